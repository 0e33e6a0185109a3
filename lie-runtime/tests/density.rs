//! Steps that follow the motion by a reversible density: symmetric, of the order of the method, without drift; beside controls whose steps
//! follow it too, but look at the state before the step alone.

use lie_runtime::diagnostics::order_of_convergence;
use lie_runtime::driver::{MILESTONE, Milestone, OptionError, integrate, take_up};
use lie_runtime::methods::Method;
use lie_runtime::newton::FailureReason;
use lie_runtime::prelude::*;
use lie_runtime::{Poisson, State};
use std::fmt::Debug;
use std::ops::ControlFlow;

lie_poisson! {
    /// A planet on an eccentric orbit, e = 9/10, at its pericentre.
    pub system Planet;
    poisson { {q1, p1} = 1; {q2, p2} = 1; }
    state q1, q2, p1, p2;
    hamiltonian = (p1^2 + p2^2)/2 - 1/sqrt(q1^2 + q2^2);
    initial = [1/10, 0, 0, sqrt(19)];
    methods = [gauss4];
}

lie_poisson! {
    /// A free rigid body that starts beside its saddle.
    pub system Body;
    algebra = so(3);
    state x, y, z;
    hamiltonian = x^2/4 + y^2/2 + 3*z^2/4;
    initial = [1/1000, 1, 1/500];
    methods = [lie-midpoint, collective16, taylor];
}

lie_poisson! {
    /// A spin whose energy is no polynomial.
    pub system Spin;
    algebra = so(3);
    state x, y, z;
    hamiltonian = sin(x) + exp(y/2) + sqrt(1 + z^2) + x*y^2*z;
    initial = [3/5, -1/2, 7/10];
    methods = [lie-midpoint, collective16, taylor];
}

lie_poisson! {
    /// A spin in a field that turns.
    pub system Driven;
    algebra = so(3);
    state x, y, z;
    hamiltonian = z^2 + x*cos(t) + y*sin(t);
    initial = [3/5, -1/2, 7/10];
    methods = [lie-midpoint, collective16, taylor];
}

macro_rules! start {
    ($name:ident $declared:ident $system:ident) => {
        fn $name() -> ($system, <$system as Poisson<f64>>::State) {
            let declared = $declared::<f64>::new();
            (declared.system().expect("sound"), declared.initial_state())
        }
    };
}
start!(planet Planet PlanetSystem);
start!(body Body BodySystem);
start!(spin Spin SpinSystem);
start!(driven Driven DrivenSystem);

/// The period of the planet.
const PERIOD: f64 = core::f64::consts::TAU;

fn difference<V: State<f64>>(a: &V, b: &V) -> f64 {
    let pairs = a.as_slice().iter().zip(b.as_slice());
    pairs.fold(0.0, |most, (a, b)| most.max((a - b).abs()))
}

/// By how much a run back, with the last whole step turned round, misses the states and the times of the way there.
fn defect<P: Poisson<f64, State: Debug>, M: Method<f64, P> + Copy>(
    (system, mu0): (P, P::State),
    method: M,
    step: f64,
    end: f64,
) -> f64 {
    let options = |step| Options::new(step).reversible();
    let mut problem = Problem::new(system, mu0, (0.0, end));
    let there = solve(&problem, method, &options(step)).expect("there");
    let last = there.len() - 2;
    (problem.mu0, problem.span) = (there.mu[last].clone(), (there.t[last], 0.0));
    let turned = options(there.t[last - 1] - there.t[last]);
    let back = solve(&problem, method, &turned).expect("back");
    let missed = (0..=last).map(|k| {
        let (time, mu) = (there.t[k] - back.t[last - k], &back.mu[last - k]);
        difference(&there.mu[k], mu).max(time.abs())
    });
    missed.fold(0.0, f64::max)
}

/// Steps whose size is chosen by the field before each: as long as those of the density, but not symmetric. The states, with their times.
fn chosen_by_the_start<P: Poisson<f64>, M: Method<f64, P>>(
    system: &P,
    mut mu: P::State,
    method: M,
    (mut time, mut size): (f64, f64),
    (end, sign): (f64, f64),
) -> Vec<(f64, P::State)> {
    let speed = |mu: &P::State| {
        let mut field = system.zero_state();
        system.vector_field(mu, &mut field);
        let squares = field.as_slice().iter().map(|f| f * f);
        squares.sum::<f64>().powf(-0.375)
    };
    size /= speed(&mu);
    let mut all = vec![(time, mu.clone())];
    while (end - time) * sign > 0.0 {
        let h = sign * size * speed(&mu);
        let mut stepper = method.stepper(system, h, &NewtonOptions::default());
        stepper.step(&mut mu, &mut ()).expect("a step");
        time += h;
        all.push((time, mu.clone()));
    }
    all
}

#[test]
fn steps_go_back_over_the_same_times() {
    for missed in [
        defect(planet(), Gauss16, 0.015, 3.0 * PERIOD),
        defect(planet(), Gauss4, 0.005, 3.0 * PERIOD),
        defect(body(), LieMidpoint::exp(), 0.1, 60.0),
        defect(body(), Collective16::hopf(), 1.0, 60.0),
        defect(spin(), LieMidpoint::cayley(), 0.05, 20.0),
        defect(driven(), Gauss8, 0.1, 20.0),
    ] {
        println!("{missed:e}");
        // round-off, which grows by 1e3 beside the saddle of the body
        assert!(missed < 3e-9, "{missed:e}");
    }
    // the control
    let (system, mu0) = planet();
    let there = chosen_by_the_start(&system, mu0, Gauss16, (0.0, 0.015), (PERIOD, 1.0));
    let (time, mu) = *there.last().expect("an end");
    let size = time - there[there.len() - 2].0;
    let back = chosen_by_the_start(&system, mu, Gauss16, (time, size), (0.0, -1.0));
    let missed = (back.iter().map(|(time, _)| time.abs())).fold(f64::INFINITY, f64::min);
    assert!(missed > 1e-4, "{missed:e}");
}

/// The slope of the error at the end, which shorter steps aside lead to.
fn order<P: Poisson<f64, State: Debug>, M: Method<f64, P> + Copy>(
    start: fn() -> (P, P::State),
    method: M,
    (step, end): (f64, f64),
) -> f64 {
    let run = |options: &Options| {
        let (system, mu0) = start();
        let problem = Problem::new(system, mu0, (0.0, end));
        let solution = solve(&problem, method, options).expect("a run");
        let (time, mu) = solution.last().expect("an end");
        assert_eq!(time, end);
        mu.clone()
    };
    let reference = run(&Options::new(step / 64.0));
    let points: Vec<(f64, f64)> = (0..5)
        .map(|k| {
            let step = step / f64::from(1 << k);
            let options = Options::new(step).reversible().save(Save::Ends);
            (step, difference(&run(&options), &reference))
        })
        .collect();
    let order = order_of_convergence(&points, 1e-11);
    order.expect("an order").slope
}

#[test]
fn the_order_stays() {
    for (slope, expected) in [
        (order(spin, LieMidpoint::exp(), (0.05, 2.0)), 2.0),
        (order(spin, Gauss4, (0.1, 2.0)), 4.0),
        (order(planet, Gauss4, (0.004, 1.0)), 4.0),
        (order(driven, Gauss4, (0.2, 4.0)), 4.0),
    ] {
        println!("{slope}");
        assert!((slope - expected).abs() < 0.35, "{slope}");
    }
}

/// The largest error of the energy in the first and in the last tenth of a run.
fn drift(errors: &[f64]) -> [f64; 2] {
    let tenth = errors.len() / 10;
    let most = |errors: &[f64]| errors.iter().fold(0.0_f64, |most, error| most.max(*error));
    [
        most(&errors[..tenth]),
        most(&errors[errors.len() - tenth..]),
    ]
}

#[test]
fn the_energy_does_not_drift() {
    const PERIODS: f64 = 200.0;
    let (system, mu0) = planet();
    let energy = system.hamiltonian(&mu0);
    let mut errors = Vec::new();
    let look = EveryStep(|_: Progress, mu: &_| {
        errors.push((Poisson::<f64>::hamiltonian(&system, mu) - energy).abs());
        ControlFlow::Continue(())
    });
    let problem = Problem::new(planet().0, mu0, (0.0, PERIODS * PERIOD));
    let options = Options::new(0.004).reversible().save(Save::Ends);
    solve_observed(&problem, Gauss4, &options, look).expect("a run");
    let [first, last] = drift(&errors);
    println!("{} steps: {first:e}, {last:e}", errors.len());
    assert!(last < 1.2 * first && first < 1e-4, "{first:e}, {last:e}");
    // the control has about as many steps
    let states = chosen_by_the_start(&system, mu0, Gauss4, (0.0, 0.004), (PERIODS * PERIOD, 1.0));
    let errors = states
        .iter()
        .map(|(_, mu)| (system.hamiltonian(mu) - energy).abs());
    let errors: Vec<f64> = errors.collect();
    let [first, last] = drift(&errors);
    println!("{} steps: {first:e}, {last:e}", errors.len());
    assert!(last > 3.0 * first, "{first:e}, {last:e}");
}

#[test]
fn orbits_are_kept_and_the_saddle_is_passed() {
    let (system, mu0) = body();
    let problem = Problem::new(system, mu0, (0.0, 200.0));
    let reference = solve(&problem, Gauss16, &Options::new(0.2)).expect("a reference");
    for step in [0.5, 2.0, 3.0] {
        let options = Options::new(step).reversible();
        let solution = solve(&problem, Collective16::hopf(), &options).expect("a run");
        assert!(solution.drift().casimirs[0].max < 1e-13);
        assert!(solution.drift().energy.max < 1e-11);
        let sizes: Vec<f64> = solution.t.windows(2).map(|t| t[1] - t[0]).collect();
        let largest = sizes.iter().fold(0.0_f64, |most, size| most.max(*size));
        assert!(
            largest < 1.1 * step,
            "{step}: steps are longest beside the saddle, {largest}"
        );
        let missed = difference(
            solution.last().expect("an end").1,
            reference.last().expect("an end").1,
        );
        println!("{step}: {} steps, {missed:e}", solution.stats.steps);
        assert!(missed < 1e-5, "{step}: {missed:e}");
    }
}

#[test]
fn a_tolerance_gives_the_first_step() {
    let (system, mu0) = planet();
    let problem = Problem::new(system, mu0, (0.0, 9.5 * PERIOD));
    let tight = Options::new(0.006).reversible().save(Save::Ends);
    let reference = solve(&problem, Gauss16, &tight).expect("a reference");
    let mut steps = 0;
    for tolerance in [1e-3, 1e-6, 1e-9] {
        let options = Options::tolerance(tolerance).save(Save::Ends);
        let constant = solve(&problem, Gauss16, &options).expect("a run");
        assert!(constant.uneven.expect("said") > 30.0);
        let solution = solve(&problem, Gauss16, &options.reversible().assessed()).expect("a run");
        let (stats, chosen) = (solution.stats, solution.chosen.expect("a step"));
        let error = difference(
            solution.last().expect("an end").1,
            reference.last().expect("an end").1,
        );
        let told = solution.assessed.and_then(|assessed| assessed.error);
        println!(
            "{tolerance}: {} of {} steps, {error:e}, told {told:?}, {chosen:?}",
            stats.steps, constant.stats.steps
        );
        assert!(solution.uneven.is_none() && solution.shortened.is_none());
        assert!(stats.newton < constant.stats.newton, "{stats:?}");
        assert!(
            error < 30.0 * tolerance && stats.steps >= steps,
            "{error:e}"
        );
        assert!(told.is_some_and(|told| told < 100.0 * error && told > 0.01 * error));
        steps = stats.steps;
    }
}

#[test]
fn rows_lie_aside_of_the_grid() {
    let (system, mu0) = planet();
    let problem = Problem::new(system, mu0, (0.0, 10.0));
    let run = |save| {
        let options = Options::new(0.012).reversible().save(save);
        solve(&problem, Gauss16, &options).expect("a run")
    };
    let all = run(Save::Every(1));
    assert_eq!(all.last().expect("an end").0, 10.0);
    assert!(all.t.windows(2).all(|t| t[0] < t[1]));
    let times: Vec<f64> = (0..=40).map(|k| 0.25 * f64::from(k)).collect();
    let at = run(Save::At([times.clone(), vec![all.t[7]]].concat()));
    assert_eq!(at.len(), 42);
    assert_eq!(
        at.at(all.t[7]),
        Some(&all.mu[7]),
        "a row on the grid is its state"
    );
    let interval = run(Save::Interval(0.25));
    assert_eq!(interval.t, times);
    let fine = solve(
        &problem,
        Gauss16,
        &Options::new(0.004)
            .reversible()
            .save(Save::At(times.clone())),
    )
    .expect("a run");
    for time in &times {
        let row = interval.at(*time).expect("a row");
        assert_eq!(Some(row), at.at(*time));
        assert!(difference(row, fine.at(*time).expect("a row")) < 1e-8);
    }
    let third = run(Save::Every(3));
    let expected = all.t.iter().step_by(3).chain(all.t.last());
    let mut expected: Vec<f64> = expected.copied().collect();
    expected.dedup();
    assert_eq!(third.t, expected);
}

/// Keeps milestones and what comes after the first.
#[derive(Default)]
struct Places<V> {
    milestones: Vec<Milestone<V>>,
    rows: Vec<(f64, V)>,
}

impl<P: Poisson<f64>> Observer<f64, P> for Places<P::State> {
    fn milestone(&mut self, _system: &P, milestone: &Milestone<P::State>) {
        self.milestones.push(milestone.clone());
    }
    fn row(&mut self, _system: &P, time: f64, mu: &P::State) -> ControlFlow<()> {
        self.rows.push((time, mu.clone()));
        ControlFlow::Continue(())
    }
}

#[test]
fn a_run_is_taken_up_with_the_same_bits() {
    let (system, mu0) = planet();
    let problem = Problem::new(system, mu0, (0.0, 400.0));
    let options = Options::new(0.012).reversible();
    let mut whole = Places::default();
    take_up(&problem, Gauss16, &options, None, &mut whole).expect("a run");
    let first = &whole.milestones[0];
    assert_eq!(first.index, MILESTONE);
    let mut rest = Places::default();
    take_up(&problem, Gauss16, &options, Some(first), &mut rest).expect("the rest");
    let from = whole.rows.iter().position(|row| row.0 == first.time);
    assert_eq!(rest.rows, whole.rows[from.expect("its row")..]);
    // one of constant steps is none of this run
    let mut constant = first.clone();
    constant.division.control = None;
    let refused = take_up(
        &problem,
        Gauss16,
        &options,
        Some(&constant),
        &mut Places::default(),
    );
    assert!(
        refused
            .expect_err("another run")
            .to_string()
            .contains("milestone")
    );
}

#[test]
fn what_cannot_follow_a_density_is_refused() {
    let (system, mu0) = spin();
    let problem = Problem::new(system, mu0, (0.0, 1.0));
    let options = Options::new(0.1).reversible();
    let why = |error: SolveError<f64, _>| match error {
        SolveError::Option(OptionError::Density(why)) => why,
        other => panic!("{other}"),
    };
    let rk4 = solve(&problem, Rk4, &options).expect_err("not symmetric");
    assert!(why(rk4).contains("not symmetric"));
    let series = solve(&problem, Taylor::default(), &options).expect_err("own steps");
    assert!(why(series).contains("its own steps"));
    let kept = options.keep(Keep::ENERGY);
    let kept = solve(&problem, LieMidpoint::exp(), &kept).expect_err("a projection");
    assert!(why(kept).contains("projection"));
}

/// A first step that is too long for the motion ends in a message, soon, and the remedy works.
#[test]
fn steps_that_are_too_long_end_in_a_message() {
    let (system, mu0) = planet();
    let problem = Problem::new(system, mu0, (0.0, 1e6));
    for step in [0.1, 0.3, 1.0] {
        let options = Options::new(step).reversible().save(Save::Ends);
        let mut steps = 0;
        let count = EveryStep(|progress: Progress, _: &_| {
            steps = progress.step;
            ControlFlow::Continue(())
        });
        let error = solve_observed(&problem, Gauss16, &options, count).expect_err("too long");
        let text = error.to_string();
        println!("{step}: after {steps} steps: {text}");
        assert!(text.contains("smaller step") && steps < 1000, "{text}");
    }
    // the start is on the way away from the pericentre, where the density falls
    let (system, mu0) = planet();
    let far = Problem::new(system, mu0, (0.0, 1.0));
    let away = solve(
        &far,
        Gauss16,
        &Options::new(0.002).save(Save::At(vec![0.05])),
    )
    .expect("a run");
    let away = Problem::new(planet().0, away.mu[0], (0.05, 1.0));
    match solve(&away, Gauss16, &Options::new(-1.0).reversible()) {
        Err(SolveError::Option(OptionError::Direction { .. })) => {}
        other => panic!("{other:?}"),
    }
    let Err(SolveError::Step { error, .. }) =
        solve(&away, Gauss16, &Options::new(0.5).reversible())
    else {
        panic!("too long");
    };
    assert!(
        matches!(
            error.failure.reason,
            FailureReason::NoDensity | FailureReason::NotConverged | FailureReason::Diverged
        ),
        "{error}"
    );
    let mut nothing = ();
    integrate(
        &away,
        Gauss16,
        &Options::new(0.005).reversible(),
        &mut nothing,
    )
    .expect("the remedy");
}

/// Where H depends on the time a run has the same end as with steps of one size.
#[test]
fn the_time_is_followed() {
    let (system, mu0) = driven();
    let problem = Problem::new(system, mu0, (0.0, 20.0));
    let reference = solve(&problem, Gauss16, &Options::new(0.05)).expect("a reference");
    let missed = [0.2, 0.1, 0.05].map(|step| {
        let options = Options::new(step).reversible();
        let solution = solve(&problem, Gauss8, &options).expect("a run");
        let [found, expected] = [&solution, &reference].map(|run| run.last().expect("an end").1);
        difference(found, expected)
    });
    println!("{missed:?}");
    assert!(missed[0] < 1e-6 && missed[1] < 1e-2 * missed[0] && missed[2] < 1e-11);
}
