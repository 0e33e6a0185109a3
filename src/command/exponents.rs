//! `lie exponents`: the Lyapunov exponents of a motion.

use std::sync::Arc;

use lie_in_process::exponents::Measurement;
use lie_in_process::words::with_error;
use lie_program::protocol::Obstacle;
use lie_spectra::exponents::{Exponent, Spectrum};
use lie_syntax::diagnostic::Kind;

use super::fold::folded;
use super::run::bar::Bar;
use super::run::impossible;
use super::run::said::stopped_text;
use super::{args, print};
use crate::build::talk::{Outcome, fault, talk_here};
use crate::compiler::{self, Spec};
use crate::interrupt::Interrupt;
use crate::message::{Failure, Message, STOPPED};
use crate::render;

/// Measures and prints.
///
/// # Errors
/// Invalid input, or surroundings that fail.
pub fn run(arguments: &args::Exponents) -> Result<u8, Failure> {
    let spec = compiler::load(&arguments.spec)?;
    let (request, asked) = arguments.asked();
    let (measurement, work) =
        Measurement::new(&spec, &request, &asked).map_err(Failure::invalid)?;
    if !arguments.quiet {
        render::print(&spec.warnings());
    }
    let interrupt = Interrupt::install();
    let bar = Bar::new(!arguments.quiet);
    let mut found = None;
    let outcome = talk_here(
        &Arc::new(work),
        measurement.clone(),
        &interrupt,
        &mut |spectrum| {
            found = Some(spectrum);
            Ok(())
        },
        &mut |progress| bar.show(progress.done, progress.all),
    );
    bar.clear();
    let outcome = outcome.map_err(|error| Failure::surroundings(fault(&error.to_string())))?;
    if let Some(spectrum) = &found {
        match arguments.json {
            true => print(&format!("{:#}\n", measurement.as_json(&spec, spectrum)))?,
            false => print(&text(&spec, &measurement, spectrum))?,
        }
    }
    ended(outcome, found.as_ref(), arguments.quiet)
}

/// What is said behind it, and the exit code.
fn ended(outcome: Outcome, found: Option<&Spectrum>, quiet: bool) -> Result<u8, Failure> {
    match outcome {
        Outcome::Done => Ok(0),
        Outcome::Interrupted(code) => {
            if !quiet && found.is_some() {
                render::say("Interrupted; what was summed so far is shown.");
            }
            Ok(code)
        }
        Outcome::Stopped(stop) => {
            let why = stopped_text(&stop, "what was summed so far is shown");
            render::stopped(&why, &stop.remedy);
            Ok(STOPPED)
        }
        Outcome::Parameter(name, why) => Err(impossible(&name, &why)),
        Outcome::Refused(Obstacle::Initial, why) => {
            let message = Message::new(Kind::Domain, why).at_option("--initial");
            Err(message.help("give another initial state").into())
        }
        Outcome::Refused(_, why) | Outcome::Broken(why) => Err(Failure::surroundings(fault(&why))),
        Outcome::NotTaken(error) => Err(Failure::surroundings(fault(&error.to_string()))),
    }
}

/// What was found, for people.
fn text(spec: &Spec, measurement: &Measurement, spectrum: &Spectrum) -> String {
    let name = &spec.model.name;
    let method = measurement.plan.method.title();
    let step = measurement.options.step;
    let mut text = format!(
        "{name}: Lyapunov exponents by the tangents of {method}, step {step}, time {}{}\n",
        rounded(spectrum.time),
        match spectrum.transient {
            0 => String::new(),
            steps => format!(" after {}", rounded(steps as f64 * step.abs())),
        },
    );
    if spectrum.steps == 0 {
        text.push_str("nothing was summed\n");
    }
    for (number, exponent) in spectrum.exponents.iter().enumerate() {
        text.push_str(&format!("{:3}. {}\n", number + 1, shown(exponent)));
    }
    if let Some(largest) = spectrum.exponents.first() {
        // what the rounding of a step does to the length of a tangent
        let round_off = 16.0 * f64::EPSILON / step.abs();
        text.push_str(&match largest.value > 2.0 * largest.error {
            _ if !largest.error.is_finite() => {
                "no errors are known: less than two of 20 parts of the time were done\n".to_owned()
            }
            true if largest.value < round_off => "no growth beyond round-off\n".to_owned(),
            true => {
                let time = 1.0 / largest.value;
                let error = largest.error * time * time;
                format!("Lyapunov time: {}\n", with_error(time, error))
            }
            false => "no growth that is larger than twice its error\n".to_owned(),
        });
    }
    if let Some(sum) = spectrum.sum() {
        text.push_str(&format!("sum, the mean divergence: {}\n", small(sum)));
    }
    text.push_str(&pairs(spec, spectrum));
    folded(&text)
}

/// What the bracket says of the exponents, and how far they are from that.
fn pairs(spec: &Spec, spectrum: &Spectrum) -> String {
    let (leaf, all) = (2 * spectrum.pairs, spectrum.dimension);
    if spec.model.driving.is_some() {
        return "forces or dissipation act: exponents need not come in pairs\n".to_owned();
    }
    if spec.model.is_almost_poisson() {
        return "the bracket that the constraint leaves is almost Poisson: exponents need not come in pairs\n".to_owned();
    }
    // the time and its momentum are a pair that has no exponents
    let clock = spec.model.configuration.as_ref().and_then(|c| c.clock());
    let rank = spec.model.generic_rank - if clock.is_some() { 2 } else { 0 };
    if leaf < rank {
        return format!(
            "the start is on a singular leaf, of {leaf} dimensions for {rank}: exponents across it need not vanish\n",
        );
    }
    let mut text = String::new();
    if let Some(defect) = spectrum.pairing() {
        text.push_str(&format!(
            "{} on the leaf of {leaf} dimensions: sums are 0 up to {}\n",
            match spectrum.pairs {
                1 => "1 pair".to_owned(),
                pairs => format!("{pairs} pairs"),
            },
            small(defect)
        ));
    }
    if let Some(largest) = spectrum.casimirs() {
        text.push_str(&format!(
            "{} off the leaf, of the Casimirs: 0 up to {}\n",
            all - leaf,
            small(largest)
        ));
    }
    text
}

/// A number in three digits.
fn small(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        size if (0.01..1e4).contains(&size) => format!("{value:.4}"),
        _ => format!("{value:.1e}"),
    }
}

/// A time without the round-off of steps.
fn rounded(time: f64) -> f64 {
    format!("{time:.9e}").parse().unwrap_or(time)
}

/// An exponent with its error, behind a blank where there is no sign.
fn shown(exponent: &Exponent) -> String {
    let text = with_error(exponent.value, exponent.error);
    match text.starts_with('-') {
        true => text,
        false => format!(" {text}"),
    }
}
