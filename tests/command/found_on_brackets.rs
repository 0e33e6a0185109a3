//! Splittings on brackets that are declared by their entries: what `lie check` finds, and whether the steps are what they claim.

use crate::common::{folder, lie};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

fn written(folder: &Path, spec: &Value) -> PathBuf {
    let name = spec["name"].as_str().expect("a name");
    let path = folder.join(format!("{name}.json"));
    std::fs::write(&path, spec.to_string()).expect("written");
    path
}

/// Predators and prey, three species.
fn species() -> Value {
    json!({
        "format": 1, "name": "Lv3", "state": ["x", "y", "z"],
        "poisson": ["{x, y} = -x*y/2", "{x, z} = x*z/2", "{y, z} = -y*z"],
        "hamiltonian": "2*x + y + 2*z + log(y) - 2*log(z)",
        "initial": [1, "19/10", "1/2"]
    })
}

/// Five species with a term in two of them.
fn chain() -> Value {
    json!({
        "format": 1, "name": "Volterra5", "state": ["x1", "x2", "x3", "x4", "x5"],
        "poisson": ["{x1, x2} = x1*x2", "{x2, x3} = x2*x3", "{x3, x4} = x3*x4", "{x4, x5} = x4*x5"],
        "hamiltonian": "x1 + x2 + x3 + x4 + x5 + x1*x4/5 - log(x2) + x3^2/4",
        "initial": [1, "7/10", "6/5", "4/5", "11/10"]
    })
}

/// A charged particle in the plane.
fn charged(field: &str) -> Value {
    json!({
        "format": 1, "name": "Mag4", "state": ["x", "y", "u", "v"],
        "poisson": ["{x, u} = 1", "{y, v} = 1", format!("{{u, v}} = {field}")],
        "hamiltonian": "(u^2 + v^2)/2 + x^2/2 + y^4/4 + x*y/5",
        "initial": ["3/5", "-2/5", "1/2", "7/10"]
    })
}

/// Each coordinate has a speed of its own.
fn changed() -> Value {
    json!({
        "format": 1, "name": "Elementwise", "state": ["x", "y", "z"],
        "poisson": ["{x, y} = (1 + x)*y", "{y, z} = 2*y*(z - 2)", "{x, z} = -(1 + x)*(z - 2)/3"],
        "casimirs": ["C = 6*log(1 + x) + log(y) + 3*log(2 - z)"],
        "hamiltonian": "x^2/3 + y + y^2/4 + z^2/2 + z",
        "initial": ["3/10", "4/5", "1/2"]
    })
}

#[test]
fn steps_are_poisson_maps_of_their_order() {
    let folder = folder();
    let field = "1 + sin(x)/2 + exp(-y^2)/3";
    for (spec, class, pieces) in [
        (species(), "log-canonical", 4),
        (chain(), "log-canonical", 3),
        (charged(field), "magnetic", 3),
        (charged("1 + x*y^2"), "magnetic", 3),
        (changed(), "elementwise", 3),
    ] {
        let path = written(folder.path(), &spec);
        let path = path.display();
        let check = lie(&format!("check {path} --json")).ok();
        let check: Value = serde_json::from_str(&check.stdout).expect("JSON");
        assert_eq!(check["bracket_class"], class, "{path}");
        let found = check["splitting"].as_array().expect("pieces");
        assert!(found.len() <= pieces, "{path}: {found:?}");
        let methods = "splitting1,splitting2,splitting4,splitting6,gauss4";
        let verify = lie(&format!("verify {path} --methods {methods} --quiet --json")).ok();
        let report: Value = serde_json::from_str(&verify.stdout).expect("JSON");
        assert_eq!(report["failed"], 0, "{path}: {report:#}");
        let defect = |method: &str| report["methods"][method]["Poisson"]["measured"].as_f64();
        for method in ["splitting1", "splitting2", "splitting4", "splitting6"] {
            let defect = defect(method).expect("a number");
            assert!(defect < 1e-13, "{path}, {method}: {defect:e}");
        }
        // the control
        assert!(defect("gauss4") > Some(1e-10), "{path}: {report:#}");
    }
}

/// A function times a Jacobian bracket: its Casimir is found whatever the function is, and the leaves with it. Where it is not, what a method
/// claims of leaves is not measured.
#[test]
fn leaves_are_measured_where_their_casimir_is_found() {
    let folder = folder();
    let verified = |name: &str, factor: &str, [x, y, z]: [&str; 3]| {
        let spec = json!({
            "format": 1, "name": name, "state": ["x", "y", "z"],
            "poisson": [format!("{{x, y}} = ({factor})*{z}"), format!("{{y, z}} = ({factor})*{x}"), format!("{{z, x}} = ({factor})*{y}")],
            "hamiltonian": "x^2/2 + y^2/3 + z^2/5 + x*y/7",
            "initial": ["3/5", "2/5", "7/10"]
        });
        let path = written(folder.path(), &spec);
        let path = path.display();
        let check = lie(&format!("check {path} --json")).ok();
        let check: Value = serde_json::from_str(&check.stdout).expect("JSON");
        let verify = lie(&format!(
            "verify {path} --methods orbit-energy,rk4 --quiet --json"
        ));
        let report: Value = serde_json::from_str(&verify.ok().stdout).expect("JSON");
        assert_eq!(report["failed"], 0, "{report:#}");
        let facts = |method: &str| report["methods"][method].clone();
        (
            check["bracket_class"].clone(),
            facts("orbit-energy"),
            facts("rk4"),
        )
    };
    let drift = |facts: &Value| {
        facts["other Casimirs"]["measured"]
            .as_f64()
            .expect("a number")
    };
    for (name, factor) in [("Rational", "1 + x*z"), ("Transcendental", "exp(x*z)")] {
        let (class, facts, control) = verified(name, factor, ["x", "3*y^2", "z"]);
        assert_eq!(class, "multiple of Jacobian");
        assert_eq!(facts["orbit"]["verdict"], "holds", "{facts:#}");
        assert!(
            drift(&facts) < 1e-13 && drift(&control) > 1e-10,
            "{facts:#}"
        );
    }
    // exp(x*y) + z^2, whose slope is no function of `a x + b` with a number a
    let slopes = ["y*exp(x*y)", "x*exp(x*y)", "2*z"];
    let (class, facts, _) = verified("Unknown", "1", slopes);
    assert_eq!(class, Value::Null);
    let note = facts["orbit"]["note"].as_str().expect("a note");
    assert!(note.contains("not measured: 0 of the 1 Casimirs"), "{note}");
}

/// Populations stay positive at a step at which Runge and Kutta leave the domain of H.
#[test]
fn flows_of_monomials_keep_signs() {
    let folder = folder();
    let prey = json!({
        "format": 1, "name": "Prey", "state": ["x", "y"], "poisson": ["{x, y} = x*y"],
        "hamiltonian": "x - log(x) + y - log(y)", "initial": ["3/10", 4]
    });
    let path = written(folder.path(), &prey);
    let run = |method: &str| {
        lie(&format!(
            "run {} --method {method} --step 1.5 --until 60 --quiet",
            path.display()
        ))
    };
    let (_, rows) = run("splitting2").ok().csv();
    assert_eq!(rows.len(), 41);
    assert!(rows.iter().all(|row| row[1] > 0.0 && row[2] > 0.0));
    let control = run("rk4");
    assert!(
        control.stderr.contains("the Hamiltonian is not finite"),
        "{}",
        control.stderr
    );
}

#[test]
fn what_has_no_pieces_says_which_term() {
    let folder = folder();
    let mut relativistic = charged("1 + x*y");
    relativistic["hamiltonian"] = json!("sqrt(1 + u^2 + v^2) + x^2/2");
    let path = written(folder.path(), &relativistic);
    let run = lie(&format!(
        "run {} --method splitting4 --step 0.1 --until 1",
        path.display()
    ));
    assert_eq!(run.code, Some(2), "{}", run.stderr);
    let error = run.stderr;
    assert!(error.contains("sqrt(u^2 + v^2 + 1)"), "{error}");
    assert!(error.contains("k-hj4"), "{error}");
    // something acts beside H
    let mut driven = charged("1 + x*y");
    driven["forces"] = json!({ "u": "-u/10" });
    let path = written(folder.path(), &driven);
    let error = lie(&format!(
        "run {} --method splitting2 --step 0.1 --until 1",
        path.display()
    ))
    .stderr;
    assert!(error.contains("acts beside the Hamiltonian"), "{error}");
}
