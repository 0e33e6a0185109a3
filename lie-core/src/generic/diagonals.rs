//! Products of matrices of at most 8 x 8 with numbers side by side, by diagonals `i xor d`.

use core::array::from_fn;

use crate::scalar::Scalar;

/// The diagonals of a matrix: entry `a_(i, i xor d)` in place i of diagonal d; 0 where there is no such row or column.
pub(super) fn diagonals<S: Scalar>(
    rows: usize,
    columns: usize,
    entry: impl Fn(usize, usize) -> S,
) -> [S::Wide; 8] {
    from_fn(|d| {
        S::gather(from_fn(|i| {
            let inside = i < rows && (i ^ d) < columns;
            if inside { entry(i, i ^ d) } else { S::zero() }
        }))
    })
}

/// The product of a matrix, given by its diagonals, with the numbers of one entry at all stages: each diagonal times the
/// numbers with places i and i xor d exchanged, which a register does in one or two moves.
#[inline(always)]
pub(super) fn product<S: Scalar, const STAGES: usize>(
    diagonals: &[S::Wide; 8],
    entry: S::Wide,
) -> S::Wide {
    let near = [
        diagonals[0] * entry,
        diagonals[1] * S::exchange::<1>(entry),
        diagonals[2] * S::exchange::<2>(entry),
        diagonals[3] * S::exchange::<3>(entry),
    ];
    if STAGES <= 4 {
        return tree(&near);
    }
    let far = [
        diagonals[4] * S::exchange::<4>(entry),
        diagonals[5] * S::exchange::<5>(entry),
        diagonals[6] * S::exchange::<6>(entry),
        diagonals[7] * S::exchange::<7>(entry),
    ];
    tree(&near) + tree(&far)
}

/// The sum of terms, neighbours first.
#[inline(always)]
pub(super) fn tree<S: Scalar>([a, b, c, d]: &[S; 4]) -> S {
    (*a + *b) + (*c + *d)
}
