//! The small forms that both front ends share: names, brackets, definitions, constants.

use super::equations;
use super::families;
use super::mistakes;
use super::names::Names;
use super::token::{Cursor, Delimiter, Token, TokenKind, render, span};
use super::{expression, token};
use crate::ast::{Algebra, Bracket, Casimir, Energy, Expr, ExprKind, Invariance, Name, Structure};
use crate::characters::{is_invisible, visible};
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};

/// A name and nothing else. `whole` is the place of an empty text.
pub fn name(tokens: &[Token], whole: Origin, report: &mut Report) -> Option<Name> {
    let place = span(tokens).unwrap_or(whole);
    if let [token] = tokens
        && let Some(text) = token.identifier()
    {
        if text.contains(mistakes::MIDDLE_DOTS) {
            report.push(
                Diagnostic::new(
                    Kind::Syntax,
                    place,
                    format!("`{text}` contains `·`, which is taken for a product"),
                )
                .help("use `_` in names; a product is written with `*`"),
            );
        } else if text.starts_with("r#") {
            report.push(mistakes::raw_identifier(token));
        } else if let Some(hidden) = text.chars().find(|c| is_invisible(*c)) {
            let message = format!(
                "the name `{}` contains U+{:04X}, which is invisible",
                visible(text),
                u32::from(hidden)
            );
            report.push(
                Diagnostic::new(Kind::Syntax, place, message)
                    .help("retype the name: names that look the same must be the same"),
            );
        } else {
            return Some(Name {
                text: text.to_owned(),
                origin: token.origin,
            });
        }
        return None;
    }
    report.push(match tokens {
        [first, second, rest @ ..]
            if first.identifier().is_some()
                && second.kind == TokenKind::Open(Delimiter::Bracket) =>
        {
            families::indexed_name(first, rest, place)
        }
        [] => Diagnostic::new(Kind::Syntax, place, "a name is missing")
            .help("names are like x, Pi1 or ω"),
        _ => Diagnostic::new(
            Kind::Syntax,
            place,
            format!("`{}` is not a name", render(tokens)),
        )
        .help("a name is a letter (of any script) or `_`, followed by letters, digits and `_`"),
    });
    None
}

/// An expression that may use `names`; `what` (its name and an example) and `whole` describe it
/// where nothing stands.
pub fn formula(
    tokens: &[Token],
    (what, example): (&str, &str),
    whole: Origin,
    names: &Names,
    report: &mut Report,
) -> Option<Expr> {
    if tokens.is_empty() {
        report.push(
            Diagnostic::new(Kind::Syntax, whole, format!("{what} is missing"))
                .help(format!("write an expression, such as {example}")),
        );
        return None;
    }
    expression::parse(tokens, names, report)
}

/// `NAME = expression`: the name and what stands behind the `=`.
pub fn definition<'a>(
    tokens: &'a [Token],
    what: &str,
    whole: Origin,
    report: &mut Report,
) -> Option<(Name, &'a [Token])> {
    definition_of(name, tokens, what, whole, report)
}

/// `LEFT = expression` with a name that is read in another way.
pub fn definition_of<'a>(
    name: impl Fn(&[Token], Origin, &mut Report) -> Option<Name>,
    tokens: &'a [Token],
    what: &str,
    whole: Origin,
    report: &mut Report,
) -> Option<(Name, &'a [Token])> {
    let mut cursor = Cursor::new(tokens);
    let left = cursor.take_until(|c| c.peek().is_some_and(equations::begins_sign));
    let Some(equals) = equations::sign(&mut cursor, report) else {
        let place = span(tokens).unwrap_or(whole);
        report.push(
            Diagnostic::new(
                Kind::Syntax,
                place,
                format!("{what} needs a name and a value"),
            )
            .help("write `NAME = expression`"),
        );
        return None;
    };
    Some((name(left, equals, report)?, cursor.rest()))
}

const CASIMIR: (&str, &str) = ("the Casimir", "x^2 + y^2");

/// `NAME = expression` or `expression` alone.
pub fn casimir(
    tokens: &[Token],
    whole: Origin,
    names: &Names,
    report: &mut Report,
) -> Option<Casimir> {
    let mut cursor = Cursor::new(tokens);
    let named = tokens.first().filter(|t| t.identifier().is_some());
    let equals = named.and_then(|_| {
        cursor.advance();
        equations::sign(&mut cursor, report)
    });
    let (name, value, place) = match equals {
        Some(equals) => (
            Some(name(&tokens[..1], whole, report)?),
            cursor.rest(),
            equals,
        ),
        None => (None, tokens, whole),
    };
    if !equations::one_side(value, "a Casimir", report) {
        return None;
    }
    let value = formula(value, CASIMIR, place, names, report)?;
    Some(Casimir { name, value })
}

/// `[a, b] = value`.
pub fn bracket(
    tokens: &[Token],
    whole: Origin,
    names: &Names,
    report: &mut Report,
) -> Option<Bracket> {
    let help = "write `[a, b] = value` with two basis names and a value linear in basis names";
    let form = (Delimiter::Bracket, "2*e1 - e2 (or 0)", help);
    pair(tokens, form, whole, names, report)
}

/// `{x, y} = value`.
pub fn poisson(
    tokens: &[Token],
    whole: Origin,
    names: &Names,
    report: &mut Report,
) -> Option<Bracket> {
    let help = "write `{x, y} = value` with two state names";
    let form = (Delimiter::Brace, "z^2 (or 1)", help);
    pair(tokens, form, whole, names, report)
}

/// Two names in delimiters and the value of their bracket; the example is one of a value.
fn pair(
    tokens: &[Token],
    (delimiter, example, help): (Delimiter, &str, &str),
    whole: Origin,
    names: &Names,
    report: &mut Report,
) -> Option<Bracket> {
    let origin = span(tokens).unwrap_or(whole);
    let mut cursor = Cursor::new(tokens);
    let open = cursor.eat_kind(&TokenKind::Open(delimiter));
    let inside = cursor.take_until(|_| false);
    let close = cursor.eat_kind(&TokenKind::Close(delimiter));
    let equals = close.and_then(|_| equations::sign(&mut cursor, report));
    let parts = token::split_commas(inside);
    let (Some(_), Some(equals), [left, right]) = (open, equals, parts.as_slice()) else {
        let message = format!("`{}` is not a bracket", render(tokens));
        report.push(Diagnostic::new(Kind::Syntax, origin, message).help(help));
        return None;
    };
    let left = name(left, origin, report);
    let right = name(right, origin, report);
    if let Some(second) = equations::second_bracket(cursor.rest(), delimiter) {
        report.push(second);
        return None;
    }
    let value = formula(
        cursor.rest(),
        ("the value of the bracket", example),
        equals,
        names,
        report,
    );
    Some(Bracket {
        left: left?,
        right: right?,
        value: value?,
        origin,
    })
}

/// An expression in numbers, `pi` and functions.
pub fn constant(tokens: &[Token], report: &mut Report) -> Option<Expr> {
    let expression = expression::parse(tokens, &Names::default(), report)?;
    constant_expression(expression, report)
}

/// The algebra with its cocycle, or the brackets of the coordinates: places and what was read. That one
/// of the two is there is checked elsewhere, and `other` is the place of a statement that only fits
/// an algebra, with its name.
pub fn structure(
    algebra: Option<(Origin, Option<Algebra>)>,
    poisson: Option<(Origin, Vec<Bracket>)>,
    cocycle: Option<(Origin, Vec<Bracket>)>,
    of_algebra: &[(Origin, &str)],
    kind: Kind,
    report: &mut Report,
) -> Option<Structure> {
    let mut fails = |place, message: &str, help: &str| {
        report.push(Diagnostic::new(kind, place, message).help(help));
    };
    match (algebra, poisson, cocycle) {
        (Some(_), Some((place, _)), _) => fails(
            place,
            "`poisson` and `algebra` are both given, and each defines the bracket",
            "remove one of the two; a constant term is added to the bracket of an algebra by `cocycle`",
        ),
        (None, _, Some((place, _))) => fails(
            place,
            "`cocycle` without `algebra`: it is added to a Lie–Poisson bracket",
            "write the constants into the brackets of `poisson`",
        ),
        (None, Some((origin, brackets)), None) => {
            for (place, name) in of_algebra {
                let message =
                    format!("`{name}` cannot be combined with `poisson`: it needs a Lie algebra");
                fails(*place, &message, "remove it, or declare an `algebra`");
            }
            if of_algebra.is_empty() {
                return Some(Structure::General { brackets, origin });
            }
        }
        (Some((_, algebra)), None, cocycle) => {
            let cocycle = cocycle.map_or_else(Vec::new, |(_, brackets)| brackets);
            return algebra.map(|algebra| Structure::Lie { algebra, cocycle });
        }
        (None, None, None) => {}
    }
    None
}

/// An algebra with names of its own, whose coordinates have none.
pub fn missing_state(kind: Kind, place: Origin) -> Diagnostic {
    let message = "the declaration has no `state`, and an algebra with another basis has no standard names of it";
    Diagnostic::new(kind, place, message).help("name one coordinate for each basis element")
}

/// A Hamiltonian of blanks.
pub fn empty_function(keyword: &str, place: Origin) -> Diagnostic {
    let (name, help) = match keyword {
        "lagrangian" => ("Lagrangian", "write an expression in the velocity names"),
        "discrete_lagrangian" => (
            "discrete Lagrangian",
            "write an expression in the velocity names and `h`",
        ),
        _ => (
            "Hamiltonian",
            "write an expression in the state names; a constant is allowed",
        ),
    };
    Diagnostic::new(
        Kind::EmptyHamiltonian,
        place,
        format!("the {name} is empty"),
    )
    .help(help)
}

/// The functions that can give a system, by their keys.
pub const FUNCTIONS: [&str; 3] = ["hamiltonian", "lagrangian", "discrete_lagrangian"];

/// The Hamiltonian, or a Lagrangian with the names of the velocity: places and what was read, in the order of
/// [`FUNCTIONS`]. That there is one is checked elsewhere.
pub fn energy(
    functions: [Option<(Origin, Option<Expr>)>; 3],
    (place, velocity): (Option<Origin>, Vec<Name>),
    kind: Kind,
    report: &mut Report,
) -> Option<Energy> {
    let mut fails = |place, message: &str, help: &str| {
        report.push(Diagnostic::new(kind, place, message).help(help));
    };
    let found = functions.into_iter().zip(FUNCTIONS);
    let mut found = found.filter_map(|(function, key)| Some((function?, key)));
    let ((origin, value), key) = found.next()?;
    if let Some(((second, _), other)) = found.next() {
        let message = format!("`{other}` and `{key}` are both given, and each defines the system");
        fails(second, &message, "remove one of the two");
        return None;
    }
    match (key, place) {
        ("hamiltonian", Some(velocity)) => fails(
            velocity,
            "`velocity` cannot be combined with `hamiltonian`: a Hamiltonian is a function of mu",
            "remove it, or give a `lagrangian`",
        ),
        ("hamiltonian", None) => return value.map(Energy::Hamiltonian),
        ("lagrangian", None) => fails(
            origin,
            "the Lagrangian has no `velocity`",
            "name the components of the velocity xi, one for each basis element",
        ),
        (_, None) => fails(
            origin,
            "the discrete Lagrangian has no `velocity`",
            "name the coordinates x of the step, one for each basis element; x/h is a velocity",
        ),
        ("lagrangian", Some(_)) => {
            return value.map(|value| Energy::Lagrangian { velocity, value });
        }
        (_, Some(_)) => return value.map(|value| Energy::DiscreteLagrangian { velocity, value }),
    }
    None
}

/// `left` or `right`.
pub fn invariance(
    text: &str,
    place: Origin,
    kind: Kind,
    report: &mut Report,
) -> Option<Invariance> {
    match text {
        "left" => Some(Invariance::Left),
        "right" => Some(Invariance::Right),
        _ => {
            report.push(
                Diagnostic::new(
                    kind,
                    place,
                    format!("unknown invariance `{}`", text.escape_debug()),
                )
                .help("write `left` or `right`"),
            );
            None
        }
    }
}

/// The answer where a constant is missing.
pub fn missing_constant(place: Origin) -> Diagnostic {
    Diagnostic::new(Kind::Number, place, "a number is missing")
        .help("write a number or an exact constant, such as 1/7")
}

/// The expression if it contains no name but `pi`.
fn constant_expression(expression: Expr, report: &mut Report) -> Option<Expr> {
    let mut pending = vec![&expression];
    let mut clean = true;
    while let Some(part) = pending.pop() {
        match &part.kind {
            ExprKind::Name { name, .. } if name != "pi" => {
                report.push(
                    Diagnostic::new(Kind::Number, part.origin, format!("`{name}` is not a number"))
                        .help("a constant consists of numbers, `pi` and functions of them, such as 1/7 or cos(11/10)"),
                );
                clean = false;
            }
            ExprKind::Number(_) | ExprKind::Name { .. } => {}
            ExprKind::Negative(a) => pending.push(a),
            ExprKind::Power(a, b) => pending.extend([&**b, &**a]),
            ExprKind::Sum(operands) | ExprKind::Product(operands) => {
                pending.extend(operands.iter().rev().map(|(_, operand)| operand));
            }
            ExprKind::Call { arguments, .. } => pending.extend(arguments.iter().rev()),
            ExprKind::IndexedSum { from, to, body, .. } => {
                pending.extend([&**body, &**to, &**from])
            }
        }
    }
    clean.then_some(expression)
}
