//! The rows of a run that are dots on its curve.

use super::FEW_ROWS;
use super::chart::{Series, Stroke};
use super::few;
use super::svg::Place;

/// The rows of a run, as long as they are few, and how many points there are between them.
#[derive(Clone, Debug, Default)]
pub(super) struct Rows {
    dots: Vec<Place>,
    between: usize,
}

impl Rows {
    /// Takes a row.
    pub(super) fn push(&mut self, place: Place) {
        if self.dots.len() <= FEW_ROWS {
            self.dots.push(place);
        }
    }

    /// Takes note of a point between rows.
    pub(super) fn add_between(&mut self) {
        self.between += 1;
    }

    /// How many points there are between the rows.
    pub(super) fn between(&self) -> usize {
        self.between
    }

    /// How many rows there are; where they are not few, one more than those.
    pub(super) fn count(&self) -> usize {
        self.dots.len()
    }

    /// The rows, where they are few.
    pub(super) fn all(&self) -> &[Place] {
        &self.dots
    }

    /// The dots as a series, if there are any.
    pub(super) fn series(&self, name: &str, colour: usize) -> Option<Series> {
        let dots = few(&self.dots, self.between);
        (!dots.is_empty()).then(|| Series {
            name: name.to_owned(),
            colour,
            stroke: Stroke::Dots,
            points: dots.to_vec(),
        })
    }
}
