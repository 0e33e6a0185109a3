//! Products of matrices of at most 8 x 8 with numbers side by side, by diagonals.

use core::array::from_fn;

use crate::scalar::Scalar;

/// A matrix for products: entry `a_(i, i xor d)` in place i of diagonal d where d is even; where it is odd, that entry in place
/// `i xor 1`. 0 where there is no such row or column.
///
/// The entry is asked for once, and not in 64 copies of it: this is made with a stepper.
#[inline(never)]
pub(super) fn diagonals<S: Scalar>(
    rows: usize,
    columns: usize,
    entry: &dyn Fn(usize, usize) -> S,
) -> [S::Wide; 8] {
    from_fn(|d| {
        S::gather(from_fn(|place| {
            let i = place ^ (d & 1);
            let inside = i < rows && (i ^ d) < columns;
            if inside { entry(i, i ^ d) } else { S::zero() }
        }))
    })
}

/// The product of a matrix, given by its diagonals, with the numbers of one entry at all stages, which are in the first 4 or 8 places.
///
/// The sum over the odd diagonals is taken with neighbours exchanged and put right by one exchange, so that a product
/// moves numbers within a register four times.
#[inline(always)]
pub(super) fn product<S: Scalar, const PLACES: usize>(
    diagonals: &[S::Wide],
    entry: S::Wide,
) -> S::Wide {
    let [even, odd] = [0, 1].map(|d| diagonals[d] * entry);
    finish::<S, PLACES>(diagonals, entry, even, odd)
}

/// A number and a product: a term that needs no move takes the number up while the others are moved.
#[inline(always)]
pub(super) fn product_from<S: Scalar, const PLACES: usize>(
    start: S::Wide,
    diagonals: &[S::Wide],
    entry: S::Wide,
) -> S::Wide {
    let even = start + diagonals[0] * entry;
    finish::<S, PLACES>(diagonals, entry, even, diagonals[1] * entry)
}

/// The terms of the first two diagonals and those of the rest.
#[inline(always)]
fn finish<S: Scalar, const PLACES: usize>(
    diagonals: &[S::Wide],
    entry: S::Wide,
    even: S::Wide,
    odd: S::Wide,
) -> S::Wide {
    let two = S::exchange::<2>(entry);
    let (mut even, mut odd) = (even + diagonals[2] * two, odd + diagonals[3] * two);
    if PLACES > 4 {
        let (four, six) = (S::exchange::<4>(entry), S::exchange::<6>(entry));
        even += diagonals[4] * four + diagonals[6] * six;
        odd += diagonals[5] * four + diagonals[7] * six;
    }
    even + S::exchange::<1>(odd)
}

/// The sum of eight numbers, in every place; neighbours first.
#[inline(always)]
pub(super) fn total<S: Scalar>(wide: S::Wide) -> S::Wide {
    if S::LANES == 1 {
        let pairs = wide + S::exchange::<1>(wide);
        let fours = pairs + S::exchange::<2>(pairs);
        return fours + S::exchange::<4>(fours);
    }
    let [a, b, c, d, e, f, g, h] = S::scatter(wide);
    (((a + b) + (c + d)) + ((e + f) + (g + h))).widen()
}
