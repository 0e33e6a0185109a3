//! `lie verify`: claims against measurements.

use crate::common::{command, folder, lie, spec};

#[test]
fn all_claims_of_a_few_methods_hold() {
    claims_hold("");
}

#[test]
#[ignore = "a minute, it builds a program: .ci/nightly runs it"]
fn all_claims_hold_in_a_program_of_its_own() {
    claims_hold("--compile");
}

fn claims_hold(flags: &str) {
    let run = lie(&format!(
        "verify specs/so3_nonpolynomial.json --methods midpoint,lie-midpoint,rk4,dopri5 --quiet {flags}"
    ))
    .ok();
    assert!(run.stderr.is_empty(), "{}", run.stderr);
    let line = |name: &str| {
        let found = run.stdout.lines().find(|line| line.starts_with(name));
        found
            .unwrap_or_else(|| panic!("{name} in {}", run.stdout))
            .to_owned()
    };
    assert!(line("midpoint ").contains("2: 2.00 ✓"), "{}", run.stdout);
    // an id stands for every option that applies
    assert!(line("lie-midpoint --retraction cayley").contains('✓'));
    assert!(run.stdout.contains(" claims, 0 fail\n"));
    // what is not claimed of a method stands below the table
    for line in [
        "these hold too, each with the number of methods: ",
        " of the allowed round-off away from the declaration as written; the reference solution differs by ",
    ] {
        let words: Vec<&str> = run.stdout.split_whitespace().collect();
        assert!(words.join(" ").contains(line), "{}", run.stdout);
    }
}

/// A Hamiltonian by Newton's iteration, and a discrete Lagrangian: every claim of the methods that they add holds.
#[test]
fn systems_by_lagrangians() {
    for (spec, methods, orders) in [
        (
            "specs/so3_quartic_lagrangian",
            "variational2,variational4,variational6,lie-midpoint,generating4",
            [
                ("variational2 ", "2: 2.00 ✓"),
                ("variational4 ", "4: "),
                ("variational6 ", "6: "),
            ],
        ),
        (
            "specs/so3_discrete_lagrangian",
            "discrete-euler-poincare,variational2,variational4,moser-veselov",
            [
                ("discrete-euler-poincare ", "1: 2.00 ✓"),
                ("variational4 ", "4: "),
                ("moser-veselov ", "2: 2.00 ✓"),
            ],
        ),
    ] {
        let run = lie(&format!("verify {spec}.json --methods {methods} --quiet")).ok();
        for (name, order) in orders {
            let line = run.stdout.lines().find(|line| line.starts_with(name));
            assert!(
                line.is_some_and(|line| line.contains(order)),
                "{name}: {}",
                run.stdout
            );
        }
        assert!(run.stdout.contains(" claims, 0 fail\n"), "{}", run.stdout);
    }
}

/// A Lagrangian of group element and time that is not quadratic: the energy of the command is that of the declared H, without the momentum of
/// the time, and a variational method stays near `gauss16`.
#[test]
fn a_lagrangian_on_a_group_is_integrated() {
    let path = "tests/data/lagrangian/on_group.json";
    let last = |flags: &str| {
        let run = lie(&format!("run {path} --until 1 --quiet {flags}")).ok();
        let (header, rows) = run.csv();
        let place = header
            .iter()
            .position(|name| name == "energy")
            .expect("a column");
        let row = rows.last().expect("rows").clone();
        (row[place], row)
    };
    let (energy, exact) = last("--method gauss16 --step 0.1");
    let (_, near) = last("--method variational4 --step 0.05");
    let error = exact
        .iter()
        .zip(&near)
        .fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    assert!((1e-12..1e-3).contains(&error), "{error:e}");
    let [x, y, z] = [1, 2, 3].map(|k| exact[k]);
    let [r13, r33] = [3, 9].map(|k| exact[3 + k]);
    let speed = (1.0 + ((x - 0.4 * r13).powi(2) + y * y / 2.0 + 2.0 * z * z) / 1.5625).sqrt();
    let closed = 1.5625 * speed + (1.0 + 1.0_f64.cos() / 5.0) * r33;
    assert!((energy - closed).abs() < 1e-13, "{energy} {closed}");
}

/// The angle in its Casimir jumps, which is no fault of a method; the orbit is measured all the same.
#[test]
fn a_casimir_with_several_branches_fails_no_method() {
    let spec = "tests/data/declarations/pass/casimir_with_several_branches.json";
    let run = lie(&format!("verify {spec} --methods lie-midpoint --quiet")).ok();
    assert!(run.stdout.contains(" claims, 0 fail\n"), "{}", run.stdout);
}

#[test]
fn as_json() {
    let run = lie("verify specs/so3_nonpolynomial.json --methods midpoint,lie-midpoint,rk4,dopri5 --quiet --json --seed 4").ok();
    let value: serde_json::Value = serde_json::from_str(&run.stdout).expect("JSON");
    assert_eq!(value["failed"], 0);
    assert_eq!(value["interrupted"], false);
    let order = &value["methods"]["rk4"]["order"];
    assert_eq!(order["claim"], 4.0);
    assert!((order["measured"].as_f64().expect("a number") - 4.0).abs() < 0.3);
    assert_eq!(value["methods"]["rk4"]["energy"]["verdict"], "not-claimed");
    assert!(
        value["methods"]["rk4"]["energy"]["measured"].as_f64() > Some(1e-9),
        "it drifts"
    );
}

/// What is measured of a method on a spec with noise, as `lie verify --json` says it.
fn on_noise(spec: &serde_json::Value, method: &str) -> serde_json::Value {
    let folder = folder();
    let path = folder.path().join("noise.json");
    std::fs::write(&path, spec.to_string()).expect("it is written");
    let call = format!(
        "verify {} --methods {method} --quiet --json",
        path.display()
    );
    let run = lie(&call).ok();
    assert_eq!(run.stdout, lie(&call).ok().stdout, "the same seed");
    let value: serde_json::Value = serde_json::from_str(&run.stdout).expect("JSON");
    value["methods"][method].clone()
}

/// That an order is claimed and found, within three standard errors and a tenth.
fn has_order(found: &serde_json::Value, fact: &str, order: f64) {
    let found = &found[fact];
    let number = |key: &str| {
        found[key]
            .as_f64()
            .unwrap_or_else(|| panic!("{fact}: {found}"))
    };
    assert_eq!(found["verdict"], "holds", "{fact}: {found}");
    assert_eq!(number("claim"), order, "{fact}: {found}");
    let far = (number("measured") - order).abs();
    assert!(far < 0.1 + 3.0 * number("error"), "{fact}: {found}");
}

/// A spin at a temperature: three noises that do not commute, and the density of Langevin.
#[test]
fn a_thermal_spin_has_its_orders_and_its_density() {
    let spec = serde_json::json!({
        "name": "Spin", "algebra": "so(3)", "state": ["x", "y", "z"], "hamiltonian": "z",
        "parameters": { "T": 0.3 },
        "dissipation": [{ "kind": "double-bracket", "strength": "1", "temperature": "T" }],
        "initial": [0.6, 0, 0.8]
    });
    for method in ["lie-midpoint", "spherical-midpoint"] {
        let found = on_noise(&spec, method);
        has_order(&found, "strong order", 0.5);
        has_order(&found, "weak order", 1.0);
        for fact in ["mean energy", "mean coordinates"] {
            assert_eq!(found[fact]["verdict"], "holds", "{found}");
            assert!(found[fact]["measured"].as_f64() < Some(0.02), "{found}");
        }
        // what the quadrature says of H is the function of Langevin, T - coth(1/T)
        let note = found["mean energy"]["note"].as_str().expect("a note");
        assert!(note.contains("where -0.7025 is exact"), "{note}");
    }
}

/// Noises that commute have order 1 in the mean square: constant forces, of a temperature over the whole space.
#[test]
fn a_warm_body_has_order_one_and_the_density_of_gauss() {
    let spec = serde_json::json!({
        "name": "Warm", "algebra": "so(3)", "state": ["x", "y", "z"],
        "hamiltonian": "x^2/2 + y^2 + z^2/4",
        "dissipation": [{ "kind": "rayleigh", "matrix": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "temperature": "1/2" }],
        "initial": [0.6, -0.5, 0.7]
    });
    let found = on_noise(&spec, "rk4");
    has_order(&found, "strong order", 1.0);
    // its means are so good that the samples do not resolve their error
    assert_ne!(found["weak order"]["verdict"], "fails", "{found}");
    assert_eq!(found["mean energy"]["verdict"], "holds", "{found}");
    let note = found["mean energy"]["note"].as_str().expect("a note");
    assert!(note.contains("where 0.7500 is exact"), "3/2 T: {note}");
}

/// Where another noise acts too no density is known, and the reason is said.
#[test]
fn a_density_that_is_not_known_is_not_measured() {
    let spec = serde_json::json!({
        "name": "Driven", "algebra": "so(3)", "state": ["x", "y", "z"], "hamiltonian": "z + x^2/4",
        "dissipation": [{ "kind": "double-bracket", "strength": "1", "temperature": "1/2" }],
        "noise": [{ "hamiltonian": "x/5" }],
        "initial": [0.6, 0, 0.8]
    });
    let found = on_noise(&spec, "rk4");
    let mean = &found["mean energy"];
    assert_eq!(mean["verdict"], "absent", "{found}");
    assert_eq!(mean["note"], "something without a temperature acts too");
}

#[test]
fn wrong_options() {
    let verify = |rest: &str| lie(&format!("verify specs/so3_free_rigid_body.json {rest}"));
    verify("--methods midpoint,midpont").error("method", "command line: --methods");
    verify("--methods").error("option", "command line: --methods");
    verify("--step 0").error("option", "command line: --step");
    verify("--step x").error("number", "command line: --step");
    verify("--seed -1").error("option", "command line: --seed");
    verify("--initial 1,2").error("state-length", "command line: --initial");
    verify("--param I9=2").error("option", "command line: --param");
    lie("verify").error("option", "command line: SPEC");
    let option = [
        "verify",
        "specs/so3_free_rigid_body.json",
        "--methods",
        "rk4 --retraction exp",
    ];
    crate::common::Run::from(command(option).output().expect("lie starts"))
        .error("method", "command line: --methods");
    let foreign = [
        "verify",
        "specs/heisenberg_h3.json",
        "--methods",
        "splitting2,rk4 --x y",
    ];
    crate::common::Run::from(command(foreign).output().expect("lie starts"))
        .error("method", "command line: --methods");
}

#[test]
fn a_system_at_rest_cannot_be_measured() {
    let folder = folder();
    let path = spec(folder.path(), |spec| spec["hamiltonian"] = "1".into());
    let run: crate::common::Run = command([
        "verify".as_ref(),
        path.as_os_str(),
        "--methods".as_ref(),
        "rk4".as_ref(),
    ])
    .output()
    .expect("lie starts")
    .into();
    let run = run.error("domain", "command line: --initial");
    assert!(run.stderr.contains("is zero"), "{}", run.stderr);
}

/// `lie verify` with a program in the place of the built one, which says that it has found this.
#[cfg(unix)]
fn with_program(found: &[serde_json::Value]) -> crate::common::Run {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = folder();
    let path = spec(folder.path(), |spec| spec["name"] = "Lied".into());
    let script = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, format!("#!/bin/sh\n{text}\n")).expect("the script is written");
        let permissions = std::fs::Permissions::from_mode(0o755);
        std::fs::set_permissions(&path, permissions).expect("it can be run");
        path
    };
    let end = serde_json::json!({ "end": "done" });
    let said = found
        .iter()
        .map(|found| serde_json::json!({ "found": found }));
    let said: String = said
        .chain([end])
        .map(|message| format!("printf '%s\\n' '{message}'\n"))
        .collect();
    let program = script("program", &format!("read -r request\n{said}"));
    let cargo = script(
        "cargo",
        &format!(
            "name=$(sed -n '/bin/,$s/^name = \"\\(.*\\)\"/\\1/p' Cargo.toml)\n\
             echo \"{{\\\"target\\\":{{\\\"name\\\":\\\"$name\\\"}},\\\"executable\\\":\\\"{}\\\"}}\"",
            program.display()
        ),
    );
    command([
        "verify".as_ref(),
        path.as_os_str(),
        "--compile".as_ref(),
        "--methods".as_ref(),
        "rk4".as_ref(),
    ])
    .env("CARGO", cargo)
    .env("LIE_CACHE_DIR", folder.path().join("cache"))
    .output()
    .expect("lie starts")
    .into()
}

/// A measurement of `rk4`.
#[cfg(unix)]
fn finding(fact: &str, claim: f64, measured: f64, bound: f64, verdict: &str) -> serde_json::Value {
    serde_json::json!({ "finding": { "method": "rk4", "finding": {
        "fact": fact, "claim": claim, "measured": measured, "bound": bound,
        "verdict": verdict, "step": 0.1, "note": "",
    } } })
}

#[test]
#[cfg(unix)]
fn a_claim_that_fails_is_exit_code_1() {
    let run = with_program(&[
        finding("order", 4.0, 4.01, 3.7, "holds"),
        finding("symmetric", 0.0, 1e-7, 1e-14, "fails"),
    ]);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    assert!(
        run.stderr.contains(
            "failed: rk4: symmetric is claimed, 1.0e-7 was measured, where at most 1.0e-14 holds"
        ),
        "{}",
        run.stderr
    );
    assert!(
        run.stdout.contains("4: 4.01 ✓") && run.stdout.contains("1.0e-7 ✗"),
        "{}",
        run.stdout
    );
}

/// Every claim holds, and still: a kernel computes something else, a measurement is blind, nothing is shown.
#[test]
#[cfg(unix)]
fn the_program_is_judged_by_the_declaration() {
    let kernel = |name: &str| {
        serde_json::json!({ "kernel": {
            "name": name, "arguments": [[0.1, 0.2, 0.3]], "values": [1e9], "gradient": [0.0, 0.0, 0.0],
        } })
    };
    for (found, complaint) in [
        (
            Some(kernel("energy")),
            "failed: energy: entry 0 is 1000000000.0, and ",
        ),
        (
            Some(serde_json::json!({ "broken": { "fact": "Poisson" } })),
            "failed: Poisson: a spoiled map passes, the measurement says nothing",
        ),
        (
            Some(serde_json::json!({ "unsound": { "what": "fixed-point iteration" } })),
            "failed: fixed-point iteration: an equation with a known solution is not solved correctly",
        ),
        (
            Some(kernel("novel")),
            "failed: novel: the judge does not know it",
        ),
        (None, "failed: ad_star_matrix: the judge has not seen it"),
    ] {
        let holds = finding("order", 4.0, 4.01, 3.7, "holds");
        let all: Vec<_> = [holds].into_iter().chain(found).collect();
        let run = with_program(&all);
        assert_eq!(run.code, Some(1), "{complaint}: {}", run.stderr);
        assert!(run.stderr.contains(complaint), "{}", run.stderr);
        assert!(run.stdout.contains("1 claims, 0 fail"), "{}", run.stdout);
    }
}

#[test]
fn steps_backwards_have_the_same_orders() {
    let run =
        lie("verify specs/so3_free_rigid_body.json --step -0.1 --methods rk4,midpoint --quiet");
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
}
