//! What an observer sees that draws a run.

use crate::systems;

use core::ops::ControlFlow;
use lie_runtime::driver::{Observer, Recorder, integrate};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use systems::heavy_top::{HeavyTop, START};
use systems::nonpolynomial::Nonpolynomial;
use systems::rigid_body::RigidBody;

/// Draws: the time and state of each row, or of what is between rows.
struct Drawing<V> {
    seen: Vec<(f64, V, bool)>,
}

impl<P: Poisson<f64>> Observer<f64, P> for Drawing<P::State> {
    fn draws(&self) -> bool {
        true
    }
    fn row(&mut self, _: &P, time: f64, mu: &P::State) -> ControlFlow<()> {
        self.seen.push((time, mu.clone(), false));
        ControlFlow::Continue(())
    }
    fn between(&mut self, _: &P, time: f64, mu: &P::State) {
        self.seen.push((time, mu.clone(), true));
    }
}

fn drawn<P: Poisson<f64>>(
    problem: &Problem<f64, P>,
    method: impl Method<f64, P>,
    options: &Options,
) -> Drawing<P::State> {
    let mut drawing = Drawing { seen: Vec::new() };
    // what was seen of a run that stops early stays
    let _ = integrate(problem, method, options, &mut drawing);
    drawing
}

fn body(span: (f64, f64)) -> Problem<f64, RigidBody> {
    Problem::new(RigidBody::default(), [0.8, 0.1, 0.6], span)
}

/// The largest angle between two lines that follow each other.
fn sharpest<V: State<f64>>(drawing: &Drawing<V>) -> f64 {
    let states: Vec<&[f64]> = drawing.seen.iter().map(|seen| seen.1.as_slice()).collect();
    let line = |two: &[&[f64]]| -> Vec<f64> {
        let pairs = two[0].iter().zip(two[1]);
        pairs.map(|(a, b)| b - a).collect()
    };
    let lines: Vec<Vec<f64>> = states.windows(2).map(line).collect();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let angle = |two: &[Vec<f64>]| {
        let (a, b) = (&two[0], &two[1]);
        (dot(a, b) / (dot(a, a) * dot(b, b)).sqrt()).min(1.0).acos()
    };
    lines.windows(2).map(angle).fold(0.0, f64::max)
}

#[test]
fn long_steps_are_a_curve_that_the_run_does_not_depend_on() {
    for step in [1.5, -1.5] {
        let problem = body((0.0, 20.0_f64.copysign(step)));
        let options = Options::new(step);
        let drawing = drawn(&problem, Gauss6, &options);
        let times: Vec<f64> = drawing.seen.iter().map(|seen| seen.0.abs()).collect();
        assert!(times.is_sorted(), "in order");
        assert!(sharpest(&drawing) < 0.2, "{}", sharpest(&drawing));
        // the control: the rows alone
        let plain = solve(&problem, Gauss6, &options).expect("it converges");
        let rows = || drawing.seen.iter().filter(|seen| !seen.2);
        let alone = Drawing {
            seen: rows().cloned().collect(),
        };
        assert!(sharpest(&alone) > 0.5, "{}", sharpest(&alone));
        assert!(rows().map(|seen| &seen.1).eq(&plain.mu));
        // neither the rows nor the work are others
        let mut observer = Drawing { seen: Vec::new() };
        let with = solve_observed(&problem, Gauss6, &options, &mut observer);
        assert_eq!(with.expect("it converges"), plain);
    }
}

#[test]
fn states_between_rows_are_those_of_rows_there() {
    let problem = Problem::new(HeavyTop::<f64>::default(), START, (0.0, 3.9));
    let drawing = drawn(&problem, Gauss4, &Options::new(0.4).save(Save::Every(2)));
    let between = drawing.seen.iter().filter(|seen| seen.2);
    let (times, states): (Vec<f64>, Vec<_>) = between.cloned().map(|seen| (seen.0, seen.1)).unzip();
    assert!(times.len() > 20);
    // that of a step which is no row among them, and none beyond the end
    assert!(times.contains(&0.4) && times.iter().all(|&time| time < 3.9));
    let mut at = times.clone();
    at.push(3.9);
    let there = solve(&problem, Gauss4, &Options::new(0.4).save(Save::At(at)));
    let there = there.expect("it converges");
    assert_eq!(there.mu[..times.len()], states);
}

#[test]
fn rows_that_are_asked_for_stand_among_what_is_between() {
    let asked = vec![0.0, 0.1, 2.25, 3.0, 7.0];
    let options = Options::new(1.5).save(Save::At(asked.clone()));
    let drawing = drawn(&body((0.0, 9.0)), Gauss6, &options);
    assert!(drawing.seen.is_sorted_by(|a, b| a.0 <= b.0));
    let rows = drawing.seen.iter().filter(|seen| !seen.2);
    assert!(rows.map(|seen| seen.0).eq(asked));
    // the curve goes on to the end
    assert!(drawing.seen.last().is_some_and(|last| last.0 > 8.8));
}

#[test]
fn short_steps_and_many_have_nothing_between() {
    let between = |problem: &Problem<f64, RigidBody>, options: &Options| {
        let drawing = drawn(problem, Gauss6, options);
        drawing.seen.iter().filter(|seen| seen.2).count()
    };
    assert_eq!(between(&body((0.0, 20.0)), &Options::new(0.05)), 0);
    assert_eq!(between(&body((0.0, 15_000.0)), &Options::new(1.5)), 0);
    // the controls: rows far apart, and fewer steps
    let rows = Options::new(0.05).save(Save::Every(40));
    let few = between(&body((0.0, 20.0)), &rows);
    assert!((20..200).contains(&few), "{few}");
    assert!(between(&body((0.0, 14_000.0)), &Options::new(1.5)) > 5_000);
}

#[test]
fn a_curve_ends_where_its_run_stops() {
    // the velocity grows with the square of the state: a long step fails somewhere
    let problem = Problem::new(Nonpolynomial, [3.0, -2.5, 2.0], (0.0, 30.0));
    let mut failed = 0;
    for step in [0.15, 0.2, 0.4] {
        let options = Options::new(step).newton(NewtonOptions::fixed_point());
        let mut plain = Recorder::new(&problem.system);
        let ended = integrate(&problem, ImplicitMidpoint, &options, &mut plain);
        let drawing = Drawing { seen: Vec::new() };
        let mut with = (Recorder::new(&problem.system), drawing);
        let same = integrate(&problem, ImplicitMidpoint, &options, &mut with);
        failed += u32::from(ended.is_err());
        // as text: a residual may be no number
        assert_eq!(format!("{ended:?}"), format!("{same:?}"), "step {step}");
        assert_eq!(plain.solution.mu, with.0.solution.mu);
    }
    assert!(failed > 0);
}
