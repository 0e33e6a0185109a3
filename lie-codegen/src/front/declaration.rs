//! The body of the macro: statements to the syntax tree.

mod statement;

use proc_macro2::{Span, TokenStream};

use self::statement::{Statement, entries, statements};
use super::object::NOT_BUILT;
use super::token::{Delimiter, Token, TokenKind, render, span, split_commas};
use super::{Body, Names, Parsed, expression, item, rust};
use crate::ast::{Algebra, Declaration, Expr, Invariance, Name, Parameter};
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};

/// Parses the input of the macro. Every mistake is reported at its token; one in a statement does
/// not hide those of the others. The body is there only if there is no mistake.
pub fn parse(input: TokenStream, report: &mut Report) -> Parsed {
    let tokens = rust::tokens(input);
    let start = tokens
        .first()
        .map_or(Origin::Span(Span::call_site()), |t| t.origin);
    let mut found = Report::new();
    let parts = Parts {
        statements: statements(&tokens, &mut found),
        start,
    };
    let parsed = if parts.first("spec").is_some() {
        spec(&parts, &mut found)
    } else {
        system(&parts, &mut found)
    };
    found
        .into_diagnostics()
        .into_iter()
        .for_each(|d| report.push(d));
    parsed
}

/// The statements of a macro.
struct Parts<'a> {
    statements: Vec<Statement<'a>>,
    /// The first token, the place of what is missing.
    start: Origin,
}

impl<'a> Parts<'a> {
    fn all(&self, keyword: &str) -> impl Iterator<Item = &Statement<'a>> {
        self.statements.iter().filter(move |s| s.keyword == keyword)
    }

    fn first(&self, keyword: &str) -> Option<&Statement<'a>> {
        self.all(keyword).next()
    }

    /// Reports statements that stand twice and visibilities where none belongs.
    fn check_heads(&self, report: &mut Report) {
        let mut seen: Vec<&str> = Vec::new();
        for statement in &self.statements {
            let keyword = statement.keyword;
            let repeatable = matches!(keyword, "let" | "casimir");
            if !repeatable && seen.contains(&keyword) {
                report.push(
                    Diagnostic::new(
                        Kind::Syntax,
                        statement.origin,
                        format!("`{keyword}` stands twice"),
                    )
                    .help("remove one of the two"),
                );
            }
            seen.push(keyword);
            if !matches!(keyword, "system" | "spec")
                && let Some(place) = span(statement.visibility)
            {
                report.push(
                    Diagnostic::new(
                        Kind::Syntax,
                        place,
                        format!("`{keyword}` has no visibility"),
                    )
                    .help("`pub` stands before `system` only"),
                );
            }
        }
    }

    fn missing(&self, keyword: &str, example: &str, place: Origin, report: &mut Report) {
        let replaced = NOT_BUILT.iter().any(|(reserved, replaces)| {
            replaces.contains(&keyword) && self.first(reserved).is_some()
        });
        if self.first(keyword).is_none() && !replaced {
            report.push(
                Diagnostic::new(
                    Kind::Syntax,
                    place,
                    format!("the declaration has no `{keyword}`"),
                )
                .help(format!("add `{example}`")),
            );
        }
    }
}

/// `pub spec = "path";`
fn spec(parts: &Parts<'_>, report: &mut Report) -> Parsed {
    parts.check_heads(report);
    let mut parsed = Parsed::default();
    let mut path = None;
    for statement in &parts.statements {
        if statement.keyword != "spec" {
            report.push(
                Diagnostic::new(
                    Kind::Syntax,
                    statement.origin,
                    format!("`{}` beside `spec`", statement.keyword),
                )
                .help("the spec file declares everything; remove the statement"),
            );
        } else if path.is_none() {
            parsed.visibility = rust::stream(statement.visibility);
            path = statement.value(report).and_then(|value| match value {
                [
                    Token {
                        kind: TokenKind::Text(text),
                        origin,
                    },
                ] => Some(Name {
                    text: text.clone(),
                    origin: *origin,
                }),
                _ => {
                    let place = span(value).unwrap_or(statement.origin);
                    report.push(
                        Diagnostic::new(
                            Kind::Syntax,
                            place,
                            "the path of the spec is a string literal",
                        )
                        .help("write `pub spec = \"specs/name.json\";`, relative to the manifest"),
                    );
                    None
                }
            });
        }
    }
    if !report.has_errors() {
        parsed.body = path.map(|path| Body::Spec { path });
    }
    parsed
}

/// A whole declaration.
fn system(parts: &Parts<'_>, report: &mut Report) -> Parsed {
    parts.check_heads(report);
    let mut parsed = Parsed::default();
    if let Some(statement) = parts.first("system") {
        parsed.visibility = rust::stream(statement.visibility);
        parsed.name = item::name(statement.rest, statement.origin, report);
    }
    let place = parsed.name.as_ref().map_or(parts.start, |name| name.origin);
    parts.missing("system", "pub system NAME;", parts.start, report);
    parts.missing(
        "algebra",
        "algebra { basis e1, e2; [e1, e2] = e2; }",
        place,
        report,
    );
    parts.missing("state", "state x, y;", place, report);
    parts.missing("hamiltonian", "hamiltonian = x^2/2;", place, report);
    parsed.state = parts
        .first("state")
        .map(|s| names(s.rest, s.origin, report))
        .unwrap_or_default();
    let entries = parts
        .first("parameters")
        .and_then(|s| s.block(report))
        .unwrap_or_default();
    let (names, parameters) = self::parameters(entries, report);
    parsed.parameters = names;
    let declaration = remainder(parts, &parsed, parameters, report);
    if !report.has_errors() {
        parsed.body = declaration.map(|d| Body::Declaration(Box::new(d)));
    }
    parsed
}

/// What is read when all names are known.
fn remainder(
    parts: &Parts<'_>,
    parsed: &Parsed,
    parameters: Vec<Parameter>,
    report: &mut Report,
) -> Option<Declaration> {
    let texts = |names: &[Name]| names.iter().map(|n| n.text.clone()).collect::<Vec<_>>();
    let constants = texts(&parsed.parameters);
    let lets = parts
        .all("let")
        .filter_map(|s| s.rest.first()?.identifier())
        .map(str::to_owned);
    let names: Names = texts(&parsed.state)
        .into_iter()
        .chain(constants.iter().cloned())
        .chain(lets)
        .collect();
    let algebra = parts
        .first("algebra")
        .and_then(|s| algebra(s, &constants, report));
    let lets = parts.all("let").filter_map(|s| {
        let (name, value) = item::definition(s.rest, "an abbreviation", s.origin, report)?;
        Some((
            name,
            item::formula(value, "its value", s.origin, &names, report)?,
        ))
    });
    let lets = lets.collect();
    let hamiltonian = parts.first("hamiltonian").and_then(|s| {
        let value = s.value(report)?;
        if value.is_empty() {
            report.push(item::empty_hamiltonian(s.origin));
            return None;
        }
        expression::parse(value, &names, report)
    });
    let casimirs = parts
        .all("casimir")
        .filter_map(|s| item::casimir(s.rest, s.origin, &names, report))
        .collect();
    let methods = parts
        .first("methods")
        .map(|s| methods(s, report))
        .unwrap_or_default();
    let invariance = parts
        .first("invariance")
        .map_or(Some(Invariance::Left), |s| {
            let value = s.value(report)?;
            item::invariance(
                &render(value),
                span(value).unwrap_or(s.origin),
                Kind::Syntax,
                report,
            )
        });
    let constants: Names = constants.into_iter().collect();
    let initial = parts
        .first("initial")
        .map(|s| (initial(s, &constants, report), s.origin));
    Some(Declaration {
        visibility: parsed.visibility.clone(),
        name: parsed.name.clone()?,
        description: parts.first("system")?.description(),
        references: Vec::new(),
        algebra: algebra?,
        state: parsed.state.clone(),
        parameters,
        lets,
        hamiltonian: hamiltonian?,
        casimirs,
        methods,
        invariance: invariance?,
        initial_origin: initial.as_ref().map(|(_, origin)| *origin),
        initial: initial.map(|(values, _)| values),
        run: Vec::new(),
    })
}

/// Names with commas between them.
fn names(tokens: &[Token], place: Origin, report: &mut Report) -> Vec<Name> {
    if tokens.is_empty() {
        report.push(
            Diagnostic::new(Kind::Syntax, place, "names are missing")
                .help("write them with commas between, as in `x, y`"),
        );
    }
    split_commas(tokens)
        .into_iter()
        .filter_map(|part| item::name(part, place, report))
        .collect()
}

/// `{ basis …; [a, b] = …; }`
fn algebra(
    statement: &Statement<'_>,
    parameters: &[String],
    report: &mut Report,
) -> Option<Algebra> {
    if let Some(equals) = statement.rest.first().filter(|t| t.is('=')) {
        let place = span(&statement.rest[1..]).unwrap_or(equals.origin);
        report.push(
            Diagnostic::new(Kind::Syntax, place, "named algebras are not built yet")
                .help("write `algebra { basis e1, e2; [e1, e2] = e2; }`"),
        );
        return None;
    }
    let entries = statement.block(report)?;
    let mut basis: Option<Vec<Name>> = None;
    for entry in entries.iter().filter(|e| e.is_word("basis")) {
        if basis.is_some() {
            report.push(
                Diagnostic::new(Kind::Syntax, entry.origin(), "`basis` stands twice")
                    .help("remove one of the two"),
            );
        }
        basis.get_or_insert(names(&entry.tokens[1..], entry.origin(), report));
    }
    if basis.is_none() {
        report.push(
            Diagnostic::new(Kind::Syntax, statement.origin, "the algebra has no `basis`")
                .help("add `basis e1, e2, e3;`"),
        );
    }
    let basis = basis.unwrap_or_default();
    let known: Names = basis
        .iter()
        .map(|n| n.text.clone())
        .chain(parameters.iter().cloned())
        .collect();
    let mut brackets = Vec::new();
    for entry in entries.iter().filter(|e| !e.is_word("basis")) {
        if entry.is_word("matrices") || entry.is_word("matrix") {
            report.push(
                Diagnostic::new(Kind::Syntax, entry.origin(), "the macro has no matrices")
                    .help("declare the system in a spec file and write `spec = \"path\";`"),
            );
        } else {
            brackets.extend(item::bracket(entry.tokens, entry.origin(), &known, report));
        }
    }
    Some(Algebra {
        basis,
        brackets: Some(brackets),
        matrices: Vec::new(),
        origin: statement.origin,
    })
}

/// `{ I1 = 2.0; exact k = 1/3; }`: the names that could be read, and the parameters without mistakes.
fn parameters(
    entries: Vec<statement::Entry<'_>>,
    report: &mut Report,
) -> (Vec<Name>, Vec<Parameter>) {
    let (mut names, mut parameters) = (Vec::new(), Vec::new());
    for entry in entries {
        let exact = entry.is_word("exact")
            && entry
                .tokens
                .get(1)
                .is_some_and(|t| t.identifier().is_some());
        let tokens = &entry.tokens[usize::from(exact)..];
        let Some((name, value)) = item::definition(tokens, "a parameter", entry.origin(), report)
        else {
            continue;
        };
        names.push(name.clone());
        if value.is_empty() {
            report.push(item::missing_constant(name.origin));
        } else if let Some(default) = item::constant(value, report) {
            let description = entry.description();
            parameters.push(Parameter {
                name,
                default,
                exact,
                unit: None,
                description,
            });
        }
    }
    (names, parameters)
}

/// The parts of `= [a, b]`.
fn bracketed<'a>(
    statement: &Statement<'a>,
    example: &str,
    report: &mut Report,
) -> Vec<&'a [Token]> {
    let Some(value) = statement.value(report) else {
        return Vec::new();
    };
    let inside = entries::inside(value, Delimiter::Bracket);
    if inside.is_none() {
        let place = span(value).unwrap_or(statement.origin);
        let message = format!("`{}` is a list in brackets", statement.keyword);
        report
            .push(Diagnostic::new(Kind::Syntax, place, message).help(format!("write `{example}`")));
    }
    split_commas(inside.unwrap_or_default())
}

/// Ids such as `lie-midpoint` or `compose4(midpoint)`: words, dashes and parentheses.
fn methods(statement: &Statement<'_>, report: &mut Report) -> Vec<Name> {
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
                    format!("`{}` is no id of a method", render(part)),
                )
                .help("ids are like lie-midpoint or gauss4, without quotes"),
            );
            return None;
        }
        Some(Name {
            text: entries::compact(part),
            origin: place,
        })
    };
    parts.into_iter().filter_map(method).collect()
}

/// Exact expressions in parameters.
fn initial(statement: &Statement<'_>, names: &Names, report: &mut Report) -> Vec<Expr> {
    let parts = bracketed(statement, "initial = [0.3, -1/2];", report);
    let value =
        |part: &[Token]| item::formula(part, "an initial value", statement.origin, names, report);
    parts.into_iter().filter_map(value).collect()
}
