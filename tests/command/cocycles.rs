//! Cocycles: central extensions and shifts, by the command.

use crate::common::{folder, lie};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

fn written(folder: &Path, name: &str, spec: Value) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, spec.to_string()).expect("written");
    path
}

fn gyrostat(more: Value) -> Value {
    let mut spec = json!({
        "format": 1,
        "name": "Gyrostat",
        "algebra": "so(3)",
        "state": ["x", "y", "z"],
        "parameters": { "l": { "default": "3/2", "exact": true } },
        "initial": ["1/2", 1, "-3/10"]
    });
    let all = spec.as_object_mut().expect("an object");
    all.extend(more.as_object().expect("an object").clone());
    spec
}

/// The last row of a run, in columns of the state.
fn end(path: &Path, arguments: &str) -> Vec<f64> {
    let path = path.display();
    let run = lie(&format!(
        "run {path} --step 0.05 --until 10 --quiet {arguments}"
    ))
    .ok();
    let row = run.stdout.lines().last().expect("a row");
    let numbers = row
        .split(',')
        .map(|number| number.parse().expect("a number"));
    numbers.skip(1).take(3).collect()
}

/// A rotor within a body is a shift of its momentum: the steps are those of the shifted body.
#[test]
fn a_coboundary_is_a_shift() {
    let folder = folder();
    let beside = |value: &str| {
        gyrostat(json!({
            "cocycle": [format!("{{x, y}} = {value}"), "{y, z} = -1/2"],
            "hamiltonian": "x^2/2 + y^2/4 + z^4/6"
        }))
    };
    let numbers = written(folder.path(), "numbers.json", beside("3/2"));
    let parameters = written(folder.path(), "parameters.json", beside("l"));
    // nu = mu - s with s = (-1/2, 0, l)
    let shifted = gyrostat(json!({
        "hamiltonian": "(x - 1/2)^2/2 + y^2/4 + (z + l)^4/6",
        "initial": [1, 1, "-9/5"]
    }));
    let shifted = written(folder.path(), "shifted.json", shifted);
    for (path, shown) in [(&numbers, "z - 3/2"), (&parameters, "z - l")] {
        let check = lie(&format!("check {}", path.display())).ok().stdout;
        let expected = format!("a coboundary: x + 1/2, {shown} have the bracket without it");
        assert!(check.contains(&expected), "{check}");
    }
    for arguments in [
        "--method lie-midpoint",
        "--method lie-midpoint --retraction cayley",
        "--method rkmk4",
        "--method cf4",
        "--method generating4",
        "--method generating4 --retraction cayley",
        "--method compose6(lie-midpoint)",
        "--method gauss16",
        "--method gonzalez",
        "--method orbit-energy",
    ] {
        let expected = end(&shifted, arguments);
        for path in [&numbers, &parameters] {
            let found = end(path, arguments);
            for ((found, expected), shift) in found.iter().zip(&expected).zip([-0.5, 0.0, 1.5]) {
                let off = (found - shift - expected).abs();
                assert!(off < 2e-13, "{arguments}: {off:e}");
            }
        }
    }
}

/// Every method on a cocycle that is none: what is claimed of it is measured, and Gauss methods, which are no Poisson maps, are the control.
#[test]
fn methods_of_the_algebra_hold_beside_a_cocycle() {
    let folder = folder();
    let plane = json!({
        "format": 1,
        "name": "Plane",
        "algebra": "se(2)",
        "cocycle": ["{p1, p2} = 7/10"],
        "state": ["L", "p1", "p2"],
        "hamiltonian": "L^2/2 + p1^2/3 + p2^4/5 + L*p1/4",
        "initial": ["2/5", "7/10", "-1/2"]
    });
    let mut on_group = plane.clone();
    on_group["group"] = json!("g");
    on_group["hamiltonian"] = json!("L^2/2 + p1^2/2 + p2^2/3 + g13^2/2 + g23^2/3 + g11/4");
    let methods = "lie-midpoint,rkmk4,cf4,generating4,generating6,splitting4,lie-taylor,gauss4,gonzalez,orbit-energy";
    for (name, spec) in [("plane.json", plane), ("group.json", on_group)] {
        let path = written(folder.path(), name, spec);
        let check = lie(&format!("check {} --json", path.display())).ok();
        let check: Value = serde_json::from_str(&check.stdout).expect("JSON");
        let sentence = check["cocycle"].as_str().expect("a sentence");
        assert!(sentence.starts_with("no coboundary"), "{sentence}");
        let verify = lie(&format!(
            "verify {} --methods {methods} --quiet --json",
            path.display()
        ))
        .ok();
        let report: Value = serde_json::from_str(&verify.stdout).expect("JSON");
        assert_eq!(report["failed"], 0, "{report:#}");
        let defect = |method: &str| report["methods"][method]["Poisson"]["measured"].as_f64();
        for method in ["lie-midpoint", "generating4", "generating6", "splitting4"] {
            let defect = defect(method).expect("a number");
            assert!(defect < 1e-13, "{name}, {method}: {defect:e}");
        }
        assert!(defect("gauss4") > Some(1e-10), "{name}: {report:#}");
    }
}

/// The coordinates that are there for the cocycle alone are in no picture.
#[test]
fn an_orbit_is_drawn_in_the_declared_coordinates() {
    let folder = folder();
    let spec = gyrostat(json!({
        "cocycle": ["{x, y} = l"],
        "hamiltonian": "x^2/2 + y^2/4 + z^2/6"
    }));
    let path = written(folder.path(), "gyrostat.json", spec);
    let picture = folder.path().join("orbit.svg");
    lie(&format!(
        "run {} --method lie-midpoint --step 0.05 --until 10 --quiet --plot {} --picture orbit",
        path.display(),
        picture.display()
    ))
    .ok();
    let drawn = std::fs::read_to_string(&picture).expect("a picture");
    assert!(drawn.contains("surface: "), "{drawn}");
    assert!(!drawn.contains("_one"), "{drawn}");
}
