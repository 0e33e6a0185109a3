//! The exact flow: free rigid bodies against the reference values, near the separatrix and for any symmetric matrix; constant
//! velocities; what is kept.

use crate::systems;
use crate::vectors;

use crate::round_off::change;
use crate::systems::{Declared, FreeRigidBody, distance};
use crate::vectors::Reference;
use lie_runtime::diagnostics::poisson_defect;
use lie_runtime::lie_poisson;
use lie_runtime::methods::{Exact, Facts as _, Gauss16, Method, Stepper};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;

lie_poisson! {
    /// A body whose axes are not those of the basis.
    system Oblique;
    algebra {
        basis e1, e2, e3;
        [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2;
    }
    state x, y, z;
    hamiltonian = 0.7*x^2 + 0.4*y^2 + 0.55*z^2 + 0.15*x*y - 0.2*y*z + 0.1*x*z;
}

lie_poisson! {
    /// Two bodies that do not know of each other, the second with another bracket.
    system Pair;
    algebra {
        basis e1, e2, e3, f1, f2, f3;
        [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2;
        [f1, f2] = -2*f3; [f2, f3] = -2*f1; [f3, f1] = -2*f2;
    }
    state x, y, z, u, v, w;
    hamiltonian = x^2 + y^2/2 + z^2/3 + u^2/4 + v*w;
}

lie_poisson! {
    /// A velocity that does not change.
    system Linear;
    algebra {
        basis J, P1, P2;
        [J, P1] = P2; [J, P2] = -P1;
    }
    state m, p, q;
    hamiltonian = 0.3*p - 0.2*q + 1.1*m;
}

lie_poisson! {
    /// A function of coordinates that commute.
    system Commuting;
    algebra {
        basis J, P1, P2;
        [J, P1] = P2; [J, P2] = -P1;
    }
    state m, p, q;
    hamiltonian = sin(p) + p*q^2;
}

fn walk<P: Poisson<f64>>(
    system: &P,
    method: &impl Method<f64, P>,
    mu: &mut P::State,
    h: f64,
    steps: usize,
) {
    let mut stepper = method.stepper(system, h, &NewtonOptions::default());
    for _ in 0..steps {
        stepper.step(mu, &mut ()).expect("the step is made");
    }
}

#[test]
fn the_rigid_body_is_where_the_reference_has_it() {
    let reference = Reference::vector(FreeRigidBody::FILE);
    let system = FreeRigidBody::declared::<f64>();
    for (time, expected) in reference.times().iter().zip(reference.states()) {
        let time = vectors::number(&serde_json::json!(time));
        for steps in [1_u32, 7, 200] {
            let mut mu = FreeRigidBody::initial::<f64>();
            walk(
                &system,
                &Exact,
                &mut mu,
                time / f64::from(steps),
                steps as usize,
            );
            let off = distance(mu.as_slice(), &expected);
            println!("t = {time} in {steps} steps: {off:e}");
            // round-off of each step, and of the turns that are made
            assert!(
                off < 4e-16 * (8.0 + time + f64::from(steps)),
                "{time} {steps}: {off:e}"
            );
        }
    }
}

/// One step of any size is many small ones by a method of order 16.
#[test]
fn a_step_is_the_flow() {
    fn check<P: Lift<f64> + Widen<f64>>(system: &P, start: &[f64], bound: f64)
    where
        Exact: Method<f64, P>,
    {
        for h in [1e-6, 0.01, 1.0, -3.0, 20.0] {
            let mut mu = system.zero_state();
            mu.as_mut_slice().copy_from_slice(start);
            let mut fine = mu.clone();
            walk(system, &Exact, &mut mu, h, 1);
            walk(system, &Gauss16, &mut fine, h / 256.0, 256);
            let off = distance(mu.as_slice(), fine.as_slice());
            println!("h = {h}: {off:e}");
            assert!(off < bound, "{h}: {off:e}");
        }
    }
    check(
        &Oblique::default().system().unwrap(),
        &[0.9, -0.4, 0.7],
        2e-14,
    );
    check(
        &Oblique::default().system().unwrap(),
        &[0.0, 0.0, 0.0],
        1e-300,
    );
    check(
        &Pair::default().system().unwrap(),
        &[0.9, -0.4, 0.7, 0.3, 1.1, -0.6],
        1e-13,
    );
    check(
        &Linear::default().system().unwrap(),
        &[0.9, -0.4, 0.7],
        2e-14,
    );
    check(
        &Commuting::default().system().unwrap(),
        &[0.9, -0.4, 0.7],
        2e-13,
    );
}

/// Beside the separatrix, where a step passes the unstable axis slowly, and with equal moments.
#[test]
fn every_body_and_every_state() {
    let body = |moments: [f64; 3]| {
        systems::so3_free_rigid_body::FreeRigidBody {
            I1: moments[0],
            I2: moments[1],
            I3: moments[2],
        }
        .system()
        .unwrap()
    };
    for moments in [
        [1.0, 2.0, 3.0],
        [3.0, 1.0, 2.0],
        [2.0, 2.0, 1.0],
        [1.0, 1.0, 1.0],
        [1.0, 1.0 + 1e-12, 3.0],
    ] {
        let system = body(moments);
        for tilt in [0.0, 1e-12, 1e-6, 0.1] {
            let mut mu = system.zero_state();
            mu.as_mut_slice().copy_from_slice(&[tilt, 1.0, 0.5 * tilt]);
            let (mut fine, start) = (mu, mu);
            walk(&system, &Exact, &mut mu, 12.0, 1);
            walk(&system, &Gauss16, &mut fine, 12.0 / 512.0, 512);
            let off = distance(mu.as_slice(), fine.as_slice());
            println!("{moments:?} {tilt:e}: {off:e}");
            assert!(off < 1e-13, "{moments:?} {tilt:e}: {off:e}");
            walk(&system, &Exact, &mut mu, -12.0, 1);
            let back = distance(mu.as_slice(), start.as_slice());
            assert!(
                back < 1e-13,
                "{moments:?} {tilt:e}: {back:e} there and back"
            );
        }
    }
}

#[test]
fn what_is_kept() {
    let system = Oblique::default().system().unwrap();
    let mut mu = system.zero_state();
    mu.as_mut_slice().copy_from_slice(&[0.9, -0.4, 0.7]);
    let (h, lifted) = (5.0, system.lift());
    let defect =
        poisson_defect(&lifted, &Exact, h, mu.as_slice(), &NewtonOptions::default()).unwrap();
    let control = poisson_defect(
        &lifted,
        &Gauss16,
        h,
        mu.as_slice(),
        &NewtonOptions::default(),
    )
    .unwrap();
    println!("{} {defect:e}, gauss16 {control:e}", Exact::ID);
    assert!(defect < 2e-14 && control > 1e-8, "{defect:e} {control:e}");
    let (energy, length) = (system.hamiltonian(&mu), mu.norm_squared());
    walk(&system, &Exact, &mut mu, h, 100_000);
    let off = (system.hamiltonian(&mu) - energy).abs();
    let off = off.max((mu.norm_squared() - length).abs());
    println!("energy and length move by {off:e}");
    assert!(off < 1e-12, "{off:e}");
}

/// The largest change of `|m|^2` and of the energy, relative to themselves; the control begins anew at every step.
fn largest_change(moments: [f64; 3], h: f64, steps: usize, anew: bool) -> f64 {
    let system = moments_of(moments);
    let start = [0.499_193_886_206_320_2, 1.186_821_513_974_446_7, 0.477];
    let mut mu = system.zero_state();
    mu.as_mut_slice().copy_from_slice(&start);
    let mut stepper = Exact.stepper(&system, h, &NewtonOptions::default());
    let mut worst: f64 = 0.0;
    for step in 1..=steps {
        if anew {
            stepper = Exact.stepper(&system, h, &NewtonOptions::default());
        }
        stepper.step(&mut mu, &mut ()).expect("the step is made");
        if step % 101 == 0 || step == steps {
            for weights in [[1.0; 3], moments.map(|moment| 1.0 / moment)] {
                let size = change(weights, &start, &[0.0; 3]);
                worst = worst.max((change(weights, mu.as_slice(), &start) / size).abs());
            }
        }
    }
    worst
}

fn moments_of([i1, i2, i3]: [f64; 3]) -> systems::so3_free_rigid_body::FreeRigidBodySystem<f64> {
    systems::so3_free_rigid_body::FreeRigidBody {
        I1: i1,
        I2: i2,
        I3: i3,
    }
    .system()
    .unwrap()
}

/// On one orbit the rounding of every step is the same; a step that knows where the orbit began does not add it up.
#[test]
fn invariants_do_not_drift() {
    for (moments, h) in [
        ([1.0, 1.0, 2.0 / 3.0], 0.5),
        ([2.0, 1.0, 2.0 / 3.0], 0.15),
        ([1.3, 0.7, 1.1], 7.0),
    ] {
        let worst = largest_change(moments, h, 150_000, false);
        let control = largest_change(moments, h, 30_000, true);
        println!("{moments:?}: {worst:e}, control {control:e}");
        assert!(worst < 4e-16, "{moments:?}: {worst:e}");
        assert!(control > 2e-15, "{moments:?}: {control:e}");
    }
}

/// Powers of two in the state, the moments and the time change nothing but exponents.
#[test]
fn units_do_not_matter() {
    let [moments, start, h] = [[2.0, 1.0, 2.0 / 3.0], [0.4, -0.9, 0.7], [0.3; 3]];
    let run = |state: i32, moment: i32| {
        let two = |power: i32| 2.0_f64.powi(power);
        let system = moments_of(moments.map(|i| i * two(moment)));
        let mut mu = system.zero_state();
        let scaled = start.map(|entry| entry * two(state));
        mu.as_mut_slice().copy_from_slice(&scaled);
        let h = h[0] * two(moment) * two(-state);
        walk(&system, &Exact, &mut mu, h, 200);
        let back = mu.as_slice().iter().map(|entry| entry * two(-state));
        back.collect::<Vec<f64>>()
    };
    let expected = run(0, 0);
    for state in [-500, -300, -200, -150, -20, 1, 20, 100, 200, 300, 500] {
        assert_eq!(run(state, 0), expected, "2^{state}");
        assert_eq!(run(0, state), expected, "moments 2^{state}");
    }
    assert_eq!(run(-113, -155), expected);
}

/// At the unstable equilibrium, on the separatrix, and near it where a step passes the other equilibrium.
#[test]
fn long_steps_at_the_separatrix() {
    let system = moments_of([1.0, 0.5, 1.0 / 3.0]);
    for h in [1e-3, 30.0, 250.0, 1e3, 1e6, 1e100] {
        for start in [[0.0, 1.0, 0.0], [0.0, -0.7, 0.0], [0.6, 0.5, 0.6]] {
            let mut mu = system.zero_state();
            mu.as_mut_slice().copy_from_slice(&start);
            let mut stepper = Exact.stepper(&system, h, &NewtonOptions::default());
            stepper.step(&mut mu, &mut ()).expect("the step is made");
            let length = change([1.0; 3], &start, &[0.0; 3]);
            let off = change([1.0; 3], mu.as_slice(), &start).abs() / length;
            assert!(off < 1e-15, "{start:?} {h}: {mu:?}");
            if start[0] == 0.0 {
                assert!(distance(mu.as_slice(), &start) < 2e-16, "{h}: {mu:?}");
            } else if h > 20.0 && h < 1e3 {
                // the end of the separatrix, at the speed 2 m/sqrt(2)
                let left = mu.as_slice()[0].hypot(mu.as_slice()[2]);
                assert!(left < 1e-8, "{start:?} {h}: {mu:?}");
            }
        }
    }
}
