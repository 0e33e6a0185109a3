//! Statements of families: `state x[i], y[i], z[i];`, `algebra = so(3)^N;`, `initial = random(unit-sphere, 1);`.

use super::block::names;
use super::entry::{compact, inside};
use super::statement::Statement;
use crate::ast::{BONDS, Name, SiteData, SiteValues, Start};
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};
use crate::front::entries::Read;
use crate::front::token::{Delimiter, Token, TokenKind, span, split_commas};
use crate::front::{families, item};

/// The names of the state, and of a family their indices.
pub fn state(statement: &Statement<'_>, report: &mut Report) -> (Vec<Name>, Vec<Name>) {
    let parts = split_commas(statement.rest).into_iter();
    match parts
        .map(families::indexed_state)
        .collect::<Option<Vec<_>>>()
    {
        Some(state) if !state.is_empty() => families::same_indices(state, report),
        _ => (names(statement.rest, statement.origin, report), Vec::new()),
    }
}

/// Whether a state is that of a family.
pub fn is_indexed(statement: &Statement<'_>) -> bool {
    let mut parts = split_commas(statement.rest).into_iter().peekable();
    parts.peek().is_some() && parts.all(|part| families::indexed_state(part).is_some())
}

/// `= so(3)^N`
pub fn algebra(statement: &Statement<'_>, report: &mut Report) -> Option<Read> {
    match statement.rest.split_first().filter(|(t, _)| t.is('=')) {
        Some((equals, name)) => families::algebra(name, equals.origin, report),
        None => {
            let message = "the algebra of a family is one by its name";
            let help = "write `algebra = so(3)^N;`, with N a parameter or a number";
            report.push(Diagnostic::new(Kind::Syntax, statement.origin, message).help(help));
            None
        }
    }
}

/// `[1, 2, 1/2]`, or of a lattice `[[1, 2], [3, 4]]`: the values of a coefficient, site after site.
pub fn data(
    list: &[Token],
    name: Name,
    description: Option<String>,
    report: &mut Report,
) -> Option<SiteData> {
    let origin = span(list).unwrap_or(name.origin);
    let parts = split_commas(list);
    let rows: Option<Vec<&[Token]>> = parts
        .iter()
        .map(|part| inside(part, Delimiter::Bracket))
        .collect();
    let rows: Option<Vec<_>> = rows.map(|rows| rows.into_iter().map(split_commas).collect());
    let shape = match rows.as_deref() {
        Some([first, rest @ ..]) if rest.iter().all(|row| row.len() == first.len()) => {
            vec![rest.len() + 1, first.len()]
        }
        Some([_, ..]) => {
            let message = format!("the rows of `{}` have different lengths", name.text);
            let help = "write a row of values for each row of the lattice";
            report.push(Diagnostic::new(Kind::Syntax, origin, message).help(help));
            return None;
        }
        _ => vec![parts.len()],
    };
    let entries = rows.map_or(parts, |rows| rows.concat()).into_iter();
    let entries = entries.map(|entry| match entry {
        [] => {
            report.push(item::missing_constant(origin));
            None
        }
        entry => item::constant(entry, report),
    });
    let entries: Vec<_> = entries.collect();
    Some(SiteData {
        values: SiteValues::Written(entries.into_iter().collect::<Option<_>>()?),
        name,
        shape,
        origin,
        unit: None,
        description,
    })
}

/// `= [[0, 1, 1], [1, 5, 1/2]]`: rows of bonds.
pub fn rows(statement: &Statement<'_>, report: &mut Report) -> Option<SiteData> {
    let list = match statement.value(report)? {
        [one] => inside(std::slice::from_ref(one), Delimiter::Bracket),
        list => inside(list, Delimiter::Bracket),
    };
    let origin = statement.origin;
    let name = Name {
        text: BONDS.to_owned(),
        origin,
    };
    let read = data(list.unwrap_or_default(), name, None, report)?;
    bonds(read.values, read.shape, origin, report)
}

/// Bonds of these numbers, three for each.
pub fn bonds(
    values: SiteValues,
    shape: Vec<usize>,
    origin: Origin,
    report: &mut Report,
) -> Option<SiteData> {
    if shape.last() != Some(&3) || shape.len() != 2 || shape[0] == 0 {
        let message = match shape.contains(&0) {
            true => "there are no bonds",
            false => "a bond is two sites and a number",
        };
        let help = "write `i,j,value` in each line of a file, or `[[0, 1, 1], [1, 5, 1/2]]`";
        report.push(Diagnostic::new(Kind::Schema, origin, message).help(help));
        return None;
    }
    let name = Name {
        text: BONDS.to_owned(),
        origin,
    };
    Some(SiteData {
        name,
        values,
        shape,
        origin,
        unit: None,
        description: None,
    })
}

/// `= random(unit-sphere, 1)`
pub fn start(statement: &Statement<'_>, report: &mut Report) -> Option<Start> {
    let value = statement.value(report)?;
    let seed = match value {
        [word, list @ ..] if word.is_word("random") => seed(list),
        _ => None,
    };
    if seed.is_none() {
        let place = span(value).unwrap_or(statement.origin);
        let message = "the initial state of a family is a random one";
        let help = "write `initial = random(unit-sphere, 1);`: a point on the unit sphere for each site, the seed behind it";
        report.push(Diagnostic::new(Kind::Syntax, place, message).help(help));
    }
    seed.map(Start::UnitSpheres)
}

fn seed(list: &[Token]) -> Option<u64> {
    let parts = split_commas(inside(list, Delimiter::Parenthesis)?);
    let sphere = parts
        .first()
        .is_some_and(|part| compact(part) == "unit-sphere");
    match parts.as_slice() {
        _ if !sphere => None,
        [_] => Some(1),
        [_, [number]] => match &number.kind {
            TokenKind::Number(text) => text.parse().ok(),
            _ => None,
        },
        _ => None,
    }
}
