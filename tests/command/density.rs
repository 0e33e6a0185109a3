//! `--density reversible`: what the command says of steps that follow the motion, and what it refuses. What the steps are is tested with the
//! driver, in `lie-runtime/tests/density.rs`.

use crate::common::lie;

/// An orbit with e = 0.9 from its pericentre on, ten periods.
const PLANET: &str = "run tests/data/planet.json --method gauss16 --until 60";

#[test]
fn the_command_follows_the_motion_and_says_so() {
    let run = lie(&format!("{PLANET} --density reversible --step 0.0158")).ok();
    for part in ["reversible density", "no Poisson map", "first step 0.0158"] {
        assert!(run.stderr.contains(part), "{}", run.stderr);
    }
    let (_, rows) = run.csv();
    let sizes: Vec<f64> = rows.windows(2).map(|row| row[1][0] - row[0][0]).collect();
    let inner = &sizes[..sizes.len() - 1];
    let (least, most) = (
        inner.iter().copied().fold(f64::MAX, f64::min),
        inner.iter().copied().fold(0.0, f64::max),
    );
    assert!(most > 8.0 * least, "{least} to {most}");
    assert!((sizes[0] - 0.0158).abs() < 1e-15, "{}", sizes[0]);
    assert_eq!(rows.last().unwrap()[0], 60.0);
    assert!(rows.len() < 400, "{} rows", rows.len());
    let moved = rows.iter().map(|row| (row[5] - rows[0][5]).abs());
    assert!(moved.fold(0.0, f64::max) < 1e-6);
    let json = lie(&format!(
        "{PLANET} --density reversible --step 0.0158 --format json"
    ));
    let json: serde_json::Value = serde_json::from_str(&json.ok().stdout).unwrap();
    assert_eq!(json["density"], "reversible");
    let plain = lie("run tests/data/planet.json --method gauss16 --until 1 --format json").ok();
    let plain: serde_json::Value = serde_json::from_str(&plain.stdout).unwrap();
    assert!(plain["density"].is_null());
}

#[test]
fn a_tolerance_says_when_steps_that_follow_the_motion_are_faster() {
    let said = |call: &str| lie(call).ok().stderr;
    let constant = said(&format!("{PLANET} --tol 1e-8"));
    for part in ["`--density reversible`", "`--method taylor`"] {
        assert!(constant.contains(part), "{constant}");
    }
    let following = said(&format!("{PLANET} --tol 1e-8 --density reversible"));
    assert!(!following.contains("is faster"), "{following}");
    let body = said("run specs/so3_free_rigid_body.json --method gauss16 --tol 1e-8 --until 100");
    assert!(!body.contains("is faster"), "{body}");
}

#[test]
fn rows_plots_and_the_group_go_along() {
    let rows = lie(&format!(
        "{PLANET} --density reversible --step 0.0158 --rows 0:60:7"
    ));
    let times: Vec<f64> = rows.ok().csv().1.iter().map(|row| row[0]).collect();
    assert_eq!(times, [0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0]);
    let body = "run specs/so3_free_rigid_body.json --step 0.5 --density reversible";
    let group = lie(&format!("{body} --group quaternion --at 3,20")).ok();
    let fine = "run specs/so3_free_rigid_body.json --step 0.005 --group quaternion";
    let fine = lie(&format!("{fine} --method gauss4 --at 3,20")).ok();
    for method in ["gauss16", "lie-midpoint --step 0.01"] {
        let call = match method {
            "gauss16" => format!("{body} --group quaternion --at 3,20 --method gauss16"),
            _ => format!(
                "run specs/so3_free_rigid_body.json --density reversible --group quaternion --at 3,20 --method {method}"
            ),
        };
        let (of, with) = (lie(&call).ok().csv().1, fine.csv().1);
        for (one, other) in of.iter().zip(&with) {
            for (one, other) in one.iter().zip(other) {
                assert!((one - other).abs() < 2e-3, "{method}: {one} {other}");
            }
        }
    }
    assert_eq!(group.csv().1.len(), 2);
}

#[test]
fn the_command_refuses_what_cannot_follow_the_motion() {
    let body = "specs/so3_free_rigid_body.json";
    for (call, why) in [
        (
            format!("{body} --method rk4 --density reversible"),
            "rk4 is not symmetric",
        ),
        (
            format!("{body} --method rkmk4 --density reversible"),
            "not symmetric",
        ),
        (
            format!("{body} --method taylor --density reversible"),
            "taylor chooses its own steps",
        ),
        (
            format!("{body} --method gauss4 --density equal"),
            "unknown density of steps `equal`",
        ),
        (
            "tests/data/families/heisenberg_chain.json --density reversible".to_owned(),
            "is a family",
        ),
    ] {
        let run = lie(&format!("run {call} --until 1"));
        let run = run.error("option", "command line: --density");
        assert!(run.stderr.contains(why), "{}", run.stderr);
    }
    let run = lie(&format!(
        "run {body} --method rk4 --density reversible --until 1"
    ));
    assert!(
        run.stderr.contains("lie-midpoint")
            && run.stderr.contains("collective16")
            && !run.stderr.contains("dopri5"),
        "those that are possible: {}",
        run.stderr
    );
    let ensemble = lie(&format!(
        "ensemble {body} --members 3 --method gauss16 --density reversible --until 1 --out none.npy"
    ));
    ensemble.error("option", "command line: --density");
    let far = lie(
        "run tests/data/planet.json --method gauss16 --until 60 --step 0.3 --density reversible",
    );
    assert_eq!(far.code, Some(3), "{}", far.stderr);
    assert!(far.stderr.contains("smaller step"), "{}", far.stderr);
}
