//! How fast the iteration behind an implicit step converges.

use lie_runtime::diagnostics::AnyMethod;
use lie_runtime::methods::StepFailure;
use lie_runtime::newton::NewtonOptions;
use lie_runtime::poisson::Poisson;
use lie_runtime::state::Unknown;

/// The residuals of one step, iteration by iteration, from the first guess on, and the number of iterations
/// that the step takes by itself.
///
/// Iterations are cut off after 1, 2, 3, …: the solver needs no window for this. Of a method that solves
/// several equations in one step, the residuals of the first.
///
/// # Errors
/// The [`StepFailure`] of a step that does not converge at all.
pub fn residuals<P: Poisson<f64>>(
    system: &P,
    method: &dyn AnyMethod<f64, P>,
    h: f64,
    mu: &P::State,
) -> Result<(Vec<f64>, u32), StepFailure> {
    let own = NewtonOptions::newton();
    let mut state = mu.clone();
    let iterations = method
        .any_stepper(system, h, &own)
        .step(&mut state)?
        .iterations;
    let mut residuals = Vec::new();
    for max_iterations in 1..=iterations.clamp(1, 30) + 2 {
        // no prediction: the iteration goes on until the updates are round-off
        let options = NewtonOptions {
            max_iterations,
            tolerance: 0.0,
            ..own
        };
        let mut state = mu.clone();
        match method.any_stepper(system, h, &options).step(&mut state) {
            Ok(report) => {
                residuals.push(report.residual);
                break;
            }
            Err(failure) => residuals.push(failure.report.residual),
        }
    }
    Ok((residuals, iterations))
}

/// The order of convergence that residuals show: 2 for Newton's method, 1 for an iteration with a wrong or
/// simplified Jacobian. None if they come to round-off too soon to tell.
///
/// It is `log(r2/r1)/log(r1/r0)` of the last three above `floor`, or, if that says more, of the last two above it
/// with the floor for the third.
pub fn order_of_iteration(residuals: &[f64], floor: f64) -> Option<f64> {
    let order = |r0: f64, r1: f64, r2: f64| {
        if r1 < r0 {
            (r2 / r1).ln() / (r1 / r0).ln()
        } else {
            0.0
        }
    };
    let above = residuals.iter().take_while(|&&r| r > floor).count();
    let last = |count: usize| residuals[..above].get(above.checked_sub(count)?..);
    let seen = last(3).map(|r| order(r[0], r[1], r[2]));
    let at_least = match last(2) {
        Some(&[r0, r1]) if above < residuals.len() => Some(order(r0, r1, floor)),
        _ => None,
    };
    match (seen, at_least) {
        (Some(seen), Some(at_least)) => Some(f64::max(seen, at_least)),
        (Some(seen), None) => Some(seen),
        // two residuals above round-off: only a high order can be told
        (None, at_least) => at_least.filter(|&order| order > 1.5),
    }
}

/// The size below which a residual is round-off.
pub(crate) fn residual_floor<V: Unknown<f64>>(mu: &V) -> f64 {
    8.0 * f64::EPSILON * mu.max_norm()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quadratic_and_linear() {
        let quadratic = order_of_iteration(&[1e-1, 1e-3, 1e-7, 1e-15], 1e-15);
        assert!((quadratic.unwrap() - 2.0).abs() < 1e-9, "{quadratic:?}");
        let linear = order_of_iteration(&[1e-1, 1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13], 1e-16);
        assert!((linear.unwrap() - 1.0).abs() < 1e-9, "{linear:?}");
        assert_eq!(order_of_iteration(&[1e-3, 1e-16], 1e-16), None);
        assert_eq!(order_of_iteration(&[], 1e-16), None);
    }
}
