//! The blocks `algebra`, `realization` and `parameters`, and lists of names.

use super::entry::{Entry, inside};
use super::family;
use super::statement::Statement;
use crate::ast::{Algebra, Expr, Matrix, Name, Parameter, Realization};
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};
use crate::front::entries::{Line, Parameters, Read};
use crate::front::named::{self, Changes};
use crate::front::token::{Delimiter, Token, span, split_commas};
use crate::front::{Names, item};

/// Names with commas between them.
pub fn names(tokens: &[Token], place: Origin, report: &mut Report) -> Vec<Name> {
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

/// `= so(3)`, or a block.
pub fn algebra(
    statement: &Statement<'_>,
    parameters: &[String],
    report: &mut Report,
) -> Option<Read> {
    if let Some((equals, name)) = statement.rest.split_first().filter(|(t, _)| t.is('=')) {
        let named = named::parse(name, equals.origin, report)?;
        let place = span(name).unwrap_or(equals.origin);
        return Some(named::standard(&named, place));
    }
    let entries = statement.block(report)?;
    if let Some(name) = entries.iter().find(|entry| entry.is_word("named")) {
        return by_name(statement, name, &entries, parameters, report);
    }
    for word in ["action", "central"] {
        if let Some(entry) = entries.iter().find(|entry| entry.is_word(word)) {
            report.push(named::without_name(Kind::Syntax, word, entry.origin()));
            return None;
        }
    }
    written(statement, &entries, parameters, report)
}

/// `{ basis …; [a, b] = …; }` without a name.
fn written(
    statement: &Statement<'_>,
    entries: &[Entry<'_>],
    parameters: &[String],
    report: &mut Report,
) -> Option<Read> {
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
    let constants: Names = parameters.iter().cloned().collect();
    let (mut brackets, mut matrices) = (Vec::new(), Vec::new());
    let mut with_brackets = false;
    for entry in entries.iter().filter(|e| !e.is_word("basis")) {
        if entry.is_word("matrix") {
            matrices.extend(matrix(entry, &constants, report));
        } else {
            with_brackets = true;
            brackets.extend(item::bracket(entry.tokens, entry.origin(), &known, report));
        }
    }
    let computed = !with_brackets && entries.iter().any(|e| e.is_word("matrix"));
    let algebra = Algebra {
        basis,
        brackets: (!computed).then_some(brackets),
        matrices,
        origin: statement.origin,
    };
    let state = None;
    Some(Read {
        algebra,
        state,
        sizes: Vec::new(),
    })
}

/// Whether the algebra is one by its name.
pub fn is_named(statement: &Statement<'_>) -> bool {
    let block = inside(statement.rest, Delimiter::Brace).unwrap_or_default();
    statement.rest.first().is_some_and(|token| token.is('='))
        || block
            .windows(2)
            .any(|pair| pair[0].is_word("named") && pair[1].is('='))
}

/// `{ named = so(3); basis a = e1, b = e2 + e3, c = e3; }`
fn by_name(
    statement: &Statement<'_>,
    name: &Entry<'_>,
    entries: &[Entry<'_>],
    parameters: &[String],
    report: &mut Report,
) -> Option<Read> {
    let (_, value) = item::definition(name.tokens, "`named`", name.origin(), report)?;
    let named = named::parse(value, name.origin(), report);
    let constants: Names = parameters.iter().cloned().collect();
    let mut changes = Changes {
        action: None,
        basis: None,
        central: Vec::new(),
        brackets: Vec::new(),
        matrices: None,
        origin: statement.origin,
    };
    for entry in entries.iter().filter(|entry| !entry.is_word("named")) {
        if entry.is_word("basis") {
            let parts = split_commas(&entry.tokens[1..]).into_iter();
            let line = |tokens: &[Token]| Line {
                tokens: tokens.to_vec().into(),
                place: span(tokens).unwrap_or(entry.origin()),
            };
            changes.basis = Some(parts.map(line).collect());
        } else if entry.is_word("central") {
            changes
                .central
                .extend(names(&entry.tokens[1..], entry.origin(), report));
        } else if entry.is_word("action") {
            let matrix = matrix(entry, &constants, report);
            changes.action.get_or_insert_default().extend(matrix);
        } else if entry.is_word("matrix") {
            let matrix = matrix(entry, &constants, report);
            changes.matrices.get_or_insert_default().extend(matrix);
        } else {
            changes.brackets.push(entry.line());
        }
    }
    changes.apply(named?, report)
}

/// `{ positions q1, q2; momenta p1, p2; x = …; start = [1, 0, 0, 1]; }`
pub fn realization(
    statement: &Statement<'_>,
    parameters: &[String],
    report: &mut Report,
) -> Option<Realization> {
    let entries = statement.block(report)?;
    let mut list = |word: &str| {
        let entry = entries.iter().find(|entry| entry.is_word(word));
        if entry.is_none() {
            report.push(
                Diagnostic::new(
                    Kind::Syntax,
                    statement.origin,
                    format!("the realization has no `{word}`"),
                )
                .help("write `positions q1, q2; momenta p1, p2;`"),
            );
        }
        entry.map_or_else(Vec::new, |entry| {
            names(&entry.tokens[1..], entry.origin(), report)
        })
    };
    let (positions, momenta) = (list("positions"), list("momenta"));
    let own = positions.iter().chain(&momenta).map(|n| n.text.clone());
    let known: Names = own.chain(parameters.iter().cloned()).collect();
    let constants: Names = parameters.iter().cloned().collect();
    let (mut map, mut start) = (Vec::new(), None);
    for entry in &entries {
        if entry.is_word("positions") || entry.is_word("momenta") {
            continue;
        }
        let Some((name, value)) =
            item::definition(entry.tokens, "a component", entry.origin(), report)
        else {
            continue;
        };
        if name.text != "start" {
            let example = ("its value", "q*p");
            let value = item::formula(value, example, name.origin, &known, report);
            map.extend(value.map(|value| (name, value)));
            continue;
        }
        start = starting_point(value, name.origin, &constants, report).or(start);
    }
    Some(Realization {
        positions,
        momenta,
        map,
        start,
        origin: statement.origin,
    })
}

/// `[1, 0, 0, 1]`
fn starting_point(
    value: &[Token],
    origin: Origin,
    constants: &Names,
    report: &mut Report,
) -> Option<Vec<Expr>> {
    let Some(values) = inside(value, Delimiter::Bracket) else {
        let place = span(value).unwrap_or(origin);
        report.push(
            Diagnostic::new(Kind::Syntax, place, "`start` is a list in brackets")
                .help("write `start = [1, 0, 0, 1];`"),
        );
        return None;
    };
    let what = ("an entry of `start`", "1/2");
    let entry = |part| item::formula(part, what, origin, constants, report);
    Some(split_commas(values).into_iter().filter_map(entry).collect())
}

/// `matrix NAME = [[a, b], [c, d]]`
fn matrix(entry: &Entry<'_>, names: &Names, report: &mut Report) -> Option<Matrix> {
    let (name, value) = item::definition(&entry.tokens[1..], "a matrix", entry.origin(), report)?;
    let origin = span(value).unwrap_or(name.origin);
    let mut list = |tokens, what: &str| {
        let list = inside(tokens, Delimiter::Bracket);
        if list.is_none() {
            let place = span(tokens).unwrap_or(origin);
            report.push(
                Diagnostic::new(Kind::Syntax, place, format!("{what} is a list in brackets"))
                    .help(format!("write `matrix {} = [[0, -1], [1, 0]];`", name.text)),
            );
        }
        list.map(split_commas)
    };
    let rows: Vec<Vec<&[Token]>> = list(value, "a matrix")?
        .into_iter()
        .map(|row| list(row, "a row of a matrix"))
        .collect::<Option<_>>()?;
    let mut entry = |tokens| {
        let what = ("an entry of the matrix", "-1/2");
        item::formula(tokens, what, origin, names, report)
    };
    let rows = rows
        .into_iter()
        .map(|row| row.into_iter().map(&mut entry).collect::<Option<_>>())
        .collect::<Option<_>>()?;
    Some(Matrix { name, rows, origin })
}

/// `{ I1 = 2.0, positive; exact k = 1/3; }`
pub fn parameters(entries: Vec<Entry<'_>>, report: &mut Report) -> Parameters {
    let mut parameters = Parameters::default();
    for entry in entries {
        let exact = entry.is_word("exact")
            && entry
                .tokens
                .get(1)
                .is_some_and(|t| t.identifier().is_some());
        let tokens = &entry.tokens[usize::from(exact)..];
        let Some((name, value)) = item::definition(tokens, "a parameter", entry.origin(), report)
        else {
            // Code that uses the parameter is no mistake of its own.
            parameters.names.extend(tokens.first().and_then(|token| {
                let text = token.identifier()?.to_owned();
                Some(Name {
                    text,
                    origin: token.origin,
                })
            }));
            continue;
        };
        if let Some(list) = inside(value, Delimiter::Bracket) {
            let data = family::data(list, name, entry.description(), report);
            parameters.sites.extend(data);
            continue;
        }
        parameters.names.push(name.clone());
        let (value, positive) = positive(value, report);
        if value.is_empty() {
            report.push(item::missing_constant(name.origin));
        } else if let Some(default) = item::constant(value, report) {
            let description = entry.description();
            parameters.whole.push(Parameter {
                name,
                default,
                exact,
                positive,
                unit: None,
                description,
            });
        }
    }
    parameters
}

/// Splits `, positive` off the default of a parameter.
fn positive<'a>(value: &'a [Token], report: &mut Report) -> (&'a [Token], bool) {
    let [default @ .., comma, word] = value else {
        return (value, false);
    };
    let Some(text) = word.identifier().filter(|_| comma.is(',')) else {
        return (value, false);
    };
    if text != "positive" {
        let message = format!("unknown word `{text}` after the default of a parameter");
        report.push(
            Diagnostic::new(Kind::Syntax, word.origin, message)
                .help("write `, positive` for a parameter that takes positive values only"),
        );
    }
    (default, true)
}
