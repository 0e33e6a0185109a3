//! Systems whose Hamiltonian depends on the time, by the command: the time over long runs, and runs from another time than 0.

use crate::common::{Run, lie};

const ROTATION: &str = "tests/data/driven/rotation.json";
const OSCILLATOR: &str = "tests/data/driven/oscillator.json";

/// The angle by which the driven rotation has turned at a time.
fn angle(time: f64) -> f64 {
    time + time.sin() / 2.0
}

/// The error of the angle at the end of a run from a time.
#[track_caller]
fn error(run: &Run, from: f64) -> f64 {
    let (_, rows) = run.csv();
    let last = rows.last().expect("a row");
    let turned = angle(last[0]) - angle(from);
    let error = (last[2].abs() - turned.sin().abs()).abs();
    error.max((last[1] - turned.cos()).abs())
}

/// Over 100,000 steps the sum of steps leaves the times of the grid by far more than the bound, which a method would show.
#[test]
fn a_long_run_keeps_the_time() {
    let run = lie(&format!(
        "run {ROTATION} --method gauss16 --step 0.1 --at 10000 --quiet"
    ));
    let found = error(&run.ok(), 0.0);
    assert!(found < 1e-10, "{found:e}");
    // the control
    let (mut sum, mut turned) = (0.0_f64, 0.0_f64);
    for _ in 0..100_000 {
        turned += 0.1 + ((sum + 0.1).sin() - sum.sin()) / 2.0;
        sum += 0.1;
    }
    let lost = (turned - angle(10_000.0)).abs();
    assert!(lost > 1e-9, "{lost:e}");
}

/// They stopped where the round-off of the time came into the test of the map.
#[test]
fn collective_methods_go_on() {
    for (method, bound) in [
        ("collective8", 1e-10),
        ("collective10", 3e-11),
        ("collective16", 3e-11),
        ("isospectral10", 3e-11),
        ("isospectral16", 3e-11),
    ] {
        let run = lie(&format!(
            "run {ROTATION} --method {method} --step 0.1 --at 3000 --quiet"
        ));
        let found = error(&run.ok(), 0.0);
        assert!(found < bound, "{method}: {found:e}");
    }
}

#[test]
fn a_run_starts_at_its_time() {
    let run = lie(&format!(
        "run {ROTATION} --method gauss16 --step 0.1 --from 20 --until 23.05 --every 10 --quiet"
    ))
    .ok();
    let times: Vec<f64> = run.csv().1.iter().map(|row| row[0]).collect();
    assert_eq!(
        times,
        [
            20.0,
            20.0 + 10.0 * 0.1,
            20.0 + 20.0 * 0.1,
            20.0 + 30.0 * 0.1,
            23.05
        ]
    );
    assert!(error(&run, 20.0) < 1e-13);
    assert!(error(&run, 0.0) > 1e-2, "the control");
    let at = lie(&format!(
        "run {ROTATION} --method gauss16 --step -0.1 --from 20 --at 20,17.5,19 --quiet"
    ))
    .ok();
    let times: Vec<f64> = at.csv().1.iter().map(|row| row[0]).collect();
    assert_eq!(times, [20.0, 19.0, 17.5]);
    assert!(error(&at, 20.0) < 1e-13);
    // without an end it takes as long as from 0
    let plain = lie(&format!("run {ROTATION} --from 1/2 --every 1000 --quiet")).ok();
    let last = plain.csv().1.last().map(|row| row[0]);
    assert_eq!(last, Some(10.5));
}

/// The same steps from another time, where H does not depend on it.
#[test]
fn nothing_but_the_times_depends_on_the_start() {
    let states = |span: &str| {
        let spec = "specs/so3_free_rigid_body.json";
        let run = lie(&format!(
            "run {spec} --method gauss8 --step 1/8 {span} --quiet"
        ));
        let rows = run.ok().csv().1;
        let states = rows.iter().map(|row| row[1..].to_vec());
        (rows[0][0], states.collect::<Vec<_>>())
    };
    let (early, late) = (states("--until 2"), states("--from 64 --until 66"));
    assert_eq!((early.0, late.0), (0.0, 64.0));
    assert_eq!(early.1, late.1);
}

#[test]
fn wrong_starts_are_refused() {
    let run = |options: &str| lie(&format!("run {OSCILLATOR} {options}"));
    run("--from 5 --until 3 --step 0.1").error("option", "command line: --until");
    run("--from 5 --at 4,6").error("option", "command line: --at");
    run("--from soon").error("number", "command line: --from");
}

/// The energy of a row is that of its state at its time, which gonzalez and orbit-energy had as an unknown among others.
#[test]
fn the_energy_is_that_of_the_row() {
    let methods = lie(&format!("check {OSCILLATOR} --json")).ok();
    let report: serde_json::Value = serde_json::from_str(&methods.stdout).expect("JSON");
    let methods = report["methods"].as_object().expect("methods");
    let applying = methods.iter().filter(|(_, reason)| reason.is_null());
    let mut labels: Vec<String> = applying.map(|(id, _)| id.clone()).collect();
    labels.retain(|id| !id.starts_with("compose"));
    labels.push("compose4(gonzalez)".to_owned());
    labels.push("compose4(orbit-energy)".to_owned());
    assert!(labels.len() > 20, "{labels:?}");
    for method in labels {
        let run = lie(&format!(
            "run {OSCILLATOR} --method {method} --step 0.1 --until 20 --every 50 --quiet"
        ));
        let (header, rows) = run.ok().csv();
        assert_eq!(header[..5], ["t", "q", "p", "z", "energy"]);
        for row in rows {
            let [t, q, p] = [row[0], row[1], row[2]];
            let energy = p * p / 2.0 + q.powi(4) / 4.0 + q * (2.0 * t).sin() / 3.0;
            let error = (row[4] - energy).abs();
            assert!(error < 1e-13, "{method} at {t}: {error:e}");
        }
    }
}

/// The error at t = 2.05 of a rotation whose rate has a joint at t = 1/3, by steps that do not meet it, forwards or backwards.
fn across(rate: &str, method: &str, exact: f64, backwards: bool) -> f64 {
    let folder = crate::common::folder();
    let path = crate::common::spec(folder.path(), |spec| {
        spec["algebra"] = serde_json::json!("so(3)");
        spec["parameters"] = serde_json::json!({ "c": { "default": "1/3" } });
        spec["hamiltonian"] = serde_json::json!(format!("z*({rate})"));
        spec["initial"] = serde_json::json!([1, 0, "3/10"]);
    });
    let span = match backwards {
        false => "--step 0.1 --at 2.05",
        true => "--step -0.1 --from 2.05 --at 0",
    };
    let path = path.to_str().expect("a path");
    let run = lie(&format!("run {path} --method {method} {span} --quiet"));
    let (_, rows) = run.ok().csv();
    let [x, y] = [rows[0][1], rows[0][2]];
    (x - exact.cos())
        .abs()
        .max((y.abs() - exact.sin().abs()).abs())
}

#[test]
fn a_joint_at_a_known_time_divides_its_step() {
    let (c, end) = (1.0_f64 / 3.0, 2.05_f64);
    let kink = end + (c * c + (end - c) * (end - c)) / 2.0;
    let jump = c + 2.0 * (end - c);
    for (rate, exact) in [
        ("1 + abs(t - c)", kink),
        ("piecewise(t < c: 1, 2)", jump),
        ("1 + min(1, max(0, 1000000*(t - c)))", jump - 0.5e-6),
    ] {
        for method in ["gauss16", "collective8", "cohen-hairer12"] {
            for backwards in [false, true] {
                let error = across(rate, method, exact, backwards);
                assert!(error < 1e-9, "{rate} {method} {backwards}: {error:e}");
            }
        }
        // the stage at the end of a step is on the side of the step
        assert!(across(rate, "rk4", exact, false) < 1e-3, "{rate}");
    }
    // the control: a joint that depends on the state too, although hardly
    let unknown = across("1 + abs(t - c + 1e-9*x)", "gauss16", kink, false);
    assert!(unknown > 1e-6, "{unknown:e}");
}
