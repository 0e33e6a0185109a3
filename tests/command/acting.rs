//! Inputs and noise at the command: tables, seeds, threads and shares.

use std::fs;
use std::path::Path;

use crate::common::{Run, folder, lie};
use serde_json::{Value, json};

/// A body with a torque from outside, and with a moment of inertia from there too.
fn driven() -> Value {
    json!({
        "name": "Driven",
        "algebra": "so(3)",
        "state": ["x", "y", "z"],
        "inputs": { "u": { "default": 0.25 }, "w": { "default": 1 } },
        "hamiltonian": "x^2/2 + w*y^2/4 + z^2/6",
        "forces": { "z": "u*x" },
        "initial": [0.3, 0.1, 1],
        "run": { "method": "gauss6", "step": 0.1, "until": 10 }
    })
}

/// A spin in a field, in thermal equilibrium.
fn spin() -> Value {
    json!({
        "name": "Spin",
        "algebra": "so(3)",
        "state": ["x", "y", "z"],
        "parameters": { "alpha": 1, "T": 0.3 },
        "hamiltonian": "z",
        "casimirs": ["C = x^2 + y^2 + z^2"],
        "dissipation": [{ "kind": "double-bracket", "strength": "alpha", "temperature": "T" }],
        "initial": [0.6, 0, 0.8],
        "run": { "method": "gauss4", "step": 0.1, "until": 10 }
    })
}

fn written(folder: &Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    fs::write(&path, text).unwrap();
    path.display().to_string()
}

fn last(run: &Run) -> Vec<f64> {
    run.csv().1.pop().unwrap()
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    let pairs = a.iter().zip(b).take(4);
    pairs.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}

/// An input that jumps between the steps is the force with the same jumps.
#[test]
fn a_table_is_the_force_that_it_writes() {
    let folder = folder();
    let by_table = written(folder.path(), "table.json", &driven().to_string());
    let table = written(folder.path(), "u.csv", "t,u\n0,0.5\n3.14159,-1\n6,2\n");
    let mut spec = driven();
    spec.as_object_mut().unwrap().remove("inputs");
    spec["hamiltonian"] = json!("x^2/2 + y^2/4 + z^2/6");
    spec["forces"] = json!({ "z": "piecewise(t < 3.14159: 1/2, t < 6: -1, 2)*x" });
    let by_force = written(folder.path(), "force.json", &spec.to_string());
    for pace in ["--step 0.01", "--tol 1e-11", "--at 0,10 --tol 1e-11"] {
        let one = lie(&format!("run {by_table} --input u={table} {pace}")).ok();
        let other = lie(&format!("run {by_force} {pace}")).ok();
        let (one, other) = (last(&one), last(&other));
        assert!(distance(&one, &other) < 1e-11, "{pace}: {one:?} {other:?}");
    }
    let without = last(&lie(&format!("run {by_table}")).ok());
    let with = last(&lie(&format!("run {by_table} --input u={table}")).ok());
    assert!(distance(&without, &with) > 0.1, "the control");
}

#[test]
fn a_wrong_table_has_a_place_and_a_remedy() {
    let folder = folder();
    let spec = written(folder.path(), "spec.json", &driven().to_string());
    let run = |flags: &str| lie(&format!("run {spec} {flags}"));
    let missing = folder.path().join("none.csv");
    let text = run(&format!("--input u={}", missing.display())).stderr;
    assert!(
        text.starts_with("error[io]: ") && text.contains("none.csv"),
        "{text}"
    );
    let text = run("--input v=u.csv")
        .error("option", "command line: --input")
        .stderr;
    assert!(text.contains("the inputs are u, w"), "{text}");
    run("--input u").error("option", "command line: --input");
    for (name, table) in [
        ("back.csv", "t,u\n0,1\n3,1\n2,1\n"),
        ("twice.csv", "t,u\n0,1\n0,2\n"),
        ("infinite.csv", "t,u\n0,1\n1,inf\n"),
        ("words.csv", "t,u\n0,one\n"),
        ("fraction.csv", "0,1/2\n1,2\n"),
        ("empty.csv", ""),
    ] {
        let path = written(folder.path(), name, table);
        let text = run(&format!("--input u={path}")).stderr;
        assert!(
            text.starts_with("error[input]: ") && text.contains(name),
            "{text}"
        );
        assert!(text.contains("help:"), "{text}");
    }
}

#[test]
fn noise_is_told_by_its_seed() {
    let folder = folder();
    let spec = written(folder.path(), "spin.json", &spin().to_string());
    let run = |flags: &str| lie(&format!("run {spec} {flags}")).ok().stdout;
    let first = run("--seed 1");
    assert_eq!(first, run(""), "the seed is 1 where none is given");
    assert_ne!(first, run("--seed 2"));
    let text = lie(&format!("run {spec} --tol 1e-6"))
        .error("option", "command line: --tol")
        .stderr;
    assert!(text.contains("help:"), "{text}");
}

/// On the sphere of radius 1 the mean of H is that of Langevin, `T - coth(1/T)`.
#[test]
fn a_thermal_spin_has_the_mean_of_langevin() {
    let folder = folder();
    let mean = |spec: &Value| {
        let path = written(folder.path(), "spin.json", &spec.to_string());
        let run = lie(&format!("run {path} --until 3000 --every 10")).ok();
        let (_, rows) = run.csv();
        let radius = |row: &[f64]| row[1..4].iter().map(|x| x * x).sum::<f64>();
        assert!(rows.iter().all(|row| (radius(row) - 1.0).abs() < 1e-12));
        let late = &rows[rows.len() / 20..];
        late.iter().map(|row| row[3]).sum::<f64>() / late.len() as f64
    };
    // the mean of one run of this length has an error of 0.008
    let expected = 0.3 - 1.0 / (1.0_f64 / 0.3).tanh();
    let found = mean(&spin());
    assert!((found - expected).abs() < 0.03, "{found}, {expected}");
    let mut cold = spin();
    cold["dissipation"][0]
        .as_object_mut()
        .unwrap()
        .remove("temperature");
    let found = mean(&cold);
    assert!((found + 1.0).abs() < 1e-6, "the control: {found}");
}

#[test]
fn members_have_noise_of_their_own_whoever_makes_them() {
    let folder = folder();
    let spec = written(folder.path(), "spin.json", &spin().to_string());
    let made = |flags: &str, name: &str| {
        let path = folder.path().join(name);
        let members = "--members 20 --seed 3 --until 2";
        let out = path.display();
        lie(&format!("ensemble {spec} {members} {flags} --out {out}")).ok();
        path
    };
    let one = fs::read(made("--threads 1", "one.npy")).unwrap();
    assert_eq!(one, fs::read(made("--threads 2", "two.npy")).unwrap());
    let shares: Vec<String> = (1..=3)
        .map(|k| made(&format!("--shard {k}/3"), &format!("share{k}.npy")))
        .map(|path| path.display().to_string())
        .collect();
    let merged = folder.path().join("merged.npy");
    lie(&format!(
        "merge {} --out {}",
        shares.join(" "),
        merged.display()
    ))
    .ok();
    assert_eq!(one, fs::read(merged).unwrap());
    let members: std::collections::BTreeSet<&[u8]> = one[128..].chunks_exact(24).collect();
    assert_eq!(members.len(), 20, "all members differ");
}

/// Events are looked for piece by piece between the jumps of an input, and leave the run as it is.
#[test]
fn events_and_jumps_of_inputs_do_not_disturb_each_other() {
    let folder = folder();
    let plain = written(folder.path(), "plain.json", &driven().to_string());
    let mut spec = driven();
    spec["events"] = json!({ "x": { "when": "x" }, "y": { "when": "y" }, "z": { "when": "z - 0.9" }, "jump": { "when": "u + 0.9" }, "level": { "when": "u - 2" } });
    let with = written(folder.path(), "events.json", &spec.to_string());
    let table = written(folder.path(), "u.csv", "t,u\n0,0.5\n3.14159,-1\n6.03,2\n");
    let found = folder.path().join("found.csv");
    let flags = format!("--input u={table} --step 0.1 --until 20");
    let one = lie(&format!("run {plain} {flags}")).ok();
    let events = format!("--events {}", found.display());
    let other = lie(&format!("run {with} {flags} {events}")).ok();
    assert_eq!(one.stdout, other.stdout);
    let times = |path: &Path| -> Vec<(String, f64)> {
        let text = fs::read_to_string(path).unwrap();
        let rows = text
            .lines()
            .skip(1)
            .map(|line| line.split(',').collect::<Vec<_>>());
        rows.map(|row| (row[0].to_owned(), row[1].parse().unwrap()))
            .collect()
    };
    // the same zeros by the force with the same jumps, at a step that ends at them
    spec["inputs"] = json!({ "w": { "default": 1 } });
    spec["events"] =
        json!({ "x": { "when": "x" }, "y": { "when": "y" }, "z": { "when": "z - 0.9" } });
    spec["forces"] = json!({ "z": "piecewise(t < 3.14159: 1/2, t < 6.03: -1, 2)*x" });
    let by_force = written(folder.path(), "force.json", &spec.to_string());
    let expected = folder.path().join("expected.csv");
    let out = expected.display();
    lie(&format!(
        "run {by_force} --step 0.01 --until 20 --events {out}"
    ))
    .ok();
    let (found, expected) = (times(&found), times(&expected));
    assert!(expected.len() == 8, "{expected:?}");
    assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
    for (found, expected) in found.iter().zip(&expected) {
        assert_eq!(found.0, expected.0);
        assert!(
            (found.1 - expected.1).abs() < 1e-6,
            "{found:?} {expected:?}"
        );
    }
}

/// What a tolerance is told of an input before it comes, and what a second run says of the end.
#[test]
fn a_tolerance_knows_the_tables() {
    let folder = folder();
    let spec = written(folder.path(), "spec.json", &driven().to_string());
    let table = written(folder.path(), "u.csv", "0,0\n0.5,30\n");
    let run = |flags: &str| lie(&format!("run {spec} --input u={table} --until 3 {flags}")).ok();
    let exact = last(&run("--method gauss16 --step 0.002"));
    let size = exact[1..4]
        .iter()
        .fold(0.0_f64, |most, x| most.max(x.abs()));
    for method in ["rk4", "gauss6", "gauss16"] {
        let found = run(&format!("--method {method} --tol 1e-8 --assess"));
        let error = distance(&exact, &last(&found)) / size;
        assert!(error < 3e-7, "{method}: {error:e}");
        let said = found
            .stderr
            .split("the error at the end is about ")
            .nth(1)
            .unwrap();
        let said: f64 = said.split_whitespace().next().unwrap().parse().unwrap();
        assert!(said < 1e-5, "{method}: {said:e}");
    }
    let noisy = written(folder.path(), "spin.json", &spin().to_string());
    lie(&format!("run {noisy} --assess")).error("option", "command line: --assess");
    lie(&format!("run {noisy} --density reversible")).error("option", "command line: --density");
}

/// A table is read by a run as the spec is: it is not written over, a changed one takes up no run, and shares of another are not merged.
#[test]
fn a_table_belongs_to_the_run() {
    let folder = folder();
    let spec = written(folder.path(), "spec.json", &driven().to_string());
    let text = "0,0.5\n1,-1\n";
    let table = written(folder.path(), "u.csv", text);
    lie(&format!("run {spec} --input u={table} --out {table}"))
        .error("option", "command line: --out");
    assert_eq!(fs::read_to_string(&table).unwrap(), text);
    let place = |name: &str| folder.path().join(name).display().to_string();
    let (checkpoint, out) = (place("checkpoint"), place("rows.csv"));
    let flags = format!("--input u={table} --until 300 --checkpoint {checkpoint} --out {out}");
    lie(&format!("run {spec} {flags}")).ok();
    let share = |k: u32| {
        let out = place(&format!("share{k}.npy"));
        let members = "--members 4 --spread 0.1 --until 1";
        lie(&format!(
            "ensemble {spec} {members} --input u={table} --shard {k}/2 --out {out}"
        ))
        .ok();
        out
    };
    let first = share(1);
    fs::write(&table, "0,0.5\n1,-2\n").unwrap();
    lie(&format!("resume {checkpoint}")).error("checkpoint", &table);
    let second = share(2);
    let merged = place("merged.npy");
    let run = lie(&format!("merge {first} {second} --out {merged}"));
    assert_eq!(run.code, Some(2), "{}", run.stderr);
    assert!(run.stderr.contains("input"), "{}", run.stderr);
}

/// Methods are compared along one path.
#[test]
fn methods_see_the_same_noise() {
    let folder = folder();
    let spec = written(folder.path(), "spin.json", &spin().to_string());
    let run = lie(&format!(
        "run {spec} --method lie-midpoint --method gauss4 --step 0.001 --until 1 --every 1000"
    ))
    .ok();
    let ends: Vec<Vec<f64>> = run
        .stdout
        .lines()
        .skip(1)
        .map(|line| {
            line.split(',')
                .filter_map(|entry| entry.parse().ok())
                .collect()
        })
        .collect();
    let ends: Vec<_> = ends
        .iter()
        .filter(|row: &&Vec<f64>| row[1] == 1.0)
        .collect();
    assert_eq!(ends.len(), 2);
    assert!(distance(&ends[0][1..], &ends[1][1..]) < 0.01, "{ends:?}");
    let other = last(&lie(&format!("run {spec} --seed 2 --step 0.001 --until 1")).ok());
    assert!(
        distance(&ends[0][1..], &other) > 0.1,
        "the control: {other:?}"
    );
}

/// By machine code of the command: discrete gradients keep H, and have the entropy grow, at a step where others lose both.
#[test]
fn a_metriplectic_body_keeps_its_energy() {
    let folder = folder();
    let spec = json!({
        "name": "Relaxing",
        "algebra": "so(3)",
        "state": ["x", "y", "z"],
        "hamiltonian": "x^2/2 + y^2/4 + z^2/6 + x*y*z/10",
        "dissipation": [{
            "kind": "metriplectic",
            "entropy": "(x^2 + y^2 + z^2)^2/4",
            "factor": [["y/2 + x*z/10"], ["-(x + y*z/10)"], [0]]
        }],
        "observables": { "S": "(x^2 + y^2 + z^2)^2/4", "H": "x^2/2 + y^2/4 + z^2/6 + x*y*z/10" },
        "initial": [0.8, 0.3, -0.5]
    });
    let spec = written(folder.path(), "relaxing.json", &spec.to_string());
    let run = |method: &str| {
        let run = lie(&format!(
            "run {spec} --method {method} --step 0.5 --until 100"
        ))
        .ok();
        let (header, rows) = run.csv();
        let place = |name: &str| header.iter().position(|column| column == name).unwrap();
        let (entropy, energy) = (place("S"), place("H"));
        let fall = rows
            .windows(2)
            .map(|pair| pair[0][entropy] - pair[1][entropy])
            .fold(0.0, f64::max);
        let drift = rows
            .iter()
            .map(|row| (row[energy] - rows[0][energy]).abs())
            .fold(0.0, f64::max);
        (drift, fall)
    };
    for method in ["gonzalez", "mean-value", "itoh-abe"] {
        let (drift, fall) = run(method);
        assert!(
            drift < 2e-14 && fall < 2e-15,
            "{method}: {drift:e} {fall:e}"
        );
    }
    let (drift, _) = run("midpoint");
    assert!(drift > 1e-5, "{drift:e}");
}

/// The work is that of the forces: what a noise does as a force is not in it, by no method.
#[test]
fn noise_does_no_work() {
    let folder = folder();
    let spec = json!({
        "name": "Shaken",
        "algebra": "so(3)",
        "state": ["x", "y", "z"],
        "hamiltonian": "x^2/2 + y^2/4 + z^2/6 + x*y*z/10",
        "noise": [{ "force": { "y": "1/5", "z": "1/3" } }],
        "initial": [0.8, 0.3, -0.5]
    });
    let spec = written(folder.path(), "shaken.json", &spec.to_string());
    for method in [
        "gauss6",
        "gonzalez",
        "mean-value",
        "orbit-energy",
        "cohen-hairer4",
    ] {
        let run = lie(&format!(
            "run {spec} --method {method} --step 0.1 --until 10 --seed 3"
        ))
        .ok();
        let (header, rows) = run.csv();
        let place = |name: &str| header.iter().position(|column| column == name).unwrap();
        let (work, energy) = (place("work"), place("energy"));
        let worked = rows.iter().map(|row| row[work].abs()).fold(0.0, f64::max);
        assert!(worked < 1e-14, "{method}: {worked:e}");
        // the noise heats the body
        let last = rows.last().unwrap();
        assert!((last[energy] - rows[0][energy]).abs() > 1e-3, "{method}");
    }
}
