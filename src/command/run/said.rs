//! What is said of a run, in sentences.

use lie_in_process::request::Plan;
use lie_in_process::words::counted;
use lie_program::protocol::Stop;
use lie_runtime::driver::{Density, Pace};
use lie_runtime::newton::Convergence;

use super::reception::Received;
use super::summary::short;
use crate::build::talk::Outcome;
use crate::compiler::Spec;

/// The system, the method and its pace.
pub fn title(spec: &Spec, plan: &Plan, step: f64) -> String {
    let (name, method) = (&spec.model.name, plan.method.title());
    let written = plan.pace.1.trim();
    let what = match plan.density {
        Density::Constant => "step",
        Density::Reversible => "first step",
    };
    match plan.pace.0 {
        Pace::Step(_) => format!("{name}, {method}, {what} {written}"),
        Pace::Tolerance(_) => format!("{name}, {method}, tolerance {written}, {what} {step:?}"),
    }
}

/// What a tolerance has led to.
pub fn of_tolerance(plan: &Plan, received: &Received) -> Vec<String> {
    let mut notes = Vec::new();
    if received.at_round_off {
        notes.push("the round-off of this many steps may exceed the tolerance".to_owned());
    }
    if let Some((step, time)) = received.shortened {
        notes.push(format!(
            "from t = {time:.6} on steps have the size {step:?}, {:?} before: the motion is faster there than at the start",
            received.step
        ));
    }
    if let Some(factor) = received.uneven {
        notes.push(format!(
            "the steps that the tolerance allows differ by a factor of {factor:.0} along this orbit: `--density reversible`, or \
             `--method taylor` where structure does not count, is faster"
        ));
    }
    if plan.newton.convergence == Convergence::Tolerance {
        let kept = received.drift.errors().map(|(name, error, relative)| {
            let absolute = if relative { "" } else { " (absolute)" };
            format!("{name} {}{absolute}", short(error))
        });
        notes.push(format!(
            "the solver stopped at the tolerance, and what {} keeps is kept as far: {}",
            plan.method.id(),
            kept.collect::<Vec<_>>().join(", ")
        ));
    }
    if let Some((error, false)) = received.assessed.filter(|_| plan.assess) {
        notes.push(format!(
            "the error at the end is about {error:.1e} of the state, by a second run"
        ));
    }
    let warning = missed(received).or_else(|| moved(plan, received));
    notes.extend(warning.map(|warning| format!("warning: {warning}")));
    notes
}

/// What steps that follow the motion are, and what they are not.
pub fn of_density(plan: &Plan) -> Option<String> {
    (plan.density == Density::Reversible).then(|| {
        format!(
            "the size of steps follows the motion by a reversible density: {} stays symmetric, and is no Poisson map for that",
            plan.method.id()
        )
    })
}

/// Which noise it was.
pub fn of_noise(spec: &Spec, plan: &Plan) -> Option<String> {
    let driving = spec.model.driving.as_ref()?;
    driving
        .is_noisy()
        .then(|| format!("noise with seed {}", plan.held.seed))
}

/// What was kept by a projection, and what that is not.
pub fn of_projection(spec: &Spec, plan: &Plan) -> Option<String> {
    let kept = plan.kept(spec);
    (!kept.is_empty()).then(|| {
        format!(
            "{} kept by a projection behind each step, which is no Poisson map",
            kept.join(", ")
        )
    })
}

/// An invariant that moved so many times the tolerance says what the steps that were looked at do not.
const MOVED: f64 = 100.0;

/// What of the rows says that the tolerance is missed.
fn moved(plan: &Plan, received: &Received) -> Option<String> {
    let Pace::Tolerance(tolerance) = plan.pace.0 else {
        return None;
    };
    let relative = received.drift.errors().filter(|(_, _, relative)| *relative);
    let worst = relative.max_by(|a, b| f64::total_cmp(&a.1, &b.1))?;
    (worst.1 > MOVED * tolerance).then(|| {
        format!(
            "{} moved by {} of itself, much more than the tolerance: H may have a kink that steps passed; `--assess` says by how \
             much the end is off",
            worst.0,
            short(worst.1)
        )
    })
}

/// How far the tolerance may be missed, if it may.
pub fn missed(received: &Received) -> Option<String> {
    match (received.assessed, received.lost) {
        (Some((error, true)), _) if error.is_nan() => Some(
            "the error at the end is not known: the second run, which would tell it, failed, or chooses its own steps; give \
             `--step`, and compare with the run of half of it"
                .to_owned(),
        ),
        (Some((error, true)), _) => Some(format!(
            "the error at the end is about {error:.1e} of the state, more than the tolerance: errors grow on this orbit, \
             or the method cannot keep it"
        )),
        (_, Some(time)) => Some(format!(
            "from t = {time:.6} on no step is short enough for the tolerance: there is a singularity or a joint of H; \
             `--assess` says by how much the end is off"
        )),
        _ => None,
    }
}

/// How the run ended, for the output.
pub fn word(outcome: &Outcome) -> &'static str {
    match outcome {
        Outcome::Done => "done",
        Outcome::Interrupted(_) => "interrupted",
        Outcome::Stopped(_) => "stopped",
        Outcome::Parameter(..)
        | Outcome::Refused(..)
        | Outcome::Broken(_)
        | Outcome::NotTaken(_) => "failed",
    }
}

/// Where and why a run stopped, and what becomes of what there is of it.
pub fn stopped_text(stop: &Stop, kept: &str) -> String {
    let Stop {
        step, time, reason, ..
    } = stop;
    // nothing is iterated in an explicit step
    let solver = match stop.iterations {
        0 => String::new(),
        iterations => {
            let iterations = counted(iterations.into(), "iteration");
            format!(" ({iterations}, residual {:?})", stop.residual)
        }
    };
    format!("the integration stopped in step {step} at t = {time:?}: {reason}{solver}\n{kept}")
}
