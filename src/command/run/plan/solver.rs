//! Tolerances of adaptive methods, and the solver of implicit ones.

use lie_codegen::methods::Choice;
use lie_program::protocol::Tolerances;
use lie_runtime::driver::Pace;
use lie_runtime::newton::{Convergence, NewtonOptions};

use super::super::values::Given;
use super::{Foreign, Planner};
use crate::command::method;
use crate::message::Message;

/// The relative tolerance of methods by series, unless another is given.
const SERIES: f64 = 1e-15;
/// Their tolerance as a part of one for the end of the run. A digit costs them little.
const PER_STEP: f64 = 0.01;

impl Planner<'_> {
    pub(super) fn tolerances(&mut self, choice: &Choice, pace: Option<Pace>) -> Tolerances {
        let flags = self.flags;
        let mut tolerances = Tolerances::default();
        if matches!(choice, Choice::Taylor | Choice::LieTaylor) {
            tolerances.rtol = match pace {
                Some(Pace::Tolerance(overall)) => (PER_STEP * overall).max(SERIES),
                _ => SERIES,
            };
        }
        let tolerance = "give a tolerance such as 1e-9";
        for (flag, value, place) in [
            ("--rtol", &flags.rtol, &mut tolerances.rtol),
            ("--atol", &flags.atol, &mut tolerances.atol),
        ] {
            let Some(given) = self.given(flag, value.as_ref()) else {
                continue;
            };
            if !method::takes(choice, name(flag)) {
                let of = match flag {
                    "--rtol" => "dopri5, taylor and lie-taylor",
                    _ => "dopri5",
                };
                let text = format!("`{}` is an option of {of} alone", name(flag));
                let help = "add `--method dopri5`, or leave it out";
                self.out_of_place(flag, value.is_some(), given.wrong(text).help(help));
                continue;
            }
            let positive = given.number().and_then(|value| match value > 0.0 {
                true => Ok(value),
                false => {
                    let text = format!("`{}` is not positive", name(flag));
                    Err(given.wrong(text).help(tolerance))
                }
            });
            if let Some(value) = self.keep(positive) {
                *place = value;
            }
        }
        tolerances
    }

    /// An option that the method does not have: a mistake where it was given with the method, of no importance where the
    /// spec gives it and another method was asked for.
    fn out_of_place(&mut self, flag: &str, is_flag: bool, message: Message) {
        if is_flag || (self.flags.method.is_empty() && !self.picks()) {
            self.foreign.push(Foreign {
                name: name(flag).to_owned(),
                message,
                own: false,
            });
        }
    }

    pub(super) fn newton(&mut self, choice: &Choice, pace: Option<Pace>) -> NewtonOptions {
        let flags = &self.flags.solver;
        let mut options = NewtonOptions::default();
        let solved = choice.solved().entry();
        let explicit = solved.is_some_and(|method| method.explicit);
        // the iteration first: the others differ from its defaults
        for (flag, value) in [
            ("--iteration", &flags.iteration),
            ("--newton-tolerance", &flags.newton_tolerance),
            ("--max-iterations", &flags.max_iterations),
            ("--converge", &flags.converge),
        ] {
            let Some(given) = self.given(flag, value.as_ref()) else {
                continue;
            };
            if explicit {
                let (name, id) = (name(flag), choice.id());
                let text =
                    format!("`{name}` is an option of implicit methods, and {id} is explicit");
                let help = "leave it out, or take an implicit method such as `--method midpoint`";
                self.out_of_place(flag, value.is_some(), given.wrong(text).help(help));
                continue;
            }
            let together = solved.is_some_and(|method| method.fixed_point);
            if flag == "--converge" && !together {
                let id = choice.id();
                let text = format!(
                    "`converge` is an option of methods that evaluate their stages together, and {id} does not"
                );
                let help = "leave it out, or take a method such as `--method gauss16`";
                self.out_of_place(flag, value.is_some(), given.wrong(text).help(help));
                continue;
            }
            let set = match flag {
                "--iteration" => iteration(&given).map(|found| options = found),
                "--newton-tolerance" => tolerance(&given).map(|found| options.tolerance = found),
                "--converge" => convergence(&given, pace).map(|found| options.convergence = found),
                _ => count(&given).map(|found| options.max_iterations = found),
            };
            self.keep(set);
        }
        options
    }
}

/// The name of a flag's option in a spec.
fn name(flag: &str) -> &str {
    flag.trim_start_matches('-')
}

fn iteration(given: &Given) -> Result<NewtonOptions, Message> {
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

fn convergence(given: &Given, pace: Option<Pace>) -> Result<Convergence, Message> {
    match given.text.trim() {
        "tolerance" if matches!(pace, Some(Pace::Step(_))) => {
            let message = given.wrong("the run has no tolerance to which anything could converge");
            Err(message.help("give `--tol 1e-6` in place of the step, or write `state`"))
        }
        "state" => Ok(Convergence::State),
        "map" => Ok(Convergence::Map),
        "tolerance" => Ok(Convergence::Tolerance),
        other => {
            let message = given.wrong(format!("`{other}` is nothing that converges"));
            Err(message.help("write `state`, `map` or `tolerance`"))
        }
    }
}

fn tolerance(given: &Given) -> Result<f64, Message> {
    let value = given.number()?;
    if value < 0.0 {
        let message = given.wrong("a tolerance cannot be negative");
        return Err(message.help("give a number of units of round-off such as 1/1024"));
    }
    Ok(value)
}

fn count(given: &Given) -> Result<u32, Message> {
    let help = "give a number of iterations such as 50";
    let value = given.count().map_err(|message| message.help(help))?;
    u32::try_from(value).map_err(|_| {
        given
            .wrong("more iterations than can be counted")
            .help(help)
    })
}
