//! Systems that something acts on, against ends that another program found.

use std::collections::BTreeMap;
use std::path::Path;

use crate::common::{folder, lie};
use serde::Deserialize;
use serde_json::Value;

/// Where a system is after a time: by SciPy's DOP853 to 1e-13, from equations that were written by hand.
#[derive(Deserialize)]
struct Reference {
    until: f64,
    end: Vec<f64>,
}

fn ends() -> BTreeMap<String, Reference> {
    serde_json::from_str(include_str!("../data/acting_ends.json")).unwrap()
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

/// Of systems by a Lagrangian the variational methods come there too, each with its order.
#[test]
fn variational_methods_come_to_the_same_ends() {
    let ends = ends();
    for name in ["lagrangian_time", "gyro_lagrangian_force"] {
        let (reference, path) = (&ends[name], spec(name));
        for (order, [long, short]) in [(2, [0.04, 0.02]), (4, [0.2, 0.1]), (6, [0.4, 0.2])] {
            let error = |step: f64| {
                let until = reference.until;
                let call =
                    format!("run {path} --method variational{order} --step {step} --until {until}");
                let run = lie(&call).ok();
                let (_, rows) = run.csv();
                let last = &rows.last().unwrap()[1..];
                let pairs = last.iter().zip(&reference.end);
                pairs.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
            };
            let slope = (error(long) / error(short)).log2();
            let near = (slope - f64::from(order)).abs() < 0.12 * f64::from(order);
            assert!(near, "{name} variational{order}: {slope}");
        }
    }
}

/// On T*G by a Lagrangian, with the time, a force and damping, variational methods end where the others do; what has no place for them says why.
#[test]
fn variational_methods_take_forces_on_the_group() {
    let folder = folder();
    let spec = serde_json::json!({
        "name": "OnGroup",
        "algebra": { "basis": ["e1", "e2", "e3"], "brackets": ["[e1, e2] = e3", "[e2, e3] = e1", "[e3, e1] = e2"], "matrices": {
            "e1": [[0, 0, 0], [0, 0, -1], [0, 1, 0]], "e2": [[0, 0, 1], [0, 0, 0], [-1, 0, 0]], "e3": [[0, -1, 0], [1, 0, 0], [0, 0, 0]]
        } },
        "group": "R",
        "state": ["x", "y", "z"],
        "velocity": ["u", "v", "w"],
        "lagrangian": "u^2/2 + v^2 + (2 + R12)*w^2 - R33*cos(2*t)",
        "forces": { "x": "R31/3 - x/5", "y": "sin(t)/4" },
        "dissipation": [{ "kind": "rayleigh", "matrix": [[0, 0, 0], [0, 0.1, 0], [0, 0, 0.2]] }],
        "initial": [1, "1/2", "-1/3"]
    });
    let path = folder.path().join("group.json");
    std::fs::write(&path, spec.to_string()).unwrap();
    let path = path.display();
    let end = |method: &str, step: f64| -> Vec<f64> {
        let run = lie(&format!(
            "run {path} --method {method} --step {step} --until 2"
        ))
        .ok();
        run.csv().1.pop().unwrap()
    };
    let exact = end("gauss16", 0.1);
    let far = |a: &[f64]| {
        let pairs = a.iter().zip(&exact).map(|(x, y)| (x - y).abs());
        pairs.fold(0.0, f64::max)
    };
    for (method, order, steps) in [
        ("variational2", 2, [0.02, 0.01]),
        ("variational4", 4, [0.1, 0.05]),
        ("variational6", 6, [0.2, 0.1]),
        ("variational2 --retraction cayley", 2, [0.02, 0.01]),
        ("variational4 --retraction cayley", 4, [0.1, 0.05]),
        ("variational6 --retraction cayley", 6, [0.2, 0.1]),
        ("euler-arnold2", 2, [0.02, 0.01]),
    ] {
        let slope = (far(&end(method, steps[0])) / far(&end(method, steps[1]))).log2();
        let near = (slope - f64::from(order)).abs() < 0.12 * f64::from(order);
        assert!(near, "{method}: {slope}");
    }
    for (method, reason) in [
        ("generating4", "the generating function is one of H alone"),
        ("discrete-euler-poincare", "has the motion without it"),
        ("exact", "the closed solution is that of H alone"),
    ] {
        let refused = lie(&format!(
            "run {path} --method {method} --step 0.1 --until 1"
        ));
        let refused = refused.error("method", "command line: --method");
        assert!(refused.stderr.contains(reason), "{}", refused.stderr);
    }
}

/// Of a reduced Lagrangian there is the Cayley map for order 2 alone, and of a Hamiltonian no variational method.
#[test]
fn higher_orders_along_the_cayley_map_are_for_what_has_a_path_in_phase_space() {
    for (spec, reason) in [
        (
            "so3_gyrostat_lagrangian",
            "of a reduced Lagrangian the step of this order is along the exponential map",
        ),
        (
            "so3_free_rigid_body",
            "the system is given by its Hamiltonian",
        ),
    ] {
        let refused = lie(&format!(
            "run specs/{spec}.json --method variational4 --retraction cayley --step 0.1 --until 1"
        ));
        assert_eq!(refused.code, Some(2), "{spec}");
        assert!(refused.stderr.contains(reason), "{}", refused.stderr);
    }
    lie("run specs/so3_gyrostat_lagrangian.json --method variational2 --retraction cayley --step 0.1 --until 1").ok();
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
