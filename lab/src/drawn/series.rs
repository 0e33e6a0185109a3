//! Taylor coefficients of the field of a drawn system, each operation by its rule.

use super::energy::Shape;
use super::system::Drawn;
use lie_runtime::{GradientRecurrence, GradientSeries, Recurrence, Scalar, Series};

/// The coefficients that have been found.
#[derive(Clone, Debug)]
pub struct Coefficients<S> {
    system: Drawn,
    /// Those of the state and of the gradient, order after order.
    state: Vec<Vec<S>>,
    gradients: Vec<Vec<S>>,
    /// Those of each term.
    terms: Vec<Chain<S>>,
}

/// A number along the solution, and what leads from it to the slope of the term.
#[derive(Clone, Debug, Default)]
struct Chain<S> {
    x: Vec<S>,
    first: Vec<S>,
    second: Vec<S>,
}

/// `sum_(from <= j <= k) u_j v_(k-j)`
fn product<S: Scalar>(u: &[S], v: &[S], from: usize, k: usize) -> S {
    (from..=k).fold(S::zero(), |sum, j| sum + u[j] * v[k - j])
}

/// The coefficient of order k of a y with `y' = factor z x'`.
fn integral<S: Scalar>(x: &[S], z: &[S], k: usize) -> S {
    let sum = (1..=k).fold(S::zero(), |sum, j| {
        sum + S::from_f64(j as f64) * (x[j] * z[k - j])
    });
    sum * S::ratio(1.0, k as f64)
}

impl<S: Scalar> Chain<S> {
    /// The coefficient of order k of the slope, from that of x.
    fn next(&mut self, shape: Shape, x: S) -> S {
        self.x.push(x);
        let k = self.x.len() - 1;
        let one = S::one();
        let (x, first, second) = (&self.x, &mut self.first, &mut self.second);
        match shape {
            Shape::Quartic => {
                first.push(product(x, x, 0, k));
                product(x, first, 0, k)
            }
            Shape::Sine if k == 0 => {
                first.push(x[0].sin());
                second.push(x[0].cos());
                second[0]
            }
            Shape::Sine => {
                let (sine, cosine) = (integral(x, second, k), -integral(x, first, k));
                first.push(sine);
                second.push(cosine);
                cosine
            }
            Shape::Exponential => {
                let value = if k == 0 {
                    x[0].exp()
                } else {
                    integral(x, first, k)
                };
                first.push(value);
                value
            }
            Shape::Root => {
                let square = product(x, x, 0, k);
                if k == 0 {
                    first.push((one + square).sqrt());
                } else {
                    let inner = (1..k).fold(S::zero(), |sum, j| sum + first[j] * first[k - j]);
                    first.push((square - inner) / (first[0] + first[0]));
                }
                let known = (1..=k).fold(S::zero(), |sum, j| sum + first[j] * second[k - j]);
                second.push((x[k] - known) / first[0]);
                second[k]
            }
        }
    }
}

impl<S: Scalar> Coefficients<S> {
    fn new(system: &Drawn) -> Self {
        Self {
            terms: system
                .energy
                .terms
                .iter()
                .map(|_| Chain::default())
                .collect(),
            system: system.clone(),
            state: Vec::new(),
            gradients: Vec::new(),
        }
    }

    fn push(&mut self, coefficient: &[S], field: &mut [S]) {
        let (energy, k) = (&self.system.energy, self.state.len());
        self.state.push(coefficient.to_vec());
        let along = |direction: &[f64]| {
            let pairs = direction.iter().zip(coefficient);
            pairs.fold(S::zero(), |sum, (&entry, &x)| sum + S::from_f64(entry) * x)
        };
        let mut gradient: Vec<S> = energy.quadratic.iter().map(|row| along(row)).collect();
        if k == 0 {
            for (entry, &linear) in gradient.iter_mut().zip(&energy.linear) {
                *entry += S::from_f64(linear);
            }
        }
        for (term, chain) in energy.terms.iter().zip(&mut self.terms) {
            let slope = S::from_f64(term.factor) * chain.next(term.shape, along(&term.direction));
            for (entry, &direction) in gradient.iter_mut().zip(&term.direction) {
                *entry += slope * S::from_f64(direction);
            }
        }
        self.gradients.push(gradient);
        field.fill(S::zero());
        for &(i, j, l, c) in &self.system.algebra.constants {
            let sum = (0..=k).fold(S::zero(), |sum, m| {
                sum + self.gradients[m][i] * self.state[k - m][l]
            });
            field[j] += S::from_f64(c) * sum;
        }
    }
}

impl<S: Scalar> Recurrence<S> for Coefficients<S> {
    type State = Vec<S>;
    type Carry = ();

    fn begin(&mut self, mu: &Vec<S>, field: &mut Vec<S>) {
        *self = Self::new(&self.system);
        self.push(mu, field);
    }

    fn advance(&mut self, _k: usize, (): (), coefficient: &Vec<S>, field: &mut Vec<S>) {
        self.push(coefficient, field);
    }
}

impl<S: Scalar> GradientRecurrence<S> for Coefficients<S> {
    fn gradient(&self) -> &Vec<S> {
        self.gradients.last().expect("it has begun")
    }
}

impl<S: Scalar> Series<S> for Drawn {
    type Recurrence<'a> = Coefficients<S>;
    fn series(&self) -> Coefficients<S> {
        Coefficients::new(self)
    }
}

impl<S: Scalar> GradientSeries<S> for Drawn {
    type Recurrence<'a> = Coefficients<S>;
    fn gradient_series(&self) -> Coefficients<S> {
        Coefficients::new(self)
    }
}
