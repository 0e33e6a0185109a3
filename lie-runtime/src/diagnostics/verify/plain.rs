//! Whether the generic form of a method makes the steps of the fused one.

use super::findings::Finding;
use super::ground::Ground;
use super::{PER_STEP, Subject, largest, smaller_steps};
use crate::methods::StepFailure;
use crate::newton::NewtonOptions;
use crate::poisson::Lift;
use crate::state::State;

/// Steps that are compared.
const STEPS: usize = 3;
/// A difference within this multiple of what round-off at the start changes is round-off.
const NOISE: f64 = 20.0;

/// Makes so many steps of size h from a state, of a system whose type is forgotten.
pub type PlainSteps = dyn Fn(&[f64], f64, usize) -> Result<Vec<f64>, StepFailure>;

/// The largest difference of the states after some steps, relative to the state; none where there is one form only.
pub(super) fn finding<P: Lift<f64>>(
    system: &P,
    ground: &Ground<P>,
    subject: &Subject<P>,
) -> Option<Finding> {
    let plain = subject.plain.as_ref()?;
    let newton = NewtonOptions::default();
    let fused = |mu: &P::State, h: f64, nudge: f64| {
        let mut end = mu.clone();
        for entry in end.as_mut_slice() {
            *entry *= 1.0 + nudge * f64::EPSILON;
        }
        let mut stepper = subject.method.any_stepper(system, h, &newton);
        for _ in 0..STEPS {
            stepper.step(&mut end)?;
        }
        Ok(end)
    };
    let all = |h: f64| {
        let mut worst = (0.0, 4.0 * PER_STEP * f64::EPSILON);
        for mu in &ground.states {
            for h in [h, -h, 0.3 * h] {
                let end = fused(mu, h, 0.0)?;
                let nudged = fused(mu, h, 4.0)?;
                let generic = plain(mu.as_slice(), h, STEPS)?;
                let distance = |other: &[f64]| {
                    let pairs = other.iter().zip(end.as_slice());
                    let gaps: Vec<f64> = pairs.map(|(a, b)| a - b).collect();
                    let invalid = gaps.iter().any(|gap| gap.is_nan());
                    if invalid {
                        f64::NAN
                    } else {
                        largest(&gaps) / largest(end.as_slice())
                    }
                };
                let bound = 4.0 * PER_STEP * f64::EPSILON + NOISE * distance(nudged.as_slice());
                let value = distance(&generic);
                if value.is_nan() || value / bound > worst.0 / worst.1 {
                    worst = (value, bound);
                }
                if value.is_nan() {
                    return Ok(worst);
                }
            }
        }
        Ok(worst)
    };
    Some(match smaller_steps(ground.step, all) {
        Ok(((value, bound), _)) => Finding::zero("generic form", true, value, bound),
        Err(failure) => Finding::unmeasured("generic form", true, &failure),
    })
}
