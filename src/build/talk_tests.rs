//! The protocol against programs of the shell.

use lie_program::protocol::Found;

use super::*;

/// Runs a shell script as the program, with rows of two numbers.
fn script(text: &str) -> (io::Result<Outcome>, Vec<f64>, Vec<String>) {
    let mut command = Command::new("sh");
    command.args(["-c", text]);
    let (mut got, mut said) = (Vec::new(), Vec::new());
    let outcome = talk(
        command,
        &"the request",
        &Interrupt::default(),
        &mut |found| {
            if let Found::Rows(rows) = found {
                got.extend_from_slice(&rows.numbers);
            }
            Ok(())
        },
        &mut |progress| said.push(format!("{progress:?}")),
    );
    (outcome, got, said)
}

/// Announces so many rows.
fn announce(count: u64) -> String {
    format!(r#"echo '{{"found":{{"rows":{{"count":{count},"width":2}}}}}}'"#)
}

/// 1.0 and -2.0 as bytes; `printf` of every shell knows octal escapes.
const ROW: &str = r"printf '\000\000\000\000\000\000\360\077\000\000\000\000\000\000\000\300'";
const DONE: &str = r#"echo '{"end":"done"}'"#;

#[test]
fn rows_and_progress() {
    let two = announce(2);
    let (outcome, rows, said) = script(&format!(
        r#"read line; [ "$line" = '"the request"' ] || exit 9; {two}; {ROW}; {ROW};
           echo '{{"progress":{{"done":3,"all":10}}}}';
           echo '{{"progress":{{"done":3,"all":10,"stage":"the reference"}}}}'; {DONE}"#
    ));
    assert!(matches!(outcome, Ok(Outcome::Done)), "{outcome:?}");
    assert_eq!(rows, [1.0, -2.0, 1.0, -2.0]);
    let progress = |stage: Option<&str>| Progress {
        done: 3,
        all: 10,
        stage: stage.map(str::to_owned),
    };
    let expected = [progress(None), progress(Some("the reference"))];
    assert_eq!(said, expected.map(|progress| format!("{progress:?}")));
}

#[test]
fn early_stop_keeps_rows_and_drops_half_a_row() {
    let stopped = r#"{"end":{"stopped":{"step":7,"time":0.7,"iterations":9,"residual":"NaN",
        "reason":"Newton does not converge","remedy":"take a smaller step"}}}"#;
    let stopped = stopped.replace('\n', " ");
    let one = announce(1);
    let (outcome, rows, _) = script(&format!("{one}; {ROW}; echo '{stopped}'; exit 3"));
    let Ok(Outcome::Stopped(stop)) = outcome else {
        panic!("{outcome:?}")
    };
    assert_eq!((stop.step, stop.time), (7, 0.7));
    assert!(stop.residual.is_nan());
    assert_eq!(stop.reason, "Newton does not converge");
    assert_eq!(stop.remedy, "take a smaller step");
    assert_eq!(rows, [1.0, -2.0]);
    let three = announce(3);
    let (outcome, rows, _) = script(&format!("{three}; {ROW}; printf abc; exit 139"));
    assert!(matches!(outcome, Ok(Outcome::Broken(_))), "{outcome:?}");
    assert_eq!(rows, [1.0, -2.0]);
}

#[test]
fn other_ends() {
    let parameter = r#"{"end":{"parameter":{"name":"I1","why":"1/I1 is not finite"}}}"#;
    let (outcome, ..) = script(&format!("echo '{parameter}'; exit 2"));
    assert!(
        matches!(&outcome, Ok(Outcome::Parameter(name, why)) if name == "I1" && why.ends_with("finite")),
        "{outcome:?}"
    );
    let ground = r#"{"end":{"refused":{"what":"ground","why":"nothing moves"}}}"#;
    let (outcome, ..) = script(&format!("echo '{ground}'; exit 2"));
    assert!(
        matches!(&outcome, Ok(Outcome::Refused(Obstacle::Ground, why)) if why == "nothing moves"),
        "{outcome:?}"
    );
    let broken = |text: &str| match script(text).0 {
        Ok(Outcome::Broken(how)) => how,
        other => panic!("{other:?}"),
    };
    let how = broken("echo first >&2; echo second >&2; exit 101");
    assert_eq!(how, "exit status: 101: first\nsecond");
    // a silent program has not finished, and one whose words and exit code differ neither
    assert_eq!(broken("exit 0"), "exit status: 0");
    assert_eq!(broken(&format!("{DONE}; exit 3")), "exit status: 3");
    assert!(broken("echo done").contains("done"));
    let missing = talk(
        Command::new("/nonexistent/program"),
        &"the request",
        &Interrupt::default(),
        &mut |_: Found| Ok(()),
        &mut |_| (),
    );
    assert!(missing.is_err());
}

#[test]
fn a_refused_row_ends_the_program() {
    let mut command = Command::new("sh");
    let one = announce(1);
    command.args(["-c", &format!("while :; do {one}; {ROW}; done")]);
    let outcome = talk(
        command,
        &"the request",
        &Interrupt::default(),
        &mut |_: Found| Err(io::ErrorKind::BrokenPipe.into()),
        &mut |_| (),
    );
    let Ok(Outcome::NotTaken(error)) = outcome else {
        panic!("{outcome:?}")
    };
    assert_eq!(error.kind(), io::ErrorKind::BrokenPipe);
}

#[test]
fn the_end_of_stdin_ends_the_program() {
    let mut command = Command::new("sh");
    let one = announce(1);
    let text = format!(
        r#"{one}; {ROW}; while read line; do :; done; {one}; {ROW};
           echo '{{"end":"interrupted"}}'; exit 130"#
    );
    command.args(["-c", &text]);
    let interrupt = Interrupt::default();
    let mut got = 0;
    let outcome = talk(
        command,
        &"the request",
        &interrupt,
        &mut |found: Found| {
            if let Found::Rows(rows) = found {
                interrupt.stop();
                got += rows.numbers.len() / 2;
            }
            Ok(())
        },
        &mut |_| (),
    );
    // Nobody pressed Ctrl-C here, so the end is not called an interruption.
    let how = "exit status: 130";
    assert!(
        matches!(&outcome, Ok(Outcome::Broken(text)) if text == how),
        "{outcome:?}"
    );
    assert_eq!(got, 2);
}
