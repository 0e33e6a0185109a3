//! Tolerances of adaptive methods, and the solver of implicit ones.

use lie_codegen::methods::Choice;
use lie_program::protocol::Tolerances;
use lie_runtime::driver::Pace;
use lie_runtime::methods::MOST_UNKNOWNS;
use lie_runtime::newton::{Convergence, NewtonOptions};

use super::plan::Planner;
use super::{OptionValue, method};
use crate::message::Message;

/// The relative tolerance of methods by series, unless another is given.
const SERIES: f64 = 1e-15;
/// Their tolerance as a part of one for the end of the run. A digit costs them little.
const PER_STEP: f64 = 0.01;

impl Planner<'_> {
    pub(super) fn tolerances(&mut self, choice: &Choice, pace: Option<Pace>) -> Tolerances {
        let front = self.request.front;
        let mut tolerances = Tolerances::default();
        if matches!(choice, Choice::Taylor | Choice::LieTaylor) {
            tolerances.rtol = match pace {
                Some(Pace::Tolerance(overall)) => (PER_STEP * overall).max(SERIES),
                _ => SERIES,
            };
        }
        for (name, owners, place) in [
            (
                "rtol",
                "dopri5, taylor and lie-taylor",
                &mut tolerances.rtol,
            ),
            ("atol", "dopri5", &mut tolerances.atol),
        ] {
            let Some(given) = self.method_option(name) else {
                continue;
            };
            if !method::takes(choice, name) {
                let (id, name) = (choice.id(), front.named(name));
                let text = format!("`{name}` is not an option of {id}: {owners} alone have it");
                let help = format!(
                    "take {}, or leave it out",
                    front.assignment("method", "dopri5")
                );
                self.foreign(&name, given.wrong(text).help(help));
                continue;
            }
            let positive = given.number().and_then(|value| match value > 0.0 {
                true => Ok(value),
                false => {
                    let text = format!("`{name}` is not positive");
                    Err(given.wrong(text).help("give a tolerance such as 1e-9"))
                }
            });
            if let Some(value) = self.keep(positive) {
                *place = value;
            }
        }
        tolerances
    }

    pub(super) fn newton(&mut self, choice: &Choice, pace: Option<Pace>) -> NewtonOptions {
        let front = self.request.front;
        let mut options = NewtonOptions::default();
        let solved = choice.solved().entry();
        let explicit = solved.is_some_and(|method| method.explicit);
        let together = solved.is_some_and(|method| method.fixed_point);
        // on points over the state, which have no equation for Newton's iteration
        let lifted = together && solved.is_some_and(|method| method.preserves.poisson);
        let unknowns =
            solved.map_or(0, |method| method.order as usize / 2) * self.spec.model.dimension();
        let alone =
            lifted || together && (self.spec.model.family.is_some() || unknowns > MOST_UNKNOWNS);
        // the iteration first: the others differ from its defaults
        for name in [
            "iteration",
            "newton-tolerance",
            "max-iterations",
            "converge",
        ] {
            let Some(given) = self.method_option(name) else {
                continue;
            };
            let id = choice.id();
            let instead = if explicit {
                let name = front.named(name);
                let text =
                    format!("`{name}` is an option of implicit methods, and {id} is explicit");
                Some((text, "an implicit method", "midpoint"))
            } else if name == "converge" && !together {
                let text = format!(
                    "`converge` is an option of methods that evaluate their stages together, and {id} does not"
                );
                Some((text, "a method", "gauss16"))
            } else {
                None
            };
            if let Some((text, what, example)) = instead {
                let example = front.assignment("method", example);
                let help = format!("leave it out, or take {what} such as {example}");
                self.foreign(name, given.wrong(text).help(help));
                continue;
            }
            if alone
                && matches!(
                    (name, given.text.trim()),
                    ("iteration", "newton" | "simplified")
                )
            {
                let system = &self.spec.model.name;
                let text = format!("{id} is solved by fixed-point iteration alone on {system}");
                self.foreign(name, given.wrong(text).help("leave it out"));
                continue;
            }
            let set = match name {
                "iteration" => iteration(&given).map(|found| options = found),
                "newton-tolerance" => tolerance(&given).map(|found| options.tolerance = found),
                "converge" => self
                    .convergence(&given, pace)
                    .map(|found| options.convergence = found),
                _ => count(&given).map(|found| options.max_iterations = found),
            };
            self.keep(set);
        }
        let map = match options.convergence {
            Convergence::Map => together,
            Convergence::Claimed => lifted,
            Convergence::State | Convergence::Tolerance => false,
        };
        if map && let Some(given) = self.method_option("newton-tolerance") {
            let id = choice.id();
            let text =
                format!("the iteration of {id} ends where its map has converged, by no tolerance");
            let help = format!(
                "leave it out, or give {} too",
                front.assignment("converge", "state")
            );
            self.foreign("newton-tolerance", given.wrong(text).help(help));
        }
        options
    }

    fn convergence(&self, given: &OptionValue, pace: Option<Pace>) -> Result<Convergence, Message> {
        match given.text.trim() {
            "tolerance" if matches!(pace, Some(Pace::Step(_))) => {
                let message =
                    given.wrong("the run has no tolerance to which anything could converge");
                let example = self.request.front.assignment("tol", "1e-6");
                Err(message.help(format!(
                    "give {example} in place of the step, or write `state`"
                )))
            }
            "state" => Ok(Convergence::State),
            "map" => Ok(Convergence::Map),
            "tolerance" => Ok(Convergence::Tolerance),
            other => {
                let message = given.wrong(format!("unknown criterion of convergence `{other}`"));
                Err(message.help("write `state`, `map` or `tolerance`"))
            }
        }
    }
}

fn iteration(given: &OptionValue) -> Result<NewtonOptions, Message> {
    match given.text.trim() {
        "automatic" => Ok(NewtonOptions::default()),
        "newton" => Ok(NewtonOptions::newton()),
        "simplified" => Ok(NewtonOptions::simplified()),
        "fixed-point" => Ok(NewtonOptions::fixed_point()),
        other => {
            let message = given.wrong(format!("unknown iteration `{other}`"));
            Err(message.help("write `automatic`, `newton`, `simplified` or `fixed-point`"))
        }
    }
}

fn tolerance(given: &OptionValue) -> Result<f64, Message> {
    let value = given.number()?;
    if value < 0.0 {
        let message = given.wrong("a tolerance cannot be negative");
        return Err(message.help("give a number of units of round-off such as 1/1024"));
    }
    Ok(value)
}

fn count(given: &OptionValue) -> Result<u32, Message> {
    let help = "give a number of iterations such as 50";
    let value = given.count().map_err(|message| message.help(help))?;
    u32::try_from(value).map_err(|_| {
        given
            .wrong("more iterations than can be counted")
            .help(help)
    })
}
