//! Tests of the front ends: kinds and exact places of mistakes, meanings of expressions.

use super::{Names, parse_expression_text};
use crate::ast::{Expr, ExprKind, Index};
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};

mod constraint;
mod declaration;
mod expression;
mod families;
mod habits;
mod robustness;
mod spec;

/// The expression with every operation in parentheses.
fn explicit(expression: &Expr) -> String {
    let join = |operands: &[(bool, Expr)], signs: [&str; 2]| {
        let mut text = String::from("(");
        for (at, (inverse, operand)) in operands.iter().enumerate() {
            if at > 0 || *inverse {
                text.push_str(signs[usize::from(*inverse)]);
            }
            text.push_str(&explicit(operand));
        }
        text + ")"
    };
    match &expression.kind {
        ExprKind::Number(value) => value.to_string(),
        ExprKind::Name { name, index: None } => name.clone(),
        ExprKind::Name {
            name,
            index: Some(index),
        } => {
            let Index {
                variable, offset, ..
            } = &**index;
            format!(
                "{name}[{}{offset:+}]",
                variable.as_ref().map_or("", |v| &v.text)
            )
        }
        ExprKind::Negative(a) => format!("(-{})", explicit(a)),
        ExprKind::Sum(terms) => join(terms, ["+", "-"]),
        ExprKind::Product(factors) => join(factors, ["*", "/"]),
        ExprKind::Power(a, b) => format!("({}^{})", explicit(a), explicit(b)),
        ExprKind::Call {
            function,
            arguments,
        } => {
            let arguments: Vec<String> = arguments.iter().map(explicit).collect();
            format!("{}({})", function.text, arguments.join(","))
        }
        ExprKind::IndexedSum {
            index,
            from,
            to,
            body,
        } => {
            format!(
                "sum({} in {}..{}: {})",
                index.text,
                explicit(from),
                explicit(to),
                explicit(body)
            )
        }
    }
}

/// The names that expressions of these tests may use.
fn names() -> Names {
    ["x", "y", "z", "e3", "ω", "Π", "Δ", "a", "b", "c"]
        .into_iter()
        .collect()
}

fn parse(text: &str) -> Result<Expr, Vec<Diagnostic>> {
    let mut report = Report::new();
    let expression = parse_expression_text(text, 0, &names(), &mut report);
    report.gate()?;
    Ok(expression.expect("without a mistake there is an expression"))
}

/// The kinds of the mistakes and the parts of `text` at which they were reported.
fn places<'t>(text: &'t str, diagnostics: &[Diagnostic]) -> Vec<(Kind, &'t str)> {
    let place = |d: &Diagnostic| match d.origin {
        Some(Origin::Text { start, end }) => (d.kind, &text[start..end]),
        other => panic!("no place in the text: {other:?}"),
    };
    diagnostics.iter().map(place).collect()
}
