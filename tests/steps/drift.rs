//! Lengths after many steps: what rounding does to them is a walk and no drift.

use crate::round_off::change;
use lie_runtime::methods::{Method, SphericalMidpoint, Splitting2, Stepper};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use spec_systems::so3_free_rigid_body::{FreeRigidBody, FreeRigidBodySystem};

type Body = FreeRigidBodySystem<f64>;

/// States in all directions.
fn states() -> impl Iterator<Item = [f64; 3]> {
    (1..=8).map(|k| {
        let part = |step: f64| (f64::from(k) * step).fract();
        [
            0.2 + 0.6 * part(0.618),
            0.6 * part(0.755) - 0.7,
            0.3 + 0.6 * part(0.57),
        ]
    })
}

/// The root of the mean square of what `|m|^2` has changed by, relative to itself.
fn drift(advance: impl Fn(&mut [f64; 3])) -> f64 {
    let errors = states().map(|start| {
        let mut state = start;
        advance(&mut state);
        change([1.0; 3], &state, &start) / change([1.0; 3], &start, &[0.0; 3])
    });
    let squares = errors.map(|error| error * error);
    (squares.sum::<f64>() / 8.0).sqrt()
}

fn drift_of(method: &impl Method<f64, Body>, moments: [f64; 3], h: f64, steps: u32) -> f64 {
    let [first, second, third] = moments;
    let body = FreeRigidBody {
        I1: first,
        I2: second,
        I3: third,
    };
    let system = body.system().expect("a body");
    drift(|state| {
        let mut mu = system.zero_state();
        mu.as_mut_slice().copy_from_slice(state);
        let mut stepper = method.stepper(&system, h, &NewtonOptions::default());
        for _ in 0..steps {
            stepper.step(&mut mu, &mut ()).expect("a step");
        }
        state.copy_from_slice(mu.as_slice());
    })
}

/// A symmetric body turns by the same angle in every step.
#[test]
fn equal_rotations_do_not_add_up() {
    const STEPS: u32 = 20_000;
    // the control: by sine and versine, rounded apart
    let control = drift(|[x, y, z]| {
        let tangent = (0.5 * *z).tan();
        let sine = tangent * 2.0 / (1.0 + tangent * tangent);
        let versine = tangent * sine;
        for _ in 0..STEPS {
            (*x, *y) = (
                *x + (*y * sine - *x * versine),
                *y - (*x * sine + *y * versine),
            );
        }
    });
    for h in [0.5, 2.0, 9.0] {
        let (body, method) = ([1.0, 1.0, 2.0 / 3.0], Splitting2::new());
        let found = drift_of(&method, body, h, STEPS);
        let by_coordinate = drift_of(&method.coordinate(), body, h, STEPS);
        for off in [found, by_coordinate] {
            println!("{h}: {off:e}, control {control:e}");
            assert!(off < 6e-14, "{h}: {off:e}");
        }
    }
    assert!(control > 1.5e-13, "{control:e}");
}

/// An iteration for the state at the end stops half a unit of its round-off early, always on the same side.
#[test]
fn iterations_do_not_end_on_one_side() {
    const STEPS: u32 = 10_000;
    let h = 1.0;
    let off = drift_of(&SphericalMidpoint, [2.0, 1.0, 2.0 / 3.0], h, STEPS);
    let control = drift(|mu| {
        for _ in 0..STEPS {
            let square = mu.iter().map(|x| x * x).sum::<f64>();
            let (mut end, mut last) = (*mu, [f64::NAN; 3]);
            for _ in 0..60 {
                if end == last {
                    break;
                }
                last = end;
                let s: [f64; 3] = core::array::from_fn(|i| mu[i] + end[i]);
                let ratio = (square / s.iter().map(|x| x * x).sum::<f64>()).sqrt();
                let [x, y, z] = s.map(|s| ratio * s);
                let moved = [z * (y * 0.5), -z * x, y * (x * 0.5)];
                end = core::array::from_fn(|i| mu[i] + h * moved[i]);
            }
            *mu = end;
        }
    });
    println!("{off:e}, control {control:e}");
    assert!(off < 1.2e-14, "{off:e}");
    assert!(control > 1.6e-14, "{control:e}");
}
