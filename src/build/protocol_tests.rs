//! The protocol against programs of the shell.

use super::*;

fn job() -> Job {
    Job {
        method: "midpoint".to_owned(),
        step: 0.1,
        times: Times::Until { end: 1.0, every: 2 },
        parameters: vec![1.0, 1e-300],
        initial: vec![-0.5, 0.1 + 0.2],
        tolerances: vec![("rtol", 1e-6)],
    }
}

/// Runs a shell script as the program, with rows of two numbers.
fn script(text: &str) -> (io::Result<End>, Vec<f64>, Vec<(u64, u64)>) {
    let mut command = Command::new("sh");
    command.args(["-c", text]);
    let (mut got, mut steps) = (Vec::new(), Vec::new());
    let end = run(
        command,
        &job(),
        2,
        &Interrupt::default(),
        &mut |rows| {
            got.extend_from_slice(rows);
            Ok(())
        },
        &mut |done, all| steps.push((done, all)),
    );
    (end, got, steps)
}

#[test]
fn the_job_reads_back_as_the_same_numbers() {
    let expected = "method midpoint\nstep 0.1\nuntil 1.0\nevery 2\nparameter 0 1.0\nparameter 1 1e-300\n\
                    initial -0.5 0.30000000000000004\nrtol 1e-6\nrun\n";
    assert_eq!(job().lines(), expected);
    let at = Job {
        times: Times::At(vec![0.0, 0.5]),
        ..job()
    };
    assert!(at.lines().contains("at 0.0\nat 0.5\n"));
}

/// 1.0 and -2.0 as bytes; `printf` of every shell knows octal escapes.
const ROW: &str = r"printf '\000\000\000\000\000\000\360\077\000\000\000\000\000\000\000\300'";

#[test]
fn rows_progress_and_counts() {
    let (end, rows, steps) = script(&format!(
        "while read line; do [ \"$line\" = run ] && break; done; {ROW}; {ROW}; \
         echo progress 3 10 >&2; echo done steps=10 evaluations=4 newton=21 accepted=12 rejected=1 >&2"
    ));
    let counts = Counts {
        steps: 10,
        evaluations: 4,
        newton: 21,
        accepted: 12,
        rejected: 1,
    };
    assert_eq!(end.ok(), Some(End::Done(counts)));
    assert_eq!(rows, [1.0, -2.0, 1.0, -2.0]);
    assert_eq!(steps, [(3, 10)]);
}

#[test]
fn early_stop_keeps_rows_and_drops_half_a_row() {
    let (end, rows, _) = script(&format!(
        "{ROW}; printf abc; echo 'failed step=7 time=0.7 iterations=9 residual=1e-3 \
         reason=Newton does not converge remedy=take a smaller step' >&2; exit 3"
    ));
    let Ok(End::Stopped(stop)) = end else {
        panic!("{end:?}")
    };
    assert_eq!((stop.step.as_str(), stop.time.as_str()), ("7", "0.7"));
    assert_eq!(stop.reason, "Newton does not converge");
    assert_eq!(stop.remedy, "take a smaller step");
    assert_eq!(rows, [1.0, -2.0]);
}

#[test]
fn other_ends() {
    let (end, ..) = script("echo parameter I1 1/I1 is not finite >&2; exit 2");
    assert_eq!(
        end.ok(),
        Some(End::Parameter("I1".into(), "1/I1 is not finite".into()))
    );
    let (end, ..) = script("echo first >&2; echo second >&2; echo third >&2; exit 101");
    assert_eq!(
        end.ok(),
        Some(End::Broken("exit status: 101: second\nthird".into()))
    );
    let (end, ..) = script("exit 0");
    assert!(
        matches!(end, Ok(End::Broken(_))),
        "a silent program has not finished"
    );
    let missing = run(
        Command::new("/nonexistent/program"),
        &job(),
        2,
        &Interrupt::default(),
        &mut |_| Ok(()),
        &mut |_, _| (),
    );
    assert!(missing.is_err());
}

#[test]
fn a_refused_row_ends_the_program() {
    let mut command = Command::new("sh");
    command.args(["-c", &format!("while :; do {ROW}; done")]);
    let mut refuse = |_: &[f64]| Err(io::Error::from(io::ErrorKind::BrokenPipe));
    let end = run(
        command,
        &job(),
        2,
        &Interrupt::default(),
        &mut refuse,
        &mut |_, _| (),
    );
    assert_eq!(
        end.err().map(|error| error.kind()),
        Some(io::ErrorKind::BrokenPipe)
    );
}

#[test]
fn the_end_of_stdin_ends_the_program() {
    let mut command = Command::new("sh");
    command.args([
        "-c",
        &format!("{ROW}; while read line; do :; done; {ROW}; exit 130"),
    ]);
    let interrupt = Interrupt::default();
    let mut got = 0;
    let mut rows = |rows: &[f64]| {
        got += rows.len() / 2;
        interrupt.stop();
        Ok(())
    };
    let end = run(command, &job(), 2, &interrupt, &mut rows, &mut |_, _| ());
    // Nobody pressed Ctrl-C here, so the end is not called an interruption.
    assert_eq!(end.ok(), Some(End::Broken("exit status: 130".into())));
    assert_eq!(got, 2);
}

#[test]
fn a_measuring_program_says_how_far_it_is_and_its_last_word() {
    let mut command = Command::new("sh");
    let text = "echo stage 0 3 the reference solution >&2; echo 'point\t1'; echo progress 1 3 >&2; \
                echo stage 2 3 lie-midpoint --retraction cayley >&2; echo staged >&2; echo ground none >&2; exit 2";
    command.args(["-c", text]);
    let (mut lines, mut seen) = (Vec::new(), Vec::new());
    let words = measure(
        command,
        "run\n",
        &Interrupt::default(),
        &mut |line| lines.push(line.to_owned()),
        &mut |progress| seen.push(format!("{progress:?}")),
    );
    let expected = [
        "Stage(0, 3, \"the reference solution\")",
        "Done(1, 3)",
        "Stage(2, 3, \"lie-midpoint --retraction cayley\")",
    ];
    assert_eq!(
        (lines.len(), seen.as_slice()),
        (1, &expected.map(str::to_owned)[..])
    );
    let words = words.expect("it starts");
    assert_eq!((words.code, words.last.as_str()), (Some(2), "ground none"));
}
