//! Diagnostics against values that are known.

use crate::systems::affine_line::AffineLine;
use crate::systems::rigid_body::RigidBody;
use crate::systems::steps;
use lie_measure::{act_by_exp, integrals, orbit_distance};
use lie_runtime::methods::LieMidpoint;

#[test]
fn the_distance_from_a_sphere() {
    let body = RigidBody::<f64>::default();
    let start = [1.0, 2.0, 2.0].into();
    // anywhere on the sphere of radius 3, also far away
    for end in [[2.0, 1.0, 2.0], [0.0, 0.0, 3.0], [-2.0, 2.0, 1.0]] {
        let distance = orbit_distance(&body, &start, &end.into());
        assert!(distance < 1e-14, "{end:?}: {distance:e}");
    }
    let distance = orbit_distance(&body, &start, &[2.002, 1.001, 2.002].into());
    assert!((distance - 0.002).abs() < 2e-4, "{distance:e}");
}

/// The orbits q > 0 and q < 0 are open: every state of the same half plane is on the orbit, no other one is.
#[test]
fn the_distance_from_an_open_orbit() {
    let line = AffineLine::<f64>::decay();
    let start = [0.5, 1.0].into();
    for end in [[3.0, 0.01], [-40.0, 20.0], [2.4, 0.09], [0.5, 1e-6]] {
        let distance = orbit_distance(&line, &start, &end.into());
        let scale = f64::max(end[0].abs(), end[1]).max(1.0);
        assert!(distance < 1e-14 * scale, "{end:?}: {distance:e}");
    }
    for end in [[0.7, -0.2], [3.0, -5.0], [-1.0, -0.01]] {
        let distance = orbit_distance(&line, &start, &end.into());
        assert!(
            distance > 0.99 * end[1].abs() && distance < 1.5 * end[1].abs(),
            "{end:?}: {distance:e}"
        );
    }
    // large steps of the exponential form, on which the iteration overshoots
    for h in [0.8, -0.8, 1.5] {
        let mut end = start;
        steps(&line, &LieMidpoint::exp(), h, 1, &mut end).expect("a step");
        let distance = orbit_distance(&line, &start, &end);
        let scale = end.amax().max(1.0);
        assert!(distance < 1e-14 * scale, "{h}: {end:?} {distance:e}");
    }
}

#[test]
fn a_rotation_by_exp() {
    let body = RigidBody::<f64>::default();
    let mut mu = [1.0, 0.0, 0.0].into();
    // mu' = ad*_xi mu = mu x xi
    act_by_exp(&body, &[0.0, 0.0, 2.0].into(), &mut mu);
    let expected = [2.0_f64.cos(), -(2.0_f64.sin()), 0.0];
    for (value, expected) in mu.iter().zip(expected) {
        assert!((value - expected).abs() < 1e-14, "{mu:?}");
    }
}

#[test]
fn the_integrals_of_the_rigid_body() {
    let body = RigidBody::<f64>::default();
    let states = [[0.9, 0.3, 0.4].into()];
    assert!(integrals(&body, &states, false).is_empty());
    // the energy and the Casimir
    assert_eq!(integrals(&body, &states, true).len(), 2);
}
