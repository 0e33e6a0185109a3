//! Runs with a checkpoint, within a folder.

// Each test file uses its own part of this.
#![allow(dead_code)]

use std::fs;
use std::path::Path;

use super::common::{Run, command};

/// A body to which every kind of method applies, one with a table among its files, one whose velocity has several branches, and an
/// oscillator that becomes faster and faster.
pub fn prepared(folder: &Path) {
    let spec = r#"{
        "format": 1, "name": "Body", "algebra": "so(3)", "state": ["x", "y", "z"],
        "parameters": { "a": 2, "b": 1 },
        "hamiltonian": "x^2/(2*a) + y^2/(2*b) + 3*z^2/4", "casimirs": ["C = x^2 + y^2 + z^2"],
        "initial": [0.3, 0.4, 0.5]
    }"#;
    fs::write(folder.join("body.json"), spec).unwrap();
    let driven = spec.replace("3*z^2/4", "drag(z)*cos(t)").replace(
        "\"parameters\"",
        r#""functions": { "drag": { "table": "drag.csv" } }, "parameters""#,
    );
    fs::write(folder.join("driven.json"), driven).unwrap();
    let folded = r#"{
        "format": 1, "name": "Fold", "algebra": "so(3)", "state": ["x", "y", "z"], "velocity": ["u", "v", "w"],
        "lagrangian": "u^2/2 - u^4/4 + 3*u^6/60 + v^2 + w^2*3/2", "initial": [1, 0.9, 0.8]
    }"#;
    fs::write(folder.join("folded.json"), folded).unwrap();
    let chirp = r#"{
        "format": 1, "name": "Chirp", "poisson": ["{q, p} = 1", "{r, s} = -1"], "state": ["q", "p", "s", "r"],
        "hamiltonian": "r/100 + (1 + s)*(p^2 + q^2)/2 + (1 + s)*q^4/10", "initial": [1, 0, 0, 0]
    }"#;
    fs::write(folder.join("chirp.json"), chirp).unwrap();
    fs::write(folder.join("drag.csv"), "-9,0.1\n-2,0.2\n0,0\n2,0.5\n9,1\n").unwrap();
}

/// A call of `lie` within a folder.
pub fn within(folder: &Path, call: &str) -> Run {
    let mut command = command(arguments(call));
    command.current_dir(folder).output().unwrap().into()
}

/// Words.
pub fn arguments(call: &str) -> Vec<String> {
    call.split_whitespace().map(str::to_owned).collect()
}

/// Changes the content of a checkpoint and signs it again.
pub fn forged(path: &Path, change: impl FnOnce(&mut serde_json::Value)) {
    let text = fs::read_to_string(path).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let mut content = serde_json::from_str(lines[1]).unwrap();
    change(&mut content);
    let signed = format!("{}\n{content}\n", lines[0]);
    fs::write(path, format!("{signed}{}\n", digest(signed.as_bytes()))).unwrap();
}

/// FNV-1a with 128 bits, written again.
fn digest(bytes: &[u8]) -> String {
    let hash = bytes.iter().fold(
        144_066_263_297_769_815_596_495_629_667_062_367_629,
        |hash: u128, byte| (hash ^ u128::from(*byte)).wrapping_mul((1 << 88) + 0x13b),
    );
    format!("{hash:032x}")
}
