//! The columns of a run: what of the program's rows is shown.

use std::borrow::Cow;
use std::ops::Range;

use std::collections::BTreeMap;

use lie_codegen::model::{Family, Parameter, QuantityKind};
use lie_codegen::program::{Chart, columns};
use lie_codegen::structure::{Structure, group};
use lie_program::protocol::{Columns, Coordinates};
use lie_runtime::lattice::AXES;

use lie_output::Names;

/// The columns that are shown.
pub struct Layout {
    /// Their names: the time, the coordinates, the energy, the Casimirs, the declared functions, the entries of the group element.
    pub columns: Names,
    /// How many coordinates are shown: those that carry the time are not.
    pub states: usize,
    /// The columns, of those that are watched, that ought to be constant: energy, Casimirs, first integrals. The energy of a system
    /// that depends on the time is none of them.
    pub invariants: Range<usize>,
    /// What is watched in a row, where that is not the row itself: where forces act, the energy without their work takes the place of the
    /// energy, and Casimirs that they change stand with what is recorded beside the invariants.
    watched: Option<Vec<Watched>>,
    /// Where the entries of the group element begin. The other declared functions stand before it.
    pub element: usize,
}

/// A number that is watched.
#[derive(Clone, Copy)]
enum Watched {
    /// That of a column.
    Column(usize),
    /// The difference of two.
    Difference(usize, usize),
}

impl Layout {
    /// The names of what is watched.
    pub fn watched_names(&self) -> Vec<String> {
        let all = self.columns.made(0..self.columns.len());
        let name = |watched: &Watched| match *watched {
            Watched::Column(place) => all[place].clone(),
            Watched::Difference(a, b) => format!("{} - {}", all[a], all[b]),
        };
        match &self.watched {
            Some(watched) => watched.iter().map(name).collect(),
            None => all,
        }
    }

    /// What is watched of a row that is shown.
    pub fn watched<'r>(&self, row: &'r [f64]) -> Cow<'r, [f64]> {
        let value = |watched: &Watched| match *watched {
            Watched::Column(place) => row[place],
            Watched::Difference(a, b) => row[a] - row[b],
        };
        match &self.watched {
            Some(watched) => watched.iter().map(value).collect(),
            None => Cow::Borrowed(row),
        }
    }

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

    /// Whether something is recorded beside the state and the invariants.
    pub fn has_recorded(&self) -> bool {
        self.watched.is_some() || self.element > self.invariants.end
    }

    /// The names of the coordinates.
    pub fn coordinates(&self) -> Vec<String> {
        self.columns.made(1..1 + self.states)
    }

    /// The columns of a system, with those of a group element.
    fn of_system(model: &Structure, chart: Option<Chart>) -> Self {
        let states = model.shown_coordinates();
        let coordinates = states.iter().map(|&i| model.coordinates[i].text.clone());
        let casimirs = model.casimirs.iter().map(|casimir| casimir.name.clone());
        let energy = states.len() + 1;
        let quantities = model.quantities.iter();
        let integrals = quantities
            .clone()
            .filter(|q| q.kind == QuantityKind::Integral);
        let casimirs_end = energy + 1 + model.casimirs.len();
        let mut layout = Self {
            columns: std::iter::once("t".to_owned())
                .chain(coordinates)
                .chain(["energy".to_owned()])
                .chain(casimirs)
                .chain(quantities.map(|quantity| quantity.name.clone()))
                .chain(entries(model, chart))
                .collect(),
            invariants: energy..casimirs_end + integrals.count(),
            element: casimirs_end + model.quantities.len(),
            states: states.len(),
            watched: None,
        };
        layout.watch(model, 1);
        layout
    }

    /// Where something acts or H depends on the time, watches the energy without the work of forces and dissipation in place of the energy,
    /// which is recorded as what else varies; each Casimir has so many columns.
    fn watch(&mut self, model: &Structure, each: usize) {
        if model.driving.is_none() && !model.is_timed() {
            return;
        }
        let energy = self.states + 1;
        let casimirs = model.casimirs.iter();
        let casimirs = casimirs.flat_map(|casimir| std::iter::repeat_n(casimir.kept, each));
        let quantities = model.quantities.iter().map(|quantity| quantity.kind);
        let quantities = quantities.map(|kind| kind == QuantityKind::Integral);
        let kept = (energy + 1..).zip(casimirs.chain(quantities));
        let (kept, changed): (Vec<_>, Vec<_>) = kept.partition(|(_, kept)| *kept);
        let work = energy + 1 + each * model.casimirs.len();
        let columns = |places: Vec<(usize, bool)>| places.into_iter().map(|(place, _)| place);
        let mut watched: Vec<Watched> = (0..energy).map(Watched::Column).collect();
        // noise is no work, and where nothing acts there is no such column
        let driving = model.driving.as_ref();
        let balanced = driving.is_some_and(|driving| !driving.is_noisy());
        if balanced {
            watched.push(Watched::Difference(energy, work));
        }
        watched.extend(columns(kept).map(Watched::Column));
        self.invariants = energy..watched.len();
        let behind = [energy].into_iter().chain(columns(changed));
        watched.extend(
            behind
                .chain(self.element..self.columns.len())
                .map(Watched::Column),
        );
        self.watched = Some(watched);
    }

    /// The columns of a family with these values of its parameters.
    fn of_family(model: &Structure, family: &Family, values: &BTreeMap<String, f64>) -> Self {
        let parameters = model.parameters.iter();
        let value = |p: &Parameter| values.get(&p.name).copied().unwrap_or(p.default_value);
        let parameters: Vec<f64> = parameters.map(value).collect();
        let sizes = family.sites(&parameters).unwrap_or([1; AXES]);
        let mut names = Names::default();
        names.push("t");
        for name in &model.coordinates {
            names.push_sites(&name.text, sizes);
        }
        let states = names.len() - 1;
        names.push("energy");
        for casimir in &model.casimirs {
            for what in lie_runtime::family::STATISTICS {
                names.push(format!("{}_{what}", casimir.name));
            }
        }
        let casimirs = names.len();
        for quantity in &model.quantities {
            names.push(&quantity.name);
        }
        let mut layout = Self {
            invariants: states + 1..casimirs,
            element: names.len(),
            columns: names,
            states,
            watched: None,
        };
        layout.watch(model, lie_runtime::family::STATISTICS.len());
        layout
    }

    /// Where the columns that are shown stand in the rows of a program; none where it does not have them.
    pub fn places(&self, columns: &Columns) -> Option<Places> {
        let behind = self.columns.made(2 + self.states..self.element);
        let (casimirs, quantities) = behind.split_at(columns.casimirs.len().min(behind.len()));
        if self.columns.len() - self.element != columns.element {
            return None;
        }
        let known = match &columns.coordinates {
            // the order of a family is that of its sites
            Coordinates::OfSites(count) => {
                let same = *count == self.states
                    && *casimirs == columns.casimirs
                    && *quantities == columns.quantities;
                return same.then(|| Places::All(columns.width()));
            }
            Coordinates::Named(known) => known,
        };
        let place = |names: &[String], name: &String| names.iter().position(|known| known == name);
        let mut places = vec![0];
        for name in &self.coordinates() {
            places.push(columns.coordinates() + place(known, name)?);
        }
        places.push(columns.energy());
        for name in casimirs {
            places.push(columns.casimirs() + place(&columns.casimirs, name)?);
        }
        for name in quantities {
            places.push(columns.quantities() + place(&columns.quantities, name)?);
        }
        places.extend(columns.element()..columns.width());
        Some(match places.iter().copied().eq(0..columns.width()) {
            true => Places::All(columns.width()),
            false => Places::Some(places),
        })
    }
}

/// Where the columns that are shown stand in the rows of a program.
#[derive(Debug, PartialEq)]
pub enum Places {
    /// They are all of them, in their order.
    All(usize),
    /// These.
    Some(Vec<usize>),
}

impl Places {
    /// How many columns are shown.
    pub fn len(&self) -> usize {
        match self {
            Self::All(count) => *count,
            Self::Some(places) => places.len(),
        }
    }

    /// Of rows of this width what is shown.
    pub fn shown(&self, numbers: Vec<f64>, width: usize) -> Vec<f64> {
        match self {
            Self::All(_) => numbers,
            Self::Some(places) => {
                let rows = numbers.chunks_exact(width);
                rows.flat_map(|row| places.iter().map(|&place| row[place]))
                    .collect()
            }
        }
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
            || model.quantities.iter().any(|q| q.name == *name)
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

    fn named(text: &str) -> Coordinates {
        Coordinates::Named(names(text))
    }

    #[test]
    fn columns_are_found_by_their_names() {
        let layout = Layout {
            columns: names("t x y energy C D F q0 q1").into_iter().collect(),
            states: 2,
            invariants: 3..6,
            watched: None,
            element: 7,
        };
        let columns = Columns {
            coordinates: named("y clock x"),
            casimirs: names("D C"),
            quantities: names("F"),
            element: 2,
        };
        let places = vec![0, 3, 1, 4, 6, 5, 7, 8, 9];
        assert_eq!(layout.places(&columns), Some(Places::Some(places)));
        let of_sites = |count| Columns {
            coordinates: Coordinates::OfSites(count),
            casimirs: names("C D F"),
            element: 2,
            ..Columns::default()
        };
        assert_eq!(layout.places(&of_sites(2)), Some(Places::All(9)));
        assert_eq!(layout.places(&of_sites(3)), None);
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
                quantities: names("G"),
                ..columns.clone()
            },
            Columns {
                coordinates: named("x clock"),
                ..columns
            },
        ] {
            assert_eq!(layout.places(&wrong), None);
        }
    }
}
