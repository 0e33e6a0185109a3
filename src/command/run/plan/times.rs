//! The step, and the times at which rows are wanted.

use super::super::values::Given;
use super::Planner;
use crate::message::Message;
use lie_program::protocol::Times;

const STEP: &str = "0.01";
const UNTIL: &str = "10";

impl Planner<'_> {
    pub(super) fn step(&mut self) -> Option<(f64, Given)> {
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

    pub(super) fn times(&mut self, step: Option<&(f64, Given)>) -> Option<Times> {
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
            if let (Some(value), Some((step, given))) = (value, step) {
                self.compatible(*step, given, value, end);
            }
            values.extend(value);
        }
        if values.len() < ends.len() {
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
            let text = format!("{:.1e} steps are more than can be counted", end / step);
            self.mistakes.push(
                given
                    .wrong(text)
                    .help("take a larger step or an earlier end"),
            );
        }
    }
}
