//! The step, and the times at which rows are wanted.

use super::super::values::Given;
use super::Planner;
use crate::message::Message;
use lie_codegen::methods::Choice;
use lie_program::protocol::Times;
use lie_runtime::driver::Pace;

const STEP: &str = "0.01";
const UNTIL: &str = "10";
/// Below this a tolerance is round-off.
const LEAST_TOLERANCE: f64 = 8.0 * f64::EPSILON;

impl Planner<'_> {
    /// Whether the step is to be chosen from a tolerance: a flag replaces what the spec says.
    pub(super) fn wants_tolerance(&self) -> bool {
        let in_spec = !self.in_spec("tol").is_empty();
        self.flags.tol.is_some() || (self.flags.step.is_none() && in_spec)
    }

    /// The step, or the tolerance from which it is chosen.
    pub(super) fn pace(&mut self) -> Option<(Pace, Given)> {
        if !self.wants_tolerance() {
            return self.step().map(|(step, given)| (Pace::Step(step), given));
        }
        let given = self.given("--tol", self.flags.tol.as_ref())?;
        let both = match self.flags.tol {
            Some(_) => self.flags.step.is_some(),
            None => !self.in_spec("step").is_empty(),
        };
        if both {
            let message = given.wrong("a tolerance and a step are both given");
            let help = "a tolerance chooses the step: leave one of them out";
            self.mistakes.push(message.help(help));
            return None;
        }
        let tolerance = self.keep(given.number())?;
        if !(LEAST_TOLERANCE..1.0).contains(&tolerance) {
            let message = given.wrong("a tolerance lies between 2e-15, which is round-off, and 1");
            let help = "give the relative error that the end may have, such as 1e-9";
            self.mistakes.push(message.help(help));
            return None;
        }
        Some((Pace::Tolerance(tolerance), given))
    }

    /// dopri5 has tolerances of its own, and no constant step to choose.
    pub(super) fn takes_tolerance(&mut self, method: &Choice, given: &Given) {
        if *method == Choice::Dopri5 {
            let text = format!("{} chooses its own steps", method.id());
            let help = "give `--rtol` and `--atol` with `--step`, or take another method";
            self.mistakes.push(given.wrong(text).help(help));
        }
    }

    fn step(&mut self) -> Option<(f64, Given)> {
        let given = self.given("--step", self.flags.step.as_ref());
        let fallback = given.is_none();
        let given = given.unwrap_or_else(|| Given::flag("--step", STEP));
        let step = self.keep(given.number())?;
        if step == 0.0 {
            let message = given
                .wrong("the step is zero")
                .help("give a step such as 0.01; negative to go backwards");
            self.mistakes.push(message);
            return None;
        }
        // Without a step of the user's, the direction is that of the end.
        let backwards = fallback
            && self
                .ends()
                .iter()
                .any(|end| end.number().is_ok_and(|end| end < 0.0));
        if backwards {
            return Some((-step, Given::flag("--step", &format!("-{STEP}"))));
        }
        Some((step, given))
    }

    /// The final time, or the times asked for.
    fn ends(&self) -> Vec<Given> {
        let flags = self.flags;
        match (&flags.at, &flags.until) {
            (Some(at), _) => Given::flag("--at", at).split(),
            (None, Some(until)) => vec![Given::flag("--until", until)],
            (None, None) if flags.every.is_none() && !self.in_spec("at").is_empty() => {
                self.in_spec("at")
            }
            (None, None) => self
                .in_spec("until")
                .into_iter()
                .next()
                .into_iter()
                .chain(std::iter::once(Given::flag("--until", UNTIL)))
                .take(1)
                .collect(),
        }
    }

    pub(super) fn times(&mut self, pace: Option<&(Pace, Given)>) -> Option<Times> {
        let flags = self.flags;
        for (name, other) in [("--until", &flags.until), ("--every", &flags.every)] {
            if flags.at.is_some() && other.is_some() {
                let text = format!("`--at` excludes `{name}`");
                let help =
                    "with `--at` there is one row per time asked for, and the last one is the end";
                self.mistakes.push(Message::option("--at", text).help(help));
                return None;
            }
        }
        if flags.at.is_none() && flags.until.is_none() && flags.every.is_none() {
            let at = self.in_spec("at");
            for name in ["until", "every"] {
                if let (Some(at), false) = (at.first(), self.in_spec(name).is_empty()) {
                    let text = format!("`at` excludes `{name}` in `run`");
                    self.mistakes
                        .push(at.wrong(text).help(format!("remove `{name}`")));
                    return None;
                }
            }
        }
        let wants_times = flags.at.is_some()
            || (flags.until.is_none() && flags.every.is_none() && !self.in_spec("at").is_empty());
        let ends = self.ends();
        let mut values = Vec::new();
        for end in &ends {
            let value = self.keep(end.number());
            if let (Some(value), Some((Pace::Step(step), given))) = (value, pace) {
                self.compatible(*step, given, value, end);
            }
            values.extend(value);
        }
        if values.len() < ends.len() {
            return None;
        }
        let against = ends
            .iter()
            .zip(&values)
            .find(|(_, value)| *value * values[0] < 0.0);
        if let (Some((end, _)), Some((Pace::Tolerance(_), _))) = (against, pace) {
            let message = end.wrong("the times asked for lie on both sides of t = 0");
            let help = "a run goes one way: make two of it";
            self.mistakes.push(message.help(help));
            return None;
        }
        if wants_times {
            values.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
            return Some(Times::At(values));
        }
        let every = match self.given("--every", flags.every.as_ref()) {
            Some(given) => self.keep(given.count())?,
            None => 1,
        };
        Some(Times::Until {
            end: *values.first()?,
            every,
        })
    }

    /// Whether steps of this size get there.
    fn compatible(&mut self, step: f64, given: &Given, end: f64, end_given: &Given) {
        if end != 0.0 && (end > 0.0) != (step > 0.0) {
            let text = format!(
                "steps of {} never reach {}: their signs differ",
                given.text.trim(),
                end_given.text.trim()
            );
            let help = "backwards in time, both the step and the end are negative";
            self.mistakes.push(end_given.wrong(text).help(help));
        } else if end / step > 9e15 {
            let steps = end / step;
            let text = match steps.is_finite() {
                true => format!("{steps:.1e} steps are more than can be counted"),
                false => format!("so many steps of {} cannot be counted", given.text.trim()),
            };
            self.mistakes.push(
                given
                    .wrong(text)
                    .help("take a larger step or an earlier end"),
            );
        }
    }
}
