//! Nothing is lost: files that are read stay, and what fails does not take the rest with it.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::common::{Run, command, folder, lie};

/// A body with a table, in a folder.
fn prepared(folder: &Path) {
    let spec = r#"{
        "format": 1, "name": "Body", "algebra": "so(3)", "state": ["x", "y", "z"],
        "functions": { "drag": { "table": "drag.csv" } },
        "hamiltonian": "x^2/2 + y^2/3 + z^2/4 + drag(x)", "initial": [0.3, 0.4, 0.5],
        "run": { "method": "rk4", "step": 0.1, "until": 1 }
    }"#;
    fs::write(folder.join("body.json"), spec).unwrap();
    fs::write(folder.join("drag.csv"), "-9,0.1\n-2,0.2\n0,0\n2,0.5\n9,1\n").unwrap();
    fs::write(folder.join("states.csv"), "0.1,0.2,0.3\n0.3,0.2,0.1\n").unwrap();
}

/// A call of `lie` within a folder.
fn within(folder: &Path, call: &str) -> Run {
    let mut command = command(call.split_whitespace());
    command.current_dir(folder).output().unwrap().into()
}

/// The same by a script of the shell, with `lie` as `"$0"`.
fn shell(folder: &Path, script: &str) -> Run {
    let mut shell = Command::new("bash");
    let shell = shell.args(["-c", script, env!("CARGO_BIN_EXE_lie")]);
    let shell = shell.env("LIE_CACHE_DIR", crate::common::cache());
    shell.current_dir(folder).output().unwrap().into()
}

/// All files with their texts.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let entries = fs::read_dir(folder).unwrap().map(Result::unwrap);
    let mut all: Vec<_> = entries
        .filter(|entry| entry.path().is_file())
        .map(|entry| {
            let name = entry.file_name().into_string().unwrap();
            (name, fs::read(entry.path()).unwrap())
        })
        .collect();
    all.sort();
    all
}

#[test]
fn no_output_is_an_input() {
    let folder = folder();
    let here = folder.path();
    prepared(here);
    fs::create_dir(here.join("sub")).unwrap();
    for (input, name) in [
        ("body.json", "spec"),
        ("drag.csv", "table"),
        ("states.csv", "states"),
    ] {
        for end in ["csv", "svg", "html", "npy"] {
            symlink(input, here.join(format!("soft_{name}.{end}"))).unwrap();
            fs::hard_link(here.join(input), here.join(format!("hard_{name}.{end}"))).unwrap();
        }
    }
    let before = files(here);
    let run = "run body.json --quiet --initial-file states.csv";
    let mut calls: Vec<(String, &str)> = ["spec", "table", "states"]
        .iter()
        .flat_map(|name| ["soft", "hard"].map(|kind| format!("{kind}_{name}")))
        .flat_map(|link| {
            [
                (format!("{run} --out {link}.csv"), "--out"),
                (format!("{run} --format csv --out {link}.npy"), "--out"),
                (format!("{run} --plot {link}.svg"), "--plot"),
                (format!("{run} --out new.csv --plot {link}.svg"), "--plot"),
            ]
        })
        .collect();
    for link in ["soft_spec", "hard_spec", "soft_table", "hard_table"] {
        calls.extend([
            (format!("report body.json --out {link}.html"), "--out"),
            (format!("bench body.json --quiet --out {link}.csv"), "--out"),
            (
                format!("bench body.json --quiet --plot {link}.svg"),
                "--plot",
            ),
            (
                format!("stress body.json --quiet --out {link}.csv"),
                "--out",
            ),
            (
                format!("stress body.json --quiet --plot {link}.svg"),
                "--plot",
            ),
        ]);
    }
    let spec = here.join("body.json");
    calls.extend([
        (
            "run body.json --format json --out sub/../body.json".to_owned(),
            "--out",
        ),
        (
            format!("run body.json --format json --out {}", spec.display()),
            "--out",
        ),
        ("run ./sub/../body.json --out drag.csv".to_owned(), "--out"),
        (
            "run hard_spec.npy --format csv --out body.json".to_owned(),
            "--out",
        ),
        ("report soft_spec.html".to_owned(), "--out"),
    ]);
    for (call, option) in &calls {
        let refused = within(here, call).error("option", &format!("command line: {option}"));
        assert!(refused.stdout.is_empty(), "{call}");
        assert!(refused.stderr.contains("would be overwritten"), "{call}");
        assert!(files(here) == before, "{call} has touched a file");
    }
    for script in [
        r#""$0" run body.json >> drag.csv"#,
        r#""$0" expand body.json >> body.json"#,
        r#""$0" check body.json 1<> hard_table.csv"#,
        r#""$0" run body.json --initial-file states.csv >> states.csv"#,
        r#""$0" run /dev/stdin --format json --out body.json < body.json"#,
    ] {
        let code = shell(here, script).code;
        assert_eq!(code, Some(2), "{script}");
        assert!(files(here) == before, "{script} has touched a file");
    }
    // rows and picture are two files, also where none of them is there yet
    symlink("rows.csv", here.join("rows.svg")).unwrap();
    within(here, "run body.json --out rows.csv --plot rows.svg")
        .error("option", "command line: --plot");
    assert!(files(here) == before);
    // the control: other files are written, a copy of the table among them
    fs::copy(here.join("drag.csv"), here.join("copy.csv")).unwrap();
    within(here, &format!("{run} --out copy.csv --plot new.svg")).ok();
    assert!(
        fs::read_to_string(here.join("copy.csv"))
            .unwrap()
            .starts_with("run,t,x,y,z")
    );
    within(
        here,
        "run body.json --quiet --out /dev/null --plot /dev/null --picture phase",
    )
    .code
    .unwrap();
}

#[test]
fn what_is_refused_later_leaves_files_as_they_were() {
    let folder = folder();
    let here = folder.path();
    prepared(here);
    for name in ["rows.csv", "rows.svg"] {
        fs::write(here.join(name), "precious").unwrap();
    }
    // how many steps a tolerance takes is found before the first row
    let call =
        "run body.json --method gauss16 --tol 1e-14 --until 1e300 --out rows.csv --plot rows.svg";
    within(here, call).error("option", "command line: --tol");
    for name in ["rows.csv", "rows.svg"] {
        assert_eq!(fs::read_to_string(here.join(name)).unwrap(), "precious");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn what_does_not_fit_into_memory_is_refused_beforehand() {
    let folder = folder();
    let here = folder.path();
    prepared(here);
    let chain = r#"{
        "format": 1, "name": "Chain", "algebra": "so(3)^N", "state": ["x[i]", "y[i]", "z[i]"],
        "parameters": { "N": 10, "J": 1 }, "hamiltonian": "J*sum(i in 0..N: z[i]*z[i+1])",
        "initial": { "random": "unit-sphere", "seed": 1 },
        "run": { "method": "rk4", "step": 0.1, "until": 0.3 }
    }"#;
    fs::write(here.join("chain.json"), chain).unwrap();
    let limited = |call: &str| shell(here, &format!(r#"ulimit -v 3000000; "$0" {call}"#));
    limited("run chain.json --param N=1000").ok();
    for (call, kind, place) in [
        (
            "run chain.json --param N=20000000",
            "limit",
            "command line: --param",
        ),
        (
            "run chain.json --param N=2000000000",
            "limit",
            "command line: --param",
        ),
        (
            "run chain.json --param N=10000 --param J=0:1:100000",
            "limit",
            "command line: --param",
        ),
        ("run body.json --initial-file /dev/zero", "io", "/dev/zero"),
    ] {
        let run = limited(&format!("{call} --out rows.csv")).says(kind, place);
        assert_eq!(run.code, Some(1), "{call}: {}", run.stderr);
        assert!(run.stderr.contains("memory"), "{}", run.stderr);
        assert!(!here.join("rows.csv").exists());
    }
    let rows = "ensemble body.json --members 2 --method rk4 --step 0.001 --until 1e9 --every 1";
    let run = limited(&format!("{rows} --out all.npy")).says("limit", "command line: --every");
    assert!(run.stderr.contains("memory"), "{}", run.stderr);
    assert!(!here.join("all.npy").exists());
}

/// Whether a picture has all that a whole run shows.
fn whole(picture: &str) -> bool {
    picture.trim_end().ends_with("</svg>") && picture.contains("rk4")
}

#[test]
fn a_reader_that_goes_away_does_not_take_the_picture_with_it() {
    let folder = folder();
    let here = folder.path();
    prepared(here);
    let run = "run body.json --step 0.001 --until 60 --quiet";
    within(here, &format!("{run} --out rows.csv --plot whole.svg")).ok();
    let picture = fs::read_to_string(here.join("whole.svg")).unwrap();
    for (number, rest) in [
        "| head -1",
        "--format npy | head -c 1",
        "--format jsonl | head -1",
        "2>&1 | head -1",
    ]
    .iter()
    .enumerate()
    {
        let quiet = if rest.starts_with("2>") {
            run.trim_end_matches(" --quiet")
        } else {
            run
        };
        let script = format!(r#""$0" {quiet} --plot {number}.svg {rest}; exit ${{PIPESTATUS[0]}}"#);
        let ended = shell(here, &script);
        assert_eq!(ended.code, Some(0), "{script}: {}", ended.stderr);
        let drawn = fs::read_to_string(here.join(format!("{number}.svg"))).unwrap();
        assert!(drawn == picture, "{script}");
    }
    // nobody waits for a picture: the run ends with its reader
    let months = r#"timeout 20 "$0" run body.json --step 0.001 --until 1e9 | head -1; exit ${PIPESTATUS[0]}"#;
    assert_eq!(shell(here, months).code, Some(0));
}

#[test]
fn stderr_that_is_closed_or_full_stops_nothing() {
    let folder = folder();
    let here = folder.path();
    prepared(here);
    for stderr in ["2>/dev/full", "2>&-", "2> >(true)"] {
        let script = format!(r#"sleep 0.1; "$0" run body.json --out rows.csv {stderr}"#);
        assert_eq!(shell(here, &script).code, Some(0), "{stderr}");
        assert_eq!(
            fs::read_to_string(here.join("rows.csv"))
                .unwrap()
                .lines()
                .count(),
            12
        );
    }
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_keeps_rows_and_picture_and_says_so() {
    let folder = folder();
    let here = folder.path();
    prepared(here);
    let run = "run body.json --step 0.01 --until 1000 --quiet";
    for form in ["csv", "json", "jsonl", "npy"] {
        // 40 blocks of 1024 bytes
        let script = format!(r#"ulimit -f 40; "$0" {run} --out rows.{form} --plot {form}.svg"#);
        let ended = shell(here, &script);
        assert_eq!(ended.code, Some(1), "{form}: {}", ended.stderr);
        ended.says("io", &format!("rows.{form}"));
        let bytes = fs::read(here.join(format!("rows.{form}"))).unwrap();
        assert!(bytes.len() > 38_000, "{form}: {} bytes", bytes.len());
        let text = String::from_utf8_lossy(&bytes);
        match form {
            "json" => drop(serde_json::from_str::<serde_json::Value>(&text).unwrap()),
            "jsonl" => objects(&text),
            _ => {}
        }
        assert!(whole(
            &fs::read_to_string(here.join(format!("{form}.svg"))).unwrap()
        ));
    }
    // the picture does not fit, and the rows do
    let script = format!(r#"ulimit -f 2; "$0" {run} --every 9000 --out few.csv --plot large.svg"#);
    let ended = shell(here, &script);
    assert_eq!(ended.code, Some(1), "{}", ended.stderr);
    assert_eq!(
        fs::read_to_string(here.join("few.csv"))
            .unwrap()
            .lines()
            .count(),
        14
    );
    assert!(!here.join("large.svg").exists(), "a part of a picture");
}

/// Fails unless each line is an object with all columns.
#[track_caller]
fn objects(text: &str) {
    for line in text.lines() {
        let row: serde_json::Value = serde_json::from_str(line).expect(line);
        assert!(
            ["t", "x", "y", "z", "energy"]
                .iter()
                .all(|name| row[name].is_number()),
            "{line}"
        );
    }
}

#[test]
fn lines_of_json_survive_a_kill() {
    let folder = folder();
    let here = folder.path();
    prepared(here);
    for _ in 0..5 {
        let mut command =
            command("run body.json --step 0.001 --until 1e9 --out rows.jsonl".split(' '));
        let mut child = command
            .current_dir(here)
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        while fs::metadata(here.join("rows.jsonl")).map_or(0, |file| file.len()) < 50_000 {
            std::thread::yield_now();
        }
        child.kill().unwrap();
        child.wait().unwrap();
        let text = fs::read_to_string(here.join("rows.jsonl")).unwrap();
        let whole = text.rfind('\n').map_or(0, |end| end + 1);
        assert!(
            whole == text.len() || text.len().is_multiple_of(4096),
            "a row is cut"
        );
        objects(&text[..whole]);
        fs::remove_file(here.join("rows.jsonl")).unwrap();
    }
    let help = lie("run --help").ok().stdout;
    assert!(
        help.contains("jsonl") && help.contains("whatever ends the command"),
        "{help}"
    );
}

#[test]
fn a_driven_system_has_no_error_of_its_energy() {
    let folder = folder();
    let path = crate::common::spec(folder.path(), |spec| {
        spec["hamiltonian"] = "x^2/2 + y^2/4 + z^2/6 + cos(t)*x".into();
    });
    let run = lie(&format!("run {} --method gauss4 --until 3", path.display())).ok();
    let (_, said) = run.stderr.split_once("largest relative error").unwrap();
    assert!(
        !said.contains("energy") && said.contains("e-"),
        "{}",
        run.stderr
    );
    assert!(run.stdout.starts_with("t,x,y,z,energy"));
    let constant = crate::common::spec(folder.path(), |_| {});
    let run = lie(&format!(
        "run {} --method gauss4 --until 3",
        constant.display()
    ))
    .ok();
    assert!(
        run.stderr.contains("rows: energy"),
        "the control: {}",
        run.stderr
    );
}
