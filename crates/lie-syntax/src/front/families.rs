//! Indexed names and sums, `x[i+1]` and `sum(i in 0..N: …)`.
//!
//! The parser reads them into the tree; [`refuse`] turns them away where the declaration is none of a family.

use super::entries::Read;
use super::expression::Parser;
use super::item;
use super::named;
use super::token::{Cursor, render, span};
use super::token::{Delimiter, Token, TokenKind};
use crate::ast::{BONDS, Expr, ExprKind, Index, Name, Size};
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};
use lie_core::lattice::AXES;
use lie_symbolic::exact::Rational;

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
        "indexed names and sums belong to families, and this declaration is none",
    )
    .help("a family has an algebra such as `so(3)^N` and a state such as `x[i]`; else write the copies out, as in x1, x2, x3")
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

/// The rest of `sum(i in from..to: body)`, or of `sum(i in from..to, j in from..to: body)`, after the word `sum`.
pub(super) fn indexed_sum<'a>(parser: &mut Parser<'a>, word: &'a Token) -> Option<Expr> {
    let open = parser.cursor.advance()?;
    let over_bonds = parser.cursor.peek().filter(|token| token.is_word(BONDS));
    if let Some(bonds) = over_bonds
        && parser.cursor.ahead(1).is_some_and(|token| token.is(':'))
    {
        parser.cursor.advance();
        return over(parser, word, open, vec![of_bonds(bonds.origin)]);
    }
    let mut ranges = vec![range(parser, word)?];
    while parser.cursor.eat(',').is_some() {
        ranges.push(range(parser, word)?);
    }
    over(parser, word, open, ranges)
}

/// The index of a sum with its ends.
type Range = (Name, Expr, Expr);

/// A sum over bonds has their word in the place of an index, and no ends.
fn of_bonds(origin: Origin) -> Range {
    let text = BONDS.to_owned();
    let none = Expr {
        kind: ExprKind::Number(Rational::ZERO),
        origin,
    };
    (Name { text, origin }, none.clone(), none)
}

/// `: body)`
fn over<'a>(
    parser: &mut Parser<'a>,
    word: &'a Token,
    open: &'a Token,
    ranges: Vec<Range>,
) -> Option<Expr> {
    expect(parser, ':', word)?;
    let body = parser.sum()?;
    let origin = word
        .origin
        .join(parser.close(open, Delimiter::Parenthesis)?);
    let sum = |body: Expr, (index, from, to): (Name, Expr, Expr)| Expr {
        kind: ExprKind::IndexedSum {
            index: Box::new(index),
            from: Box::new(from),
            to: Box::new(to),
            body: Box::new(body),
        },
        origin,
    };
    Some(ranges.into_iter().rev().fold(body, sum))
}

/// `i in from..to`
fn range<'a>(parser: &mut Parser<'a>, word: &'a Token) -> Option<(Name, Expr, Expr)> {
    let index = parser.cursor.peek().and_then(|t| {
        Some(Name {
            text: t.identifier()?.to_owned(),
            origin: t.origin,
        })
    });
    if index.as_ref().is_some_and(|index| index.text == BONDS) {
        let message = "`bonds` is the word for bonds in a sum, and no index of sites";
        let help = "write `sum(bonds: value*x[i]*x[j])`, or another name for the index";
        parser.fail(Diagnostic::new(Kind::Syntax, word.origin, message).help(help));
        return None;
    }
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
    Some((index, from, to))
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
    let mut along_axes = vec![one_index(parser, open)?];
    while let Some(comma) = parser.cursor.eat(',') {
        if along_axes.len() == AXES {
            let message = format!("a site has at most {AXES} indices");
            let help = "write `x[i]`, `x[i, j]` or `x[i, j, k]`, as many indices as the state has";
            parser.fail(Diagnostic::new(Kind::Syntax, comma.origin, message).help(help));
            return None;
        }
        along_axes.push(one_index(parser, open)?);
    }
    let joined = |next: Option<Box<Index>>, index| Some(Box::new(Index { next, ..index }));
    let index = along_axes.into_iter().rfold(None, joined);
    let end = parser.close(open, Delimiter::Bracket)?;
    Some((index.map(|index| *index), name.origin.join(end)))
}

/// `i`, `i+1`, `i-2` or `0`
fn one_index<'a>(parser: &mut Parser<'a>, open: &'a Token) -> Option<Index> {
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
    Some(Index {
        variable,
        offset,
        next: None,
    })
}

/// A name of the state with its indices, `x[i]`, `x[i, j]` or `x[i, j, k]`; none where it is another text.
pub(super) fn indexed_state(tokens: &[Token]) -> Option<(Name, Vec<Name>)> {
    let name = |token: &Token| {
        Some(Name {
            text: token.identifier()?.to_owned(),
            origin: token.origin,
        })
    };
    let [first, open, inside @ .., close] = tokens else {
        return None;
    };
    let brackets = open.kind == TokenKind::Open(Delimiter::Bracket)
        && close.kind == TokenKind::Close(Delimiter::Bracket);
    let indices = listed(inside, name).filter(|_| brackets)?;
    Some((name(first)?, indices))
}

/// What each token between commas is, of which there is at least one.
fn listed<T>(tokens: &[Token], one: impl Fn(&Token) -> Option<T>) -> Option<Vec<T>> {
    let parts = tokens.split(|token| token.is(','));
    let parts = parts.map(|part| match part {
        [token] => one(token),
        _ => None,
    });
    parts.collect()
}

/// A coordinate of the state as it is written, of a family with its indices, `x[i]`: what a force is given for.
pub(super) fn written(name: &Name, indices: &[Name]) -> String {
    let indices: Vec<&str> = indices.iter().map(|index| index.text.as_str()).collect();
    match indices.as_slice() {
        [] => name.text.clone(),
        indices => format!("{}[{}]", name.text, indices.join(", ")),
    }
}

/// The name for which a force is given: a coordinate, one of a family with its indices, or a vector.
pub(super) fn target(tokens: &[Token], place: Origin, report: &mut Report) -> Option<Name> {
    match indexed_state(tokens) {
        Some((name, indices)) => Some(Name {
            text: written(&name, &indices),
            origin: span(tokens).unwrap_or(place),
        }),
        None if tokens
            .get(1)
            .is_some_and(|token| token.kind == TokenKind::Open(Delimiter::Bracket)) =>
        {
            let message = "a force is given for a coordinate as it stands in the state";
            let help = "write `x[i]` where the state of a family has `x[i]`, else the name alone";
            let place = span(tokens).unwrap_or(place);
            report.push(Diagnostic::new(Kind::Syntax, place, message).help(help));
            None
        }
        None => item::name(tokens, place, report),
    }
}

/// The names of a state, of a family with their indices, all the same.
pub(super) fn same_indices(
    state: Vec<(Name, Vec<Name>)>,
    report: &mut Report,
) -> (Vec<Name>, Vec<Name>) {
    let texts = |names: &[Name]| -> Vec<String> { names.iter().map(|n| n.text.clone()).collect() };
    let first = state.first().map_or_else(Vec::new, |(_, i)| i.clone());
    for (name, indices) in &state {
        if texts(indices) != texts(&first) {
            let message = format!(
                "`{}` has other indices than the first coordinate",
                name.text
            );
            let help = format!("write `{}[{}]`", name.text, texts(&first).join(", "));
            report.push(Diagnostic::new(Kind::Syntax, name.origin, message).help(help));
        }
    }
    (state.into_iter().map(|(name, _)| name).collect(), first)
}

/// The algebra of a site of a family, by its name, and the number of copies.
pub(super) fn algebra(tokens: &[Token], place: Origin, report: &mut Report) -> Option<Read> {
    let (site, sizes) = power(tokens, place, report)?;
    let named = named::parse(site, place, report)?;
    let read = named::standard(&named, place);
    Some(Read { sizes, ..read })
}

/// What stands before the last `^` of the algebra of a family, and the sizes behind it: `N`, `64`, `(N, M)` or `(L, N, M)`.
fn power<'a>(
    tokens: &'a [Token],
    whole: Origin,
    report: &mut Report,
) -> Option<(&'a [Token], Vec<Size>)> {
    let caret = tokens.iter().rposition(|token| token.is('^'));
    let sizes = caret.and_then(|at| Some((&tokens[..at], sizes(&tokens[at + 1..])?)));
    if sizes.is_none() {
        let place = span(tokens).unwrap_or(whole);
        let message = format!(
            "the state has an index, and the algebra `{}` no number of copies",
            render(tokens)
        );
        let help = "write the algebra as `so(3)^N`, with N a parameter or a number; of a lattice as `so(3)^(N, M)` or `so(3)^(L, N, M)`";
        report.push(Diagnostic::new(Kind::Syntax, place, message).help(help));
    }
    sizes
}

fn sizes(tokens: &[Token]) -> Option<Vec<Size>> {
    let size = |token: &Token| match &token.kind {
        TokenKind::Identifier(text) => Some(Size::Parameter(Name {
            text: text.clone(),
            origin: token.origin,
        })),
        TokenKind::Number(text) if text.bytes().all(|b| b.is_ascii_digit()) => {
            Some(Size::Number(text.parse().ok()?, token.origin))
        }
        _ => None,
    };
    let mut cursor = Cursor::new(tokens);
    if cursor
        .eat_kind(&TokenKind::Open(Delimiter::Parenthesis))
        .is_none()
    {
        return match tokens {
            [one] => Some(vec![size(one)?]),
            _ => None,
        };
    }
    let (close, inside) = cursor.rest().split_last()?;
    let is_closed = close.kind == TokenKind::Close(Delimiter::Parenthesis);
    let sizes = listed(inside, size).filter(|_| is_closed)?;
    (sizes.len() > 1).then_some(sizes)
}
