//! The block `functions`.

use super::entry::{Entry, inside};
use super::functions::is_own;
use crate::ast::{Expr, ExprKind, Name};
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};
use crate::front::item;
use crate::front::tables::{Outside, Read, Written};
use crate::front::token::{Delimiter, Token, render, span, split_commas};
use lie_symbolic::exact::Rational;

/// `{ drag = table [(0, 0), (1, 1/2)], degree 3, outside linear; }`
pub fn read(block: &[Entry<'_>], report: &mut Report) -> Vec<Read> {
    let mut read = Vec::new();
    for entry in block.iter().filter(|entry| !is_own(entry)) {
        let parts = item::definition(entry.tokens, "a function", entry.origin(), report);
        read.extend(parts.map(|(name, value)| {
            let written = table(&name, value, report);
            (name, written)
        }));
    }
    read
}

fn table(name: &Name, value: &[Token], report: &mut Report) -> Option<Written> {
    let parts = split_commas(value);
    let list = parts.first().and_then(|part| match part {
        [word, list @ ..] if word.is_word("table") => inside(list, Delimiter::Bracket),
        _ => None,
    });
    let Some(list) = list else {
        return malformed(name, span(value).unwrap_or(name.origin), report);
    };
    let points = split_commas(list).into_iter();
    let points: Vec<_> = points
        .map(|point| pair(point, name, report))
        .collect::<Option<_>>()?;
    let mut written = Written {
        degree: (cubic(name.origin), name.origin),
        outside: Outside::default(),
        points,
    };
    for part in &parts[1..] {
        let place = span(part).unwrap_or(name.origin);
        match part {
            [word, value @ ..] if word.is_word("degree") && !value.is_empty() => {
                let place = span(value).unwrap_or(place);
                written.degree = (item::constant(value, report)?, place);
            }
            [word, value] if word.is_word("outside") => {
                let text = render(std::slice::from_ref(value));
                written.outside = Outside::read(&text, value.origin, report)?;
            }
            _ => return malformed(name, place, report),
        }
    }
    Some(written)
}

/// `(x, y)`
fn pair(tokens: &[Token], name: &Name, report: &mut Report) -> Option<(Expr, Expr, Origin)> {
    let place = span(tokens).unwrap_or(name.origin);
    let numbers = inside(tokens, Delimiter::Parenthesis).map(split_commas);
    let Some([x, y]) = numbers.as_deref() else {
        return malformed(name, place, report);
    };
    let (x, y) = (item::constant(x, report), item::constant(y, report));
    Some((x?, y?, place))
}

/// The degree where none is given.
fn cubic(origin: Origin) -> Expr {
    Expr {
        kind: ExprKind::Number(Rational::from(3)),
        origin,
    }
}

fn malformed<T>(name: &Name, place: Origin, report: &mut Report) -> Option<T> {
    let message = format!("`{}` is no table", name.text);
    let help = format!(
        "write `{} = table [(0, 0), (1, 1/2)], degree 1;`, and `outside constant` or `outside linear` behind it if the table is to be continued; a function of Rust is `{}(x) = crate::function;`",
        name.text, name.text
    );
    report.push(Diagnostic::new(Kind::Syntax, place, message).help(help));
    None
}
