//! Steps that are written here, measured beside what is claimed of them.

use std::convert::Infallible;

use lie_runtime::diagnostics::{Claims, StepVerification, Verdict, verify_step};
use lie_runtime::methods::Preserves;
use lie_runtime::prelude::*;

lie_poisson! {
    system RigidBody;
    algebra = so(3);
    state x, y, z;
    hamiltonian = (x^2 + y^2/2 + z^2/3)/2;
    casimir C = x^2 + y^2 + z^2;
    methods = [rk4];
}

type Body = RigidBodySystem<f64>;
type Vector = lie_runtime::nalgebra::Vector3<f64>;

/// The implicit midpoint rule, by fixed-point iteration.
fn midpoint(body: &Body, mu: &mut Vector, h: f64) -> Result<(), Infallible> {
    let (mut next, mut field) = (*mu, *mu);
    for _ in 0..100 {
        body.vector_field(&((*mu + next) / 2.0), &mut field);
        next = *mu + h * field;
    }
    *mu = next;
    Ok(())
}

/// Rotations about the axes, there and back: the flows of `x^2/2 I1`, `y^2/2 I2`, `z^2/2 I3`, each exact.
fn rotations(body: &Body, mu: &mut Vector, h: f64) -> Result<(), Infallible> {
    let mut gradient = *mu;
    for (axis, part) in [(0, 0.5), (1, 0.5), (2, 1.0), (1, 0.5), (0, 0.5)] {
        body.gradient(mu, &mut gradient);
        let (sine, cosine) = (part * h * gradient[axis]).sin_cos();
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        (mu[i], mu[j]) = (cosine * mu[i] + sine * mu[j], cosine * mu[j] - sine * mu[i]);
    }
    Ok(())
}

fn verify(
    claims: &Claims,
    step: impl Fn(&Body, &mut Vector, f64) -> Result<(), Infallible>,
) -> StepVerification {
    let body = RigidBody::new().system().expect("finite parameters");
    let found = verify_step(&body, &[0.9, 0.3, 0.4].into(), 0.4, claims, |mu, h| {
        step(&body, mu, h)
    });
    found.unwrap_or_else(|never| match never {})
}

fn verdict(found: &StepVerification, fact: &str) -> Verdict {
    found.of(fact).expect("it is measured").verdict()
}

const MIDPOINT: Claims = Claims {
    order: 2,
    symmetric: true,
    preserves: Preserves::QUADRATIC,
    ..Claims::NONE
};
const ROTATIONS: Claims = Claims {
    order: 2,
    symmetric: true,
    preserves: Preserves::POISSON,
    ..Claims::NONE
};

#[test]
fn what_holds_is_confirmed() {
    for (claims, step) in [
        (MIDPOINT, midpoint as fn(&_, &mut _, _) -> _),
        (ROTATIONS, rotations),
    ] {
        let found = verify(&claims, step);
        assert!(found.is_confirmed(), "{found}");
    }
    let found = verify(&MIDPOINT, midpoint);
    assert_eq!(
        verdict(&found, "energy"),
        Verdict::Confirmed,
        "it is quadratic"
    );
    assert_eq!(verdict(&found, "Poisson"), Verdict::Absent, "{found}");
    let found = verify(&ROTATIONS, rotations);
    assert_eq!(verdict(&found, "energy"), Verdict::Absent, "{found}");
    assert_eq!(
        verdict(&verify(&Claims::NONE, rotations), "Poisson"),
        Verdict::Unclaimed
    );
}

#[test]
fn what_does_not_hold_is_violated() {
    let wrong = |claims: Claims, fact: &str, step: fn(&_, &mut _, _) -> _| {
        let found = verify(&claims, step);
        assert_eq!(verdict(&found, fact), Verdict::Violated, "{fact}\n{found}");
        assert!(!found.is_confirmed());
    };
    wrong(
        Claims {
            order: 3,
            ..MIDPOINT
        },
        "order",
        midpoint,
    );
    wrong(
        Claims {
            preserves: Preserves::POISSON,
            ..MIDPOINT
        },
        "Poisson",
        midpoint,
    );
    wrong(
        Claims {
            preserves: Preserves::ENERGY,
            ..ROTATIONS
        },
        "energy",
        rotations,
    );
    // a sign
    let backwards = |body: &Body, mu: &mut Vector, h: f64| rotations(body, mu, -h);
    assert_eq!(
        verdict(&verify(&ROTATIONS, backwards), "order"),
        Verdict::Violated
    );
    // half of it
    let first = |body: &Body, mu: &mut Vector, h: f64| {
        let mut field = *mu;
        body.vector_field(mu, &mut field);
        *mu += h * field;
        Ok(())
    };
    let found = verify(
        &Claims {
            symmetric: true,
            preserves: Preserves::ORBIT,
            ..Claims::NONE
        },
        first,
    );
    for fact in ["symmetric", "quadratic Casimirs"] {
        assert_eq!(verdict(&found, fact), Verdict::Violated, "{found}");
    }
    assert_eq!(verdict(&found, "order"), Verdict::Confirmed);
}

/// At a short step a method that keeps nothing passes as well, and nothing is decided.
#[test]
fn a_short_step_decides_nothing() {
    let body = RigidBody::new().system().expect("finite parameters");
    let mu = [0.9, 0.3, 0.4].into();
    let found = verify_step(&body, &mu, 1e-4, &MIDPOINT, |mu, h| midpoint(&body, mu, h));
    let found = found.unwrap_or_else(|never| match never {});
    assert_eq!(verdict(&found, "symmetric"), Verdict::Undecided, "{found}");
    assert!(!found.is_confirmed());
    assert!(found.to_string().contains("take a longer step"));
}

/// The error of a step ends the verification.
#[test]
fn an_error_is_passed_on() {
    let body = RigidBody::new().system().expect("finite parameters");
    let fails = |_: &mut Vector, _| Err("no convergence");
    let found = verify_step(&body, &[0.9, 0.3, 0.4].into(), 0.1, &Claims::NONE, fails);
    assert_eq!(found, Err("no convergence"));
}
