//! Runs of each kind of method: to their end, and with what is seen on the way.

use super::super::measure::Wanted;
use super::super::{RunControl, Watch};
use lie_program::session::Interruption;
use lie_runtime::diagnostics::{AnyMethod, AnyStepper};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::{Poisson, State};

/// A long run of a method that chooses its own steps is made in pieces, in each of which the field turns about so often.
const PIECE: f64 = 2000.0;
/// Where a method shows nothing but its end, so many runs show what lies before.
const LOOKS: u64 = 32;
/// So many coordinates are advanced by a step between two looks for an interruption: about a hundred microseconds, beside
/// which a look costs nothing.
const BETWEEN: usize = 1024;

/// A run that has come to its end.
pub(super) struct Run<V> {
    pub(super) end: V,
    pub(super) steps: u64,
    pub(super) evaluations: u64,
    pub(super) newton: u64,
}

/// How a run is made.
#[derive(Clone, Copy)]
pub(super) struct How<'a> {
    /// Ends it between two steps.
    pub(super) stop: &'a Interruption,
    /// Whether a step may take long: it consists of many.
    pub(super) by_pieces: bool,
}

/// A run on its way.
struct Way<'a, V> {
    stepper: Box<dyn AnyStepper<f64, V> + 'a>,
    stop: &'a Interruption,
    /// Steps between two looks for an interruption.
    between: u64,
    /// Steps of this size that were made; of a method that chooses its own they consist of many.
    done: u64,
    run: Run<V>,
}

impl<'a, V: State<f64>> Way<'a, V> {
    fn new<P: Poisson<f64, State = V>>(
        system: &'a P,
        method: &dyn AnyMethod<f64, P>,
        mu: &V,
        h: f64,
        how: How<'a>,
    ) -> Self {
        let steps = (BETWEEN / system.dimension().max(1)).max(1) as u64;
        Self {
            stepper: method.any_stepper(system, h, &NewtonOptions::default()),
            stop: how.stop,
            between: if how.by_pieces { 1 } else { steps },
            done: 0,
            run: Run {
                end: mu.clone(),
                steps: 0,
                evaluations: 0,
                newton: 0,
            },
        }
    }

    /// Goes on to this step.
    fn go(&mut self, to: u64) -> Result<(), String> {
        while self.done < to {
            if self.stop.is_there() {
                return Err("interrupted".to_owned());
            }
            let more = self.between.min(to - self.done);
            let stats = self.stepper.advance(&mut self.run.end, more);
            let stats = stats.map_err(|(further, failure)| {
                format!("step {}: {failure}", self.done + further + 1)
            })?;
            self.done += more;
            self.run.steps += stats.accepted;
            self.run.evaluations += stats.evaluations;
            self.run.newton += stats.newton;
        }
        Ok(())
    }
}

/// In steps of one size.
pub(super) fn by_steps<P: Poisson<f64>>(
    system: &P,
    method: &dyn AnyMethod<f64, P>,
    mu: &P::State,
    (h, steps): (f64, u64),
    how: How<'_>,
) -> Result<Run<P::State>, String> {
    let mut way = Way::new(system, method, mu, h, how);
    way.go(steps)?;
    Ok(way.run)
}

/// Every step, or the last grid points before the times.
pub(super) fn see_steps<P: Poisson<f64>>(
    system: &P,
    method: &dyn AnyMethod<f64, P>,
    mu: &P::State,
    (h, steps): (f64, u64),
    how: How<'_>,
    wanted: &Wanted<'_>,
    see: &mut dyn FnMut(f64, &P::State),
) -> Result<(), String> {
    let mut way = Way::new(system, method, mu, h, how);
    match wanted {
        Wanted::Every => {
            for step in 1..=steps {
                way.go(step)?;
                see(h * step as f64, &way.run.end);
            }
        }
        Wanted::At(times) => {
            let mut at = 0;
            for time in *times {
                at = ((time / h) as u64).clamp(at, steps);
                way.go(at)?;
                see(h * at as f64, &way.run.end);
            }
        }
    }
    Ok(())
}

fn pieces(until: f64, rate: f64) -> u64 {
    (until.abs() * rate / PIECE).ceil().max(1.0) as u64
}

/// With steps of the method's own choice.
pub(super) fn by_pieces<P: Poisson<f64>>(
    system: &P,
    method: &dyn AnyMethod<f64, P>,
    mu: &P::State,
    (until, rate): (f64, f64),
    stop: &Interruption,
) -> Result<Run<P::State>, String> {
    let pieces = pieces(until, rate);
    let how = How {
        stop,
        by_pieces: true,
    };
    by_steps(system, method, mu, (until / pieces as f64, pieces), how)
}

/// The ends of the pieces, where there are many; else by runs of their own, whose steps but the last are those of the
/// whole run.
pub(super) fn see_pieces<P: Poisson<f64>>(
    system: &P,
    method: &dyn AnyMethod<f64, P>,
    mu: &P::State,
    (until, rate): (f64, f64),
    stop: &Interruption,
    wanted: &Wanted<'_>,
    see: &mut dyn FnMut(f64, &P::State),
) -> Result<(), String> {
    let pieces = pieces(until, rate);
    let even: Vec<f64>;
    let times = match wanted {
        Wanted::Every if pieces >= LOOKS => {
            let grid = (until / pieces as f64, pieces);
            let how = How {
                stop,
                by_pieces: true,
            };
            return see_steps(system, method, mu, grid, how, wanted, see);
        }
        Wanted::Every => {
            let part = |k| until * k as f64 / LOOKS as f64;
            even = (1..=LOOKS).map(part).collect();
            &even
        }
        Wanted::At(times) => *times,
    };
    for &time in times {
        let run = by_pieces(system, method, mu, (time, rate), stop)?;
        see(time, &run.end);
    }
    Ok(())
}

/// By a method from outside.
pub(super) fn by_control<P: Poisson<f64>>(
    system: &P,
    run: &RunControl<P>,
    mu: &P::State,
    (until, rate): (f64, f64),
    tolerance: f64,
    mut watch: Option<Watch<'_>>,
) -> Result<Run<P::State>, String> {
    let pieces = pieces(until, rate);
    let piece = until / pieces as f64;
    let mut all = Run {
        end: mu.clone(),
        steps: 0,
        evaluations: 0,
        newton: 0,
    };
    for k in 0..pieces {
        let before = piece * k as f64;
        let watching = watch.is_some();
        let mut later = |time: f64, mu: &[f64]| {
            if let Some(watch) = &mut watch {
                watch(before + time, mu);
            }
        };
        let watched: Option<Watch<'_>> = if watching { Some(&mut later) } else { None };
        let part = run(system, all.end.as_slice(), piece, tolerance, watched);
        let part = part.ok_or_else(|| "it gave up".to_owned())?;
        all.end.as_mut_slice().copy_from_slice(&part.end);
        all.steps += part.steps;
        all.evaluations += part.evaluations;
    }
    Ok(all)
}

/// Every step, or the last ones before the times.
pub(super) fn see_control<P: Poisson<f64>>(
    system: &P,
    run: &RunControl<P>,
    mu: &P::State,
    span: (f64, f64),
    tolerance: f64,
    wanted: &Wanted<'_>,
    see: &mut dyn FnMut(f64, &P::State),
) -> Result<(), String> {
    let times = match wanted {
        Wanted::Every => &[][..],
        Wanted::At(times) => times,
    };
    let mut waiting = times.iter().peekable();
    let mut before = (0.0, mu.clone());
    let mut watch = |time: f64, now: &[f64]| {
        while waiting
            .next_if(|wanted| wanted.abs() < time.abs())
            .is_some()
        {
            see(before.0, &before.1);
        }
        before.0 = time;
        before.1.as_mut_slice().copy_from_slice(now);
        if let Wanted::Every = wanted {
            see(before.0, &before.1);
        }
    };
    by_control(system, run, mu, span, tolerance, Some(&mut watch))?;
    for _ in waiting {
        see(before.0, &before.1);
    }
    Ok(())
}
