//! The mistakes that the expression parser reports, with their remedies.

use super::names::{FUNCTIONS, Names};
use super::operand::operand_text;
use super::token::{Delimiter, Token, TokenKind, render, span};
use crate::diagnostic::{Diagnostic, Kind, Origin};
use crate::suggest::did_you_mean;

/// Characters that Unicode lets stand inside identifiers and that people use for a product.
pub const MIDDLE_DOTS: [char; 2] = ['·', '\u{387}'];

/// Signs that people write for one that the grammar has.
const LOOKALIKES: &[(char, &str)] = &[
    ('·', "*"),
    ('\u{387}', "*"),
    ('⋅', "*"),
    ('×', "*"),
    ('∙', "*"),
    ('•', "*"),
    ('÷', "/"),
    ('∕', "/"),
    ('−', "-"),
    ('–', "-"),
    ('²', "^2"),
    ('³', "^3"),
    ('⁴', "^4"),
    ('√', "sqrt(…)"),
    ('₀', "0"),
    ('₁', "1"),
    ('₂', "2"),
    ('₃', "3"),
];

/// Other names of the functions of the grammar.
const OTHER_NAMES: &[(&str, &str)] = &[
    ("ln", "log"),
    ("arcsin", "asin"),
    ("arccos", "acos"),
    ("arctan", "atan"),
    ("arctan2", "atan2"),
    ("sh", "sinh"),
    ("ch", "cosh"),
    ("th", "tanh"),
    ("tg", "tan"),
];

/// What the grammar has.
const PARTS: &str = "expressions consist of numbers, names, + - * / ^, parentheses and functions";

/// A token that cannot stand where it stands.
pub fn unexpected(token: &Token, before: Option<&Token>) -> Diagnostic {
    let text = render(std::slice::from_ref(token));
    let syntax = |message: String| Diagnostic::new(Kind::Syntax, token.origin, message);
    let after = match before {
        Some(before) => format!(" after `{}`", render(std::slice::from_ref(before))),
        None => " at the beginning".to_owned(),
    };
    match &token.kind {
        TokenKind::Punctuation('*') if before.is_some_and(|t| t.is('*')) => {
            syntax("`**` is not an operator".into()).help("a power is written `^`")
        }
        TokenKind::Punctuation('/') if before.is_some_and(|t| t.is('/')) => {
            syntax("`//` is not an operator".into())
                .help("a quotient is written `/`; an expression has no comments")
        }
        TokenKind::Punctuation(',') if before.is_some_and(ends_operand) => {
            let help = match before.map(|t| &t.kind) {
                Some(TokenKind::Number(_)) => "a decimal number has a point, as in `0.5`",
                _ => "a comma stands between the two arguments of `atan2` only",
            };
            syntax(format!("unexpected `,`{after}")).help(help)
        }
        TokenKind::Punctuation('.') => {
            Diagnostic::new(Kind::Number, token.origin, "a number cannot begin with `.`")
                .help("write the zero, as in `0.5`")
        }
        TokenKind::Punctuation(c) => {
            if let Some((_, sign)) = LOOKALIKES.iter().find(|(other, _)| other == c) {
                return syntax(format!("`{c}` is no sign of the grammar"))
                    .help(format!("write `{sign}`"));
            }
            match c {
                '*' | '/' | '^' | ',' => syntax(format!("an operand is missing before `{c}`"))
                    .help(format!(
                        "write a number, a name or parentheses between the operators{after}"
                    )),
                '=' => syntax(format!("unexpected `=`{after}"))
                    .help("write the expression alone, without `=`"),
                ';' => syntax(format!("unexpected `;`{after}")).help("remove it"),
                '\'' | '"' | '\\' => syntax(format!("unexpected `{c}`{after}")).help(PARTS),
                _ => syntax(format!("unexpected `{}`{after}", c.escape_debug())).help(PARTS),
            }
        }
        TokenKind::Close(_) if before.is_some_and(|t| matches!(t.kind, TokenKind::Open(_))) => {
            syntax("an expression is missing in the parentheses".into())
                .help("write one, or remove them")
        }
        TokenKind::Close(_) if before.is_some_and(ends_operand) => {
            syntax(format!("`{text}` has no opening partner")).help("remove it, or open it before")
        }
        TokenKind::Close(_) => syntax(format!("an operand is missing before `{text}`"))
            .help(format!("write a number, a name or parentheses{after}")),
        TokenKind::Text(_) | TokenKind::Literal(_) => syntax(format!("unexpected {text}{after}"))
            .help("an expression is written without quotes"),
        TokenKind::Open(Delimiter::Bracket | Delimiter::Brace) => {
            syntax(format!("unexpected `{text}`{after}")).help("group with `(` and `)`")
        }
        _ => syntax(format!("unexpected `{text}`{after}")).help(PARTS),
    }
}

fn ends_operand(token: &Token) -> bool {
    matches!(
        token.kind,
        TokenKind::Identifier(_) | TokenKind::Number(_) | TokenKind::Close(_)
    )
}

/// The text ends behind an operator.
pub fn missing_operand(before: &Token) -> Diagnostic {
    let text = render(std::slice::from_ref(before));
    Diagnostic::new(
        Kind::Syntax,
        before.origin,
        format!("an operand is missing after `{text}`"),
    )
    .help("write a number, a name or parentheses behind it")
}

/// An opening delimiter without its partner.
pub fn unclosed(open: &Token) -> Diagnostic {
    let text = render(std::slice::from_ref(open));
    Diagnostic::new(Kind::Syntax, open.origin, format!("`{text}` is not closed"))
        .help("add its closing partner")
}

/// `+x`.
pub fn unary_plus(plus: &Token) -> Diagnostic {
    Diagnostic::new(Kind::Syntax, plus.origin, "there is no unary `+`").help("remove it")
}

/// `2(x+y)`, `x(y)`, `(a)(b)`, `x y`.
pub fn missing_times(left: &[Token], rest: &[Token]) -> Diagnostic {
    let (before, after) = (render(left), operand_text(rest));
    let place = span(left)
        .into_iter()
        .chain(rest.first().map(|t| t.origin))
        .reduce(Origin::to);
    Diagnostic {
        kind: Kind::Syntax,
        message: format!("`*` is missing between `{before}` and `{after}`"),
        origin: place,
        help: Some(format!("write `{before}*{after}`")),
        warning: false,
    }
}

/// `ω·Π`, one identifier to Unicode.
pub fn middle_dot(name: &str, origin: Origin) -> Diagnostic {
    Diagnostic::new(
        Kind::Syntax,
        origin,
        format!("`{name}` contains `·`, which is no operator"),
    )
    .help(format!("write `{}`", name.replace(MIDDLE_DOTS, "*")))
}

/// `r#type`.
pub fn raw_identifier(token: &Token) -> Diagnostic {
    let text = render(std::slice::from_ref(token));
    Diagnostic::new(
        Kind::Syntax,
        token.origin,
        format!("`{text}` is a raw identifier"),
    )
    .help("use another name")
}

/// `1..5`, `1.2.3`, `1.x`.
pub fn malformed_number(tokens: &[Token]) -> Diagnostic {
    Diagnostic {
        kind: Kind::Number,
        message: format!("`{}` is not a number", render(tokens)),
        origin: span(tokens),
        help: Some("numbers are written like 2, 0.5 or 1.5e-3".into()),
        warning: false,
    }
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
    Diagnostic::new(
        Kind::Syntax,
        origin,
        format!("`{name}` is {what} and needs its argument in parentheses"),
    )
    .help(format!("write `{form}`"))
}

/// A call of something that is neither a function nor a name.
pub fn unknown_function(name: &str, origin: Origin, names: &Names) -> Diagnostic {
    let functions = || FUNCTIONS.iter().map(|(name, _)| *name);
    let other = OTHER_NAMES
        .iter()
        .find(|(other, _)| *other == name)
        .map(|(_, name)| *name);
    let help = if let Some(function) = other.or_else(|| did_you_mean(name, functions())) {
        format!("did you mean `{function}`?")
    } else if name == "pow" {
        "a power is written `a^b`".to_owned()
    } else if let Some(near) = did_you_mean(name, names.iter()) {
        format!("did you mean the name `{near}`? A product is written with `*`")
    } else {
        format!(
            "the functions are {}",
            functions().collect::<Vec<_>>().join(", ")
        )
    };
    Diagnostic::new(
        Kind::UnknownFunction,
        origin,
        format!("there is no function `{name}`"),
    )
    .help(help)
}

/// A call with the wrong number of arguments.
pub fn wrong_arity(name: &str, expected: usize, found: usize, origin: Origin) -> Diagnostic {
    let form = if expected == 1 {
        format!("{name}(a)")
    } else {
        format!("{name}(a, b)")
    };
    let plural = if expected == 1 { "" } else { "s" };
    Diagnostic::new(
        Kind::Arity,
        origin,
        format!("`{name}` takes {expected} argument{plural}, not {found}"),
    )
    .help(format!("write `{form}`"))
}
