//! Whether a step that fails leaves the state as it was.

use super::Subject;
use super::findings::Finding;
use super::ground::Ground;
use lie_runtime::newton::NewtonOptions;
use lie_runtime::poisson::Lift;
use lie_runtime::state::State;

/// A step at which numbers overflow, in units of the step of the measurements.
const BEYOND: f64 = 1e300;

/// How many of the steps that must fail, or do, change the state or say that they succeeded.
///
/// An implicit method has no step without an iteration. Steps beyond all numbers may succeed where a method is exact.
pub(super) fn finding<P: Lift<f64>>(
    system: &P,
    ground: &Ground<P>,
    subject: &Subject<P>,
) -> Finding {
    let method = &*subject.method;
    let usual = NewtonOptions::default();
    let none = NewtonOptions {
        max_iterations: 0,
        ..usual
    };
    let same = |a: &P::State, b: &P::State| {
        let mut pairs = a.as_slice().iter().zip(b.as_slice());
        pairs.all(|(a, b)| a.to_bits() == b.to_bits())
    };
    let mut wrong = 0_u32;
    for mu in &ground.states {
        let mut check = |h: f64, newton: &NewtonOptions, must_fail: bool| {
            let mut state = mu.clone();
            wrong += match method.any_stepper(system, h, newton).step(&mut state) {
                Ok(_) => u32::from(must_fail),
                Err(failure) => u32::from(failure.lanes != 1 || !same(&state, mu)),
            };
        };
        let iterates = {
            let mut state = mu.clone();
            let step = method
                .any_stepper(system, ground.step, &usual)
                .step(&mut state);
            step.is_ok_and(|report| report.iterations > 0)
        };
        if iterates {
            check(ground.step, &none, true);
        }
        // an adaptive method would go there in millions of steps
        if subject.with_tolerance.is_none() {
            check(BEYOND * ground.step, &usual, false);
        }
    }
    Finding::exact("failed steps", f64::from(wrong))
}
