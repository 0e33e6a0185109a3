//! What is recorded beside state, energy and Casimirs, for programs.

use lie_codegen::model::QuantityKind;
use lie_codegen::structure::Structure;
use lie_codegen::structure::integrals::brackets;
use lie_syntax::ast::BONDS;
use serde_json::{Map, Value, json};

/// Adds first integrals with their brackets, observables, and what has a value for each site, where there are some.
pub fn add(model: &Structure, report: &mut Map<String, Value>) {
    let data = model.family.iter().flat_map(|family| &family.data);
    let data: Vec<Value> = data
        .filter(|data| data.name != BONDS)
        .map(|data| {
            let [least, most] = data.range();
            json!({ "name": data.name, "count": data.values.len(), "min": least, "max": most })
        })
        .collect();
    if let Some(family) = model.family.as_ref().filter(|family| family.has_bonds) {
        let bonds = family.data.last().map_or(0, |bonds| bonds.values.len() / 3);
        report.insert("bonds".into(), bonds.into());
    }
    if !data.is_empty() {
        report.insert("per_site".into(), data.into());
    }
    let of = |kind: QuantityKind| {
        let quantities = model.quantities.iter();
        quantities.filter(move |quantity| quantity.kind == kind)
    };
    let integrals: Vec<Value> = of(QuantityKind::Integral)
        .map(|q| json!({ "name": q.name, "expression": model.display(q.expr) }))
        .collect();
    if !integrals.is_empty() {
        let brackets = brackets(model).into_iter();
        let brackets: Vec<Value> = brackets
            .map(|bracket| json!({ "of": bracket.of, "value": bracket.value.as_deref().unwrap_or("0") }))
            .collect();
        report.insert("integrals".into(), integrals.into());
        report.insert("integral_brackets".into(), brackets.into());
    }
    let observables: Vec<Value> = of(QuantityKind::Observable)
        .map(|q| {
            let expression = model.display_quantity(q);
            json!({ "name": q.name, "expression": expression, "unwrap": q.unwrap })
        })
        .collect();
    if !observables.is_empty() {
        report.insert("observables".into(), observables.into());
    }
}
