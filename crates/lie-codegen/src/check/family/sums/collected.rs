//! All sums of a declaration, with the sites that they and the motion of a site depend on.

use super::bonds::{BOND_VALUE, second};
use super::{Near, Sum, Sums, indices, named};
use crate::model::apart;
use lie_core::lattice::AXES;

/// A sum as it was written.
pub struct Collected {
    /// The distances of all sites that a summand or the motion of a site depends on.
    pub slots: Vec<[i64; AXES]>,
    /// The names of all coordinates, slot after slot.
    pub names: Vec<String>,
    /// Which slots and coefficients sums and motions depend on.
    pub data_places: Vec<[usize; 2]>,
    /// The names of these coefficients.
    pub data: Vec<String>,
    /// The number of last layers, rows and columns of which no sum asks for a value.
    pub unused: Vec<[usize; AXES]>,
    /// The names of the coordinates of the second site of a bond, and of its value.
    pub other: Vec<String>,
    /// The sums.
    pub sums: Vec<Sum>,
}

impl Collected {
    /// The slot of a distance.
    pub fn slot(&self, distance: [i64; AXES]) -> usize {
        let found = self.slots.iter().position(|slot| *slot == distance);
        found.unwrap_or_default()
    }
}

impl Sums<'_> {
    /// All that were found.
    pub fn collected(self) -> Collected {
        let Near {
            sites: mut slots,
            data: mut asked,
        } = self.acting;
        slots.insert([0; AXES]);
        slots.extend(asked.iter().map(|(at, _)| *at));
        for sum in &self.found {
            for one in &sum.sites {
                slots.insert(*one);
                let others = sum.sites.iter();
                slots.extend(others.map(|other| apart(other, one)));
            }
        }
        let indices: Vec<String> = indices(self.family);
        let state = &self.declaration.state;
        let names = slots
            .iter()
            .flat_map(|slot| state.iter().map(|name| named(&name.text, &indices, *slot)))
            .collect();
        // the motion of a site asks for those of the summands that it is in
        for sum in &self.found {
            for from in sum.moving.iter().chain(&[[0; AXES]]) {
                let data = sum.data.iter();
                asked.extend(data.map(|(at, which)| (apart(at, from), *which)));
            }
        }
        let name = |which: usize| &self.family.data[which].name.text;
        let data = asked
            .iter()
            .map(|(at, which)| named(name(*which), &indices, *at))
            .collect();
        let slots: Vec<[i64; AXES]> = slots.into_iter().collect();
        let slot = |at| slots.iter().position(|slot| *slot == at);
        let data_places = asked
            .into_iter()
            .filter_map(|(at, which)| Some([slot(at)?, which]))
            .collect();
        let unused = self.unused.iter();
        let other = state.iter().map(|name| second(&name.text));
        Collected {
            other: other.chain([BOND_VALUE.to_owned()]).collect(),
            slots,
            names,
            data_places,
            data,
            unused: unused.map(|unused| unused.unwrap_or_default()).collect(),
            sums: self.found,
        }
    }
}
