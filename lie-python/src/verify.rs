//! What methods claim, measured on a system.

use crate::declaration::{Declaration, choices, runs};
use crate::talk::{not_here, talk};
use lie_codegen::methods::Choice;
use lie_codegen::model::Model;
use lie_codegen::program::Purpose;
use lie_codegen::structure::smoothness;
use lie_measure::verify::{Found, Options};
use lie_program::protocol::Start;
use pyo3::prelude::*;

/// A fact: the method, its name, what is claimed, what was measured, the bound, the verdict, a note, the step.
pub type Fact = (String, String, f64, f64, f64, String, String, f64);

/// What was found.
#[derive(Default)]
pub struct Facts {
    pub facts: Vec<Fact>,
    /// What is wrong with the measurements themselves.
    pub unsound: Vec<String>,
}

impl Facts {
    fn take(&mut self, found: Found) {
        match found {
            Found::Finding { method, finding } => {
                let verdict = serde_json::to_value(finding.verdict).unwrap_or_default();
                self.facts.push((
                    method,
                    finding.fact.to_string(),
                    finding.claim,
                    finding.measured,
                    finding.bound,
                    verdict.as_str().unwrap_or_default().to_owned(),
                    finding.note.to_string(),
                    finding.step,
                ));
            }
            Found::Broken { fact } => self.unsound.push(format!(
                "{fact}: a spoiled map passes, the measurement says nothing"
            )),
            Found::Unsound { what } => self.unsound.push(format!(
                "{what}: an equation with a known solution is not solved correctly"
            )),
            // these are for the command, which compares them with the declaration
            Found::Ground(_)
            | Found::Kernel(_)
            | Found::Reference(_)
            | Found::Measured { .. } => {}
        }
    }
}

/// Every method that applies and runs in Python, at its default options.
fn every(model: &Model) -> Vec<Choice> {
    let known = lie_codegen::methods::applicability(model);
    let apply = known.into_iter().filter(|(_, why)| why.is_none());
    apply
        .filter_map(|(id, _)| Choice::from_id(id).ok())
        .filter(runs)
        .collect()
}

/// Has every claim of these methods measured, of all that apply where none is named.
pub fn verify(
    py: Python<'_>,
    declaration: &Declaration,
    labels: &[String],
    start: Start,
    (step, seed): (Option<f64>, u64),
) -> PyResult<Facts> {
    let made = declaration.with_model(py, |model| {
        let choices = choices(&model, labels, every)?;
        let joints = smoothness::joints(&model);
        let reach =
            (!joints.is_empty()).then(|| smoothness::reached(&joints, u32::MAX).unwrap_or(0));
        let work = lie_in_process::work(&model, &choices, Purpose::Verify, || None);
        Ok((work, choices, reach))
    });
    let (work, choices, reach) =
        made.map_err(|refused: crate::choice::Refused| refused.raise(py))?;
    let work = work.ok_or_else(|| not_here(py, "lie verify"))?;
    let request = lie_measure::Request {
        methods: choices.iter().map(Choice::label).collect(),
        start,
        options: Options { seed, step, reach },
    };
    let mut facts = Facts::default();
    let outcome = talk(py, &*work, &request, |found| facts.take(found))?;
    outcome.checked("verification")?;
    match outcome.interrupted {
        Some(interrupted) => Err(interrupted),
        None => Ok(facts),
    }
}
