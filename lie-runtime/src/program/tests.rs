use super::*;
use crate::methods::{Dopri5, Rk4};
use crate::test_systems::Spring;

fn program() -> Program<Spring> {
    Program::new(&[1.0], |parameters| {
        let error = ParameterError {
            name: "k",
            expression: "1/k",
            fault: ParameterFault::NotFinite,
        };
        if parameters[0] == 0.0 {
            Err(error)
        } else {
            Ok(Spring)
        }
    })
    .method("rk4", |_| Rk4)
    .method("dopri5", |tolerances| Dopri5 {
        rtol: tolerances.rtol,
        atol: tolerances.atol,
    })
}

/// Serves a request whose input stays open until the end; returns exit code, rows and messages.
fn serve(request: &str) -> (u8, Vec<[f64; 4]>, String) {
    let (input, mut writer) = io::pipe().expect("a pipe");
    writer
        .write_all(request.as_bytes())
        .expect("the pipe takes the request");
    let (mut output, mut messages) = (Vec::new(), Vec::new());
    let code = program().serve(io::BufReader::new(input), &mut output, &mut messages);
    drop(writer);
    (
        code,
        rows(&output),
        String::from_utf8(messages).expect("messages are text"),
    )
}

fn rows(bytes: &[u8]) -> Vec<[f64; 4]> {
    let number = |bytes: &[u8]| f64::from_le_bytes(bytes.try_into().expect("eight bytes"));
    let row = |bytes: &[u8]| core::array::from_fn(|k| number(&bytes[8 * k..8 * k + 8]));
    assert_eq!(bytes.len() % 32, 0, "rows are whole");
    bytes.chunks(32).map(row).collect()
}

#[test]
fn rows_are_time_state_energy() {
    let (code, rows, messages) = serve("method rk4\nstep 0.5\nuntil 2\ninitial 3 4\nrun\n");
    assert_eq!(code, 0, "{messages}");
    assert_eq!(
        rows.iter().map(|row| row[0]).collect::<Vec<_>>(),
        [0.0, 0.5, 1.0, 1.5, 2.0]
    );
    // the energy, which is not the Hamiltonian here
    assert_eq!(rows[0], [0.0, 3.0, 4.0, 25.0]);
    assert!((rows[4][3] - 25.0).abs() < 0.2);
    assert_eq!(
        messages,
        "done steps=4 evaluations=16 newton=0 accepted=4 rejected=0\n"
    );
}

#[test]
fn tolerances_reach_the_method() {
    let error = |rtol: &str| {
        let request = format!("method dopri5\nstep 1\nat 1\ninitial 1 0\nrtol {rtol}\nrun\n");
        let (code, rows, messages) = serve(&request);
        assert_eq!((code, rows.len()), (0, 1), "{messages}");
        (rows[0][1] - 1.0_f64.cos()).abs()
    };
    assert!(error("1e-10") < 1e-8);
    assert!(error("1e-2") > 1e-8);
}

#[test]
fn what_is_wrong_is_said() {
    let cases = [
        (
            "method gauss4\nstep 1\nuntil 1\ninitial 1 0\nrun\n",
            "request no method `gauss4`",
        ),
        ("method rk4\nstep one\nrun\n", "request step one"),
        (
            "method rk4\nstep 1\nuntil -1\ninitial 1 0\nrun\n",
            "option the step 1 leads from 0",
        ),
        (
            "method rk4\nstep 1\nuntil 1\ninitial 1\nrun\n",
            "initial 1 values where 2",
        ),
        (
            "method rk4\nstep 1\nuntil 1\ninitial 1 0\nparameter 0 0\nrun\n",
            "parameter k `1/k` is",
        ),
    ];
    for (request, expected) in cases {
        let (code, rows, messages) = serve(request);
        assert_eq!((code, rows.len()), (2, 0), "{messages}");
        assert!(messages.starts_with(expected), "{messages}");
    }
    let (code, rows, messages) = serve("method rk4\nstep 1e160\nuntil 1e162\ninitial 1 0\nrun\n");
    assert_eq!((code, rows.len()), (3, 1), "{messages}");
    assert!(
        messages.starts_with("failed step=1 time=0.0 iterations=0 residual=0.0 reason=a number")
    );
    assert!(
        messages.contains(" remedy=take a smaller step"),
        "{messages}"
    );
}

#[test]
fn the_end_of_the_input_stops_the_run_and_keeps_rows() {
    let request: &[u8] = b"method rk4\nstep 0.5\nuntil 1e9\nevery 1000\ninitial 1 0\nrun\n";
    let (mut output, mut messages) = (Vec::new(), Vec::new());
    let code = program().serve(request, &mut output, &mut messages);
    let messages = String::from_utf8(messages).expect("messages are text");
    assert_eq!(code, 130, "{messages}");
    assert!(messages.contains("interrupted steps="), "{messages}");
    assert_eq!(rows(&output)[0], [0.0, 1.0, 0.0, 1.0]);
    let early: &[u8] = b"method rk4\n";
    assert_eq!(program().serve(early, io::sink(), io::sink()), 130);
}

#[test]
fn a_closed_output_is_an_error_of_the_surroundings() {
    struct Full;
    impl Write for Full {
        fn write(&mut self, _: &[u8]) -> io::Result<usize> {
            Err(io::Error::other("no space left"))
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }
    let (input, mut writer) = io::pipe().expect("a pipe");
    writer
        .write_all(b"method rk4\nstep 0.5\nuntil 1e6\ninitial 1 0\nrun\n")
        .expect("a request");
    let mut messages = Vec::new();
    let code = program().serve(io::BufReader::new(input), Full, &mut messages);
    assert_eq!(code, 1);
    assert_eq!(messages, b"output no space left\n");
}
