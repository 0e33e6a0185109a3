//! Equations that the velocity satisfies.

use super::{Declaration, Expr};
use crate::diagnostic::Origin;

/// `left = right`: both sides are linear in the components of the velocity xi.
#[derive(Clone, Debug)]
pub struct Constraint {
    /// What stands before the sign.
    pub left: Expr,
    /// What stands behind it.
    pub right: Expr,
    /// The whole equation.
    pub origin: Origin,
}

impl Declaration {
    /// Whether the velocity is constrained.
    pub fn is_constrained(&self) -> bool {
        !self.constraint.is_empty()
    }

    /// The sides of all constraints.
    pub fn constrained(&self) -> impl Iterator<Item = &Expr> {
        let constraints = self.constraint.iter();
        constraints.flat_map(|constraint| [&constraint.left, &constraint.right])
    }
}
