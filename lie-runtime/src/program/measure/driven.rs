//! Whether the driver shows what the steps of a method make: times, states, energies and Casimirs of its rows, on the
//! grid and off it, forwards and backwards, as observers see them and as programs write them.

use super::super::rows::RowWriter;
use crate::diagnostics::verify::{Finding, Ground, Subject};
use crate::diagnostics::{AnyMethod, Forgotten};
use crate::driver::{IntegrateError, Options, Problem, Recorder, Save, Solution, integrate};
use crate::methods::StepFailure;
use crate::newton::NewtonOptions;
use crate::poisson::{Lift, Poisson};
use crate::state::State;
use std::sync::atomic::AtomicBool;

/// A row: time, state, energy, Casimirs.
type Row = Vec<f64>;

/// Where rows are asked for, in steps; those off the grid are reached by a shorter step that is not continued from.
const PLACES: [f64; 6] = [0.0, 1.0, 1.25, 1.75, 3.0, 4.375];

/// The finding on one method: no row differs from the one made by hand.
pub(super) fn finding<P>(system: &P, ground: &Ground<P>, subject: &Subject<P>) -> Finding
where
    P: Lift<f64> + Clone,
{
    let mut h = ground.step;
    for _ in 0..7 {
        let method = &*subject.method;
        let both = compare(system, ground, method, h)
            .and_then(|there| Ok(f64::max(there, compare(system, ground, method, -h)?)));
        match both {
            Ok(difference) => return Finding::exact("rows", difference),
            Err(_) => h *= 0.5,
        }
    }
    Finding::exact("rows", f64::NAN)
}

/// The largest difference of rows; infinite where their number differs.
fn compare<P>(
    system: &P,
    ground: &Ground<P>,
    method: &dyn AnyMethod<f64, P>,
    h: f64,
) -> Result<f64, StepFailure>
where
    P: Lift<f64> + Clone,
{
    let mu = &ground.states[ground.states.len() - 1];
    let expected = by_hand(system, method, mu, h)?;
    let problem = Problem {
        system: system.clone(),
        mu0: mu.clone(),
        span: (0.0, PLACES[PLACES.len() - 1] * h),
    };
    let options = Options::new(h);
    let at = options
        .clone()
        .save(Save::At(PLACES.map(|place| place * h).to_vec()));
    let every = options.save(Save::Every(3));
    let every_third = [0, 4, 5].map(|place| expected[place].clone());
    let mut worst = 0.0_f64;
    for (options, expected) in [(at, &expected[..]), (every, &every_third[..])] {
        let (solution, written) = run(&problem, method, &options)?;
        let recorded: Vec<Row> = (0..solution.len())
            .map(|place| row_of(&solution, place))
            .collect();
        for rows in [recorded, written] {
            worst = f64::max(worst, difference(&rows, expected));
        }
    }
    Ok(worst)
}

fn difference(rows: &[Row], expected: &[Row]) -> f64 {
    if rows.len() != expected.len() || rows.iter().zip(expected).any(|(a, b)| a.len() != b.len()) {
        return f64::INFINITY;
    }
    let pairs = rows.iter().flatten().zip(expected.iter().flatten());
    let gaps = pairs.map(|(a, b)| {
        if (a - b).is_nan() {
            f64::INFINITY
        } else {
            (a - b).abs()
        }
    });
    gaps.fold(0.0, f64::max)
}

fn row_of<V: State<f64>>(solution: &Solution<f64, V>, place: usize) -> Row {
    let mut row = vec![solution.t[place]];
    row.extend(solution.mu[place].as_slice());
    row.push(solution.energy[place]);
    row.extend(&solution.casimirs[place]);
    row
}

/// The rows by single steps, the branch of the system carried along as a run does.
fn by_hand<P: Poisson<f64> + Clone>(
    system: &P,
    method: &dyn AnyMethod<f64, P>,
    mu: &P::State,
    h: f64,
) -> Result<Vec<Row>, StepFailure> {
    let newton = NewtonOptions::default();
    let (mut rows, mut state, mut done) = (Vec::new(), mu.clone(), 0_u32);
    let mut places = PLACES.into_iter().peekable();
    let mut current = system.following(mu).unwrap_or_else(|| system.clone());
    loop {
        let mut stepper = method.any_stepper(&current, h, &newton);
        let next = loop {
            while let Some(place) = places.next_if(|place| f64::from(done + 1) > *place) {
                let mut here = state.clone();
                let rest = place * h - f64::from(done) * h;
                if rest != 0.0 {
                    let mut shorter = method.any_stepper(&current, rest, &newton);
                    shorter.step(&mut here)?;
                }
                rows.push(row_at(&current, place * h, &here));
            }
            if places.peek().is_none() {
                return Ok(rows);
            }
            stepper.step(&mut state)?;
            done += 1;
            if let Some(next) = current.following(&state) {
                break next;
            }
        };
        drop(stepper);
        current = next;
    }
}

fn row_at<P: Poisson<f64>>(system: &P, time: f64, mu: &P::State) -> Row {
    let mut casimirs = vec![0.0; system.casimir_count()];
    system.casimirs(mu, &mut casimirs);
    let mut row = vec![time];
    row.extend(mu.as_slice());
    row.push(system.energy(mu));
    row.extend(casimirs);
    row
}

/// What an observer kept, and the rows that were written.
type Seen<V> = (Solution<f64, V>, Vec<Row>);

/// The rows of the driver, as an observer keeps them and as a program writes them.
fn run<P: Poisson<f64>>(
    problem: &Problem<f64, P>,
    method: &dyn AnyMethod<f64, P>,
    options: &Options,
) -> Result<Seen<P::State>, StepFailure> {
    let (mut bytes, mut messages) = (Vec::new(), Vec::new());
    let interrupted = AtomicBool::new(false);
    let mut recorder = Recorder::new(&problem.system);
    {
        let mut writer = RowWriter::new(&problem.system, &mut bytes, &mut messages, &interrupted);
        let mut observers = (&mut recorder, &mut writer);
        match integrate(problem, Forgotten(method), options, &mut observers) {
            Ok(_) => {}
            Err(IntegrateError::Step(error)) => return Err(error.failure),
            // refused options give no rows, and none are as many as by hand
            Err(IntegrateError::Option(_)) => return Ok((recorder.solution, Vec::new())),
        }
    }
    let numbers = bytes.chunks_exact(8).map(|bytes| {
        let bytes: [u8; 8] = bytes.try_into().unwrap_or([0xff; 8]);
        f64::from_le_bytes(bytes)
    });
    let numbers: Vec<f64> = numbers.collect();
    let width = 2 + problem.system.dimension() + problem.system.casimir_count();
    let written = numbers.chunks(width).map(<[f64]>::to_vec).collect();
    Ok((recorder.solution, written))
}
