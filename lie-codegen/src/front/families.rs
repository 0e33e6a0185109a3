//! Indexed names and sums, `x[i+1]` and `sum(i in 0..N: …)`.
//!
//! The parser reads them into the tree; [`refuse`] is the one place that turns them away as long
//! as no later stage takes them.

use super::expression::Parser;
use super::token::{Delimiter, Token, TokenKind};
use crate::ast::{Expr, ExprKind, Index, Name};
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};

/// Reports indexed names and sums; whether there were none.
pub fn refuse(expression: &Expr, report: &mut Report) -> bool {
    // An explicit stack: a sum may have any number of terms.
    let mut pending = vec![expression];
    let mut clean = true;
    while let Some(expression) = pending.pop() {
        match &expression.kind {
            ExprKind::Name {
                name,
                index: Some(index),
            } if index.variable.is_none() => {
                let message = format!(
                    "`{name}[{}]`: coordinates are not elements of a list",
                    index.offset
                );
                report.push(
                    Diagnostic::new(Kind::Syntax, expression.origin, message)
                        .help("write the name of the coordinate as it stands in the state"),
                );
                clean = false;
            }
            ExprKind::IndexedSum { .. } | ExprKind::Name { index: Some(_), .. } => {
                report.push(not_built(expression.origin));
                clean = false;
            }
            ExprKind::Number(_) | ExprKind::Name { .. } => {}
            ExprKind::Negative(a) => pending.push(a),
            ExprKind::Power(a, b) => pending.extend([&**b, &**a]),
            ExprKind::Sum(operands) | ExprKind::Product(operands) => {
                pending.extend(operands.iter().rev().map(|(_, operand)| operand));
            }
            ExprKind::Call { arguments, .. } => pending.extend(arguments.iter().rev()),
        }
    }
    clean
}

/// The answer to the syntax of families.
pub fn not_built(origin: Origin) -> Diagnostic {
    Diagnostic::new(
        Kind::Syntax,
        origin,
        "families of systems (indexed names and sums) are not built yet",
    )
    .help("write the copies out, as in x1, x2, x3")
}

/// `x[0]` or `x[i]` where a name is declared: what stands behind the opening bracket.
pub fn indexed_name(name: &Token, index: &[Token], origin: Origin) -> Diagnostic {
    let (Some(name), [number, _]) = (name.identifier(), index) else {
        return not_built(origin);
    };
    let TokenKind::Number(digits) = &number.kind else {
        return not_built(origin);
    };
    let message =
        format!("`{name}[{digits}]` is not a name: coordinates are not elements of a list");
    Diagnostic::new(Kind::Syntax, origin, message).help(format!("write `{name}{digits}`"))
}

/// The rest of `sum(i in from..to: body)`, after the word `sum`.
pub(super) fn indexed_sum<'a>(parser: &mut Parser<'a>, word: &'a Token) -> Option<Expr> {
    let open = parser.cursor.advance()?;
    let index = parser.cursor.peek().and_then(|t| {
        Some(Name {
            text: t.identifier()?.to_owned(),
            origin: t.origin,
        })
    });
    let has_in = parser.cursor.ahead(1).is_some_and(|t| t.is_word("in"));
    let (Some(index), true) = (index, has_in) else {
        parser.fail(malformed(word.origin));
        return None;
    };
    parser.cursor.advance();
    parser.cursor.advance();
    let outer = std::mem::replace(&mut parser.bounds, true);
    let from = parser.sum()?;
    for sign in ['.', '.'] {
        expect(parser, sign, word)?;
    }
    let to = parser.sum()?;
    parser.bounds = outer;
    expect(parser, ':', word)?;
    let body = parser.sum()?;
    let origin = word.origin.to(parser.close(open, Delimiter::Parenthesis)?);
    let kind = ExprKind::IndexedSum {
        index,
        from: Box::new(from),
        to: Box::new(to),
        body: Box::new(body),
    };
    Some(Expr { kind, origin })
}

fn expect<'a>(parser: &mut Parser<'a>, sign: char, word: &'a Token) -> Option<&'a Token> {
    let token = parser.cursor.eat(sign);
    if token.is_none() {
        let place = parser.cursor.peek().map_or(word.origin, |t| t.origin);
        parser.fail(malformed(place));
    }
    token
}

fn malformed(origin: Origin) -> Diagnostic {
    Diagnostic::new(Kind::Syntax, origin, "malformed indexed sum").help("write `sum(i in 0..N: …)`")
}

/// The index behind a name, if there is one, and the place of both.
pub(super) fn index<'a>(
    parser: &mut Parser<'a>,
    name: &'a Token,
) -> Option<(Option<Index>, Origin)> {
    let Some(open) = parser.cursor.eat_kind(&TokenKind::Open(Delimiter::Bracket)) else {
        return Some((None, name.origin));
    };
    let variable = parser.cursor.peek().and_then(|t| {
        Some(Name {
            text: t.identifier()?.to_owned(),
            origin: t.origin,
        })
    });
    let mut sign = 1;
    if variable.is_some() {
        parser.cursor.advance();
    }
    let signed = if let Some(sign_token) = parser.cursor.eat('-').or_else(|| parser.cursor.eat('+'))
    {
        sign = if sign_token.is('-') { -1 } else { 1 };
        true
    } else {
        variable.is_none()
    };
    let mut offset = 0;
    if signed {
        let token = parser.cursor.advance();
        let value = token.and_then(|t| match &t.kind {
            TokenKind::Number(text) if text.bytes().all(|b| b.is_ascii_digit()) => {
                text.parse::<i64>().ok()
            }
            _ => None,
        });
        let Some(value) = value else {
            let place = token.map_or(open.origin, |t| t.origin);
            parser.fail(
                Diagnostic::new(Kind::Syntax, place, "malformed index")
                    .help("write `x[i]`, `x[i+1]`, `x[i-2]` or `x[0]`"),
            );
            return None;
        };
        offset = sign * value;
    }
    let end = parser.close(open, Delimiter::Bracket)?;
    Some((Some(Index { variable, offset }), name.origin.to(end)))
}
