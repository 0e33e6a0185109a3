//! Equilibria that are proven to be there.
//!
//! A solution whose coordinates are rational is recognised by continued fractions and inserted into the equations, exactly.
//! Of any other isolated one a box around the approximation is shown to contain exactly one solution: with an approximate
//! inverse Y of the derivative, `K = y - Y F(y) + (1 - Y F'(X)) (X - y)` lies in the interior of the box X (Krawczyk 1969,
//! doi:10.1007/BF02234767). The computations are those of balls of 256 bits.

use lie_symbolic::exact::{Ball, Rational};

use crate::arithmetic::{Arithmetic as _, Balls, Rationals};
use crate::dense::{norm, solve};
use crate::homotopy::multiplier;
use crate::newton::At;
use crate::system::{Equations, Shape};
use crate::tape::Tape;

/// Denominators of rational solutions.
const DENOMINATOR: f64 = 1e6;
/// A coordinate is known to this part of its scale.
const ROUND_OFF: f64 = 1e-13;
/// A degenerate equilibrium is within this part of its size of where it is found.
const FLAT: f64 = 5e-4;
/// A box reaches so many binary digits below the solution.
const WIDTH: i64 = 90;
/// Steps of refinement: each has 15 more digits.
const REFINEMENTS: usize = 4;

/// What proofs compute with.
pub struct Prover<'a> {
    equations: &'a Equations,
    rational: Option<[Tape<Rationals>; 2]>,
    balls: Option<[Tape<Balls>; 2]>,
}

/// A solution that is there.
pub enum Proven {
    /// With rational coordinates and multipliers.
    Rational(Vec<Rational>, Shape<Rational>),
    /// The one in a box, with what linearises the motion in all of it.
    Enclosed(Box<Enclosed>),
}

/// A box with exactly one solution.
pub struct Enclosed {
    /// What is computed with.
    pub balls: Balls,
    /// What linearises the motion in all of the box.
    pub shape: Shape<Ball>,
    /// The middle of the box; zero where the box holds zero.
    pub middle: Vec<f64>,
}

impl<'a> Prover<'a> {
    /// For the equations of a system.
    pub fn new(equations: &'a Equations) -> Self {
        Self {
            equations,
            rational: equations.rational(),
            balls: equations.balls(),
        }
    }

    /// Proves that there is a solution near y, which is known to so much, at exact values of the parameters.
    pub fn prove(&self, y: &[f64], reach: f64, parameters: &[Rational]) -> Option<Proven> {
        self.rational(y, 0.0, parameters)
            .or_else(|| self.enclosed(y, parameters))
            .or_else(|| (reach > 0.0).then(|| self.rational(y, reach, parameters))?)
            .or_else(|| {
                // flat to the fourth order or more, it is known to a fourth of the digits
                let far = FLAT * norm(&y[..self.equations.sizes.n]);
                (reach > 0.0).then(|| self.rational(y, far, parameters))?
            })
    }

    fn rational(&self, y: &[f64], reach: f64, parameters: &[Rational]) -> Option<Proven> {
        let [first, second] = self.rational.as_ref()?;
        let pairs = y.iter().zip(self.sizes(y, parameters));
        let near = |size: f64| (ROUND_OFF * size).max(2.0 * reach);
        let exact = pairs.map(|(y, size)| fraction(*y, near(size)));
        let exact: Option<Vec<Rational>> = exact.collect();
        let exact = exact?;
        let inputs = [exact.as_slice(), parameters].concat();
        let linear = self.equations.sizes.linear(first.evaluate(&inputs)?);
        if !linear.residual.iter().all(Rational::is_zero) {
            return None;
        }
        let shape = self.equations.sizes.shape(second.evaluate(&inputs)?);
        Some(Proven::Rational(exact, shape))
    }

    /// The scale of each unknown: states and multipliers have units of their own.
    fn sizes(&self, y: &[f64], parameters: &[Rational]) -> Vec<f64> {
        let values: Vec<f64> = parameters.iter().map(Rational::to_f64).collect();
        let at = At {
            equations: self.equations,
            parameters: &values,
        };
        let (x, lambda) = y.split_at(self.equations.sizes.n);
        let size = at.size(y);
        let multiplier = multiplier(at, x, size).max(norm(lambda));
        let of = |k: usize| if k < x.len() { size } else { multiplier };
        (0..y.len()).map(of).collect()
    }

    fn enclosed(&self, y: &[f64], parameters: &[Rational]) -> Option<Proven> {
        let [first, second] = self.balls.as_ref()?;
        let balls = first.arithmetic();
        let (n, sizes) = (y.len(), self.equations.sizes);
        let given: Vec<Ball> = parameters.iter().map(|p| balls.rational(p)).collect();
        let at = |y: &[Ball]| Some(sizes.linear(first.evaluate(&[y, &given].concat())?));
        let exact: Option<Vec<Rational>> = y.iter().map(|y| Rational::from_f64(*y)).collect();
        let mut exact = exact?;
        let slope: Vec<f64> = {
            let middle: Vec<Ball> = exact.iter().map(|y| balls.rational(y)).collect();
            at(&middle)?.slope.iter().map(Ball::to_f64).collect()
        };
        let scales = self.sizes(y, parameters);
        for _ in 0..REFINEMENTS {
            let middle: Vec<Ball> = exact.iter().map(|y| balls.rational(y)).collect();
            let residual = at(&middle)?.residual.iter().map(Ball::to_f64).collect();
            let step = balanced(&slope, &scales, residual)?;
            for (y, d) in exact.iter_mut().zip(step) {
                *y = &*y - &Rational::from_f64(d)?;
            }
        }
        let middle: Vec<Ball> = exact.iter().map(|y| balls.rational(y)).collect();
        let reach: Vec<i64> = scales
            .iter()
            .map(|size| size.log2().ceil() as i64 - WIDTH)
            .collect();
        let zero: Vec<Ball> = reach.iter().map(|k| balls.around_zero(*k)).collect();
        let whole = middle.iter().zip(&zero).map(|(y, zero)| balls.add(y, zero));
        let whole: Vec<Ball> = whole.collect();
        let (residual, derivative) = (at(&middle)?.residual, at(&whole)?.slope);
        let inverse = inverse(&slope, &scales, balls)?;
        for (own, row) in inverse.chunks(n).enumerate() {
            let mut moved = balls.rational(&Rational::ZERO);
            for (y, f) in row.iter().zip(&residual) {
                moved = balls.sub(&moved, &balls.mul(y, f));
            }
            for j in 0..n {
                let mut entry = balls.rational(&Rational::from(i64::from(own == j)));
                for (y, slopes) in row.iter().zip(derivative.chunks(n)) {
                    entry = balls.sub(&entry, &balls.mul(y, &slopes[j]));
                }
                moved = balls.add(&moved, &balls.mul(&entry, &zero[j]));
            }
            // less than the box in every coordinate
            if moved.magnitude() > reach[own] {
                return None;
            }
        }
        let shape = sizes.shape(second.evaluate(&[whole.as_slice(), &given].concat())?);
        let sides = whole.iter().map(|side| match side.sign() {
            Some(_) => side.to_f64(),
            None => 0.0,
        });
        Some(Proven::Enclosed(Box::new(Enclosed {
            balls: balls.clone(),
            middle: sides.collect(),
            shape,
        })))
    }
}

/// The solution of `A x = b` for unknowns of these scales: each row in parts of its largest term.
fn balanced(a: &[f64], scales: &[f64], b: Vec<f64>) -> Option<Vec<f64>> {
    let (mut matrix, mut right) = (Vec::with_capacity(a.len()), Vec::with_capacity(b.len()));
    for (row, value) in a.chunks(scales.len()).zip(b) {
        let terms: Vec<f64> = row.iter().zip(scales).map(|(a, scale)| a * scale).collect();
        let size = terms.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
        matrix.extend(terms.iter().map(|x| x / size));
        right.push(value / size);
    }
    let found = solve(&matrix, right)?;
    Some(
        found
            .iter()
            .zip(scales)
            .map(|(x, scale)| x * scale)
            .collect(),
    )
}

/// An approximate inverse, as numbers that are what they are.
fn inverse(slope: &[f64], scales: &[f64], balls: &Balls) -> Option<Vec<Ball>> {
    let n = scales.len();
    let mut columns = Vec::new();
    for j in 0..n {
        let unit = (0..n).map(|i| f64::from(u8::from(i == j))).collect();
        columns.push(balanced(slope, scales, unit)?);
    }
    let entries = (0..n).flat_map(|i| columns.iter().map(move |column| column[i]));
    entries
        .map(|x| Some(balls.rational(&Rational::from_f64(x)?)))
        .collect()
}

/// The fraction with the smallest denominator so near to a number, if it is small.
fn fraction(value: f64, near: f64) -> Option<Rational> {
    let (mut rest, mut last, mut now) = (value, (0.0, 1.0), (1.0, 0.0));
    for _ in 0..40 {
        let whole = rest.floor();
        (last, now) = (now, (whole * now.0 + last.0, whole * now.1 + last.1));
        if now.1 > DENOMINATOR || now.0.abs() > 1e15 {
            return None;
        }
        if (now.0 / now.1 - value).abs() <= near {
            return Rational::new(now.0 as i64, now.1 as i64);
        }
        rest = 1.0 / (rest - whole);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fractions_are_recognised() {
        let of = |n: i64, d: i64| fraction(n as f64 / d as f64, ROUND_OFF);
        assert_eq!(of(355, 113), Rational::new(355, 113));
        assert_eq!(of(-2, 7), Rational::new(-2, 7));
        assert_eq!(fraction(3e-17, ROUND_OFF), Some(Rational::ZERO));
        assert_eq!(fraction(2.0_f64.sqrt(), ROUND_OFF), None);
    }
}
