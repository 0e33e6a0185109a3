//! Steps of a method from a state, and its order by slope.

use lie_runtime::State;
use lie_runtime::diagnostics::order_of_convergence;
use lie_runtime::methods::{Method, Stepper};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;

use crate::systems::{distance, state};

/// So many steps of size h.
pub fn advance<P: Poisson<f64>>(
    system: &P,
    method: &impl Method<f64, P>,
    h: f64,
    count: u32,
    mu: &mut P::State,
) {
    let mut stepper = method.stepper(system, h, &NewtonOptions::default());
    for _ in 0..count {
        stepper.step(mu, &mut ()).expect("a step");
    }
}

/// The order over a span, from these counts of steps, beside 1,000 of `gauss6`.
pub fn order<P: Poisson<f64>>(
    system: &P,
    method: &impl Method<f64, P>,
    start: &[f64],
    (span, counts): (f64, [u32; 3]),
) -> f64
where
    Gauss6: Method<f64, P>,
{
    let mut reference = state(system, start);
    advance(system, &Gauss6, span / 1000.0, 1000, &mut reference);
    let points = counts.map(|count| {
        let h = span / f64::from(count);
        let mut mu = state(system, start);
        advance(system, method, h, count, &mut mu);
        (h, distance(mu.as_slice(), reference.as_slice()))
    });
    let order = order_of_convergence(&points, 1e-13);
    order.unwrap_or_else(|| panic!("{points:?}")).slope
}
