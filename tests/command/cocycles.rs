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

/// The columns of these names in the last row of a run.
fn end_of(path: &Path, names: &[&str], arguments: &str) -> Vec<f64> {
    let path = path.display();
    let run = lie(&format!(
        "run {path} --step 0.01 --until 2 --quiet {arguments}"
    ))
    .ok();
    let mut lines = run.stdout.lines().filter(|line| !line.starts_with('#'));
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let row: Vec<&str> = lines.next_back().expect("a row").split(',').collect();
    let place = |name: &&str| header.iter().position(|column| column == name);
    let number = |name: &&str| {
        row[place(name).expect("a column")]
            .parse()
            .expect("a number")
    };
    names.iter().map(number).collect()
}

/// `lie canonical` takes a coboundary away: the motion stays, and methods over other spaces apply.
#[test]
fn lie_canonical_shifts_a_coboundary_away() {
    let folder = folder();
    let beside = json!({ "cocycle": ["{x, y} = l", "{y, z} = -1/2"] });
    let of = |more: Value| {
        let mut spec = gyrostat(beside.clone());
        let all = spec.as_object_mut().expect("an object");
        all.extend(more.as_object().expect("an object").clone());
        spec
    };
    let by_hamiltonian = json!({
        "hamiltonian": "x^2/2 + y^2/4 + z^4/6",
        "observables": { "w": "x*z", "a": "y" }
    });
    let by_lagrangian = json!({
        "velocity": ["u", "v", "w"],
        "lagrangian": "u^2/2 + v^2 + w^2/3 + u*v/5"
    });
    let with_forces = json!({
        "hamiltonian": "x^2/2 + y^2/4 + z^2/6",
        "forces": { "x": "-x/10", "z": "1/4" }
    });
    let all = [by_hamiltonian, by_lagrangian, with_forces];
    for (k, (spec, methods)) in all
        .into_iter()
        .zip([
            &[
                "collective4",
                "isospectral4",
                "spherical-midpoint",
                "lie-midpoint",
            ][..],
            &["collective4", "variational2"],
            &["lie-midpoint"],
        ])
        .enumerate()
    {
        let old = written(folder.path(), &format!("old{k}.json"), of(spec));
        let new = folder.path().join(format!("new{k}.json"));
        let run = lie(&format!(
            "canonical {} --out {}",
            old.display(),
            new.display()
        ))
        .ok();
        let says = "the bracket has no cocycle with x = x_s + (-1/2), z = z_s + (l)";
        assert!(run.stdout.contains(says), "{}", run.stdout);
        assert!(run.stdout.contains("next: lie check "), "{}", run.stdout);
        let check = lie(&format!("check {}", new.display())).ok().stdout;
        assert!(!check.contains("cocycle"), "{check}");
        for parameters in ["", "--param l=7/5"] {
            let exact = format!("--method gauss16 {parameters}");
            let names = ["x", "y", "z"];
            let (here, there) = (end_of(&old, &names, &exact), end_of(&new, &names, &exact));
            let distance = |a: &[f64], b: &[f64]| {
                let pairs = a.iter().zip(b);
                pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()))
            };
            assert!(distance(&here, &there) < 1e-13, "{k}: {here:?} {there:?}");
            for method in methods {
                let call = format!("--method {method} {parameters}");
                let by_it = end_of(&new, &names, &call);
                assert!(
                    distance(&by_it, &here) < 1e-3,
                    "{k} {method}: {by_it:?} {here:?}"
                );
                if method.starts_with("isospectral") || method.starts_with("collective") {
                    let refused = lie(&format!(
                        "run {} {call} --step 0.01 --until 1",
                        old.display()
                    ));
                    assert_eq!(refused.code, Some(2), "{method} beside the cocycle");
                }
            }
        }
    }
    // the control: where no shift takes it away there is none
    let plane = json!({
        "format": 1, "name": "Plane", "algebra": "se(2)", "state": ["m", "p", "q"],
        "cocycle": ["{p, q} = 1"], "hamiltonian": "m^2 + p^2/2 + q^2", "initial": [1, 2, 3]
    });
    let plane = written(folder.path(), "plane.json", plane);
    assert_eq!(lie(&format!("canonical {}", plane.display())).code, Some(2));
}
