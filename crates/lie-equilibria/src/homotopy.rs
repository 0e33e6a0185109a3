//! All isolated solutions of polynomial equations, by paths in the complex plane.
//!
//! Each equation is deformed into a product of linear forms, of as many in x and as many in the multipliers as it has degrees in
//! both. The solutions of the products are known, and their number bounds that of the isolated solutions of the equations
//! (the two-homogeneous number of Bézout). Along `(1 - t) gamma G + t F = 0` with a complex `gamma` drawn by chance a path leads from each
//! of them; for almost all `gamma` the paths are smooth, and every isolated solution is the end of one.
//!
//! A. Morgan and A. Sommese (1987), A homotopy for solving general polynomial systems that respects m-homogeneous structures,
//! doi:10.1016/0096-3003(87)90063-4.

use num_complex::Complex64 as c64;

use crate::arithmetic::Complexes;
use crate::dense::{norm, solve};
use crate::newton::At;
use crate::random::Random;
use crate::system::Sizes;
use crate::tape::Tape;

/// More paths are not followed.
pub const MOST: usize = 500;
/// Steps of a path.
const STEPS: usize = 2000;
/// The smallest step, but for the last part of a path, which is so long.
const LEAST: f64 = 1e-9;
const NEAR: f64 = 1e-4;
/// A path beyond so many times the scale goes to infinity.
const FAR: f64 = 1e6;
/// An end is real where its imaginary part is below this part of its size.
const REAL: f64 = 1e-6;

/// What became of the paths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Paths {
    /// How many there are.
    pub all: usize,
    /// Those that end at solutions that are isolated.
    pub isolated: usize,
    /// Those of them that are real.
    pub real: usize,
    /// Those that end at solutions with a singular linearisation: multiple ones, or members of families.
    pub singular: usize,
    /// Those that go to infinity.
    pub infinite: usize,
    /// Those that were lost: then a solution may be missing.
    pub lost: usize,
}

/// A linear form, in x or in the multipliers: coefficients, then the constant.
struct Form {
    in_x: bool,
    coefficients: Vec<c64>,
}

struct Tracker<'a> {
    tape: Tape<Complexes>,
    sizes: Sizes,
    parameters: Vec<c64>,
    /// The scale of each unknown, and what each equation is divided by.
    scale: Vec<f64>,
    weight: Vec<f64>,
    gamma: c64,
    forms: &'a [Vec<Form>],
}

enum End {
    Isolated(Vec<c64>),
    Singular(Vec<c64>),
    Infinite,
    Lost,
}

/// What the paths lead to, with the real ends; `None` where the equations are no polynomials, or there are too many paths.
pub fn ends(at: At<'_>, seed: u64) -> Option<(Paths, Vec<Vec<f64>>)> {
    let equations = at.equations;
    let (sizes, all) = (equations.sizes, equations.unknowns());
    let (tape, [in_x, in_lambda]) = equations.polynomial()?;
    let (_, state) = equations.leaf(at.parameters)?;
    let mut random = Random::new(seed ^ 0x5eed);
    let mut forms = Vec::new();
    for (x, lambda) in in_x.iter().zip(&in_lambda) {
        let blocks = (0..*x).map(|_| true).chain((0..*lambda).map(|_| false));
        let form = |in_x| Form {
            in_x,
            coefficients: (0..=if in_x { sizes.n } else { sizes.m })
                .map(|_| c64::new(random.unit(), random.unit()))
                .collect(),
        };
        forms.push(blocks.map(form).collect::<Vec<Form>>());
    }
    let choices = choices(&forms, sizes.n)?;
    let size = match norm(&state) {
        0.0 => 1.0,
        size => size,
    };
    let multiplier = multiplier(at, &state, size);
    let scale: Vec<f64> = (0..all)
        .map(|k| if k < sizes.n { size } else { multiplier })
        .collect();
    let parameters: Vec<c64> = at.parameters.iter().map(|p| c64::new(*p, 0.0)).collect();
    let angle = std::f64::consts::PI * random.unit();
    let mut tracker = Tracker {
        tape,
        sizes,
        parameters,
        scale,
        weight: vec![1.0; all],
        gamma: c64::new(angle.cos(), angle.sin()),
        forms: &forms,
    };
    let typical: Vec<c64> = (0..all)
        .map(|_| c64::new(random.unit(), random.unit()))
        .collect();
    let (values, _) = tracker.equations(&typical)?;
    for (weight, value) in tracker.weight.iter_mut().zip(values) {
        *weight = value.norm().max(f64::MIN_POSITIVE);
    }
    let mut paths = Paths {
        all: choices.len(),
        ..Paths::default()
    };
    let mut real = Vec::new();
    for choice in &choices {
        let Some(start) = tracker.start(choice) else {
            paths.lost += 1;
            continue;
        };
        let end = match tracker.follow(start) {
            End::Isolated(end) => {
                paths.isolated += 1;
                paths.real += usize::from(is_real(&end));
                end
            }
            End::Singular(end) => {
                paths.singular += 1;
                end
            }
            End::Infinite => {
                paths.infinite += 1;
                continue;
            }
            End::Lost => {
                paths.lost += 1;
                continue;
            }
        };
        if is_real(&end) {
            let places = end.iter().zip(&tracker.scale);
            real.push(places.map(|(z, scale)| z.re * scale).collect());
        }
    }
    Some((paths, real))
}

fn is_real(end: &[c64]) -> bool {
    let part = |of: fn(&c64) -> f64| end.iter().map(|z| of(z).powi(2)).sum::<f64>().sqrt();
    // a double end is only known to half of the digits
    part(|z| z.im) <= REAL * part(|z| z.norm())
}

/// About how large multipliers are: `|grad H|/|grad C|` at a state.
pub(crate) fn multiplier(at: At<'_>, state: &[f64], size: f64) -> f64 {
    let m = at.equations.sizes.m;
    let shifted: Vec<f64> = state.iter().map(|x| x + 0.1 * size).collect();
    let y = [shifted, vec![0.0; m]].concat();
    let Some(shape) = at.equations.shape(&y, at.parameters) else {
        return 1.0;
    };
    let Some(linear) = at.equations.linear(&y, at.parameters) else {
        return 1.0;
    };
    let gradient = norm(&linear.residual[..state.len()]);
    let casimirs = norm(&shape.gradients) / (m.max(1) as f64).sqrt();
    match gradient > 0.0 && casimirs > 0.0 {
        true => gradient / casimirs,
        false => 1.0,
    }
}

/// The choices of one form of each equation of which n are in x; `None` if there are too many.
fn choices(forms: &[Vec<Form>], n: usize) -> Option<Vec<Vec<usize>>> {
    let mut all: Vec<(Vec<usize>, usize)> = vec![(Vec::new(), 0)];
    let m = forms.len() - n;
    for (place, of) in forms.iter().enumerate() {
        let mut next = Vec::new();
        for (choice, in_x) in &all {
            for (k, form) in of.iter().enumerate() {
                let in_x = in_x + usize::from(form.in_x);
                if in_x <= n && place + 1 - in_x <= m {
                    next.push(([choice.as_slice(), &[k]].concat(), in_x));
                }
            }
        }
        if next.len() > 40 * MOST {
            return None;
        }
        all = next;
    }
    (all.len() <= MOST).then(|| all.into_iter().map(|(choice, _)| choice).collect())
}

impl Tracker<'_> {
    /// F and its derivative at scaled unknowns, each equation divided by its weight.
    fn equations(&self, z: &[c64]) -> Option<(Vec<c64>, Vec<c64>)> {
        let n = z.len();
        let y = z.iter().zip(&self.scale).map(|(z, scale)| z * scale);
        let inputs: Vec<c64> = y.chain(self.parameters.iter().copied()).collect();
        let linear = self.sizes.linear(self.tape.evaluate(&inputs)?);
        let (mut values, mut slope) = (linear.residual, linear.slope);
        for i in 0..n {
            values[i] /= self.weight[i];
            for j in 0..n {
                slope[i * n + j] *= self.scale[j] / self.weight[i];
            }
        }
        Some((values, slope))
    }

    fn form(&self, form: &Form, z: &[c64]) -> c64 {
        let own = self.block(form, z);
        let (constant, coefficients) = match form.coefficients.split_last() {
            Some((constant, coefficients)) => (*constant, coefficients),
            None => return c64::new(0.0, 0.0),
        };
        coefficients
            .iter()
            .zip(own)
            .fold(constant, |sum, (a, z)| sum + a * z)
    }

    fn block<'z>(&self, form: &Form, z: &'z [c64]) -> &'z [c64] {
        match form.in_x {
            true => &z[..self.sizes.n],
            false => &z[self.sizes.n..],
        }
    }

    /// The products of linear forms and their derivatives.
    fn products(&self, z: &[c64]) -> (Vec<c64>, Vec<c64>) {
        let n = z.len();
        let (mut values, mut slope) = (Vec::new(), vec![c64::new(0.0, 0.0); n * n]);
        for (i, forms) in self.forms.iter().enumerate() {
            let of: Vec<c64> = forms.iter().map(|form| self.form(form, z)).collect();
            values.push(of.iter().fold(c64::new(1.0, 0.0), |product, x| product * x));
            for (k, form) in forms.iter().enumerate() {
                let others = of.iter().enumerate().filter(|(other, _)| *other != k);
                let others = others.fold(c64::new(1.0, 0.0), |product, (_, x)| product * x);
                let from = if form.in_x { 0 } else { self.sizes.n };
                for (j, a) in self
                    .block(form, z)
                    .iter()
                    .zip(&form.coefficients)
                    .map(|(_, a)| a)
                    .enumerate()
                {
                    slope[i * n + from + j] += others * a;
                }
            }
        }
        (values, slope)
    }

    /// Where the chosen forms are all zero.
    fn start(&self, choice: &[usize]) -> Option<Vec<c64>> {
        let mut z = Vec::new();
        for in_x in [true, false] {
            let chosen = self.forms.iter().zip(choice).map(|(forms, k)| &forms[*k]);
            let own: Vec<&Form> = chosen.filter(|form| form.in_x == in_x).collect();
            let (mut a, mut b) = (Vec::new(), Vec::new());
            for form in own {
                let (constant, coefficients) = form.coefficients.split_last()?;
                a.extend_from_slice(coefficients);
                b.push(-constant);
            }
            z.extend(solve(&a, b)?);
        }
        Some(z)
    }

    /// The homotopy, its derivative by z and that by t.
    fn homotopy(&self, z: &[c64], t: f64) -> Option<[Vec<c64>; 3]> {
        let (f, df) = self.equations(z)?;
        let (g, dg) = self.products(z);
        let (own, start) = (c64::new(t, 0.0), self.gamma * (1.0 - t));
        let mix = |f: &[c64], g: &[c64]| -> Vec<c64> {
            f.iter().zip(g).map(|(f, g)| own * f + start * g).collect()
        };
        let by_t = f.iter().zip(&g).map(|(f, g)| f - self.gamma * g).collect();
        Some([mix(&f, &g), mix(&df, &dg), by_t])
    }

    /// Newton's iteration at t: the solution, and the last step in parts of it.
    fn correct(&self, mut z: Vec<c64>, t: f64, most: usize) -> Option<(Vec<c64>, f64)> {
        let mut last = f64::INFINITY;
        for _ in 0..most {
            let [value, slope, _] = self.homotopy(&z, t)?;
            let step = solve(&slope, value)?;
            z.iter_mut().zip(&step).for_each(|(z, d)| *z -= d);
            let part = length(&step) / (1.0 + length(&z));
            if !part.is_finite() || part > 0.5 * last && part > 1e-12 {
                return None;
            }
            last = part;
            if part < 1e-10 {
                break;
            }
        }
        Some((z, last))
    }

    fn follow(&self, mut z: Vec<c64>) -> End {
        let (mut t, mut step, mut lucky) = (0.0_f64, 0.02_f64, 0);
        let minus = |v: &[c64]| -> Vec<c64> { v.iter().map(|x| -x).collect() };
        for _ in 0..STEPS {
            if length(&z) > FAR {
                return End::Infinite;
            }
            let to = if t + step >= 1.0 { 1.0 } else { t + step };
            let predicted = self.homotopy(&z, t).and_then(|[_, slope, by_t]| {
                let tangent = solve(&slope, minus(&by_t))?;
                let moved = z.iter().zip(&tangent).map(|(z, d)| z + d * (to - t));
                Some(moved.collect::<Vec<c64>>())
            });
            let corrected = predicted.and_then(|p| {
                let most = if to == 1.0 { 6 } else { 3 };
                let (next, last) = self.correct(p.clone(), to, most)?;
                let moved: Vec<c64> = next.iter().zip(&p).map(|(a, b)| a - b).collect();
                let near = length(&moved) < 0.05 * (1.0 + length(&next));
                (last < 1e-7 && near).then_some(next)
            });
            match corrected {
                Some(next) => {
                    (z, t, lucky) = (next, to, lucky + 1);
                    if t == 1.0 {
                        return match self.is_regular(&z) {
                            true => End::Isolated(z),
                            false => End::Singular(z),
                        };
                    }
                    if lucky >= 3 {
                        (step, lucky) = (2.0 * step, 0);
                    }
                }
                None => {
                    (step, lucky) = (0.5 * step, 0);
                    let near = 1.0 - t < NEAR;
                    if step < if near { 1e-3 * (1.0 - t) } else { LEAST } || step < 1e-15 {
                        break;
                    }
                }
            }
        }
        // what slows down before the end goes to a singular solution, or far away
        match 1.0 - t {
            rest if rest > NEAR => End::Lost,
            _ if length(&z) > 1e-2 * FAR => End::Infinite,
            _ => End::Singular(z),
        }
    }

    fn is_regular(&self, z: &[c64]) -> bool {
        let Some((_, slope)) = self.equations(z) else {
            return false;
        };
        let n = z.len();
        // how far a solution moves for a change of the equations, by chance directions
        let mut random = Random::new(3);
        (0..3).all(|_| {
            let right = (0..n).map(|_| c64::new(random.unit(), random.unit()));
            let moved = solve(&slope, right.collect());
            moved.is_some_and(|moved| length(&moved) < 1e7 * (1.0 + length(z)))
        })
    }
}

fn length(z: &[c64]) -> f64 {
    z.iter().map(|z| z.norm_sqr()).sum::<f64>().sqrt()
}
