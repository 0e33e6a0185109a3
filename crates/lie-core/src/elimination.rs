//! Sparse elimination from a static index list, for systems whose elimination would be too long
//! written out.

use crate::clock::Clock;
use crate::equation::Equation;
use crate::matrix::SquareMatrix;
use crate::methods::Retraction;
use crate::newton::inverse_pivots_are_safe;
use crate::scalar::Scalar;
use crate::state::Unknown;
use core::marker::PhantomData;

/// The elimination of a matrix of known pattern, diagonal pivots in a fixed order. Pattern and
/// fill-in are found at compile time; only entries in the lists are touched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StaticElimination {
    /// The rows (and columns) of the pivots, in order.
    pub order: &'static [u16],
    /// For each pivot in order: the rows eliminated later with an entry in its column, before or
    /// after fill-in.
    pub below: &'static [&'static [u16]],
    /// For each pivot in order: the columns eliminated later with an entry in its row, before or
    /// after fill-in, in order of elimination.
    pub right: &'static [&'static [u16]],
}

impl StaticElimination {
    /// Replaces a matrix by its triangular factors, the inverse pivots on the diagonal. Returns the
    /// lanes in which every pivot was safe.
    pub fn factor<S: Scalar, M: SquareMatrix<S>>(&self, matrix: &mut M) -> S::Mask {
        let mut largest = S::zero();
        for ((&pivot, below), right) in self.order.iter().zip(self.below).zip(self.right) {
            let pivot = usize::from(pivot);
            let inverse = S::one() / matrix.get(pivot, pivot);
            largest = largest.max(inverse.abs());
            matrix.set(pivot, pivot, inverse);
            for &row in *below {
                let row = usize::from(row);
                let multiplier = matrix.get(row, pivot) * inverse;
                matrix.set(row, pivot, multiplier);
                for &column in *right {
                    let column = usize::from(column);
                    let product = multiplier * matrix.get(pivot, column);
                    matrix.set(row, column, matrix.get(row, column) - product);
                }
            }
        }
        inverse_pivots_are_safe(largest)
    }

    /// Solves `A x = b` in place of b by the factors of [`StaticElimination::factor`].
    pub fn solve<S: Scalar, M: SquareMatrix<S>, U: Unknown<S>>(&self, factors: &M, vector: &mut U) {
        for (&pivot, below) in self.order.iter().zip(self.below) {
            let pivot = usize::from(pivot);
            let value = vector.entry(pivot);
            for &row in *below {
                let row = usize::from(row);
                let product = factors.get(row, pivot) * value;
                vector.set_entry(row, vector.entry(row) - product);
            }
        }
        for (&pivot, right) in self.order.iter().zip(self.right).rev() {
            let pivot = usize::from(pivot);
            let mut sum = vector.entry(pivot);
            for &column in *right {
                let column = usize::from(column);
                sum -= factors.get(pivot, column) * vector.entry(column);
            }
            vector.set_entry(pivot, sum * factors.get(pivot, pivot));
        }
    }

    /// The number of multiplications of a factorisation and a solution.
    pub fn multiplications(&self) -> usize {
        let pairs = self.below.iter().zip(self.right);
        let factors: usize = pairs
            .map(|(below, right)| below.len() * (1 + right.len()))
            .sum();
        let entries: usize = self
            .below
            .iter()
            .chain(self.right)
            .map(|list| list.len())
            .sum();
        factors + entries + self.order.len()
    }
}

/// The elimination of a matrix of known pattern, as generated code writes it out.
pub trait FixedElimination<S: Scalar, M, U> {
    /// Replaces a matrix by its triangular factors. Returns the lanes in which every pivot was safe.
    fn factor(matrix: &mut M) -> S::Mask;
    /// Solves `A x = b` in place of b by the factors.
    fn solve(factors: &M, vector: &mut U);
}

/// An equation with an elimination specialised to the pattern of its matrix.
#[derive(Clone, Debug)]
pub struct Eliminated<E, T> {
    equation: E,
    elimination: PhantomData<T>,
}

impl<E, T> Eliminated<E, T> {
    /// The same equation with the elimination T.
    pub fn new(equation: E) -> Self {
        Self {
            equation,
            elimination: PhantomData,
        }
    }
}

impl<S, E, T> Equation<S> for Eliminated<E, T>
where
    S: Scalar,
    E: Equation<S>,
    T: FixedElimination<S, E::Matrix, E::Unknown>,
{
    type State = E::State;
    type Unknown = E::Unknown;
    type Matrix = E::Matrix;

    fn zero_unknown(&self) -> Self::Unknown {
        self.equation.zero_unknown()
    }

    fn zero_matrix(&self) -> Self::Matrix {
        self.equation.zero_matrix()
    }

    #[inline]
    fn set_base(&mut self, mu: &Self::State) {
        self.equation.set_base(mu);
    }

    #[inline]
    fn scale(&self, mu: &Self::State) -> S {
        self.equation.scale(mu)
    }

    #[inline]
    fn clock(&self) -> Option<Clock> {
        self.equation.clock()
    }

    #[inline]
    fn norm(&self, unknown: &Self::Unknown) -> S {
        self.equation.norm(unknown)
    }

    #[inline]
    fn initial_guess(&mut self, unknown: &mut Self::Unknown) {
        self.equation.initial_guess(unknown);
    }

    #[inline]
    fn leave_out(&self, unknown: &mut Self::Unknown) {
        self.equation.leave_out(unknown);
    }

    #[inline]
    fn residual(&mut self, unknown: &Self::Unknown, residual: &mut Self::Unknown) {
        self.equation.residual(unknown, residual);
    }

    #[inline]
    fn approach(
        &mut self,
        unknown: &Self::Unknown,
        residual: &mut Self::Unknown,
        active: S::Mask,
    ) -> S {
        self.equation.approach(unknown, residual, active)
    }

    #[inline]
    fn linearize(
        &mut self,
        unknown: &Self::Unknown,
        residual: &mut Self::Unknown,
        matrix: &mut Self::Matrix,
    ) {
        self.equation.linearize(unknown, residual, matrix);
    }

    #[inline]
    fn factor(&self, matrix: &mut Self::Matrix) -> S::Mask {
        T::factor(matrix)
    }

    #[inline]
    fn solve(&self, factors: &Self::Matrix, residual: &mut Self::Unknown) {
        T::solve(factors, residual);
    }

    fn jacobian_cost(&self) -> f64 {
        self.equation.jacobian_cost()
    }

    #[inline]
    fn result(&mut self, unknown: &Self::Unknown, mu: &mut Self::State) {
        self.equation.result(unknown, mu);
    }

    fn resolved(&mut self, unknown: &Self::Unknown, end: &Self::State) -> S::Mask {
        self.equation.resolved(unknown, end)
    }

    fn within_chart(&mut self, unknown: &Self::Unknown) -> S::Mask {
        self.equation.within_chart(unknown)
    }

    fn earlier_factor(
        &mut self,
        unknown: &Self::Unknown,
        eta: &mut Self::State,
    ) -> Option<Retraction> {
        self.equation.earlier_factor(unknown, eta)
    }

    fn group_factor(
        &mut self,
        unknown: &Self::Unknown,
        xi: &mut Self::State,
    ) -> Option<Retraction> {
        self.equation.group_factor(unknown, xi)
    }

    fn velocity(&mut self, unknown: &Self::Unknown, stage: usize, xi: &mut Self::State) -> usize {
        self.equation.velocity(unknown, stage, xi)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{SMatrix, SVector};

    // pattern (x: entry, f: fill-in), pivots in the order 2, 0, 3, 1:
    //   x . x .
    //   . x x x
    //   x x x .
    //   . . x x
    const LIST: StaticElimination = StaticElimination {
        order: &[2, 0, 3, 1],
        below: &[&[0, 1, 3], &[1, 3], &[1], &[]],
        right: &[&[0, 1], &[1], &[1], &[]],
    };

    #[test]
    fn agrees_with_a_dense_solution() {
        let matrix = SMatrix::<f64, 4, 4>::new(
            2.0, 0.0, 0.5, 0.0, //
            0.0, 1.5, -0.25, 0.75, //
            0.25, -0.5, 3.0, 0.0, //
            0.0, 0.0, 1.0, 1.25,
        );
        let expected = SVector::from([1.0, -2.0, 0.5, 4.0]);
        let mut vector = matrix * expected;
        let mut factors = matrix;
        assert!(LIST.factor(&mut factors));
        LIST.solve(&factors, &mut vector);
        assert!((vector - expected).amax() < 1e-14, "{vector}");
        assert_eq!(LIST.multiplications(), 3 * 3 + 2 * 2 + 2 + (6 + 4) + 4);
    }

    #[test]
    fn a_small_pivot_is_refused() {
        let mut matrix = SMatrix::<f64, 4, 4>::identity();
        matrix[(2, 2)] = 1e-5;
        assert!(!LIST.factor::<f64, _>(&mut matrix));
    }
}
