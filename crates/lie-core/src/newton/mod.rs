//! Newton's iteration for implicit steps: the equation is [`crate::equation::Equation`], the loop
//! [`Newton`], its start `predictor`, one Jacobian a step `chord`, its stopping rule `convergence`, round-off told from slow convergence `rest`, by what errors are measured `sizes`, the choice between variants `trial`, the update of each variant `update`, elimination
//! [`dense`] and, for lanes with a small pivot, [`pivoted`]; [`exchanging`] is for matrices that are far
//! from the identity.

mod chord;
mod convergence;
mod count;
pub mod dense;
pub mod exchanging;
mod failed;
mod options;
pub mod pivoted;
mod predictor;
mod report;
pub(crate) mod rest;
mod sizes;
mod solver;
mod trial;
mod update;

pub use dense::inverse_pivots_are_safe;
pub use options::{Convergence, Iteration, NewtonOptions};
pub(crate) use predictor::Predictor;
pub use report::{Failure, FailureReason, NewtonReport};
pub use solver::Newton;
pub(crate) use solver::Start;
