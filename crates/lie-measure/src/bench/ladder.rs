//! A method at one accuracy after the other, until it is as good as the reference solution or takes too long.

mod runs;

use super::Entry;
use super::found::{Accuracy, Found, Point};
use super::measure::{Judge, Judged, Wanted};
use super::timing::{Clock, Spent, summary};
use crate::facts::rate;
use lie_program::protocol::End;
use lie_program::session::{Interruption, Session};
use lie_runtime::Poisson;
use runs::{How, Run, by_control, by_pieces, by_steps};

/// Rounds of timing; between two runs of one point all others run once.
const ROUNDS: usize = 7;
/// Rounds of a run that takes longer than so many seconds, which average over most of what disturbs.
const LONG: (f64, usize) = (0.5, 2);
/// A run that is timed is repeated until it lasts about so many seconds.
const SAMPLE: f64 = 2e-3;

/// One run that can be repeated.
pub(super) struct Rung<'a> {
    /// Everything but the times.
    point: Point,
    /// What the first run took, and a run in each round.
    first: Spent,
    samples: Vec<Spent>,
    run: Box<dyn Fn() + 'a>,
}

/// Shows what is wanted of the run at an accuracy.
type LookAt<'a, V> =
    dyn Fn((f64, u64), &Wanted<'_>, &mut dyn FnMut(f64, &V)) -> Result<(), String> + 'a;

/// What the runs of a method are compared with.
pub(super) struct Ladder<'a, P: Poisson<f64>> {
    pub(super) system: &'a P,
    pub(super) mu: &'a P::State,
    pub(super) judge: &'a Judge<P::State>,
    pub(super) until: f64,
    /// The least error that says something.
    pub(super) floor: f64,
    /// Seconds that one run may take.
    pub(super) budget: f64,
    pub(super) label: &'a str,
    pub(super) clock: &'a Clock,
    /// Ends a run between two steps.
    pub(super) stop: &'a Interruption,
    /// How far the whole is, before this ladder: parts done, and all of them.
    pub(super) before: (u64, u64),
}

impl<'a, P: Poisson<f64>> Ladder<'a, P> {
    /// Tells of each run as soon as it has come to its end.
    ///
    /// # Errors
    /// The session ends.
    pub(super) fn climb(
        self,
        entry: &'a Entry<P>,
        session: &mut Session<'_, Found>,
        rungs: &mut Vec<Rung<'a>>,
    ) -> Result<(), End> {
        let Self {
            system,
            mu,
            until,
            stop,
            ..
        } = self;
        let rate = rate(system, mu);
        match entry {
            Entry::Method(make) => {
                let first = (until.abs() * rate / 6.0).ceil().max(2.0) as u64;
                let steps = (0..26).map(|k| first << k);
                let how = How {
                    stop,
                    by_pieces: false,
                };
                self.go(
                    Accuracy::Step,
                    steps.map(|steps| (until / steps as f64, steps)),
                    &move |(h, steps)| by_steps(system, &*make(), mu, (h, steps), how),
                    &|(h, steps), wanted, see| {
                        runs::see_steps(system, &*make(), mu, (h, steps), how, wanted, see)
                    },
                    session,
                    rungs,
                )
            }
            Entry::Adaptive(make) => self.go(
                Accuracy::Tolerance,
                tolerances(),
                &move |(tolerance, _)| {
                    by_pieces(system, &*make(tolerance), mu, (until, rate), stop)
                },
                &|(tolerance, _), wanted, see| {
                    let span = (until, rate);
                    runs::see_pieces(system, &*make(tolerance), mu, span, stop, wanted, see)
                },
                session,
                rungs,
            ),
            Entry::Control(run) => self.go(
                Accuracy::Tolerance,
                tolerances(),
                &move |(tolerance, _)| by_control(system, run, mu, (until, rate), tolerance, None),
                &|(tolerance, _), wanted, see| {
                    runs::see_control(system, run, mu, (until, rate), tolerance, wanted, see)
                },
                session,
                rungs,
            ),
        }
    }

    fn go(
        &self,
        control: Accuracy,
        values: impl Iterator<Item = (f64, u64)>,
        run: &(impl Fn((f64, u64)) -> Result<Run<P::State>, String> + Clone + 'a),
        look: &LookAt<'_, P::State>,
        session: &mut Session<'_, Found>,
        rungs: &mut Vec<Rung<'a>>,
    ) -> Result<(), End> {
        let mut at_floor = 0;
        let mut best = f64::INFINITY;
        let (done, all) = self.before;
        for (index, value) in values.enumerate() {
            let word = control.word();
            session.stage(
                done,
                all,
                &format!("{}, {word} {:.3e}", self.label, value.0),
            )?;
            let (mut outcome, mut first) = self.clock.spent(|| run(value));
            if index == 0 && first.seconds > self.budget {
                // the first run of all may compile what it calls
                (outcome, first) = self.clock.spent(|| run(value));
            }
            let look =
                |wanted: &Wanted<'_>, see: &mut dyn FnMut(f64, &P::State)| look(value, wanted, see);
            let outcome = outcome.and_then(|run| {
                let judged = self.judge.error(self.system, &run.end, &look)?;
                Ok((run, judged))
            });
            // what was cut short says nothing
            session.goes_on()?;
            let error = outcome
                .as_ref()
                .map_or(f64::NAN, |(_, judged)| judged.error);
            let stopped = |why: &str| Found::Stopped {
                method: self.label.to_owned(),
                control,
                value: value.0,
                why: why.to_owned(),
            };
            match outcome {
                Ok((outcome, judged)) if error.is_finite() => {
                    let run = run.clone();
                    let rung = Rung {
                        point: self.point(control, value.0, &judged, &outcome),
                        first,
                        samples: Vec::new(),
                        run: Box::new(move || {
                            // its result is known; it only has to take place
                            let _ = std::hint::black_box(run(std::hint::black_box(value)));
                        }),
                    };
                    session.found(Found::Point(rung.timed(self.until)));
                    rungs.push(rung);
                }
                Ok(_) => session.found(stopped("a number is not finite")),
                Err(why) => session.found(stopped(&why)),
            }
            // two points at the floor, or two that are worse than before, end the ladder
            at_floor += u32::from(error <= 3.0 * self.floor || (error > best && best < 1e-10));
            best = f64::min(best, error);
            if at_floor == 2 || first.seconds > self.budget {
                break;
            }
        }
        Ok(())
    }

    fn point(&self, control: Accuracy, value: f64, judged: &Judged, run: &Run<P::State>) -> Point {
        Point {
            method: self.label.to_owned(),
            control,
            value,
            error: judged.error,
            across: judged.across,
            seconds: f64::NAN,
            median: f64::NAN,
            wall: f64::NAN,
            steps: run.steps,
            evaluations: run.evaluations,
            newton: run.newton,
        }
    }
}

/// Half decades.
fn tolerances() -> impl Iterator<Item = (f64, u64)> {
    (4..28).map(|k| (10_f64.powf(-0.5 * f64::from(k)), 0))
}

/// Times every run, round after round, so that a slow moment of the machine does not fall on one method alone. After each
/// round the points are told again, with the best times so far.
///
/// # Errors
/// The session ends.
pub(super) fn time(
    rungs: &mut [Rung<'_>],
    until: f64,
    clock: &Clock,
    session: &mut Session<'_, Found>,
) -> Result<(), End> {
    let all = (rungs.len() * ROUNDS) as u64;
    let mut done = 0;
    session.stage(all / 3, all, "times")?;
    for round in 0..ROUNDS {
        for rung in &mut *rungs {
            session.progress(all / 3 + done * 2 / 3, all)?;
            done += 1;
            if rung.first.seconds > LONG.0 && round >= LONG.1 {
                continue;
            }
            let times = (SAMPLE / rung.first.seconds).ceil().clamp(1.0, 1e5) as u32;
            let ((), spent) = clock.spent(|| (0..times).for_each(|_| (rung.run)()));
            session.goes_on()?;
            rung.samples.push(spent.divided_by(f64::from(times)));
        }
        for rung in &*rungs {
            session.found(Found::Point(rung.timed(until)));
        }
    }
    Ok(())
}

impl Rung<'_> {
    /// With the times of a run to this end.
    pub(super) fn timed(&self, until: f64) -> Point {
        let [seconds, median, wall] =
            summary(&self.samples, self.first).map(|time| time / until.abs());
        Point {
            seconds,
            median,
            wall,
            ..self.point.clone()
        }
    }
}
