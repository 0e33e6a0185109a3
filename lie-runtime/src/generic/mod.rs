//! Plain forms of every kernel and equation, for any system.
//!
//! Generated code overrides them where fusing pays; a test holds each generated kernel equal to the
//! form given here.

mod cayley_midpoint;
mod coordinate_flows;
mod exp_midpoint;
mod gauss;
mod generating;
mod kernels;
mod midpoint;
mod second_kind;
mod series;
mod tableau;

pub use cayley_midpoint::{CayleyMidpoint, CayleyRetraction};
pub use coordinate_flows::CoordinateFlows;
pub use exp_midpoint::{ExpMidpoint, ExpRetraction};
pub use gauss::Gauss;
pub use generating::{
    CayleyGenerating4, Generating2, Generating4, Generating6, SecondKind2, linearize_by_duals,
};
pub use kernels::{ad_star, ad_star_matrix, jacobian, linearize, multiply, vector_field};
pub use midpoint::Midpoint;
pub use second_kind::SecondKind;
pub(crate) use series::{Scratch, coadjoint_action_in};
pub use series::{coadjoint_action, dexp_dual};
pub use tableau::{Tableau, gauss_tableau};
