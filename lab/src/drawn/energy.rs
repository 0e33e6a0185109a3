//! Hamiltonians of given shapes with coefficients drawn by chance.

use super::Chance;
use lie_runtime::Scalar;

/// A function of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// `x^4/4`
    Quartic,
    /// `sin x`
    Sine,
    /// `exp x`
    Exponential,
    /// `sqrt(1 + x^2)`
    Root,
}

impl Shape {
    /// Value, slope and curvature.
    pub fn at<S: Scalar>(self, x: S) -> [S; 3] {
        let one = S::one();
        match self {
            Self::Quartic => {
                let square = x * x;
                [
                    S::ratio(1.0, 4.0) * square * square,
                    square * x,
                    S::from_f64(3.0) * square,
                ]
            }
            Self::Sine => [x.sin(), x.cos(), -x.sin()],
            Self::Exponential => [x.exp(); 3],
            Self::Root => {
                let root = (one + x * x).sqrt();
                [root, x / root, one / (root * root * root)]
            }
        }
    }
}

/// `factor shape(direction . mu)`
#[derive(Clone, Debug)]
pub struct Term {
    /// The function.
    pub shape: Shape,
    /// The factor.
    pub factor: f64,
    /// The direction.
    pub direction: Vec<f64>,
}

/// What kind of function H is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A quadratic form.
    Quadratic,
    /// With linear terms.
    Linear,
    /// With quartic terms.
    Quartic,
    /// With sine, exponential and root.
    Nonpolynomial,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 4] = [
        Self::Quadratic,
        Self::Linear,
        Self::Quartic,
        Self::Nonpolynomial,
    ];
}

/// `b . mu + mu . Q mu/2 + sum of terms`
#[derive(Clone, Debug)]
pub struct Energy {
    /// b
    pub linear: Vec<f64>,
    /// Q
    pub quadratic: Vec<Vec<f64>>,
    /// The others.
    pub terms: Vec<Term>,
    /// Whether it is a sum of functions of one coordinate each.
    pub separable: bool,
}

impl Energy {
    /// One of a kind, for states of a size.
    pub fn draw(
        kind: Kind,
        dimension: usize,
        size: f64,
        separable: bool,
        chance: &mut Chance,
    ) -> Self {
        let mut energy = Self {
            linear: vec![0.0; dimension],
            quadratic: form(dimension, separable, chance),
            terms: Vec::new(),
            separable,
        };
        if kind != Kind::Quadratic {
            let factor = if chance.holds(0.7) { size } else { 0.0 };
            energy.linear = chance.numbers(dimension);
            energy.linear.iter_mut().for_each(|entry| *entry *= factor);
        }
        let shapes: &[Shape] = match kind {
            Kind::Quadratic | Kind::Linear => &[],
            Kind::Quartic => &[Shape::Quartic, Shape::Quartic],
            Kind::Nonpolynomial => &[Shape::Sine, Shape::Exponential, Shape::Root, Shape::Sine],
        };
        for &shape in shapes {
            if kind == Kind::Nonpolynomial && chance.holds(0.3) {
                continue;
            }
            let length = chance.size_between(0.5, 2.0) / size;
            let direction = if separable {
                let mut direction = vec![0.0; dimension];
                direction[chance.below(dimension)] = length;
                direction
            } else {
                let numbers = chance.numbers(dimension);
                let norm = numbers.iter().map(|x| x * x).sum::<f64>().sqrt();
                numbers.iter().map(|x| length * x / norm).collect()
            };
            let mut factor = chance.number() * size * size;
            if shape == Shape::Quartic {
                factor = factor.abs();
            }
            energy.terms.push(Term {
                shape,
                factor,
                direction,
            });
        }
        energy
    }

    /// H
    pub fn value<S: Scalar>(&self, mu: &[S]) -> S {
        let half = S::ratio(1.0, 2.0);
        let mut sum = S::zero();
        for (i, (&x, &b)) in mu.iter().zip(&self.linear).enumerate() {
            sum += x * (S::from_f64(b) + half * along(&self.quadratic[i], mu));
        }
        for term in &self.terms {
            sum += S::from_f64(term.factor) * term.shape.at(along(&term.direction, mu))[0];
        }
        sum
    }

    /// grad H
    pub fn gradient<S: Scalar>(&self, mu: &[S], out: &mut [S]) {
        for ((out, row), &b) in out.iter_mut().zip(&self.quadratic).zip(&self.linear) {
            *out = S::from_f64(b) + along(row, mu);
        }
        for term in &self.terms {
            let slope = S::from_f64(term.factor) * term.shape.at(along(&term.direction, mu))[1];
            for (out, &entry) in out.iter_mut().zip(&term.direction) {
                if entry != 0.0 {
                    *out += slope * S::from_f64(entry);
                }
            }
        }
    }

    /// The second derivatives, entry by entry.
    pub fn hessian<S: Scalar>(&self, mu: &[S], mut set: impl FnMut(usize, usize, S)) {
        let curvature =
            |term: &Term| S::from_f64(term.factor) * term.shape.at(along(&term.direction, mu))[2];
        let curvatures: Vec<S> = self.terms.iter().map(curvature).collect();
        for (i, row) in self.quadratic.iter().enumerate() {
            for (j, &entry) in row.iter().enumerate() {
                let mut sum = S::from_f64(entry);
                for (term, &curvature) in self.terms.iter().zip(&curvatures) {
                    sum += curvature * S::from_f64(term.direction[i] * term.direction[j]);
                }
                set(i, j, sum);
            }
        }
    }

    /// The degree, where it is a polynomial.
    pub fn degree(&self) -> Option<u32> {
        let quartic = self.terms.iter().all(|term| term.shape == Shape::Quartic);
        match (self.terms.is_empty(), quartic) {
            (true, _) => Some(2),
            (_, true) => Some(4),
            _ => None,
        }
    }
}

fn along<S: Scalar>(direction: &[f64], mu: &[S]) -> S {
    let pairs = direction.iter().zip(mu).filter(|(entry, _)| **entry != 0.0);
    pairs.fold(S::zero(), |sum, (&entry, &x)| sum + S::from_f64(entry) * x)
}

/// A symmetric matrix with eigenvalues between 1/5 and 3, some of them negative one time in four.
fn form(dimension: usize, diagonal: bool, chance: &mut Chance) -> Vec<Vec<f64>> {
    let signs = chance.holds(0.25);
    let values: Vec<f64> = (0..dimension)
        .map(|_| {
            let value = chance.size_between(0.2, 3.0);
            if signs && chance.holds(0.3) {
                -value
            } else {
                value
            }
        })
        .collect();
    let mut rows = vec![vec![0.0; dimension]; dimension];
    for (i, value) in values.iter().enumerate() {
        rows[i][i] = *value;
    }
    if diagonal {
        return rows;
    }
    // turned in planes
    for _ in 0..2 * dimension {
        let (i, j) = (chance.below(dimension), chance.below(dimension));
        if i == j {
            continue;
        }
        let (sin, cos) = (3.2 * chance.number()).sin_cos();
        for row in &mut rows {
            (row[i], row[j]) = (cos * row[i] - sin * row[j], sin * row[i] + cos * row[j]);
        }
        let pairs: Vec<(f64, f64)> = rows[i]
            .iter()
            .copied()
            .zip(rows[j].iter().copied())
            .collect();
        for (k, (a, b)) in pairs.into_iter().enumerate() {
            (rows[i][k], rows[j][k]) = (cos * a - sin * b, sin * a + cos * b);
        }
    }
    // the same digits on both sides
    let upper = rows.clone();
    for (i, row) in rows.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate().take(i) {
            *entry = upper[j][i];
        }
    }
    rows
}
