//! Newton's iteration for implicit steps: the equation is [`crate::equation::Equation`], the loop
//! [`Newton`], its stopping rule `convergence`, the choice between variants `trial`, the update of each variant `update`, elimination
//! [`dense`] and, for lanes with a small pivot, [`pivoted`]; [`exchanging`] is for matrices that are far
//! from the identity.

mod convergence;
pub mod dense;
pub mod exchanging;
mod options;
pub mod pivoted;
mod report;
mod solver;
mod trial;
mod update;

pub use dense::inverse_pivots_are_safe;
pub use options::{Convergence, Iteration, NewtonOptions};
pub use report::{Failure, FailureReason, NewtonReport};
pub use solver::Newton;
