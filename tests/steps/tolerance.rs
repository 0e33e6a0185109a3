//! Steps that are chosen from a tolerance: the error at the end against it, over systems, methods and tolerances.

use crate::systems::{
    Declared, FreeRigidBody, HeavyTop, KirchhoffBody, NonpolynomialSpin, Random, Su3Quadratic,
    relative_distance,
};
use lie_runtime::driver::{IntegrateError, OptionError, integrate};
use lie_runtime::methods::Method;
use lie_runtime::newton::Convergence;
use lie_runtime::prelude::*;

const SPAN: f64 = 20.0;

/// The relative errors at the end over the tolerance, of random states of a system.
fn ratios<D: Declared, M>(method: M, tolerances: &[f64], states: usize) -> Vec<f64>
where
    M: Method<f64, D::System<f64>> + Clone,
    Gauss16: Method<f64, D::System<f64>>,
{
    let mut random = Random(2018);
    let mut found = Vec::new();
    for _ in 0..states {
        let mut mu = D::initial::<f64>();
        for entry in mu.as_mut_slice() {
            *entry += 0.3 * random.number();
        }
        let problem = Problem {
            system: D::declared::<f64>(),
            mu0: mu,
            span: (0.0, SPAN),
        };
        let ends = Options::new(0.05).save(Save::Ends);
        let reference = solve(&problem, Gauss16, &ends).ok().expect("it is solved");
        for &tolerance in tolerances {
            let options = Options::tolerance(tolerance).save(Save::Ends);
            let solution = solve(&problem, method.clone(), &options)
                .ok()
                .expect("it is solved");
            let chosen = solution.chosen.expect("a step was chosen");
            let last = |solution: &Solution<f64, _>| solution.mu.last().cloned().expect("an end");
            let (end, exact): (<D::System<f64> as Poisson<f64>>::State, _) =
                (last(&solution), last(&reference));
            let error = relative_distance(end.as_slice(), exact.as_slice());
            println!(
                "{} {} {tolerance:e}: h {:.4}, error {error:.1e}, at round-off {}",
                M::ID,
                D::FILE,
                chosen.step,
                chosen.at_round_off
            );
            let steps = SPAN / chosen.step;
            assert!((steps - steps.round()).abs() < 1e-9, "{steps} steps");
            found.push(error / tolerance);
        }
    }
    found
}

/// 95 of 100 errors are below 100 times the tolerance, and half of them below ten times; none is far below for no reason.
#[test]
fn errors_are_about_the_tolerance() {
    let mut found = Vec::new();
    let tight = [1e-7, 1e-9, 1e-11];
    found.extend(ratios::<FreeRigidBody, _>(Gauss16, &tight, 4));
    found.extend(ratios::<HeavyTop, _>(Gauss16, &tight, 4));
    found.extend(ratios::<KirchhoffBody, _>(Gauss12, &tight, 4));
    found.extend(ratios::<NonpolynomialSpin, _>(Gauss8, &tight, 4));
    found.extend(ratios::<Su3Quadratic, _>(Gauss10, &tight, 2));
    found.extend(ratios::<HeavyTop, _>(Gauss6, &[1e-3, 1e-6, 1e-8], 2));
    found.extend(ratios::<HeavyTop, _>(LieMidpoint::exp(), &[1e-2, 1e-3], 2));
    found.extend(ratios::<NonpolynomialSpin, _>(Rk4, &[1e-3, 1e-6], 3));
    found.extend(ratios::<FreeRigidBody, _>(Rkmk4, &[1e-3, 1e-6], 2));
    found.sort_by(f64::total_cmp);
    let quantile = |part: f64| found[(part * (found.len() - 1) as f64) as usize];
    let quantiles = [0.0, 0.05, 0.5, 0.95, 1.0].map(quantile);
    println!("{} runs, error/tolerance: {quantiles:?}", found.len());
    assert!(quantiles[3] < 100.0, "{quantiles:?}");
    assert!(quantiles[2] < 10.0, "{quantiles:?}");
    assert!(quantiles[1] > 1e-4, "{quantiles:?}");
    // here the iteration asks for shorter steps than the tolerance
    let mut found = Vec::new();
    found.extend(ratios::<FreeRigidBody, _>(Gauss16, &[1e-3, 1e-5], 4));
    found.extend(ratios::<HeavyTop, _>(Gauss16, &[1e-3, 1e-5], 4));
    found.extend(ratios::<KirchhoffBody, _>(Gauss12, &[1e-3, 1e-5], 4));
    found.extend(ratios::<NonpolynomialSpin, _>(Gauss8, &[1e-3, 1e-5], 4));
    let most = found.into_iter().fold(0.0, f64::max);
    assert!(most < 10.0, "{most}");
}

/// A constant step: the run is the one that `Options::new` with the chosen step makes.
#[test]
fn the_run_is_that_of_the_chosen_step() {
    let problem = Problem::new(
        HeavyTop::declared::<f64>(),
        HeavyTop::initial::<f64>(),
        (0.0, -7.0),
    );
    let options = Options::tolerance(1e-8).save(Save::At(vec![-1.0, -6.9]));
    let by_tolerance = solve(&problem, Gauss6, &options).expect("it is solved");
    let chosen = by_tolerance.chosen.expect("a step was chosen");
    assert!(chosen.step < 0.0 && !chosen.at_round_off && chosen.error < 1e-8);
    let same = Options::new(chosen.step).save(options.save.clone());
    let by_step = solve(&problem, Gauss6, &same).expect("it is solved");
    assert_eq!(by_tolerance.mu, by_step.mu);
    assert_eq!(by_tolerance.t, [-1.0, -6.9]);
    // of a fixed-point method, too, whose quadratic Casimirs stay to round-off, where nothing becomes faster
    let (system, start) = (FreeRigidBody::declared::<f64>(), [0.8, 0.1, 0.6]);
    let problem = Problem::new(system, start, (0.0, -7.0));
    let by_tolerance = solve(&problem, Gauss16, &options).expect("it is solved");
    assert_eq!(by_tolerance.shortened, None);
    let chosen = by_tolerance.chosen.expect("a step was chosen");
    let same = Options::new(chosen.step).save(options.save.clone());
    let by_step = solve(&problem, Gauss16, &same).expect("it is solved");
    assert_eq!(by_tolerance.mu, by_step.mu);
    let drift = by_tolerance.drift();
    assert!(
        drift.casimirs.iter().all(|casimir| casimir.max < 1e-14),
        "{drift:?}"
    );
    let ends = solve(
        &problem,
        Gauss16,
        &Options::tolerance(1e-8).save(Save::Ends),
    );
    assert_eq!(ends.expect("it is solved").t, [0.0, -7.0]);
}

/// A tighter tolerance takes no fewer steps, but for what the looks on the way change.
#[test]
fn steps_grow_with_the_digits() {
    fn counts<D: Declared, M>(method: M) -> Vec<u64>
    where
        M: Method<f64, D::System<f64>> + Clone,
    {
        let problem = Problem {
            system: D::declared::<f64>(),
            mu0: D::initial::<f64>(),
            span: (0.0, 100.0),
        };
        let steps = (2..=13).map(|digits| {
            let options = Options::tolerance(0.1_f64.powi(digits)).save(Save::Ends);
            let solution = solve(&problem, method.clone(), &options);
            solution.ok().expect("it is solved").stats.steps
        });
        let steps = steps.collect();
        println!("{} {}: {steps:?}", M::ID, D::FILE);
        steps
    }
    let mut all = Vec::new();
    all.push(counts::<FreeRigidBody, _>(Gauss16));
    all.push(counts::<HeavyTop, _>(Gauss16));
    all.push(counts::<KirchhoffBody, _>(Gauss16));
    all.push(counts::<Su3Quadratic, _>(Gauss16));
    all.push(counts::<NonpolynomialSpin, _>(Gauss16));
    all.push(counts::<HeavyTop, _>(Gauss8));
    all.push(counts::<FreeRigidBody, _>(Gauss8));
    for steps in &all {
        for pair in steps.windows(2) {
            assert!(pair[0] as f64 <= 1.3 * pair[1] as f64, "{steps:?}");
        }
        assert!(steps[0] < steps[11], "{steps:?}");
    }
}

/// A body near its unstable axis begins quietly and then turns over: steps become shorter on the way, rows stay where they were asked
/// for, and the tolerance is kept as far as errors grow. The control: the step of the start alone misses it.
#[test]
fn a_motion_that_becomes_faster_has_shorter_steps_from_there_on() {
    let start = [1e-4, 1.0, 1e-4];
    let problem =
        |start: [f64; 3]| Problem::new(FreeRigidBody::declared::<f64>(), start, (0.0, 60.0));
    let times = [0.0, 9.5, 20.0, 33.3, 60.0];
    let saved = Save::At(times.to_vec());
    let exact = solve(
        &problem(start),
        Gauss16,
        &Options::new(0.05).save(saved.clone()),
    );
    let exact = exact.expect("it is solved").mu;
    let options = Options::tolerance(1e-8).save(saved.clone());
    let found = solve(&problem(start), Gauss16, &options).expect("it is solved");
    let (chosen, shortened) = (found.chosen.unwrap().step, found.shortened.unwrap());
    assert!(
        0.0 < shortened && shortened < 0.9 * chosen,
        "{chosen} {shortened}"
    );
    assert_eq!(found.t, times);
    let errors = |rows: &[_]| {
        let rows: Vec<[f64; 3]> = rows
            .iter()
            .map(|mu: &nalgebra::SVector<f64, 3>| (*mu).into())
            .collect();
        let pairs = rows.iter().zip(&exact);
        pairs
            .map(|(a, b)| relative_distance(a, b.as_slice()))
            .fold(0.0, f64::max)
    };
    let error = errors(&found.mu);
    let control = solve(&problem(start), Gauss16, &Options::new(chosen).save(saved));
    let control = control.map_or(f64::INFINITY, |control| errors(&control.mu));
    println!("step {chosen}, then {shortened}: error {error:.1e}, control {control:.1e}");
    assert!(
        error < 1e-5 && control > 30.0 * error,
        "{error:e} {control:e}"
    );
    // every step is a row, and the last one is at the end
    let all = solve(&problem(start), Gauss16, &Options::tolerance(1e-8)).expect("it is solved");
    assert_eq!(all.t.last(), Some(&60.0));
    // a step that was far too long is counted, and made again
    let again = all.stats.steps + 1 - all.t.len() as u64;
    assert!(again <= 1, "{again}");
    let lengths: Vec<f64> = all.t.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(
        lengths
            .windows(2)
            .all(|pair| pair[1] < pair[0] * (1.0 + 1e-9))
    );
}

/// A second run tells the error at the end, of a tolerance and of a step; an observer may end it.
#[test]
fn the_error_at_the_end_is_told_on_demand() {
    let problem = Problem {
        system: HeavyTop::declared::<f64>(),
        mu0: HeavyTop::initial::<f64>(),
        span: (0.0, SPAN),
    };
    let ends = Options::new(0.02).save(Save::Ends);
    let exact = solve(&problem, Gauss16, &ends).expect("it is solved").mu;
    let ended = |mut options: Options| {
        options = options.save(Save::Ends);
        solve(&problem, Gauss6, &options).expect("it is solved")
    };
    assert_eq!(ended(Options::tolerance(1e-6)).assessed, None);
    for options in [Options::tolerance(1e-6), Options::new(0.2)] {
        let found = ended(options.assessed());
        let error = relative_distance(found.mu[1].as_slice(), exact[1].as_slice());
        let told = found.assessed.expect("it was asked for");
        let ratio = told.error.expect("it is known") / error;
        println!("told {:?}, error {error:.1e}", told.error);
        assert!((0.5..2.0).contains(&ratio), "{ratio}");
        assert_eq!(told.tolerance.is_some(), found.chosen.is_some());
        assert!(!told.missed());
    }
    struct Impatient(u32);
    impl<P: Poisson<f64>> lie_runtime::driver::Observer<f64, P> for Impatient {
        fn compared(&mut self, _: lie_runtime::driver::Progress) -> std::ops::ControlFlow<()> {
            self.0 += 1;
            std::ops::ControlFlow::Break(())
        }

        fn assessed(&mut self, assessed: &lie_runtime::driver::Assessed) {
            assert!(assessed.error.is_none() && assessed.missed());
            self.0 += 100;
        }
    }
    let mut observer = Impatient(0);
    integrate(
        &problem,
        Gauss6,
        &Options::new(0.2).assessed(),
        &mut observer,
    )
    .expect("it is solved");
    assert_eq!(observer.0, 101);
}

#[test]
fn what_cannot_be_kept_is_refused() {
    let problem = |end: f64| {
        let (system, mu) = (HeavyTop::declared::<f64>(), HeavyTop::initial::<f64>());
        Problem::new(system, mu, (0.0, end))
    };
    for tolerance in [0.0, 1e-17, 1.0, -1e-3, f64::NAN] {
        let outcome = integrate(
            &problem(1.0),
            Gauss6,
            &Options::tolerance(tolerance),
            &mut (),
        );
        assert!(
            matches!(
                outcome,
                Err(IntegrateError::Option(OptionError::Tolerance(_)))
            ),
            "{tolerance}: {outcome:?}"
        );
    }
    let endless = integrate(
        &problem(f64::INFINITY),
        Gauss6,
        &Options::tolerance(1e-6),
        &mut (),
    );
    assert!(matches!(
        endless,
        Err(IntegrateError::Option(OptionError::Span(..)))
    ));
    let nowhere = solve(&problem(0.0), Gauss6, &Options::tolerance(1e-6)).expect("nothing to do");
    assert_eq!(nowhere.t, [0.0]);
}

/// Where that is asked for, the iteration goes as far as the tolerance asks: less work, the same tolerance kept, and invariants kept as
/// far. The control, to round-off, keeps them.
#[test]
fn the_iteration_ends_by_the_tolerance_where_that_is_asked_for() {
    let problem = Problem {
        system: HeavyTop::declared::<f64>(),
        mu0: HeavyTop::initial::<f64>(),
        span: (0.0, SPAN),
    };
    let ends = Options::new(0.05).save(Save::Ends);
    let exact = solve(&problem, Gauss16, &ends).expect("it is solved");
    let exact = exact.mu.last().cloned().expect("an end");
    for tolerance in [1e-4, 1e-6, 1e-8] {
        let [asked, control] = [Convergence::Tolerance, Convergence::Claimed].map(|convergence| {
            let mut options = Options::tolerance(tolerance);
            options.newton.convergence = convergence;
            solve(&problem, Gauss16, &options).expect("it is solved")
        });
        let error = |end: Option<&_>| {
            let end: &<<HeavyTop as Declared>::System<f64> as Poisson<f64>>::State =
                end.expect("an end");
            relative_distance(end.as_slice(), exact.as_slice())
        };
        let lost = [&asked, &control].map(|solution| solution.drift().casimirs[0].max);
        let work = asked.stats.evaluations as f64 / control.stats.evaluations as f64;
        println!(
            "{tolerance:e}: error {:.1e}, work {work:.2}, Casimir lost {lost:?}",
            error(asked.mu.last())
        );
        assert!(error(asked.mu.last()) < 30.0 * tolerance);
        assert!(work < 0.8, "{work}");
        assert!(lost[0] < tolerance && lost[1] < 1e-13, "{lost:?}");
        assert!(lost[0] > 10.0 * lost[1], "{lost:?}");
    }
}
