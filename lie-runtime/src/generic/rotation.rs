//! Rotation vectors of quaternions.

use crate::scalar::Scalar;

/// The rotation vector of the quaternion `(real, v)` of any length: its axis times its angle in `[0, 2 pi]`.
pub(crate) fn rotation_vector<S: Scalar>(real: S, v: [S; 3]) -> [S; 3] {
    let square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    let length = square.sqrt();
    let two = S::from_f64(2.0);
    // near the identity atan2(length, real)/length is 1/real
    let small = length.less_equal(real * S::epsilon());
    let divisor = S::select(small, S::one(), length);
    let ratio = S::select(small, two / real, two * length.atan2(real) / divisor);
    v.map(|entry| ratio * entry)
}
