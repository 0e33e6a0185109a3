//! Statements of families: `state x[i], y[i], z[i];`, `algebra = so(3)^N;`, `initial = random(unit-sphere, 1);`.

use super::block::names;
use super::entry::{compact, inside};
use super::statement::Statement;
use crate::ast::{BONDS, Name, SiteData, SiteValues, Start};
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};
use crate::front::entries::Read;
use crate::front::token::{Delimiter, Token, TokenKind, span, split_commas};
use crate::front::{families, item};
use lie_core::lattice::AXES;

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

/// `[1, 2, 1/2]`, or of a lattice `[[1, 2], [3, 4]]`, in three dimensions `[[[1, 2]], [[3, 4]]]`: the values of a coefficient, site after site.
pub fn data(
    list: &[Token],
    name: Name,
    description: Option<String>,
    report: &mut Report,
) -> Option<SiteData> {
    let origin = span(list).unwrap_or(name.origin);
    let mut entries = Vec::new();
    let shape = match nested(list, AXES, &mut entries) {
        Ok(shape) => shape,
        Err((part, shapes)) => {
            let (message, help) = ragged(&format!("`{}`", name.text), [&shapes[0], &shapes[1]]);
            let place = span(part).unwrap_or(origin);
            report.push(Diagnostic::new(Kind::Syntax, place, message).help(help));
            return None;
        }
    };
    let entries = entries.into_iter().map(|entry| match entry {
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

/// A part of a list that has another shape than the first one, and both shapes.
type Ragged<'a> = (&'a [Token], [Vec<usize>; 2]);

/// Adds the entries of lists within lists, at most so deep; how many there are along each axis.
fn nested<'a>(
    list: &'a [Token],
    depth: usize,
    all: &mut Vec<&'a [Token]>,
) -> Result<Vec<usize>, Ragged<'a>> {
    let parts = split_commas(list);
    let rows = parts.iter().map(|part| inside(part, Delimiter::Bracket));
    let rows: Option<Vec<_>> = rows.collect();
    let Some(rows) = rows.filter(|rows| depth > 1 && !rows.is_empty()) else {
        let count = parts.len();
        all.extend(parts);
        return Ok(vec![count]);
    };
    let (mut shape, count) = (Vec::new(), rows.len());
    for (row, part) in rows.into_iter().zip(parts) {
        let of_row = nested(row, depth - 1, all)?;
        if shape.is_empty() {
            shape.clone_from(&of_row);
        }
        if shape != of_row {
            return Err((part, [shape, of_row]));
        }
    }
    shape.insert(0, count);
    Ok(shape)
}

/// What is said of parts of a list that have these shapes, and what to write.
pub fn ragged(what: &str, shapes: [&[usize]; 2]) -> (String, &'static str) {
    match shapes.iter().all(|shape| shape.len() == 1) {
        true => (
            format!("the rows of {what} have different lengths"),
            "write a row of values for each row of the lattice",
        ),
        false => (
            format!("the layers of {what} have different shapes"),
            "write as many rows of as many values for each layer of the lattice",
        ),
    }
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
