//! The program of the example, started as everybody would.

use std::process::Command;

fn output(arguments: &[&str]) -> String {
    let program = Command::new(env!("CARGO_BIN_EXE_own-method"))
        .args(arguments)
        .output()
        .expect("it starts");
    assert!(program.status.success(), "{program:?}");
    String::from_utf8(program.stdout).expect("text")
}

/// The state at the end, which the program prints as a list.
fn end(system: &str, form: &str, steps: &str) -> Vec<f64> {
    let text = output(&[system, form, steps]);
    let list = text.trim().trim_matches(['[', ']']).split(", ");
    list.map(|number| number.parse().expect("a number"))
        .collect()
}

#[test]
fn both_forms_of_the_method_make_the_same_steps() {
    let apart = |a: &[f64], b: &[f64]| {
        let differences = a.iter().zip(b).map(|(a, b)| (a - b).abs());
        differences.fold(0.0, f64::max)
    };
    for system in ["so3", "se3"] {
        let fused = end(system, "fused", "100");
        let generic = end(system, "generic", "100");
        assert_eq!(fused.len(), generic.len());
        assert!(apart(&fused, &generic) < 1e-11, "{fused:?} {generic:?}");
        // the control: one step more is another state
        let later = end(system, "generic", "101");
        assert!(apart(&fused, &later) > 1e-6, "{later:?}");
    }
}

#[test]
fn it_says_what_both_forms_cost() {
    assert!(!output(&[]).is_empty());
}
