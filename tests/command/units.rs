//! Every method in other units: a state times a power of two, at the step that makes the same motion of it.

use crate::common::{Run, lie};

/// A spec, a state, and how its coordinates change with the unit: as that power of it.
type System = (&'static str, &'static [f64], &'static [i32]);

const BODY: System = (
    "specs/so3_free_rigid_body.json",
    &[0.4535961214255773, 0.1, 0.8912073600614354],
    &[1; 3],
);
const TOP: System = (
    "specs/se3_heavy_top.json",
    &[0.4, 0.3, 0.9, 0.36, 0.48, 0.8],
    &[1, 1, 1, 2, 2, 2],
);

/// The methods that apply to a spec, as arguments of `lie run`.
fn methods(spec: &str) -> Vec<String> {
    let check = lie(&format!("check {spec} --json")).ok();
    let check: serde_json::Value = serde_json::from_str(&check.stdout).expect("JSON");
    let listed = check["methods"].as_object().expect("methods");
    let applies = listed.iter().filter(|(_, why)| why.is_null());
    applies
        .map(|(method, _)| match method.starts_with("compose") {
            true => format!("{method}(lie-midpoint)"),
            false => method.clone(),
        })
        .collect()
}

/// The states after 40 steps of each method, in units of `2^power` and brought back.
fn ends((spec, initial, degrees): System, methods: &[String], power: i32) -> Vec<Vec<f64>> {
    let step = 0.15 * 2.0_f64.powi(-power);
    let scaled = initial.iter().zip(degrees);
    let initial: Vec<String> = scaled
        .map(|(number, degree)| (number * 2.0_f64.powi(degree * power)).to_string())
        .collect();
    let named: Vec<String> = methods.iter().map(|m| format!("--method {m}")).collect();
    let run: Run = lie(&format!(
        "run {spec} {} --initial={} --step {step} --until {} --every 40 --quiet",
        named.join(" "),
        initial.join(","),
        40.0 * step,
    ));
    let rows = run.ok().stdout;
    let mut ends = vec![Vec::new(); methods.len()];
    for row in rows.lines().skip(1) {
        // run, method, t, and the coordinates
        let fields: Vec<&str> = row.split(',').collect();
        let run: usize = fields[0].parse().expect("a number");
        let numbers = fields[3..].iter().zip(degrees).map(|(field, degree)| {
            field.parse::<f64>().expect("a number") * 2.0_f64.powi(-degree * power)
        });
        ends[run] = numbers.collect();
    }
    ends
}

/// The largest difference to units of 1 of each method.
fn differences(system: System, powers: &[i32]) -> Vec<(String, f64)> {
    let methods = methods(system.0);
    let expected = ends(system, &methods, 0);
    let mut largest = vec![0.0_f64; methods.len()];
    for &power in powers {
        let found = ends(system, &methods, power);
        for (largest, (found, expected)) in largest.iter_mut().zip(found.iter().zip(&expected)) {
            assert_eq!(found.len(), expected.len(), "{power}");
            for (a, b) in found.iter().zip(expected) {
                *largest = largest.max((a - b).abs());
            }
        }
    }
    methods.into_iter().zip(largest).collect()
}

#[test]
fn the_bits_do_not_depend_on_units() {
    let found = differences(BODY, &[20, -100, 300]);
    for (method, difference) in &found {
        match method.as_str() {
            // the control: it has an absolute tolerance
            "dopri5" => assert!(*difference > 1e-13, "{difference:e}"),
            _ => assert_eq!(*difference, 0.0, "{method}"),
        }
    }
    assert!(found.len() > 50, "{}", found.len());
}

/// Spinors are roots, in units of the root of two here; momenta and directions of the top have units of their own.
#[test]
#[ignore = "half a minute of machine code for the top: .ci/nightly runs it"]
fn no_unit_is_too_large_or_too_small() {
    let body = differences(BODY, &[21, -301]);
    let top = differences(TOP, &[21, -20, 100, -100, 250, -250]);
    for (method, difference) in body.iter().chain(&top).filter(|(m, _)| m != "dopri5") {
        assert!(*difference < 2e-14, "{method}: {difference:e}");
    }
}
