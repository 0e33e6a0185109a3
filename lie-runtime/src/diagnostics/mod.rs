//! Measurements of what a method keeps and how fast it converges.
//!
//! Those that compare many methods take them as [`AnyMethod`], which every [`Method`](crate::methods::Method) is. What
//! `lie verify` measures is the crate `lie-measure`. [`verify_step`] measures a step that somebody wrote elsewhere, given as a closure.

mod any;
mod drift;
mod order;
mod poisson_defect;
mod reference;
mod step;
mod symmetry;

pub use crate::methods::any::{AnyStepper, GroupMotion, Motions};
pub use any::{AnyMethod, Claims, Forgotten, ForgottenStepper};
pub use drift::{Drift, DriftMonitor, InvariantDrift};
pub use order::{Order, order_of_convergence};
pub use poisson_defect::{TangentMap, poisson_defect, tangent_map};
pub use reference::{Reference, reference};
pub use step::{Measured, StepVerification, Verdict, verify_step};
pub use symmetry::symmetry_defect;
