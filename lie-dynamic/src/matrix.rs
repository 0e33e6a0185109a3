//! Square matrices on the heap.

use lie_runtime::{Scalar, SquareMatrix};

/// A square matrix on the heap, row after row.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrix<S> {
    size: usize,
    entries: Vec<S>,
}

impl<S: Scalar> Matrix<S> {
    /// A matrix of zeros.
    pub fn zero(size: usize) -> Self {
        Self {
            size,
            entries: vec![S::zero(); size * size],
        }
    }

    /// All entries, row after row.
    pub fn as_mut_slice(&mut self) -> &mut [S] {
        &mut self.entries
    }
}

impl<S: Scalar> SquareMatrix<S> for Matrix<S> {
    #[inline]
    fn dimension(&self) -> usize {
        self.size
    }
    #[inline]
    fn get(&self, row: usize, column: usize) -> S {
        self.entries[row * self.size + column]
    }
    #[inline]
    fn set(&mut self, row: usize, column: usize, value: S) {
        self.entries[row * self.size + column] = value;
    }
}
