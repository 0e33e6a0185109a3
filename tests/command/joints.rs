//! Joints by the command: runs by series whose steps end there, and what `lie check` says.

use crate::common::{folder, lie, spec};

/// A body whose inertia differs on the two sides of x = 0, and its state at t = 20, from an extrapolation method in 32 digits.
const ENERGY: &str = "x^2/2 + y^2/3 + z^2/5 + piecewise(x < 0: 3*x^2, x^2/7)";
const END: [f64; 3] = [
    0.297_047_742_076_674_67,
    -0.125_914_571_411_517_4,
    0.897_723_877_165_692_5,
];

/// A force that is switched off, and one that acts on one side of a plane; its end is from an extrapolation method.
#[test]
fn a_tolerance_without_a_method_is_met_across_joints() {
    let folder = folder();
    let path = spec(folder.path(), |spec| {
        *spec = serde_json::json!({
            "name": "Switched",
            "algebra": "so(3)",
            "state": ["x", "y", "z"],
            "hamiltonian": "x^2/4 + y^2/3 + z^2/2",
            "forces": { "x": "piecewise(t < 5: 1/5, 0)", "y": "-max(y, 0)/10" },
            "initial": [0.5, 0.6, 0.7]
        });
    });
    let end = [
        1.576_009_908_754_72,
        -0.253_392_603_106_295,
        -0.756_173_447_885_1,
    ];
    let error = |options: &str| {
        let run = lie(&format!(
            "run {} --tol 1e-10 --at 10 {options}",
            path.display()
        ))
        .ok();
        let row = run.csv().1[0].clone();
        let pairs = row[1..4].iter().zip(&end);
        let error = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        (error, run.stderr)
    };
    let (found, said) = error("");
    assert!(found < 1e-9, "{found:e} {said}");
    assert!(
        said.contains("taylor was picked: branches of H or of a force meet"),
        "{said}"
    );
    // the control: steps that cross them
    assert!(error("--method gauss16").0 > 1e-7);
}

/// A field that turns round takes the motion back the way that it came: a state that was there before is not the state before.
#[test]
fn a_motion_that_comes_back_is_not_where_it_was() {
    let folder = folder();
    let path = spec(folder.path(), |spec| {
        *spec = serde_json::json!({
            "name": "Flip",
            "algebra": "so(3)",
            "state": ["x", "y", "z"],
            "hamiltonian": "-z*piecewise(t < 5: 1, -1)",
            "initial": ["3/5", 0, "4/5"]
        });
    });
    let end = [0.6 * 10.0_f64.cos(), -0.6 * 10.0_f64.sin(), 0.8];
    for options in [
        "--tol 1e-10",
        "--method taylor --step 0.5",
        "--method taylor --step 1",
        "--method lie-taylor --step 0.5",
        "--method lie-taylor --step 1",
        "--method gauss16 --step 0.5",
    ] {
        let run = lie(&format!("run {} {options} --at 20", path.display())).ok();
        let row = run.csv().1[0].clone();
        for (found, expected) in row[1..4].iter().zip(end) {
            let error = (found - expected).abs();
            assert!(error < 1e-9, "{options}: {row:?}");
        }
    }
}

/// At a known time steps of every method end, so that the usual one is picked; what H jumps there is work.
#[test]
fn a_jump_at_a_known_time_is_work() {
    let folder = folder();
    let path = spec(folder.path(), |spec| {
        *spec = serde_json::json!({
            "name": "Flip",
            "algebra": "so(3)",
            "state": ["x", "y", "z"],
            "hamiltonian": "-z*piecewise(t < 5: 1, -1) + x/5",
            "dissipation": [{ "kind": "double-bracket", "strength": "1/4" }],
            "forces": { "y": "u" },
            "inputs": { "u": { "default": 0 } },
            "initial": ["3/5", 0, "4/5"]
        });
    });
    // a table that changes where H jumps
    let table = folder.path().join("u.csv");
    std::fs::write(&table, "t,u\n0,0\n5,0.1\n").expect("a table");
    let input = format!("--input u={}", table.display());
    for options in ["", "--method taylor", "--method lie-midpoint", &input] {
        let run = lie(&format!(
            "run {} --tol 1e-9 --at 0,4,5,6,12 {options}",
            path.display()
        ))
        .ok();
        assert!(
            !options.is_empty() || run.stderr.contains("gauss16 was picked"),
            "{}",
            run.stderr
        );
        let (names, rows) = run.csv();
        let place = |name: &str| names.iter().position(|column| column == name).expect(name);
        let [energy, work] = ["energy", "work"].map(place);
        for row in &rows {
            let balance = row[energy] - rows[0][energy] - row[work];
            assert!(balance.abs() < 1e-7, "{options}: {balance:e} at {}", row[0]);
        }
        // the control: it jumps by twice the field
        assert!(rows[3][work] - rows[1][work] > 1.0, "{options}: {rows:?}");
    }
}

/// A force that takes a branch by the state is not linear, though its derivatives vanish or are constant where they exist.
#[test]
fn a_branch_is_no_linear_friction() {
    let folder = folder();
    for force in [
        "-piecewise(y < 0: 1, 5)*x",
        "-abs(x)",
        "-2*max(x, 0)",
        "-piecewise(z < 0: 1, 5)",
    ] {
        let path = spec(folder.path(), |spec| {
            *spec = serde_json::json!({
                "name": "Branched", "algebra": "so(3)", "state": ["x", "y", "z"],
                "hamiltonian": "x^2/4 + y^2/3 + z^2/2", "forces": { "x": force }, "initial": [1, "1/2", "-1/3"]
            });
        });
        let run = lie(&format!(
            "run {} --method splitting2 --step 0.1 --until 1",
            path.display()
        ));
        let said = run.error("splitting", "command line: --method").stderr;
        assert!(said.contains("on `x` it is not linear"), "{force}: {said}");
    }
}

/// A table of the time that ends where the run does has no values behind that, and no step is tried there.
#[test]
fn a_table_may_end_with_the_run() {
    let folder = folder();
    let path = spec(folder.path(), |spec| {
        *spec = serde_json::json!({
            "name": "Tank",
            "algebra": "so(3)",
            "state": ["x", "y", "z"],
            "functions": { "mass": { "table": [[0, 5], [10, 4], [20, 2], [40, 1]], "degree": 3 } },
            "let": ["I1 = 1 + mass(t)/5", "I2 = 2 + mass(t)/2", "I3 = 3 + mass(t)/3"],
            "hamiltonian": "x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3)",
            "initial": [1, "1/5", "3/10"]
        });
    });
    for until in ["40", "39.99", "39", "20"] {
        let run = lie(&format!(
            "run {} --tol 1e-8 --until {until}",
            path.display()
        ))
        .ok();
        let rows = run.csv().1.len();
        assert!((4..200).contains(&rows), "{until}: {rows} {}", run.stderr);
    }
}

#[test]
fn runs_by_series_are_right_across_joints() {
    let folder = folder();
    let path = spec(folder.path(), |spec| {
        spec["parameters"] = serde_json::json!({});
        spec["hamiltonian"] = ENERGY.into();
        spec["initial"] = serde_json::json!(["3/10", "1/10", "9/10"]);
    });
    let error = |options: &str| {
        let run = lie(&format!("run {} --quiet {options}", path.display())).ok();
        let row = run.csv().1[0].clone();
        let pairs = row[1..4].iter().zip(&END);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    for method in ["taylor", "lie-taylor"] {
        for (pace, allowed) in [
            ("--tol 1e-9", 1e-8),
            ("--step 0.01", 1e-12),
            ("--step 5 --rtol 1e-9", 1e-6),
        ] {
            let found = error(&format!("--method {method} {pace} --at 20"));
            assert!(found < allowed, "{method} {pace}: {found:e}");
        }
    }
    // the control: a method whose steps cross the joint
    assert!(error("--method rk4 --step 0.1 --at 20") > 1e-5);
}

#[test]
fn check_says_that_series_keep_their_order() {
    let folder = folder();
    let path = spec(folder.path(), |spec| {
        spec["parameters"] = serde_json::json!({});
        spec["hamiltonian"] = ENERGY.into();
        spec["initial"] = serde_json::json!(["3/10", "1/10", "9/10"]);
    });
    let text = lie(&format!("check {}", path.display())).ok().stdout;
    let line = "steps that end at them, and the whole order: taylor, lie-taylor";
    assert!(text.contains(line), "{text}");
    let lost = text
        .lines()
        .find(|line| line.contains("order 2 where steps cross them"));
    assert!(lost.is_some_and(|line| !line.contains("taylor")), "{text}");
    let json = lie(&format!("check {} --json", path.display())).ok().stdout;
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let orders = ["taylor", "lie-taylor", "rk4"].map(|id| json["orders"][id].as_u64());
    assert_eq!(orders, [Some(33), Some(15), Some(2)]);
}
