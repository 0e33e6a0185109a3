//! The columns of a run: what the program writes, and what of it is shown.

use std::ops::Range;

use lie_codegen::model::Model;
use lie_codegen::program::Chart;
use lie_codegen::structure::group;

/// Where the numbers of a row stand.
pub struct Layout {
    /// Numbers of a row as the program writes it: time, all coordinates, energy, Casimirs, group element.
    pub width: usize,
    /// The coordinates that are shown: those that carry the time are not.
    pub states: Vec<usize>,
    /// The columns, of those that are shown, that ought to be constant. The energy of a system that depends on
    /// the time is none of them.
    pub invariants: Range<usize>,
    /// The numbers of a row that are shown.
    picked: Vec<usize>,
    /// The names of the entries of the group element.
    group: Vec<String>,
}

impl Layout {
    /// The columns of a system, with those of a group element.
    pub fn new(model: &Model, chart: Option<Chart>) -> Self {
        let states = model.shown_coordinates();
        let group = chart
            .zip(group::group(model))
            .map_or_else(Vec::new, |(chart, group)| {
                let taken = |name: &String| {
                    model.coordinates.iter().any(|c| c.text == *name)
                        || model.casimirs.iter().any(|c| c.name == *name)
                };
                let names = chart.columns(group.size);
                if names.iter().any(taken) {
                    names.iter().map(|name| format!("group_{name}")).collect()
                } else {
                    names
                }
            });
        let all = model.dimension();
        let width = all + 2 + model.casimirs.len() + group.len();
        let coordinates = states.iter().map(|coordinate| coordinate + 1);
        let picked = std::iter::once(0).chain(coordinates).chain(all + 1..width);
        let varies = model.configuration.as_ref().is_some_and(|c| c.time);
        let energy = states.len() + 1;
        Self {
            width,
            picked: picked.collect(),
            invariants: energy + usize::from(varies)..energy + 1 + model.casimirs.len(),
            states,
            group,
        }
    }

    /// The names of the columns that are shown.
    pub fn columns(&self, model: &Model) -> Vec<String> {
        let states = self
            .states
            .iter()
            .map(|&i| model.coordinates[i].text.clone());
        let casimirs = model.casimirs.iter().map(|casimir| casimir.name.clone());
        std::iter::once("t".to_owned())
            .chain(states)
            .chain(["energy".to_owned()])
            .chain(casimirs)
            .chain(self.group.iter().cloned())
            .collect()
    }

    /// What is shown of whole rows.
    pub fn shown(&self, numbers: &[f64]) -> Vec<f64> {
        let rows = numbers.chunks_exact(self.width);
        rows.flat_map(|row| self.picked.iter().map(|&column| row[column]))
            .collect()
    }
}
