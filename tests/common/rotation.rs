//! The matrix of a rotation.

// Each test file uses its own part of this.
#![allow(dead_code)]

/// The matrix of a unit quaternion (w, x, y, z), row by row.
pub fn rotation(quaternion: &[f64]) -> Vec<f64> {
    let [w, x, y, z] = [0, 1, 2, 3].map(|k| quaternion[k]);
    vec![
        1.0 - 2.0 * (y * y + z * z),
        2.0 * (x * y - w * z),
        2.0 * (x * z + w * y),
        2.0 * (x * y + w * z),
        1.0 - 2.0 * (x * x + z * z),
        2.0 * (y * z - w * x),
        2.0 * (x * z - w * y),
        2.0 * (y * z + w * x),
        1.0 - 2.0 * (x * x + y * y),
    ]
}
