//! Unit quaternions of rotations in three dimensions.

use crate::scalar::Scalar;

/// The unit quaternion of a rotation, its real part not negative: of the columns of the matrix `4 q q^T` the one with the largest
/// diagonal entry, divided by its length.
pub fn quaternion<S: Scalar>(r: &[[S; 3]; 3]) -> [S; 4] {
    let [x, y, z] = [r[0][0], r[1][1], r[2][2]];
    let one = S::one();
    let [a, b, c] = [r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]];
    let [p, q, s] = [r[0][1] + r[1][0], r[2][0] + r[0][2], r[1][2] + r[2][1]];
    let columns = [
        [one + x + y + z, a, b, c],
        [a, one + x - y - z, p, q],
        [b, p, one - x + y - z, s],
        [c, q, s, one - x - y + z],
    ];
    let mut best = columns[0];
    let mut size = columns[0][0];
    for (index, column) in columns.iter().enumerate().skip(1) {
        let larger = size.less(column[index]);
        size = S::select(larger, column[index], size);
        best = core::array::from_fn(|k| S::select(larger, column[k], best[k]));
    }
    let sign = S::select(best[0].less(S::zero()), -one, one);
    unit(best.map(|entry| sign * entry))
}

/// A quaternion divided by its length.
pub fn unit<S: Scalar>(quaternion: [S; 4]) -> [S; 4] {
    let square = quaternion.iter().fold(S::zero(), |sum, &q| sum + q * q);
    let inverse = S::one() / square.sqrt();
    quaternion.map(|entry| entry * inverse)
}
