//! The measured cases beside other integrators, `lab/peers`, which is outside the workspace: what they say of specs is so.

use std::collections::BTreeSet;
use std::path::Path;

use serde_json::Value;

fn read(path: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn json(path: &str) -> Value {
    serde_json::from_str(&read(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

fn count(value: &Value) -> usize {
    value
        .as_array()
        .map(Vec::len)
        .or_else(|| value.as_object().map(serde_json::Map::len))
        .unwrap_or(0)
}

/// What is wrong with a case.
fn mistakes(case: &Value, spec: &Value, reference: &Value) -> Vec<String> {
    let size = count(&spec["state"]);
    let mut mistakes = Vec::new();
    for (what, value) in [("initial", &case["initial"]), ("reference", reference)] {
        if count(value) != size {
            mistakes.push(format!("{what} has {} numbers, not {size}", count(value)));
        }
    }
    if count(&case["parameters"]) != count(&spec["parameters"]) {
        mistakes.push("parameters".to_owned());
    }
    let lines = case["field"].as_array().into_iter().flatten();
    let lines = lines.filter_map(|line| line.as_str()?.split_once(" = "));
    let given: BTreeSet<String> = lines.map(|(left, _)| left.to_owned()).collect();
    let missing = (0..size).map(|k| format!("d{k}"));
    mistakes.extend(missing.filter(|name| !given.contains(name)));
    mistakes
}

#[test]
fn the_cases_fit_their_specs() {
    let (cases, references) = (
        json("lab/peers/cases.json"),
        json("lab/peers/references.json"),
    );
    let mut found = 0;
    for (name, case) in cases.as_object().expect("cases by name") {
        let Some(spec) = case["spec"].as_str() else {
            continue;
        };
        let spec = json(&format!("specs/{spec}.json"));
        let none: [String; 0] = [];
        assert_eq!(mistakes(case, &spec, &references[name]), none, "{name}");
        found += 1;
    }
    assert!(found >= 5, "{found} cases");
}

#[test]
fn a_case_of_another_spec_is_noticed() {
    let (cases, references) = (
        json("lab/peers/cases.json"),
        json("lab/peers/references.json"),
    );
    let top = json("specs/se3_heavy_top.json");
    let found = mistakes(&cases["A"], &top, &references["A"]);
    assert_eq!(found.len(), 6, "{found:?}");
}

#[test]
fn the_page_has_a_place_for_every_case() {
    let (page, cases) = (read("lab/docs/peers.md"), json("lab/peers/cases.json"));
    for name in cases.as_object().expect("cases by name").keys() {
        for kind in ["table", "settings"] {
            let mark = format!("<!-- {kind} {name} -->");
            assert_eq!(page.matches(&mark).count(), 1, "{mark}");
        }
    }
}
