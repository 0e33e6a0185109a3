//! Steps beyond a pole of the Cayley map, or of the rational function that a Gauss method is.

use crate::systems;

use lie_runtime::methods::{
    Collective2, Compose4, Generating2, Generating4, Isospectral2, Isospectral4, Isospectral6,
    LieMidpoint, Method, Stepper,
};
use lie_runtime::newton::{FailureReason, NewtonOptions};
use lie_runtime::prelude::*;
use lie_runtime::scalar::Dual;
use systems::affine_line::AffineLine;

/// Steps until one is refused; the states before it.
fn until_refused(
    method: &impl Method<f64, AffineLine<f64>>,
    system: &AffineLine<f64>,
    h: f64,
    start: [f64; 2],
) -> (Vec<[f64; 2]>, Option<FailureReason>) {
    let mut stepper = method.stepper(system, h, &NewtonOptions::default());
    let mut mu = start.into();
    let mut rows = vec![start];
    for _ in 0..40 {
        let before = mu;
        if let Err(failure) = stepper.step(&mut mu, &mut ()) {
            assert_eq!(mu, before, "a refused step leaves the state alone");
            return (rows, Some(failure.reason));
        }
        rows.push(mu.into());
    }
    (rows, None)
}

/// q never changes its sign, whatever the step: a step that would is refused.
#[test]
fn no_step_leaves_the_half_plane() {
    fn check(name: &str, method: &impl Method<f64, AffineLine<f64>>, refuses: bool) {
        let decay = AffineLine::<f64>::decay();
        let mut outside = 0;
        for h in [0.1, 0.5, 0.8, 1.0, 1.3, 1.7, 2.5, -0.6, -0.9, -1.6, -2.4] {
            for start in [[0.5, 1.0], [0.3, -2.0], [-4.0, 0.5]] {
                let (rows, reason) = until_refused(method, &decay, h, start);
                // round-off is as large as that of p
                for row in rows.iter().filter(|row| row[1].abs() > 1e-14) {
                    assert!(row[1] * start[1] > 0.0, "{name} {h}: {rows:?}");
                }
                outside += u32::from(reason == Some(FailureReason::OutsideChart));
                assert!(h.abs() > 0.1 || reason.is_none(), "{name} {h}: {reason:?}");
            }
        }
        assert_eq!(outside > 0, refuses, "{name}: {outside} steps refused");
    }
    check("lie-midpoint", &LieMidpoint::cayley(), true);
    check("generating2", &Generating2::cayley(), true);
    check("generating4", &Generating4::cayley(), true);
    check("isospectral2", &Isospectral2::new(), true);
    check("isospectral6", &Isospectral6::new(), true);
    check("collective2", &Collective2::representation(), true);
    check("compose4", &Compose4::new(LieMidpoint::cayley()), true);
    // the Padé approximant with two stages has no real pole, but stages that differ have one
    check("isospectral4", &Isospectral4::new(), true);
    check("exp", &LieMidpoint::exp(), false);
}

/// What the steps were refused for: without the check, they succeed and q changes its sign.
#[test]
fn the_equation_has_a_solution_beyond_the_pole() {
    use lie_runtime::newton::Newton;
    use lie_runtime::{Equation, Implicit};
    let decay = AffineLine::<f64>::decay();
    let mut equation = decay.equation(&LieMidpoint::cayley(), 0.8);
    let start = [0.5, 1.0].into();
    equation.set_base(&start);
    let mut unknown = equation.zero_unknown();
    equation.initial_guess(&mut unknown);
    let mut newton = Newton::new(&equation, &NewtonOptions::default());
    newton
        .solve(&mut equation, &mut unknown, 1.0)
        .expect("a solution");
    let mut end = start;
    equation.result(&unknown, &mut end);
    assert!(end[1] < -0.01, "{end:?}");
    assert!(!equation.within_chart(&unknown));
}

/// A solution that becomes infinite in a finite time is stopped before it, with a step that works.
#[test]
fn a_blow_up_is_stopped_with_a_step_that_works() {
    let start = [0.0, 1.0];
    let problem = Problem::new(AffineLine::<f64>::blow_up(), start, (0.0, 4.0));
    let error =
        solve(&problem, LieMidpoint::cayley(), &Options::new(0.03)).expect_err("it blows up");
    let SolveError::Step { error, solution } = error else {
        panic!("{error}");
    };
    assert_eq!(error.failure.reason, FailureReason::OutsideChart);
    let rows = solution.mu.iter();
    assert!(solution.t.len() > 30 && rows.clone().all(|mu| mu[1] > 0.0 && mu[0] >= 0.0));
    let works = error.works.expect("a step");
    let text = error.to_string();
    assert!(text.contains(&format!("a step of {works} works")), "{text}");
    let mut mu = *solution.mu.last().expect("a row");
    let mut stepper =
        LieMidpoint::cayley().stepper(&problem.system, works, &NewtonOptions::default());
    stepper.step(&mut mu, &mut ()).expect("it works");
    let mut stepper =
        LieMidpoint::cayley().stepper(&problem.system, 2.0 * works, &NewtonOptions::default());
    let mut mu = *solution.mu.last().expect("a row");
    assert!(
        works == 0.015 || stepper.step(&mut mu, &mut ()).is_err(),
        "the largest"
    );
}

/// Lanes are refused one by one, and dual numbers as their values are.
#[test]
fn lanes_and_dual_numbers() {
    let decay = AffineLine::<F64x4>::decay();
    let mut h = F64x4::zero();
    let steps = [0.1, 0.8, 0.3, 1.7];
    for (lane, step) in steps.into_iter().enumerate() {
        h = h.with_lane(lane, step);
    }
    let start = systems::state(&decay, &[0.5, 1.0]);
    let mut mu = start;
    let mut stepper = LieMidpoint::cayley().stepper(&decay, h, &NewtonOptions::default());
    let failure = stepper.step(&mut mu, &mut ()).expect_err("two lanes leave");
    assert_eq!(
        (failure.reason, failure.lanes),
        (FailureReason::OutsideChart, 0b1010)
    );
    for (lane, step) in steps.into_iter().enumerate() {
        let scalar = AffineLine::<f64>::decay();
        let mut alone = [0.5, 1.0].into();
        let mut stepper = LieMidpoint::cayley().stepper(&scalar, step, &NewtonOptions::default());
        assert_eq!(stepper.step(&mut alone, &mut ()).is_err(), lane % 2 == 1);
        for k in 0..2 {
            assert_eq!(
                mu[k].lane(lane),
                alone[k],
                "the state after the step, or before it"
            );
        }
    }
    let lifted = AffineLine::<Dual<f64>>::decay();
    for (step, refused) in [(0.1, false), (0.8, true)] {
        let mut mu = systems::state(&lifted, &[0.5, 1.0]);
        mu[0].derivative = 1.0;
        let h = Dual::from_f64(step);
        let mut stepper = LieMidpoint::cayley().stepper(&lifted, h, &NewtonOptions::default());
        assert_eq!(stepper.step(&mut mu, &mut ()).is_err(), refused);
    }
}
