//! Retractions that a user declares.

use crate::algebra::moving::Moving;
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::ExprId;
use lie_syntax::diagnostic::Origin;

/// A verified retraction: a map `tau = second^-1 map` from the algebra to the group of the declared matrices.
#[derive(Clone, Debug)]
pub struct Retraction {
    /// The number of rows of the matrices.
    pub size: usize,
    /// The matrix by rows; the coordinates of the element are the inputs from 0 on.
    pub map: Vec<ExprId>,
    /// The matrix at the other end of the step, if there is one.
    pub second: Option<Vec<ExprId>>,
    /// Where it stands.
    pub origin: Origin,
}

impl Retraction {
    /// It as a map to the group of these matrices.
    pub fn moving<'a>(&'a self, basis: &'a [Vec<Vec<Rational>>]) -> Moving<'a> {
        Moving {
            size: self.size,
            basis,
            ends: [Some(&self.map), self.second.as_deref()],
        }
    }
}
