//! Matrices whose entries have parameters: their runs are those of the numbers, put in.

use crate::common::{command, folder, lie};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Rotations for positive k, of a hyperboloid for negative ones, with brackets that are computed from the matrices.
fn body(k: &str, put_in: bool) -> Value {
    let entry = |factor: &str| match put_in {
        true => format!("{factor}({k})"),
        false => format!("{factor}k"),
    };
    json!({
        "format": 1,
        "name": "Turning",
        "algebra": {
            "basis": ["a", "b", "c"],
            "matrices": {
                "a": [[0, 0, 0], [0, 0, entry("-")], [0, 1, 0]],
                "b": [[0, 0, entry("")], [0, 0, 0], [-1, 0, 0]],
                "c": [[0, -1, 0], [1, 0, 0], [0, 0, 0]]
            }
        },
        "state": ["x", "y", "z"],
        "parameters": { "k": { "default": k, "exact": true }, "I": 2 },
        "hamiltonian": "x^2/4 + y^2/I + 3*z^2/4 + x*y^2*z/3 + x^3/5 + k*y/4",
        "initial": ["3/5", "-1/2", "7/10"]
    })
}

/// so(3) in a basis of the space that is stretched by k: the brackets have no parameter.
fn stretched(k: &str, put_in: bool) -> Value {
    let text = |value: &str| match put_in {
        true => value.replace('k', &format!("({k})")),
        false => value.to_owned(),
    };
    let mut spec = body(k, put_in);
    spec["name"] = json!("Stretched");
    spec["algebra"]["matrices"] = json!({
        "a": [[0, 0, 0], [0, 0, text("-1/k")], [0, text("k"), 0]],
        "b": [[0, 0, text("1/k^2")], [0, 0, 0], [text("-k^2"), 0, 0]],
        "c": [[0, text("-1/k"), 0], [text("k"), 0, 0], [0, 0, 0]]
    });
    spec
}

fn written(folder: &Path, name: &str, spec: &Value) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, spec.to_string()).expect("written");
    path
}

/// The states of a run.
fn states(path: &Path, arguments: &str) -> Vec<Vec<f64>> {
    let path = path.display();
    let call = format!("run {path} --step 0.05 --until 5 --quiet {arguments}");
    let (_, rows) = lie(&call).ok().csv();
    assert_eq!(rows.len(), 101, "{call}");
    rows.into_iter().map(|row| row[1..4].to_vec()).collect()
}

fn difference(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    let entries = a.iter().flatten().zip(b.iter().flatten());
    let off = entries.map(|(a, b)| (a - b).abs() / b.abs().max(1.0));
    off.fold(0.0, f64::max)
}

const METHODS: [&str; 9] = [
    "--method lie-midpoint",
    "--method lie-midpoint --retraction cayley",
    "--method compose4(lie-midpoint) --retraction cayley",
    "--method rkmk4",
    "--method cf4",
    "--method generating4",
    "--method generating4 --retraction cayley",
    "--method gauss16",
    "--method gonzalez",
];

#[test]
fn runs_are_those_of_the_numbers() {
    let folder = folder();
    let mut worst: f64 = 0.0;
    for (name, make) in [
        ("body", body as fn(&str, bool) -> Value),
        ("stretched", stretched),
    ] {
        let parametric = written(folder.path(), &format!("{name}.json"), &make("3/2", false));
        for k in ["3/2", "1/3", "-3/4", "5/2"] {
            let numbers = written(folder.path(), "numbers.json", &make(k, true));
            for method in METHODS {
                let found = states(&parametric, &format!("{method} --param k={k}"));
                let off = difference(&found, &states(&numbers, method));
                assert!(off < 1e-12, "{name}, k = {k}, {method}: {off:e}");
                worst = worst.max(off);
            }
            // the control: another value makes other steps
            let other = states(&parametric, "--method lie-midpoint --param k=0.7");
            let far = difference(&other, &states(&numbers, "--method lie-midpoint"));
            assert!(far > 1e-3, "{name}, k = {k}: {far:e}");
        }
    }
    println!("largest difference {worst:.1e}");
}

/// What is claimed of the methods is measured, of left- and right-invariant systems, and beside a cocycle.
#[test]
fn methods_keep_what_they_claim() {
    let folder = folder();
    let right = |mut spec: Value| {
        spec["invariance"] = json!("right");
        spec
    };
    let beside = |mut spec: Value| {
        spec["cocycle"] = json!(["{x, y} = 3/7"]);
        spec
    };
    for (name, spec) in [
        ("turning.json", body("3/2", false)),
        ("boosts.json", body("-3/2", false)),
        ("right.json", right(body("3/2", false))),
        ("stretched.json", stretched("2", false)),
        ("cocycle.json", beside(stretched("2", false))),
    ] {
        let path = written(folder.path(), name, &spec);
        let cayley = "lie-midpoint --retraction cayley";
        let methods = format!("lie-midpoint,{cayley},rkmk4,rk4");
        let path = path.to_string_lossy();
        let arguments = ["verify", &path, "--methods", &methods, "--quiet", "--json"];
        let verify = command(arguments).output().expect("it runs");
        let report: Value = serde_json::from_slice(&verify.stdout).expect("JSON");
        assert_eq!(report["failed"], 0, "{name}: {report:#}");
        let defect = |method: &str| report["methods"][method]["Poisson"]["measured"].as_f64();
        for method in ["lie-midpoint", cayley] {
            let defect = defect(method).expect("a number");
            assert!(defect < 1e-13, "{name}, {method}: {defect:e}");
        }
        assert!(defect("rk4") > Some(1e-10), "{name}: {report:#}");
    }
}

#[test]
fn what_needs_numbers_says_so() {
    let folder = folder();
    let path = written(folder.path(), "body.json", &body("3/2", false));
    for arguments in [
        "--method isospectral4",
        "--method collective4 --lift representation",
        "--method lie-midpoint --group matrix",
    ] {
        let call = format!("run {} --step 0.05 --until 1 {arguments}", path.display());
        let refused = lie(&call);
        assert_ne!(refused.code, Some(0), "{call}");
        let expected = "the declared ones depend on the parameter `k`";
        assert!(refused.stderr.contains(expected), "{}", refused.stderr);
    }
    // a value at which a bracket has none
    let path = written(folder.path(), "stretched.json", &{
        let mut spec = body("3/2", false);
        spec["algebra"]["matrices"]["c"] = json!([[0, "-1/k", 0], ["1/k", 0, 0], [0, 0, 0]]);
        spec
    });
    let call = format!(
        "run {} --method lie-midpoint --step 0.05 --until 1",
        path.display()
    );
    lie(&format!("{call} --param k=0")).error("domain", "command line: --param");
    lie(&call).ok();
    // and one at which the brackets are finite, but nothing says that they are those of the matrices
    let path = written(folder.path(), "scaled.json", &{
        let mut spec = body("3/2", false);
        spec["algebra"]["matrices"]["c"] = json!([[0, "-k", 0], ["k", 0, 0], [0, 0, 0]]);
        spec
    });
    let call = format!(
        "run {} --method lie-midpoint --step 0.05 --until 1",
        path.display()
    );
    let refused = lie(&format!("{call} --param k=0")).error("domain", "command line: --param");
    assert!(
        refused.stderr.contains("linearly dependent"),
        "{}",
        refused.stderr
    );
    lie(&call).ok();
}
