//! Measurements of integrators, and the programs that the command builds to make them on one system: of `lie verify`
//! ([`Verify`]), `lie bench` ([`Bench`]) and `lie stress` ([`Stress`]).
//!
//! [`facts`] compares everything that a method claims with what is measured; beside it stand the measurements that need
//! nothing but a system and a method. A request names the methods; what is found comes as values of the enum `Found`
//! of each program, by the protocol of [`lie_program`]. When the input ends, a program stops after the measurement that it
//! is at, but not later than two seconds after.

#![forbid(unsafe_code)]
#![warn(missing_docs)]

/// What reads requests and writes messages of a program, compiled here and not with every system.
macro_rules! talk {
    ($options:ty, $found:ty) => {
        impl ::lie_program::protocol::Wire for $found {}

        type Work<'a> = ::lie_program::session::Work<'a, $crate::Request<$options>, $found>;

        fn main(work: &Work<'_>) -> ::std::process::ExitCode {
            ::lie_program::session::main($crate::GRACE, work)
        }
    };
}

mod basis;
pub mod bench;
pub mod facts;
mod integrals;
mod newton_order;
mod orbit;
mod random;
#[cfg(feature = "sources")]
pub mod sources;
pub mod stress;
pub mod verify;

pub use bench::Bench;
pub use integrals::{Integral, integrals};
pub use newton_order::{order_of_iteration, residuals};
pub use orbit::{act_by_exp, orbit_distance};
pub use stress::Stress;
pub use verify::Verify;

use lie_program::protocol::Start;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// How long a measurement may take after the input has ended.
const GRACE: Duration = Duration::from_secs(2);

/// What a program is asked for.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Request<O> {
    /// The labels of the methods.
    pub methods: Vec<String>,
    /// Where the system starts.
    pub start: Start,
    /// What is measured.
    pub options: O,
}
