//! Products of which a triangle is computed.

use ndarray::linalg::general_mat_mul;
use ndarray::{ArrayView2, ArrayViewMut2, Axis, LinalgScalar};

/// What is left of a triangle is computed as a square, from so many rows on.
const SQUARE: usize = 32;

/// `out = left right` on and below the diagonal, by halves: what lies beside both triangles is a product of its own. Some entries
/// above the diagonal are written too.
pub(crate) fn lower_product<A: LinalgScalar>(
    left: ArrayView2<'_, A>,
    right: ArrayView2<'_, A>,
    mut out: ArrayViewMut2<'_, A>,
) {
    let size = out.nrows();
    if size <= SQUARE {
        general_mat_mul(A::one(), &left, &right, A::zero(), &mut out);
        return;
    }
    // a kernel has eight rows
    let half = (size / 2).next_multiple_of(8);
    let (upper, lower) = left.split_at(Axis(0), half);
    let (first, second) = right.split_at(Axis(1), half);
    let (top, bottom) = out.split_at(Axis(0), half);
    let (mut beside, last) = bottom.split_at(Axis(1), half);
    general_mat_mul(A::one(), &lower, &first, A::zero(), &mut beside);
    lower_product(upper, first, top.split_at(Axis(1), half).0);
    lower_product(lower, second, last);
}
