//! The body of the macro: statements to the syntax tree.

mod block;
mod entry;
mod statement;

use proc_macro2::{Span, TokenStream};

use self::block::{algebra, names, parameters, poisson, realization};
use self::entry::{compact, inside};
use self::statement::{Statement, statements};
use super::token::{Delimiter, Token, TokenKind, render, span, split_commas};
use super::{Body, Names, Parsed, expression, item, rust};
use crate::ast::{Declaration, Expr, Invariance, Name, Parameter};
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

    /// Number of basis elements, however broken the algebra is.
    fn size_of_basis(&self) -> usize {
        let tokens = self.first("algebra").map_or(&[][..], |s| s.rest);
        let Some(basis) = tokens.iter().position(|t| t.is_word("basis")) else {
            return 0;
        };
        let names = &tokens[basis + 1..];
        let end = names.iter().position(|t| t.is(';')).unwrap_or(names.len());
        split_commas(&names[..end]).len()
    }

    fn missing(&self, keyword: &str, example: &str, place: Origin, report: &mut Report) {
        if self.first(keyword).is_none() {
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
    if parts.first("poisson").is_none() {
        let example = "algebra { basis e1, e2; [e1, e2] = e2; }";
        parts.missing("algebra", example, place, report);
    }
    parts.missing("state", "state x, y;", place, report);
    if item::FUNCTIONS[1..]
        .iter()
        .all(|f| parts.first(f).is_none())
    {
        parts.missing("hamiltonian", "hamiltonian = x^2/2;", place, report);
    }
    parsed.state = parts
        .first("state")
        .map(|s| names(s.rest, s.origin, report))
        .unwrap_or_default();
    parsed.dimension = match parts.first("state") {
        Some(state) => split_commas(state.rest).len(),
        None => parts.size_of_basis(),
    };
    let entries = parts
        .first("parameters")
        .and_then(|s| s.block(report))
        .unwrap_or_default();
    let (found, parameters) = parameters(entries, report);
    parsed.parameters = found;
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
    let algebra = parts
        .first("algebra")
        .map(|s| (s.origin, algebra(s, &constants, report)));
    let lets = parts
        .all("let")
        .filter_map(|s| s.rest.first()?.identifier())
        .map(str::to_owned);
    let velocity = parts.first("velocity");
    let place = velocity.map(|s| s.origin);
    let velocity = velocity
        .map(|s| names(s.rest, s.origin, report))
        .unwrap_or_default();
    let names: Names = texts(&parsed.state)
        .into_iter()
        .chain(texts(&velocity))
        .chain(constants.iter().cloned())
        .chain(lets)
        .chain(parts.first(item::FUNCTIONS[2]).map(|_| "h".to_owned()))
        .collect();
    let basis = algebra.iter().filter_map(|(_, algebra)| algebra.as_ref());
    let names = names.with_elsewhere(basis.flat_map(|a| texts(&a.basis)));
    let [brackets, cocycle] = ["poisson", "cocycle"].map(|keyword| {
        let statement = parts.first(keyword)?;
        Some((statement.origin, poisson(statement, &names, report)))
    });
    let of_algebra = [
        "lagrangian",
        "discrete_lagrangian",
        "invariance",
        "group",
        "realization",
    ]
    .map(|keyword| {
        let statement = parts.first(keyword)?;
        Some((statement.origin, keyword))
    });
    let of_algebra: Vec<_> = of_algebra.into_iter().flatten().collect();
    let structure = item::structure(
        algebra,
        brackets,
        cocycle,
        &of_algebra,
        Kind::Syntax,
        report,
    );
    let lets = parts.all("let").filter_map(|s| {
        let (name, value) = item::definition(s.rest, "an abbreviation", s.origin, report)?;
        Some((
            name,
            item::formula(value, ("its value", "x^2/2"), s.origin, &names, report)?,
        ))
    });
    let lets = lets.collect();
    let functions = item::FUNCTIONS.map(|keyword| {
        let statement = parts.first(keyword)?;
        Some((statement.origin, function(statement, &names, report)))
    });
    let energy = item::energy(functions, (place, velocity), Kind::Syntax, report);
    let realization = parts
        .first("realization")
        .map(|s| realization(s, &constants, report));
    let casimirs = parts
        .all("casimir")
        .filter_map(|s| item::casimir(s.rest, s.origin, &names, report))
        .collect();
    let methods = parts
        .first("methods")
        .map(|s| methods(s, report))
        .unwrap_or_default();
    let group = parts
        .first("group")
        .map(|s| item::name(s.rest, s.origin, report));
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
        structure: structure?,
        group: group.map_or(Some(None), |name| name.map(Some))?,
        state: parsed.state.clone(),
        parameters,
        lets,
        energy: energy?,
        realization: realization.map_or(Some(None), |read| read.map(Some))?,
        casimirs,
        methods,
        invariance: invariance?,
        initial_origin: initial.as_ref().map(|(_, origin)| *origin),
        initial: initial.map(|(values, _)| values),
        run: Vec::new(),
    })
}

/// `= H` or `= l`.
fn function(statement: &Statement<'_>, names: &Names, report: &mut Report) -> Option<Expr> {
    let value = statement.value(report)?;
    if value.is_empty() {
        report.push(item::empty_function(statement.keyword, statement.origin));
        return None;
    }
    expression::parse(value, names, report)
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
            text: compact(part),
            origin: place,
        })
    };
    parts.into_iter().filter_map(method).collect()
}

/// Exact expressions in parameters.
fn initial(statement: &Statement<'_>, names: &Names, report: &mut Report) -> Vec<Expr> {
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
