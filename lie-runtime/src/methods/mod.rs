//! The integrators, one per file, each with its mathematics, what it needs and its reference.
//!
//! With the vector field `$f = \Pi\, \nabla H$`, the step `$h$` and, for the last two rows, a retraction `$\tau$`
//! of the group with its right-trivialised tangent `$\mathrm{d}\tau$`:
//!
//! | method | one step | order |
//! |---|---|---|
//! | [`ImplicitMidpoint`] | `$\mu_1 = \mu + h f\!\left(\tfrac12(\mu + \mu_1)\right)$` | 2 |
//! | [`Gauss4`], [`Gauss6`] | `$Y_i = \mu + h \sum_j a_{ij} f(Y_j), \quad \mu_1 = \mu + h \sum_i b_i f(Y_i)$` | 4, 6 |
//! | [`LieMidpoint::exp`] | `$(\mathrm{d}\tau_x^{-1})^* m = \mu, \quad x = h \nabla H(m), \quad \mu_1 = \mathrm{Ad}^*_{\tau(x)} \mu$`, `$\tau = \exp$` | 2 |
//! | [`LieMidpoint::cayley`] | the same with `$\tau(x) = (1 - x/2)^{-1}(1 + x/2)$` | 2 |
//!
//! [`Rk4`] and [`Dopri5`] keep no structure: they are there to compare with. What a method keeps is data,
//! see [`Facts`].
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

pub mod dopri5;
mod facts;
pub mod gauss;
mod implicit;
pub mod lie_midpoint;
pub mod midpoint;
pub mod rk4;
mod stepper;

pub use dopri5::{Dopri5, Dopri5Stepper};
pub use facts::{Facts, Preserves};
pub use gauss::{Gauss4, Gauss6};
pub use implicit::ImplicitStepper;
pub use lie_midpoint::{Cayley, Exp, LieMidpoint};
pub use midpoint::ImplicitMidpoint;
pub use rk4::{Rk4, Rk4Stepper};
pub use stepper::{FactorSink, Method, Retraction, StepFailure, StepReport, Stepper};
