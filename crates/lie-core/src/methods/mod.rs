//! The integrators, one per file, each with its mathematics, what it needs and its reference.
//!
//! With the vector field `$f = \Pi\, \nabla H$`, the step `$h$` and, for the methods of coadjoint form, a retraction `$\tau$`
//! of the group with its right-trivialised tangent `$\mathrm{d}\tau$`:
//!
//! | method | one step | order |
//! |---|---|---|
//! | [`ImplicitMidpoint`] | `$\mu_1 = \mu + h f\!\left(\tfrac12(\mu + \mu_1)\right)$` | 2 |
//! | [`Gauss4`], [`Gauss6`] | `$Y_i = \mu + h \sum_j a_{ij} f(Y_j), \quad \mu_1 = \mu + h \sum_i b_i f(Y_i)$` | 4, 6 |
//! | [`LieMidpoint::exp`] | `$(\mathrm{d}\tau_x^{-1})^* m = \mu, \quad x = h \nabla H(m), \quad \mu_1 = \mathrm{Ad}^*_{\tau(x)} \mu$`, `$\tau = \exp$` | 2 |
//! | [`LieMidpoint::cayley`] | the same with `$\tau(x) = (1 - x/2)^{-1}(1 + x/2)$` | 2 |
//! | [`Generating2`], [`Generating4`], [`Generating6`] | the same with `$x = \nabla S(m)$`, `$S = h H + h^3 S_3 + h^5 S_5$` | 2, 4, 6 |
//! | [`GeneratingSecondKind2`] | the same in coordinates `$\exp(x_1 e_1) \cdots \exp(x_n e_n)$` | 2 |
//! | [`Gonzalez`], [`MeanValue`], [`ItohAbe`] | `$\mu_1 = \mu + h\, \Pi\!\left(\tfrac12(\mu + \mu_1)\right) \overline\nabla H(\mu, \mu_1)$` | 2 |
//! | [`WithTensor`] | the same with another tensor, `$\tilde\Pi(\mu, \mu_1, h)$` | 2 and more |
//! | [`OrbitEnergy`] | `$\mu_1 = \mathrm{Ad}^*_{\exp(h \overline\nabla H(\mu, \mu_1))}\, \mu$` | 2 |
//! | [`HamiltonJacobi2`], [`HamiltonJacobi4`], [`HamiltonJacobi6`] | `$\mu_1 = y(1)$`, `$\dot y = \Pi(y)\, p$`, `$p = \nabla S(X)$`, X the mean of y, on any bracket | 2, 4, 6 |
//! | [`Canonical2`], [`Canonical4`], [`Canonical6`] | Gauss in coordinates in which the bracket is constant, `$w(\mu_1) = w(\mu) + h \sum_i b_i\, (w' f)(Y_i)$` | 2, 4, 6 |
//! | [`CohenHairer`] | collocation with mean gradients, `$s$` stages | `$2s$` |
//! | [`Isospectral2`], [`Isospectral4`], [`Isospectral6`] | Gauss on `T*V` of a representation V, reduced to g*; also [`Collective`] | 2, 4, 6 |
//! | [`Collective::hopf`] | Gauss on `T*R^2` by the Hopf map, reduced to so(3)* | 2, 4, 6 |
//! | [`ParallelCollective`], [`ParallelIsospectral`] | Gauss on the points of such spaces, of `T*H` for so(3) with vectors, of `C^(N x (N-1))` for su(N) and u(N) | 8, 10, …, 16 |
//! | [`SphericalMidpoint`] | `$\mu_1 = \mu + h f(w)$`, w the midpoint on the sphere of each spin | 2 |
//! | [`Variational2`], [`Variational4`], [`Variational6`] | `$F^+(g) = \mu, \quad \mu_1 = F^-(g)$` of a discrete Lagrangian `$l_d(g)$` | 2, 4, 6 |
//! | [`DiscreteEulerPoincare`] | the same with a declared `$l_d$` | at least 1 |
//! | [`MoserVeselov`] | `$h M = g J - J g^T, \quad M_1 = g^T M g$`, keeps the energy too | 2 |
//! | [`EulerArnold2`] | on `T*G`, for a Hamiltonian of g and mu: `$B_{h/2} \circ A_{h/2}$`, symplectic | 2 |
//!
//! [`Exact`] is the flow itself, where it is known in closed form. Explicit, by exponentials: [`LieEuler`], [`Rkmk2`], [`Rkmk3`], [`Rkmk4`], [`Rkmk6`], [`CrouchGrossman3`]
//! and [`CommutatorFree4`] for any Lie algebra; [`Splitting`] for a Hamiltonian that is a sum of functions
//! of one coordinate each. [`Compose`] makes methods of order 4, 6 and 8 of any symmetric one of order 2.
//!
//! By Taylor series, with order and step from a tolerance: [`Taylor`] of the solution itself, [`LieTaylor`] in the algebra.
//!
//! Every method is made by `new()`, at the defaults of the command line; a choice has a constructor of its own name, as
//! [`LieMidpoint::cayley`] has.
//!
//! Where forces act or damping does, `$\mu' = \Pi(\mu)\, \xi(\mu) + F(\mu)$` ([`Poisson`](crate::Poisson)), [`Facts::FORCES`] and [`Facts::DAMPING`] say
//! which methods apply. Those that take the field alone are what they are. Explicit methods of the algebra act by the affine flows
//! `$\exp(\mathrm{ad}^*_x)\, \mu + \varphi_1(\mathrm{ad}^*_x)\, K$` of pairs (x, K), [`LieMidpoint`], [`Variational`] and [`EulerArnold2`] by the principle of
//! Lagrange and d'Alembert. Discrete
//! gradients, [`OrbitEnergy`] and [`CohenHairer`] balance the energy to round-off. Damping leaves every method of the algebra on the orbit.
//! Linear friction and noise along constant directions are pieces of a [`Splitting`]. Noise is held over a step, with weak order 1; [`Splitting2`] and
//! [`NinomiyaVictoir`] have weak order 2.
//!
//! [`Rk4`] and [`Dopri5`] keep no structure: they are there to compare with. A [`Projection`] keeps energy and Casimirs of any method. What a method keeps is data,
//! see [`Facts`].
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

/// A step of a method is the solution of the equation that a system has for it.
macro_rules! by_equation {
    ([$($parameters:tt)*] $method:ty $(where $($bounds:tt)+)?) => {
        impl<S, P, $($parameters)*> $crate::methods::Method<S, P> for $method
        where
            S: $crate::Scalar,
            P: $crate::Implicit<S, Self>,
            $($($bounds)+)?
        {
            type Stepper<'a>
                = $crate::methods::implicit::ImplicitStepper<S, P::Equation<'a>>
            where
                P: 'a;

            fn stepper<'a>(
                &self,
                system: &'a P,
                h: S,
                newton: &$crate::newton::NewtonOptions,
            ) -> Self::Stepper<'a> {
                let (equation, zero) = (system.equation(self, h), system.zero_state());
                $crate::methods::implicit::ImplicitStepper::new(equation, zero, newton)
            }
        }
    };
}

#[cfg(feature = "std")]
pub mod any;
pub mod canonical;
mod coefficients;
pub mod cohen_hairer;
pub mod collective;
pub mod commutator_free;
pub mod compose;
pub mod crouch_grossman;
mod development;
pub mod discrete_euler_poincare;
pub mod dopri5;
pub mod euler_arnold;
pub mod exact;
mod explicit;
mod facts;
pub mod gauss;
pub mod generating;
pub mod generating_second_kind;
pub mod gonzalez;
pub mod hamilton_jacobi;
mod implicit;
pub mod isospectral;
pub mod itoh_abe;
mod joints;
pub mod lie_euler;
pub mod lie_midpoint;
pub mod lie_taylor;
mod lifted;
mod list;
mod made;
pub mod mean_value;
pub mod midpoint;
pub mod moser_veselov;
pub mod ninomiya_victoir;
pub mod orbit_energy;
pub mod projection;
mod radius;
mod realized;
pub mod rk4;
pub mod rkmk;
pub(crate) mod rough_log;
mod series_stepper;
pub mod spherical_midpoint;
pub mod splitting;
mod stage_parallel;
mod stats;
mod stepper;
pub mod taylor;
pub mod tensor;
mod time_unit;
pub mod variational;

/// Equations that stand in the file of their method: a part of [`generic`](crate::generic).
pub(crate) mod equations {
    pub use super::midpoint::Midpoint;
}

pub use canonical::{Canonical2, Canonical4, Canonical6};
pub use coefficients::Scheme;
pub use cohen_hairer::{
    CohenHairer, CohenHairer2, CohenHairer4, CohenHairer6, CohenHairer8, CohenHairer10,
    CohenHairer12, CohenHairer14, CohenHairer16, MeanField,
};
pub use collective::{
    Collective, Collective2, Collective4, Collective6, Collective8, Collective10, Collective12,
    Collective14, Collective16, Given, Hopf, ParallelCollective, Quaternion, Reduced,
    Representation, Smallest, Unitary,
};
pub use commutator_free::{CommutatorFree4, CommutatorFreeStepper};
pub use compose::{Compose, Compose4, Compose6, Compose8, ComposeStepper};
pub use crouch_grossman::{CrouchGrossman3, CrouchGrossmanStepper};
pub use discrete_euler_poincare::DiscreteEulerPoincare;
pub use dopri5::{Dopri5, Dopri5Stepper};
pub use euler_arnold::{EulerArnold2, EulerArnoldStepper};
pub use exact::{Exact, ExactStepper};
pub use facts::{Facts, Preserves};
pub use gauss::*;
pub use generating::{Generating, Generating2, Generating4, Generating6};
pub use generating_second_kind::GeneratingSecondKind2;
pub use gonzalez::Gonzalez;
pub use hamilton_jacobi::{HamiltonJacobi, HamiltonJacobi2, HamiltonJacobi4, HamiltonJacobi6};
pub use implicit::ImplicitStepper;
pub use isospectral::{
    Isospectral, Isospectral2, Isospectral4, Isospectral6, Isospectral8, Isospectral10,
    Isospectral12, Isospectral14, Isospectral16, ParallelIsospectral,
};
pub use itoh_abe::ItohAbe;
pub use lie_euler::{LieEuler, LieEulerStepper};
pub use lie_midpoint::{Cayley, Declared, Exp, LieMidpoint};
pub use lie_taylor::{LieTaylor, LieTaylorDevelopment};
pub use lifted::{LiftedStepper, StageLift};
pub use made::Tolerances;
pub use mean_value::MeanValue;
pub use midpoint::ImplicitMidpoint;
pub use moser_veselov::{MoserVeselov, MoserVeselovStepper};
pub use ninomiya_victoir::{NinomiyaVictoir, NinomiyaVictoirStepper};
pub use orbit_energy::OrbitEnergy;
pub use projection::{Keep, Levels, MOST_LEVELS, Projection, Unkept};
pub use realized::RealizedStepper;
pub use rk4::{Rk4, Rk4Stepper};
pub use rkmk::{Rkmk2, Rkmk3, Rkmk4, Rkmk6, RkmkStepper};
pub use series_stepper::{Developed, Development, SeriesStepper};
pub use spherical_midpoint::SphericalMidpoint;
pub use splitting::{
    Coordinate, Found, Splitting, Splitting1, Splitting2, Splitting4, Splitting6, Splitting8,
    SplittingStepper,
};
pub use stage_parallel::{Field, MOST_UNKNOWNS, Slopes, StageParallelStepper};
pub use stats::Stats;
pub use stepper::{
    FactorSink, Legs, Method, Relay, Retraction, RungeKutta, Stage, StepFailure, StepReport,
    Stepper,
};
pub use taylor::{Taylor, TaylorDevelopment};
pub use tensor::{
    AlongGradient, MeanTensor, MidpointTensor, PoissonTensor, TensorFacts, WithTensor,
};
pub use variational::{
    CayleyOnGroup, OnGroup, Variational, Variational2, Variational4, Variational6,
};
