//! The equations `Pi(x) grad H(x) = 0`, `C_k(x) = c_k` of all states at rest, without multipliers.
//!
//! Where Pi has a lower rank than generically, a state is at rest though H is not stationary among those of the same Casimirs. These n + m
//! equations in n unknowns have all such solutions. They are solved as in [`crate::newton`], in parts of the scale of states, and each
//! equation in parts of its own terms.

use lie_symbolic::symbolic::{ExprId, Symbol};

use crate::arithmetic::Floats;
use crate::dense::{Singular, add, norm};
use crate::descent::{End, Linearised, descend};
use crate::family::Solutions;
use crate::newton::{At, RANK};
use crate::random::Random;
use crate::tape::Tape;

/// Steps far from a solution: those of a double one are halvings.
const MOST: usize = 120;
/// Steps near it.
const LAST: usize = 8;
/// A residual of round-off.
const SOLVED: f64 = 1e-12;
/// States beside one are so far, in parts of it.
const BESIDE: f64 = 1e-2;
/// Products of entries of Pi and of slopes beyond which no equations are written down.
const TERMS: usize = 20_000;

/// The equations at values of the parameters, in parts of scales.
pub struct Field<'a> {
    at: At<'a>,
    tape: Tape<Floats>,
    /// The scale of states.
    pub size: f64,
    /// What each equation is divided by: n of the motion, m of the Casimirs, and that of the energy.
    weights: Vec<f64>,
    /// The values of the Casimirs, and of H where it is held.
    levels: Vec<f64>,
    /// The singular values of Pi and its rank in a state that is none in particular.
    pub typical: (Vec<f64>, usize),
}

/// The values of the equations and their slopes, by rows.
pub struct Linear {
    /// The values.
    pub value: Vec<f64>,
    /// The slopes.
    pub slope: Vec<f64>,
}

impl Linearised for Linear {
    fn value(&self) -> &[f64] {
        &self.value
    }
    fn slope(&self) -> &[f64] {
        &self.slope
    }
}

impl<'a> Field<'a> {
    /// Of a system whose bracket depends on the state; `None` for others, where the rank is one, and where the equations are too many.
    pub fn new(at: At<'a>) -> Option<Self> {
        let equations = at.equations;
        let (n, m) = (equations.sizes.n, equations.sizes.m);
        let system = &equations.system;
        let mut graph = system.graph.clone();
        let all = (0..n).map(Symbol::Coordinate);
        let depends = |entry: &(usize, usize, ExprId)| !graph.coordinates(entry.2).is_empty();
        if !system.bracket.iter().any(depends) || system.bracket.len() * n > TERMS {
            return None;
        }
        let gradient = all.clone().map(|x| graph.derivative(system.hamiltonian, x));
        let gradient: Vec<ExprId> = gradient.collect();
        let mut motion = vec![Vec::new(); n];
        for (i, j, value) in &system.bracket {
            motion[*i].push(graph.mul(*value, gradient[*j]));
            let product = graph.mul(*value, gradient[*i]);
            motion[*j].push(graph.neg(product));
        }
        let mut roots: Vec<ExprId> = motion.iter().map(|terms| graph.sum(terms)).collect();
        roots.extend(system.casimirs.iter().map(|casimir| casimir.value));
        roots.push(system.hamiltonian);
        let rows = roots.clone();
        for row in rows {
            roots.extend(all.clone().map(|x| graph.derivative(row, x)));
        }
        let tape = Tape::new(Floats, &graph, &roots, |symbol| match symbol {
            Symbol::Coordinate(i) => (i < n).then_some(i),
            Symbol::Parameter(p) => Some(n + p),
            _ => None,
        })?;
        let (levels, state) = equations.leaf(at.parameters)?;
        let mut field = Self {
            at,
            tape,
            size: at.size(&vec![0.0; n + m]),
            weights: vec![1.0; n + m + 1],
            levels,
            typical: (Vec::new(), 0),
        };
        let beside = state.iter().enumerate();
        let beside = beside.map(|(i, x)| x / field.size + 0.1 + 0.03 * i as f64);
        let beside: Vec<f64> = beside.collect();
        let linear = field.whole(&beside)?;
        let largest = |rows: &[f64]| rows.chunks(n).map(norm).fold(f64::MIN_POSITIVE, f64::max);
        let of_motion = largest(&linear.slope[..n * n]);
        field.weights[..n].fill(of_motion);
        for k in 0..=m {
            field.weights[n + k] = largest(&linear.slope[(n + k) * n..(n + k + 1) * n]);
        }
        let values = field.singular(&beside)?;
        let rank = values.iter().filter(|x| **x > 1e-9 * values[0]).count();
        field.typical = (values, rank);
        Some(field)
    }

    /// The same equations where H has a value too.
    pub fn with_energy(mut self, energy: f64) -> Self {
        self.levels.truncate(self.at.equations.sizes.m);
        self.levels.push(energy);
        self
    }

    /// Every equation, that of the energy too, at a state in parts of the scale.
    fn whole(&self, z: &[f64]) -> Option<Linear> {
        let (n, m) = (z.len(), self.at.equations.sizes.m);
        let x: Vec<f64> = z.iter().map(|z| z * self.size).collect();
        let mut value = self.tape.evaluate(&[&x, self.at.parameters].concat())?;
        if !value.iter().all(|x| x.is_finite()) {
            return None;
        }
        let mut slope = value.split_off(n + m + 1);
        for (row, weight) in self.weights.iter().enumerate() {
            let level = row.checked_sub(n).and_then(|k| self.levels.get(k));
            value[row] = (value[row] - level.unwrap_or(&0.0)) / weight;
            let row = &mut slope[row * n..(row + 1) * n];
            row.iter_mut().for_each(|x| *x *= self.size / weight);
        }
        Some(Linear { value, slope })
    }

    /// The equations that hold.
    pub fn linear(&self, z: &[f64]) -> Option<Linear> {
        let mut linear = self.whole(z)?;
        let count = z.len() + self.levels.len();
        linear.value.truncate(count);
        linear.slope.truncate(count * z.len());
        Some(linear)
    }

    /// The singular values of Pi.
    pub fn singular(&self, z: &[f64]) -> Option<Vec<f64>> {
        let (n, m) = (z.len(), self.at.equations.sizes.m);
        let mut y: Vec<f64> = z.iter().map(|z| z * self.size).collect();
        y.resize(n + m, 0.0);
        let shape = self.at.equations.shape(&y, self.at.parameters)?;
        Some(Singular::new(&shape.bracket, n, n)?.values)
    }

    /// Whether the rank is higher beside a state: a singular value that dies out like `exp(-x)` is as small there, and no zero.
    pub fn rank_returns(&self, z: &[f64], rank: usize) -> bool {
        let own = self.singular(z).map(|values| values[rank]);
        let mut random = Random::new(11);
        let mut beside = (0..z.len() + 2).filter_map(|_| {
            let mut other = z.to_vec();
            add(
                &mut other,
                BESIDE * norm(z).max(1.0),
                &random.direction(z.len()),
            );
            self.singular(&other).map(|values| values[rank])
        });
        own.is_some_and(|own| beside.any(|value| own <= 1e-2 * value))
    }

    /// The eigenvalues' matrix: the slope of the motion in units of the time.
    pub fn motion(&self, linear: &Linear) -> Vec<f64> {
        let n = self.at.equations.sizes.n;
        let factor = self.weights[0] / self.size;
        linear.slope[..n * n].iter().map(|x| x * factor).collect()
    }

    /// How large entries of that matrix are in general.
    pub fn rate(&self) -> f64 {
        self.weights[0]
    }

    /// A solution that steps from z lead to.
    pub fn solve(&self, z: &[f64]) -> Option<Vec<f64>> {
        let near = self.approach(z)?;
        self.polish(near)
    }

    /// Steps of Levenberg and Marquardt.
    fn approach(&self, z: &[f64]) -> Option<Vec<f64>> {
        let is_solved = |_: &[f64], linear: &Linear| norm(&linear.value) <= 0.1 * SOLVED;
        match descend(z, MOST, |z| self.linear(z), is_solved, |_| 1e-30)? {
            End::Solved(z) | End::Spent(z) => Some(z),
            End::Stuck(z, size) => (size <= SOLVED).then_some(z),
        }
    }

    /// How far a member of a family of this dimension is uncertain: as far as the equations are round-off.
    pub fn reach(&self, z: &[f64], family: usize) -> Option<f64> {
        let linear = self.linear(z)?;
        let singular = Singular::new(&linear.slope, linear.value.len(), z.len())?;
        let Some(place) = z.len().checked_sub(family + 1) else {
            return Some(f64::EPSILON);
        };
        let direction = &singular.right[place];
        let bound = (64.0 * f64::EPSILON).max(2.0 * norm(&linear.value));
        let is_flat = |part: f64| {
            let mut other = z.to_vec();
            add(&mut other, part, direction);
            let linear = self.linear(&other);
            linear.is_some_and(|linear| norm(&linear.value) <= bound)
        };
        let mut length = f64::EPSILON;
        while length < 1e-2 && (is_flat(2.0 * length) || is_flat(-2.0 * length)) {
            length *= 2.0;
        }
        Some(2.0 * length)
    }
}

impl Solutions for Field<'_> {
    fn kernel(&self, z: &[f64]) -> Option<Vec<Vec<f64>>> {
        let linear = self.linear(z)?;
        let singular = Singular::new(&linear.slope, linear.value.len(), z.len())?;
        // in parts of what slopes are in general: those of a state where all vanish are round-off
        let rank = singular.values.iter().filter(|value| **value > RANK);
        Some(singular.kernel(rank.count()).to_vec())
    }

    /// The shortest steps to round-off.
    fn polish(&self, mut z: Vec<f64>) -> Option<Vec<f64>> {
        let mut best: Option<(f64, Vec<f64>)> = None;
        for _ in 0..LAST {
            let linear = self.linear(&z)?;
            let size = norm(&linear.value);
            if best.as_ref().is_some_and(|(least, _)| size >= *least) {
                break;
            }
            best = Some((size, z.clone()));
            let singular = Singular::new(&linear.slope, linear.value.len(), z.len())?;
            let rank = singular.values.iter().filter(|value| **value > RANK);
            let step = singular.shortest(&linear.value, rank.count());
            if norm(&step) > 1e-1 * norm(&z).max(1.0) && size > 1e-6 {
                return None;
            }
            add(&mut z, -1.0, &step);
        }
        let (size, z) = best?;
        (size <= SOLVED).then_some(z)
    }
}
