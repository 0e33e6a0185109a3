//! Runs backwards in time: a table of an input is one function of the time, whichever way a run goes.

use std::fs;
use std::path::Path;

use crate::common::{Run, folder, lie};
use serde_json::{Value, json};

fn written(folder: &Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    fs::write(&path, text).unwrap();
    path.display().to_string()
}

fn column(run: &Run, name: &str) -> Vec<f64> {
    let (header, rows) = run.csv();
    let place = header.iter().position(|column| column == name).unwrap();
    rows.iter().map(|row| row[place]).collect()
}

fn last(run: &Run) -> Vec<f64> {
    run.csv().1.pop().unwrap()
}

/// The largest difference of so many coordinates behind the time.
fn apart(a: &[f64], b: &[f64], count: usize) -> f64 {
    let pairs = a[1..=count].iter().zip(&b[1..=count]);
    pairs.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}

/// `--initial` with the coordinates of a row.
fn from_row(row: &[f64], count: usize) -> String {
    let values: Vec<String> = row[1..=count].iter().map(|x| format!("{x:?}")).collect();
    format!("--initial={}", values.join(","))
}

/// A spin in a field u along z: phi' = -u.
fn turning() -> Value {
    json!({
        "name": "Turning",
        "algebra": "so(3)",
        "state": ["x", "y", "z"],
        "inputs": { "u": { "default": 0 } },
        "hamiltonian": "u*z",
        "observables": { "phi": { "expression": "atan2(y, x)", "unwrap": true } },
        "events": { "turned": { "when": "y" } },
        "initial": [1, 0, 0],
        "run": { "method": "gauss16", "step": 0.5, "until": 3 }
    })
}

/// A body whose moment of inertia and torque come from outside.
fn driven() -> Value {
    json!({
        "name": "Driven",
        "algebra": "so(3)",
        "state": ["x", "y", "z"],
        "inputs": { "u": { "default": 0.25 }, "w": { "default": 1 } },
        "hamiltonian": "x^2/2 + w*y^2/4 + z^2/6",
        "forces": { "z": "u*x" },
        "events": { "down": { "when": "x" }, "side": { "when": "y" }, "up": { "when": "z - 1.1" } },
        "initial": [0.3, 0.1, 1],
        "run": { "method": "gauss16", "step": 0.1, "until": 10 }
    })
}

/// phi = -int u, from 3 to 0 that is 2*2 + 1*1, whether steps end at the time of the table, beside it or beyond it.
#[test]
fn a_table_is_one_function_of_the_time() {
    let folder = folder();
    let spec = written(folder.path(), "turning.json", &turning().to_string());
    let table = written(folder.path(), "u.csv", "t,u\n0,1\n1,2\n");
    let call = |rest: &str| lie(&format!("run {spec} --input u={table} {rest}")).ok();
    let end = |rest: &str| *column(&call(rest), "phi").last().unwrap();
    assert!((end("") + 5.0).abs() < 1e-13, "forwards");
    let back = "--from 3 --until 0";
    for pace in [
        "--step -0.5",
        "--step -0.4",
        "--step -3",
        "--step -0.7",
        "--method rk4 --step -0.01",
        "--tol 1e-10",
        "--method splitting4 --step -0.5",
    ] {
        let found = end(&format!("{back} {pace}"));
        assert!((found - 5.0).abs() < 1e-7, "{pace}: {found}");
    }
    // rows beside the grid, at the time of the table and behind it
    let rows = call("--from 3 --step -0.4 --at 3,2.5,1.1,1,0.9,0");
    for (phi, known) in column(&rows, "phi")
        .iter()
        .zip([0.0, 1.0, 3.8, 4.0, 4.1, 5.0])
    {
        assert!((phi - known).abs() < 1e-13, "{phi} {known}");
    }
    // H jumps where it changes, from 2*z to z, and that is work
    let tilted = call("--from 3 --until 0 --step -0.5 --initial 0.6,0,0.8");
    let (work, energy) = (column(&tilted, "work"), column(&tilted, "energy"));
    assert!((work.last().unwrap() + 0.8).abs() < 1e-13, "{work:?}");
    let kept = work.iter().zip(&energy).map(|(w, e)| e - w);
    assert!(kept.clone().all(|kept| (kept - 1.6).abs() < 1e-13));
}

/// A run to the end and back is at its start, with the same events on the way.
#[test]
fn the_way_back_is_the_way() {
    let folder = folder();
    let spec = written(folder.path(), "driven.json", &driven().to_string());
    let u = written(folder.path(), "u.csv", "t,u\n0,0.5\n3.14159,-1\n6,2\n");
    let w = written(folder.path(), "w.csv", "t,w\n1,1\n4.5,1.5\n8,0.7\n");
    let inputs = format!("--input u={u} --input w={w}");
    let times = |table: &Path| -> Vec<f64> {
        let text = fs::read_to_string(table).unwrap();
        let rows = text.lines().skip(1);
        rows.map(|row| row.split(',').nth(1).unwrap().parse().unwrap())
            .collect()
    };
    let [there, here] = ["there.csv", "here.csv"].map(|name| folder.path().join(name));
    let out = lie(&format!("run {spec} {inputs} --events {}", there.display())).ok();
    let (first, end) = (out.csv().1.remove(0), last(&out));
    for pace in ["--step -0.1", "--step -0.37", "--tol 1e-12"] {
        let start = from_row(&end, 3);
        let back = lie(&format!(
            "run {spec} {inputs} --from 10 --until 0 {pace} {start} --events {}",
            here.display()
        ))
        .ok();
        let off = apart(&last(&back), &first, 3);
        assert!(off < 1e-10, "{pace}: {off:e}");
        let (mut found, known) = (times(&here), times(&there));
        found.reverse();
        assert!(known.len() > 3 && found.len() == known.len(), "{pace}");
        let pairs = found.iter().zip(&known);
        let worst = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-9, "{pace}: {worst:e}");
        let balance = column(&back, "energy")
            .into_iter()
            .zip(column(&back, "work"));
        let balance: Vec<f64> = balance.map(|(energy, work)| energy - work).collect();
        let drift = balance.iter().map(|x| (x - balance[0]).abs());
        assert!(drift.fold(0.0, f64::max) < 1e-9, "{pace}");
    }
    // in two parts, the second of which begins where the table changes
    let part = |rest: &str, row: &[f64]| {
        let start = from_row(row, 3);
        last(&lie(&format!("run {spec} {inputs} {rest} {start}")).ok())
    };
    let middle = part("--from 10 --until 6 --step -0.1", &end);
    let whole = part("--from 6 --until 0 --step -0.1", &middle);
    assert!(apart(&whole, &first, 3) < 1e-10, "{whole:?}");
}

/// Branches of H in the time are joints backwards too, as the table that says the same is.
#[test]
fn branches_in_the_time_are_met_from_behind() {
    let folder = folder();
    let mut spec = driven();
    let by_table = written(folder.path(), "table.json", &spec.to_string());
    let u = written(folder.path(), "u.csv", "t,u\n0,0.5\n3.14159,-1\n6,2\n");
    spec.as_object_mut().unwrap().remove("inputs");
    spec["hamiltonian"] = json!("x^2/2 + y^2/4 + z^2/6");
    spec["forces"] = json!({ "z": "piecewise(t < 3.14159: 1/2, t < 6: -1, 2)*x" });
    let by_force = written(folder.path(), "force.json", &spec.to_string());
    for pace in ["--step -0.1", "--step -1.3", "--tol 1e-11"] {
        let back = format!("--from 10 --until 0 {pace}");
        let one = lie(&format!("run {by_table} --input u={u} {back}")).ok();
        let other = lie(&format!("run {by_force} {back}")).ok();
        let off = apart(&last(&one), &last(&other), 3);
        assert!(off < 1e-8, "{pace}: {off:e}");
        if pace != "--step -1.3" {
            assert!(off < 1e-10, "{pace}: {off:e}");
        }
    }
}

/// Sites of a lattice share an input, members of an ensemble too.
#[test]
fn families_and_ensembles_go_back() {
    let folder = folder();
    let lattice = json!({
        "name": "Lattice",
        "algebra": "so(3)^N",
        "state": ["x[i]", "y[i]", "z[i]"],
        "parameters": { "N": 4 },
        "inputs": { "u": { "default": 0 } },
        "hamiltonian": "sum(i in 0..N: u*z[i] + x[i]*x[i+1]/2)",
        "initial": { "random": "unit-sphere", "seed": 3 },
        "run": { "method": "gauss16", "step": 0.1, "until": 4 }
    });
    let lattice = written(folder.path(), "lattice.json", &lattice.to_string());
    let u = written(folder.path(), "u.csv", "t,u\n0,1\n1,2\n2.5,-1\n");
    let out = lie(&format!("run {lattice} --input u={u}")).ok();
    let (first, end) = (out.csv().1.remove(0), last(&out));
    let start = from_row(&end, 12);
    for step in ["-0.1", "-0.3"] {
        let back = lie(&format!(
            "run {lattice} --input u={u} --from 4 --until 0 --step {step} {start}"
        ))
        .ok();
        let off = apart(&last(&back), &first, 12);
        assert!(off < 1e-10, "{step}: {off:e}");
    }
    let mut single = turning();
    single["events"] = json!({});
    let spec = written(folder.path(), "turning.json", &single.to_string());
    // members turn by -int u = 2.5 on their way
    let starts = written(
        folder.path(),
        "s.csv",
        "x,y,z\n1,0,0\n0,0.6,0.8\n0.6,0,0.8\n",
    );
    let file = folder.path().join("members.npy");
    let call = format!(
        "ensemble {spec} --input u={u} --initial-file {starts} --from 4 --step -0.4 --at 0 --out {}",
        file.display()
    );
    lie(&call).ok();
    let bytes = fs::read(&file).unwrap();
    let numbers = bytes[128..].chunks_exact(8);
    let ends: Vec<f64> = numbers
        .map(|one| f64::from_le_bytes(one.try_into().unwrap()))
        .collect();
    let (s, c) = 2.5_f64.sin_cos();
    let known = [c, s, 0.0, -0.6 * s, 0.6 * c, 0.8, 0.6 * c, 0.6 * s, 0.8];
    let off = ends.iter().zip(known).map(|(x, y)| (x - y).abs());
    assert!(
        ends.len() == 9 && off.fold(0.0, f64::max) < 1e-13,
        "{ends:?}"
    );
}

/// A run backwards that is taken up goes on as if it had not ended.
#[test]
fn a_run_backwards_is_taken_up() {
    let folder = folder();
    let mut spec = driven();
    spec["events"] = json!({});
    let spec = written(folder.path(), "driven.json", &spec.to_string());
    let u = written(folder.path(), "u.csv", "t,u\n0,0.5\n3.14159,-1\n6,2\n");
    let [rows, ck] = ["rows.csv", "run.ck"].map(|name| folder.path().join(name));
    let call = format!(
        "run {spec} --input u={u} --from 12 --until 0 --step -0.01 --out {} --checkpoint {} --checkpoint-every 1",
        rows.display(),
        ck.display()
    );
    assert_eq!(lie(&call).code, Some(0));
    let whole = fs::read(&rows).unwrap();
    let resumed = lie(&format!("resume {}", ck.display())).ok();
    assert!(
        resumed.stderr.contains("goes on from step "),
        "{}",
        resumed.stderr
    );
    assert!(fs::read(&rows).unwrap() == whole, "other rows");
}

/// Friction and its noise have one direction of time; either alone has two.
#[test]
fn a_temperature_goes_forwards_alone() {
    let folder = folder();
    let mut spec = json!({
        "name": "Spin",
        "algebra": "so(3)",
        "state": ["x", "y", "z"],
        "parameters": { "T": 0.3 },
        "hamiltonian": "z",
        "dissipation": [{ "kind": "double-bracket", "strength": 1, "temperature": "T" }],
        "initial": [0.6, 0, 0.8],
        "run": { "method": "lie-midpoint", "step": 0.1, "until": 10 }
    });
    let warm = written(folder.path(), "warm.json", &spec.to_string());
    for call in [
        format!("run {warm} --from 3 --until 0 --step -0.1"),
        format!("run {warm} --until -3"),
        format!("run {warm} --step -0.1 --at=-1,-2"),
        format!(
            "ensemble {warm} --members 4 --until -3 --step -0.1 --out {}",
            folder.path().join("e.npy").display()
        ),
    ] {
        let run = lie(&call);
        assert_eq!(run.code, Some(2), "{call}: {}", run.stderr);
        assert!(
            run.stderr
                .contains("has a temperature, and runs only forwards in time"),
            "{call}: {}",
            run.stderr
        );
    }
    lie(&format!("run {warm} --from -3 --until 0 --step 0.1")).ok();
    spec["dissipation"][0]
        .as_object_mut()
        .unwrap()
        .remove("temperature");
    let cold = written(folder.path(), "cold.json", &spec.to_string());
    let end = last(&lie(&format!("run {cold} --until 2")).ok());
    let start = from_row(&end, 3);
    let back = last(
        &lie(&format!(
            "run {cold} --from 2 --until 0 --step -0.1 {start}"
        ))
        .ok(),
    );
    assert!(apart(&back, &[0.0, 0.6, 0.0, 0.8], 3) < 1e-12, "{back:?}");
    spec["dissipation"] = json!([]);
    spec["noise"] = json!([{ "hamiltonian": "x/5" }]);
    let noisy = written(folder.path(), "noisy.json", &spec.to_string());
    lie(&format!("run {noisy} --until -3 --step -0.1")).ok();
}
