//! Whether the generic form of a method makes the steps of the fused one, in as many iterations.

use super::findings::Finding;
use super::ground::Ground;
use super::{PER_STEP, largest, smaller_steps};
use lie_runtime::diagnostics::AnyMethod;
use lie_runtime::methods::StepFailure;
use lie_runtime::newton::NewtonOptions;
use lie_runtime::poisson::Lift;
use lie_runtime::state::State;

/// Steps that are compared.
const STEPS: usize = 3;
/// A difference within this multiple of what round-off at the start changes is round-off.
const NOISE: f64 = 20.0;
/// The iterations of one form over those of the other: a wrong entry of a Jacobian costs more.
const MORE: f64 = 1.25;

/// The end of some steps, and the iterations that they took together.
pub type PlainEnd = (Vec<f64>, u32);

/// Makes so many steps of size h from a state, of a system whose type is forgotten.
pub type PlainSteps = dyn Fn(&[f64], f64, usize) -> Result<PlainEnd, StepFailure>;

/// The largest difference of the states after some steps, relative to the state. It is infinite where one form takes many
/// more iterations than the other, as with a wrong Jacobian: both solve the same equation.
pub(super) fn finding<P: Lift<f64>>(
    system: &P,
    ground: &Ground<P>,
    method: &dyn AnyMethod<f64, P>,
    plain: &PlainSteps,
) -> Finding {
    let newton = NewtonOptions::newton();
    let fused = |mu: &P::State, h: f64, nudge: f64| {
        let (mut end, mut iterations) = (mu.clone(), 0);
        for entry in end.as_mut_slice() {
            *entry *= 1.0 + nudge * f64::EPSILON;
        }
        let mut stepper = method.any_stepper(system, h, &newton);
        for _ in 0..STEPS {
            iterations += stepper.step(&mut end)?.iterations;
        }
        Ok((end, iterations))
    };
    let all = |h: f64| {
        let mut worst = (0.0, 4.0 * PER_STEP * f64::EPSILON);
        let mut work = [0, 0];
        for mu in &ground.states {
            for h in [h, -h, 0.3 * h] {
                let (end, iterations) = fused(mu, h, 0.0)?;
                let (nudged, _) = fused(mu, h, 4.0)?;
                let (generic, other) = plain(mu.as_slice(), h, STEPS)?;
                work = [work[0] + iterations, work[1] + other];
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
                    return Ok((worst, work));
                }
            }
        }
        Ok((worst, work))
    };
    match smaller_steps(ground.step, all) {
        Ok((((value, bound), [own, other]), _)) => {
            let many = f64::from(own.max(other)) > MORE * f64::from(own.min(other));
            let value = if many { f64::INFINITY } else { value };
            Finding::zero("generic form", true, value, bound)
                .note(format!("{own} and {other} iterations"))
        }
        Err(failure) => Finding::unmeasured("generic form", true, &failure),
    }
}
