//! What stands in a row.

use serde::{Deserialize, Serialize};

/// The coordinates of rows.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Coordinates {
    /// Their names.
    Named(Vec<String>),
    /// So many: those of the sites of a family, in its order. There may be millions, whose names would take more memory than they.
    OfSites(usize),
}

impl Default for Coordinates {
    fn default() -> Self {
        Self::Named(Vec::new())
    }
}

impl Coordinates {
    /// How many there are.
    pub fn len(&self) -> usize {
        match self {
            Self::Named(names) => names.len(),
            Self::OfSites(count) => *count,
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// The numbers of a row: the time, the coordinates, the energy, the Casimirs, the declared functions, the group element.
#[derive(Clone, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Columns {
    /// The coordinates.
    pub coordinates: Coordinates,
    /// The names of the Casimirs.
    pub casimirs: Vec<String>,
    /// The names of the declared functions.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub quantities: Vec<String>,
    /// The number of entries of the group element, where a method reconstructs it.
    pub element: usize,
}

impl Columns {
    /// How many numbers a row has.
    pub fn width(&self) -> usize {
        self.element() + self.element
    }

    /// The place of the first coordinate; the time stands before it.
    pub fn coordinates(&self) -> usize {
        1
    }

    /// The place of the energy.
    pub fn energy(&self) -> usize {
        self.coordinates() + self.coordinates.len()
    }

    /// The place of the first Casimir.
    pub fn casimirs(&self) -> usize {
        self.energy() + 1
    }

    /// The place of the first declared function.
    pub fn quantities(&self) -> usize {
        self.casimirs() + self.casimirs.len()
    }

    /// The place of the first entry of the group element.
    pub fn element(&self) -> usize {
        self.quantities() + self.quantities.len()
    }
}
