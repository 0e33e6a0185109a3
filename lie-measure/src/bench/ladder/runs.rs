//! Runs of each kind of method: to their end, and with what is seen on the way.

use super::super::measure::Wanted;
use super::super::{RunControl, Watch};
use lie_runtime::diagnostics::AnyMethod;
use lie_runtime::newton::NewtonOptions;
use lie_runtime::{Poisson, State};

/// A long run of a method that chooses its own steps is made in pieces, in each of which the field turns about so often.
const PIECE: f64 = 2000.0;
/// Where a method shows nothing but its end, so many runs show what lies before.
const LOOKS: u64 = 32;

/// A run that has come to its end.
pub(super) struct Run<V> {
    pub(super) end: V,
    pub(super) steps: u64,
    pub(super) evaluations: u64,
    pub(super) newton: u64,
}

/// In steps of one size.
pub(super) fn by_steps<P: Poisson<f64>>(
    system: &P,
    method: &dyn AnyMethod<f64, P>,
    mu: &P::State,
    h: f64,
    steps: u64,
) -> Result<Run<P::State>, String> {
    let mut end = mu.clone();
    let mut stepper = method.any_stepper(system, h, &NewtonOptions::default());
    match stepper.advance(&mut end, steps) {
        Ok(stats) => Ok(Run {
            end,
            steps: stats.accepted,
            evaluations: stats.evaluations,
            newton: stats.newton,
        }),
        Err((step, failure)) => Err(format!("step {}: {failure}", step + 1)),
    }
}

/// Every step, or the last grid points before the times.
pub(super) fn see_steps<P: Poisson<f64>>(
    system: &P,
    method: &dyn AnyMethod<f64, P>,
    mu: &P::State,
    (h, steps): (f64, u64),
    wanted: &Wanted<'_>,
    see: &mut dyn FnMut(f64, &P::State),
) -> Result<(), String> {
    let mut state = mu.clone();
    let mut stepper = method.any_stepper(system, h, &NewtonOptions::default());
    let mut done = 0;
    let mut go = |to: u64, state: &mut P::State| {
        let went = stepper.advance(state, to - done);
        let step = done + 1;
        done = to;
        went.map_err(|(more, failure)| format!("step {}: {failure}", step + more))
    };
    match wanted {
        Wanted::Every => {
            for step in 1..=steps {
                go(step, &mut state)?;
                see(h * step as f64, &state);
            }
        }
        Wanted::At(times) => {
            let mut at = 0;
            for time in *times {
                at = ((time / h) as u64).clamp(at, steps);
                go(at, &mut state)?;
                see(h * at as f64, &state);
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
    until: f64,
    rate: f64,
) -> Result<Run<P::State>, String> {
    let pieces = pieces(until, rate);
    by_steps(system, method, mu, until / pieces as f64, pieces)
}

/// The ends of the pieces, where there are many; else by runs of their own, whose steps but the last are those of the
/// whole run.
pub(super) fn see_pieces<P: Poisson<f64>>(
    system: &P,
    method: &dyn AnyMethod<f64, P>,
    mu: &P::State,
    (until, rate): (f64, f64),
    wanted: &Wanted<'_>,
    see: &mut dyn FnMut(f64, &P::State),
) -> Result<(), String> {
    let pieces = pieces(until, rate);
    let even: Vec<f64>;
    let times = match wanted {
        Wanted::Every if pieces >= LOOKS => {
            let grid = (until / pieces as f64, pieces);
            return see_steps(system, method, mu, grid, wanted, see);
        }
        Wanted::Every => {
            let part = |k| until * k as f64 / LOOKS as f64;
            even = (1..=LOOKS).map(part).collect();
            &even
        }
        Wanted::At(times) => *times,
    };
    for &time in times {
        let run = by_pieces(system, method, mu, time, rate)?;
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
