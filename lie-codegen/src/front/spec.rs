//! The spec file: JSON to the syntax tree.

mod algebra;
mod parameters;
mod realization;
mod run;

use quote::quote;

use super::json::{self, Type, Value};
use super::object::{Object, list, string, strings, wrong_type};
use super::schema::Spec;
use super::token::Token;
use super::{Body, Names, Parsed, expression, file, item, number, prose};
use crate::ast::{Bracket, Declaration, Energy, Expr, ExprKind, Invariance, Name, Parameter};
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};

/// The only version of the format.
const FORMAT: &str = "1";

/// Reads the text of a spec file. Every mistake is reported at its bytes in `text`, in the order
/// of the file; the declaration is there only if there is none.
pub fn read(text: &str, report: &mut Report) -> Parsed {
    if let Some(oversized) = file::oversized(text.len()) {
        report.push(oversized);
        return Parsed::default();
    }
    let mut found = Report::new();
    let parsed = document(text, &mut found);
    // The keys may stand in any order, but are read in that of their meaning.
    let mut diagnostics = found.into_diagnostics();
    diagnostics.sort_by_key(|d| match d.origin {
        Some(Origin::Text { start, .. }) => start,
        _ => 0,
    });
    diagnostics.into_iter().for_each(|d| report.push(d));
    parsed
}

fn document(text: &str, report: &mut Report) -> Parsed {
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
    spec.require("a spec", Spec::REQUIRED, report);
    if spec.get("poisson").is_none() {
        spec.require("a spec", &["algebra"], report);
    }
    if item::FUNCTIONS[1..].iter().all(|f| spec.get(f).is_none()) {
        spec.require("a spec", &["hamiltonian"], report);
    }
    headers(&spec, report);
    parsed.name = spec.get("name").and_then(|v| name_of(v, "`name`", report));
    parsed.state = spec
        .get("state")
        .map(|v| name_list(v, "`state`", report))
        .unwrap_or_default();
    parsed.dimension = spec.get("state").map_or(0, |v| v.elements().len());
    let parameters = spec
        .get("parameters")
        .map(|v| parameters::read(v, report))
        .unwrap_or_default();
    parsed.parameters = parameters.names;
    let declaration = Remainder {
        spec: &spec,
        parsed: &parsed,
        parameters: parameters.whole,
    }
    .read(report);
    if !report.has_errors() {
        parsed.body = declaration.map(|d| Body::Declaration(Box::new(d)));
    }
    parsed
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

/// What is read when all names are known.
struct Remainder<'s, 'a> {
    spec: &'s Object<'a>,
    parsed: &'s Parsed,
    parameters: Vec<Parameter>,
}

impl Remainder<'_, '_> {
    fn read(self, report: &mut Report) -> Option<Declaration> {
        let spec = self.spec;
        let texts = |names: &[Name]| names.iter().map(|n| n.text.clone()).collect::<Vec<_>>();
        let parameters = texts(&self.parsed.parameters);
        let algebra = spec
            .get("algebra")
            .map(|v| (v.origin(), algebra::read(v, &parameters, report)));
        let lets: Vec<Line> = lines(spec, "let", report);
        let defined = lets
            .iter()
            .filter_map(|line| line.tokens.first()?.identifier());
        let velocity = spec
            .get("velocity")
            .map(|v| name_list(v, "`velocity`", report))
            .unwrap_or_default();
        let names: Names = texts(&self.parsed.state)
            .into_iter()
            .chain(texts(&velocity))
            .chain(parameters.iter().cloned())
            .chain(defined.map(str::to_owned))
            .chain(spec.get(item::FUNCTIONS[2]).map(|_| "h".to_owned()))
            .collect();
        let basis = algebra.iter().filter_map(|(_, algebra)| algebra.as_ref());
        let names = names.with_elsewhere(basis.flat_map(|a| texts(&a.basis)));
        let constants: Names = parameters.iter().cloned().collect();

        let lets = lets.iter().filter_map(|line| {
            let (name, value) =
                item::definition(&line.tokens, "an abbreviation", line.place, report)?;
            Some((
                name,
                item::formula(value, ("its value", "x^2/2"), line.place, &names, report)?,
            ))
        });
        let lets = lets.collect();
        let [poisson, cocycle] = ["poisson", "cocycle"].map(|key| {
            let place = spec.get(key)?.origin();
            Some((place, poisson(spec, key, &names, report)))
        });
        let of_algebra = [
            "lagrangian",
            "discrete_lagrangian",
            "invariance",
            "group",
            "realization",
        ]
        .map(|key| Some((spec.get(key)?.origin(), key)));
        let of_algebra: Vec<_> = of_algebra.into_iter().flatten().collect();
        let structure =
            item::structure(algebra, poisson, cocycle, &of_algebra, Kind::Schema, report);
        let energy = self.energy(velocity, &names, report);
        let realization = spec
            .get("realization")
            .map(|v| realization::read(v, &parameters, report));
        let casimirs = lines(spec, "casimirs", report)
            .iter()
            .filter_map(|line| item::casimir(&line.tokens, line.place, &names, report))
            .collect();
        let methods = spec
            .get("methods")
            .map(|v| strings(v, "`methods`", report))
            .unwrap_or_default();
        let group = spec.get("group").map(|v| name_of(v, "`group`", report));
        let invariance = spec
            .get("invariance")
            .map_or(Some(Invariance::Left), |v| invariance(v, report));
        let initial = spec.get("initial").map(|v| {
            (
                initial(v, &self.parsed.state, &constants, report),
                v.origin(),
            )
        });
        let description = spec
            .get("description")
            .and_then(|v| string(v, "`description`", report))
            .map(|text| prose::lines(&text, "the description", report));
        let references = spec
            .get("references")
            .map(|v| strings(v, "`references`", report))
            .unwrap_or_default();
        let references: Vec<String> = references
            .iter()
            .map(|text| prose::inline(text, "the reference", report))
            .collect();
        let run = spec
            .get("run")
            .map(|v| run::read(v, report))
            .unwrap_or_default();
        Some(Declaration {
            visibility: self.parsed.visibility.clone(),
            name: self.parsed.name.clone()?,
            description: description.unwrap_or_default(),
            references,
            structure: structure?,
            group: group.map_or(Some(None), |name| name.map(Some))?,
            state: self.parsed.state.clone(),
            parameters: self.parameters,
            lets,
            energy: energy?,
            realization: realization.map_or(Some(None), |read| read.map(Some))?,
            casimirs,
            methods: methods
                .into_iter()
                .map(|m| Name {
                    origin: m.whole(),
                    text: m.text.into_owned(),
                })
                .collect(),
            invariance: invariance?,
            initial_origin: initial.as_ref().map(|(_, origin)| *origin),
            initial: initial.map(|(values, _)| values),
            run,
        })
    }
}

impl Remainder<'_, '_> {
    /// `hamiltonian`, or one of the Lagrangians with `velocity`.
    fn energy(&self, velocity: Vec<Name>, names: &Names, report: &mut Report) -> Option<Energy> {
        let spec = self.spec;
        let functions = item::FUNCTIONS.map(|key| {
            let value = spec.get(key)?;
            Some((value.origin(), function(value, key, names, report)))
        });
        let place = spec.get("velocity").map(|value| value.origin());
        item::energy(functions, (place, velocity), Kind::Schema, report)
    }
}

/// A string of the file as tokens.
struct Line {
    tokens: Vec<Token>,
    /// The string with its quotes: a place even where it is empty.
    place: Origin,
}

fn line(value: Value<'_>, what: &str, report: &mut Report) -> Option<Line> {
    let source = string(value, what, report)?;
    Some(Line {
        tokens: source.tokens(),
        place: value.origin(),
    })
}

fn lines(spec: &Object<'_>, key: &str, report: &mut Report) -> Vec<Line> {
    let Some(value) = spec.get(key) else {
        return Vec::new();
    };
    let (whole, element) = (format!("`{key}`"), format!("an element of `{key}`"));
    let elements = list(value, &whole, report).unwrap_or_default();
    elements
        .into_iter()
        .filter_map(|v| line(v, &element, report))
        .collect()
}

/// Brackets of coordinates.
fn poisson(spec: &Object<'_>, key: &str, names: &Names, report: &mut Report) -> Vec<Bracket> {
    lines(spec, key, report)
        .iter()
        .filter_map(|line| item::poisson(&line.tokens, line.place, names, report))
        .collect()
}

fn name_of(value: Value<'_>, what: &str, report: &mut Report) -> Option<Name> {
    let line = line(value, what, report)?;
    item::name(&line.tokens, line.place, report)
}

fn name_list(value: Value<'_>, what: &str, report: &mut Report) -> Vec<Name> {
    let element = format!("an element of {what}");
    let elements = list(value, what, report).unwrap_or_default();
    elements
        .into_iter()
        .filter_map(|v| name_of(v, &element, report))
        .collect()
}

fn function(value: Value<'_>, key: &str, names: &Names, report: &mut Report) -> Option<Expr> {
    let line = line(value, &format!("`{key}`"), report)?;
    if line.tokens.is_empty() {
        report.push(item::empty_function(key, line.place));
        return None;
    }
    expression::parse(&line.tokens, names, report)
}

fn invariance(value: Value<'_>, report: &mut Report) -> Option<Invariance> {
    let source = string(value, "`invariance`", report)?;
    item::invariance(&source.text, source.whole(), Kind::Schema, report)
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
