//! Runtime of lie-poisson: Newton's method, Lie–Poisson integrators, drivers and diagnostics.
//!
//! # Convention
//!
//! Left-invariant, the same in every crate of the project. On a Lie algebra with basis `$e_1, …, e_n$`
//! and its dual, with the Hamiltonian `$H$`:
//!
//! ```math
//! [e_i, e_j] = \sum_k C_{ij}^k\, e_k, \qquad
//! \langle \mathrm{ad}^*_\xi \mu, \eta \rangle = \langle \mu, [\xi, \eta] \rangle, \qquad
//! \Pi(\mu)_{ij} = \{\mu_i, \mu_j\} = -\sum_k C_{ij}^k\, \mu_k
//! ```
//!
//! ```math
//! \dot\mu = f(\mu) = \mathrm{ad}^*_{\nabla H(\mu)} \mu = \Pi(\mu)\, \nabla H(\mu), \qquad
//! \dot\mu_j = \sum_{i,k} C_{ij}^k\, \frac{\partial H}{\partial \mu_i}\, \mu_k
//! ```
//!
//! For so(3) this is `$\dot\mu = \mu \times \nabla H(\mu)$`; on the group, `$\dot g = g\, \nabla H(\mu)$`. A
//! right-invariant system is declared as such and is the same with `$-C$` in the place of `$C$`.
//!
//! A Poisson bracket that does not come from an algebra, such as the canonical one, `$\{q, p\} = 1$`, has its own
//! Poisson matrix `$\Pi(\mu)$`, with `$\dot\mu = \Pi(\mu)\, \nabla H(\mu)$`. Such a system implements [`Poisson`], but
//! not [`LiePoisson`].
//!
//! Functions `$C$` with `$\Pi\, \nabla C = 0$` are Casimirs: the flow keeps them whatever the Hamiltonian is.
//!
//! # From a declaration to a trajectory
//!
//! The macro `lie_poisson!` (feature `macros`) makes a type with the parameters; its `system()` implements
//! [`Poisson`], [`LiePoisson`] and the hooks for [`methods`]. A [`driver::Problem`], a method and
//! [`driver::Options`] go to [`driver::solve`] (feature `std`).
#![cfg_attr(
    feature = "macros",
    doc = r#"
```
use lie_runtime::prelude::*;

lie_poisson! {
    pub system RigidBody;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    parameters { I1 = 2.0; I2 = 1.0; I3 = 2/3; }
    hamiltonian = x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3);
    casimir C = x^2 + y^2 + z^2;
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let problem = Problem::new(RigidBody::new().system()?, [0.9, 0.3, 0.4], (0.0, 10.0));
    let solution = solve(&problem, LieMidpoint::exp(), &Options::new(0.1).save(Save::Ends))?;
    println!("{:?}", solution.last());
    Ok(())
}
```
"#
)]
#![cfg_attr(doc, doc = include_str!("../docs/katex.html"))]
#![cfg_attr(not(feature = "std"), no_std)]
#![forbid(unsafe_code)]
#![warn(missing_docs)]

#[cfg(feature = "std")]
pub mod diagnostics;
#[cfg(feature = "std")]
pub mod driver;
#[cfg(feature = "std")]
pub use lie_core::family;
#[cfg(feature = "sources")]
pub mod sources;
#[cfg(test)]
mod test_systems;

pub use lie_core::{
    CanonicalPoisson, CayleyPoisson, Clock, ClosedRealization, CollectivePoisson, ColumnPoisson,
    CotangentPoisson, DiscreteLagrangian, DiscreteLagrangianPoisson, Dual, Elementary, Equation,
    EventRule, Expand, FoundPoisson, GeneratingFunction, GradientRecurrence, GradientSeries, Group,
    Implicit, InertiaPoisson, IntegrablePoisson, LagrangianPoisson, LiePoisson, Lift, Mask,
    MatrixGroup, MatrixPoisson, Motion, ParameterError, ParameterFault, PieceFlows, Poisson,
    RealizedPoisson, Recurrence, RetractedPoisson, Scalar, SeparablePoisson, Series, Spectrum,
    SpinPoisson, SquareMatrix, StageMatrix, Stages, State, UnitaryPoisson, Unknown, VectorPoisson,
    Widen, clock, closed, elimination, equation, functions, generating, generic, generic_equations,
    lagrangian, lattice, matrix, methods, newton, parameter, pieces, poisson, recurrence, scalar,
    state, structure,
};
#[cfg(feature = "macros")]
pub use lie_macros::lie_poisson;
/// The library of the states and matrices of generated systems, in the version that they have.
pub use nalgebra;

/// What a program usually needs.
pub mod prelude {
    #[cfg(feature = "std")]
    pub use crate::diagnostics::{Drift, DriftMonitor};
    #[cfg(feature = "std")]
    pub use crate::driver::{
        EveryStep, Held, Keep, Observer, Options, Problem, Progress, Save, Solution, SolveError,
        Source, Stats, Status, solve, solve_observed,
    };
    #[doc(no_inline)]
    pub use crate::methods::gauss::*;
    pub use crate::methods::{
        Canonical2, Canonical4, Canonical6, CohenHairer2, CohenHairer4, CohenHairer6, CohenHairer8,
        CohenHairer10, CohenHairer12, CohenHairer14, CohenHairer16, Collective2, Collective4,
        Collective6, Collective8, Collective10, Collective12, Collective14, Collective16,
        CommutatorFree4, Compose4, Compose6, Compose8, CrouchGrossman3, DiscreteEulerPoincare,
        Dopri5, EulerArnold2, Exact, Generating2, Generating4, Generating6, GeneratingSecondKind2,
        Gonzalez, HamiltonJacobi2, HamiltonJacobi4, HamiltonJacobi6, ImplicitMidpoint,
        Isospectral2, Isospectral4, Isospectral6, Isospectral8, Isospectral10, Isospectral12,
        Isospectral14, Isospectral16, ItohAbe, LieEuler, LieMidpoint, LieTaylor, MeanValue, Method,
        MoserVeselov, NinomiyaVictoir, OrbitEnergy, Rk4, Rkmk2, Rkmk3, Rkmk4, Rkmk6, Scheme,
        SphericalMidpoint, Splitting1, Splitting2, Splitting4, Splitting6, Splitting8, Stepper,
        Taylor, Variational2, Variational4, Variational6,
    };
    pub use crate::newton::{Convergence, Iteration, NewtonOptions};
    #[cfg(feature = "lanes")]
    pub use crate::scalar::{F32x8, F64x4, F64x8};
    pub use crate::{
        CayleyPoisson, DiscreteLagrangian, DiscreteLagrangianPoisson, Dual, LagrangianPoisson,
        LiePoisson, Lift, Mask, ParameterError, Poisson, Scalar, SquareMatrix, State, Widen,
    };
    #[cfg(feature = "macros")]
    pub use lie_macros::lie_poisson;
}

/// What generated code refers to. Not for other use: it follows the generator, not semantic
/// versions.
#[doc(hidden)]
pub mod __private_0_1 {
    pub use crate::elimination::{Eliminated, FixedElimination, StaticElimination};
    pub use crate::equation::{Equation, Implicit};
    pub use crate::generating::GeneratingFunction;
    pub use crate::generic;
    pub use crate::matrix::{SquareMatrix, StageMatrix};
    pub use crate::newton::{dense, inverse_pivots_are_safe};
    pub use crate::parameter::{ParameterError, all_finite, all_positive};
    pub use crate::pieces::{FoundPoisson, PieceFlows, SeparablePoisson};
    pub use crate::poisson::{CayleyPoisson, LiePoisson, Lift, Poisson, Widen};
    pub use crate::scalar::{Mask, Scalar, declared_derivative, partial};
    pub use crate::state::{Stages, State, Unknown};
    pub use crate::structure::{
        CollectivePoisson, ColumnPoisson, Columns, CotangentPoisson, Entry, Group, InertiaPoisson,
        MatrixGroup, MatrixPoisson, Motion, Plane, Representation, Spectrum, SpinPoisson,
        UnitaryPoisson, VectorPoisson,
    };
    pub use core::marker::PhantomData;
    pub use lie_core::{__entries as entries, __over_scalars as over_scalars};
    pub use nalgebra::{SMatrix, SVector};
}
