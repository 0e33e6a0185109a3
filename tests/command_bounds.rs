//! Searches and measurements that could go on for ever, or say more than they know.

mod common;

use common::{folder, lie};

/// Calls `lie` with a file that holds a spec.
#[track_caller]
fn with_spec(command: &str, spec: &str, flags: &str) -> common::Run {
    let folder = folder();
    let path = folder.path().join("system.json");
    std::fs::write(&path, spec).expect("writable");
    lie(&format!("{command} {} {flags}", path.display()))
}

/// H, the Casimirs and their products solve the equations for constants of the motion; to find them again over the rational functions
/// of the parameter did not end.
#[test]
fn a_report_on_six_coordinates_with_a_parameter() {
    let spec = r#"{"format": 1, "name": "Six", "algebra": "tangent(so(3))", "parameters": {"a": "-1/2"},
        "state": ["u1", "u2", "u3", "u4", "u5", "u6"], "initial": ["-2/5", "-6/5", "-7/10", "11/10", "1/10", "-1"],
        "hamiltonian": "u1^2/8 + 2*u2^2/9 + 2*u3^2/9 + 3*u4^2/16 + u5^2/4 + 5*u6^2/16 + u2 - u2*u6/4 + 4*u6/9 - 4*u6*u3/3 + a*u6"}"#;
    let run = with_spec("check", spec, "").ok();
    let words: Vec<&str> = run.stdout.split_whitespace().collect();
    let words = words.join(" ");
    assert!(words.contains("constants of the motion"), "{}", run.stdout);
    assert!(
        words.contains("polynomials of degree up to 4: none"),
        "{}",
        run.stdout
    );
}
