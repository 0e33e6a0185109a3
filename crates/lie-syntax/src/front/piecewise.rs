//! `piecewise(x < 0: -x, x <= 1: x^2, 2*x - 1)`: the value of the first case whose condition holds, or the last one.
//!
//! In the tree it is `piecewise(a, b, yes, no)`, which is `yes` where `a < b`: every comparison is one of that form.

use super::expression::Parser;
use super::mistakes::render_one;
use super::names::PIECEWISE;
use super::token::{Delimiter, Token};
use crate::ast::{Expr, ExprKind, Name};
use crate::diagnostic::{Diagnostic, Kind, Origin};

const FORM: &str = "the form is `piecewise(x < 0: -x, x)`: conditions with `<`, `<=`, `>` or `>=`, each with its \
                    value, and last a value without a condition";

/// A comparison of two expressions.
struct Condition {
    left: Expr,
    right: Expr,
    /// Whether it is true where both are equal.
    or_equal: bool,
    /// Whether it is true where the left one is larger.
    above: bool,
}

/// The cases behind the word `piecewise`.
pub(super) fn cases<'a>(parser: &mut Parser<'a>, word: &'a Token) -> Option<Expr> {
    let open = parser.cursor.advance()?;
    let mut cases: Vec<(Condition, Expr)> = Vec::new();
    let last = loop {
        let left = parser.sum()?;
        let Some((above, or_equal)) = comparison(parser) else {
            break left;
        };
        let right = parser.sum()?;
        let condition = Condition {
            left,
            right,
            or_equal,
            above,
        };
        expect(parser, ':', word, "a condition has no value")?;
        cases.push((condition, parser.sum()?));
        expect(
            parser,
            ',',
            word,
            "the last value, without a condition, is missing",
        )?;
    };
    if cases.is_empty() {
        parser.fail(mistake(last.origin, "the first case has no condition"));
        return None;
    }
    if let Some(comma) = parser.cursor.peek().filter(|token| token.is(',')) {
        let message = "only the last value has no condition";
        parser.fail(mistake(comma.origin, message));
        return None;
    }
    let origin = word
        .origin
        .join(parser.close(open, Delimiter::Parenthesis)?);
    let cases = cases.into_iter().rev();
    Some(cases.fold(last, |otherwise, (condition, value)| {
        choice(condition, value, otherwise, (word.origin, origin))
    }))
}

/// Takes `<`, `<=`, `>` or `>=`: whether it is true above, and where both sides are equal.
fn comparison(parser: &mut Parser<'_>) -> Option<(bool, bool)> {
    let sign = parser.cursor.peek()?;
    let above = sign.is('>');
    if !above && !sign.is('<') {
        return None;
    }
    parser.cursor.advance();
    Some((above, parser.cursor.eat('=').is_some()))
}

fn choice(
    condition: Condition,
    value: Expr,
    otherwise: Expr,
    (word, origin): (Origin, Origin),
) -> Expr {
    let Condition {
        left,
        right,
        or_equal,
        above,
    } = condition;
    // `a <= b` is no `b < a`
    let (yes, no) = match or_equal {
        true => (otherwise, value),
        false => (value, otherwise),
    };
    let arguments = match above != or_equal {
        true => vec![right, left, yes, no],
        false => vec![left, right, yes, no],
    };
    let function = Name {
        text: PIECEWISE.to_owned(),
        origin: word,
    };
    Expr {
        kind: ExprKind::Call {
            function: Box::new(function),
            arguments,
        },
        origin,
    }
}

fn expect(parser: &mut Parser<'_>, sign: char, word: &Token, missing: &str) -> Option<()> {
    if parser.cursor.eat(sign).is_some() {
        return Some(());
    }
    let diagnostic = match parser.cursor.peek() {
        Some(token) => {
            let message = format!(
                "`{sign}` is missing before `{}`: {missing}",
                render_one(token)
            );
            mistake(token.origin, message)
        }
        None => mistake(word.origin, missing),
    };
    parser.fail(diagnostic);
    None
}

fn mistake(origin: Origin, message: impl Into<String>) -> Diagnostic {
    Diagnostic::new(Kind::Syntax, origin, message).help(FORM)
}
