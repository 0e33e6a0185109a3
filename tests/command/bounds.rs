//! Searches and measurements that could go on for ever, or say more than they know.

use crate::common::{folder, lie};

/// Calls `lie` with a file that holds a spec.
#[track_caller]
fn with_spec(command: &str, spec: &str, flags: &str) -> crate::common::Run {
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

const SPIN_UP: &str = r#"{"format": 1, "name": "SpinUp", "algebra": "so(3)", "state": ["x", "y", "z"],
    "parameters": {"I1": 0.5, "I2": 0.6, "I3": 0.9}, "let": ["h = piecewise(t < 1: 0, t < 3: (t-1)*0.4, 0.8)"],
    "hamiltonian": "x^2/(2*I1)+y^2/(2*I2)+(z-h)^2/(2*I3)", "initial": [0.1, 0.2, 0.3]}"#;

/// A joint of H asks for shorter steps without end; the run comes back, right or with a warning.
#[test]
fn a_tolerance_across_joints() {
    for tolerance in ["1e-4", "1e-7"] {
        let flags = format!("--method gauss16 --at 10 --tol {tolerance}");
        let run = with_spec("run", SPIN_UP, &flags).ok();
        let (_, rows) = run.csv();
        let exact = [-0.147_910_131_55, -0.173_930_442_98, 0.296_430_082_80];
        let pairs = rows[0][1..].iter().zip(exact);
        let error = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let kept = error < 30.0 * tolerance.parse::<f64>().expect("a number");
        assert!(
            kept || run.stderr.contains("warning: the error at the end"),
            "{error:e}: {}",
            run.stderr
        );
    }
}

/// The fall into a centre ends at t = π/√8 = 1.1107: steps that keep a tolerance there are short without end.
#[test]
fn a_tolerance_beyond_a_singularity() {
    let spec = r#"{"format": 1, "name": "Fall", "state": ["q", "p"], "poisson": ["{q, p} = 1"], "initial": [1, 0],
        "hamiltonian": "p^2/2 - 1/q"}"#;
    for tolerance in ["1e-4", "1e-6", "1e-11"] {
        let run = with_spec(
            "run",
            spec,
            &format!("--method gauss16 --at 10 --tol {tolerance}"),
        );
        assert!(
            run.stderr.contains("t = 1.1"),
            "{tolerance}: {}",
            run.stderr
        );
        // control: before it there are steps that do
        with_spec(
            "run",
            spec,
            &format!("--method gauss16 --at 1 --tol {tolerance}"),
        )
        .ok();
    }
}

/// An iteration that contracts by one half ends where the state is at rest; a part of it that is a tenth of the rest needs more. It
/// lost 1.1e-12 of its length.
#[test]
fn small_parts_of_slow_iterations_are_at_rest() {
    let spec = include_str!("../data/slow_top.json");
    for method in ["gauss16", "cohen-hairer16"] {
        let flags =
            format!("--method {method} --step 2.6434950789188334 --until 528.6990157837666");
        let (_, rows) = with_spec("run", spec, &flags).ok().csv();
        let length = |row: &[f64]| row[4..7].iter().map(|y| y * y).sum::<f64>();
        let lost = |row: &Vec<f64>| (length(row) / length(&rows[0]) - 1.0).abs();
        let lost = rows.iter().map(lost).fold(0.0, f64::max);
        assert!(rows.len() == 201 && lost < 1e-13, "{method}: {lost:e}");
    }
}

/// Small steps start at round-off now and then and show no rate there. Each made more iterations than the one before it, up to the
/// limit: after 518 and 3,449 steps.
#[test]
fn starts_at_round_off_need_no_more_iterations() {
    for method in ["isospectral12", "collective10"] {
        let flags = format!("--method {method} --step 0.01 --until 40 --every 4000");
        lie(&format!("run specs/so3_free_rigid_body.json {flags}")).ok();
    }
}

/// A tenth of a unit of time in a hundred: the start knows nothing of it, and steps of 16 pass it.
#[test]
fn a_tolerance_across_a_pulse() {
    let spec = r#"{"format": 1, "name": "Pulse", "algebra": "so(3)", "state": ["x", "y", "z"], "initial": [0.6, 0.48, 0.64],
        "hamiltonian": "z + 3*exp(-((t - 50)/0.1)^2)*x"}"#;
    let exact = [0.216_525_537_80, 0.946_620_629_05, 0.238_801_332_35];
    for method in ["lie-midpoint", "gauss4", "gauss16"] {
        let run = with_spec(
            "run",
            spec,
            &format!("--method {method} --at 100 --tol 1e-4"),
        )
        .ok();
        let (_, rows) = run.csv();
        let pairs = rows[0][1..].iter().zip(exact);
        let error = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(error < 3e-3, "{method} {error:e}: {}", run.stderr);
    }
}

/// Errors within a hundred times those of the reference have no slope: a right method does not fail by it.
#[test]
fn an_order_at_round_off_is_not_measurable() {
    let spec = r#"{"format": 1, "name": "Bianchi", "algebra": "bianchi(VI0)", "parameters": {"a": "2/5"},
        "state": ["u1", "u2", "u3"], "initial": ["2/5", "-1/10", "1/5"],
        "hamiltonian": "5*u1^2/12 + u2^2/6 + u3^2/4 - exp(-u2^2/3)/6 + a*u3*u3"}"#;
    let run = with_spec("verify", spec, "--methods collective16,midpoint --quiet").ok();
    assert!(run.stdout.contains("not measurable"), "{}", run.stdout);
    // control: where there is something to tell it is told
    assert!(run.stdout.contains("2: 2.0"), "{}", run.stdout);
}

/// From order 8 on a collective method over spinors moves the group element of other matrices to its order alone.
#[test]
fn a_group_element_that_goes_along() {
    let spec = r#"{"format": 1, "name": "Right", "invariance": "right", "state": ["x", "y", "z"], "initial": [1, "1/2", "-1/3"],
        "algebra": {"basis": ["e1", "e2", "e3"], "brackets": ["[e1, e2] = e3", "[e2, e3] = e1", "[e3, e1] = e2"],
        "matrices": {"e1": [[0, 0, 0], [0, 0, -1], [0, 1, 0]], "e2": [[0, 0, 1], [0, 0, 0], [-1, 0, 0]],
        "e3": [[0, -1, 0], [1, 0, 0], [0, 0, 0]]}}, "hamiltonian": "x^2/2 + y^2 + 3*z^2/2"}"#;
    for step in ["0.1", "0.4"] {
        let flags = format!("--methods collective4,collective8,collective16 --step {step} --quiet");
        with_spec("verify", spec, &flags).ok();
    }
}
