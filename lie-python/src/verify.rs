//! What methods claim, measured on a system, and its kernels before the declaration.

use crate::talk::Measurement;
use lie_codegen::methods::Choice;
use lie_codegen::model::Parameter;
use lie_codegen::program::Purpose;
use lie_codegen::structure::Structure;
use lie_in_process::evidence::Evidence;
use lie_in_process::spec::Spec;
use lie_in_process::verify::{Results, Row, options};
use lie_measure::verify::{Found, Options};
use lie_program::protocol::Start;
use pyo3::prelude::*;
use std::collections::BTreeMap;

/// A fact: the method, its name, what is claimed, what was measured, the bound, the verdict, a note, the step, the standard error.
type Fact = (String, String, f64, f64, f64, String, String, f64, f64);

/// What was found.
#[derive(IntoPyObject)]
pub struct Facts {
    facts: Vec<Fact>,
    /// What does not hold, in words.
    failures: Vec<String>,
    /// How far each kernel is from the declaration, in units of what is allowed; none of a family.
    kernels: Option<BTreeMap<String, f64>>,
    /// The same of the reference solution, where it is compared.
    reference: Option<f64>,
    /// A line on kernels.
    summary: String,
    complete: bool,
}

/// Verifies at a step, or at one that is found.
pub struct Verification {
    pub step: Option<f64>,
    pub seed: u64,
}

fn fact(row: Row) -> Fact {
    let Row { method, finding } = row;
    let verdict = serde_json::to_value(finding.verdict).unwrap_or_default();
    (
        method,
        finding.fact.to_string(),
        finding.claim,
        finding.measured,
        finding.bound,
        verdict.as_str().unwrap_or_default().to_owned(),
        finding.note.to_string(),
        finding.step,
        finding.error,
    )
}

impl Measurement for Verification {
    const PURPOSE: Purpose = Purpose::Verify;
    const COMMAND: &'static str = "lie verify";
    type Options = Options;
    type Found = Found;
    type Results = Results;
    type Output = Facts;

    /// Every method that applies, at its default options.
    fn usual(model: &Structure) -> Vec<Choice> {
        let known = lie_codegen::methods::applicability(model);
        let apply = known.into_iter().filter(|(_, why)| why.is_none());
        apply
            .filter_map(|(id, _)| Choice::from_id(id).ok())
            .collect()
    }

    fn begin(&self, spec: &Spec, start: &Start) -> PyResult<(Options, Results)> {
        let (text, model) = (&spec.source.text, &spec.model);
        let parameters = model.parameters.iter();
        let value = |p: &Parameter| *start.parameters.get(&p.name).unwrap_or(&p.default_value);
        let parameters: Vec<f64> = parameters.map(value).collect();
        let evidence = Evidence::from_spec(text, model, &parameters);
        let options = options(model, &parameters, self.step, self.seed);
        Ok((options, Results::new(evidence)))
    }

    fn record(results: &mut Results, found: Found) {
        results.record(found);
    }

    fn end(&self, results: Results, _: &Structure, _: &[String], whole: bool) -> Facts {
        let kernels = results.evidence.kernels().map(|kernels| {
            let named = kernels.into_iter();
            named
                .map(|(name, excess)| (name.to_owned(), excess))
                .collect()
        });
        Facts {
            // before the end kernels may be missing
            failures: match whole {
                true => results.failures(),
                false => results.failed_claims(),
            },
            kernels,
            reference: results.evidence.reference_excess(),
            summary: results.evidence.summary(),
            facts: results.rows.into_iter().map(fact).collect(),
            complete: whole,
        }
    }
}
