//! Whether a step backwards undoes a step forwards.

use super::any::AnyMethod;
use crate::methods::StepFailure;
use crate::newton::NewtonOptions;
use crate::poisson::Poisson;
use crate::scalar::Scalar;
use crate::state::State;

/// The time-symmetry defect `|Phi_-h(Phi_h(mu)) - mu|` in the maximum norm: zero to round-off for a
/// symmetric method, `O(h^(p+1))` otherwise (p the order, where it is odd; one more where it is even).
///
/// # Errors
/// The [`StepFailure`] of either step.
pub fn symmetry_defect<S: Scalar, P: Poisson<S>>(
    system: &P,
    method: &dyn AnyMethod<S, P>,
    h: S,
    mu: &P::State,
    newton: &NewtonOptions,
) -> Result<S, StepFailure> {
    let mut end = mu.clone();
    method.any_stepper(system, h, newton).step(&mut end)?;
    method.any_stepper(system, -h, newton).step(&mut end)?;
    let pairs = end.as_slice().iter().zip(mu.as_slice());
    Ok(pairs.fold(S::zero(), |largest, (&a, &b)| largest.max((a - b).abs())))
}
