//! Messages about shapes: they name the vectors and their lengths.

use super::Value;
use crate::ast::{Expr, ExprKind, Index};
use crate::characters::excerpt;
use crate::diagnostic::{Diagnostic, Kind, LONGEST_QUOTE, Origin};
use crate::front::habits;

/// What stands between a text and its shape, taken before the expression is expanded.
pub struct Operand {
    /// As it was written, but for spaces.
    pub text: String,
    /// Its place.
    pub origin: Origin,
}

impl Operand {
    /// Of an expression before its expansion.
    pub fn new(expression: &Expr) -> Self {
        Self {
            text: excerpt(&text(expression), LONGEST_QUOTE).into_owned(),
            origin: expression.origin,
        }
    }
}

/// `Pi has 3 entries`, `A is a matrix of 2 by 2`.
fn shape(operand: &Operand, value: &Value) -> String {
    let text = &operand.text;
    match value {
        Value::Scalar(_) => format!("{text} is a scalar"),
        Value::Vector(entries) if entries.len() == 1 => format!("{text} has 1 entry"),
        Value::Vector(entries) => format!("{text} has {} entries", entries.len()),
        Value::Matrix(rows) => {
            let columns = rows.first().map_or(0, Vec::len);
            format!("{text} is a matrix of {} by {columns}", rows.len())
        }
    }
}

/// Operands that do not fit each other or what is done with them.
pub fn mistake<'a>(
    whole: &Operand,
    operands: impl IntoIterator<Item = (&'a Operand, &'a Value)>,
    help: &str,
) -> Diagnostic {
    let operands = operands.into_iter();
    let shapes: Vec<String> = operands
        .map(|(operand, value)| shape(operand, value))
        .collect();
    let message = format!("`{}`: {}", whole.text, shapes.join(", "));
    Diagnostic::new(Kind::Syntax, whole.origin, message).help(help)
}

/// A vector or a matrix where a scalar belongs.
pub fn no_scalar(operand: &Operand, value: &Value) -> Diagnostic {
    let message = format!("{}, and a scalar belongs here", shape(operand, value));
    let help = "make a scalar of it, with dot(v, w), norm(v), norm2(v) or quad(A, v)";
    Diagnostic::new(Kind::Syntax, operand.origin, message).help(help)
}

/// An expression as text.
pub fn text(expression: &Expr) -> String {
    match &expression.kind {
        ExprKind::Number(value) => value.to_string(),
        ExprKind::Name { name, index: None } => name.clone(),
        ExprKind::Name {
            name,
            index: Some(index),
        } => format!("{name}[{}]", place(index)),
        ExprKind::Negative(a) => format!("-{}", operand(a)),
        ExprKind::Power(a, b) => format!("{}^{}", operand(a), operand(b)),
        ExprKind::Sum(terms) => chain(terms, [" + ", " - "]),
        ExprKind::Product(factors) => chain(factors, ["*", "/"]),
        ExprKind::Call {
            function,
            arguments,
        } => {
            let arguments: Vec<String> = arguments.iter().map(text).collect();
            format!("{}({})", function.text, arguments.join(", "))
        }
        ExprKind::IndexedSum { index, .. } => format!("sum({} in …)", index.text),
    }
}

/// `i+1`, or `i+1, j` on a lattice.
fn place(index: &Index) -> String {
    let along = |index: &Index| match (&index.variable, index.offset) {
        (None, offset) => offset.to_string(),
        (Some(i), 0) => i.text.clone(),
        (Some(i), offset) => format!("{}{offset:+}", i.text),
    };
    let all: Vec<String> = index.along_axes().map(along).collect();
    all.join(", ")
}

fn chain(operands: &[(bool, Expr)], signs: [&str; 2]) -> String {
    let mut all = String::new();
    for (at, (second, part)) in operands.iter().enumerate() {
        if at > 0 {
            all += signs[usize::from(*second)];
        }
        all += &operand(part);
    }
    all
}

/// In parentheses, if it has parts.
fn operand(expression: &Expr) -> String {
    let text = text(expression);
    match &expression.kind {
        ExprKind::Name { .. } | ExprKind::Call { .. } => text,
        ExprKind::Number(_) if !text.contains(['/', '-']) => text,
        _ => format!("({text})"),
    }
}

/// A vector or a matrix by which something is divided, or a matrix in a negative power.
pub fn no_quotient(whole: &Operand, operand: &Operand, value: &Value) -> Diagnostic {
    let help = match value {
        Value::Matrix(_) => habits::without("inv").unwrap_or_default(),
        _ => "divide by a scalar, such as norm(v)",
    };
    mistake(whole, [(operand, value)], help)
}

/// Rows and columns; no columns of a vector, neither of a scalar.
pub fn form(value: &Value) -> (usize, usize) {
    match value {
        Value::Scalar(_) => (0, 0),
        Value::Vector(entries) => (entries.len(), 0),
        Value::Matrix(rows) => (rows.len(), rows[0].len()),
    }
}

/// The same with each entry changed.
pub fn each(value: Value, mut change: impl FnMut(Expr) -> Expr) -> Value {
    match value {
        Value::Scalar(entry) => Value::Scalar(change(entry)),
        Value::Vector(entries) => Value::Vector(entries.into_iter().map(change).collect()),
        Value::Matrix(rows) => {
            let rows = rows.into_iter();
            let rows = rows.map(|row| row.into_iter().map(&mut change).collect());
            Value::Matrix(rows.collect())
        }
    }
}
