//! The names of columns. Those of the sites of a family, which may be millions, are made when they are read.

use std::borrow::Cow;
use std::ops::Range;

use lie_runtime::lattice::{AXES, count, named};

/// Names in order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Names {
    parts: Vec<Part>,
    /// Where each part ends.
    ends: Vec<usize>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Part {
    One(String),
    /// A name at each of layers, rows and columns of sites.
    Sites(String, [usize; AXES]),
}

impl Names {
    /// So many names.
    pub fn len(&self) -> usize {
        self.ends.last().copied().unwrap_or(0)
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Adds a name.
    pub fn push(&mut self, name: impl Into<String>) {
        self.ends.push(self.len().saturating_add(1));
        self.parts.push(Part::One(name.into()));
    }

    /// Adds a name at each site; a chain is one row of them, a square lattice one layer.
    pub fn push_sites(&mut self, name: &str, sizes: [usize; AXES]) {
        self.ends.push(self.len().saturating_add(count(sizes)));
        self.parts.push(Part::Sites(name.to_owned(), sizes));
    }

    /// The name at a place.
    ///
    /// # Panics
    /// There is none.
    pub fn get(&self, place: usize) -> Cow<'_, str> {
        let part = self.ends.partition_point(|end| *end <= place);
        let begin = part.checked_sub(1).map_or(0, |before| self.ends[before]);
        match &self.parts[part] {
            Part::One(name) => name.into(),
            Part::Sites(name, sizes) => named(name, place - begin, *sizes).into(),
        }
    }

    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = Cow<'_, str>> {
        (0..self.len()).map(|place| self.get(place))
    }

    /// Those of some places, made.
    pub fn made(&self, places: Range<usize>) -> Vec<String> {
        places.map(|place| self.get(place).into_owned()).collect()
    }
}

impl<T: Into<String>> FromIterator<T> for Names {
    fn from_iter<I: IntoIterator<Item = T>>(names: I) -> Self {
        let mut all = Self::default();
        names.into_iter().for_each(|name| all.push(name));
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_sites_stand_between_others() {
        let mut names: Names = ["t"].into_iter().collect();
        names.push_sites("x", [1, 1, 3]);
        names.push_sites("y", [1, 2, 2]);
        names.push_sites("z", [2, 1, 1]);
        names.push("energy");
        let all: Vec<_> = names.iter().collect();
        let wanted =
            "t x[0] x[1] x[2] y[0][0] y[0][1] y[1][0] y[1][1] z[0][0][0] z[1][0][0] energy";
        assert_eq!(all, wanted.split(' ').collect::<Vec<_>>());
        assert_eq!(names.len(), 11);
        assert_eq!(names.made(3..5), ["x[2]", "y[0][0]"]);
    }
}
