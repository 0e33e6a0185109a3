//! What was verified: claims of methods, and kernels before the declaration.

use lie_codegen::structure::Structure;
use lie_measure::facts::{Finding, Verdict};
use lie_measure::verify::{Found, GroundFound as Ground, Options};
use lie_symbolic::prove::joints::reached;
use serde_json::{Value, json};

use crate::evidence::Evidence;
use crate::words::{number, short};

mod thermal;

/// What is asked for of a system with values of its parameters, at a step or at one that is found.
pub fn options(model: &Structure, parameters: &[f64], step: Option<f64>, seed: u64) -> Options {
    let joints = &model.joints;
    let reach = (!joints.is_empty()).then(|| reached(joints, u32::MAX).unwrap_or(0));
    Options {
        seed,
        step,
        reach,
        thermal: thermal::density(model, parameters),
    }
}

/// One fact of one method.
pub struct Row {
    /// The method.
    pub method: String,
    /// What was measured.
    pub finding: Finding,
}

impl Row {
    /// Whether it is claimed and does not hold.
    pub fn fails(&self) -> bool {
        self.finding.verdict == Verdict::Fails
    }

    /// Whether it is claimed.
    pub fn is_claimed(&self) -> bool {
        matches!(self.finding.verdict, Verdict::Holds | Verdict::Fails)
    }

    /// `method: fact is claimed, … was measured, where at most … holds`.
    pub fn failure(&self) -> String {
        let finding = &self.finding;
        let bound = short(finding.bound);
        let allowed = match finding.claim == 0.0 {
            true => format!("at most {bound}"),
            false => format!("at least {bound}"),
        };
        let (fact, measured) = (&finding.fact, short(finding.measured));
        let mut text = format!(
            "{}: {fact} is claimed, {measured} was measured, where {allowed} holds",
            self.method
        );
        if finding.step.is_finite() {
            text.push_str(&format!(" with a step of {}", short(finding.step)));
        }
        if finding.error.is_finite() {
            text.push_str(&format!(", standard error {}", short(finding.error)));
        }
        if !finding.note.is_empty() {
            text.push_str(&format!(" ({})", finding.note));
        }
        text
    }

    /// The same as data.
    pub fn as_json(&self) -> Value {
        let Finding {
            claim,
            measured,
            bound,
            step,
            error,
            ..
        } = self.finding;
        let mut value = json!({
            "claim": number(claim), "measured": number(measured), "bound": number(bound),
            "verdict": self.finding.verdict, "note": self.finding.note, "step": number(step),
        });
        if error.is_finite() {
            value["error"] = number(error);
        }
        value
    }
}

/// What was found so far.
pub struct Results {
    /// What all measurements share.
    pub ground: Option<Ground>,
    /// The facts, method after method.
    pub rows: Vec<Row>,
    /// The kernels before the declaration.
    pub evidence: Evidence,
}

impl Results {
    /// Nothing yet.
    pub fn new(evidence: Evidence) -> Self {
        Self {
            ground: None,
            rows: Vec::new(),
            evidence,
        }
    }

    /// Takes what was found; answers how a method did once all of it is known.
    pub fn record(&mut self, found: Found) -> Option<String> {
        match found {
            Found::Ground(ground) => self.ground = Some(ground),
            Found::Kernel(kernel) => self.evidence.kernel(kernel),
            Found::Reference(solution) => self.evidence.reference(&solution),
            Found::Broken { fact } => self.evidence.broken(fact),
            Found::Unsound { what } => self.evidence.unsound(what),
            Found::Finding { method, finding } => self.rows.push(Row { method, finding }),
            Found::Measured { method } => return Some(self.measured(&method)),
        }
        None
    }

    /// How a method did.
    fn measured(&self, method: &str) -> String {
        let own = || self.rows.iter().filter(|row| row.method == method);
        let failed = own().filter(|row| row.fails());
        let failed: Vec<&str> = failed.map(|row| &*row.finding.fact).collect();
        let claims = own().filter(|row| row.is_claimed()).count();
        match failed.is_empty() {
            true => format!("{method}: {claims} claims hold"),
            false => format!(
                "{method}: {} of {claims} claims fail: {}",
                failed.len(),
                failed.join(", ")
            ),
        }
    }

    /// The claims that do not hold.
    pub fn failed_claims(&self) -> Vec<String> {
        let failed = self.rows.iter().filter(|row| row.fails());
        failed.map(Row::failure).collect()
    }

    /// What does not hold: claims, then what speaks against kernels and measurements.
    pub fn failures(&self) -> Vec<String> {
        let mut failures = self.failed_claims();
        failures.extend(self.evidence.failures());
        failures
    }
}
