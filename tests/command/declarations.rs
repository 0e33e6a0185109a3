//! Declarations sorted by intent: every mistake has its kind, its place, its remedy, and exit code
//! 2; what is unusual but valid passes. `tests/data/declarations/README.md` says what a place is.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use crate::common::{Run, command, folder, lie, spec};
use lie_syntax::diagnostic::Kind;

const DATA: &str = "tests/data/declarations";

/// The lines of a folder's `expected.txt`, as words.
fn expected(folder: &str) -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(format!("{DATA}/{folder}/expected.txt")).expect("the list");
    text.lines()
        .map(|line| line.split(' ').map(str::to_owned).collect())
        .collect()
}

fn files(folder: &str) -> BTreeSet<String> {
    let entries = std::fs::read_dir(format!("{DATA}/{folder}")).expect("the folder");
    let names = entries.map(|entry| {
        entry
            .expect("an entry")
            .file_name()
            .to_string_lossy()
            .into_owned()
    });
    names.filter(|name| name.ends_with(".json")).collect()
}

/// The titles of the errors.
fn errors(run: &Run) -> Vec<&str> {
    run.stderr
        .lines()
        .filter(|line| line.starts_with("error"))
        .collect()
}

/// Runs `lie COMMAND` on every file of a folder; each has one mistake, which must be reported alone.
#[track_caller]
fn refused(command: &str, folder: &str) {
    let mut wrong = Vec::new();
    let mut listed = BTreeSet::new();
    for line in expected(folder) {
        let [file, kind, place] = line.as_slice() else {
            panic!("{line:?}")
        };
        assert!(listed.insert(file.clone()), "{file} is listed twice");
        assert!(
            file.starts_with(&format!("{kind}__")),
            "{file} is named after its kind"
        );
        let path = format!("{DATA}/{folder}/{file}");
        let run = lie(&format!("{command} {path}"));
        let title = format!("error[{kind}]: ");
        let arrow = format!("--> {path}:{place}");
        let sound = run.code == Some(2)
            && run.stdout.is_empty()
            && errors(&run)
                .iter()
                .map(|e| e.starts_with(&title))
                .eq([true])
            && run.stderr.lines().any(|line| line.trim_start() == arrow)
            && run
                .stderr
                .lines()
                .filter(|line| line.starts_with("help: "))
                .count()
                == 1;
        if !sound {
            wrong.push(format!(
                "expected {kind} at {place}, exit {:?}:\n{}",
                run.code, run.stderr
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_eq!(files(folder), listed, "files and list differ");
}

#[test]
fn broken_declarations_are_refused_at_their_place() {
    refused("check", "fail");
}

#[test]
fn options_that_do_not_fit_are_refused_at_their_place() {
    refused("run", "run");
    refused("check", "run");
}

#[test]
fn unusual_declarations_pass() {
    let warnings = expected("pass");
    for file in files("pass") {
        let path = format!("{DATA}/pass/{file}");
        let run = lie(&format!("check {path}")).ok();
        let listed = warnings.iter().find(|line| line[0] == file);
        let found = run
            .stderr
            .lines()
            .filter(|line| line.starts_with("warning["))
            .count();
        assert_eq!(
            found,
            usize::from(listed.is_some()),
            "{path}\n{}",
            run.stderr
        );
        if let Some([_, _, kind, place]) = listed.map(Vec::as_slice) {
            assert!(
                run.stderr.contains(&format!("warning[{kind}]: ")),
                "{path}\n{}",
                run.stderr
            );
            assert!(
                run.stderr.contains(&format!("--> {path}:{place}\n")),
                "{path}\n{}",
                run.stderr
            );
        }
    }
}

/// Every kind has its fixture, or a test below; the rest belongs to what is not built yet.
#[test]
fn every_kind_is_covered() {
    let mut covered: BTreeSet<String> = ["fail", "run"]
        .iter()
        .flat_map(|folder| expected(folder))
        .map(|line| line[1].clone())
        .collect();
    // those of files and tools are below, that of a checkpoint in `command_resume_refused`
    covered.extend(["io", "toolchain", "checkpoint"].map(str::to_owned));
    // What only warns has its fixtures among those that pass.
    covered.extend(expected("pass").into_iter().map(|line| line[2].clone()));
    for kind in Kind::ALL {
        assert!(covered.contains(kind.as_str()), "{kind}");
    }
}

#[test]
fn files_and_tools_that_are_missing() {
    let folder = folder();
    let missing = folder.path().join("missing.json");
    let run = lie(&format!("check {}", missing.display()));
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    run.says("io", &missing.display().to_string());

    // A system that no other test builds, and a PATH without cargo.
    let path = spec(folder.path(), |spec| {
        spec["name"] = "NeverBuilt".into();
        spec["hamiltonian"] = "x^2/17/I1 + y^4/(2*I2) + z^2/I3".into();
    });
    let cache = folder.path().join("cache");
    let run = command(["run".as_ref(), path.as_os_str(), "--compile".as_ref()])
        .env("PATH", folder.path())
        .env("HOME", folder.path())
        .env_remove("CARGO")
        .env_remove("RUSTC")
        .env_remove("CARGO_HOME")
        .env("LIE_CACHE_DIR", &cache)
        .output()
        .expect("lie starts");
    let run = Run::from(run);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    assert!(
        run.stderr.starts_with("error[toolchain]: "),
        "{}",
        run.stderr
    );
    assert!(
        run.stderr.lines().any(|line| line.starts_with("help: ")),
        "{}",
        run.stderr
    );
    assert!(!run.stderr.contains("panicked"), "{}", run.stderr);
}

#[test]
fn values_of_the_command_line_have_the_kinds_of_the_spec() {
    let body = "specs/so3_free_rigid_body.json";
    for (flags, kind, place) in [
        ("--initial 1,2", "state-length", "--initial"),
        ("--initial 1,2,3,4", "state-length", "--initial"),
        ("--initial 1,,3", "number", "--initial"),
        ("--initial 1,2,x", "number", "--initial"),
        ("--param I1=0", "domain", "--param"),
        ("--param I1=1/0", "number", "--param"),
        ("--param I9=1", "option", "--param"),
        ("--step one", "number", "--step"),
        ("--step 1..5", "number", "--step"),
        ("--until 2(3)", "syntax", "--until"),
        ("--until sin(1,2)", "arity", "--until"),
        ("--until sine(1)", "unknown-function", "--until"),
        ("--method leapfrog", "method", "--method"),
        ("--method euler-arnold2", "method", "--method"),
        ("--step 1e9999", "limit", "--step"),
    ] {
        let run =
            lie(&format!("run {body} {flags}")).error(kind, &format!("command line: {place}"));
        assert_eq!(errors(&run).len(), 1, "{flags}\n{}", run.stderr);
        assert!(run.stdout.is_empty(), "{flags}");
    }
}

/// The mistakes of a file, as `kind line:column`, in the order in which they are printed.
fn mistakes(path: &Path) -> Vec<String> {
    let run = lie(&format!("check {}", path.display()));
    assert_eq!(run.code, Some(2), "{}", run.stderr);
    let arrow = format!("--> {}:", path.display());
    let mut found = Vec::new();
    let mut kind = "";
    for line in run.stderr.lines() {
        if let Some((title, _)) = line
            .strip_prefix("error[")
            .and_then(|rest| rest.split_once(']'))
        {
            kind = title;
        } else if let Some(place) = line.trim_start().strip_prefix(&arrow) {
            found.push(format!("{kind} {place}"));
        }
    }
    assert_eq!(found.len(), errors(&run).len(), "{}", run.stderr);
    found
}

fn write(folder: &Path, text: &str) -> PathBuf {
    let path = folder.join("several.json");
    std::fs::write(&path, text).expect("the spec is written");
    path
}

#[test]
fn the_mistakes_of_a_stage_are_reported_together() {
    let folder = folder();
    // What cannot be read.
    let path = write(
        folder.path(),
        r#"{
  "format": 1, "name": "Several",
  "algebra": { "basis": ["e1", "e2", "e3"], "brackets": ["[e1, e2] = 2e3", "[e2 e3] = e1"] },
  "state": ["x", "2y", "z"],
  "parameters": { "k": "1/0", "m": "one" },
  "let": ["a = 2(x + z)", "b"],
  "hamiltonian": "x^2 + sen(z) + 0x10 + atan2(x)",
  "casimirs": ["C = x^2 = z^2"],
  "methodes": []
}
"#,
    );
    let found = mistakes(&path);
    for mistake in [
        "syntax 3:70",
        "syntax 3:77",
        "syntax 4:19",
        "number 5:37",
        "syntax 6:16",
        "syntax 6:28",
        "unknown-function 7:25",
        "number 7:34",
        "arity 7:41",
        "syntax 8:25",
        "schema 9:4",
    ] {
        assert!(
            found.iter().any(|f| f == mistake),
            "{mistake} is missing: {found:#?}"
        );
    }
    // What can be read, but means nothing.
    let path = write(
        folder.path(),
        r#"{
  "format": 1, "name": "fn",
  "algebra": {
    "basis": ["e1", "e2", "e3", "e1"],
    "brackets": ["[e1, e2] = e3 + q", "[e3, e3] = e1", "[e2, e9] = e1"]
  },
  "state": ["x", "pi", "z"],
  "parameters": { "x": 1, "k": "1/0" },
  "let": ["a = x + later", "later = z"],
  "hamiltonian": "x^2 + w + t + x/(1 - 1)",
  "initial": [1, "log(0)"],
  "methods": ["leapfrog", "gauss8"]
}
"#,
    );
    let found = mistakes(&path);
    for mistake in [
        "reserved-name 2:25",
        "duplicate-name 4:34",
        "reserved-name 7:19",
        "duplicate-name 8:20",
        "state-length 7:25",
        "unknown-symbol 5:35",
        "antisymmetry 5:40",
        "unknown-symbol 5:62",
        "number 8:35",
        "unknown-symbol 9:20",
        "unknown-symbol 10:25",
        "number 10:35",
        "number 11:19",
        "state-length 11:14",
    ] {
        assert!(
            found.iter().any(|f| f == mistake),
            "{mistake} is missing: {found:#?}"
        );
    }
}

#[test]
fn several_specs_are_all_checked() {
    let run = lie(&format!(
        "check {DATA}/fail/jacobi__heavy_top_sign.json specs/se3_heavy_top.json {DATA}/fail/number__word.json"
    ));
    assert_eq!(run.code, Some(2));
    assert_eq!(errors(&run).len(), 2, "{}", run.stderr);
    assert!(run.stdout.contains("HeavyTop"), "{}", run.stdout);
}
