use super::protocol::{Choice, Columns, Coordinates, Message, Start, Times};
use super::*;
use lie_runtime::driver::{Density, Pace};
use lie_runtime::methods::{Dopri5, Keep, Rk4};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::{ParameterFault, State};
use nalgebra::{SMatrix, SVector};
use std::io;

/// The harmonic oscillator `q' = p`, `p' = -q`.
struct Spring;

impl Poisson<f64> for Spring {
    type State = SVector<f64, 2>;
    type Jacobian = SMatrix<f64, 2, 2>;
    fn dimension(&self) -> usize {
        2
    }
    fn name(&self) -> &str {
        "Spring"
    }
    fn coordinate(&self, index: usize) -> &str {
        ["q", "p"][index]
    }

    fn zero_state(&self) -> Self::State {
        Self::State::repeat(0.0)
    }
    fn zero_jacobian(&self) -> Self::Jacobian {
        Self::Jacobian::repeat(0.0)
    }
    fn hamiltonian(&self, mu: &Self::State) -> f64 {
        0.5 * mu.norm_squared()
    }
    /// Twice H, to be told from it.
    fn energy(&self, mu: &Self::State) -> f64 {
        mu.norm_squared()
    }
    fn gradient(&self, mu: &Self::State, out: &mut Self::State) {
        State::copy_from(out, mu);
    }
    fn hessian(&self, _mu: &Self::State, out: &mut Self::Jacobian) {
        *out = Self::Jacobian::new(1.0, 0.0, 0.0, 1.0);
    }
    fn poisson_matrix(&self, _mu: &Self::State, out: &mut Self::Jacobian) {
        *out = Self::Jacobian::new(0.0, 1.0, -1.0, 0.0);
    }
    fn jacobian(&self, _mu: &Self::State, out: &mut Self::Jacobian) {
        *out = Self::Jacobian::new(0.0, 1.0, -1.0, 0.0);
    }
    fn casimirs(&self, _mu: &Self::State, _out: &mut [f64]) {}
    fn casimir_gradient(&self, _index: usize, _mu: &Self::State, _out: &mut Self::State) {}
}

fn program() -> Program<Spring> {
    Program::new(&[("k", 1.0)], |parameters| {
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

fn request(method: &str, step: f64, times: Times, initial: &[f64]) -> Run {
    Run {
        method: method.to_owned(),
        start: Start {
            initial: initial.to_vec(),
            ..Start::default()
        },
        pace: Pace::Step(step),
        from: 0.0,
        times,
        tolerances: Tolerances::default(),
        newton: NewtonOptions::default(),
        keep: Keep::NOTHING,
        density: Density::Constant,
        assess: 0,
        element: Vec::new(),
        from_milestone: None,
        milestones: Milestones::None,
        curve: false,
        held: Default::default(),
        sources: Default::default(),
    }
}

fn until(end: f64) -> Times {
    Times::Until { end, every: 1 }
}

/// What a program said, with the rows.
#[derive(Debug, Default)]
struct Heard {
    code: u8,
    chosen: Option<Choice>,
    columns: Option<Columns>,
    rows: Vec<[f64; 4]>,
    work: Option<Work>,
    end: Option<End>,
}

fn heard(code: u8, mut output: &[u8]) -> Heard {
    let mut heard = Heard {
        code,
        ..Heard::default()
    };
    listen::listen(&mut output, &mut |message: Message<Found>| {
        match message {
            Message::Found(Found::Chosen(chosen)) => heard.chosen = Some(chosen),
            Message::Found(Found::Columns(columns)) => heard.columns = Some(columns),
            Message::Found(Found::Rows(found)) => {
                let (rows, rest) = found.numbers.as_chunks::<4>();
                assert!(rest.is_empty(), "rows are whole");
                heard.rows.extend(rows);
            }
            Message::Found(Found::Work(work)) => heard.work = Some(work),
            Message::Found(
                Found::Shortened { .. }
                | Found::Lost { .. }
                | Found::Uneven { .. }
                | Found::Assessed { .. }
                | Found::Between(_)
                | Found::Event(_)
                | Found::Milestone(_),
            ) => {}
            Message::Progress(_) => {}
            Message::End(end) => heard.end = Some(end),
        }
        Ok(())
    })
    .expect("messages");
    let code_of_end = heard.end.as_ref().map(End::code);
    assert!(code_of_end.is_none_or(|end| end == code), "{heard:?}");
    heard
}

/// Serves a line whose input stays open until the end.
fn serve_line(line: &str) -> Heard {
    let (input, mut writer) = io::pipe().expect("a pipe");
    writeln!(writer, "{line}").expect("the pipe takes the request");
    let mut output = Vec::new();
    let code = program().serve(io::BufReader::new(input), &mut output);
    drop(writer);
    heard(code, &output)
}

fn serve(request: &Run) -> Heard {
    serve_line(&serde_json::to_string(request).expect("text"))
}

#[test]
fn rows_are_time_state_energy() {
    let heard = serve(&request("rk4", 0.5, until(2.0), &[3.0, 4.0]));
    assert_eq!(heard.end, Some(End::Done));
    let columns = heard.columns.expect("columns");
    assert_eq!(
        (columns.coordinates, columns.casimirs.len(), columns.element),
        (
            Coordinates::Named(vec!["q".to_owned(), "p".to_owned()]),
            0,
            0
        )
    );
    let times = heard.rows.iter().map(|row| row[0]).collect::<Vec<_>>();
    assert_eq!(times, [0.0, 0.5, 1.0, 1.5, 2.0]);
    // the energy, which is not the Hamiltonian here
    assert_eq!(heard.rows[0], [0.0, 3.0, 4.0, 25.0]);
    assert!((heard.rows[4][3] - 25.0).abs() < 0.2);
    let work = Work {
        steps: 4,
        evaluations: 16,
        newton: 0,
        fixed_point: 0,
        accepted: 4,
        rejected: 0,
    };
    assert_eq!(heard.work, Some(work));
}

#[test]
fn long_runs_come_in_several_blocks() {
    let heard = serve(&request("rk4", 0.5, until(5e3), &[3.0, 4.0]));
    let expected = (0..=10_000).map(|k| 0.5 * f64::from(k));
    assert!(heard.rows.iter().map(|row| row[0]).eq(expected));
}

#[test]
fn states_between_rows_are_said_where_they_are_drawn() {
    let said = |curve| {
        let mut said: Vec<Message<Found>> = Vec::new();
        let request = Run {
            curve,
            ..request("rk4", 1.0, until(10.0), &[3.0, 4.0])
        };
        let mut session = Session::undisturbed(&mut said);
        program().run(&request, &mut session).expect("it runs");
        said
    };
    let numbers = |said: &[Message<Found>], between: bool| -> Vec<f64> {
        let numbers = said.iter().filter_map(|message| match message {
            Message::Found(Found::Rows(rows)) if !between => Some(&rows.numbers),
            Message::Found(Found::Between(rows)) if between => Some(&rows.numbers),
            _ => None,
        });
        numbers.flatten().copied().collect()
    };
    let (plain, drawn) = (said(false), said(true));
    assert_eq!(numbers(&plain, false), numbers(&drawn, false));
    assert!(numbers(&plain, true).is_empty());
    assert!(numbers(&drawn, true).len() > 100);
}

#[test]
fn tolerances_reach_the_method() {
    let error = |rtol: f64| {
        let mut request = request("dopri5", 1.0, Times::At(vec![1.0]), &[1.0, 0.0]);
        request.tolerances.rtol = rtol;
        let heard = serve(&request);
        assert_eq!((heard.code, heard.rows.len()), (0, 1), "{heard:?}");
        (heard.rows[0][1] - 1.0_f64.cos()).abs()
    };
    assert!(error(1e-10) < 1e-8);
    assert!(error(1e-2) > 1e-8);
}

#[test]
fn what_is_wrong_is_said() {
    let sound = || request("rk4", 1.0, until(1.0), &[1.0, 0.0]);
    let of = |change: fn(&mut Run)| {
        let mut request = sound();
        change(&mut request);
        let heard = serve(&request);
        assert_eq!((heard.code, heard.rows.len()), (2, 0), "{heard:?}");
        match heard.end {
            Some(End::Refused { what, why }) => format!("{what:?} {why}"),
            Some(End::Parameter { name, why }) => format!("{name}: {why}"),
            end => panic!("{end:?}"),
        }
    };
    assert_eq!(
        of(|run| run.method = "gauss4".to_owned()),
        "Request no method `gauss4` in this program"
    );
    assert!(of(|run| run.times = until(-1.0)).starts_with("Option the step 1 leads from 0"));
    assert_eq!(
        of(|run| run.start.initial = vec![1.0]),
        "Initial 1 values where 2 are needed"
    );
    assert!(
        of(|run| run.start.parameters = [("k".to_owned(), 0.0)].into()).starts_with("k: `1/k` is")
    );
    assert_eq!(
        of(|run| run.start.parameters = [("l".to_owned(), 0.0)].into()),
        "Request no parameter `l` in this program"
    );
    let heard = serve_line("method rk4");
    assert!(
        matches!(
            &heard.end,
            Some(End::Refused {
                what: Obstacle::Request,
                ..
            })
        ),
        "{heard:?}"
    );
}

#[test]
fn a_failed_step_is_told() {
    let heard = serve(&request("rk4", 1e160, until(1e162), &[1.0, 0.0]));
    let Some(End::Stopped(stop)) = &heard.end else {
        panic!("{heard:?}")
    };
    assert_eq!((heard.code, heard.rows.len()), (3, 1));
    assert_eq!((stop.step, stop.time, stop.iterations), (1, 0.0, 0));
    assert!(stop.reason.starts_with("a number"), "{stop:?}");
    assert!(stop.remedy.starts_with("take a smaller step"), "{stop:?}");
}

#[test]
fn the_end_of_the_input_stops_the_run_and_keeps_rows() {
    let endless = request("rk4", 0.5, until(1e9), &[1.0, 0.0]);
    let line = serde_json::to_string(&endless).expect("text");
    let serve = |text: String| {
        let mut output = Vec::new();
        let code = program().serve(io::Cursor::new(text), &mut output);
        heard(code, &output)
    };
    let stopped = serve(format!("{line}\n"));
    assert_eq!(stopped.end, Some(End::Interrupted));
    assert_eq!(stopped.rows[0], [0.0, 1.0, 0.0, 1.0]);
    assert!(stopped.work.is_some());
    // before the request was whole
    let early = serve(line);
    assert_eq!((early.code, early.end), (130, None));
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
    let endless = request("rk4", 0.5, until(1e6), &[1.0, 0.0]);
    let line = serde_json::to_string(&endless).expect("text");
    writeln!(writer, "{line}").expect("a request");
    let code = program().serve(io::BufReader::new(input), &mut Full);
    assert_eq!(code, 1);
}

#[test]
fn what_a_killed_program_did_not_finish_is_dropped() {
    let mut output = Vec::new();
    let mut lines = session::Lines(&mut output);
    let mut session = Session::undisturbed(&mut lines);
    let mut rows = RowWriter::new(&Spring, &mut session);
    for time in [0.0, 1.0, 2.0] {
        use lie_runtime::driver::Observer;
        let _ = Observer::<f64, Spring>::row(&mut rows, &Spring, time, &[3.0, 4.0].into());
    }
    rows.finish();
    let cut = heard(3, &output[..output.len() - 5]);
    assert_eq!(cut.rows, [[0.0, 3.0, 4.0, 25.0], [1.0, 3.0, 4.0, 25.0]]);
    // in the middle of the line that announces them
    let announced = output.len() - 96 - 5;
    assert!(heard(3, &output[..announced]).rows.is_empty());
    // more than there can be, as of no program of ours
    let mut wide = &br#"{"found":{"rows":{"count":2,"width":4611686018427387904}}}
12345678"#[..];
    let taken = listen::listen(&mut wide, &mut |message: Message<Found>| {
        let none = matches!(message, Message::Found(Found::Rows(rows)) if rows.numbers.is_empty());
        assert!(none, "a row that is cut off");
        Ok(())
    });
    assert!(taken.is_ok(), "{taken:?}");
}
