//! Plain forms of every kernel and equation, for any system.
//!
//! Generated code overrides them where fusing pays; a test holds each generated kernel equal to the
//! form given here.

/// The unknown of an equation is a state of its system.
macro_rules! unknown_of_a_state {
    () => {
        type State = P::State;
        type Unknown = P::State;
        type Matrix = P::Jacobian;

        fn zero_unknown(&self) -> P::State {
            self.system.zero_state()
        }
        fn zero_matrix(&self) -> P::Jacobian {
            self.system.zero_jacobian()
        }
        #[inline(always)]
        fn clock(&self) -> Option<$crate::Clock> {
            self.system.clock()
        }
    };
}
pub(crate) use unknown_of_a_state;

/// The unknown of an equation is a state of its system for each stage.
macro_rules! unknown_of_stages {
    () => {
        type State = P::State;
        type Unknown = $crate::Stages<P::State, STAGES>;
        type Matrix = $crate::StageMatrix<P::Jacobian, STAGES>;

        fn zero_unknown(&self) -> Self::Unknown {
            $crate::Stages($crate::state::copies(&self.system.zero_state()))
        }
        fn zero_matrix(&self) -> Self::Matrix {
            let row = $crate::state::copies(&self.system.zero_jacobian());
            $crate::StageMatrix($crate::state::copies(&row))
        }
        #[inline(always)]
        fn clock(&self) -> Option<$crate::Clock> {
            self.system.clock()
        }
    };
}
use unknown_of_stages;

mod acting;
mod beside;
mod blocks;
mod canonical_gauss;
mod cayley_midpoint;
mod cayley_variational;
mod chart;
mod cohen_hairer;
mod columns;
mod coordinate_flows;
mod declared_midpoint;
mod dexp_series;
mod dexp_slope;
mod diagonals;
mod discrete_body;
mod discrete_gradient;
mod discrete_gradient_step;
mod discrete_top;
mod driven_flows;
mod euler_arnold;
mod exp_midpoint;
mod exp_variational;
mod free_body;
mod friction;
mod frozen_flow;
mod galerkin;
mod gauss;
mod generating;
mod hermitian;
mod inverse_tangent;
mod kernels;
mod lifts;
mod matrix_stages;
mod mean_gradients;
mod metriplectic;
mod midpoint_force;
mod momenta;
mod motion;
mod noise;
mod orbit_beside;
mod orbit_energy;
mod pair;
mod part_flows;
mod power_series;
mod quadrature;
mod quaternion_stages;
mod quaternions;
mod realization;
mod realized;
mod rotation;
mod second_kind;
mod series;
mod spherical;
mod spinors;
mod stage_ending;
mod stage_momenta;
mod stage_parallel;
mod stage_work;
mod tableau;
mod tensor;
mod unitary;
mod words;

pub use crate::methods::equations::*;
pub use canonical_gauss::CanonicalGauss;
pub use cayley_midpoint::{CayleyMidpoint, CayleyRetraction};
pub use cayley_variational::{CayleyDiscrete, CayleyVariational};
pub(crate) use chart::invertible_along;
pub use chart::{CAYLEY_POLE, cayley_chart, cayley_chart_of_step};
pub use cohen_hairer::CohenHairerStep;
pub use columns::{columns_of, flow_of_columns, flow_over_columns, momentum_of_columns};
pub use coordinate_flows::{CoordinateFlows, piece_direction};
pub use declared_midpoint::DeclaredMidpoint;
pub use dexp_slope::dexp_dual_slope;
pub use discrete_body::DiscreteBody;
pub use discrete_gradient::{
    DiscreteGradient, Energy, Entropy, Function, GonzalezGradient, ItohAbeGradient,
    MeanValueGradient, inverse_length,
};
pub use discrete_gradient_step::DiscreteGradientStep;
pub use discrete_top::DiscreteTop;
pub use driven_flows::DrivenFlows;
pub use euler_arnold::{EulerArnoldHalf, Half};
pub use exp_midpoint::{ExpMidpoint, ExpRetraction};
pub use exp_variational::{ExpDiscrete, ExpVariational};
pub use free_body::{FreeBody, principal_axes};
pub use friction::Friction;
pub use frozen_flow::FrozenFlow;
pub use galerkin::{GalerkinAlong, GalerkinCayley, GalerkinOnGroup, GalerkinStep};
pub use gauss::Gauss;
pub use generating::{
    CayleyGenerating4, Generating2, Generating4, Generating6, HamiltonJacobi4, HamiltonJacobi6,
    SecondKind2, linearize_by_duals,
};
pub use inverse_tangent::{dcay_inverse_dual, dexp_inverse_dual};
pub(crate) use kernels::direction;
pub use kernels::{
    ad, ad_star, ad_star_matrix, add_damping, add_damping_slope, casimir_gradient_by_duals,
    euler_poincare, hessian_by_duals, jacobian, jacobian_by_duals, linearize, multiply,
    poisson_slope, vector_field,
};
pub use lifts::LinearLift;
pub use matrix_stages::MatrixStages;
pub use mean_gradients::MeanGradients;
pub use motion::{Coadjoint, Motion};
pub use noise::Noise;
pub(crate) use noise::{excite, quieten};
pub use orbit_energy::{FrozenStep, LeafStep, OrbitEnergyStep};
pub use part_flows::{PartFlows, Parts};
pub use power_series::PowerSeries;
pub use quadrature::{MAX_NODES, Quadrature};
pub use quaternion_stages::QuaternionStages;
pub use quaternion_stages::product as quaternion_product;
pub use quaternions::{flow_of_quaternions, flow_over_quaternions, quaternion_of, vectors_of};
pub use realization::RealizationStep;
pub use realized::{Canonical, Lifting};
pub use second_kind::{Actions, SecondKind, SeriesActions};
pub(crate) use series::{Scratch, coadjoint_action_in, phi1_in};
pub use series::{coadjoint_action, dexp_dual};
pub use spherical::{Spherical, sphere_ratio, sphere_ratios, sphere_ratios_into};
pub use spinors::{flow_of_spinors, flow_over_spins, spinors_of, spins_of};
pub use stage_momenta::{MatrixMomenta, QuaternionMomenta, StageMap, StageMomenta};
#[cfg(feature = "std")]
pub use stage_parallel::program::StageProgram;
pub use stage_parallel::program::{StageSlopes, StageStep, TABLE as STAGE_TABLE};
pub use stage_parallel::{Iterated, StageParallel};
pub use stage_work::{At, Open, Rule};
pub use tableau::{MOST_STAGES, Tableau, gauss_ahead, gauss_ratio, gauss_tableau, gauss_weight};
pub use tensor::{MeanTensor, MidpointTensor, PoissonTensor, TensorFacts};
pub use unitary::{factor_of, flow_of_factor, flow_over_factors, momentum_of_factor};
pub use words::Words;
