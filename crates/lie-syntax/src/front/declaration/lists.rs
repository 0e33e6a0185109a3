//! Lists in brackets: methods, and the initial state.

use super::entry::{compact, inside};
use super::statement::Statement;
use crate::ast::{Expr, Name};
use crate::diagnostic::{Diagnostic, Kind, Report};
use crate::front::token::{Delimiter, Token, TokenKind, render, span, split_commas};
use crate::front::{Names, item};

/// The parts of `= [a, b]`.
fn bracketed<'a>(
    statement: &Statement<'a>,
    example: &str,
    report: &mut Report,
) -> Vec<&'a [Token]> {
    let Some(value) = statement.value(report) else {
        return Vec::new();
    };
    let list = inside(value, Delimiter::Bracket);
    if list.is_none() {
        let place = span(value).unwrap_or(statement.origin);
        let message = format!("`{}` is a list in brackets", statement.keyword);
        report
            .push(Diagnostic::new(Kind::Syntax, place, message).help(format!("write `{example}`")));
    }
    split_commas(list.unwrap_or_default())
}

/// Ids such as `lie-midpoint` or `compose4(midpoint)`: words, dashes and parentheses.
pub fn methods(statement: &Statement<'_>, report: &mut Report) -> Vec<Name> {
    let parts = bracketed(statement, "methods = [lie-midpoint, gauss4];", report);
    let method = |part: &[Token]| {
        let place = span(part).unwrap_or(statement.origin);
        let word = |t: &Token| {
            t.identifier().is_some()
                || t.is('-')
                || matches!(
                    t.kind,
                    TokenKind::Open(Delimiter::Parenthesis)
                        | TokenKind::Close(Delimiter::Parenthesis)
                )
        };
        if part.is_empty() || !part.iter().all(word) {
            report.push(
                Diagnostic::new(
                    Kind::Syntax,
                    place,
                    format!("`{}` is not a method id", render(part)),
                )
                .help("ids are like lie-midpoint or gauss4, without quotes"),
            );
            return None;
        }
        Some(Name {
            text: compact(part),
            origin: place,
        })
    };
    parts.into_iter().filter_map(method).collect()
}

/// Exact expressions in parameters.
pub fn initial(statement: &Statement<'_>, names: &Names, report: &mut Report) -> Vec<Expr> {
    let parts = bracketed(statement, "initial = [0.3, -1/2];", report);
    let value = |part: &[Token]| {
        item::formula(
            part,
            ("an initial value", "cos(11/10)"),
            statement.origin,
            names,
            report,
        )
    };
    parts.into_iter().filter_map(value).collect()
}
