//! The block `vectors`.

use super::entry::{Entry, inside};
use crate::ast::{Expr, Name};
use crate::diagnostic::{Diagnostic, Kind, Report};
use crate::front::token::{Delimiter, Token, span, split_commas};
use crate::front::vectors::{Declared, Value};
use crate::front::{Names, expression, item};

/// `{ Pi = (m1, m2, m3); A = [[a11, a12], [a12, a22]]; }`; one with a mistake is left out.
pub fn read(block: &[Entry<'_>], names: &Names, report: &mut Report) -> Vec<Declared> {
    let declared = block.iter();
    declared
        .filter_map(|entry| vector(entry, names, report))
        .collect()
}

fn vector(entry: &Entry<'_>, names: &Names, report: &mut Report) -> Option<Declared> {
    let (name, value) = item::definition(entry.tokens, "a vector", entry.origin(), report)?;
    let value = listed(&name, value, names, report)?;
    Some(Declared { name, value })
}

/// An expression, or entries in brackets.
pub fn value(name: &Name, value: &[Token], names: &Names, report: &mut Report) -> Option<Value> {
    match inside(value, Delimiter::Bracket) {
        Some(_) => listed(name, value, names, report),
        None if value.is_empty() => {
            report.push(item::missing_constant(name.origin));
            None
        }
        None => expression::parse_value(value, names, report),
    }
}

fn listed(name: &Name, value: &[Token], names: &Names, report: &mut Report) -> Option<Value> {
    let list = inside(value, Delimiter::Parenthesis).or(inside(value, Delimiter::Bracket));
    let Some(list) = list else {
        let place = span(value).unwrap_or(name.origin);
        let message = format!(
            "`{}` is a vector or a matrix, and needs its entries",
            name.text
        );
        report.push(
            Diagnostic::new(Kind::Syntax, place, message)
                .help("write `v = (x, y, z);` or `A = [[a, b], [b, c]];`"),
        );
        return None;
    };
    let parts = split_commas(list);
    let mut entries = |parts: Vec<&[Token]>| {
        let parts = parts.into_iter();
        let what = ("an entry", "m1");
        parts
            .map(|part| item::formula(part, what, name.origin, names, report))
            .collect::<Option<Vec<Expr>>>()
    };
    let rows = parts.iter().map(|row| inside(row, Delimiter::Bracket));
    Some(match rows.collect::<Option<Vec<_>>>() {
        Some(rows) if !rows.is_empty() => {
            let rows = rows.into_iter().map(|row| entries(split_commas(row)));
            Value::Matrix(rows.collect::<Option<_>>()?)
        }
        _ => Value::Vector(entries(parts)?),
    })
}
