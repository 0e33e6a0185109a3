//! The spherical midpoint rule where the time, damping and noise act on spins.

use crate::common::{csv, folder, lie};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

fn spec_file(folder: &Path, name: &str, spec: &Value) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, spec.to_string()).expect("written");
    path
}

/// Two spins that exchange, in a field that turns.
fn pair(more: Value) -> Value {
    let mut spec = json!({
        "format": 1,
        "name": "Pair",
        "algebra": "so(3)^2",
        "state": ["x1", "y1", "z1", "x2", "y2", "z2"],
        "hamiltonian": "-(x1*x2 + y1*y2 + z1*z2) + z1^2/5 - (x1 + x2)*cos(t)/3 - z2*sin(t)/4",
        "initial": ["3/5", 0, "4/5", 0, "-12/13", "5/13"]
    });
    let all = spec.as_object_mut().expect("an object");
    all.extend(more.as_object().expect("an object").clone());
    spec
}

/// All rows of a run, without their time.
fn rows(spec: &Path, arguments: &str) -> Vec<Vec<f64>> {
    let run = lie(&format!("run {} --quiet {arguments}", spec.display())).ok();
    csv(&run.stdout).1
}

fn lengths(row: &[f64]) -> [f64; 2] {
    [1, 4].map(|first| {
        row[first..first + 3]
            .iter()
            .map(|x| x * x)
            .sum::<f64>()
            .sqrt()
    })
}

/// What it claims holds: order 2, symmetric, a Poisson map with the time, the length of every spin.
#[test]
fn claims_hold_under_the_time_and_damping() {
    let folder = folder();
    let damped = json!({
        "dissipation": [{ "kind": "double-bracket", "strength": "1/5" }]
    });
    for (k, more) in [json!({}), damped].into_iter().enumerate() {
        let path = spec_file(folder.path(), &format!("pair{k}.json"), &pair(more));
        let run = lie(&format!(
            "verify {} --methods spherical-midpoint --quiet",
            path.display()
        ))
        .ok();
        assert!(run.stdout.contains(" claims, 0 fail\n"), "{}", run.stdout);
        assert!(run.stdout.contains("2: 2.00 ✓"), "{}", run.stdout);
    }
}

/// The end has the error of order 2 beside another method, whose own is far below it.
#[test]
fn the_error_is_of_order_two() {
    let folder = folder();
    let more = json!({
        "dissipation": [{ "kind": "double-bracket", "strength": "1/5" }]
    });
    let path = spec_file(folder.path(), "pair.json", &pair(more));
    let end = |arguments: &str| rows(&path, arguments).pop().expect("a row");
    let exact = end("--method gauss16 --step 0.05 --until 4");
    let error = |step: &str| {
        let found = end(&format!(
            "--method spherical-midpoint --step {step} --until 4"
        ));
        let pairs = found[1..7].iter().zip(&exact[1..7]);
        pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()))
    };
    let (coarse, fine) = (error("0.04"), error("0.02"));
    let slope = (coarse / fine).log2();
    assert!((slope - 2.0).abs() < 0.05, "{slope}: {coarse:e} {fine:e}");
}

/// At a temperature the lengths stay, and the mean of a free spin is that of Langevin; the classical method loses the length.
#[test]
fn spins_at_a_temperature_stay_on_their_spheres() {
    let folder = folder();
    let spec = json!({
        "format": 1,
        "name": "Free",
        "algebra": "so(3)^2",
        "state": ["x1", "y1", "z1", "x2", "y2", "z2"],
        "hamiltonian": "-z1 - z2",
        "dissipation": [{ "kind": "double-bracket", "strength": "1", "temperature": "1/2" }],
        "initial": [0, 0, 1, 1, 0, 0]
    });
    let path = spec_file(folder.path(), "free.json", &spec);
    let run = |method: &str| {
        rows(
            &path,
            &format!("--method {method} --step 0.05 --until 1000 --seed 5"),
        )
    };
    let rows = run("spherical-midpoint");
    let worst = |rows: &[Vec<f64>]| {
        let all = rows.iter().flat_map(|row| lengths(row));
        all.fold(0.0_f64, |most, length| most.max((length - 1.0).abs()))
    };
    assert!(worst(&rows) < 1e-12, "{:e}", worst(&rows));
    assert!(worst(&run("rk4")) > 1e-6, "the control");
    // two spins over 1,000 units of time, whose memory is about one
    let sum: f64 = rows.iter().map(|row| row[3] + row[6]).sum();
    let mean = sum / (2 * rows.len()) as f64;
    let langevin = 1.0 / 2.0_f64.tanh() - 0.5;
    assert!((mean - langevin).abs() < 0.06, "{mean} {langevin}");
}

/// Forces move spins off their spheres, which the method says.
#[test]
fn forces_are_refused() {
    let folder = folder();
    let path = spec_file(
        folder.path(),
        "pushed.json",
        &pair(json!({ "forces": { "x1": "1/10" } })),
    );
    let run = lie(&format!(
        "run {} --method spherical-midpoint --step 0.1 --until 1",
        path.display()
    ));
    assert_eq!(run.code, Some(2), "{}", run.stderr);
    assert!(
        run.stderr.contains("forces act beside the Hamiltonian"),
        "{}",
        run.stderr
    );
}
