//! Several runs by one call of `lie run`: methods, values of parameters, initial states.

use crate::common::{Run, csv, folder, lie};

const BODY: &str = "run specs/so3_free_rigid_body.json --step 0.1 --until 1";

/// The rows of a CSV behind so many columns that are text or tell the run apart.
fn rows(run: &Run, labels: usize) -> Vec<(Vec<String>, String)> {
    let lines = run.stdout.lines().skip(1);
    let split = |line: &str| {
        let fields: Vec<String> = line.split(',').map(str::to_owned).collect();
        (fields[..labels].to_vec(), fields[labels..].join(","))
    };
    lines.map(split).collect()
}

/// The rows of one run alone.
fn alone(flags: &str) -> Vec<String> {
    let run = lie(&format!("{BODY} --quiet {flags}")).ok();
    run.stdout.lines().skip(1).map(str::to_owned).collect()
}

#[test]
fn each_of_several_runs_is_the_run_alone() {
    let folder = folder();
    let states = folder.path().join("states.csv");
    // names in another order, exact constants, a comment and an empty line
    std::fs::write(&states, "z,x,y\n# two states\n3,1,2\n\n1/2, 1/3, -1\n").expect("written");
    let call = format!("--param I1=1:2:3 --initial-file {}", states.display());
    let (first, second) = ("rk4", "gauss4");
    let run = lie(&format!("{BODY} --method {first} --method {second} {call}")).ok();
    let header = run.stdout.lines().next().expect("a header");
    assert_eq!(header, "run,method,I1,t,x,y,z,energy,norm2");
    let found = rows(&run, 3);
    let mut expected = Vec::new();
    for method in [first, second] {
        for value in ["1.0", "1.5", "2.0"] {
            for state in ["1,2,3", "1/3,-1,1/2"] {
                let number = expected.len() / 11;
                let flags = format!("--method {method} --param I1={value} --initial {state}");
                for row in alone(&flags) {
                    let labels = [number.to_string(), method.to_owned(), value.to_owned()];
                    expected.push((labels.to_vec(), row));
                }
            }
        }
    }
    assert_eq!(found.len(), 12 * 11);
    assert!(found == expected, "the runs differ from those alone");
    // a line for each run
    let named = "run 7, gauss4, I1 = 1.0: 10 steps";
    assert!(run.stderr.contains(named), "{}", run.stderr);
}

#[test]
fn options_go_to_the_methods_that_have_them() {
    let two = "--method rk4 --method lie-midpoint --retraction cayley";
    let run = lie(&format!("{BODY} --quiet {two}")).ok();
    let found = rows(&run, 2);
    let cayley = alone("--method lie-midpoint --retraction cayley");
    assert_ne!(cayley, alone("--method lie-midpoint"));
    let second: Vec<String> = found[11..].iter().map(|(_, row)| row.clone()).collect();
    assert_eq!(second, cayley);
    assert_eq!(found[11].0[1], "lie-midpoint --retraction cayley");
    // written behind the method
    let folder = folder();
    let out = folder.path().join("rows.json");
    let path = out.display().to_string();
    let mut call: Vec<&str> = BODY.split(' ').chain(["--quiet", "--out", &path]).collect();
    call.extend(["--method", "lie-midpoint --retraction cayley", "--method"]);
    call.push("lie-midpoint");
    let output = crate::common::command(call).output().expect("lie runs");
    assert!(output.status.success());
    let text = std::fs::read_to_string(&out).expect("rows");
    let value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let last = |run: usize| {
        let row = &value["runs"][run]["rows"][10];
        let numbers = row.as_array().expect("a row").iter();
        let numbers: Vec<String> = numbers
            .map(|n| format!("{:?}", n.as_f64().unwrap()))
            .collect();
        numbers.join(",")
    };
    assert_eq!(Some(&last(0)), cayley.last());
    assert_eq!(Some(&last(1)), alone("--method lie-midpoint").last());
    // but an option of none of them is a mistake
    let wrong = lie(&format!(
        "{BODY} --method rk4 --method midpoint --lift hopf"
    ));
    wrong.error("option", "command line: --lift");
}

#[test]
fn a_run_that_stops_early_does_not_keep_the_others_from_theirs() {
    let call = "run specs/so3_free_rigid_body.json --step 3 --until 20 --initial 1,1000,1";
    let run = lie(&format!("{call} --method rk4 --method midpoint"));
    assert_eq!(run.code, Some(3));
    assert!(
        run.stderr
            .contains("error: run 0, rk4: the integration stopped")
    );
    assert!(!run.stderr.contains("0 iterations"), "rk4 solves nothing");
    let of = |number: &str| {
        let all = rows(&run, 2);
        all.iter().filter(|(labels, _)| labels[0] == number).count()
    };
    assert!(of("0") < 8, "rk4 stops");
    assert_eq!(of("1"), 8);
}

#[test]
fn an_array_has_the_numbers_of_the_runs() {
    let folder = folder();
    let out = folder.path().join("rows.npy");
    let call = format!("{BODY} --quiet --param I1=1:2:5 --out {}", out.display());
    lie(&call).ok();
    let bytes = std::fs::read(&out).expect("an array");
    let head = String::from_utf8_lossy(&bytes[..128]).into_owned();
    assert!(head.contains("'shape': (55, 8)"), "{head}");
    let number = |at: usize| f64::from_le_bytes(bytes[128 + 8 * at..][..8].try_into().unwrap());
    assert_eq!([number(8 * 54), number(8 * 54 + 1)], [4.0, 2.0]);
    // states from an array give the same runs as those from text
    let numbers = [1.0_f64, 2.0, 3.0, 0.5, 0.25, -1.0];
    let mut array = b"\x93NUMPY\x01\x00".to_vec();
    let head = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }";
    array.extend(118_u16.to_le_bytes());
    array.extend(format!("{head:<117}\n").bytes());
    array.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    let (states, text) = (folder.path().join("s.npy"), folder.path().join("s.csv"));
    std::fs::write(&states, array).expect("written");
    std::fs::write(&text, "1,2,3\n0.5,0.25,-1\n").expect("written");
    let of = |path: &std::path::Path| {
        lie(&format!("{BODY} --quiet --initial-file {}", path.display()))
            .ok()
            .stdout
    };
    assert_eq!(of(&states), of(&text));
    assert_eq!(csv(&of(&text)).1.len(), 22);
    // a state at which H is not finite stands in its row
    let pole = r#"{"format": 1, "name": "Pole", "algebra": "so(3)", "state": ["x", "y", "z"], "hamiltonian": "1/(x - 1/2) + y^2"}"#;
    let spec = folder.path().join("pole.json");
    std::fs::write(&spec, pole).expect("written");
    let call = |path: &std::path::Path| {
        let [spec, path] = [&spec, path].map(|path| path.display().to_string());
        lie(&format!(
            "run {spec} --until 1 --step 0.1 --initial-file {path}"
        ))
    };
    call(&states).error("domain", &format!("{}, row 1", states.display()));
    call(&text).error("domain", &format!("{}:2:1", text.display()));
}

#[test]
fn many_runs_are_summed_up() {
    let run = lie(&format!(
        "{BODY} --param I1=1:2:100 --method rk4 --method midpoint"
    ))
    .ok();
    assert!(!run.stderr.contains("run 0, "), "{}", run.stderr);
    assert!(
        run.stderr.contains("rk4: 100 runs, 1000 steps in total"),
        "{}",
        run.stderr
    );
    // the worst run, found again among the rows
    let drift = |row: &str, first: &str| {
        let energy = |row: &str| row.split(',').nth(4).unwrap().parse::<f64>().unwrap();
        ((energy(row) - energy(first)) / energy(first)).abs()
    };
    let all = rows(&run, 3);
    let of = |number: usize| {
        let own: Vec<&String> = all[11 * number..][..11]
            .iter()
            .map(|(_, row)| row)
            .collect();
        own.iter().map(|row| drift(row, own[0])).fold(0.0, f64::max)
    };
    let worst = (0..100)
        .max_by(|a, b| of(*a).total_cmp(&of(*b)))
        .expect("runs");
    let line = format!("energy {:.1e} (run {worst})", of(worst));
    assert!(run.stderr.contains(&line), "{line}: {}", run.stderr);
}

#[test]
fn mistakes_have_their_place_and_a_remedy() {
    let folder = folder();
    let states = folder.path().join("states.csv");
    let path = states.display().to_string();
    let with = |text: &str| {
        std::fs::write(&states, text).expect("written");
        lie(&format!("{BODY} --initial-file {path}"))
    };
    with("x,y,z\n1,2\n").error("state-length", &format!("{path}:2:1"));
    with("1,2\n").error("state-length", &format!("{path}:1:1"));
    with("a,b,c\n1,2,3\n").error("option", &format!("{path}:1:1"));
    let run = with("1,2\n3,4\n5,6\n").error("state-length", &format!("{path}:1:1"));
    let once = "2 values for a state of 3, as in 2 more rows";
    assert!(run.stderr.contains(once), "{}", run.stderr);
    assert_eq!(run.stderr.matches("error[").count(), 1, "{}", run.stderr);
    with("\u{feff}x,y,z\n1,2,3\n").ok();
    for (text, said) in [
        ("1;2;3\n", "no commas stand between these numbers"),
        ("1 2 3\n", "no commas stand between these numbers"),
        ("1\t2\t3\n", "no commas stand between these numbers"),
        ("t,x,y,z\n0,1,2,3\n", "`t` is not the name of a coordinate"),
        ("x,y\n1,2\n", "these are not the names of the coordinates"),
    ] {
        let run = with(text).error("option", &format!("{path}:1:1"));
        assert!(run.stderr.contains(said), "{text}: {}", run.stderr);
    }
    with("1,2,3\n1,2,what\n").error("option", &format!("{path}:2:1"));
    with("# nothing\n").error("io", &path);
    lie(&format!("{BODY} --initial-file {path}.none")).error("io", &format!("{path}.none"));
    for (flags, place) in [
        ("--param I1=1:2", "--param"),
        ("--param I1=1:2:0", "--param"),
        ("--param I1=1:2:3.5", "--param"),
        ("--param I1=1:2:1", "--param"),
        ("--param what=1:2:3", "--param"),
        ("--method rk4 --method rk4", "--method"),
        ("--method rk4 --method rk5", "--method"),
    ] {
        let run = lie(&format!("{BODY} {flags}"));
        let kind = if flags.contains("rk5") {
            "method"
        } else {
            "option"
        };
        run.error(kind, &format!("command line: {place}"));
    }
    lie(&format!("{BODY} --param I1=1:2:10000000")).error("limit", "command line: --param");
    lie(&format!("{BODY} --initial 1,2,3 --initial-file {path}")).error("option", "");
}

#[test]
fn a_tolerance_of_several_runs_says_what_it_has_chosen() {
    let said = |options: &str| {
        let run = lie(&format!("run specs/so3_free_rigid_body.json {options}")).ok();
        run.stderr.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let run = said("--tol 1e-6 --until 5 --param I1=1:2:2");
    for text in [
        "gauss16 was picked in place of midpoint, which the spec names",
        "run 0, I1 = 1.0, step ",
        "run 1, I1 = 2.0, step ",
    ] {
        assert!(run.contains(text), "{text}: {run}");
    }
    assert_eq!(run.matches("was picked").count(), 1, "{run}");
    assert!(!run.contains("round-off of so many"), "{run}");
    let run = said("--tol 1e-14 --until 1 --method rk4 --param I1=1.5:2:2");
    assert!(
        run.contains("2 runs: the round-off of so many steps"),
        "{run}"
    );
    assert!(!run.contains("was picked"), "{run}");
}

#[test]
fn an_option_behind_a_method_and_as_a_flag_is_refused_where_no_other_method_takes_it() {
    let of = |other: &str| {
        let label = "lie-midpoint --retraction cayley";
        let methods = ["--method", other, "--method", label, "--retraction", "exp"];
        let output = crate::common::command(BODY.split_whitespace().chain(methods)).output();
        let output = output.expect("lie starts");
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        (output.status.code(), stderr)
    };
    let (code, stderr) = of("rk4");
    assert_eq!(code, Some(2), "{stderr}");
    assert!(stderr.contains("cayley` has its own"), "{stderr}");
    assert!(stderr.contains("leave out `--retraction`"), "{stderr}");
    let (code, stderr) = of("generating2");
    assert_eq!(code, Some(0), "{stderr}");
}
