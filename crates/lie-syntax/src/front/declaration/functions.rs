//! Functions of Rust in the block `functions`.

use proc_macro2::TokenStream;
use syn::parse::Parser;

use super::entry::{Entry, inside};
use crate::ast::OwnFunction;
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};
use crate::front::token::{Delimiter, Token, TokenKind, span, split_commas};
use crate::front::{item, rust};
use lie_symbolic::symbolic::{Declared, MOST_ARGUMENTS, Opaque};

/// Derivatives of an order above this one no method asks for.
const MOST_SMOOTH: i64 = 100;

/// A path as text, and its tokens.
type Path = (String, TokenStream);

/// Whether an entry has arguments behind its name.
pub fn is_own(entry: &Entry<'_>) -> bool {
    let open = TokenKind::Open(Delimiter::Parenthesis);
    entry.tokens.get(1).is_some_and(|token| token.kind == open)
}

/// Those of a block.
pub fn read(block: &[Entry<'_>], report: &mut Report) -> Vec<OwnFunction> {
    let own = block.iter().filter(|entry| is_own(entry));
    own.filter_map(|entry| function(entry, report)).collect()
}

/// `gravity(r) = crate::gravity, derivatives (crate::slope), smooth 2`
fn function(entry: &Entry<'_>, report: &mut Report) -> Option<OwnFunction> {
    let tokens = entry.tokens;
    let place = span(tokens).unwrap_or(entry.origin());
    let close = TokenKind::Close(Delimiter::Parenthesis);
    let end = tokens.iter().position(|token| token.kind == close);
    let Some((head, rest)) = end.and_then(|end| tokens.split_at_checked(end + 1)) else {
        return malformed(place, report);
    };
    let name = item::name(&head[..1], entry.origin(), report)?;
    let arguments = split_commas(inside(&head[1..], Delimiter::Parenthesis).unwrap_or_default());
    for argument in &arguments {
        item::name(argument, place, report)?;
    }
    let arity = arguments.len();
    if arity == 0 || arity > MOST_ARGUMENTS {
        let message = format!("`{}` has {arity} arguments", name.text);
        let help = format!("a function of Rust has from 1 to {MOST_ARGUMENTS} arguments");
        let place = span(head).unwrap_or(place);
        report.push(Diagnostic::new(Kind::Arity, place, message).help(help));
        return None;
    }
    let [equals, value @ ..] = rest else {
        return malformed(place, report);
    };
    if !equals.is('=') {
        return malformed(equals.origin, report);
    }
    let parts = split_commas(value);
    let value = path(parts.first().copied().unwrap_or_default(), place, report)?;
    let (mut slopes, mut smooth) = (Vec::new(), None);
    for part in parts.iter().skip(1) {
        match part {
            [word, list @ ..] if word.is_word("derivatives") && slopes.is_empty() => {
                slopes = derivatives(list, (&name.text, arity), word.origin, report)?;
            }
            [word, value @ ..] if word.is_word("smooth") && smooth.is_none() => {
                smooth = Some(order(value, word.origin, report)?);
            }
            part => return malformed(span(part).unwrap_or(place), report),
        }
    }
    let declared = Declared {
        name: name.text.clone(),
        path: value.0.clone(),
        arity,
        derivatives: slopes.iter().map(|(text, _)| text.clone()).collect(),
        smooth,
    };
    let mut paths = vec![value];
    paths.extend(slopes);
    Some(OwnFunction {
        name,
        function: Opaque::new(declared),
        paths,
    })
}

/// `(crate::by_x, crate::by_y)`
fn derivatives(
    list: &[Token],
    (name, arity): (&str, usize),
    word: Origin,
    report: &mut Report,
) -> Option<Vec<Path>> {
    let place = span(list).unwrap_or(word);
    let Some(parts) = inside(list, Delimiter::Parenthesis).map(split_commas) else {
        return malformed(place, report);
    };
    if parts.len() != arity {
        let message = format!(
            "`{name}` has {arity} arguments, but here are {} derivatives",
            parts.len()
        );
        let help = "give one derivative for each argument, or leave `derivatives` out: dual numbers give them then";
        report.push(Diagnostic::new(Kind::Arity, place, message).help(help));
        return None;
    }
    let parts = parts.into_iter();
    parts.map(|part| path(part, place, report)).collect()
}

/// A path of Rust, which another macro may have given as a group of its own.
fn path(tokens: &[Token], place: Origin, report: &mut Report) -> Option<Path> {
    let invisible = |kind: &TokenKind| {
        let delimiter = Delimiter::Invisible;
        [TokenKind::Open(delimiter), TokenKind::Close(delimiter)].contains(kind)
    };
    let visible = tokens.iter().filter(|token| !invisible(&token.kind));
    let tokens: Vec<Token> = visible.cloned().collect();
    let place = span(&tokens).unwrap_or(place);
    let plain = |token: &Token| token.identifier().is_some() || token.is(':');
    if !tokens.iter().all(plain) {
        return malformed(place, report);
    }
    let stream = rust::stream(&tokens);
    if syn::Path::parse_mod_style.parse2(stream.clone()).is_err() {
        return malformed(place, report);
    }
    let text: String = stream.to_string().split_whitespace().collect();
    Some((text, stream))
}

/// The number of continuous derivatives.
fn order(value: &[Token], word: Origin, report: &mut Report) -> Option<u32> {
    let place = span(value).unwrap_or(word);
    let number = match value {
        [token] => match &token.kind {
            TokenKind::Number(text) => text.parse::<i64>().ok(),
            _ => None,
        },
        _ => None,
    };
    let number = number.filter(|number| *number <= MOST_SMOOTH);
    let order = number.and_then(|number| u32::try_from(number).ok());
    if order.is_none() {
        let message = "`smooth` is followed by the number of continuous derivatives";
        let help =
            "write a whole number, as in `smooth 2`, or leave it out if all of them are continuous";
        report.push(Diagnostic::new(Kind::Number, place, message).help(help));
    }
    order
}

fn malformed<T>(place: Origin, report: &mut Report) -> Option<T> {
    let message = "this is no function of Rust";
    let help = "write `f(x) = crate::f;`, and `derivatives (crate::slope_of_f)` or `smooth 2` behind a comma";
    report.push(Diagnostic::new(Kind::Syntax, place, message).help(help));
    None
}
