//! The driver: times, saved states, failures, observers.

use crate::systems;

use core::ops::ControlFlow;
use lie_runtime::driver::OptionError;
use lie_runtime::newton::{FailureReason, NewtonOptions};
use lie_runtime::prelude::*;
use systems::heavy_top::{HeavyTop, START};
use systems::logarithmic::Logarithmic;
use systems::nonpolynomial::Nonpolynomial;
use systems::rigid_body::RigidBody;
use systems::saddle::Saddle;
use systems::{distance, state, steps};

fn top(span: (f64, f64)) -> Problem<f64, HeavyTop> {
    Problem::new(HeavyTop::default(), START, span)
}

#[test]
fn a_time_between_steps_is_reached_by_one_shorter_step() {
    let options = Options::new(0.1).save(Save::At(vec![0.25, 0.2, 0.5]));
    let solution = solve(&top((0.0, 0.5)), ImplicitMidpoint, &options).expect("it converges");
    assert_eq!(solution.t, [0.2, 0.25, 0.5]);
    let system = HeavyTop::default();
    let mut mu = state(&system, &START);
    steps(&system, &ImplicitMidpoint, 0.1, 2, &mut mu).expect("it converges");
    assert_eq!(solution.mu[0], mu);
    let mut between = mu;
    steps(
        &system,
        &ImplicitMidpoint,
        0.25 - 2.0 * 0.1,
        1,
        &mut between,
    )
    .expect("it converges");
    assert_eq!(solution.mu[1], between);
    // the trajectory goes on from the grid, not from the saved state
    steps(&system, &ImplicitMidpoint, 0.1, 3, &mut mu).expect("it converges");
    assert_eq!(solution.mu[2], mu);
    assert_eq!(solution.stats.steps, 6);
    assert_eq!(solution.at(0.25), Some(&between));
    assert_eq!(solution.at(0.3), None);
    assert_eq!(solution.last(), Some((0.5, &mu)));
}

#[test]
fn an_end_off_the_grid_is_reached() {
    let options = Options::new(0.1).save(Save::Every(2));
    let solution = solve(&top((0.0, 0.35)), Gauss6, &options).expect("it converges");
    assert_eq!(solution.t, [0.0, 0.2, 0.35]);
    let fine = solve(&top((0.0, 0.35)), Gauss6, &Options::new(0.035)).expect("it converges");
    assert_eq!(fine.len(), 11);
    let distance = distance(solution.last().unwrap().1, fine.last().unwrap().1);
    assert!(distance < 1e-9, "{distance:e}");
}

/// The work of a run is that of its steps; at h = 2 a saddle's first pivot vanishes in every iteration.
#[test]
fn the_work_of_a_run_is_that_of_its_steps() {
    fn check<P>(system: P, h: f64, start: &[f64], pivoted: u64)
    where
        P: Poisson<f64, State: core::fmt::Debug + PartialEq>,
        ImplicitMidpoint: Method<f64, P>,
    {
        let mut mu = state(&system, start);
        let mut stepper = ImplicitMidpoint.stepper(&system, h, &NewtonOptions::newton());
        let (mut evaluations, mut newton, mut factorizations) = (0, 0, 0);
        for _ in 0..5 {
            let report = stepper.step(&mut mu, &mut ()).expect("it converges");
            evaluations += u64::from(report.evaluations);
            newton += u64::from(report.iterations);
            factorizations += u64::from(report.factorizations);
        }
        drop(stepper);
        let start = state(&system, start);
        let problem = Problem::new(system, start, (0.0, 5.0 * h));
        let options = Options::new(h).newton(NewtonOptions::newton());
        let solution = solve(&problem, ImplicitMidpoint, &options).expect("it converges");
        assert_eq!(solution.last().expect("rows").1, &mu);
        let stats = solution.stats;
        assert_eq!((stats.steps, stats.accepted), (5, 5));
        assert_eq!((stats.rejected, stats.failures), (0, 0));
        assert_eq!((stats.evaluations, stats.newton), (evaluations, newton));
        assert_eq!(stats.fixed_point, 0);
        assert_eq!(
            (stats.factorizations, stats.pivoted),
            (factorizations, pivoted)
        );
        // one factorization per iteration, and a second one where rows are exchanged
        let each = if pivoted > 0 { 2 } else { 1 };
        assert_eq!(factorizations, each * newton);
    }
    check(HeavyTop::default(), 0.1, &START, 0);
    check(Saddle(0.75), 0.1, &[0.3, -0.4], 0);
    check(Saddle(0.75), 2.0, &[0.3, -0.4], 5);
}

#[test]
fn backwards_returns() {
    let there = solve(&top((0.0, 2.0)), Gauss6, &Options::new(0.1)).expect("it converges");
    let (time, end) = there.last().expect("rows");
    let back = Problem::new(HeavyTop::default(), *end, (time, 0.0));
    let back = solve(&back, Gauss6, &Options::new(-0.1).save(Save::Ends)).expect("it converges");
    assert_eq!(back.t[1], 0.0);
    assert!(distance(back.last().unwrap().1, &state(&HeavyTop::default(), &START)) < 1e-13);
}

#[test]
fn the_adaptive_method_lands_on_every_grid_time() {
    let method = Dopri5 {
        rtol: 1e-11,
        atol: 1e-13,
    };
    let coarse = solve(&top((0.0, 3.0)), method, &Options::new(1.0)).expect("it converges");
    let fine = solve(
        &top((0.0, 3.0)),
        Gauss6,
        &Options::new(0.01).save(Save::Every(100)),
    )
    .expect("it converges");
    assert_eq!(coarse.t, [0.0, 1.0, 2.0, 3.0]);
    for (a, b) in coarse.mu.iter().zip(&fine.mu) {
        assert!(distance(a, b) < 1e-9);
    }
    assert!(
        coarse.stats.accepted > 30 && coarse.stats.steps == 3,
        "{:?}",
        coarse.stats
    );
    let backwards = Problem::new(HeavyTop::default(), *coarse.last().unwrap().1, (3.0, 0.0));
    let backwards = solve(&backwards, method, &Options::new(-1.0)).expect("it converges");
    assert!(
        distance(
            backwards.last().unwrap().1,
            &state(&HeavyTop::default(), &START)
        ) < 1e-9
    );
}

#[test]
fn a_failure_keeps_what_was_saved() {
    // the velocity grows with the square of the state: a step of 0.4 fails somewhere
    let problem = Problem::new(Nonpolynomial, [3.0, -2.5, 2.0], (0.0, 100.0));
    let options = Options::new(0.4).newton(NewtonOptions::fixed_point());
    let error = solve(&problem, ImplicitMidpoint, &options).expect_err("it must fail");
    let SolveError::Step { error, solution } = &error else {
        panic!("{error}")
    };
    assert_eq!(solution.len() as u64, error.step);
    assert_eq!(solution.last().expect("the start").0, error.time);
    assert_eq!(solution.status, Status::Failed);
    assert_eq!(solution.stats.failures, 1);
    let text = error.to_string();
    assert!(text.contains("take a smaller step"), "{text}");
    assert!(
        text.contains(&format!("step {} from t = {}", error.step, error.time)),
        "{text}"
    );
}

#[test]
fn a_start_that_is_not_finite_is_refused() {
    let problem = Problem::new(RigidBody::default(), [1.0, f64::NAN, 0.0], (0.0, 1.0));
    let error = solve(&problem, Rk4, &Options::new(0.1)).expect_err("nothing to integrate");
    let SolveError::Step { error, solution } = error else {
        panic!("{error}")
    };
    assert_eq!(
        (error.step, error.failure.reason),
        (1, FailureReason::NotFinite)
    );
    assert!(solution.is_empty());
    let inertia = RigidBody {
        inertia: [1.0, 0.0, 1.0],
    };
    let problem = Problem::new(inertia, [1.0, 0.5, 0.0], (0.0, 1.0));
    assert!(solve(&problem, Rk4, &Options::new(0.1)).is_err());
}

#[test]
fn options_that_make_no_run_are_refused() {
    let error = solve(&top((0.0, 1.0)), Rk4, &Options::new(-0.1)).expect_err("the wrong way");
    assert!(
        matches!(error, SolveError::Option(OptionError::Direction { .. })),
        "{error}"
    );
    assert!(error.solution().is_none());
}

#[test]
fn an_observer_may_end_the_run() {
    let mut seen = Vec::new();
    let stop = EveryStep(|progress: Progress, _mu: &_| {
        seen.push(progress.step);
        if progress.time > 0.35 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    let solution =
        solve_observed(&top((0.0, 1.0)), Rk4, &Options::new(0.1), stop).expect("no failure");
    assert_eq!(solution.status, Status::Stopped);
    assert_eq!(seen, [1, 2, 3, 4]);
    assert_eq!(solution.t, [0.0, 0.1, 0.2, 3.0 * 0.1]);
}

#[test]
fn csv_can_be_read_back() {
    let solution = solve(&top((0.0, 0.3)), Gauss4, &Options::new(0.1)).expect("it converges");
    let mut text = Vec::new();
    solution
        .write_csv(&mut text)
        .expect("a vector takes everything");
    let text = String::from_utf8(text).expect("text");
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("t,m1,m2,m3,g1,g2,g3,energy,length,area"));
    for (row, line) in lines.enumerate() {
        let numbers: Vec<f64> = line
            .split(',')
            .map(|number| number.parse().unwrap())
            .collect();
        assert_eq!(numbers[0], solution.t[row]);
        assert_eq!(numbers[1..7], *solution.mu[row].as_slice());
        assert_eq!(numbers[7], solution.energy[row]);
        assert_eq!(numbers[8..], solution.casimirs[row]);
    }
    assert_eq!(text.lines().count(), 5);
}

#[test]
fn drift_of_the_saved_states() {
    let options = Options::new(0.1).save(Save::Every(10));
    let kept = solve(&top((0.0, 200.0)), LieMidpoint::cayley(), &options).expect("it converges");
    let lost = solve(&top((0.0, 200.0)), Rk4, &options).expect("it is finite");
    assert!(kept.drift().casimirs.iter().all(|drift| drift.max < 1e-13));
    assert!(lost.drift().casimirs.iter().all(|drift| drift.max > 1e-8));
    assert!(lost.drift().energy.growth().expect("an error") > 5.0);
    assert_eq!(kept.drift().casimirs[1].name, "area");
}

#[test]
fn lanes_and_single_precision_go_through_the_same_driver() {
    let start = systems::state(&HeavyTop::<F64x8>::default(), &START);
    let problem = Problem::<F64x8, _>::new(HeavyTop::default(), start, (0.0, 1.0));
    let lanes = solve(&problem, Gauss4, &Options::new(0.1)).expect("it converges");
    let one = solve(&top((0.0, 1.0)), Gauss4, &Options::new(0.1)).expect("it converges");
    for (many, one) in lanes.mu.iter().zip(&one.mu) {
        assert!((0..6).all(|row| many[row].lane(5) == one[row]));
    }
    let start = systems::state(&HeavyTop::<f32>::default(), &START);
    let problem = Problem::<f32, _>::new(HeavyTop::default(), start, (0.0, 1.0));
    let single = solve(&problem, Gauss4, &Options::new(0.1)).expect("it converges");
    let (many, one) = (single.last().unwrap().1, one.last().unwrap().1);
    assert!((0..6).all(|row| (f64::from(many[row]) - one[row]).abs() < 2e-6));
}

/// Rk4 needs no value of H: where H is a polynomial it is evaluated at the start alone, elsewhere after every
/// step too.
#[test]
fn the_energy_is_looked_at_where_a_step_may_leave_the_domain() {
    fn values<const POLYNOMIAL: bool>(save: Save) -> u32 {
        let system = Logarithmic::<POLYNOMIAL>::default();
        let problem = Problem::new(system, [0.3, 4.0], (0.0, 2.0));
        let options = Options::new(0.1).save(save);
        solve(&problem, Rk4, &options).expect("inside the domain");
        problem.system.values.get()
    }
    assert_eq!(values::<true>(Save::Ends), 1);
    assert_eq!(values::<false>(Save::Ends), 21);
    // and after a step to a row off the grid
    let off = || Save::At(vec![0.55, 0.57, 2.0]);
    assert_eq!(values::<true>(off()), 1);
    assert_eq!(values::<false>(off()), 23);
}

#[test]
fn a_step_beyond_the_domain_is_refused() {
    // p falls below 0 in one long step; the field is finite there, H is not
    for (step, end, save) in [(2.0, 2.0, Save::Ends), (4.0, 4.0, Save::At(vec![2.0]))] {
        let system = Logarithmic::<false>::default();
        let problem = Problem::new(system, [1.0, 0.4], (0.0, end));
        let options = Options::new(step).save(save);
        let error = solve(&problem, Rk4, &options).expect_err("H is not finite there");
        let SolveError::Step { error, .. } = error else {
            panic!("{error}")
        };
        assert_eq!(error.failure.reason, FailureReason::OutsideDomain);
    }
}

/// Where H depends on the time the energy is not [`Poisson::hamiltonian`]: rows and drift show the energy.
#[test]
fn the_energy_that_is_shown() {
    let system = Logarithmic::<true>::default();
    let problem = Problem::new(system, [0.3, 0.4], (0.0, 1.0));
    let mut monitor = DriftMonitor::new();
    let options = Options::new(0.1);
    let solution = solve_observed(&problem, Rk4, &options, &mut monitor).expect("finite");
    for (mu, &energy) in solution.mu.iter().zip(&solution.energy) {
        assert_eq!(energy, problem.system.energy(mu));
        assert_ne!(energy, problem.system.hamiltonian(mu));
    }
    // what is followed is conserved, which the energy that is shown need not be
    let drift = &monitor.drift().energy;
    let conserved = |mu| problem.system.hamiltonian(mu);
    assert_eq!(drift.initial, conserved(&solution.mu[0]));
    let changes = solution
        .mu
        .iter()
        .map(|mu| (conserved(mu) - drift.initial).abs());
    assert_eq!(drift.max, changes.fold(0.0, f64::max));
}

/// Changes its mind about the motion with every step.
struct Wavering {
    steps: usize,
    motions: usize,
}

impl<P: Poisson<f64>> Observer<f64, P> for Wavering {
    fn follows_motion(&self) -> bool {
        self.steps.is_multiple_of(2)
    }

    fn step(&mut self, _: &P, _: Progress, _: &P::State) -> ControlFlow<()> {
        self.steps += 1;
        ControlFlow::Continue(())
    }

    fn motion(&mut self, _: &P, _: &lie_runtime::driver::Motion<'_, P::State>) {
        self.motions += 1;
    }
}

/// What an observer answers before the start holds: no motion of a step is lost.
#[test]
fn an_observer_is_asked_once_about_the_motion() {
    let mut observer = Wavering {
        steps: 0,
        motions: 0,
    };
    let options = Options::new(0.1).save(Save::Ends);
    let method = LieMidpoint::cayley();
    solve_observed(&top((0.0, 1.0)), method, &options, &mut observer).expect("it converges");
    assert_eq!((observer.steps, observer.motions), (10, 10));
}
