//! Runtime of lie-poisson: Newton's method, Lie–Poisson integrators, drivers and diagnostics.
#![cfg_attr(not(feature = "std"), no_std)]
#![forbid(unsafe_code)]
#![warn(missing_docs)]

#[cfg(feature = "std")]
pub mod diagnostics;
#[cfg(feature = "std")]
pub mod driver;
pub mod elimination;
pub mod equation;
pub mod generic;
pub mod matrix;
pub mod methods;
pub mod newton;
pub mod parameter;
pub mod poisson;
#[cfg(feature = "std")]
pub mod program;
pub mod scalar;
#[cfg(feature = "sources")]
pub mod sources;
pub mod state;
#[cfg(test)]
mod test_systems;

pub use equation::{
    CayleyEquations, Equation, GaussEquations, LieMidpointEquations, MidpointEquations,
};
#[cfg(feature = "macros")]
pub use lie_macros::lie_poisson;
pub use matrix::{SquareMatrix, StageMatrix};
pub use parameter::ParameterError;
pub use poisson::{CayleyPoisson, LiePoisson, Poisson};
pub use scalar::{Dual, Mask, Scalar};
pub use state::{Stages, State, Unknown};

/// What a program usually needs.
pub mod prelude {
    #[cfg(feature = "std")]
    pub use crate::driver::{
        EveryStep, Observer, Options, Problem, Progress, Save, Solution, SolveError, Stats, Status,
        solve, solve_observed,
    };
    pub use crate::methods::{
        Dopri5, Gauss4, Gauss6, ImplicitMidpoint, LieMidpoint, Method, Rk4, Stepper,
    };
    pub use crate::newton::{Iteration, NewtonOptions};
    #[cfg(feature = "lanes")]
    pub use crate::scalar::{F32x8, F64x4, F64x8};
    pub use crate::{
        CayleyPoisson, Dual, LiePoisson, Mask, ParameterError, Poisson, Scalar, SquareMatrix, State,
    };
    #[cfg(feature = "macros")]
    pub use lie_macros::lie_poisson;
}

/// What generated code refers to. Not for other use: it follows the generator, not semantic
/// versions.
#[doc(hidden)]
pub mod __private {
    pub use crate::elimination::StaticElimination;
    pub use crate::equation::{
        CayleyEquations, Equation, GaussEquations, LieMidpointEquations, MidpointEquations,
    };
    pub use crate::generic;
    pub use crate::matrix::{SquareMatrix, StageMatrix};
    pub use crate::newton::{dense, inverse_pivots_are_safe};
    pub use crate::parameter::{ParameterError, all_finite};
    pub use crate::poisson::{CayleyPoisson, LiePoisson, Poisson};
    pub use crate::scalar::{Mask, Scalar};
    pub use crate::state::{Stages, State, Unknown};
    pub use core::marker::PhantomData;
    pub use nalgebra::{SMatrix, SVector};
}
