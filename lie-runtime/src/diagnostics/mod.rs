//! Measurements of what a method keeps and how fast it converges.
//!
//! Those that compare many methods take them as [`AnyMethod`], which every [`Method`](crate::methods::Method) is;
//! [`verify`](fn@verify::verify) makes all measurements on one system and compares them with what the method
//! claims.

mod any;
mod basis;
mod drift;
mod integrals;
mod newton_order;
mod orbit;
mod order;
mod poisson_defect;
pub(crate) mod random;
mod reference;
mod symmetry;
pub mod verify;

pub(crate) use any::Forgotten;
pub use any::{AnyMethod, AnyStepper, Claims, Motions, Shown};
pub use drift::{Drift, DriftMonitor, InvariantDrift};
pub use integrals::{Integral, integrals};
pub use newton_order::{order_of_iteration, residuals};
pub use orbit::{act_by_exp, orbit_distance};
pub use order::{Order, order_of_convergence};
pub use poisson_defect::{TangentMap, poisson_defect, tangent_map};
pub use reference::{Reference, reference};
pub use symmetry::symmetry_defect;
