//! The solver: how much work a step takes, that its variants agree, and how it fails.

use crate::systems;

use lie_runtime::methods::{Method, StepReport, Stepper};
use lie_runtime::newton::{FailureReason, NewtonOptions};
use lie_runtime::prelude::*;
use systems::heavy_top::{HeavyTop, START};
use systems::nonpolynomial::Nonpolynomial;
use systems::rigid_body::RigidBody;
use systems::saddle::Saddle;
use systems::{distance, state};

const BODY: [f64; 3] = [0.6, -0.5, 0.7];

fn one_step<P: Poisson<f64>>(
    system: &P,
    method: &impl Method<f64, P>,
    options: &NewtonOptions,
    start: &[f64],
) -> (P::State, StepReport) {
    let mut mu = state(system, start);
    let mut stepper = method.stepper(system, 0.1, options);
    let report = stepper.step(&mut mu, &mut ()).expect("the step converges");
    (mu, report)
}

/// Iterations and factorizations of a step of 0.1 by each variant; all must reach the same state.
fn work<P: Poisson<f64>>(system: &P, method: &impl Method<f64, P>, start: &[f64]) -> [u32; 6] {
    let (mu, newton) = one_step(system, method, &NewtonOptions::newton(), start);
    let (other, simplified) = one_step(system, method, &NewtonOptions::simplified(), start);
    assert!(distance(&mu, &other) < 4e-16);
    let (other, fixed) = one_step(system, method, &NewtonOptions::fixed_point(), start);
    assert!(distance(&mu, &other) < 4e-16);
    let reports = [newton, simplified, fixed];
    assert!(
        reports
            .iter()
            .all(|report| report.evaluations == report.iterations + 1)
    );
    [
        newton.iterations,
        newton.factorizations,
        simplified.iterations,
        simplified.factorizations,
        fixed.iterations,
        fixed.factorizations,
    ]
}

#[test]
fn iterations_are_pinned() {
    let top = HeavyTop::default();
    let measured = [
        work(&top, &ImplicitMidpoint, &START),
        work(&top, &Gauss4, &START),
        work(&top, &Gauss6, &START),
        work(&top, &LieMidpoint::exp(), &START),
        work(&top, &LieMidpoint::cayley(), &START),
        work(&Nonpolynomial, &ImplicitMidpoint, &BODY),
        work(&Nonpolynomial, &Gauss6, &BODY),
        work(&Nonpolynomial, &LieMidpoint::exp(), &BODY),
        work(&Nonpolynomial, &LieMidpoint::cayley(), &BODY),
        work(&Nonpolynomial, &Gonzalez, &BODY),
        work(&Nonpolynomial, &OrbitEnergy::gonzalez(), &BODY),
        work(&Nonpolynomial, &CohenHairer4::new(), &BODY),
        work(&Nonpolynomial, &SphericalMidpoint, &BODY),
        work(&Nonpolynomial, &Collective4::hopf(), &BODY),
        work(&Nonpolynomial, &Isospectral4::new(), &BODY),
        work(&RigidBody::default(), &MoserVeselov, &BODY),
    ];
    // iterations and factorizations of Newton, simplified Newton, fixed point
    let pinned = [
        [3, 3, 4, 1, 12, 0],
        [2, 2, 3, 1, 10, 0],
        [2, 2, 3, 1, 9, 0],
        [2, 2, 3, 1, 11, 0],
        [3, 3, 4, 1, 12, 0],
        [3, 3, 5, 1, 13, 0],
        [2, 2, 3, 1, 9, 0],
        [3, 3, 4, 1, 10, 0],
        [3, 3, 5, 1, 12, 0],
        [3, 3, 5, 1, 13, 0],
        [3, 3, 5, 1, 11, 0],
        [2, 2, 3, 1, 11, 0],
        [3, 3, 5, 1, 13, 0],
        [2, 2, 3, 1, 8, 0],
        [2, 2, 3, 1, 8, 0],
        [3, 3, 4, 1, 11, 0],
    ];
    assert_eq!(measured.as_slice(), pinned.as_slice(), "{measured:?}");
}

/// mu -> s mu, t -> t/s leaves the equations of the rigid body alone; with a power of two for s
/// every digit must stay, and so every decision of the solver.
#[test]
fn convergence_is_relative_to_the_state() {
    fn check(method: &impl Method<f64, RigidBody>) {
        let system = RigidBody::default();
        let (reference, report) = one_step(&system, method, &NewtonOptions::default(), &BODY);
        for exponent in [-300, -40, 40, 300] {
            let scale = 2.0_f64.powi(exponent);
            let mut mu = state(&system, &BODY.map(|entry| entry * scale));
            let mut stepper = method.stepper(&system, 0.1 / scale, &NewtonOptions::default());
            let scaled = stepper.step(&mut mu, &mut ()).expect("the step converges");
            assert_eq!(mu / scale, reference, "2^{exponent}");
            assert_eq!(scaled.iterations, report.iterations, "2^{exponent}");
        }
    }
    check(&ImplicitMidpoint);
    check(&Gauss4);
    check(&Gauss6);
    check(&LieMidpoint::exp());
    check(&LieMidpoint::cayley());
    check(&Rk4);
}

/// A step that must fail; the state must be untouched.
fn failure<P: Poisson<f64>>(
    system: &P,
    method: &impl Method<f64, P>,
    options: &NewtonOptions,
    h: f64,
    start: &[f64],
) -> FailureReason {
    let mut mu = state(system, start);
    let failure = method
        .stepper(system, h, options)
        .step(&mut mu, &mut ())
        .expect_err("it fails");
    assert_eq!(mu.as_slice(), start);
    assert_eq!(failure.lanes, 1);
    assert!(!failure.reason.remedy().is_empty());
    failure.reason
}

#[test]
fn failures_say_why_and_leave_the_state_alone() {
    let top = HeavyTop::default();
    let newton = NewtonOptions::default();
    let reason = failure(
        &top,
        &ImplicitMidpoint,
        &NewtonOptions::fixed_point(),
        50.0,
        &START,
    );
    assert!(
        matches!(reason, FailureReason::Diverged | FailureReason::NotFinite),
        "{reason:?}"
    );
    let few = NewtonOptions {
        max_iterations: 1,
        ..newton
    };
    let reason = failure(&top, &LieMidpoint::exp(), &few, 0.1, &START);
    assert_eq!(reason, FailureReason::NotConverged);
    let reason = failure(&Saddle(0.0), &ImplicitMidpoint, &newton, 2.0, &[0.3, -0.4]);
    assert_eq!(reason, FailureReason::Singular);
    let huge = [1e200, 1e200, 0.0];
    let reason = failure(&Nonpolynomial, &Rk4, &newton, 0.1, &huge);
    assert_eq!(reason, FailureReason::NotFinite);
    let reason = failure(&Nonpolynomial, &LieMidpoint::cayley(), &newton, 0.1, &huge);
    assert_eq!(reason, FailureReason::NotFinite);
    let strict = Dopri5 {
        rtol: 1e-40,
        atol: 0.0,
    };
    let reason = failure(&Nonpolynomial, &strict, &newton, 0.1, &BODY);
    assert_eq!(reason, FailureReason::StepTooSmall);
}

/// Where updates shrink fast no Jacobian is computed; where they do not, the step is that of Newton's method to the last
/// bit, and so are the next ones.
#[test]
fn the_automatic_choice_solves_what_newton_solves() {
    let top = HeavyTop::default();
    let steps = |options: &NewtonOptions, h: f64| {
        let mut mu = state(&top, &START);
        let mut stepper = Gauss6.stepper(&top, h, options);
        let reports: Option<Vec<StepReport>> = (0..20)
            .map(|_| stepper.step(&mut mu, &mut ()).ok())
            .collect();
        (mu, reports)
    };
    let solved = |options: &NewtonOptions, h: f64| {
        let (mu, reports) = steps(options, h);
        (mu, reports.expect("the steps converge"))
    };
    let (automatic, newton) = (NewtonOptions::default(), NewtonOptions::newton());

    let (mu, reports) = solved(&automatic, 0.05);
    assert!(distance(&mu, &solved(&newton, 0.05).0) < 1e-14);
    for report in &reports {
        assert_eq!((report.factorizations, report.pivoted), (0, 0));
        assert_eq!(report.fixed_point, report.iterations);
    }

    let long = 2.0;
    let slow = |reports: Vec<StepReport>| reports.iter().any(|report| report.iterations > 30);
    assert!(
        steps(&NewtonOptions::fixed_point(), long)
            .1
            .is_none_or(slow)
    );
    let (mu, reports) = solved(&automatic, long);
    let (expected, by_newton) = solved(&newton, long);
    assert_eq!(mu.as_slice(), expected.as_slice());
    let tries: Vec<usize> = (0..20).filter(|&k| reports[k].fixed_point > 0).collect();
    assert_eq!(tries, [0, 16]);
    for (report, newton) in reports.iter().zip(&by_newton) {
        assert_eq!(report.iterations, report.fixed_point + newton.iterations);
        assert_eq!(report.factorizations, newton.factorizations);
    }
}

/// Steps that start from a prediction end where Newton's method does from the guess of the equation, with less work; also
/// after a state that does not follow.
#[test]
fn predictions_change_the_work_and_not_the_steps() {
    fn check<P: Poisson<f64>>(
        system: &P,
        method: &impl Method<f64, P>,
        start: &[f64],
        h: f64,
    ) -> [f64; 2] {
        let mut mu = state(system, start);
        let mut stepper = method.stepper(system, h, &NewtonOptions::default());
        let mut work = [0.0; 2];
        for step in 0..120 {
            if step == 70 {
                mu = state(system, start);
            }
            let mut expected = mu.clone();
            let mut fresh = method.stepper(system, h, &NewtonOptions::newton());
            fresh.step(&mut expected, &mut ()).expect("a step");
            let mut cold = mu.clone();
            let mut fresh = method.stepper(system, h, &NewtonOptions::default());
            let report = fresh.step(&mut cold, &mut ()).expect("a step");
            work[1] += f64::from(report.iterations) / 120.0;
            let report = stepper.step(&mut mu, &mut ()).expect("a step");
            work[0] += f64::from(report.iterations) / 120.0;
            let error = distance(&mu, &expected);
            assert!(error < 2e-15, "h = {h}, step {step}: {error:e}");
        }
        work
    }
    macro_rules! all {
        ($($method:expr),*) => {$(
            for h in [0.003, 0.03, 0.1, 0.3, 0.6] {
                check(&HeavyTop::default(), &$method, &START, h);
                check(&Nonpolynomial, &$method, &BODY, h);
                check(&RigidBody::default(), &$method, &BODY, h);
            }
            let [predicted, cold] = check(&HeavyTop::default(), &$method, &START, 0.01);
            assert!(predicted < 0.8 * cold, "{predicted} {cold}");
        )*};
    }
    all!(
        ImplicitMidpoint,
        Gauss6,
        LieMidpoint::exp(),
        LieMidpoint::cayley(),
        CohenHairer4::new(),
        OrbitEnergy::gonzalez()
    );
}
