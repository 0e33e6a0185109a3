//! Realizations in canonical coordinates.

use lie_symbolic::symbolic::ExprId;
use lie_syntax::ast::Name;
use lie_syntax::diagnostic::Origin;

/// [`Symbol::Input`](lie_symbolic::symbolic::Symbol::Input) of the first canonical coordinate of a realization: beyond all other inputs.
pub const CANONICAL: usize = 1 << 20;

/// A verified realization of the bracket: a Poisson map from canonical coordinates.
#[derive(Clone, Debug)]
pub struct Realization {
    /// Names of the positions, then of the momenta.
    pub names: Vec<Name>,
    /// The component of each coordinate of the state; position k is the input `CANONICAL + k`.
    pub map: Vec<ExprId>,
    /// Where the components stand.
    pub origins: Vec<Origin>,
    /// A point near which points over a state are sought.
    pub start: Vec<ExprId>,
    /// Whether the declaration gives it.
    pub given: bool,
    /// Whether Gauss methods over it are methods for the state.
    pub descent: Descent,
}

/// Whether the Gauss methods for `H o J`, J a realization, descend to the state J(z).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Descent {
    /// They do.
    Closed,
    /// The components are not of degree at most two, or it could not be shown that they are.
    Degree,
    /// The closure of the components adds functions that the state does not determine, and that commute with them or
    /// not.
    Adds {
        /// Whether they do.
        commuting: bool,
    },
    /// The closure could not be found: a coefficient is not rational, or there are too many of them.
    Unknown,
}
