//! Whether a step and a start are what they should be.

use super::kept::Kept;
use crate::methods::{StepFailure, StepReport};
use crate::newton::{FailureReason, NewtonOptions};
use crate::poisson::Poisson;
use crate::scalar::{Mask, Scalar};
use crate::state::Unknown;

/// Halvings of a step that is too large.
const HALVINGS: u32 = 30;

/// The largest of the halves, quarters, … of a step that succeeds from a state, if there is one.
pub(super) fn smaller<S: Scalar, P: Poisson<S>>(
    system: &P,
    method: &Kept<'_, S, P>,
    newton: &NewtonOptions,
    h: f64,
    mu: &P::State,
) -> Option<f64> {
    let mut h = h;
    (0..HALVINGS).find_map(|_| {
        h *= 0.5;
        let mut stepper = method.stepper(system, S::from_f64(h), newton);
        stepper.step(&mut mu.clone(), &mut ()).ok().map(|_| h)
    })
}

/// The energy must be finite after a step, where H is no polynomial: a step may jump over a singularity.
pub(super) fn check_domain<S: Scalar, P: Poisson<S>>(
    system: &P,
    mu: &P::State,
    report: StepReport,
) -> Result<(), StepFailure> {
    if system.hamiltonian_degree().is_some() {
        return Ok(());
    }
    let finite = system.hamiltonian(mu).finite();
    if finite.all() {
        return Ok(());
    }
    Err(StepFailure {
        reason: FailureReason::OutsideDomain,
        lanes: (!finite).bits(),
        report,
    })
}

/// The state, its energy and its velocity must be finite before the first step.
pub(super) fn check_start<S: Scalar, P: Poisson<S>>(
    system: &P,
    mu: &P::State,
) -> Result<(), StepFailure> {
    let mut field = system.zero_state();
    system.vector_field(mu, &mut field);
    let finite = mu.finite() & field.finite() & system.hamiltonian(mu).finite();
    if finite.all() {
        return Ok(());
    }
    Err(StepFailure {
        reason: FailureReason::NotFinite,
        lanes: (!finite).bits(),
        report: StepReport::default(),
    })
}
