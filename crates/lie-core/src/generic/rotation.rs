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

#[cfg(test)]
mod tests {
    use super::*;

    const AXIS: [f64; 3] = [2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0];

    #[test]
    fn the_angle_of_any_rotation() {
        // from angles that only the limit 2/real can tell to those beyond half a turn
        for angle in [0.0, 1e-300, 1e-20, 1e-15, 1e-7, 0.1, 0.29, 0.7, 3.0, 6.0] {
            for length in [1.0, 1e-3, 40.0] {
                let half: f64 = 0.5 * angle;
                let (sine, cosine) = (length * half.sin(), length * half.cos());
                let vector = rotation_vector(cosine, AXIS.map(|entry| sine * entry));
                for (entry, along) in vector.iter().zip(AXIS) {
                    let expected = angle * along;
                    let error = (entry - expected).abs();
                    assert!(error <= 4e-16 * angle, "{angle:e}, {length}: {error:e}");
                }
            }
        }
    }
}
