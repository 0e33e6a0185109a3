//! Steps that would leave the coadjoint orbit, and what the command says instead.

use crate::common::{Run, command, folder};
use serde_json::{Value, json};

/// Calls `lie` on a spec of this JSON.
fn lie(call: &str, spec: &Value, rest: &[&str]) -> Run {
    let folder = folder();
    let path = folder.path().join("spec.json");
    std::fs::write(&path, spec.to_string()).expect("the spec is written");
    let mut arguments = vec![call, path.to_str().expect("a path")];
    arguments.extend(rest);
    command(arguments).output().expect("lie starts").into()
}

/// The affine group of the line: the coordinate q keeps its sign.
fn decay() -> Value {
    json!({
        "format": 1, "name": "Decay",
        "algebra": {
            "basis": ["a", "b"], "brackets": ["[a, b] = b"],
            "matrices": { "a": [[1, 0], [0, 0]], "b": [[0, 1], [0, 0]] }
        },
        "state": ["p", "q"], "hamiltonian": "-3*p + p^2/20 + q^2/10", "initial": [0.5, 1]
    })
}

#[test]
fn the_sheets_of_a_hyperboloid() {
    let spec = json!({
        "format": 1, "name": "Sheets",
        "algebra": { "basis": ["k1", "k2", "j"], "matrices": {
            "k1": [[0, 0, 1], [0, 0, 0], [1, 0, 0]],
            "k2": [[0, 0, 0], [0, 0, 1], [0, 1, 0]],
            "j": [[0, -1, 0], [1, 0, 0], [0, 0, 0]]
        } },
        "state": ["x", "y", "z"], "hamiltonian": "5*x + y^2/40 + z^2/60",
        "casimirs": ["c = z^2 - x^2 - y^2"], "initial": [0.2, -12, 12.2],
        // fused as well as generic
        "methods": ["lie-midpoint"]
    });
    let run = |method: &str, step: &str| {
        let mut rest: Vec<&str> = vec!["--quiet", "--step", step, "--until", "1", "--method"];
        rest.extend(method.split(' '));
        lie("run", &spec, &rest)
    };
    for method in ["lie-midpoint --retraction cayley", "isospectral2"] {
        let stopped = run(method, "0.5");
        assert_eq!(stopped.code, Some(3), "{}", stopped.stderr);
        assert!(
            stopped
                .stderr
                .contains("leaves the chart of the retraction")
                && stopped
                    .stderr
                    .contains("from this state a step of 0.25 works"),
            "{}",
            stopped.stderr
        );
        assert_eq!(stopped.csv().1.len(), 1, "the rows before it");
    }
    let (_, rows) = run("lie-midpoint --retraction cayley", "0.05").ok().csv();
    assert!(rows.iter().all(|row| row[3] > 0.0), "the upper sheet");
}

#[test]
fn what_verify_says_of_large_steps() {
    let rest = ["--quiet", "--step", "0.8", "--methods", "lie-midpoint"];
    let run = lie("verify", &decay(), &rest).ok();
    let line = |name: &str| {
        let found = run.stdout.lines().find(|line| line.starts_with(name));
        found
            .unwrap_or_else(|| panic!("{name} in {}", run.stdout))
            .to_owned()
    };
    // the orbit of the exponential form is kept at the step asked for
    let header: Vec<String> = line("method ")
        .split("  ")
        .map(|cell| cell.trim().to_owned())
        .collect();
    let header: Vec<&String> = header.iter().filter(|cell| !cell.is_empty()).collect();
    assert_eq!(header[1], "step", "{}", run.stdout);
    let exp = line("lie-midpoint  ");
    assert!(exp.contains("  0.80  "), "{exp}");
    // that of the Cayley form at the smaller one that it makes, and the row says which
    let cayley = line("lie-midpoint --retraction cayley");
    assert!(cayley.contains(" 0.20 to 0.40  "), "{cayley}");
    assert!(run.stdout.contains("0 fail"), "{}", run.stdout);
}

#[test]
fn a_realization_that_is_not_closed() {
    let mut spec = json!({
        "format": 1, "name": "SpinTwo",
        "algebra": { "basis": ["e1", "e2", "e3"], "brackets": ["[e1, e2] = e3", "[e2, e3] = e1", "[e3, e1] = e2"] },
        "state": ["x", "y", "z"], "hamiltonian": "x^2/2 + y^2/3 + z^2/5 + x*y*z/2", "initial": [0.6, -0.5, 0.7]
    });
    let names = |letter: char| -> Vec<String> { (1..=6).map(|k| format!("{letter}{k}")).collect() };
    spec["realization"] = json!({
        "positions": names('q'), "momenta": names('p'),
        "map": [
            "x = 2*p2*q5 - 2*p3*q5 + p4*q6 - p5*q2 + p5*q3 - p6*q4",
            "y = -2*p1*q6 + 2*p3*q6 - p4*q5 + p5*q4 + p6*q1 - p6*q3",
            "z = 2*p1*q4 - 2*p2*q4 - p4*q1 + p4*q2 - p5*q6 + p6*q5"
        ]
    });
    let rest = [
        "--method",
        "collective2",
        "--lift",
        "spec",
        "--step",
        "0.5",
        "--until",
        "5",
    ];
    let run = lie("run", &spec, &rest).error("method", "command line: --method");
    assert!(
        run.stderr.contains("leave the coadjoint orbit"),
        "{}",
        run.stderr
    );
}

/// Behind the folds of a Lagrangian that is not convex, where each momentum has one velocity.
#[test]
fn a_lagrangian_with_folds() {
    let spec = json!({
        "format": 1, "name": "Fold",
        "algebra": { "basis": ["e1", "e2", "e3"], "brackets": ["[e1, e2] = e3", "[e2, e3] = e1", "[e3, e1] = e2"] },
        "state": ["x", "y", "z"], "velocity": ["u", "v", "w"],
        "lagrangian": "u^2/2 - u^4/4 + 3*u^6/60 + v^2 + w^2*3/2",
        "casimirs": ["c = x^2 + y^2 + z^2"], "initial": [1, 0.9, 0.8]
    });
    let rest = [
        "--quiet", "--method", "gauss6", "--step", "0.05", "--until", "2",
    ];
    let (_, rows) = lie("run", &spec, &rest).ok().csv();
    let last = rows.last().expect("a row");
    // the Euler-Poincaré equations in the velocity, by Taylor series in 30 digits (mpmath)
    let exact = [1.045449134129418, -0.2673523475636285, -1.133824867517143];
    for (found, exact) in last[1..4].iter().zip(exact) {
        assert!((found - exact).abs() < 1e-8, "{last:?}");
    }
}
