//! Systems that something acts on, against ends that another program found.

mod common;

use std::collections::BTreeMap;
use std::path::Path;

use common::{folder, lie};
use serde::Deserialize;
use serde_json::Value;

/// Where a system is after a time: by SciPy's DOP853 to 1e-13, from equations that were written by hand.
#[derive(Deserialize)]
struct Reference {
    until: f64,
    end: Vec<f64>,
}

fn ends() -> BTreeMap<String, Reference> {
    serde_json::from_str(include_str!("data/acting_ends.json")).unwrap()
}

fn spec(name: &str) -> String {
    format!("tests/data/acting/{name}.json")
}

/// The largest difference from the reference at the end of a run.
fn error(path: &Path, reference: &Reference) -> f64 {
    let (path, until) = (path.display(), reference.until);
    let run = lie(&format!("run {path} --tol 1e-11 --until {until}")).ok();
    let (_, rows) = run.csv();
    let last = &rows.last().unwrap()[1..];
    let pairs = last.iter().zip(&reference.end);
    pairs.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}

#[test]
fn ends_are_those_of_another_program() {
    let ends = ends();
    assert_eq!(ends.len(), 33);
    for (name, reference) in &ends {
        let error = error(Path::new(&spec(name)), reference);
        // `bangbang` has a joint in the state, where steps lose their order
        let allowed = if name == "bangbang" { 1e-6 } else { 1e-10 };
        assert!(error < allowed, "{name}: {error:e}");
    }
}

/// The control: what acts is seen at the end.
#[test]
fn without_what_acts_the_ends_are_others() {
    let folder = folder();
    let mut seen = 0;
    for (name, reference) in ends() {
        let mut spec: Value =
            serde_json::from_str(&std::fs::read_to_string(spec(&name)).unwrap()).unwrap();
        let object = spec.as_object_mut().unwrap();
        let forces = object.remove("forces");
        if object.remove("dissipation").or(forces).is_none() {
            continue;
        }
        let path = folder.path().join("spec.json");
        std::fs::write(&path, spec.to_string()).unwrap();
        let error = error(&path, &reference);
        assert!(error > 1e-3, "{name}: {error:e}");
        seen += 1;
    }
    assert!(seen > 25, "{seen}");
}
