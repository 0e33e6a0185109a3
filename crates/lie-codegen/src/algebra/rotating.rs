//! Which matrices turn the space of three dimensions.

use lie_symbolic::exact::Rational;
use lie_symbolic::exact::matrix::rank;
use std::ops::Range;

type Matrix = Vec<Vec<Rational>>;

/// Whether the leading block of so many rows and columns is antisymmetric.
fn is_antisymmetric(matrix: &Matrix, size: usize) -> bool {
    let mut pairs = (0..size).flat_map(|i| (0..=i).map(move |j| (i, j)));
    pairs.all(|(i, j)| (&matrix[i][j] + &matrix[j][i]).is_zero())
}

/// Whether matrices of a size are antisymmetric: those of their group are orthogonal.
pub fn are_orthogonal(size: usize, matrices: &[Matrix]) -> bool {
    matrices.iter().all(|matrix| is_antisymmetric(matrix, size))
}

/// Whether the entries in these rows and columns are zero in all matrices.
pub fn are_zero(matrices: &[Matrix], rows: Range<usize>, columns: Range<usize>) -> bool {
    matrices.iter().all(|matrix| {
        let mut rows = matrix[rows.clone()].iter();
        rows.all(|row| row[columns.clone()].iter().all(Rational::is_zero))
    })
}

/// Whether the leading block of three rows and columns of every element of their group is a rotation, and not of all of them the
/// identity: the blocks of the algebra are antisymmetric, and nothing of the other rows and columns comes into them.
pub fn turn_space(size: usize, matrices: &[Matrix]) -> bool {
    size >= 3
        && matrices.iter().all(|matrix| is_antisymmetric(matrix, 3))
        && !are_zero(matrices, 0..3, 0..3)
        // the block of a product is the product of the blocks where one of the corners beside it is empty
        && (are_zero(matrices, 3..size, 0..3) || are_zero(matrices, 0..3, 3..size))
}

/// Whether they turn space, and their group has a rotation alone, with an identity behind it: where nothing moves within the other rows and
/// columns, or something does that can be left at rest, such as a wheel in a body. The algebra has an element for each block of three
/// rows and columns that is zero elsewhere then.
pub fn have_rotations(size: usize, matrices: &[Matrix]) -> bool {
    turn_space(size, matrices)
        && (are_zero(matrices, 3..size, 3..size) || turns_alone(size, matrices))
}

/// Whether as many dimensions of the span are zero outside of the leading block as it has in that block.
fn turns_alone(size: usize, matrices: &[Matrix]) -> bool {
    let rank_where = |counts: &dyn Fn(usize, usize) -> bool| {
        let entries = |matrix: &Matrix| {
            let places = (0..size).flat_map(|i| (0..size).map(move |j| (i, j)));
            let places = places.filter(|(i, j)| counts(*i, *j));
            places.map(|(i, j)| matrix[i][j].clone()).collect()
        };
        let rows: Vec<Vec<Rational>> = matrices.iter().map(entries).collect();
        rank(&rows, rows.len())
    };
    let leading = |i: usize, j: usize| i < 3 && j < 3;
    let alone = rank_where(&|_, _| true) - rank_where(&|i, j| !leading(i, j));
    alone == rank_where(&leading)
}
