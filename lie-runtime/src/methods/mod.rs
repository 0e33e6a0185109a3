//! The integrators, one per file, each with its mathematics, what it needs and its reference.

mod dopri5;
mod facts;
mod gauss;
mod implicit;
mod lie_midpoint;
mod midpoint;
mod rk4;
mod stepper;

pub use dopri5::{Dopri5, Dopri5Stepper};
pub use facts::{Facts, Preserves};
pub use gauss::{Gauss4, Gauss6};
pub use implicit::ImplicitStepper;
pub use lie_midpoint::{Cayley, CoadjointStepper, Exp, LieMidpoint};
pub use midpoint::ImplicitMidpoint;
pub use rk4::{Rk4, Rk4Stepper};
pub use stepper::{FactorSink, Method, Retraction, StepFailure, StepReport, Stepper};
