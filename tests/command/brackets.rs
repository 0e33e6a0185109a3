//! The command on systems whose bracket is not that of an algebra alone.

use crate::common::{folder, lie};
use serde_json::{Value, json};

fn check(path: &str) -> Value {
    let run = lie(&format!("check {path} --json")).ok();
    serde_json::from_str(&run.stdout).expect("JSON")
}

#[test]
fn ranks_casimirs_and_methods() {
    let pendulum = check("specs/canonical_pendulum.json");
    assert_eq!(pendulum["generic_rank"], 2);
    assert_eq!(pendulum["initial_rank"], 2);
    assert_eq!(pendulum["independent_casimirs"], 0);
    assert!(pendulum["class"].is_null() && pendulum["splitting"].is_array());
    assert_eq!(pendulum["bracket_class"], "constant");
    let volterra = check("specs/lotka_volterra.json");
    assert_eq!(volterra["bracket_class"], "log-canonical");
    assert_eq!(volterra["generic_rank"], 2);
    assert_eq!(volterra["casimirs"][0]["name"], "C");
    assert!(volterra["casimirs"][0]["degree"].is_null());
    let body = check("specs/se2_circulation.json");
    assert_eq!(body["casimirs"][0]["degree"], 2);
    for (report, why) in [
        (
            &pendulum,
            "it needs a Lie algebra, and the system declares a general bracket",
        ),
        (
            &volterra,
            "it needs a Lie algebra, and the system declares a general bracket",
        ),
    ] {
        let methods = report["methods"].as_object().expect("an object");
        let apply: Vec<&str> = methods
            .iter()
            .filter(|(_, reason)| reason.is_null())
            .map(|(id, _)| id.as_str())
            .collect();
        let mut expected = vec![
            "midpoint",
            "gauss4",
            "gauss6",
            "gauss8",
            "gauss10",
            "gauss12",
            "gauss14",
            "gauss16",
            "rk4",
            "dopri5",
            "taylor",
            "compose4",
            "compose6",
            "compose8",
            "gonzalez",
            "mean-value",
            "itoh-abe",
            "cohen-hairer2",
            "cohen-hairer4",
            "cohen-hairer6",
            "cohen-hairer8",
            "cohen-hairer10",
            "cohen-hairer12",
            "cohen-hairer14",
            "cohen-hairer16",
            "orbit-energy",
            "k-hj2",
            "k-hj4",
            "k-hj6",
            "splitting1",
            "splitting2",
            "splitting4",
            "splitting6",
            "splitting8",
        ];
        if report["bracket_class"] != "constant" {
            expected.extend(["canonical2", "canonical4", "canonical6"]);
        }
        expected.sort_unstable();
        assert_eq!(apply, expected);
        for id in ["lie-midpoint", "rkmk4", "generating4", "euler-arnold2"] {
            assert_eq!(methods[id], json!(why), "{id}");
        }
    }
    for id in ["lie-midpoint", "rkmk4", "generating4", "splitting2"] {
        assert!(body["methods"][id].is_null(), "{id}");
    }
}

/// The verdicts of one fact, by method.
fn verdict(report: &Value, method: &str, fact: &str) -> String {
    let found = &report["methods"][method][fact]["verdict"];
    found.as_str().unwrap_or("missing").to_owned()
}

fn verify(path: &str, methods: &str) -> Value {
    let run = lie(&format!("verify {path} --methods {methods} --quiet --json")).ok();
    let report: Value = serde_json::from_str(&run.stdout).expect("JSON");
    assert_eq!(report["failed"], 0, "{report:#}");
    report
}

#[test]
fn claims_hold_where_the_bracket_is_constant_and_where_it_is_not() {
    let report = verify(
        "specs/canonical_pendulum.json",
        "midpoint,gauss4,gonzalez,rk4",
    );
    for (method, poisson, energy) in [
        ("midpoint", "holds", "not-claimed"),
        ("gauss4", "holds", "not-claimed"),
        ("gonzalez", "not-claimed", "holds"),
        ("rk4", "not-claimed", "not-claimed"),
    ] {
        assert_eq!(verdict(&report, method, "Poisson"), poisson, "{method}");
        assert_eq!(verdict(&report, method, "energy"), energy, "{method}");
        assert_eq!(verdict(&report, method, "orbit"), "absent", "{method}");
    }
    let defect = &report["methods"]["rk4"]["Poisson"]["measured"];
    assert!(
        defect.as_f64() > Some(1e-8),
        "the control is no Poisson map"
    );
    let report = verify(
        "specs/lotka_volterra.json",
        "midpoint,mean-value,cohen-hairer4",
    );
    assert_eq!(verdict(&report, "midpoint", "Poisson"), "not-claimed");
    for method in ["mean-value", "mean-value --tensor mean", "cohen-hairer4"] {
        assert_eq!(verdict(&report, method, "energy"), "holds", "{method}");
        assert_eq!(verdict(&report, method, "order"), "holds", "{method}");
    }
}

#[test]
fn runs_with_a_tensor() {
    let run = |rest: &str| {
        let flags = "--quiet --step 0.05 --until 1";
        lie(&format!("run specs/lotka_volterra.json {flags} {rest}"))
            .ok()
            .csv()
            .1
    };
    let (middle, mean) = (
        run("--method gonzalez"),
        run("--method gonzalez --tensor mean"),
    );
    let same = run("--method gonzalez --tensor midpoint");
    assert_eq!(middle, same);
    let (last, other) = (&middle[20], &mean[20]);
    let apart = (last[1] - other[1]).abs();
    assert!(apart > 1e-6 && apart < 1e-2, "{apart:e}");
    for rows in [&middle, &mean] {
        assert!((rows[20][4] - rows[0][4]).abs() < 1e-14, "the energy");
    }
    lie("run specs/se2_circulation.json --method gonzalez --tensor mean")
        .error("method", "command line: --method");
    lie("run specs/lotka_volterra.json --method midpoint --tensor mean")
        .error("option", "command line: --tensor");
    // without a method it is one that applies
    let text = std::fs::read_to_string("specs/canonical_pendulum.json").expect("the spec");
    let mut spec: Value = serde_json::from_str(&text).expect("JSON");
    spec.as_object_mut().expect("an object").remove("run");
    let folder = folder();
    let path = folder.path().join("pendulum.json");
    std::fs::write(&path, spec.to_string()).expect("the spec is written");
    let (header, rows) = lie(&format!("run {} --quiet --until 0.02", path.display()))
        .ok()
        .csv();
    assert_eq!(header, ["t", "q", "p", "energy"]);
    assert_eq!(rows.len(), 3);
}

/// Leaves that are no orbits of an algebra are measured by their Casimirs.
#[test]
fn claims_hold_where_there_is_no_algebra() {
    let report = verify("specs/lotka_volterra.json", "orbit-energy,k-hj4,rk4");
    for (method, leaf, poisson) in [
        ("orbit-energy", "holds", "not-claimed"),
        ("k-hj4", "holds", "holds"),
        ("rk4", "absent", "not-claimed"),
    ] {
        assert_eq!(verdict(&report, method, "orbit"), leaf, "{method}");
        assert_eq!(verdict(&report, method, "Poisson"), poisson, "{method}");
    }
}

/// What a refused method is told to use in its place applies where something acts, too.
#[test]
fn methods_named_in_a_refusal_apply_where_something_acts() {
    let run = "run tests/data/acting/lv_harvest.json --step 0.1 --until 1 --quiet --method";
    for method in ["lie-midpoint", "generating4", "rkmk6", "k-hj4"] {
        let refused = lie(&format!("{run} {method}")).error("method", "command line: --method");
        let help = refused
            .stderr
            .lines()
            .find(|line| line.starts_with("help: "));
        let named: Vec<&str> = help.expect("help").split('`').skip(1).step_by(2).collect();
        let methods = named
            .iter()
            .filter(|name| !["forces", "dissipation"].contains(name));
        assert_eq!(methods.clone().count(), 2, "{named:?}");
        for name in methods {
            lie(&format!("{run} {name}")).ok();
        }
    }
}
