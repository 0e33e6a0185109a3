//! The sign between a name and its value: what stands for it elsewhere, and equations where none belong.

use super::item;
use super::names::Names;
use super::token::{Cursor, Delimiter, Token, TokenKind, render, span};
use crate::ast::Constraint;
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};

/// What other languages write for `=`, the longer ones first.
const FOREIGN: [&str; 6] = ["===", "==", ":=", "->", "=>", ":"];

/// Takes the `=` and returns its place. What other languages write for it is reported, and reading goes on
/// behind it.
pub fn sign(cursor: &mut Cursor<'_>, report: &mut Report) -> Option<Origin> {
    let comes = |text: &str| {
        let mut signs = text.chars().enumerate();
        signs.all(|(ahead, c)| cursor.ahead(ahead).is_some_and(|t| t.is(c)))
    };
    let Some(foreign) = FOREIGN.into_iter().find(|text| comes(text)) else {
        return cursor.eat('=').map(|equals| equals.origin);
    };
    let start = cursor.position();
    for _ in foreign.chars() {
        cursor.advance();
    }
    let place = span(cursor.tokens_since(start))?;
    let message = format!("`{foreign}` where a value is given");
    report.push(Diagnostic::new(Kind::Syntax, place, message).help("write `=`"));
    Some(place)
}

/// Whether a token begins such a sign.
pub fn begins_sign(token: &Token) -> bool {
    token.is('=') || token.is(':')
}

/// `x^2 + y^2 = 1` for a Casimir or `what` else is kept; whether there is no second side.
pub fn one_side(tokens: &[Token], what: &str, report: &mut Report) -> bool {
    let mut cursor = Cursor::new(tokens);
    // `<=` stands in parentheses
    let equals = cursor
        .take_until(|c| c.peek().is_some_and(|t| t.is('=')))
        .len();
    if equals == 0 || !cursor.peek().is_some_and(|t| t.is('=')) {
        return true;
    }
    let (left, right) = tokens.split_at(equals);
    let place = span(right).unwrap_or(right[0].origin);
    let right = &right[right.iter().take_while(|t| t.is('=')).count()..];
    let left = render(left);
    let constant = !right.iter().any(|token| token.identifier().is_some());
    let help = match constant {
        true => format!("write `{left}`; its value follows from the initial state"),
        false => format!("write `{left} - ({})`", render(right)),
    };
    let message = format!("{what} is a function, not an equation");
    report.push(Diagnostic::new(Kind::Syntax, place, message).help(help));
    false
}

/// `form = value`, an equation between components of the velocity.
pub fn constraint(
    tokens: &[Token],
    whole: Origin,
    names: &Names,
    report: &mut Report,
) -> Option<Constraint> {
    let origin = span(tokens).unwrap_or(whole);
    let mut cursor = Cursor::new(tokens);
    let left = cursor.take_until(|c| c.peek().is_some_and(begins_sign));
    let Some(equals) = sign(&mut cursor, report) else {
        let message = match tokens {
            [] => "a constraint is missing".to_owned(),
            tokens => format!("`{}` is no equation", render(tokens)),
        };
        let help = "write a linear form that is zero, such as `e3 = 0` or `e1 - 2*e2 = 0`";
        report.push(Diagnostic::new(Kind::Syntax, origin, message).help(help));
        return None;
    };
    let right = cursor.rest();
    if let Some(second) = right.iter().find(|token| begins_sign(token)) {
        let message = "a second equation after the first";
        let help = match second.origin {
            Origin::Text { .. } => "write one string for each equation",
            _ => "end each equation with `;`",
        };
        report.push(Diagnostic::new(Kind::Syntax, second.origin, message).help(help));
        return None;
    }
    let example = ("a side of the constraint", "e1 - 2*e2 (or 0)");
    let left = item::formula(left, example, equals, names, report);
    let right = item::formula(right, example, equals, names, report);
    Some(Constraint {
        left: left?,
        right: right?,
        origin,
    })
}

/// `[e1, e2] = e3, [e2, e3] = e1` in one string or statement, behind the first `=`.
pub fn second_bracket(value: &[Token], delimiter: Delimiter) -> Option<Diagnostic> {
    let find = |kind: TokenKind, from: usize| {
        let at = value[from..].iter().position(|token| token.kind == kind)?;
        Some(from + at)
    };
    let open = find(TokenKind::Open(delimiter), 0)?;
    let close = find(TokenKind::Close(delimiter), open)?;
    value.get(close + 1).filter(|token| begins_sign(token))?;
    let bracket = &value[open..=close];
    let place = span(bracket)?;
    let help = match place {
        Origin::Text { .. } => "write one string for each bracket",
        _ => "end each bracket with `;`",
    };
    let message = format!("a second bracket, `{}`, after the first", render(bracket));
    Some(Diagnostic::new(Kind::Syntax, place, message).help(help))
}
