//! The mistakes that the expression parser reports, with their remedies.

use super::habits;
use super::names::{FUNCTIONS, Names, arity};
use super::operand::operand_text;
use super::token::{Delimiter, Token, TokenKind, render, span};
use crate::characters::is_invisible;
use crate::diagnostic::{Diagnostic, Kind, Origin};
use crate::hints;
use crate::suggest::did_you_mean;

/// Characters that Unicode lets stand inside identifiers and that people use for a product.
pub const MIDDLE_DOTS: [char; 2] = ['·', '\u{387}'];

/// What the grammar has.
const PARTS: &str = "expressions consist of numbers, names, + - * / ^, parentheses and functions";

/// A token that cannot stand where it stands; `rest` is what comes behind it.
pub fn unexpected(token: &Token, before: Option<&Token>, rest: &[Token]) -> Diagnostic {
    let text = render_one(token);
    let after = match before {
        Some(before) => format!(" after `{}`", render_one(before)),
        None => " at the beginning".to_owned(),
    };
    let (message, help) = match &token.kind {
        TokenKind::Punctuation('.' | ':') if before.is_some_and(ends_operand) => {
            return point(token, before, rest);
        }
        TokenKind::Punctuation('.') => return leading_point(token, rest),
        TokenKind::Punctuation(c) => {
            let twice = before.is_some_and(|t| t.is(*c)).then(|| doubled(*c));
            twice
                .flatten()
                .or_else(|| comma(*c, before, rest, &after))
                .unwrap_or_else(|| sign(*c, &after))
        }
        TokenKind::Close(_) if before.is_some_and(|t| matches!(t.kind, TokenKind::Open(_))) => (
            "an expression is missing in the parentheses".into(),
            "write one, or remove them".into(),
        ),
        TokenKind::Close(_) if before.is_some_and(ends_operand) => (
            format!("unmatched `{text}`"),
            "remove it, or add the opening one before it".into(),
        ),
        TokenKind::Close(_) => (
            format!("an operand is missing before `{text}`"),
            format!("write a number, a name or parentheses{after}"),
        ),
        TokenKind::Text(_) | TokenKind::Literal(_) => (
            format!("unexpected {text}{after}"),
            "an expression is written without quotes".into(),
        ),
        TokenKind::Open(Delimiter::Bracket | Delimiter::Brace) => (
            format!("unexpected `{text}`{after}"),
            "group with `(` and `)`".into(),
        ),
        _ => (format!("unexpected `{text}`{after}"), PARTS.into()),
    };
    syntax(token.origin, message, help)
}

fn syntax(origin: Origin, message: impl Into<String>, help: impl Into<String>) -> Diagnostic {
    Diagnostic::new(Kind::Syntax, origin, message).help(help)
}

/// A token as text.
pub fn render_one(token: &Token) -> String {
    render(std::slice::from_ref(token))
}

/// `**` and `//`
fn doubled(sign: char) -> Option<(String, String)> {
    let help = match sign {
        '*' => "a power is written `^`",
        '/' => "a quotient is written `/`; an expression has no comments",
        _ => return None,
    };
    Some((format!("`{sign}{sign}` is not an operator"), help.into()))
}

/// A comma behind an operand.
fn comma(
    sign: char,
    before: Option<&Token>,
    rest: &[Token],
    after: &str,
) -> Option<(String, String)> {
    let before = before.filter(|before| sign == ',' && ends_operand(before))?;
    let number = |token: &Token| matches!(token.kind, TokenKind::Number(_));
    let behind = rest.first().filter(|token| number(before) && number(token));
    let help = match behind {
        Some(behind) => format!(
            "a decimal number has a point: write `{}.{}`",
            render_one(before),
            render_one(behind)
        ),
        None => "a comma stands between the arguments of a function only".to_owned(),
    };
    Some((format!("unexpected `,`{after}"), help))
}

/// `.5`
fn leading_point(point: &Token, rest: &[Token]) -> Diagnostic {
    let help = match rest.first().map(|token| &token.kind) {
        Some(TokenKind::Number(digits)) => format!("write `0.{digits}`"),
        _ => "write the zero, as in `0.5`".to_owned(),
    };
    Diagnostic::new(Kind::Number, point.origin, "a number cannot begin with `.`").help(help)
}

/// Any other sign where none can stand: message and remedy.
fn sign(sign: char, after: &str) -> (String, String) {
    if let Some(meant) = hints::lookup_character("signs", sign) {
        return (
            format!("`{sign}` is not part of the grammar"),
            format!("write `{meant}`"),
        );
    }
    let unexpected = format!("unexpected `{sign}`{after}");
    match sign {
        '*' | '/' | '^' | ',' => (
            format!("an operand is missing before `{sign}`"),
            format!("write a number, a name or parentheses between the operators{after}"),
        ),
        '=' => (unexpected, "write the expression alone, without `=`".into()),
        ';' => (unexpected, "remove it".into()),
        _ if is_invisible(sign) || sign.is_control() => (
            format!("an invisible character, U+{:04X},{after}", u32::from(sign)),
            "remove it".into(),
        ),
        _ => (unexpected, habits::sign(sign).unwrap_or(PARTS).into()),
    }
}

/// A `.` or `:` behind an operand: a module, a method, an operation by elements.
fn point(token: &Token, before: Option<&Token>, rest: &[Token]) -> Diagnostic {
    let rest = match rest {
        [colon, rest @ ..] if token.is(':') && colon.is(':') => rest,
        rest => rest,
    };
    let module = before.and_then(Token::identifier);
    let (message, help) = match rest.first().map(|t| &t.kind) {
        Some(TokenKind::Identifier(member)) if module.is_some() => (
            format!("`{}` is not a module", module.unwrap_or_default()),
            match arity(member) {
                Some(_) => format!("write `{}`; functions stand alone", operand_text(rest)),
                None if member == "pi" => "write `pi`".to_owned(),
                None => "names and functions stand alone, without a module or an object in front"
                    .to_owned(),
            },
        ),
        Some(TokenKind::Punctuation(sign @ ('*' | '/' | '^'))) if token.is('.') => (
            format!("`.{sign}` is not an operator"),
            format!("write `{sign}`; all quantities are numbers"),
        ),
        _ => {
            let sign = if token.is('.') { '.' } else { ':' };
            (format!("unexpected `{sign}`"), PARTS.to_owned())
        }
    };
    syntax(token.origin, message, help)
}

/// `lambda x: x^2`, `x and y`.
pub fn programming_word(word: &Token) -> Diagnostic {
    let text = render_one(word);
    let message = format!("`{text}` is a word of programming languages");
    syntax(word.origin, message, habits::word(&text).unwrap_or(PARTS))
}

/// `pi()`, `x()`.
pub fn called_name(name: &str, origin: Origin) -> Diagnostic {
    let message = format!("`{name}` is a name and takes no arguments");
    syntax(origin, message, format!("write `{name}`"))
}

/// `Sin[x]`.
pub fn bracketed_call(function: &str, argument: &[Token], origin: Origin) -> Diagnostic {
    let message = format!("the argument of `{function}` stands in parentheses");
    let help = format!("write `{function}({})`", render(argument));
    syntax(origin, message, help)
}

fn ends_operand(token: &Token) -> bool {
    matches!(
        token.kind,
        TokenKind::Identifier(_) | TokenKind::Number(_) | TokenKind::Close(_)
    )
}

/// The text ends behind an operator.
pub fn missing_operand(before: &Token) -> Diagnostic {
    let message = format!("an operand is missing after `{}`", render_one(before));
    let help = "write a number, a name or parentheses behind it";
    syntax(before.origin, message, help)
}

/// An opening delimiter without its partner.
pub fn unclosed(open: &Token) -> Diagnostic {
    let message = format!("`{}` is not closed", render_one(open));
    syntax(open.origin, message, "add its closing partner")
}

/// `+x`.
pub fn unary_plus(plus: &Token) -> Diagnostic {
    syntax(plus.origin, "there is no unary `+`", "remove it")
}

/// `2(x+y)`, `x(y)`, `(a)(b)`, `x y`.
pub fn missing_times(left: &[Token], rest: &[Token]) -> Diagnostic {
    let (before, after) = (render(left), operand_text(rest));
    let place = span(left).into_iter();
    let place = place
        .chain(rest.first().map(|t| t.origin))
        .reduce(Origin::join);
    let message = format!("`*` is missing between `{before}` and `{after}`");
    let diagnostic = Diagnostic {
        origin: place,
        ..Diagnostic::placeless(Kind::Syntax, message)
    };
    diagnostic.help(format!("write `{before}*{after}`"))
}

/// `ω·Π`, one identifier to Unicode.
pub fn middle_dot(name: &str, origin: Origin) -> Diagnostic {
    let message = format!("`{name}` contains `·`, which is not an operator");
    let help = format!("write `{}`", name.replace(MIDDLE_DOTS, "*"));
    syntax(origin, message, help)
}

/// `r#type`.
pub fn raw_identifier(token: &Token) -> Diagnostic {
    let message = format!("`{}` is a raw identifier", render_one(token));
    syntax(token.origin, message, "use another name")
}

/// `1..5`, `1.2.3`, `1.x`.
pub fn malformed_number(tokens: &[Token]) -> Diagnostic {
    let message = format!("`{}` is not a number", render(tokens));
    let help = "numbers are written like 2, 0.5 or 1.5e-3";
    let diagnostic = Diagnostic {
        origin: span(tokens),
        ..Diagnostic::placeless(Kind::Number, message)
    };
    diagnostic.help(help)
}

/// `sin x`, `sin^2(x)`, `sin` alone: `argument` and `power` are what stands behind it.
pub fn function_without_call(
    name: &str,
    argument: &str,
    power: &str,
    origin: Origin,
) -> Diagnostic {
    let argument = match argument.strip_prefix('(') {
        Some(inside) => inside.strip_suffix(')').unwrap_or(inside),
        None if argument.is_empty() => "…",
        None => argument,
    };
    let (what, form) = if name == "sum" {
        ("the indexed sum", "sum(i in 0..N: …)".to_owned())
    } else {
        ("a function", format!("{name}({argument}){power}"))
    };
    let message = format!("`{name}` is {what} and needs its argument in parentheses");
    syntax(origin, message, format!("write `{form}`"))
}

/// A call of something that is neither a function nor a name.
pub fn unknown_function(
    name: &str,
    arguments: &[String],
    origin: Origin,
    names: &Names,
) -> Diagnostic {
    let functions = || FUNCTIONS.iter().map(|function| function.name);
    let help = if let Some(form) = habits::function(name, arguments) {
        format!("write `{form}`")
    } else if let Some(reason) = habits::without(name) {
        reason.to_owned()
    } else if let Some(function) = did_you_mean(name, functions()) {
        format!("did you mean `{function}`?")
    } else if let Some(near) = did_you_mean(name, names.iter()) {
        format!("did you mean the name `{near}`? A product is written with `*`")
    } else {
        format!(
            "the functions are {}",
            functions().collect::<Vec<_>>().join(", ")
        )
    };
    let message = format!("there is no function `{name}`");
    Diagnostic::new(Kind::UnknownFunction, origin, message).help(help)
}

/// A call with the wrong number of arguments.
pub fn wrong_arity(name: &str, expected: usize, found: usize, origin: Origin) -> Diagnostic {
    let form = match (name, found) {
        ("atan", 2) => "atan2(a, b)".to_owned(),
        ("log", 2) => {
            "log(a)/log(b)` for the logarithm of a to the base b, else `log(a)".to_owned()
        }
        ("sqrt", 2) => "a^(1/b)` for a root of order b, else `sqrt(a)".to_owned(),
        _ if expected == 1 => format!("{name}(a)"),
        _ => format!("{name}(a, b)"),
    };
    let plural = if expected == 1 { "" } else { "s" };
    let message = format!("`{name}` takes {expected} argument{plural}, not {found}");
    Diagnostic::new(Kind::Arity, origin, message).help(format!("write `{form}`"))
}
