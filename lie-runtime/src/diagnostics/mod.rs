//! Measurements of what a method keeps and how fast it converges.

mod drift;
mod order;
mod poisson_defect;

pub use drift::{Drift, DriftMonitor, InvariantDrift};
pub use order::{Order, order_of_convergence};
pub use poisson_defect::poisson_defect;
