//! Skew-Hermitian matrices as states: their independent real numbers in one vector.

use lie_runtime::{Scalar, State, Unknown};
use thiserror::Error;

/// A mistake in the shape of a matrix.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ShapeError {
    /// A matrix of another size than the system's.
    #[error(
        "the system has {system} x {system} matrices, the state is {state} x {state}: give both the same size"
    )]
    Size {
        /// The size of the system's matrices.
        system: usize,
        /// That of the state.
        state: usize,
    },
    /// Not as many numbers as a skew-Hermitian matrix has.
    #[error("a skew-Hermitian matrix of size {size} has {} real coordinates, not {count}", size * size)]
    Count {
        /// The size of the matrix.
        size: usize,
        /// How many numbers were given.
        count: usize,
    },
    /// A matrix that is not skew-Hermitian.
    #[error(
        "the entries ({row}, {column}) and ({column}, {row}) are not those of a skew-Hermitian matrix: W_jk = -conj(W_kj)"
    )]
    NotSkew {
        /// The row of one of them.
        row: usize,
        /// Its column.
        column: usize,
    },
    /// A degree or order that the matrices of this size do not have.
    #[error(
        "there is no harmonic of degree {degree} and order {order} for matrices of size {size}: order <= degree < size"
    )]
    Harmonic {
        /// The degree l.
        degree: usize,
        /// The order m.
        order: usize,
        /// The size of the matrices.
        size: usize,
    },
    /// Matrices too small for a system.
    #[error("the matrices must have at least {least} rows, not {size}")]
    TooSmall {
        /// The least number of rows.
        least: usize,
        /// The number given.
        size: usize,
    },
}

/// A skew-Hermitian matrix W of size N, `W_jk = -conj(W_kj)`, an element of u(N) and of its dual.
///
/// Its `N^2` coordinates are the imaginary parts of the lower triangle with the diagonal, column by column, and then
/// the real parts of what is below the diagonal. Indices count from 0.
#[derive(Clone, Debug, PartialEq)]
pub struct SkewHermitian {
    size: usize,
    coordinates: Vec<f64>,
}

impl SkewHermitian {
    /// The matrix of zeros.
    pub fn zeros(size: usize) -> Self {
        Self {
            size,
            coordinates: vec![0.0; size * size],
        }
    }

    /// The matrix with these coordinates, in the order of the type.
    ///
    /// # Errors
    /// [`ShapeError::Count`] if there are not `size^2`.
    pub fn from_coordinates(size: usize, coordinates: Vec<f64>) -> Result<Self, ShapeError> {
        if coordinates.len() != size * size {
            let count = coordinates.len();
            return Err(ShapeError::Count { size, count });
        }
        Ok(Self { size, coordinates })
    }

    /// The matrix with these entries (real and imaginary part), which must be skew-Hermitian to 1e-12 of the largest.
    ///
    /// # Errors
    /// [`ShapeError::NotSkew`] with the first pair of entries that does not fit.
    pub fn from_entries(
        size: usize,
        entry: impl Fn(usize, usize) -> (f64, f64),
    ) -> Result<Self, ShapeError> {
        let mut matrix = Self::zeros(size);
        let mut largest = 0.0_f64;
        for row in 0..size {
            for column in 0..size {
                let (re, im) = entry(row, column);
                largest = largest.max(re.abs()).max(im.abs());
            }
        }
        for row in 0..size {
            for column in 0..=row {
                let (lower, upper) = (entry(row, column), entry(column, row));
                // not a number if an entry is not
                let off = Scalar::max((lower.0 + upper.0).abs(), (lower.1 - upper.1).abs());
                if off > 1e-12 * largest || off.is_nan() {
                    return Err(ShapeError::NotSkew { row, column });
                }
                matrix.set_lower(row, column, lower);
            }
        }
        Ok(matrix)
    }

    /// The number of rows N.
    pub fn size(&self) -> usize {
        self.size
    }

    /// The entry in a row and a column: real and imaginary part.
    pub fn entry(&self, row: usize, column: usize) -> (f64, f64) {
        let (upper, low, high) = (row < column, row.min(column), row.max(column));
        let im = self.coordinates[imaginary_start(self.size, low) + high - low];
        if low == high {
            return (0.0, im);
        }
        let re = self.coordinates[real_start(self.size, low) + high - low - 1];
        (if upper { -re } else { re }, im)
    }

    /// Sets an entry below or on the diagonal, and with it the one opposite; of the diagonal the imaginary part counts.
    ///
    /// # Panics
    /// Above the diagonal.
    pub fn set_lower(&mut self, row: usize, column: usize, (re, im): (f64, f64)) {
        assert!(row >= column, "the entry must not be above the diagonal");
        self.coordinates[imaginary_start(self.size, column) + row - column] = im;
        if row > column {
            self.coordinates[real_start(self.size, column) + row - column - 1] = re;
        }
    }

    /// Imaginary parts of a column from the diagonal down, and real parts below it.
    #[inline]
    pub fn column(&self, column: usize) -> (&[f64], &[f64]) {
        let (im, re) = places(self.size, column);
        (&self.coordinates[im], &self.coordinates[re])
    }

    /// Everything before a column's imaginary or real parts, and these with all that follows: for recurrences along
    /// diagonals.
    #[inline]
    pub(crate) fn split_at(&mut self, column: usize, real: bool) -> (&mut [f64], &mut [f64]) {
        let start = if real { real_start } else { imaginary_start };
        self.coordinates.split_at_mut(start(self.size, column))
    }

    /// The trace, which is i times this number.
    pub fn trace(&self) -> f64 {
        let diagonal = (0..self.size).map(|k| self.coordinates[imaginary_start(self.size, k)]);
        diagonal.sum()
    }

    /// Adds i times a number to the diagonal.
    pub fn add_to_diagonal(&mut self, shift: f64) {
        for k in 0..self.size {
            self.coordinates[imaginary_start(self.size, k)] += shift;
        }
    }

    /// `<A, B> = Re tr(A^H B)`, the trace form.
    pub fn inner(&self, other: &Self) -> f64 {
        let mut diagonal = 0.0;
        for k in 0..self.size {
            let place = imaginary_start(self.size, k);
            diagonal += self.coordinates[place] * other.coordinates[place];
        }
        2.0 * dot(&self.coordinates, &other.coordinates) - diagonal
    }

    /// Turns an element of u(N) into what is paired with coordinates: everything off the diagonal counts twice in the trace
    /// form.
    pub(crate) fn weigh(&mut self, factor: f64) {
        for value in &mut self.coordinates {
            *value *= 2.0 * factor;
        }
        for k in 0..self.size {
            self.coordinates[imaginary_start(self.size, k)] *= 0.5;
        }
    }
}

/// A sum of products in eight partial sums.
fn dot(one: &[f64], other: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (chunks, rest) = one.as_chunks::<8>();
    let (others, other_rest) = other.as_chunks::<8>();
    for (one, other) in chunks.iter().zip(others) {
        for ((sum, &x), &y) in sums.iter_mut().zip(one).zip(other) {
            *sum += x * y;
        }
    }
    let rest: f64 = rest.iter().zip(other_rest).map(|(x, y)| x * y).sum();
    rest + sums.iter().sum::<f64>()
}

/// Where the imaginary parts of a column start.
#[inline]
pub(crate) fn imaginary_start(size: usize, column: usize) -> usize {
    (column * (2 * size + 1 - column)) / 2
}

/// Where the real parts of a column start.
#[inline]
pub(crate) fn real_start(size: usize, column: usize) -> usize {
    size * (size + 1) / 2 + (column * (2 * size - 1 - column)) / 2
}

/// The places of a column's imaginary and real parts.
#[inline]
pub(crate) fn places(
    size: usize,
    column: usize,
) -> (core::ops::Range<usize>, core::ops::Range<usize>) {
    let (im, re) = (imaginary_start(size, column), real_start(size, column));
    (im..im + size - column, re..re + size - column - 1)
}

impl Unknown<f64> for SkewHermitian {
    fn parts(&self) -> usize {
        1
    }
    fn part(&self, _index: usize) -> &[f64] {
        &self.coordinates
    }
    fn part_mut(&mut self, _index: usize) -> &mut [f64] {
        &mut self.coordinates
    }
}

impl State<f64> for SkewHermitian {
    fn as_slice(&self) -> &[f64] {
        &self.coordinates
    }
    fn as_mut_slice(&mut self) -> &mut [f64] {
        &mut self.coordinates
    }
    fn take(&mut self) -> Self {
        Self {
            size: self.size,
            coordinates: core::mem::take(&mut self.coordinates),
        }
    }
}
