//! Square matrices by entry: Jacobians of states and of stages.

use crate::scalar::Scalar;
#[cfg(any(feature = "nalgebra", test))]
use nalgebra::SMatrix;

/// A square matrix read and written by entry.
///
/// Implemented for `nalgebra::SMatrix` and for [`StageMatrix`]; a system of many coordinates
/// may bring its own sparse one.
pub trait SquareMatrix<S: Scalar>: Clone {
    /// The number of rows and of columns.
    fn dimension(&self) -> usize;
    /// The entry in a row and a column.
    fn get(&self, row: usize, column: usize) -> S;
    /// Sets the entry in a row and a column.
    fn set(&mut self, row: usize, column: usize, value: S);
}

impl<S: Scalar, const N: usize> SquareMatrix<S> for [[S; N]; N] {
    #[inline(always)]
    fn dimension(&self) -> usize {
        N
    }
    #[inline(always)]
    fn get(&self, row: usize, column: usize) -> S {
        self[row][column]
    }
    #[inline(always)]
    fn set(&mut self, row: usize, column: usize, value: S) {
        self[row][column] = value;
    }
}

#[cfg(any(feature = "nalgebra", test))]
impl<S: Scalar, const N: usize> SquareMatrix<S> for SMatrix<S, N, N> {
    #[inline(always)]
    fn dimension(&self) -> usize {
        N
    }
    #[inline(always)]
    fn get(&self, row: usize, column: usize) -> S {
        self.data.0[column][row]
    }
    #[inline(always)]
    fn set(&mut self, row: usize, column: usize, value: S) {
        self.data.0[column][row] = value;
    }
}

/// The Jacobian of a method with several stages: block (i, j) is the derivative of the residual of
/// stage i with respect to the unknown of stage j.
#[derive(Clone, Debug, PartialEq)]
pub struct StageMatrix<M, const STAGES: usize>(pub [[M; STAGES]; STAGES]);

impl<S: Scalar, M: SquareMatrix<S>, const STAGES: usize> SquareMatrix<S>
    for StageMatrix<M, STAGES>
{
    #[inline(always)]
    fn dimension(&self) -> usize {
        STAGES * self.0[0][0].dimension()
    }
    #[inline(always)]
    fn get(&self, row: usize, column: usize) -> S {
        let size = self.0[0][0].dimension();
        self.0[row / size][column / size].get(row % size, column % size)
    }
    #[inline(always)]
    fn set(&mut self, row: usize, column: usize, value: S) {
        let size = self.0[0][0].dimension();
        self.0[row / size][column / size].set(row % size, column % size, value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_rows_of_stages() {
        let zero = SMatrix::<f64, 2, 2>::repeat(0.0);
        let mut matrix = StageMatrix([[zero; 3]; 3]);
        assert_eq!(SquareMatrix::<f64>::dimension(&matrix), 6);
        matrix.set(3, 4, 5.0);
        assert_eq!(matrix.0[1][2][(1, 0)], 5.0);
        assert_eq!(SquareMatrix::<f64>::get(&matrix, 3, 4), 5.0);
    }
}
