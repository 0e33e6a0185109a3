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
    /// The entries of both matrices.
    pub fn entries(&self) -> impl Iterator<Item = &ExprId> {
        self.map.iter().chain(self.second.iter().flatten())
    }

    /// It as a map to the group of the matrices of a system. Those of a right-invariant one are the negative ones, whose group has the
    /// inverse elements: the ends change places.
    pub fn moving<'a>(&'a self, basis: &'a [Vec<Vec<Rational>>], right: bool) -> Moving<'a> {
        let (map, second) = (Some(&*self.map), self.second.as_deref());
        Moving {
            size: self.size,
            basis,
            ends: match right {
                false => [map, second],
                true => [second, map],
            },
        }
    }
}
