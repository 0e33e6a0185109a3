//! Numbers of 67 digits as a field, and the values of expressions in it.

use super::confirmation;
use super::sample::Sample;
use crate::exact::Ball;
use crate::exact::elimination::Field;
use crate::symbolic::{ExprId, Graph};

/// A number by its first 67 digits.
#[derive(Clone)]
pub struct Digits(Ball);

impl Field for Digits {
    fn is_nonzero(&self) -> bool {
        self.0.excludes_zero()
    }
    fn is_zero(&self) -> bool {
        self.0.is_zero()
    }
    fn size(&self) -> i64 {
        self.0.magnitude()
    }
    fn inverse(&self) -> Option<Self> {
        self.0.recip(confirmation::precision()).map(Self)
    }
    fn times(&self, other: &Self) -> Self {
        Self(self.0.mul(&other.0, confirmation::precision()))
    }
    fn minus(&self, other: &Self) -> Self {
        Self(self.0.sub(&other.0, confirmation::precision()))
    }
    fn zero() -> Self {
        Self(Ball::integer(0))
    }
}

/// The values at a sample point; `None` where something is not defined.
pub fn at_sample(graph: &Graph, entries: &[ExprId], point: Sample) -> Option<Vec<Digits>> {
    let values = confirmation::values(graph, entries, &|symbol| {
        let (numerator, exponent) = point.dyadic(graph, symbol);
        Some(Ball::dyadic(numerator, exponent))
    })?;
    Some(values.into_iter().map(Digits).collect())
}
