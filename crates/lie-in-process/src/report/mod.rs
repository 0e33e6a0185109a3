//! What a declaration is, and what can be done with it: the facts behind `lie check`.

mod constraint;
pub mod joints;
pub mod motions;
mod recorded;
pub mod signs;
pub mod splitting;
mod structure;

use lie_codegen::compile;
use lie_codegen::methods::applicability;
use lie_codegen::model::CasimirKind;
use lie_codegen::structure::{Structure, bracket_class};
use lie_runtime::lattice::{AXES, count};
use serde_json::{Value, json};
use splitting::Splitting;

/// What follows from the structure of a system.
pub struct Report {
    /// Kernel, additions, multiplications, divisions, calls.
    pub operations: Vec<(String, [usize; 4])>,
    /// Every method, with the reason where it does not apply.
    pub methods: Vec<(&'static str, Option<String>)>,
    /// The pieces of H whose flows are exact, or why there are none.
    pub splitting: Result<Splitting, String>,
}

impl Report {
    /// The methods, and what their code costs.
    pub fn new(model: &Structure) -> Self {
        let plan = lie_codegen::plan::plan(model, &compile::declared_choices(model));
        let operations = plan
            .counts()
            .into_iter()
            .map(|(kernel, count)| (kernel, [count.add, count.mul, count.div, count.call]))
            .collect();
        Self {
            operations,
            methods: applicability(model),
            splitting: splitting::find(model),
        }
    }

    /// The report for programs: the object of `lie check --json`.
    pub fn json(&self, model: &Structure) -> Value {
        let casimirs: Vec<Value> = model
            .casimirs
            .iter()
            .map(|casimir| {
                json!({
                    "name": casimir.name,
                    "expression": model.display(casimir.expr),
                    "kind": match casimir.kind {
                        CasimirKind::Declared => "declared",
                        CasimirKind::Polynomial => "polynomial",
                        CasimirKind::Rational => "rational",
                        CasimirKind::Function => "function",
                    },
                    "degree": casimir.degree,
                    "kept": casimir.kept,
                })
            })
            .collect();
        let operations: serde_json::Map<String, Value> = self
            .operations
            .iter()
            .map(|(kernel, [add, mul, div, call])| {
                (
                    kernel.clone(),
                    json!({ "add": add, "mul": mul, "div": div, "call": call }),
                )
            })
            .collect();
        let methods: serde_json::Map<String, Value> = self
            .methods
            .iter()
            .map(|(id, reason)| ((*id).to_owned(), reason.clone().into()))
            .collect();
        let acting: Vec<Value> = model
            .acting()
            .into_iter()
            .map(|(what, formula)| json!({ "what": what, "formula": formula }))
            .collect();
        let sites = sites(model).map_or(1, count);
        let (dimension, generic_rank, initial_rank) = model.counts();
        let mut report = json!({
            "name": model.name,
            "dimension": sites.saturating_mul(dimension),
            "generic_rank": sites.saturating_mul(generic_rank),
            "initial_rank": initial_rank,
            "brackets": signs::brackets(model),
            "canonical": signs::canonical(model),
            "casimirs": casimirs,
            "acting": acting,
            "independent_casimirs": sites.saturating_mul(dimension - generic_rank),
            "constants_of_motion": motions::json(model),
            "class": model.algebra.as_ref().map(|report| structure::class(&report.class)),
            "algebra_name": model.algebra.as_ref().and_then(|report| report.name.as_ref().ok()),
            "series": model.algebra.as_ref().map(|report| structure::series(&report.series)),
            "killing": model.algebra.as_ref().map(structure::killing),
            "splitting": splitting::json(&self.splitting),
            "splitting_cost": splitting::cost(&self.splitting),
            "joints": joints::json(&model.joints),
            "orders": joints::orders(&model.joints, &self.methods),
            "operations": operations,
            "methods": methods,
        });
        if let Some(report) = report.as_object_mut() {
            recorded::add(model, report);
            constraint::add(model, report);
            let attitude = model.display_attitude();
            report.extend(attitude.map(|text| ("attitude".to_owned(), text.into())));
            let cocycle = model.cocycle_in_words();
            report.extend(cocycle.map(|text| ("cocycle".to_owned(), text.into())));
            let class = bracket_class::class(model);
            report.extend(class.map(|class| ("bracket_class".to_owned(), class.name().into())));
        }
        report
    }
}

/// Layers, rows and columns of a family with its default parameters.
pub fn sites(model: &Structure) -> Option<[usize; AXES]> {
    model.family.as_ref()?.sites(&model.defaults())
}
