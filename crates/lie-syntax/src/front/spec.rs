//! The spec file: JSON to the syntax tree.

mod algebra;
mod attitude;
mod driving;
mod events;
mod files;
mod observables;
mod parameters;
mod realization;
mod retraction;
mod run;
mod sites;
mod start;
mod tables;
mod vectors;

use std::path::Path;

pub use files::files;
use quote::quote;

use super::entries::{Awaited, Entries, Line, Read, Recorded};
use super::json::{self, Type, Value};
use super::object::{Object, as_list, list, parts, string, wrong_type};
use super::reader;
use super::schema::Spec;
use super::tables::Read as Table;
use super::vectors::{self as written, Declared};
use super::{Names, Parsed, expression, families, file, item, number, prose};
use crate::ast::{
    Expr, ExprKind, Input, Name, OwnFunction, Realization, RunOption, SiteData, Start,
};
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};

/// The only version of the format.
const FORMAT: &str = "1";

/// Reads the text of a spec file. Every mistake is reported at its bytes in `text`, in the order
/// of the file; the declaration is there only if there is none.
pub fn read(text: &str, report: &mut Report) -> Parsed {
    read_in(text, None, report)
}

/// The same for a spec that may name files of tables, relative to a folder; without one they are refused.
pub fn read_in(text: &str, folder: Option<&Path>, report: &mut Report) -> Parsed {
    if let Some(oversized) = file::oversized(text.len()) {
        report.push(oversized);
        return Parsed::default();
    }
    let mut found = Report::new();
    let parsed = document(text, folder, &mut found);
    // The keys may stand in any order, but are read in that of their meaning.
    let mut diagnostics = found.into_diagnostics();
    diagnostics.sort_by_key(|d| match d.origin {
        Some(Origin::Text { start, .. }) => start,
        _ => 0,
    });
    diagnostics.into_iter().for_each(|d| report.push(d));
    parsed
}

fn document(text: &str, folder: Option<&Path>, report: &mut Report) -> Parsed {
    let mut parsed = Parsed {
        visibility: quote!(pub),
        ..Parsed::default()
    };
    let spec = match json::document(text) {
        Ok(value) => Object::read(value, "a spec", Spec::KEYS, report),
        Err(diagnostic) => {
            report.push(diagnostic);
            None
        }
    };
    let Some(spec) = spec else { return parsed };
    let spec = spec.with_folder(folder);
    spec.require("a spec", Spec::REQUIRED, report);
    if !spec.get("algebra").is_some_and(algebra::is_named) {
        spec.require("a spec", &["state"], report);
    }
    if spec.get("poisson").is_none() {
        spec.require("a spec", &["algebra"], report);
    }
    if item::FUNCTIONS[1..].iter().all(|f| spec.get(f).is_none()) {
        spec.require("a spec", &["hamiltonian"], report);
    }
    headers(&spec, report);
    let name = spec.line("name", report);
    parsed.name = name.and_then(|line| item::name(&line.tokens, line.place, report));
    (parsed.state, parsed.indices) = state(&spec, report);
    parsed.dimension = spec.get("state").map_or(0, |v| v.elements().len());
    let parameters = spec
        .get("parameters")
        .map(|v| parameters::read(v, spec.folder(), report))
        .unwrap_or_default();
    reader::finish(&spec, parsed, parameters, report)
}

/// The names of the state; of a family with their indices.
fn state(spec: &Object<'_>, report: &mut Report) -> (Vec<Name>, Vec<Name>) {
    let mut ignored = Report::new();
    let lines = spec.lines("state", &mut ignored);
    ignored.ignore("the list is read again");
    let indexed = lines.iter().map(|l| families::indexed_state(&l.tokens));
    match indexed.collect::<Option<Vec<_>>>() {
        Some(state) if !state.is_empty() => families::same_indices(state, report),
        _ => (spec.names("state", report), Vec::new()),
    }
}

/// `$schema` and `format`.
fn headers(spec: &Object<'_>, report: &mut Report) {
    if let Some(value) = spec.get("$schema") {
        string(value, "`$schema`", report);
    }
    if let Some(value) = spec.get("format")
        && value.raw() != FORMAT
    {
        report.push(
            Diagnostic::new(
                Kind::Schema,
                value.origin(),
                "the format is not one that this version reads",
            )
            .help(format!("write `\"format\": {FORMAT}`")),
        );
    }
}

impl Entries for Object<'_> {
    const FORM: Kind = Kind::Schema;

    fn place(&self, key: &str) -> Option<Origin> {
        Some(self.get(key)?.origin())
    }

    fn line(&self, key: &str, report: &mut Report) -> Option<Line<'_>> {
        line(self.get(key)?, &format!("`{key}`"), report)
    }

    fn lines(&self, key: &str, report: &mut Report) -> Vec<Line<'_>> {
        let elements = self.elements(key, report);
        let line = |value| line(value, &format!("an element of `{key}`"), report);
        elements.into_iter().filter_map(line).collect()
    }

    fn definitions(&self, key: &str, report: &mut Report) -> Vec<(Name, Line<'_>)> {
        let value = self.get(key);
        value.map_or_else(Vec::new, |v| driving::definitions(v, key, report))
    }

    fn dissipation(&self, names: &Names, report: &mut Report) -> Vec<super::driving::Entry> {
        let value = self.get("dissipation");
        value.map_or_else(Vec::new, |v| driving::dissipation(v, names, report))
    }

    fn noise(&self, report: &mut Report) -> Vec<super::driving::Noisy<'_>> {
        let value = self.get("noise");
        value.map_or_else(Vec::new, |v| driving::noise(v, report))
    }

    fn inputs(&self, report: &mut Report) -> Vec<Input> {
        let value = self.get("inputs");
        value.map_or_else(Vec::new, |v| driving::inputs(v, report))
    }

    fn names(&self, key: &str, report: &mut Report) -> Vec<Name> {
        let lines = self.lines(key, report);
        lines
            .iter()
            .filter_map(|line| item::name(&line.tokens, line.place, report))
            .collect()
    }

    fn methods(&self, report: &mut Report) -> Vec<Name> {
        let ids = self.strings("methods", report);
        ids.into_iter()
            .map(|id| Name {
                origin: id.extent(),
                text: id.text.into_owned(),
            })
            .collect()
    }

    fn invariance(&self, report: &mut Report) -> Option<(String, Origin)> {
        let source = string(self.get("invariance")?, "`invariance`", report)?;
        Some((source.text.to_string(), source.extent()))
    }

    fn algebra(&self, parameters: &[String], report: &mut Report) -> Option<Read> {
        let value = self.get("algebra")?;
        let (_, indices) = {
            let mut ignored = Report::new();
            let found = state(self, &mut ignored);
            ignored.ignore("the state is read elsewhere");
            found
        };
        if indices.is_empty() {
            algebra::read(value, parameters, report)
        } else {
            algebra::family_algebra(value, report)
        }
    }

    fn realization(&self, parameters: &[String], report: &mut Report) -> Option<Realization> {
        realization::read(self.get("realization")?, parameters, report)
    }

    fn retraction(
        &self,
        names: &Names,
        report: &mut Report,
    ) -> Option<Vec<(Name, written::Value)>> {
        retraction::read(self.get("retraction")?, names, report)
    }

    fn vectors(&self, names: &Names, report: &mut Report) -> Vec<Declared> {
        let value = self.get("vectors");
        value.map_or_else(Vec::new, |v| vectors::read(v, names, report))
    }

    fn observables(&self, report: &mut Report) -> Vec<Recorded<'_>> {
        let value = self.get("observables");
        value.map_or_else(Vec::new, |v| observables::read(v, report))
    }

    fn events(&self, report: &mut Report) -> Vec<Awaited<'_>> {
        let value = self.get("events");
        value.map_or_else(Vec::new, |v| events::read(v, report))
    }

    fn tables(&self, report: &mut Report) -> Vec<Table> {
        let value = self.get("functions");
        value.map_or_else(Vec::new, |v| tables::read(v, self.folder(), report))
    }

    fn own_functions(&self, _: &mut Report) -> Vec<OwnFunction> {
        Vec::new()
    }

    fn initial(&self, state: &[Name], names: &Names, report: &mut Report) -> Vec<Expr> {
        let value = self.get("initial");
        value.map_or_else(Vec::new, |v| initial(v, state, names, report))
    }

    fn attitude(&self, names: &Names, report: &mut Report) -> Option<super::attitude::Written> {
        attitude::read(self.get("attitude")?, names, report)
    }

    fn bonds(&self, report: &mut Report) -> Option<SiteData> {
        sites::bonds(self.get("bonds")?, self.folder(), report)
    }

    fn start(&self, report: &mut Report) -> Option<Start> {
        start::read(self.get("initial")?, report)
    }

    fn prose(&self, report: &mut Report) -> (Vec<String>, Vec<String>) {
        let description = self
            .get("description")
            .and_then(|v| string(v, "`description`", report))
            .map(|text| prose::lines(&text, "the description", report));
        let references = self.strings("references", report);
        let references = references
            .iter()
            .map(|text| prose::inline(text, "the reference", report));
        (description.unwrap_or_default(), references.collect())
    }

    fn run(&self, report: &mut Report) -> Vec<RunOption> {
        let value = self.get("run");
        value.map_or_else(Vec::new, |v| run::read(v, report))
    }
}

/// A string of the file as tokens; with its quotes it is a place even where it is empty.
fn line(value: Value<'_>, what: &str, report: &mut Report) -> Option<Line<'static>> {
    Some(Line {
        tokens: string(value, what, report)?.tokens().into(),
        place: value.origin(),
    })
}

/// Numbers or exact expressions in parameters, one for each name of the state.
fn initial(value: Value<'_>, state: &[Name], names: &Names, report: &mut Report) -> Vec<Expr> {
    if matches!(value.kind(), Type::Object | Type::String) {
        let mistake = not_a_list(value, state, report);
        report.push(mistake);
        return Vec::new();
    }
    let elements = list(value, "`initial`", report).unwrap_or_default();
    elements
        .into_iter()
        .filter_map(|v| quantity(v, "an initial value", Some(names), report))
        .collect()
}

/// An initial state as text, or by the names of the coordinates: the values as a list are the remedy.
fn not_a_list(value: Value<'_>, state: &[Name], report: &mut Report) -> Diagnostic {
    let members = value.members(report);
    let value_of = |name: &Name| {
        let member = members.iter().find(|member| member.key.text == name.text);
        member.map(|member| member.value.raw())
    };
    let values: Option<Vec<&str>> = state.iter().map(value_of).collect();
    let message = format!("`initial` is a list, not {}", value.kind());
    let names: Vec<&str> = state.iter().map(|name| name.text.as_str()).collect();
    let help = match values {
        Some(values) => format!("write `[{}]`, in the order of the state", values.join(", ")),
        None if value.kind() == Type::String && parts(value.raw()).len() == state.len() => {
            format!(
                "write `{}`, in the order of the state",
                as_list(value.raw())
            )
        }
        None => format!(
            "write a list with one value for each of {}",
            names.join(", ")
        ),
    };
    Diagnostic::new(Kind::Schema, value.head(), message).help(help)
}

/// A number, or an expression as text in the given names; a constant where there are none.
fn quantity(
    value: Value<'_>,
    what: &str,
    names: Option<&Names>,
    report: &mut Report,
) -> Option<Expr> {
    match value.kind() {
        Type::Number => match number::decimal(value.raw()) {
            Ok(exact) => Some(Expr {
                kind: ExprKind::Number(exact),
                origin: value.origin(),
            }),
            Err(mistake) => {
                report.push(
                    Diagnostic::new(mistake.kind, value.origin(), mistake.message)
                        .help(mistake.help),
                );
                None
            }
        },
        Type::String => {
            let line = line(value, what, report)?;
            if line.tokens.is_empty() {
                report.push(item::missing_constant(line.place));
                return None;
            }
            match names {
                Some(names) => expression::parse(&line.tokens, names, report),
                None => item::constant(&line.tokens, report),
            }
        }
        _ => {
            report.push(wrong_type(
                &value,
                what,
                "a number or an exact constant such as \"1/3\"",
            ));
            None
        }
    }
}
