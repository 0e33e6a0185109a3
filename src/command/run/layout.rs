//! The columns of a run: what of the program's rows is shown.

use std::ops::Range;

use std::collections::BTreeMap;

use lie_codegen::model::{Family, Parameter};
use lie_codegen::program::{Chart, columns};
use lie_codegen::structure::{Structure, group};
use lie_program::protocol::Columns;

/// The columns that are shown.
pub struct Layout {
    /// Their names: the time, the coordinates, the energy, the Casimirs, the entries of the group element.
    pub columns: Vec<String>,
    /// How many coordinates are shown: those that carry the time are not.
    pub states: usize,
    /// The columns, of those that are shown, that ought to be constant. The energy of a system that depends on
    /// the time is none of them.
    pub invariants: Range<usize>,
}

impl Layout {
    /// The columns of a run.
    pub fn new(
        model: &Structure,
        chart: Option<Chart>,
        parameters: &BTreeMap<String, f64>,
    ) -> Self {
        match &model.family {
            Some(family) => Self::of_family(model, family, parameters),
            None => Self::of_system(model, chart),
        }
    }

    /// The names of the coordinates.
    pub fn coordinates(&self) -> &[String] {
        &self.columns[1..=self.states]
    }

    /// The columns of a system, with those of a group element.
    fn of_system(model: &Structure, chart: Option<Chart>) -> Self {
        let states = model.shown_coordinates();
        let coordinates = states.iter().map(|&i| model.coordinates[i].text.clone());
        let casimirs = model.casimirs.iter().map(|casimir| casimir.name.clone());
        let varies = model.configuration.as_ref().is_some_and(|c| c.time);
        let energy = states.len() + 1;
        Self {
            columns: std::iter::once("t".to_owned())
                .chain(coordinates)
                .chain(["energy".to_owned()])
                .chain(casimirs)
                .chain(entries(model, chart))
                .collect(),
            invariants: energy + usize::from(varies)..energy + 1 + model.casimirs.len(),
            states: states.len(),
        }
    }

    /// The columns of a family with these values of its parameters.
    fn of_family(model: &Structure, family: &Family, values: &BTreeMap<String, f64>) -> Self {
        let parameters = model.parameters.iter();
        let value = |p: &Parameter| values.get(&p.name).copied().unwrap_or(p.default_value);
        let parameters: Vec<f64> = parameters.map(value).collect();
        let [rows, columns] = family.sites(&parameters).unwrap_or([1, 1]);
        let named = |name: &str, site: usize| match rows {
            1 => format!("{name}[{site}]"),
            _ => format!("{name}[{}][{}]", site / columns, site % columns),
        };
        let mut names = vec!["t".to_owned()];
        for name in &model.coordinates {
            names.extend((0..rows * columns).map(|site| named(&name.text, site)));
        }
        let states = names.len() - 1;
        names.push("energy".to_owned());
        for casimir in &model.casimirs {
            let statistics = lie_runtime::family::STATISTICS.iter();
            names.extend(statistics.map(|what| format!("{}_{what}", casimir.name)));
        }
        Self {
            invariants: states + 1..names.len(),
            columns: names,
            states,
        }
    }

    /// Where the columns that are shown stand in the rows of a program; none where it does not have them.
    pub fn places(&self, columns: &Columns) -> Option<Vec<usize>> {
        let (states, rest) = self.columns[1..].split_at(self.states);
        let (casimirs, element) = rest[1..].split_at(self.invariants.end - self.states - 2);
        // a large family is not searched name by name
        if states == columns.coordinates && casimirs == columns.casimirs && element.is_empty() {
            return (columns.element == 0).then(|| (0..columns.width()).collect());
        }
        if element.len() != columns.element {
            return None;
        }
        let place = |names: &[String], name: &String| names.iter().position(|known| known == name);
        let mut places = vec![0];
        for name in states {
            places.push(columns.coordinates() + place(&columns.coordinates, name)?);
        }
        places.push(columns.energy());
        for name in casimirs {
            places.push(columns.casimirs() + place(&columns.casimirs, name)?);
        }
        places.extend(columns.element()..columns.width());
        Some(places)
    }
}

/// The names of the entries of the group element, if it is followed.
fn entries(model: &Structure, chart: Option<Chart>) -> Vec<String> {
    let Some((chart, group)) = chart.zip(group::group(model)) else {
        return Vec::new();
    };
    let taken = |name: &String| {
        model.coordinates.iter().any(|c| c.text == *name)
            || model.casimirs.iter().any(|c| c.name == *name)
    };
    let names = columns(chart, group.size);
    if names.iter().any(taken) {
        names.iter().map(|name| format!("group_{name}")).collect()
    } else {
        names
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(text: &str) -> Vec<String> {
        text.split_whitespace().map(str::to_owned).collect()
    }

    #[test]
    fn columns_are_found_by_their_names() {
        let layout = Layout {
            columns: names("t x y energy C D q0 q1"),
            states: 2,
            invariants: 3..6,
        };
        let columns = Columns {
            coordinates: names("y clock x"),
            casimirs: names("D C"),
            element: 2,
        };
        assert_eq!(layout.places(&columns), Some(vec![0, 3, 1, 4, 6, 5, 7, 8]));
        for wrong in [
            Columns {
                element: 1,
                ..columns.clone()
            },
            Columns {
                casimirs: names("C"),
                ..columns.clone()
            },
            Columns {
                coordinates: names("x clock"),
                ..columns
            },
        ] {
            assert_eq!(layout.places(&wrong), None);
        }
    }
}
