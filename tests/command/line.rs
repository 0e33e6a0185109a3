//! The command line: mistakes, their places and their remedies. Nothing here compiles anything.

use std::process::Stdio;

use crate::common::{command, folder, lie, spec};

#[test]
fn every_mistake_of_the_command_line_is_an_option_error() {
    let body = "specs/so3_free_rigid_body.json";
    for (arguments, place) in [
        ("", "lie"),
        ("frobnicate", "frobnicate"),
        ("run", "SPEC"),
        ("check", "SPEC"),
        ("expand", "SPEC"),
        ("run BODY --frobnicate", "--frobnicate"),
        ("run BODY --step", "--step"),
        ("run BODY --format xml", "--format"),
        ("run BODY --cpu fast", "--cpu"),
        ("run BODY BODY", "SPEC"),
        ("run BODY --step 0", "--step"),
        ("run BODY --step 1e400", "--step"),
        ("run BODY --step -0.1 --until 1", "--until"),
        ("run BODY --step 0.1 --at 1,-1", "--at"),
        ("run BODY --step 1e-300", "--step"),
        ("run BODY --plot x.jpg", "--plot"),
        ("bench BODY --plot x.png", "--plot"),
        ("run BODY --every 0", "--every"),
        ("run BODY --every 1.5", "--every"),
        ("run BODY --every -1", "--every"),
        ("run BODY --at 1 --until 2", "--at"),
        ("run BODY --at 1 --every 2", "--at"),
        ("run BODY --param I1", "--param"),
        ("run BODY --param J1=2", "--param"),
        ("run BODY --param I1=2 --param I1=3", "--param"),
        ("run BODY --rtol 1e-3", "--rtol"),
        ("run BODY --method dopri5 --rtol 0", "--rtol"),
        ("run BODY --method dopri5 --atol -1", "--atol"),
        ("run BODY --keep energy", "--keep"),
        ("run BODY --method gauss4 --keep energy", "--keep"),
        ("run BODY --method splitting2 --keep casimirs", "--keep"),
        ("run BODY --method rkmk4 --keep energy", "--keep"),
        ("run BODY --method exact --keep energy", "--keep"),
        ("run BODY --method rk4 --keep momentum", "--keep"),
        ("run BODY --method rk4 --density reversible", "--density"),
        ("run BODY --method gauss4 --density even", "--density"),
        ("run BODY --method rk4 --keep energy,", "--keep"),
        ("run BODY --iteration secant", "--iteration"),
        ("run BODY --method rk4 --iteration newton", "--iteration"),
        (
            "run BODY --method compose4(splitting2) --max-iterations 9",
            "--max-iterations",
        ),
        ("run BODY --newton-tolerance -1", "--newton-tolerance"),
        (
            "run BODY --method collective16 --iteration newton",
            "--iteration",
        ),
        (
            "run BODY --method isospectral8 --newton-tolerance 1",
            "--newton-tolerance",
        ),
        (
            "run BODY --method gauss16 --converge map --newton-tolerance 1",
            "--newton-tolerance",
        ),
        ("run BODY --max-iterations 0", "--max-iterations"),
        ("run BODY --max-iterations 5000000000", "--max-iterations"),
        ("run BODY --method gauss4 --retraction exp", "--retraction"),
        (
            "run BODY --method lie-midpoint --retraction polar",
            "--retraction",
        ),
        ("run BODY --out BODY", "--out"),
        ("run BODY --out a.csv --plot a.csv", "--plot"),
        ("run BODY --out x.parquet", "--out"),
        ("run BODY --out x.csv.gz", "--out"),
        ("bench BODY --out x.json", "--out"),
        ("stress BODY --out x.npy", "--out"),
    ] {
        let run = lie(&arguments.replace("BODY", body));
        let run = run.error("option", &format!("command line: {place}"));
        assert!(run.stdout.is_empty(), "{arguments}");
    }
}

#[test]
fn values_are_exact_constants_with_their_own_kinds_of_mistakes() {
    let body = "specs/so3_free_rigid_body.json";
    for (option, kind) in [
        ("--step one", "number"),
        ("--step 1/0", "number"),
        ("--step 1..5", "number"),
        ("--until 2(3)", "syntax"),
        ("--at 1,,2", "number"),
        ("--until cosh(1,2)", "arity"),
        ("--step foo(1)", "unknown-function"),
        ("--param I1=", "number"),
        ("--initial 1,2,x", "number"),
        ("--initial 1,2", "state-length"),
        ("--initial 1,2,3,4", "state-length"),
        ("--param I1=0", "domain"),
        ("--initial log(0),0,1", "number"),
        ("--method runge", "method"),
        ("--method variational2", "method"),
        ("--method compose4(rk4)", "method"),
    ] {
        let flag = option.split(' ').next().unwrap_or_default();
        lie(&format!("run {body} {option}")).error(kind, &format!("command line: {flag}"));
    }
}

#[test]
fn the_caret_points_into_the_value() {
    let run = lie("run specs/so3_free_rigid_body.json --initial 1/2,one,3");
    assert!(run.stderr.contains("1/2,one,3\n"), "{}", run.stderr);
    let lines: Vec<&str> = run.stderr.lines().collect();
    let value = lines
        .iter()
        .position(|line| line.contains("1/2,one,3"))
        .unwrap_or(0);
    let column = lines[value].find("one");
    assert_eq!(lines[value + 1].find("^^^"), column, "{}", run.stderr);
}

#[test]
fn all_mistakes_are_reported_together() {
    let run =
        lie("run specs/so3_free_rigid_body.json --step 0 --every x --method nope --param K=1");
    let kinds: Vec<&str> = run
        .stderr
        .lines()
        .filter_map(|line| line.strip_prefix("error["))
        .collect();
    assert_eq!(kinds.len(), 4, "{}", run.stderr);
}

#[test]
fn a_spec_without_initial_state_needs_one() {
    let folder = folder();
    let path = spec(folder.path(), |spec| {
        drop(spec.as_object_mut().and_then(|o| o.remove("initial")))
    });
    let run = lie(&format!("run {}", path.display())).error("option", "command line: --initial");
    assert!(
        run.stderr.contains("`--initial 0.1,0.2,0.3`"),
        "{}",
        run.stderr
    );
}

#[test]
fn options_of_the_spec_are_checked_at_their_place() {
    let folder = folder();
    for (options, place) in [
        (r#"{"method": "nope"}"#, "nope"),
        (r#"{"step": 0}"#, "0"),
        (r#"{"step": -0.1, "until": 1}"#, "1"),
        (
            r#"{"method": "midpoint", "retraction": "cayley"}"#,
            "cayley",
        ),
        (r#"{"method": "midpoint", "rtol": 1e-3}"#, "1e-3"),
        (r#"{"method": "rk4", "max-iterations": 9}"#, "9"),
        (r#"{"method": "midpoint", "iteration": "secant"}"#, "secant"),
        (r#"{"at": [1, 2], "until": 3}"#, "1"),
        (r#"{"method": "midpoint", "lift": "hopf"}"#, "hopf"),
    ] {
        let path = spec(folder.path(), |_| ());
        let text = std::fs::read_to_string(&path).expect("the spec is there");
        let text = text.replacen('{', &format!("{{\n\"run\": {options},"), 1);
        std::fs::write(&path, &text).expect("the spec is written");
        let line = text.lines().nth(1).unwrap_or_default();
        let at = options
            .find(&format!("{place}\""))
            .or(options.find(&format!(" {place}")).map(|i| i + 1));
        let at = options
            .find(&format!("[{place}"))
            .map(|i| i + 1)
            .or(at)
            .unwrap_or(0);
        let column = "\"run\": ".len() + at + 1;
        let run = lie(&format!("run {}", path.display()));
        assert_eq!(run.code, Some(2), "{options}: {}", run.stderr);
        let expected = format!("--> {}:2:", path.display());
        assert!(
            run.stderr.contains(&expected),
            "{options}: {line}\n{}",
            run.stderr
        );
        assert!(
            run.stderr.contains(&format!("{expected}{column}")),
            "{options}\n{}",
            run.stderr
        );
    }
}

#[test]
fn commands_to_come_say_so() {
    let run = lie("advise specs/x.json --whatever 3");
    let run = run.error("option", "command line: advise");
    assert!(run.stderr.contains("not built yet"), "{}", run.stderr);
}

#[test]
fn help_and_version_go_to_stdout() {
    for arguments in ["--help", "run --help", "--version", "check -h"] {
        let run = lie(arguments).ok();
        assert!(
            !run.stdout.is_empty() && run.stderr.is_empty(),
            "{arguments}"
        );
    }
    let help = lie("--help").stdout;
    assert!(
        help.contains("expand") && !help.contains("advise"),
        "{help}"
    );
}

/// The plan of the code that is printed otherwise: for the methods of the spec, or those that are named.
#[test]
fn plans_are_shown() {
    let spec = "specs/so3_free_rigid_body.json";
    let plan = lie(&format!("expand {spec} --plan --method midpoint"))
        .ok()
        .stdout;
    for part in [
        "plan of FreeRigidBody",
        "inverse_I1 = 1/I1",
        "equation Midpoint",
        "x' = -y*z/I2 + y*z/I3",
    ] {
        assert!(plan.contains(part), "{part} in\n{plan}");
    }
    assert!(
        !plan.contains("CayleyMidpoint") && !plan.contains("impl<"),
        "{plan}"
    );
    let code = lie(&format!("expand {spec} --method midpoint")).ok().stdout;
    assert!(code.contains("struct FreeRigidBodyMidpoint") && !code.contains("plan of"));
}

#[test]
fn a_path_that_is_no_spec_has_a_remedy() {
    let run = lie("run specs");
    assert_eq!(run.code, Some(1), "{run:?}");
    assert!(
        run.stderr
            .contains("a file in this folder, such as specs/canonical_pendulum.json")
    );
    let run = lie("check -");
    assert_eq!(run.code, Some(1), "{run:?}");
    assert!(
        run.stderr
            .contains("that of standard input is `/dev/stdin`")
    );
    let run = lie("check tests/common");
    assert!(
        run.stderr.contains("give the path of a JSON file"),
        "{run:?}"
    );
}

#[test]
fn methods_and_schema() {
    let methods = lie("methods").ok().stdout;
    for id in [
        "midpoint",
        "gauss4",
        "gauss6",
        "lie-midpoint",
        "rk4",
        "dopri5",
        "itoh-abe",
    ] {
        assert!(methods.contains(id), "{id}");
    }
    for line in methods.lines() {
        assert!(line.chars().count() <= 100, "{line}");
    }
    let json = lie("methods --json").ok().stdout;
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let gauss6 = json
        .as_array()
        .into_iter()
        .flatten()
        .find(|entry| entry["id"] == "gauss6");
    let gauss6 = gauss6.expect("gauss6 is listed");
    assert_eq!(gauss6["order"], 6);
    assert_eq!(gauss6["preserves"]["quadratic_casimirs"], true);
    assert!(
        gauss6["reference"]
            .as_str()
            .is_some_and(|reference| reference.contains("10."))
    );
    let schema: serde_json::Value = serde_json::from_str(&lie("schema").ok().stdout).expect("JSON");
    assert_eq!(schema["additionalProperties"], false);
}

#[test]
fn a_reader_that_goes_away_is_no_mistake() {
    for arguments in [
        vec!["methods"],
        vec!["schema"],
        vec!["check", "specs/se3_heavy_top.json"],
    ] {
        let mut child = command(&arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("lie starts");
        drop(child.stdout.take());
        let output = child.wait_with_output().expect("lie ends");
        assert_eq!(output.status.code(), Some(0), "{arguments:?}");
        assert!(
            output.stderr.is_empty(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
    }
}

#[test]
fn messages_name_the_true_reason() {
    let body = "run specs/so3_free_rigid_body.json";
    let time = "run tests/data/declarations/pass/time.json --until 1 --plot a.svg";
    let chain = "run tests/data/families/xxz_chain.json --plot a.svg";
    for (call, said) in [
        (
            format!("{body} --every 18446744073709551615"),
            "is more than can be counted",
        ),
        (
            format!("{body} --step 1e-320"),
            "so many steps of 1e-320 cannot be counted",
        ),
        (
            format!("{body} --initial 1;2;3"),
            "no commas stand between these numbers",
        ),
        (format!("{body} --initial 1"), "1 value for a state of 3"),
        (
            format!("{time} --picture orbit"),
            "H of Broken changes with the time",
        ),
        (
            format!("{chain} --picture section:x[0]=0"),
            "is a family, and sections are drawn of single systems",
        ),
        (format!("{chain} --param N=1e12"), "from 1 to 2147483648"),
    ] {
        let run = lie(&call);
        assert_eq!(run.code, Some(2), "{call}: {}", run.stderr);
        assert!(run.stderr.contains(said), "{call}: {}", run.stderr);
    }
}
