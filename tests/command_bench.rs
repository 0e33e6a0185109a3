//! `lie bench`: error against run time.

mod common;

use std::collections::BTreeMap;
use std::path::Path;

use common::{csv, folder, lie};

#[test]
fn points_picture_and_table() {
    let folder = folder();
    let (out, plot) = (
        folder.path().join("points.csv"),
        folder.path().join("p.svg"),
    );
    let run = lie(&format!(
        "bench specs/so3_nonpolynomial.json --methods midpoint,gauss4,rk4,dopri5 --until 2 --budget 0.002 --quiet \
         --out {} --plot {}",
        out.display(),
        plot.display()
    ))
    .ok();
    assert!(run.stderr.is_empty(), "{}", run.stderr);
    for name in ["midpoint", "gauss4", "rk4", "dopri5"] {
        assert!(
            run.stdout.lines().any(|line| line.starts_with(name)),
            "{name}: {}",
            run.stdout
        );
    }
    let text = std::fs::read_to_string(out).expect("points");
    let numbers: String = text
        .lines()
        .map(|line| line.split(',').skip(2).collect::<Vec<_>>().join(",") + "\n")
        .collect();
    let (header, rows) = csv(&numbers);
    assert_eq!(header[..3], ["value", "error", "seconds_per_unit_time"]);
    assert!(rows.len() > 20 && rows.iter().all(|row| row[2] > 0.0 && row[2] <= row[3]));
    assert_eq!(
        header[3..5],
        ["median_seconds_per_unit_time", "wall_seconds_per_unit_time"]
    );
    // the error of a method of order 4 falls by 2^4 where the step is halved
    let of = |method: &str| -> Vec<f64> {
        let lines = text.lines().filter(|line| line.starts_with(method));
        let field = |line: &str| line.split(',').nth(3).and_then(|f| f.parse().ok());
        lines.filter_map(field).collect()
    };
    let rk4 = of("rk4,");
    let ratio = rk4[3] / rk4[4];
    assert!((10.0..25.0).contains(&ratio), "{rk4:?}");
    let svg = std::fs::read_to_string(plot).expect("picture");
    assert!(
        svg.starts_with("<svg") && svg.contains(">gauss4<") && svg.trim_end().ends_with("</svg>")
    );
}

/// Points are told when they are found, and again with better times.
#[test]
fn each_point_is_there_once() {
    let folder = folder();
    let out = folder.path().join("points.csv");
    let measured = |methods: &str| -> Vec<String> {
        lie(&format!(
            "bench specs/so3_nonpolynomial.json {methods} --until 2 --budget 0.0005 --quiet --out {}",
            out.display()
        ))
        .ok();
        let text = std::fs::read_to_string(&out).expect("points");
        let runs = text.lines().skip(1);
        runs.map(|line| line.split(',').take(3).collect::<Vec<_>>().join(","))
            .collect()
    };
    for methods in ["--methods rk4,midpoint", "--method rk4 --method midpoint"] {
        let mut runs = measured(methods);
        assert!(
            runs.iter().any(|run| run.starts_with("rk4,step,")),
            "{runs:?}"
        );
        assert!(
            runs.iter().any(|run| run.starts_with("midpoint,step,")),
            "{runs:?}"
        );
        let all = runs.len();
        runs.sort();
        runs.dedup();
        assert!(all > 6 && runs.len() == all, "{runs:?}");
    }
}

#[test]
fn it_says_what_it_measures() {
    let call = "bench specs/so3_nonpolynomial.json --methods rk4 --until 2 --budget 0.0001 --quiet";
    let here = lie(call).ok().stdout;
    let said = "measured: machine code made by this command";
    assert!(here.contains(said), "{here}");
}

/// Where a run is computed changes its time and no bit of it: flags of one way against those of others.
fn same_errors(methods: &str, way: &str, others: &[&str], least: usize) {
    let folder = folder();
    let measured = |flags: &str| -> BTreeMap<String, String> {
        let out = folder.path().join("points.csv");
        lie(&format!(
            "bench specs/so3_nonpolynomial.json --until 2 --budget 0.002 --quiet {flags} --out {} --methods {methods}",
            out.display()
        ))
        .ok();
        let text = std::fs::read_to_string(out).expect("points");
        let points = text.lines().skip(1).map(|line| {
            let fields: Vec<_> = line.split(',').collect();
            (
                fields[..3].join(","),
                format!("{}, {} steps", fields[3], fields[7]),
            )
        });
        points
            .filter(|(run, _)| !run.starts_with("ode_solvers"))
            .collect()
    };
    let expected = measured(way);
    for flags in others {
        let found = measured(flags);
        let mut compared = 0;
        for (run, result) in &expected {
            // how many step sizes fit the budget depends on the machine's hour
            if let Some(other) = found.get(run) {
                assert_eq!(result, other, "{run}");
                compared += 1;
            }
        }
        assert!(compared > least, "{flags}: {compared}");
    }
}

#[test]
#[ignore = "half a minute, it builds a program: .ci/nightly runs it"]
fn a_program_and_the_command_give_the_same_errors() {
    let run = lie("bench specs/so3_nonpolynomial.json --methods midpoint --until 2 --budget 0.002 --quiet --compile").ok();
    for said in [
        "measured: a program built by cargo",
        "\node_solvers Dopri5",
        "\node_solvers Dop853",
    ] {
        assert!(run.stdout.contains(said), "{said}: {}", run.stdout);
    }
    same_errors("midpoint,gauss4,rk4,dopri5", "--compile", &[""], 15);
}

/// One method of each kind of step.
#[test]
#[ignore = "minutes: .ci/nightly runs it"]
fn every_processor_gives_the_same_errors() {
    let methods = "gauss6,gauss8,lie-midpoint,rkmk4,cf4,collective4,collective8,isospectral4,spherical-midpoint,\
         gonzalez,orbit-energy,cohen-hairer4,generating4,compose4(midpoint),dopri5";
    same_errors(methods, "--cpu native", &["--cpu portable", ""], 50);
}

#[test]
fn a_busy_machine_is_noticed() {
    use std::sync::atomic::{AtomicBool, Ordering};
    let bench = || {
        lie("bench specs/so3_nonpolynomial.json --methods midpoint,gauss4,rk4,dopri5 --until 2 --budget 0.002").ok()
    };
    let built = bench();
    assert!(built.stdout.contains("times: of the processor") || !cfg!(target_os = "linux"));
    if !cfg!(target_os = "linux") {
        return;
    }
    let over = AtomicBool::new(false);
    let threads = 4 * std::thread::available_parallelism().map_or(1, usize::from);
    let busy = std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while !over.load(Ordering::Relaxed) {
                    std::hint::spin_loop();
                }
            });
        }
        let busy = bench();
        over.store(true, Ordering::Relaxed);
        busy
    });
    let warning = busy
        .stderr
        .lines()
        .find(|line| line.starts_with("warning: "));
    let warning = warning.unwrap_or_else(|| panic!("no warning: {}{}", busy.stdout, busy.stderr));
    assert!(
        warning.contains("other programs had the processor"),
        "{warning}"
    );
}

/// A system whose solution from (1, 1) is at infinity at t = 1.
fn escaping(folder: &Path) -> String {
    let spec = serde_json::json!({
        "format": 1,
        "name": "Escaping",
        "algebra": { "basis": ["e1", "e2"], "brackets": ["[e1, e2] = e2"] },
        "state": ["a", "b"],
        "hamiltonian": "a*b",
        "initial": [1, 1],
    });
    let path = folder.join("escaping.json");
    std::fs::write(&path, spec.to_string()).expect("the spec is written");
    path.display().to_string()
}

/// Nothing is measured where the reference is not confirmed.
fn refused(spec: &str, flags: &str) {
    let folder = folder();
    let out = folder.path().join("points.csv");
    let run = lie(&format!(
        "bench {spec} --budget 0.001 --quiet {flags} --out {}",
        out.display()
    ));
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    let run = run.says("domain", "command line: --until");
    assert!(run.stderr.contains("not confirmed"), "{}", run.stderr);
    assert!(!out.exists(), "nothing was measured");
}

#[test]
fn a_reference_that_is_not_confirmed_stops_it() {
    let folder = folder();
    let spec = escaping(folder.path());
    refused(&spec, "--methods midpoint,rk4 --until 10");
    refused(&spec, "--methods midpoint,rk4 --until 10 --measure phase");
}

#[test]
#[ignore = "minutes: .ci/nightly runs it"]
fn a_reference_of_a_chaotic_solution_is_not_confirmed() {
    let flags = "--methods midpoint,gauss4,rk4,dopri5 --initial 6,-5,7";
    for span in ["--until 100000", "--until 1000 --measure phase"] {
        refused("specs/so3_nonpolynomial.json", &format!("{flags} {span}"));
    }
}

/// The rows of a measure by method, from coarse to fine; the runs begin with the same steps.
fn rows(spec: &str, flags: &str) -> BTreeMap<String, Vec<Vec<String>>> {
    let folder = folder();
    let out = folder.path().join("points.csv");
    lie(&format!(
        "bench specs/{spec}.json --budget 0.004 --quiet {flags} --out {}",
        out.display()
    ))
    .ok();
    let text = std::fs::read_to_string(out).expect("points");
    let mut rows: BTreeMap<String, Vec<Vec<String>>> = BTreeMap::new();
    for line in text.lines().skip(1) {
        let fields: Vec<String> = line.split(',').map(str::to_owned).collect();
        rows.entry(fields[0].clone()).or_default().push(fields);
    }
    rows
}

/// A column of rows.
fn column(rows: &BTreeMap<String, Vec<Vec<String>>>, column: usize) -> BTreeMap<String, Vec<f64>> {
    let number = |row: &Vec<String>| row[column].parse().expect("a number");
    rows.iter()
        .map(|(method, rows)| (method.clone(), rows.iter().map(number).collect()))
        .collect()
}

/// The errors of a measure by method.
fn errors(spec: &str, flags: &str) -> BTreeMap<String, Vec<f64>> {
    column(&rows(spec, flags), 3)
}

const NONPOLYNOMIAL: &str = "--methods midpoint,gauss4,rk4,dopri5 --until 2";
const BODY: &str = "--methods midpoint,rk4,dopri5 --until 10";

/// Where the halving of a step divides an error by 2^order.
fn falls_by(errors: &[f64], order: i32) -> bool {
    let ratio = errors[2] / errors[3];
    (0.7..1.4).contains(&(ratio / 2_f64.powi(order)))
}

#[test]
fn invariants_against_run_time() {
    let casimirs = errors(
        "so3_nonpolynomial",
        &format!("{NONPOLYNOMIAL} --measure casimirs"),
    );
    // both keep quadratic invariants at every step, the control at none
    for method in ["midpoint", "gauss4"] {
        assert!(casimirs[method][0] < 1e-14, "{method}: {casimirs:?}");
    }
    for method in ["rk4", "dopri5"] {
        assert!(casimirs[method][0] > 1e-8, "{method}: {casimirs:?}");
    }
    let energy = errors(
        "so3_nonpolynomial",
        &format!("{NONPOLYNOMIAL} --measure energy"),
    );
    assert!(falls_by(&energy["midpoint"], 2), "{energy:?}");
    assert!(falls_by(&energy["gauss4"], 4), "{energy:?}");
    assert!(!falls_by(&energy["gauss4"], 2), "{energy:?}");
}

/// A span over which no reference solution is confirmed, as `a_reference_of_a_chaotic_solution_is_not_confirmed` shows.
#[test]
fn invariants_need_no_reference() {
    let run = lie(
        "bench specs/so3_nonpolynomial.json --methods midpoint,gauss4,rk4,dopri5 --until 1000 --budget 0.001 \
         --quiet --initial 6,-5,7 --measure casimirs",
    )
    .ok();
    // a long line goes on below, moved in
    let said = run.stdout.replace("\n  ", " ");
    assert!(
        said.contains("drift of a Casimir") && !said.contains("reference"),
        "{said}"
    );
}

/// The midpoint rule keeps both invariants of a free rigid body: its orbit is exact, its time is not.
#[test]
fn the_phase_is_apart_from_the_orbit() {
    let rows = rows("so3_free_rigid_body", &format!("{BODY} --measure phase"));
    let (phase, across) = (column(&rows, 3), column(&rows, 10));
    let state = errors("so3_free_rigid_body", BODY);
    assert!(
        across["midpoint"].iter().all(|&error| error < 1e-13),
        "{across:?}"
    );
    assert!(across["rk4"][1] > 1e-6, "{across:?}");
    assert!(falls_by(&phase["midpoint"], 2), "{phase:?}");
    // what is wrong with the state is the time alone: their ratio is the speed, at every step
    let speeds: Vec<f64> = (3..6)
        .map(|k| state["midpoint"][k] / phase["midpoint"][k])
        .collect();
    assert!(
        speeds.iter().all(|s| (s / speeds[2] - 1.0).abs() < 0.05),
        "{speeds:?}"
    );
    assert!((0.01..2.0).contains(&speeds[2]), "{speeds:?}");
}

#[test]
fn sections_are_apart_from_the_phase() {
    let flags = format!("{BODY} --measure section --section x=0.1");
    let section = errors("so3_free_rigid_body", &flags);
    let midpoint = &section["midpoint"];
    assert!(
        midpoint.len() > 1 && midpoint.iter().all(|&error| error < 1e-13),
        "{section:?}"
    );
    let rk4 = &section["rk4"];
    assert!(rk4[0] > 1e-6 && rk4[0] / rk4[2] > 100.0, "{section:?}");
    let run = lie(&format!(
        "bench specs/so3_free_rigid_body.json {flags} --budget 0.002 --quiet"
    ))
    .ok();
    assert!(run.stdout.contains("x rises through 0.1"), "{}", run.stdout);
}

#[test]
fn wrong_measures() {
    let body = |rest: &str| {
        lie(&format!(
            "bench specs/so3_free_rigid_body.json {BODY} {rest}"
        ))
    };
    body("--measure momentum").error("option", "command line: --measure");
    body("--section x=0").error("option", "command line: --section");
    body("--measure section --section x").error("option", "command line: --section");
    body("--measure section --section X=0").error("option", "command line: --section");
    body("--measure section --section x=1/0").error("number", "command line: --section");
    let run = body("--measure section --section x=3").error("option", "command line: --section");
    assert!(run.stderr.contains("does not pass 3"), "{}", run.stderr);
    let run = lie("bench specs/canonical_pendulum.json --methods midpoint --measure casimirs");
    let run = run.error("option", "command line: --measure");
    assert!(run.stderr.contains("has no Casimir"), "{}", run.stderr);
    let run =
        lie("bench tests/data/declarations/pass/time.json --methods midpoint --measure energy")
            .error("option", "command line: --measure");
    let said = "H of Broken changes with the time";
    assert!(run.stderr.contains(said), "{}", run.stderr);
}

#[test]
fn wrong_options() {
    let bench = |rest: &str| lie(&format!("bench specs/so3_free_rigid_body.json {rest}"));
    bench("--methods nope").error("method", "command line: --methods");
    bench("--until 0").error("option", "command line: --until");
    let run = bench("--param I1=1:2:3").error("option", "command line: --param");
    assert!(run.stderr.contains("a range of values"), "{}", run.stderr);
    bench("--budget -1").error("option", "command line: --budget");
    bench("--plot specs/so3_free_rigid_body.json").error("option", "command line: --plot");
    let run = bench("--out /no/such/folder/x.csv");
    assert_eq!(run.code, Some(1));
    run.says("io", "/no/such/folder/x.csv");
}

/// What was measured is said where it cannot be written.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_the_table() {
    let folder = folder();
    let out = folder.path().join("full.csv");
    std::os::unix::fs::symlink("/dev/full", &out).expect("a link");
    let run = lie(&format!(
        "bench specs/so3_free_rigid_body.json --methods rk4 --until 1 --budget 0.01 --out {}",
        out.display()
    ));
    assert_eq!(run.code, Some(1));
    assert!(run.stdout.contains("to 1e-3") && run.stderr.contains("No space left"));
}
