//! Matrices of a declared representation.

use crate::errors::ROUND_OFF;
use crate::systems::relative_distance;
use crate::vectors::{Reference, rows};

/// Square matrices of the declared representation, row after row.
pub struct Representation {
    size: usize,
    pub basis: Vec<Vec<f64>>,
}

impl Representation {
    pub fn of(name: &str) -> Self {
        let file = Reference::vector(name);
        let matrices = file.0["matrix_representation"]
            .as_array()
            .expect("matrices");
        let basis: Vec<Vec<f64>> = matrices
            .iter()
            .map(|matrix| rows(matrix).concat())
            .collect();
        Self {
            size: basis[0].len().isqrt(),
            basis,
        }
    }

    pub fn element(&self, coordinates: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; self.size * self.size];
        for (matrix, x) in self.basis.iter().zip(coordinates) {
            sum.iter_mut()
                .zip(matrix)
                .for_each(|(sum, entry)| *sum += x * entry);
        }
        sum
    }

    pub fn product(&self, a: &[f64], b: &[f64]) -> Vec<f64> {
        let n = self.size;
        let entry =
            |row: usize, column: usize| (0..n).map(|k| a[row * n + k] * b[k * n + column]).sum();
        (0..n * n)
            .map(|index| entry(index / n, index % n))
            .collect()
    }

    /// The coordinates of a matrix in the span of the basis, by the normal equations.
    pub fn coordinates(&self, matrix: &[f64]) -> Vec<f64> {
        let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
        let count = self.basis.len();
        let mut rows: Vec<Vec<f64>> = (self.basis.iter())
            .map(|a| {
                self.basis
                    .iter()
                    .map(|b| dot(a, b))
                    .chain([dot(a, matrix)])
                    .collect()
            })
            .collect();
        for pivot in 0..count {
            let row = rows[pivot].clone();
            for other in (0..count).filter(|&other| other != pivot) {
                let factor = rows[other][pivot] / row[pivot];
                rows[other]
                    .iter_mut()
                    .zip(&row)
                    .for_each(|(x, y)| *x -= factor * y);
            }
        }
        let coordinates: Vec<f64> = (0..count)
            .map(|index| rows[index][count] / rows[index][index])
            .collect();
        assert!(
            relative_distance(&self.element(&coordinates), matrix) < ROUND_OFF,
            "not in the span"
        );
        coordinates
    }
}
