mod algebra;
mod attitude;
mod branches;
mod casimirs;
mod choices;
mod configuration;
mod constraint;
mod constraint_mistakes;
mod degree;
mod domain;
mod driving;
mod entries;
mod extremes;
mod families;
mod family_lattices;
mod family_pieces;
mod found;
mod functions;
mod idle;
mod legendre;
mod limits;
mod names;
mod own_functions;
mod parametric;
mod poisson;
mod random;
mod realization;
mod remedies;
mod soundness;
mod tables;

use super::*;
use crate::compile::analysed;
use crate::structure::{Effort, Structure};
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Symbol};
use lie_syntax::diagnostic::{Kind, Origin};
use lie_syntax::front::{Body, spec};

/// so(3) with what is given: keys of the spec, each with its JSON.
pub(super) fn so3(extra: &[(&str, &str)]) -> String {
    let algebra = r#"{"basis": ["e1", "e2", "e3"], "brackets": ["[e1, e2] = e3", "[e2, e3] = e1", "[e3, e1] = e2"]}"#;
    system(
        &[
            ("algebra", algebra),
            ("state", r#"["x", "y", "z"]"#),
            ("hamiltonian", r#""x^2 + 2*y^2""#),
        ],
        extra,
    )
}

/// A spec of these keys, those of `extra` instead of or beside the others.
pub(super) fn system(base: &[(&str, &str)], extra: &[(&str, &str)]) -> String {
    let mut keys = vec![("format", "1"), ("name", r#""Test""#)];
    keys.extend(
        base.iter()
            .filter(|(key, _)| extra.iter().all(|(other, _)| other != key)),
    );
    keys.extend(extra);
    let lines: Vec<String> = keys
        .iter()
        .map(|(key, value)| format!("\"{key}\": {value}"))
        .collect();
    format!("{{{}}}", lines.join(",\n"))
}

/// What the checks make of a spec. Every diagnostic must have a place and a remedy.
pub(super) fn run(text: &str) -> (Option<Structure>, Vec<Diagnostic>) {
    let mut report = Report::new();
    let parsed = spec::read(text, &mut report);
    let model = match parsed.body {
        Some(Body::Declaration(declaration)) => {
            analysed(&declaration, Effort::Declaration, &mut report)
        }
        _ => None,
    };
    let diagnostics = report.into_diagnostics();
    for diagnostic in &diagnostics {
        assert!(
            diagnostic.origin.is_some() && diagnostic.help.is_some(),
            "{diagnostic:?}"
        );
    }
    (model, diagnostics)
}

/// A model without errors.
pub(super) fn model(text: &str) -> Structure {
    let (model, diagnostics) = run(text);
    model.unwrap_or_else(|| panic!("{text}\n{diagnostics:#?}"))
}

/// The errors as `kind at: message` with the text that each points at, in the order of the text.
pub(super) fn errors(text: &str) -> Vec<String> {
    let (model, mut diagnostics) = run(text);
    assert_eq!(
        model.is_none(),
        diagnostics.iter().any(|d| !d.warning),
        "{diagnostics:#?}"
    );
    diagnostics.sort_by_key(|d| place(d).0);
    diagnostics
        .iter()
        .map(|d| {
            let (start, end) = place(d);
            format!("{} at {}: {}", d.kind, &text[start..end], d.message)
        })
        .collect()
}

fn place(diagnostic: &Diagnostic) -> (usize, usize) {
    match diagnostic.origin {
        Some(Origin::Text { start, end }) => (start, end),
        _ => (0, 0),
    }
}

/// Asserts that the errors begin with these texts, one each.
#[track_caller]
pub(super) fn expect(text: &str, expected: &[&str]) {
    let found = errors(text);
    assert_eq!(found.len(), expected.len(), "{found:#?}");
    for (found, expected) in found.iter().zip(expected) {
        assert!(
            found.starts_with(expected),
            "{found}\n  instead of\n{expected}"
        );
    }
}
