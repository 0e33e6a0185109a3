//! The step, and the times at which rows are wanted.

use super::plan::Planner;
use super::range::{Range, Words};
use super::{Front, OptionValue};
use crate::message::{Fault, Message};
use lie_codegen::methods::Choice;
use lie_program::protocol::Times;
use lie_runtime::driver::Pace;
use lie_syntax::diagnostic::Kind;

const STEP: &str = "0.01";
/// The time that a run takes where nobody says it.
const UNTIL: f64 = 10.0;
/// So many rows can be asked for by their times: all of them are kept.
const MOST_ROWS: usize = 10_000_000;
/// What excludes what.
const EXCLUSIVE: &[(&str, &[&str])] = &[("at", &["until", "every"]), ("rows", &["at", "every"])];
/// Below this a tolerance is round-off.
const LEAST_TOLERANCE: f64 = 8.0 * f64::EPSILON;

impl Planner<'_> {
    /// Whether the step is to be chosen from a tolerance: who asks replaces what the spec says.
    pub(super) fn wants_tolerance(&self) -> bool {
        let in_spec = !self.in_spec("tol").is_empty();
        self.request.tol.is_some() || (self.request.step.is_none() && in_spec)
    }

    /// The step, or the tolerance from which it is chosen.
    pub(super) fn pace(&mut self) -> Option<(Pace, OptionValue)> {
        if !self.wants_tolerance() {
            return self.step().map(|(step, given)| (Pace::Step(step), given));
        }
        let given = self.option("tol")?;
        let both = match self.request.tol {
            Some(_) => self.request.step.is_some(),
            None => !self.in_spec("step").is_empty(),
        };
        if both {
            let message = given.wrong("a tolerance and a step are both given");
            let help = "a tolerance chooses the step: leave one of them out";
            self.mistakes
                .push(message.help(help).with_fault(Fault::Arguments));
            return None;
        }
        let tolerance = self.keep(given.number())?;
        if !(LEAST_TOLERANCE..1.0).contains(&tolerance) {
            let message = given.wrong("a tolerance lies between 2e-15, which is round-off, and 1");
            let example = self.request.front.assignment("tol", "1e-6");
            let help = format!("give the relative error that the end may have, such as {example}");
            self.mistakes.push(message.help(help));
            return None;
        }
        Some((Pace::Tolerance(tolerance), given))
    }

    /// dopri5 has tolerances of its own, and no constant step to choose.
    pub(super) fn takes_tolerance(&mut self, method: &Choice, given: &OptionValue) {
        if *method == Choice::Dopri5 {
            let option = |name| self.request.front.option(name);
            let text = format!("{} chooses its own steps", method.id());
            let help = format!(
                "give `{}` and `{}` with `{}`, or take another method",
                option("rtol"),
                option("atol"),
                option("step")
            );
            let message = given.wrong(text).help(help);
            self.mistakes.push(message.with_fault(Fault::Method));
        }
    }

    fn step(&mut self) -> Option<(f64, OptionValue)> {
        let front = self.request.front;
        let usual = |text: &str| OptionValue::flag(&front.option("step"), text);
        let given = self.option("step");
        let fallback = given.is_none();
        let given = given.unwrap_or_else(|| usual(STEP));
        let example = front.assignment("step", "0.1");
        let help = format!("give a step such as {example}; negative to go backwards");
        let step = given.number().map_err(|message| match given.is_number() {
            true => message.help(&help),
            false => message,
        });
        let step = self.keep(step)?;
        if step == 0.0 {
            self.mistakes
                .push(given.wrong("the step is zero").help(help));
            return None;
        }
        // Without a step of the user's, the direction is that of the end.
        let from = self.option("from").map_or(Ok(0.0), |from| from.number());
        let from = from.unwrap_or(0.0);
        let backwards = |end: &OptionValue| end.number().is_ok_and(|end| end < from);
        if fallback && self.ends(from).iter().any(backwards) {
            return Some((-step, usual(&format!("-{STEP}"))));
        }
        Some((step, given))
    }

    /// The time at the start.
    pub(super) fn from(&mut self) -> Option<f64> {
        match self.option("from") {
            Some(given) => self.keep(given.number()),
            None => Some(0.0),
        }
    }

    /// Whether rows are wanted at times, which the request or the spec lists.
    fn at_times(&self) -> bool {
        let request = self.request;
        let otherwise =
            request.until.is_some() || request.every.is_some() || request.rows.is_some();
        request.at.is_some() || (!otherwise && !self.in_spec("at").is_empty())
    }

    /// The final time, or the times asked for.
    fn ends(&self, from: f64) -> Vec<OptionValue> {
        let away = |time: f64| (time - from).abs();
        if self.at_times() {
            return self
                .requested("at")
                .map_or_else(|| self.in_spec("at"), |at| at.split());
        }
        // rows at equal distances end the run where nothing else does
        let of_rows = || {
            let range = self.range()?.ok()?;
            let (from, to) = range.ends();
            let order = [(from, range.from), (to, range.to)];
            let farther = order
                .into_iter()
                .max_by(|(a, _), (b, _)| away(*a).total_cmp(&away(*b)));
            farther.map(|(_, given)| given)
        };
        // where other rows than those at the times of the spec are asked for, the last of them is still the end
        let far = |end: &OptionValue| end.number().map_or(0.0, away);
        let last = self.in_spec("at").into_iter();
        let last = last.max_by(|a, b| far(a).total_cmp(&far(b)));
        let usual = || {
            let end = format!("{:?}", from + UNTIL);
            OptionValue::flag(&self.request.front.option("until"), &end)
        };
        let end = self.option("until").or(last).or_else(of_rows);
        vec![end.unwrap_or_else(usual)]
    }

    /// When rows are wanted of a run that starts at a time.
    pub(super) fn times(&mut self, from: f64, pace: Option<&(Pace, OptionValue)>) -> Option<Times> {
        self.exclusive()?;
        let ends = self.ends(from);
        if ends.is_empty() {
            let example = self.request.front.assignment("at", "[0, 1, 2]");
            let option = self.request.front.option("at");
            let message = self.option_mistake("at", format!("`{option}` is empty"));
            let help = format!("give it times, such as {example}");
            self.mistakes.push(message.help(help));
            return None;
        }
        let values: Vec<Option<f64>> = ends.iter().map(|end| self.keep(end.number())).collect();
        let mut values: Vec<f64> = values.into_iter().collect::<Option<_>>()?;
        let mut against = ends.iter().zip(&values);
        let other = |value: f64| (value - from) * (values[0] - from) < 0.0;
        if let Some((end, _)) = against.find(|(_, value)| other(**value)) {
            let message = end.wrong(format!(
                "the times asked for lie on both sides of t = {from}"
            ));
            let help = "a run goes one way: make two of it";
            self.mistakes.push(message.help(help));
            return None;
        }
        if let Some((Pace::Step(step), given)) = pace {
            for (end, value) in ends.iter().zip(&values) {
                self.compatible((*step, given), from, (*value, end));
            }
        }
        if self.at_times() {
            let away = |time: &f64| (time - from).abs();
            let in_order = values.is_sorted_by(|a, b| away(a) <= away(b));
            // who calls takes row k for that of time k
            if self.request.front == Front::Call && self.request.at.is_some() && !in_order {
                let text = "the times of `at` are not in order, as the rows will be";
                let help = "give them from the start on, as with at=sorted(…), backwards at=sorted(…, reverse=True)";
                self.mistakes
                    .push(self.option_mistake("at", text).help(help));
                return None;
            }
            values.sort_by(|a, b| away(a).total_cmp(&away(b)));
            return Some(Times::At(values));
        }
        let end = *values.first()?;
        if let Some(range) = self.range() {
            let range = self.keep(range)?;
            return self.at_equal_distances(&range, (from, end));
        }
        let every = match self.option("every") {
            Some(given) => self.keep(given.count())?,
            None => 1,
        };
        Some(Times::Until { end, every })
    }

    /// `T1:T2:COUNT`, where rows are wanted so.
    fn range(&self) -> Option<Result<Range, Message>> {
        let given = self.requested("rows")?;
        let front = self.request.front;
        let too_many = |count: usize| {
            let text = format!("{count} rows, and {MOST_ROWS} can be asked for by their times");
            let message = Message::new(Kind::Limit, text);
            let every = front.option("every");
            message.help(format!("take fewer, or every K-th step by `{every}`"))
        };
        let words = Words {
            form: "T1:T2:COUNT",
            example: front.assignment("rows", "0:10:101"),
            meaning: "t = 0, 0.1, …, 10",
            what: "rows",
            single: front.assignment("at", "2.5"),
            most: MOST_ROWS,
            too_many: &too_many,
        };
        Some(Range::read(&given, &words))
    }

    /// The rows of a range, which must lie between the start and the end.
    fn at_equal_distances(&mut self, range: &Range, (from, end): (f64, f64)) -> Option<Times> {
        let (first, last) = range.ends();
        let front = self.request.front;
        for (time, given) in [(first, &range.from), (last, &range.to)] {
            let written = given.text.trim();
            let (text, help) = if (time - from) * (end - from) < 0.0 || (end == from && time != end)
            {
                let text = format!("t = {written} lies before the start, t = {from:?}");
                let start = front.option("from");
                (
                    text,
                    format!(
                        "give rows between the start and the end; the start is that of `{start}`"
                    ),
                )
            } else if (time - from).abs() > (end - from).abs() {
                let text = format!("t = {written} lies beyond the end, t = {end:?}");
                let until = front.assignment("until", written);
                (
                    text,
                    format!("give rows that end earlier, or the end by {until}"),
                )
            } else {
                continue;
            };
            self.mistakes.push(given.wrong(text).help(help));
            return None;
        }
        let mut times = range.values();
        if (first - from).abs() > (last - from).abs() {
            times.reverse();
        }
        Some(Times::Within { end, times })
    }

    /// Whether nothing stands beside a list of times.
    fn exclusive(&mut self) -> Option<()> {
        let front = self.request.front;
        for (name, others) in EXCLUSIVE {
            let given = |name: &str| self.request.get(name).is_some();
            let Some(other) = others.iter().find(|other| given(name) && given(other)) else {
                continue;
            };
            let other = front.option(other);
            let why = match *name {
                "at" => "there is one row for each time asked for, and the last one is the end",
                _ => "the rows are those at equal distances",
            };
            let text = format!("`{}` excludes `{other}`", front.option(name));
            let message = self.option_mistake(name, text);
            let message = message.help(format!("{why}: leave out `{other}`"));
            self.mistakes.push(message.with_fault(Fault::Arguments));
            return None;
        }
        if self.request.at.is_none() && self.at_times() {
            let at = self.in_spec("at");
            for name in ["until", "every"] {
                if let (Some(at), false) = (at.first(), self.in_spec(name).is_empty()) {
                    let text = format!("`at` excludes `{name}` in `run`");
                    let message = at.wrong(text).help(format!("remove `{name}`"));
                    self.mistakes.push(message);
                    return None;
                }
            }
        }
        Some(())
    }

    /// Whether steps of this size get there.
    fn compatible(
        &mut self,
        (step, given): (f64, &OptionValue),
        from: f64,
        (end, end_given): (f64, &OptionValue),
    ) {
        let span = end - from;
        let (step_text, end_text) = (given.text.trim(), end_given.text.trim());
        if span != 0.0 && (span > 0.0) != (step > 0.0) {
            let text = match from == 0.0 {
                true => {
                    format!(
                        "steps of {step_text} lead away from t = {end_text}: their signs differ"
                    )
                }
                false => {
                    format!("steps of {step_text} lead from t = {from} away from t = {end_text}")
                }
            };
            let turned = format!("{:?}", -step);
            let example = self.request.front.assignment("step", &turned);
            let help = match from == 0.0 {
                true => format!(
                    "give {example}; backwards in time, both the step and the end are negative"
                ),
                false => format!(
                    "give {example}; backwards in time, the step is negative and the end before the start"
                ),
            };
            self.mistakes.push(end_given.wrong(text).help(help));
        } else if span / step > 9e15 {
            let steps = span / step;
            let text = match steps.is_finite() {
                true => format!("{steps:.1e} steps are more than can be counted"),
                false => format!("so many steps of {step_text} cannot be counted"),
            };
            let message = given.wrong(text);
            let help = "take a larger step or an earlier end";
            self.mistakes.push(message.help(help));
        }
    }
}
