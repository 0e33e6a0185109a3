//! What comparisons of kernels have found.

use lie_runtime::{SquareMatrix, Unknown};

use crate::systems::relative_distance;

/// Round-off of a few dozen operations on numbers near 1.
pub const ROUND_OFF: f64 = 8.0 * f64::EPSILON;
/// The errors of all kernels, relative to the size of what was compared.
pub struct Errors {
    found: Vec<(String, f64)>,
    /// The references are taken at states that differ by this factor from 1: 0, or what a control
    /// must notice.
    pub nudge: f64,
}

impl Errors {
    pub fn new(nudge: f64) -> Self {
        Self {
            found: Vec::new(),
            nudge,
        }
    }

    pub fn compare(&mut self, what: &str, fused: &[f64], reference: &[f64]) {
        self.found
            .push((what.to_owned(), relative_distance(fused, reference)));
    }

    /// The kernels whose error is beyond round-off; not a number counts.
    pub fn beyond_round_off(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for (name, error) in &self.found {
            if error.partial_cmp(&ROUND_OFF) != Some(std::cmp::Ordering::Less)
                && !names.contains(&name.as_str())
            {
                names.push(name);
            }
        }
        names
    }

    pub fn names(&self) -> Vec<&str> {
        let mut names: Vec<&str> = self.found.iter().map(|(name, _)| name.as_str()).collect();
        names.sort_unstable();
        names.dedup();
        names
    }

    pub fn largest(&self) -> (f64, &str) {
        let start = (0.0, "none");
        self.found
            .iter()
            .fold(start, |(largest, name), (new, error)| {
                if *error > largest {
                    (*error, new.as_str())
                } else {
                    (largest, name)
                }
            })
    }
}

/// All entries, row after row.
pub fn entries<M: SquareMatrix<f64>>(matrix: &M) -> Vec<f64> {
    let size = matrix.dimension();
    let mut entries = Vec::with_capacity(size * size);
    for row in 0..size {
        for column in 0..size {
            entries.push(matrix.get(row, column));
        }
    }
    entries
}

pub fn unknown_entries<U: Unknown<f64>>(unknown: &U) -> Vec<f64> {
    (0..unknown.len())
        .map(|index| unknown.entry(index))
        .collect()
}

pub fn nudged(values: &[f64], errors: &Errors) -> Vec<f64> {
    values.iter().map(|x| x * (1.0 + errors.nudge)).collect()
}
