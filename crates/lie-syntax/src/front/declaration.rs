//! The body of the macro: statements to the syntax tree.

mod acting;
mod attitude;
mod block;
mod entry;
mod events;
pub(super) mod family;
mod functions;
mod lists;
mod observables;
mod parts;
mod retraction;
mod statement;
mod tables;
mod vectors;

use std::borrow::Cow;

use proc_macro2::{Span, TokenStream};

use self::block::{algebra, is_named, names, parameters, realization};
use self::entry::Entry;
use self::parts::{Parts, REPEATABLE};
use self::statement::{Statement, statements};
use super::entries::{Awaited, Entries, Line, Read, Recorded};
use super::reader;
use super::tables::Read as Table;
use super::token::{Delimiter, Token, TokenKind, render, span, split_commas};
use super::vectors::{Declared, Value};
use super::{Body, Names, Parsed, driving, families, item, rust};
use crate::ast::{Expr, Input, Name, OwnFunction, Realization, RunOption, SiteData, Start};
use crate::ast::{NoPath, Runtime};
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};

/// Parses the input of the macro. Every mistake is reported at its token; one in a statement does
/// not hide those of the others. The body is there only if there is no mistake.
pub fn parse(input: TokenStream, report: &mut Report) -> Parsed {
    let tokens = rust::tokens(input);
    let start = tokens
        .first()
        .map_or(Origin::from_span(Span::call_site()), |t| t.origin);
    let mut found = Report::new();
    let parts = Parts {
        statements: statements(&tokens, &mut found),
        start,
    };
    let mut parsed = if parts.first("spec").is_some() {
        spec(&parts, &mut found)
    } else {
        system(&parts, &mut found)
    };
    if let Some(statement) = parts.first("crate") {
        match runtime(statement, &mut found) {
            Some(runtime) => parsed.runtime = runtime,
            // nothing can stand in for the system: what it is made of is not found
            None => parsed.name = None,
        }
    }
    found
        .into_diagnostics()
        .into_iter()
        .for_each(|d| report.push(d));
    parsed
}

/// The word that begins the statement of a key.
fn keyword(key: &str) -> &str {
    match key {
        "name" => "system",
        "casimirs" => "casimir",
        key => key,
    }
}

/// `crate = my_crate::lie_runtime;`
fn runtime(statement: &Statement<'_>, report: &mut Report) -> Option<Runtime> {
    let value = statement.value(report)?;
    let invisible = |kind: &TokenKind| {
        let delimiter = Delimiter::Invisible;
        [TokenKind::Open(delimiter), TokenKind::Close(delimiter)].contains(kind)
    };
    // a path that another macro was given stands in a group of its own
    let path: Vec<Token> = value
        .iter()
        .filter(|t| !invisible(&t.kind))
        .cloned()
        .collect();
    let runtime = path
        .iter()
        .all(|token| token.identifier().is_some() || token.is(':'))
        .then(|| Runtime::from_tokens(rust::stream(&path)))
        .flatten();
    if runtime.is_none() {
        let place = span(value).unwrap_or(statement.origin);
        let no_path = NoPath(render(value));
        report.push(
            Diagnostic::new(Kind::Syntax, place, no_path.to_string()).help(
                "write the path at which the runtime is re-exported, as in `crate = my_crate::lie_runtime;`",
            ),
        );
    }
    runtime
}

/// `pub spec = "path";`
fn spec(parts: &Parts<'_>, report: &mut Report) -> Parsed {
    parts.check_heads(report);
    let mut parsed = Parsed::default();
    let mut path = None;
    for statement in &parts.statements {
        if statement.keyword == "crate" {
            continue;
        }
        if statement.keyword != "spec" {
            report.push(
                Diagnostic::new(
                    Kind::Syntax,
                    statement.origin,
                    format!("`{}` cannot be combined with `spec`", statement.keyword),
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
    if !parts.first("algebra").is_some_and(is_named) {
        parts.missing("state", "state x, y;", place, report);
    }
    if item::FUNCTIONS[1..]
        .iter()
        .all(|f| parts.first(f).is_none())
    {
        parts.missing("hamiltonian", "hamiltonian = x^2/2;", place, report);
    }
    let state = parts.first("state");
    (parsed.state, parsed.indices) = state.map(|s| family::state(s, report)).unwrap_or_default();
    parsed.dimension = match parts.first("state") {
        Some(state) => split_commas(state.rest).len(),
        None => parts.size_of_basis(),
    };
    let block = parts.first("parameters").and_then(|s| s.block(report));
    let parameters = parameters(block.unwrap_or_default(), report);
    reader::finish(parts, parsed, parameters, report)
}

impl Entries for Parts<'_> {
    const FORM: Kind = Kind::Syntax;

    fn place(&self, key: &str) -> Option<Origin> {
        Some(self.first(keyword(key))?.origin)
    }

    fn line(&self, key: &str, report: &mut Report) -> Option<Line<'_>> {
        self.first(keyword(key))?.line(report)
    }

    fn lines(&self, key: &str, report: &mut Report) -> Vec<Line<'_>> {
        let keyword = keyword(key);
        if REPEATABLE.contains(&keyword) {
            return self.all(keyword).filter_map(|s| s.line(report)).collect();
        }
        let block = self.first(keyword).and_then(|s| s.block(report));
        block.unwrap_or_default().iter().map(Entry::line).collect()
    }

    fn definitions(&self, key: &str, report: &mut Report) -> Vec<(Name, Line<'_>)> {
        let lines = self.lines(key, report);
        let mut defined = Vec::new();
        for line in lines {
            let what = format!("an entry of `{key}`");
            let tokens = match line.tokens {
                Cow::Borrowed(tokens) => tokens,
                Cow::Owned(_) => continue,
            };
            let read = item::definition_of(families::target, tokens, &what, line.place, report);
            if let Some((name, value)) = read {
                let place = name.origin;
                let tokens = value.into();
                defined.push((name, Line { tokens, place }));
            }
        }
        defined
    }

    fn dissipation(&self, names: &Names, report: &mut Report) -> Vec<driving::Entry> {
        let block = self.first("dissipation").and_then(|s| s.block(report));
        acting::dissipation(&block.unwrap_or_default(), names, report)
    }

    fn noise(&self, report: &mut Report) -> Vec<driving::Noisy<'_>> {
        let block = self.first("noise").and_then(|s| s.block(report));
        acting::noise(&block.unwrap_or_default(), report)
    }

    fn inputs(&self, report: &mut Report) -> Vec<Input> {
        let block = self.first("inputs").and_then(|s| s.block(report));
        acting::inputs(&block.unwrap_or_default(), report)
    }

    fn names(&self, key: &str, report: &mut Report) -> Vec<Name> {
        let statement = self.first(keyword(key));
        statement.map_or_else(Vec::new, |s| names(s.rest, s.origin, report))
    }

    fn methods(&self, report: &mut Report) -> Vec<Name> {
        let statement = self.first("methods");
        statement.map_or_else(Vec::new, |s| lists::methods(s, report))
    }

    fn invariance(&self, report: &mut Report) -> Option<(String, Origin)> {
        let line = self.line("invariance", report)?;
        let place = span(&line.tokens).unwrap_or(line.place);
        Some((render(&line.tokens), place))
    }

    fn algebra(&self, parameters: &[String], report: &mut Report) -> Option<Read> {
        let statement = self.first("algebra")?;
        if self.first("state").is_some_and(family::is_indexed) {
            return family::algebra(statement, report);
        }
        algebra(statement, parameters, report)
    }

    fn realization(&self, parameters: &[String], report: &mut Report) -> Option<Realization> {
        realization(self.first("realization")?, parameters, report)
    }

    fn vectors(&self, names: &Names, report: &mut Report) -> Vec<Declared> {
        let block = self.first("vectors").and_then(|s| s.block(report));
        vectors::read(&block.unwrap_or_default(), names, report)
    }

    fn observables(&self, report: &mut Report) -> Vec<Recorded<'_>> {
        let block = self.first("observables").and_then(|s| s.block(report));
        observables::read(&block.unwrap_or_default(), report)
    }

    fn events(&self, report: &mut Report) -> Vec<Awaited<'_>> {
        let block = self.first("events").and_then(|s| s.block(report));
        events::read(&block.unwrap_or_default(), report)
    }

    fn tables(&self, report: &mut Report) -> Vec<Table> {
        let block = self.first("functions").and_then(|s| s.block(report));
        tables::read(&block.unwrap_or_default(), report)
    }

    fn own_functions(&self, report: &mut Report) -> Vec<OwnFunction> {
        let mut again = Report::new();
        let block = self.first("functions").and_then(|s| s.block(&mut again));
        // what is no block was reported where tables were read
        again.into_diagnostics();
        functions::read(&block.unwrap_or_default(), report)
    }

    fn initial(&self, _: &[Name], names: &Names, report: &mut Report) -> Vec<Expr> {
        let statement = self.first("initial");
        statement.map_or_else(Vec::new, |s| lists::initial(s, names, report))
    }

    fn retraction(&self, names: &Names, report: &mut Report) -> Option<Vec<(Name, Value)>> {
        let statement = self.first("retraction")?;
        retraction::read(&statement.block(report)?, names, report)
    }

    fn attitude(&self, names: &Names, report: &mut Report) -> Option<super::attitude::Written> {
        let statement = self.first("attitude")?;
        attitude::read(&statement.block(report)?, statement.origin, names, report)
    }

    fn bonds(&self, report: &mut Report) -> Option<SiteData> {
        family::rows(self.first("bonds")?, report)
    }

    fn start(&self, report: &mut Report) -> Option<Start> {
        family::start(self.first("initial")?, report)
    }

    fn prose(&self, _: &mut Report) -> (Vec<String>, Vec<String>) {
        let system = self.first("system");
        (system.map_or_else(Vec::new, |s| s.docs.clone()), Vec::new())
    }

    fn run(&self, _: &mut Report) -> Vec<RunOption> {
        Vec::new()
    }
}
