//! Plain forms of every kernel and equation, for any system.
//!
//! Generated code overrides them where fusing pays; a test holds each generated kernel equal to the
//! form given here.

mod cayley_midpoint;
mod exp_midpoint;
mod gauss;
mod kernels;
mod midpoint;
mod series;
mod tableau;

pub use cayley_midpoint::CayleyMidpoint;
pub use exp_midpoint::ExpMidpoint;
pub use gauss::Gauss;
pub use kernels::{ad_star, ad_star_matrix, jacobian, linearize, multiply, vector_field};
pub use midpoint::Midpoint;
pub use series::{coadjoint_action, dexp_dual};
pub use tableau::{Tableau, gauss_tableau};
