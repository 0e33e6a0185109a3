//! The numeric core of lie-poisson: what a Lie–Poisson system is, Newton's iteration, and the equations of all
//! integrators, each stated once for any system over any scalar.
//!
//! Users depend on `lie-runtime`, which re-exports these modules and adds the driver and the diagnostics. The compiler
//! depends on this crate too: it runs the same equations over expressions.
#![cfg_attr(doc, doc = include_str!("../docs/katex.html"))]
#![cfg_attr(not(feature = "std"), no_std)]
#![deny(unsafe_code)]
#![warn(missing_docs)]

pub mod clock;
pub mod closed;
pub mod elimination;
pub mod equation;
mod event;
#[cfg(feature = "std")]
pub mod family;
pub mod functions;
pub mod generating;
pub mod generic;
mod generic_equations;
pub mod lagrangian;
pub mod lattice;
pub mod matrix;
pub mod methods;
pub mod newton;
pub mod parameter;
pub mod pieces;
pub mod poisson;
pub mod recurrence;
pub mod scalar;
#[cfg(feature = "sources")]
pub mod sources;
pub mod state;
pub mod structure;
#[cfg(test)]
mod test_systems;

pub use clock::Clock;
pub use equation::{Equation, Implicit};
pub use event::EventRule;
pub use functions::Elementary;
pub use generating::GeneratingFunction;
pub use lagrangian::{DiscreteLagrangian, DiscreteLagrangianPoisson, LagrangianPoisson};
pub use matrix::{SquareMatrix, StageMatrix};
pub use parameter::{ParameterError, ParameterFault};
pub use pieces::{FoundPoisson, PieceFlows, SeparablePoisson};
pub use poisson::{CayleyPoisson, LiePoisson, Lift, Poisson, Widen};
pub use recurrence::{Expand, GradientRecurrence, GradientSeries, Recurrence, Series};
pub use scalar::{Dual, Mask, Scalar};
pub use state::{Stages, State, Unknown};
pub use structure::{
    CanonicalPoisson, ClosedRealization, CollectivePoisson, ColumnPoisson, CotangentPoisson, Group,
    InertiaPoisson, IntegrablePoisson, MatrixGroup, MatrixPoisson, Motion, RealizedPoisson,
    RetractedPoisson, Spectrum, SpinPoisson, UnitaryPoisson, VectorPoisson,
};
