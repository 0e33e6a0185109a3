//! Families that depend on the time and on inputs, at the command.

use std::fs;
use std::path::Path;

use crate::common::{Run, folder, lie};
use crate::resuming::{forged, within};
use serde_json::{Value, json};

/// Spins on an open chain in a rotating field, with an exchange and friction that somebody sets.
fn chain() -> Value {
    json!({
        "name": "Chain",
        "algebra": "so(3)^N",
        "state": ["x[i]", "y[i]", "z[i]"],
        "parameters": { "N": 3, "B": "1/2", "w": "3/2", "a": ["1/10", "1/5", 0] },
        "inputs": { "u": { "default": "1/3", "sampling": "1/4" }, "v": { "default": 0 } },
        "hamiltonian": "-(1 + u)*sum(i in 0..N-1: x[i]*x[i+1] + y[i]*y[i+1] + 2*z[i]*z[i+1]) - sum(i in 0..N: B*cos(w*t)*x[i] + B*sin(w*t)*y[i])",
        "forces": { "z[i]": "-v*z[i]/10" },
        "dissipation": [{ "kind": "double-bracket", "strength": "a[i]*(1 + sin(t)/2)" }],
        "observables": { "along": "sum(i in 0..N: x[i]*cos(w*t) + y[i]*sin(w*t))/N" },
        "initial": { "random": "unit-sphere", "seed": 1 },
        "run": { "method": "gauss8", "step": 0.05, "until": 10, "every": 40 }
    })
}

/// The same chain without its dissipation, written out as one system.
fn three() -> Value {
    let sites = ["0", "1", "2"];
    let field: Vec<String> = sites
        .iter()
        .map(|i| format!("B*cos(w*t)*x{i} + B*sin(w*t)*y{i}"))
        .collect();
    let state: Vec<String> = sites
        .iter()
        .flat_map(|i| ["x", "y", "z"].map(|name| format!("{name}{i}")))
        .collect();
    json!({
        "name": "Three",
        "algebra": "so(3)^3",
        "state": state,
        "parameters": { "B": "1/2", "w": "3/2" },
        "inputs": { "u": { "default": "1/3", "sampling": "1/4" }, "v": { "default": 0 } },
        "hamiltonian": format!(
            "-(1 + u)*(x0*x1 + y0*y1 + 2*z0*z1 + x1*x2 + y1*y2 + 2*z1*z2) - ({})", field.join(" + ")
        ),
        "forces": { "z0": "-v*z0/10", "z1": "-v*z1/10", "z2": "-v*z2/10" },
        "run": { "method": "gauss8", "step": 0.05, "until": 10, "every": 40 }
    })
}

const U: &str = "t,u\n0,0.5\n3.14159,-1\n6,2\n";
const V: &str = "t,v\n0,1\n0.33,2\n7.5,0\n";

fn written(folder: &Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    fs::write(&path, text).unwrap();
    path.display().to_string()
}

fn place(names: &[String], name: &str) -> usize {
    names.iter().position(|known| known == name).unwrap()
}

/// The largest change of energy - work along a run.
fn imbalance(run: &Run) -> f64 {
    let (names, rows) = run.csv();
    let (energy, work) = (place(&names, "energy"), place(&names, "work"));
    let balances = rows.iter().map(|row| row[energy] - row[work]);
    let balances: Vec<f64> = balances.collect();
    let changes = balances.iter().map(|b| (b - balances[0]).abs());
    changes.fold(0.0, f64::max)
}

#[test]
fn tables_set_a_family_as_they_set_one_system() {
    let folder = folder();
    let mut spec = chain();
    spec.as_object_mut().unwrap().remove("dissipation");
    spec["parameters"].as_object_mut().unwrap().remove("a");
    let family = written(folder.path(), "family.json", &spec.to_string());
    let single = written(folder.path(), "single.json", &three().to_string());
    let tables = [("u", U), ("v", V)]
        .map(|(name, text)| {
            format!(
                "--input {name}={}",
                written(folder.path(), &format!("{name}.csv"), text)
            )
        })
        .join(" ");
    let (names, rows) = lie(&format!("run {family} {tables} --at 0")).ok().csv();
    assert_eq!(rows.len(), 1);
    let at = |k: usize, i: usize| rows[0][place(&names, &format!("{}[{i}]", ["x", "y", "z"][k]))];
    let start: Vec<String> = (0..9).map(|k| format!("{:?}", at(k % 3, k / 3))).collect();
    let start = start.join(",");
    for method in ["gauss8", "rk4", "dopri5"] {
        let of_family = lie(&format!("run {family} {tables} --method {method}")).ok();
        let of_single = lie(&format!(
            "run {single} {tables} --method {method} --initial={start}"
        ))
        .ok();
        let ((names, rows), (others, theirs)) = (of_family.csv(), of_single.csv());
        assert_eq!(rows.len(), theirs.len());
        let behind = |names: &[String]| names[place(names, "work")..].to_vec();
        assert_eq!(behind(&names), ["work", "along", "u", "v"]);
        assert_eq!(behind(&others), ["work", "u", "v"]);
        for (row, other) in rows.iter().zip(&theirs) {
            for k in 0..9 {
                let difference = row[1 + k % 3 * 3 + k / 3] - other[1 + k];
                assert!(
                    difference.abs() < 1e-11,
                    "{method} t = {}: {difference}",
                    row[0]
                );
            }
            for name in ["energy", "work", "u", "v"] {
                let difference = row[place(&names, name)] - other[place(&others, name)];
                assert!(difference.abs() < 1e-11, "{method} {name}: {difference}");
            }
        }
    }
    let with = lie(&format!("run {family} {tables}")).ok().csv().1;
    let without = lie(&format!("run {family}")).ok().csv().1;
    let apart = (1..10).map(|k| (with[3][k] - without[3][k]).abs());
    assert!(apart.fold(0.0, f64::max) > 0.1, "the control");
}

#[test]
fn energy_and_work_balance_in_a_long_run() {
    let folder = folder();
    let spec = written(folder.path(), "chain.json", &chain().to_string());
    let u = written(folder.path(), "u.csv", U);
    let balance = |method: &str| {
        imbalance(
            &lie(&format!(
                "run {spec} --input u={u} --method {method} --until 300"
            ))
            .ok(),
        )
    };
    let (gauss, rk4) = (balance("gauss16"), balance("rk4"));
    assert!(gauss < 1e-11, "{gauss}");
    assert!(rk4 > 1e-7, "the control: {rk4}");
}

#[test]
fn a_run_goes_on_with_its_time_and_inputs() {
    let folder = folder();
    let here = folder.path();
    let mut spec = chain();
    spec["noise"] = json!([{ "hamiltonian": "a[i]*cos(t)*x[i]" }]);
    written(here, "chain.json", &spec.to_string());
    written(here, "u.csv", U);
    for method in ["gauss8", "rk4"] {
        let call = format!(
            "run chain.json --input u=u.csv --method {method} --step 0.005 --until 7 --every 70"
        );
        within(
            here,
            &format!("{call} --out rows.csv --checkpoint {method}.ck --checkpoint-every 1"),
        )
        .ok();
        let rows = fs::read_to_string(here.join("rows.csv")).unwrap();
        let resumed = within(here, &format!("resume {method}.ck")).ok();
        assert!(
            resumed.stderr.contains("goes on from step 1000, t = 5"),
            "{}",
            resumed.stderr
        );
        assert!(
            fs::read_to_string(here.join("rows.csv")).unwrap() == rows,
            "{method}: other rows"
        );
        // the control: a checkpoint with another input
        forged(&here.join(format!("{method}.ck")), |content| {
            let state = content["place"]["milestone"]["state"]
                .as_array_mut()
                .unwrap();
            // nine coordinates, the time with its momentum and the unit, then the inputs
            let bits = state[13].as_u64().unwrap();
            assert_eq!(f64::from_bits(bits), 0.0, "v is 0");
            state[13] = 1.0_f64.to_bits().into();
        });
        within(here, &format!("resume {method}.ck")).ok();
        assert!(
            fs::read_to_string(here.join("rows.csv")).unwrap() != rows,
            "{method}: the control"
        );
    }
}

#[test]
fn what_depends_on_the_time_is_refused_where_it_cannot_be() {
    let run = |spec: &Value, flags: &str| {
        let folder = folder();
        let spec = written(folder.path(), "spec.json", &spec.to_string());
        lie(&format!("run {spec} {flags}"))
    };
    let refused = |key: &str, value: Value, expected: &[&str]| {
        let mut spec = chain();
        spec[key] = value;
        let run = run(&spec, "--at 1");
        assert_eq!(run.code, Some(2), "{key}: {}", run.stderr);
        for text in expected {
            assert!(run.stderr.contains(text), "{text}: {}", run.stderr);
        }
    };
    refused(
        "inputs",
        json!({ "u": { "default": 0, "sampling": 0 }, "v": { "default": 0 } }),
        &[
            "error[input]",
            "`u` is sampled every 0",
            "a time that is positive",
        ],
    );
    refused(
        "inputs",
        json!({ "u": { "default": 0 }, "v": { "default": 0 }, "B": { "default": 0 } }),
        &["`B`", "name of a parameter"],
    );
    refused(
        "dissipation",
        json!([{ "kind": "double-bracket", "strength": "a[i] - 1/20" }]),
        &["the strength is -0.05", "not negative"],
    );
    refused(
        "dissipation",
        json!([{ "kind": "double-bracket", "strength": "1/5", "temperature": "cos(t)" }]),
        &["`t` is the time, which cannot stand here"],
    );
    refused(
        "dissipation",
        json!([{ "kind": "double-bracket", "strength": "a" }]),
        &["`a` has a value for each site and needs an index"],
    );
    let mut free = chain();
    for key in ["dissipation", "forces", "inputs"] {
        free.as_object_mut().unwrap().remove(key);
    }
    free["hamiltonian"] = json!("-sum(i in 0..N: x[i]*x[i+1] + cos(w*t)*z[i])");
    let kept = run(&free, "--method rk4 --at 1 --keep energy").stderr;
    assert!(
        kept.contains("changes with the time, and only motion by H alone keeps the energy"),
        "{kept}"
    );
    // the energy varies, and there is no column of work, as of single systems
    let said = run(&free, "--method rk4 --at 1").ok();
    assert!(!said.csv().0.contains(&"work".to_owned()));
}

#[test]
fn a_check_says_what_is_carried() {
    let checked = lie("check tests/data/families/driven_chain.json")
        .ok()
        .stdout;
    for text in ["beside the sites: t, u, v", "v^2*alpha[i]*", "cos(t)"] {
        assert!(checked.contains(text), "{text}: {checked}");
    }
    assert!(!checked.contains("H never grows"), "{checked}");
    let pieces = lie("check tests/data/families/noisy_ring.json").ok().stdout;
    for text in [
        "H with what acts is 7 pieces with exact flows at each site",
        "exchange with [+1]",
        "friction",
        "noise along z",
        "noise along a direction",
        "noise as a force",
    ] {
        assert!(pieces.contains(text), "{text}: {pieces}");
    }
}

/// Splittings take what changes with the time and with inputs, friction and noise: `energy - work` stays near its value, and does not drift.
#[test]
fn splittings_follow_tables_and_balance() {
    let folder = folder();
    let mut spec = chain();
    spec.as_object_mut().unwrap().remove("dissipation");
    spec["parameters"].as_object_mut().unwrap().remove("a");
    let spec = written(folder.path(), "chain.json", &spec.to_string());
    let u = written(folder.path(), "u.csv", U);
    let end = |method: &str, step: f64| {
        let run = lie(&format!(
            "run {spec} --input u={u} --method {method} --step {step} --at 3"
        ));
        run.ok().csv().1[0][1..10].to_vec()
    };
    let exact = end("gauss16", 0.01);
    let error = |step: f64| {
        let errors = end("splitting2", step).into_iter().zip(&exact);
        errors.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
    };
    let order = (error(0.02) / error(0.01)).log2();
    assert!((order - 2.0).abs() < 0.3, "{order}");
    let long = format!("run {spec} --input u={u} --method splitting2 --every 10");
    let [short, long] = [50, 300].map(|t| imbalance(&lie(&format!("{long} --until {t}")).ok()));
    assert!(long < 0.1 && long < 1.5 * short, "{short} {long}");
}
