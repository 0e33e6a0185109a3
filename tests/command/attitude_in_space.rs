//! Charts of the rotation of groups that have translations too.
#![cfg(unix)]

use crate::attitude::{ANGLES, distance, rotation};
use crate::common::{folder, lie, spec};
use serde_json::json;

/// A group with translations has a rotation in its matrix: its quaternion and its angles, from an attitude on.
#[test]
fn a_top_that_moves_has_quaternions_and_angles() {
    let here = folder();
    let path = spec(here.path(), |spec| {
        *spec = json!({
            "name": "Top", "algebra": "se(3)",
            "state": ["m1", "m2", "m3", "p1", "p2", "p3"],
            "hamiltonian": "m1^2/2 + m2^2/3 + m3^2/4 + p1^2/2 + p2^2/4 + p3^2/5 + m1*p2/6",
            "attitude": { "euler": "zxz", "angles": ANGLES },
            "initial": [0.4, -0.3, 0.8, 0.5, 0.2, -0.6],
            "run": { "method": "gauss6", "step": 0.05, "until": 8, "every": 10 }
        });
    });
    let rows = |chart: &str| {
        lie(&format!("run {} --group {chart}", path.display()))
            .ok()
            .csv()
            .1
    };
    let matrices = rows("matrix");
    let block = |row: &[f64]| {
        let all = &row[row.len() - 16..];
        let rows = [0, 4, 8].map(|from| &all[from..from + 3]);
        rows.concat()
    };
    for (chart, count) in [("quaternion", 4), ("euler:zxz", 3)] {
        for (row, whole) in rows(chart).iter().zip(&matrices) {
            let found = rotation(&row[row.len() - count..]);
            let off = distance(&found, &block(whole));
            assert!(off < 1e-13, "{chart}, t = {}: {off:e}", row[0]);
        }
    }
    let turned = distance(&block(&matrices[0]), &block(&matrices[16]));
    assert!(turned > 0.5, "the control: {turned}");
}
