//! Damping, forces and noise on families at the command.

use std::fs;

use crate::common::{Run, folder, lie};
use serde_json::{Value, json};

/// Spins in a field, which do not know of each other.
fn free() -> Value {
    json!({
        "name": "Free",
        "algebra": "so(3)^N",
        "state": ["x[i]", "y[i]", "z[i]"],
        "parameters": { "N": 1500, "T": 0.3 },
        "hamiltonian": "sum(i in 0..N: z[i])",
        "dissipation": [{ "kind": "double-bracket", "strength": 1, "temperature": "T" }],
        "initial": { "random": "unit-sphere", "seed": 1 },
        "run": { "method": "gauss8", "step": 0.1, "at": [6, 9, 12] }
    })
}

/// An open chain of spins.
fn chain() -> Value {
    json!({
        "name": "Chain",
        "algebra": "so(3)^N",
        "state": ["x[i]", "y[i]", "z[i]"],
        "parameters": { "N": 301, "T": 0.5 },
        "hamiltonian": "-sum(i in 0..N-1: x[i]*x[i+1] + y[i]*y[i+1] + z[i]*z[i+1])",
        "dissipation": [{ "kind": "double-bracket", "strength": 1, "temperature": "T" }],
        "initial": { "random": "unit-sphere", "seed": 1 },
        "run": { "method": "gauss8", "step": 0.05, "at": [10, 14, 18, 22] }
    })
}

fn with(mut spec: Value, key: &str, value: Value) -> Value {
    spec[key] = value;
    spec
}

fn run(spec: &Value, options: &str) -> Run {
    let folder = folder();
    let path = folder.path().join("spec.json");
    fs::write(&path, spec.to_string()).unwrap();
    lie(&format!("run {} {options}", path.display()))
}

/// The mean of a unit vector along a field of strength 1/T.
fn langevin(temperature: f64) -> f64 {
    1.0 / (1.0 / temperature).tanh() - temperature
}

/// The mean of a column over all rows.
fn mean(run: &Run, column: &str) -> f64 {
    let (names, rows) = run.csv();
    let place = names.iter().position(|name| name == column).unwrap();
    rows.iter().map(|row| row[place]).sum::<f64>() / rows.len() as f64
}

#[test]
fn free_spins_have_the_mean_of_langevin() {
    let spec = free();
    let mean_at = |temperature: &str| {
        let value: f64 = temperature.parse().unwrap();
        // noise moves far in a step, and more so where it is warm; there it is soon in equilibrium
        let pace = match value > 0.7 {
            true => "--step 0.02 --at 2,3,4",
            false => "--step 0.1",
        };
        let options = format!("--param T={temperature} {pace}");
        let run = run(&spec, &options).ok();
        -mean(&run, "energy") / 1500.0
    };
    for temperature in [0.1_f64, 0.3, 0.6, 1.0, 3.0] {
        let mean = mean_at(&temperature.to_string());
        let expected = langevin(temperature);
        // of 1,500 spins at three times, of which each has a variance below 1/3
        let error = (1.0 / 3.0 / 4500.0_f64).sqrt();
        assert!(
            (mean - expected).abs() < 3.0 * error,
            "{temperature}: {mean} {expected}"
        );
    }
    // the control: another temperature is seen
    let mean = mean_at("0.4");
    assert!(
        (mean - langevin(0.3)).abs() > 3.0 * (1.0_f64 / 3.0 / 4500.0).sqrt(),
        "{mean}"
    );
}

#[test]
fn a_chain_has_its_energy_at_a_temperature() {
    let run = run(&chain(), "").ok();
    let energy = -mean(&run, "energy") / 300.0;
    // neighbours of an open chain are in the field of each other: Langevin's function of J/T (M. E. Fisher, 1964, doi:10.1119/1.1970340)
    assert!((energy - langevin(0.5)).abs() < 0.03, "{energy}");
    let (names, rows) = run.csv();
    let place = |name: &str| names.iter().position(|known| known == name).unwrap();
    for row in &rows {
        for name in ["C1_min", "C1_max"] {
            assert!((row[place(name)] - 1.0).abs() < 1e-13, "{name}");
        }
    }
}

#[test]
fn energy_and_work_balance_without_noise() {
    let cold = |spec: Value| {
        let entry = json!([{ "kind": "double-bracket", "strength": "1/4" }, { "kind": "rayleigh", "matrix": [["1/30", 0, 0], [0, "1/30", 0], [0, 0, "1/20"]] }]);
        let spec = with(spec, "dissipation", entry);
        with(
            spec,
            "forces",
            json!({ "x[i]": "x[i+1]/7 - x[i]/3", "y[i]": "-y[i]/3", "z[i]": "-z[i]/2" }),
        )
    };
    let spec = cold(with(chain(), "parameters", json!({ "N": 30 })));
    let balance = |method: &str| {
        let run = run(&spec, &format!("--method {method} --at 1,2,3,4")).ok();
        let (names, rows) = run.csv();
        let place = |name: &str| names.iter().position(|known| known == name).unwrap();
        let (energy, work) = (place("energy"), place("work"));
        assert_eq!(work, place("C1_max") + 1, "behind the Casimirs");
        let balances: Vec<f64> = rows.iter().map(|row| row[energy] - row[work]).collect();
        assert!((rows[0][work] - rows[1][work]).abs() > 0.1);
        balances
            .iter()
            .map(|b| (b - balances[0]).abs())
            .fold(0.0, f64::max)
    };
    let (gauss, rk4) = (balance("gauss16"), balance("rk4"));
    assert!(gauss < 1e-12, "{gauss}");
    assert!(rk4 > 1e-9, "the control: {rk4}");
}

#[test]
fn noise_is_told_by_its_seed() {
    let spec = with(free(), "parameters", json!({ "N": 20, "T": 0.3 }));
    let rows = |seed: &str| run(&spec, &format!("--seed {seed} --at 1")).ok().stdout;
    assert_eq!(rows("5"), rows("5"));
    assert_ne!(rows("5"), rows("6"));
    // a site has the noise of its own place, whatever there is beside it
    let said = run(&spec, "--seed 5 --at 1").ok().stderr;
    assert!(said.contains("noise with seed 5"), "{said}");
    let rk4 = run(&spec, "--method rk4 --seed 5 --step 0.001 --at 0.01").ok();
    let gauss = run(&spec, "--seed 5 --step 0.001 --at 0.01").ok();
    let (a, b) = (rk4.csv().1, gauss.csv().1);
    let pairs = a[0].iter().zip(&b[0]);
    let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-4, "the same noise: {apart}");
}

#[test]
fn a_run_goes_on_with_its_noise() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let spec = with(free(), "parameters", json!({ "N": 20, "T": 0.3 }));
    let spec = with(
        spec,
        "run",
        json!({ "method": "gauss8", "step": 0.1, "until": 4 }),
    );
    fs::write(path("spec.json"), spec.to_string()).unwrap();
    let (whole, part) = (path("whole.csv"), path("part.csv"));
    let checkpoint = path("part.checkpoint");
    let spec = path("spec.json");
    lie(&format!("run {spec} --out {whole}")).ok();
    let kept = format!("--checkpoint {checkpoint} --checkpoint-every 10");
    lie(&format!("run {spec} --until 2 --out {part} {kept}")).ok();
    let (whole, part) = (
        fs::read_to_string(whole).unwrap(),
        fs::read_to_string(part).unwrap(),
    );
    assert!(whole.starts_with(&part), "the same rows, as far as they go");
}

#[test]
fn what_cannot_act_on_a_site_is_refused_where_it_stands() {
    let refused = |key: &str, value: Value, expected: &[&str]| {
        let run = run(&with(free(), key, value), "--at 1");
        assert_eq!(run.code, Some(2), "{key}: {}", run.stderr);
        for text in expected {
            assert!(run.stderr.contains(text), "{text}: {}", run.stderr);
        }
    };
    refused(
        "forces",
        json!({ "x": "1" }),
        &["`x` is no coordinate of the state", "did you mean `x[i]`?"],
    );
    refused(
        "forces",
        json!({ "x[j]": "1" }),
        &["`x[j]` is no coordinate"],
    );
    refused(
        "forces",
        json!({ "x[i]": "-x" }),
        &["`x` is a coordinate of each site and needs an index"],
    );
    refused(
        "forces",
        json!({ "x[i]": "sum(i in 0..N: x[i])" }),
        &["depends on it and on sites near by"],
    );
    refused(
        "noise",
        json!([{ "hamiltonian": "x[i]*x[i+1]" }]),
        &["depends on other sites", "sigma*z[i]"],
    );
    refused(
        "dissipation",
        json!([{ "kind": "metriplectic", "entropy": "z[i]", "metric": [[1, 0, 0], [0, 1, 0], [0, 0, 1]] }]),
        &["acts at each site, where H is shared"],
    );
    refused(
        "dissipation",
        json!([{ "kind": "double-bracket", "strength": 1, "temperature": -1 }]),
        &["the temperature is -1"],
    );
    refused(
        "dissipation",
        json!([{ "kind": "double-bracket", "strength": "x[i]" }]),
        &["x[i]"],
    );
    let split = run(&free(), "--method splitting2");
    assert!(
        split.stderr.contains("a double bracket damps")
            && split.stderr.contains("`gauss16` or `rk4`"),
        "{}",
        split.stderr
    );
}

#[test]
fn observables_are_functions_of_sums() {
    let observables = json!({
        "m": "sum(i in 0..N: z[i])/N",
        "part": "sum(i in 2..N-1: z[i])",
        "bonds": "-sum(i in 0..N-1: x[i]*x[i+1] + y[i]*y[i+1] + z[i]*z[i+1])",
        "phi": { "expression": "atan2(sum(i in 0..N: y[i]), sum(i in 0..N: x[i]))", "unwrap": true }
    });
    let spec = with(free(), "observables", observables);
    let spec = with(spec, "parameters", json!({ "N": 40, "T": 0.3 }));
    for (spec, first) in [
        (spec.clone(), "work"),
        (with(spec, "dissipation", json!([])), "C1_max"),
    ] {
        let run = run(&spec, "--at 0,1,2,20 --step 0.05").ok();
        let (names, rows) = run.csv();
        let place = |name: &str| names.iter().position(|known| known == name).unwrap();
        assert_eq!(place("bonds"), place(first) + 1);
        for row in &rows {
            let site = |k: usize, i: usize| row[1 + 40 * k + i];
            let m = (0..40).map(|i| site(2, i)).sum::<f64>() / 40.0;
            let bond = |i: usize| (0..3).map(|k| site(k, i) * site(k, i + 1)).sum::<f64>();
            let bonds = -(0..39).map(bond).sum::<f64>();
            let sum = |k: usize| (0..40).map(|i| site(k, i)).sum::<f64>();
            let phi = sum(1).atan2(sum(0));
            let turned = (row[place("phi")] - phi) / std::f64::consts::TAU;
            let part = (2..39).map(|i| site(2, i)).sum::<f64>();
            assert!((row[place("m")] - m).abs() < 1e-14);
            assert!(
                (row[place("part")] - part).abs() < 1e-14,
                "over these sites alone"
            );
            assert!((row[place("bonds")] - bonds).abs() < 1e-13);
            assert!((turned - turned.round()).abs() < 1e-12, "{turned}");
            // the energy has sums of its own
            let energy = row[place("energy")];
            assert!((energy - 40.0 * m).abs() < 1e-12, "{energy}");
        }
        let phi = rows[3][place("phi")] - rows[0][place("phi")];
        assert!(first == "work" || phi.abs() > 12.0, "counted turns: {phi}");
    }
    let checked = lie("check tests/data/families/damped_chain.json")
        .ok()
        .stdout;
    assert!(
        checked.contains("magnetisation = sum(i in 0..N: z[i])/N"),
        "{checked}"
    );
}

#[test]
fn bonds_of_a_file_join_sites_that_there_are() {
    let net = "tests/data/bonds/net.json";
    let run = lie(&format!("run {net} --at 2")).ok();
    let (_, rows) = run.csv();
    let bonds = fs::read_to_string("tests/data/bonds/net.csv").unwrap();
    let bonds: Vec<Vec<f64>> = (bonds.lines().skip(1))
        .map(|line| {
            line.split(',')
                .map(|number| number.parse().unwrap())
                .collect()
        })
        .collect();
    let site = |k: usize, i: f64| rows[0][1 + 9 * k + i as usize];
    let energy = |bond: &Vec<f64>| {
        let product = |k: usize| site(k, bond[0]) * site(k, bond[1]);
        -bond[2] * (0..3).map(product).sum::<f64>()
    };
    let expected: f64 = bonds.iter().map(energy).sum();
    assert!((rows[0][28] - expected).abs() < 1e-14, "{expected}");
    let few = lie(&format!("run {net} --param N=5 --at 2"));
    let few = few.error("domain", "command line: --param");
    assert!(few.stderr.contains("there are 5 sites"), "{}", few.stderr);
    let split = lie(&format!("run {net} --method splitting2"));
    assert!(split.stderr.contains("are in no order"), "{}", split.stderr);
}

/// Two spins and a bond that is not symmetric, with the index that is given.
fn pair(index: &str) -> Value {
    let state = ["x", "y", "z"].map(|name| format!("{name}[{index}]"));
    json!({
        "name": "Pair",
        "algebra": "so(3)^N",
        "state": state,
        "parameters": { "N": 2 },
        "bonds": [[0, 1, 2]],
        "hamiltonian": "sum(bonds: value*z[i]^2*x[j])",
        "initial": { "random": "unit-sphere", "seed": 3 },
        "run": { "method": "gauss8", "step": 0.1, "at": [0, 1] }
    })
}

#[test]
fn the_sites_of_a_bond_are_i_and_j_whatever_the_index_of_the_state() {
    let runs = ["i", "j", "k"].map(|index| run(&pair(index), "").ok().csv().1);
    assert_eq!(runs[0], runs[1]);
    assert_eq!(runs[0], runs[2]);
    let row = &runs[0][0];
    assert!(
        (row[7] - 2.0 * row[5] * row[5] * row[2]).abs() < 1e-15,
        "{row:?}"
    );
    let refused = |spec: &Value, expected: &str| {
        let found = run(spec, "");
        assert_eq!(found.code, Some(2), "{}", found.stderr);
        assert!(
            found.stderr.contains(expected),
            "{expected}: {}",
            found.stderr
        );
    };
    let spec = pair("i");
    let of = |key: &str, value: Value| with(spec.clone(), key, value);
    refused(
        &of("hamiltonian", json!("sum(bonds: x[i]*x[k])")),
        "`x[k]` is of no site of the bond",
    );
    refused(
        &of("parameters", json!({ "N": 2, "value": 3 })),
        "`value` is the number of a bond",
    );
    refused(
        &of("bonds", json!([[0, 0, 1]])),
        "joins the site 0 to itself",
    );
    refused(
        &of("bonds", json!([[0, 1]])),
        "a bond is two sites and a number",
    );
    refused(
        &of("hamiltonian", json!("sum(bonds in 0..N: x[bonds])")),
        "`bonds` is the word for bonds",
    );
    let unused = run(&of("hamiltonian", json!("sum(i in 0..N: x[i])")), "").ok();
    assert!(
        unused.stderr.contains("no sum goes over the bonds"),
        "{}",
        unused.stderr
    );
    let given = run(&spec, "--param bonds=3");
    assert!(
        given.stderr.contains("no option changes them"),
        "{}",
        given.stderr
    );
}

#[test]
fn columns_have_names_of_their_own() {
    let spec = with(
        free(),
        "observables",
        json!({ "C1_mean": "sum(i in 0..N: z[i])/N" }),
    );
    let (names, _) = run(&spec, "--param N=3 --at 1").ok().csv();
    assert!(names.contains(&"C2_mean".to_owned()), "{names:?}");
    let of_names = names.iter().filter(|name| *name == "C1_mean");
    assert_eq!(of_names.count(), 1, "{names:?}");
}

#[test]
fn what_does_not_apply_to_driven_families_is_not_offered() {
    let kept = run(
        &free(),
        "--param N=3 --param T=0 --method rk4 --at 1 --keep energy",
    );
    let kept = kept.error("option", "command line: --keep");
    assert!(
        kept.stderr.contains("more than H acts on Free"),
        "{}",
        kept.stderr
    );
    let folder = folder();
    let path = folder.path().join("spec.json");
    fs::write(&path, free().to_string()).unwrap();
    let checked = lie(&format!("check {} --json", path.display())).ok().stdout;
    let checked: Value = serde_json::from_str(&checked).unwrap();
    assert!(
        checked["methods"]["compose4"].is_string(),
        "{}",
        checked["methods"]
    );
    let chain = lie("check tests/data/families/heisenberg_chain.json --json")
        .ok()
        .stdout;
    let chain: Value = serde_json::from_str(&chain).unwrap();
    assert!(
        chain["methods"]["compose4"].is_null(),
        "{}",
        chain["methods"]
    );
}

/// The noise of each site counts where a measurement has a limit: what the remedy says is measured.
#[test]
fn so_many_noisy_sites_are_measured_as_the_remedy_says() {
    let folder = folder();
    let path = folder.path().join("spec.json");
    fs::write(&path, free().to_string()).unwrap();
    let verify = |flags: &str| lie(&format!("verify {} {flags}", path.display()));
    for sites in [30, 11] {
        let run = verify(&format!("--param N={sites}")).error("limit", "command line: --param");
        let remedy = "measure fewer sites, at most 10, as with";
        assert!(run.stderr.contains(remedy), "{}", run.stderr);
    }
    let measured = verify("--param N=10 --methods rk4");
    assert!(
        !measured.stderr.contains("error[limit]"),
        "{}",
        measured.stderr
    );
}
