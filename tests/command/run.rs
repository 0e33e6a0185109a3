//! `lie run` from the spec to the rows: it generates, compiles and runs.

use std::path::Path;

use crate::common::{Run, csv, folder, lie, spec};

const BODY: &str = "run specs/so3_free_rigid_body.json --quiet";

#[test]
fn rows_on_the_grid() {
    let run = lie(&format!(
        "{BODY} --method midpoint --step 0.1 --until 1 --every 3"
    ))
    .ok();
    assert!(run.stderr.is_empty(), "{}", run.stderr);
    let (header, rows) = run.csv();
    assert_eq!(header, ["t", "x", "y", "z", "energy", "norm2"]);
    let times: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    // By multiplication, not by addition; then the last one.
    assert_eq!(times, [0.0, 3.0 * 0.1, 6.0 * 0.1, 9.0 * 0.1, 1.0]);
    let first = &rows[0];
    assert_eq!(first[1..4], [1.1f64.cos(), 0.0, 1.1f64.sin()].map(|x| x));
    for row in &rows {
        assert!(
            (row[5] - first[5]).abs() < 1e-14,
            "the midpoint rule keeps quadratic Casimirs"
        );
    }
}

#[test]
fn times_off_the_grid_take_one_shorter_step() {
    let all = lie(&format!("{BODY} --method gauss4 --step 1/10 --until 0.25"))
        .ok()
        .csv()
        .1;
    assert_eq!(
        all.iter().map(|row| row[0]).collect::<Vec<_>>(),
        [0.0, 0.1, 0.2, 0.25]
    );
    let run = lie(&format!(
        "{BODY} --method gauss4 --step 1/10 --at 0.25,0,1/7,0.2,0.2"
    ))
    .ok();
    let some = run.csv().1;
    assert_eq!(
        some.iter().map(|row| row[0]).collect::<Vec<_>>(),
        [0.0, 1.0 / 7.0, 0.2, 0.2, 0.25]
    );
    assert_eq!((&some[0], &some[2], &some[4]), (&all[0], &all[2], &all[3]));
    let only = lie(&format!("{BODY} --method gauss4 --step 1/10 --at 0.25"))
        .ok()
        .csv()
        .1;
    assert_eq!(
        only,
        [all[3].clone()],
        "the row of t = 0 is not written unless it is asked for"
    );
}

#[test]
fn rows_at_equal_distances_are_those_at_their_times() {
    let rows = |call: &str| lie(&format!("{BODY} --method gauss4 {call}")).ok().csv().1;
    let equal = rows("--step 1/10 --rows 0:1:4");
    assert_eq!(equal, rows("--step 1/10 --at 0,1/3,2/3,1"));
    assert_eq!(
        rows("--step 0.3 --rows sqrt(2)/4:1/2:3 --until 2"),
        rows("--step 0.3 --at sqrt(2)/4,(sqrt(2)/4+1/2)/2,1/2")
    );
    // backwards, and from the far end
    let backwards = rows("--step -0.3 --rows 0:-1:5 --until -1");
    assert_eq!(backwards, rows("--step -0.3 --at 0,-0.25,-0.5,-0.75,-1"));
    assert_eq!(rows("--rows 2:1:5"), rows("--rows 1:2:5"));
    // the step is that of the whole run
    let until = rows("--tol 1e-6 --until 10 --rows 0:5:3");
    let at = rows("--tol 1e-6 --at 0,2.5,5,10");
    assert_eq!(until, at[..3]);
    assert_ne!(until[2], rows("--tol 1e-6 --rows 0:5:3")[2], "a control");
}

#[test]
fn rows_at_equal_distances_that_cannot_be() {
    for (call, says, help) in [
        ("--rows 0:1", "is not T1:T2:COUNT", "--rows 0:10:101"),
        ("--rows 0:1:0", "at least 1", "the number of rows"),
        ("--rows 0:1:1", "cannot be both ends", "--at 2.5"),
        ("--rows 0:1:1e9", "1000000000 rows", "--every"),
        ("--rows 0:x:3", "x", ""),
        ("--rows 0:1:3 --every 2", "excludes `--every`", "leave out"),
        ("--rows 0:1:3 --at 1", "excludes `--at`", "leave out"),
        (
            "--rows 0:20:3 --until 10",
            "beyond the end, t = 10.0",
            "--until 20",
        ),
        (
            "--rows -1:1:3 --until 10",
            "before the start, t = 0.0",
            "--from",
        ),
        (
            "--rows 1:2:3 --from 1.5",
            "before the start, t = 1.5",
            "--from",
        ),
        (
            "--rows 0:1:3 --step -0.1 --until 1",
            "lead away",
            "--step 0.1",
        ),
    ] {
        let run = lie(&format!("{BODY} {call}"));
        assert_eq!(run.code, Some(2), "{call}: {}", run.stderr);
        for text in [says, help, "command line: --"] {
            assert!(run.stderr.contains(text), "{call}: {}", run.stderr);
        }
    }
}

#[test]
fn backwards_in_time() {
    let there = lie(&format!("{BODY} --method lie-midpoint --step 0.1 --at 1"))
        .ok()
        .csv()
        .1;
    let state = there[0][1..4]
        .iter()
        .map(f64::to_string)
        .collect::<Vec<_>>()
        .join(",");
    let back = lie(&format!(
        "{BODY} --method lie-midpoint --step -0.1 --until -1 --initial {state}"
    ));
    let rows = back.ok().csv().1;
    let start = [1.1f64.cos(), 0.0, 1.1f64.sin()];
    let last = rows.last().map(|row| row[..4].to_vec()).unwrap_or_default();
    assert_eq!(last[0], -1.0);
    for (found, expected) in last[1..].iter().zip(start) {
        assert!(
            (found - expected).abs() < 1e-13,
            "a symmetric method returns: {last:?}"
        );
    }
    let folder = folder();
    let path = spec(folder.path(), |_| ());
    let call = format!("run {} --quiet --method rk4 --at -1,-0.5", path.display());
    let free = lie(&call).ok().csv().1;
    assert_eq!(
        free.iter().map(|row| row[0]).collect::<Vec<_>>(),
        [-0.5, -1.0],
        "the default step follows the end"
    );
}

#[test]
fn parameters_and_initial_state() {
    let run = lie(&format!(
        "{BODY} --method rk4 --step 0.1 --until 0 --param I1=1/2 --initial 1,2,-1/3"
    ));
    let (_, rows) = run.ok().csv();
    let energy = 1.0 / 1.0 + 4.0 / 2.0 + (1.0 / 9.0) / (2.0 * 2.0 / 3.0);
    assert_eq!(rows.len(), 1);
    assert_eq!(rows[0][1..4], [1.0, 2.0, -1.0 / 3.0]);
    assert!((rows[0][4] - energy).abs() < 1e-15, "{rows:?}");
}

#[test]
fn a_parameter_declared_positive_is_positive() {
    let spec = "tests/data/declarations/pass/positive_parameters.json";
    let base = format!("run {spec} --method rk4 --step 0.1 --until 0.1 --quiet");
    for value in ["-1", "0", "cos(2)"] {
        let run = lie(&format!("{base} --param I1={value}"));
        assert_eq!(run.code, Some(2), "{}", run.stderr);
        let expected = "error[option]: the parameter `I1` must be positive";
        assert!(run.stderr.starts_with(expected), "{}", run.stderr);
        assert!(run.stderr.contains("--> command line: --param"));
        assert!(run.stdout.is_empty());
    }
}

#[test]
fn the_spec_has_the_defaults_and_flags_win() {
    let folder = folder();
    let path = spec(folder.path(), |spec| {
        spec["run"] = serde_json::json!({ "method": "dopri5", "step": "1/4", "until": 1, "rtol": 1e-11, "atol": 1e-12 });
    });
    let call = |flags: &str| lie(&format!("run {} {flags}", path.display())).ok();
    let run = call("");
    assert_eq!(run.csv().1.len(), 5);
    assert!(
        run.stderr.contains("Body, dopri5, step 1/4: "),
        "{}",
        run.stderr
    );
    let fine = run.csv().1[4][1];
    let coarse = call("--rtol 1e-3 --atol 1e-3 --quiet").csv().1[4][1];
    let exact = call("--method gauss6 --step 0.001 --every 1000 --quiet")
        .csv()
        .1[1][1];
    assert!((fine - exact).abs() < 1e-10, "{fine} {exact}");
    assert!(
        (coarse - exact).abs() > 1e-10,
        "tolerances arrive: {coarse} {exact}"
    );
    assert_eq!(call("--at 0.5 --quiet").csv().1.len(), 1);
}

#[test]
fn the_form_of_the_output() {
    let folder = folder();
    let out = |name: &str| folder.path().join(name);
    let base = format!("{BODY} --method midpoint --step 0.1 --until 1");
    let rows = lie(&base).ok().csv();
    let to = |name: &str, flags: &str| {
        let run = lie(&format!("{base} --out {} {flags}", out(name).display())).ok();
        assert!(run.stdout.is_empty() && run.stderr.is_empty());
        std::fs::read(out(name)).expect("the file is there")
    };
    assert_eq!(csv(&String::from_utf8_lossy(&to("a.csv", ""))), rows);
    let json: serde_json::Value = serde_json::from_slice(&to("a.json", "")).expect("JSON");
    assert_eq!(json["columns"].as_array().map(Vec::len), Some(6));
    let last = json["rows"][10][1].as_f64().unwrap_or(f64::NAN);
    assert!((last - rows.1[10][1]).abs() < 1e-15);
    assert_eq!(json["status"], "done");
    let npy = to("a.npy", "");
    assert!(npy.starts_with(b"\x93NUMPY") && String::from_utf8_lossy(&npy).contains("(11, 6)"));
    assert_eq!(npy.len(), 128 + 11 * 6 * 8);
    // The same through a pipe, where nothing can be rewound.
    let piped = crate::common::command(base.split(' ').chain(["--format", "npy"]))
        .output()
        .expect("lie starts");
    assert_eq!(piped.stdout, npy);
    assert_eq!(to("b.txt", "--format json"), to("a.json", ""));
}

#[test]
fn a_picture() {
    let folder = folder();
    let path = folder.path().join("a.svg");
    let flags = format!(
        "--method lie-midpoint --step 0.01 --until 50 --out /dev/null --plot {}",
        path.display()
    );
    lie(&format!("run specs/se3_heavy_top.json --quiet {flags}")).ok();
    let svg = std::fs::read_to_string(path).expect("the picture is there");
    for text in [
        "HeavyTop",
        "lie-midpoint, h = 0.01",
        "m1",
        "g3",
        "vertical_momentum",
        "energy",
    ] {
        assert!(svg.contains(text), "{text}");
    }
    assert!(svg.len() < 500_000);
}

#[test]
fn an_integration_that_stops_keeps_its_rows() {
    let folder = folder();
    let out = folder.path().join("rows.csv");
    // H = log(z) drives z to 0, where nothing is left to integrate.
    let path = spec(folder.path(), |spec| {
        spec["hamiltonian"] = "x^4*y^3*50 + exp(20*x*z)".into();
        spec["initial"] = serde_json::json!([1, 1, 1]);
    });
    let run = lie(&format!(
        "run {} --method midpoint --step 0.5 --until 500 --out {}",
        path.display(),
        out.display()
    ));
    assert_eq!(run.code, Some(3), "{}", run.stderr);
    assert!(
        run.stderr
            .contains("error: the integration stopped in step "),
        "{}",
        run.stderr
    );
    assert!(
        run.stderr.contains(" at t = ") && run.stderr.contains("help: "),
        "{}",
        run.stderr
    );
    let (header, rows) = csv(&std::fs::read_to_string(out).expect("the rows are there"));
    assert!(!rows.is_empty() && rows.iter().all(|row| row.len() == header.len()));
}

/// A flow of a splitting jumps from x > 0 to x < 0, where log(x) is none.
#[test]
fn a_step_over_a_singularity_stops_the_run() {
    let folder = folder();
    let out = folder.path().join("rows.csv");
    let path = spec(folder.path(), |spec| {
        spec["hamiltonian"] = "log(x) + y^2 + z^4".into();
        spec["initial"] = serde_json::json!([0.3, 0.7, 0.4]);
    });
    let run = lie(&format!(
        "run {} --method splitting2 --pieces coordinate --step 0.35 --until 30 --out {}",
        path.display(),
        out.display()
    ));
    assert_eq!(run.code, Some(3), "{}", run.stderr);
    let reason = "the Hamiltonian is not finite at the end of the step";
    assert!(run.stderr.contains(reason), "{}", run.stderr);
    let (_, rows) = csv(&std::fs::read_to_string(out).expect("the rows are there"));
    assert!(rows.len() > 5 && rows.iter().flatten().all(|value| value.is_finite()));
}

/// Points of a representation, from its columns, move as the state does, whatever the invariance.
#[test]
fn methods_on_points_of_a_right_invariant_system() {
    let end = |method: &str| {
        let run = lie(&format!(
            "run tests/data/declarations/pass/right_invariance.json --quiet --method {method} --step 0.01 --until 1"
        ));
        let (_, rows) = run.ok().csv();
        rows.last().expect("the last row")[1..4].to_vec()
    };
    let exact = end("gauss8");
    for method in ["isospectral8", "collective8", "collective16"] {
        for (one, other) in end(method).iter().zip(&exact) {
            assert!((one - other).abs() < 1e-12, "{method}: {one} and {other}");
        }
    }
}

/// The increments of a rotation at a constant rate are linear in time: their high coefficients are round-off, single ones zero.
#[test]
fn a_series_whose_last_terms_are_round_off_goes_on() {
    let folder = folder();
    let path = spec(folder.path(), |spec| {
        spec["hamiltonian"] = "(x + y + z)^2".into();
        spec["initial"] = serde_json::json!(["3/10", "2/5", "1/2"]);
    });
    for tolerance in ["1e-12", "1e-15"] {
        let run = lie(&format!(
            "run {} --quiet --method lie-taylor --rtol {tolerance} --step 1/20 --until 7",
            path.display()
        ));
        assert_eq!(run.ok().csv().1.len(), 141);
    }
}

/// A program of each processor has packages of its own.
#[test]
#[ignore = "a minute: .ci/nightly runs it"]
fn fused_multiply_add_has_other_bits_and_is_asked_for() {
    let flags = "--method rk4 --step 0.05 --until 2";
    let portable = lie(&format!("{BODY} {flags} --cpu portable")).ok().stdout;
    let native = lie(&format!("{BODY} {flags}")).ok().stdout;
    assert_eq!(portable, native);
    let fused = lie(&format!("{BODY} {flags} --fma"));
    if fused.code == Some(2) {
        fused.says("option", "--fma");
        return;
    }
    let fused = fused.ok().stdout;
    assert_ne!(fused, native);
    let (_, native) = csv(&native);
    let (_, fused) = csv(&fused);
    for (row, other) in native.iter().flatten().zip(fused.iter().flatten()) {
        assert!(
            (row - other).abs() <= 1e-14 * row.abs().max(1.0),
            "{row} {other}"
        );
    }
}

#[test]
fn fused_multiply_add_is_for_the_processor_at_hand() {
    let run = lie(&format!("{BODY} --fma --cpu portable"));
    run.error("option", "command line: --fma");
}

#[test]
#[cfg(target_os = "linux")]
fn files_that_cannot_be_written() {
    let base = format!("{BODY} --method midpoint --step 0.01 --until 100");
    let run = lie(&format!("{base} --out /nowhere/a.csv"));
    assert_eq!(run.code, Some(1));
    run.says("io", "/nowhere/a.csv");
    let run = lie(&format!("{base} --plot /nowhere/a.svg"));
    assert_eq!(run.code, Some(1));
    run.says("io", "/nowhere/a.svg");
    let run = lie(&format!("{base} --out /dev/full"));
    assert_eq!(run.code, Some(1));
    assert!(run.says("io", "/dev/full").stderr.contains("No space left"));
}

#[test]
fn the_first_row_of_every_spec_is_its_initial_state() {
    for entry in std::fs::read_dir("specs")
        .expect("the specs are there")
        .flatten()
    {
        let path = entry.path();
        let name = path.to_string_lossy().into_owned();
        if name.ends_with("schema.json") || path.extension() != Some("json".as_ref()) {
            continue;
        }
        let (header, rows) = lie(&format!(
            "run {name} --quiet --method rk4 --step 0.01 --until 0.1"
        ))
        .ok()
        .csv();
        assert_eq!(rows.len(), 11, "{name}");
        let energy = header
            .iter()
            .position(|column| column == "energy")
            .unwrap_or(0);
        assert!(
            (rows[10][energy] - rows[0][energy]).abs() < 1e-7,
            "{name}: {rows:?}"
        );
    }
    assert!(Path::new("specs").is_dir());
}

/// The iterations of each step, as the summary says.
fn iterations(run: &Run) -> f64 {
    let (before, _) = run
        .stderr
        .split_once(" iterations per step")
        .expect("a summary");
    // before the word for their kind
    let number = before.rsplit(' ').nth(1).unwrap_or_default();
    number.parse().expect("a number")
}

#[test]
fn the_solver_of_implicit_methods_is_chosen() {
    let folder = folder();
    let path = spec(folder.path(), |spec| {
        spec["run"] = serde_json::json!({ "method": "midpoint", "step": 0.1, "until": 1 });
    });
    let call = |flags: &str| lie(&format!("run {} {flags}", path.display()));
    let automatic = call("").ok();
    let same = call("--iteration automatic --newton-tolerance 1/1024 --max-iterations 50").ok();
    assert_eq!(automatic.stdout, same.stdout);
    let newton = call("--iteration newton").ok();
    let (rows, end) = (newton.csv().1, newton.csv().1.len() - 1);
    for iteration in ["automatic", "simplified", "fixed-point"] {
        let other = call(&format!("--iteration {iteration}")).ok();
        let more = iteration == "automatic" || iterations(&other) > iterations(&newton);
        assert!(more, "{iteration}");
        for (a, b) in rows[end].iter().zip(&other.csv().1[end]) {
            assert!((a - b).abs() < 1e-14, "{iteration}: {a} {b}");
        }
    }
    // a solution that is not one: the tolerance arrives
    let coarse = call("--newton-tolerance 1e12").ok();
    assert!(iterations(&coarse) < iterations(&newton));
    assert_ne!(coarse.stdout, newton.stdout);
    let stopped = call("--iteration fixed-point --max-iterations 2");
    assert_eq!(stopped.code, Some(3), "{}", stopped.stderr);
    // the same as keys of the spec; a flag chooses another method, to which they do not belong
    let path = spec(folder.path(), |spec| {
        spec["run"] = serde_json::json!({
            "method": "midpoint", "step": 0.1, "until": 1, "iteration": "fixed-point",
            "newton-tolerance": "1/2", "max-iterations": 2
        });
    });
    let in_spec = lie(&format!("run {}", path.display()));
    assert_eq!(in_spec.code, Some(3), "{}", in_spec.stderr);
    lie(&format!("run {} --method rk4 --quiet", path.display())).ok();
}

#[test]
fn a_tolerance_chooses_step_and_method() {
    let end = |options: &str| {
        let run = lie(&format!(
            "run specs/so3_free_rigid_body.json --at 20 {options}"
        ))
        .ok();
        (run.csv().1[0][1..4].to_vec(), run.stderr)
    };
    let (exact, _) = end("--method gauss16 --step 0.1");
    let error = |state: &[f64]| {
        let pairs = state.iter().zip(&exact);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    for tolerance in [1e-4, 1e-8] {
        let (state, said) = end(&format!("--tol {tolerance:e}"));
        assert!(error(&state) < 10.0 * tolerance, "{tolerance:e}: {state:?}");
        assert!(said.contains("gauss16 was picked"), "{said}");
        let (state, said) = end(&format!("--tol {tolerance:e} --method gauss6"));
        assert!(error(&state) < 10.0 * tolerance, "{tolerance:e}: {state:?}");
        assert!(
            !said.contains("picked") && said.contains("gauss6, tolerance"),
            "{said}"
        );
    }
    let (coarse, _) = end("--tol 1e-2 --method midpoint");
    assert!(error(&coarse) > 1e-8, "a tolerance is used");
    let (_, said) = end("--tol 1e-6 --method gauss16");
    assert!(
        !said.contains("second run") && !said.contains("kept as far"),
        "{said}"
    );
    let (_, said) = end("--tol 1e-6 --method gauss16 --converge tolerance --assess");
    for expected in ["is kept as far: energy ", "the error at the end is about "] {
        assert!(said.contains(expected), "{said}");
    }
    let (_, said) = end("--step 0.5 --method gauss4 --assess");
    assert!(said.contains("of the state, by a second run"), "{said}");

    let json = lie(&format!("{BODY} --tol 1e-6 --until 3 --format json")).ok();
    let value: serde_json::Value = serde_json::from_str(&json.stdout).expect("JSON");
    let step = value["step"].as_f64().expect("the step that was chosen");
    let rows = value["rows"].as_array().expect("rows");
    assert!(
        (3.0 / step - (rows.len() - 1) as f64).abs() < 1e-9,
        "{step}"
    );
    assert_eq!(rows.last().and_then(|row| row[0].as_f64()), Some(3.0));
}

#[test]
fn a_tolerance_that_cannot_be_is_refused() {
    for (options, text) in [
        ("--tol 0", "a tolerance lies between 2e-15"),
        ("--tol 1", "a tolerance lies between 2e-15"),
        (
            "--tol 1e-6 --step 0.1",
            "a tolerance and a step are both given",
        ),
        ("--tol 1e-6 --method dopri5", "dopri5 chooses its own steps"),
        ("--tol small", "error"),
        (
            "--method gauss16 --step 0.1 --converge tolerance",
            "the run has no tolerance",
        ),
        ("--tol 1e-6 --at=-1,1", "lie on both sides of t = 0"),
    ] {
        let run = lie(&format!("{BODY} {options}"));
        assert_eq!(run.code, Some(2), "{options}: {}", run.stderr);
        assert!(run.stderr.contains(text), "{options}: {}", run.stderr);
        assert!(run.stderr.contains("help: "), "{options}: {}", run.stderr);
    }
}

#[test]
fn nothing_is_said_to_be_unknown_where_the_error_is_zero() {
    for options in ["--until 0", "--initial 0,0,0"] {
        let run = lie(&format!(
            "run specs/so3_free_rigid_body.json --tol 1e-8 {options}"
        ))
        .ok();
        assert!(run.stderr.contains("tolerance 1e-8"), "{}", run.stderr);
        assert!(!run.stderr.contains("warning"), "{options}: {}", run.stderr);
    }
}
