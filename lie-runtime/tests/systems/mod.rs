//! Systems written by hand, and what tests do with them.
#![allow(dead_code, reason = "each test file uses a part")]

pub mod affine_line;
pub mod body4;
pub mod folded;
pub mod heavy_top;
pub mod logarithmic;
pub mod nonpolynomial;
pub mod quartic;
pub mod quartic_lagrangian;
pub mod rigid_body;
pub mod saddle;

use lie_runtime::methods::{Method, StepFailure, Stepper};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::{Poisson, Scalar, State};

/// A state from f64 coordinates.
pub fn state<S: Scalar, P: Poisson<S>>(system: &P, coordinates: &[f64]) -> P::State {
    let mut state = system.zero_state();
    for (entry, &coordinate) in state.as_mut_slice().iter_mut().zip(coordinates) {
        *entry = S::from_f64(coordinate);
    }
    state
}

/// Some steps of a method with default options.
pub fn steps<S: Scalar, P: Poisson<S>>(
    system: &P,
    method: &impl Method<S, P>,
    h: f64,
    count: u32,
    mu: &mut P::State,
) -> Result<(), StepFailure> {
    let mut stepper = method.stepper(system, S::from_f64(h), &NewtonOptions::default());
    for _ in 0..count {
        stepper.step(mu, &mut ())?;
    }
    Ok(())
}

/// The largest distance of two states.
pub fn distance<S: Scalar>(a: &impl State<S>, b: &impl State<S>) -> f64 {
    let pairs = a.as_slice().iter().zip(b.as_slice());
    pairs
        .map(|(&a, &b)| (a - b).abs().to_f64())
        .fold(0.0, f64::max)
}
