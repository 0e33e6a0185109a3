//! Linear and quadratic first integrals of an equation, found numerically.

use crate::basis::{Basis, dot};
use lie_runtime::poisson::Poisson;
use lie_runtime::scalar::Scalar;
use lie_runtime::state::State;

/// First integrals are sought in so many coordinates at most: the monomials grow with their square.
pub(crate) const MOST_COORDINATES: usize = 24;

/// A first integral of degree one or two: `a·mu + mu·(A mu)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Integral {
    /// Coefficients: first the n of the linear part, then those of `mu_i mu_j`, `i <= j`, row by row; or
    /// only the linear part.
    coefficients: Vec<f64>,
    /// The largest `|grad I · f| / (|grad I| |f|)` at states that were not used to find it.
    pub defect: f64,
}

/// The monomials of degree one and, if wanted, two, and their derivatives along `field`.
fn along(mu: &[f64], field: &[f64], quadratic: bool) -> Vec<f64> {
    let mut row = field.to_vec();
    if quadratic {
        for i in 0..mu.len() {
            for j in i..mu.len() {
                row.push(mu[i] * field[j] + field[i] * mu[j]);
            }
        }
    }
    row
}

impl Integral {
    /// Its value.
    pub fn value(&self, mu: &[f64]) -> f64 {
        self.terms(mu).sum()
    }

    /// The sum of the absolute values of its terms: what round-off is relative to.
    pub fn size(&self, mu: &[f64]) -> f64 {
        self.terms(mu).map(f64::abs).sum()
    }

    fn terms<'a>(&'a self, mu: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        let quadratic = (0..mu.len()).flat_map(move |i| (i..mu.len()).map(move |j| mu[i] * mu[j]));
        let monomials = mu.iter().copied().chain(quadratic);
        self.coefficients.iter().zip(monomials).map(|(c, m)| c * m)
    }
}

/// A basis of the first integrals of degree one (`quadratic` false) or at most two, from the null space of
/// `grad I · f = 0` at many states near the ones given: those that hold there to round-off.
///
/// Systems with too many coordinates are left out: above 24 there are hundreds of monomials.
pub fn integrals<P: Poisson<f64>>(
    system: &P,
    states: &[P::State],
    quadratic: bool,
) -> Vec<Integral> {
    let n = system.dimension();
    if states.is_empty() || n > MOST_COORDINATES {
        return Vec::new();
    }
    let unknowns = if quadratic { n + n * (n + 1) / 2 } else { n };
    let mut random = crate::random::Random::new(1);
    let mut sample = |count: usize| -> Vec<Vec<f64>> {
        let mut rows = Vec::new();
        let mut tries = 0;
        let mut field = system.zero_state();
        while rows.len() < count && tries < 10 * count {
            tries += 1;
            let near = random.near(&states[tries % states.len()], 0.5);
            system.vector_field(&near, &mut field);
            let row = along(near.as_slice(), field.as_slice(), quadratic);
            let length = dot(&row, &row).sqrt();
            if length.is_finite() && length > 0.0 {
                rows.push(row.iter().map(|x| x / length).collect());
            }
        }
        rows
    };
    let rows = sample(unknowns + 8);
    if rows.len() < unknowns {
        return Vec::new();
    }
    let fresh = sample(16);
    let found = Basis::from_span(&rows).complement(unknowns);
    found
        .into_iter()
        .map(|coefficients| {
            let defects = fresh.iter().map(|row| dot(row, &coefficients).abs());
            let defect = defects.fold(0.0, Scalar::max);
            Integral {
                coefficients,
                defect,
            }
        })
        .filter(|integral| integral.defect < 1e-12)
        .collect()
}
