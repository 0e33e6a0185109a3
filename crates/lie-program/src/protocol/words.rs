//! Types of the runtime as serde writes them.

use super::number;
use lie_runtime::driver::{Density, Pace};
use lie_runtime::methods::{Keep, Tolerances};
use lie_runtime::newton::{Convergence, Iteration, NewtonOptions};
use serde::{Deserialize, Serialize};

/// [`Iteration`] in words.
#[derive(Deserialize, Serialize)]
#[serde(remote = "Iteration", rename_all = "kebab-case")]
pub(super) enum IterationInWords {
    Automatic,
    Newton,
    Simplified,
    FixedPoint,
}

/// [`Convergence`] in words.
#[derive(Deserialize, Serialize)]
#[serde(remote = "Convergence", rename_all = "kebab-case")]
pub(super) enum ConvergenceInWords {
    Claimed,
    State,
    Tolerance,
    Map,
}

/// [`Pace`] in words.
#[derive(Deserialize, Serialize)]
#[serde(remote = "Pace", rename_all = "kebab-case")]
pub(super) enum PaceInWords {
    Step(#[serde(with = "number")] f64),
    Tolerance(#[serde(with = "number")] f64),
}

/// [`Density`] in words.
#[derive(Deserialize, Serialize)]
#[serde(remote = "Density", rename_all = "kebab-case")]
pub(super) enum DensityInWords {
    Constant,
    Reversible,
}

/// The fields of [`NewtonOptions`].
#[derive(Deserialize, Serialize)]
#[serde(remote = "NewtonOptions", deny_unknown_fields)]
pub(super) struct NewtonFields {
    #[serde(with = "IterationInWords")]
    iteration: Iteration,
    #[serde(with = "number")]
    tolerance: f64,
    max_iterations: u32,
    #[serde(with = "ConvergenceInWords")]
    convergence: Convergence,
}

/// The fields of [`Keep`].
#[derive(Deserialize, Serialize)]
#[serde(remote = "Keep", deny_unknown_fields)]
pub(super) struct KeepFields {
    energy: bool,
    casimirs: bool,
}

/// The fields of [`Tolerances`].
#[derive(Deserialize, Serialize)]
#[serde(remote = "Tolerances", deny_unknown_fields)]
pub(super) struct TolerancesFields {
    #[serde(with = "number")]
    rtol: f64,
    #[serde(with = "number")]
    atol: f64,
}
