//! What a measurement says about a claim.

use lie_program::protocol::number;
use lie_runtime::methods::StepFailure;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// Whether a claim holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// It does.
    Holds,
    /// It does not.
    Fails,
    /// It is claimed, and nothing that round-off leaves tells whether it holds.
    NotMeasurable,
    /// Nothing is claimed; the number is only shown.
    NotClaimed,
    /// The system has nothing of the kind.
    Absent,
}

fn nothing() -> f64 {
    f64::NAN
}

/// One fact of a method on one system.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct Finding {
    /// The fact.
    pub fact: Cow<'static, str>,
    /// What is claimed, as a number where it is one (an order).
    #[serde(with = "number")]
    pub claim: f64,
    /// What was measured; not a number if it could not be.
    #[serde(with = "number")]
    pub measured: f64,
    /// The largest value at which a claim of zero holds, or the smallest at which an order does.
    #[serde(with = "number")]
    pub bound: f64,
    /// Whether it holds.
    pub verdict: Verdict,
    /// The step of the measurement, which is smaller than the one asked for where that failed; of an order the
    /// largest one that counts. Not a number where nothing was measured.
    #[serde(with = "number")]
    pub step: f64,
    /// The standard error of what was measured from samples; not a number elsewhere.
    #[serde(with = "number", default = "nothing")]
    pub error: f64,
    /// What else there is to say.
    pub note: String,
}

impl Finding {
    /// Something that is claimed to be zero up to `bound`.
    pub(super) fn zero(fact: &'static str, claimed: bool, measured: f64, bound: f64) -> Self {
        let verdict = match claimed {
            false => Verdict::NotClaimed,
            // what is not a number does not hold
            true if measured <= bound => Verdict::Holds,
            true => Verdict::Fails,
        };
        Self {
            fact: fact.into(),
            claim: 0.0,
            measured,
            bound,
            verdict,
            step: f64::NAN,
            error: f64::NAN,
            note: String::new(),
        }
    }

    /// Something that must be equal to the last bit.
    pub(crate) fn exact(fact: &'static str, difference: f64) -> Self {
        Self::zero(fact, true, difference, 0.0)
    }

    /// Something that is claimed to be at least `bound`.
    pub(super) fn at_least(
        fact: &'static str,
        claimed: bool,
        measured: f64,
        claim: f64,
        bound: f64,
    ) -> Self {
        let verdict = match claimed {
            false => Verdict::NotClaimed,
            true if measured >= bound => Verdict::Holds,
            true => Verdict::Fails,
        };
        Self {
            fact: fact.into(),
            claim,
            measured,
            bound,
            verdict,
            step: f64::NAN,
            error: f64::NAN,
            note: String::new(),
        }
    }

    /// Something that is claimed, of which round-off and the error of the reference leave too little to tell.
    pub(super) fn not_measurable(fact: &'static str, claim: f64, bound: f64) -> Self {
        Self {
            verdict: Verdict::NotMeasurable,
            ..Self::at_least(fact, true, f64::NAN, claim, bound)
        }
    }

    /// A measurement that no step size made possible.
    pub(super) fn unmeasured(fact: &'static str, claimed: bool, failure: &StepFailure) -> Self {
        Self::zero(fact, claimed, f64::NAN, 0.0).note(format!("no step succeeds: {failure}"))
    }

    /// A fact about something that the system does not have.
    pub(super) fn absent(fact: &'static str, note: &str) -> Self {
        Self {
            fact: fact.into(),
            claim: 0.0,
            measured: 0.0,
            bound: 0.0,
            verdict: Verdict::Absent,
            step: f64::NAN,
            error: f64::NAN,
            note: note.to_owned(),
        }
    }

    /// Adds the step of the measurement.
    pub(super) fn at_step(mut self, step: f64) -> Self {
        self.step = step;
        self
    }

    /// Adds the standard error.
    pub(super) fn with_error(mut self, error: f64) -> Self {
        self.error = error;
        self
    }

    pub(super) fn note(mut self, note: String) -> Self {
        self.note = note;
        self
    }
}
