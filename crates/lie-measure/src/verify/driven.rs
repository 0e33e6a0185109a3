//! Whether the driver shows what the steps of a method make: times, states, energies and Casimirs of its rows, on the
//! grid and off it, forwards and backwards, from a start that is not 0, as observers see them and as programs write
//! them, with the work of all steps.

use super::outside;
use crate::facts::{Finding, Ground, Subject, spoiled};
use lie_program::protocol::{Coordinates, Found, Message};
use lie_program::session::Session;
use lie_program::{RowWriter, shown};
use lie_runtime::diagnostics::{AnyMethod, Forgotten};
use lie_runtime::driver::{
    IntegrateError, Options, Problem, Quantities, Recorder, Save, Solution, Stats, Status,
    integrate, set_time,
};
use lie_runtime::methods::{StepFailure, StepReport};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::poisson::{Lift, Poisson};
use lie_runtime::state::State;

/// A row: time, state, energy, Casimirs, declared functions.
type Row = Vec<f64>;

/// Where rows are asked for, in steps; those off the grid are reached by a shorter step that is not continued from.
const PLACES: [f64; 8] = [0.0, 1.0, 1.25, 1.75, 2.5, 3.0, 3.75, 4.375];
/// The distance of rows in one of the runs, in steps, and the places at which it has them beside the end.
const INTERVAL: f64 = 1.25;
const AT_INTERVALS: [usize; 4] = [0, 2, 4, 6];
/// The places of a run with each third step, beside the end.
const AT_THIRD: [usize; 2] = [0, 5];
/// The start, in steps.
const START: f64 = 0.75;

/// The finding on one method: no row differs from the one made by hand, and none is made of what is no number.
pub(super) fn finding<P>(system: &P, ground: &Ground<P>, subject: &Subject<P>) -> Finding
where
    P: Lift<f64> + Clone,
{
    if !outside::is_refused(system, ground) {
        return Finding::exact("rows", f64::INFINITY);
    }
    let mut h = ground.step;
    for _ in 0..7 {
        let method = &*subject.method;
        let both = compare(system, ground, [method; 2], h)
            .and_then(|there| Ok(f64::max(there, compare(system, ground, [method; 2], -h)?)));
        match both {
            Ok(difference) => return Finding::exact("rows", difference),
            Err(_) => h *= 0.5,
        }
    }
    Finding::exact("rows", f64::NAN)
}

/// Whether the comparison sees no difference between a method and the same one spoiled, or between two rows that differ in
/// the last digit of one number.
pub(super) fn is_blind<P>(system: &P, ground: &Ground<P>, subject: &Subject<P>) -> bool
where
    P: Lift<f64> + Clone,
{
    let method = &*subject.method;
    let other = spoiled(ground, method);
    let passes = compare(system, ground, [&other, method], ground.step) == Ok(0.0);
    let row: Row = (0..3 + system.dimension())
        .map(|k| 1.5 + k as f64)
        .collect();
    let same = |place: usize| {
        let mut spoiled = row.clone();
        spoiled[place] *= 1.0 + f64::EPSILON;
        difference(&[row.clone(), spoiled], &[row.clone(), row.clone()]) == 0.0
    };
    passes || (0..row.len()).any(same) || difference(std::slice::from_ref(&row), &[]) == 0.0
}

/// What one run should show: its way to save, the places of its rows, and the shorter steps among them.
type Wanted = (Save, Vec<usize>);

fn wanted(t0: f64, h: f64) -> [Wanted; 4] {
    let last = PLACES.len() - 1;
    let with_end = |places: &[usize]| [places, &[last]].concat();
    let times = (0..=last).map(|place| time(place, t0, h)).collect();
    [
        (Save::At(times), (0..=last).collect()),
        (Save::Every(3), with_end(&AT_THIRD)),
        (Save::Interval(INTERVAL * h), with_end(&AT_INTERVALS)),
        (Save::Ends, with_end(&[0])),
    ]
}

/// The time of a row: on the grid and in intervals by multiplication.
fn time(place: usize, t0: f64, h: f64) -> f64 {
    match AT_INTERVALS.iter().position(|&other| other == place) {
        Some(count) => t0 + count as f64 * (INTERVAL * h),
        None => t0 + PLACES[place] * h,
    }
}

/// The largest difference of the rows that the first method makes in the driver from those of the second by hand; infinite
/// where their number differs, or what the run says of its work.
fn compare<P>(
    system: &P,
    ground: &Ground<P>,
    [method, by_steps]: [&dyn AnyMethod<f64, P>; 2],
    h: f64,
) -> Result<f64, StepFailure>
where
    P: Lift<f64> + Clone,
{
    let mu = &ground.states[ground.states.len() - 1];
    let t0 = START * h;
    let expected = by_hand(system, by_steps, mu, t0, h)?;
    let last = PLACES.len() - 1;
    let problem = Problem {
        system: system.clone(),
        mu0: mu.clone(),
        span: (t0, time(last, t0, h)),
    };
    let mut worst = 0.0_f64;
    for (save, places) in wanted(t0, h) {
        let options = Options::new(h).save(save);
        let rows: Vec<Row> = places.iter().map(|&k| expected[k].row.clone()).collect();
        let (solution, written) = run(&problem, method, &options)?;
        let recorded: Vec<Row> = (0..solution.len())
            .map(|place| row_of(system, &solution, place))
            .collect();
        for seen in [recorded, written] {
            worst = f64::max(worst, difference(&seen, &rows));
        }
        let shorter = places.iter().filter_map(|&k| expected[k].shorter);
        let whole = expected.iter().flat_map(|made| &made.whole).copied();
        if !is_work_of(&solution, whole.chain(shorter)) {
            worst = f64::INFINITY;
        }
    }
    Ok(worst)
}

/// Whether a run that came to its end counts the work of these steps.
fn is_work_of<V>(solution: &Solution<f64, V>, steps: impl Iterator<Item = StepReport>) -> bool {
    let mut work = Stats::default();
    for report in steps {
        work.steps += 1;
        work.evaluations += u64::from(report.evaluations);
        work.newton += u64::from(report.iterations);
        work.fixed_point += u64::from(report.fixed_point);
        work.factorizations += u64::from(report.factorizations);
        work.pivoted += u64::from(report.pivoted != 0);
        work.accepted += u64::from(report.substeps);
        work.rejected += u64::from(report.rejected);
    }
    solution.stats == work && solution.status == Status::Finished
}

/// The largest difference of numbers in rows; infinite where there are more or fewer.
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

fn row_of<P: Poisson<f64>>(system: &P, solution: &Solution<f64, P::State>, place: usize) -> Row {
    let mut row = vec![solution.t[place]];
    row.extend(&solution.mu[place].as_slice()[..shown(system)]);
    row.push(solution.energy[place]);
    row.extend(&solution.casimirs[place]);
    row.extend(
        solution.quantities[place]
            .iter()
            .map(|value| comparable(*value)),
    );
    row
}

/// A row by single steps, with those of the grid since the row before and the shorter one to a place off the grid.
struct Made {
    row: Row,
    whole: Vec<StepReport>,
    shorter: Option<StepReport>,
}

/// The rows by single steps, the branch of the system carried along as a run does.
fn by_hand<P: Poisson<f64> + Clone>(
    system: &P,
    method: &dyn AnyMethod<f64, P>,
    mu: &P::State,
    t0: f64,
    h: f64,
) -> Result<Vec<Made>, StepFailure> {
    let newton = NewtonOptions::default();
    let (mut rows, mut state, mut done) = (Vec::new(), mu.clone(), 0_u32);
    let (mut whole, mut quantities) = (Vec::new(), Quantities::new(system));
    let mut places = PLACES.into_iter().enumerate().peekable();
    set_time(system, &mut state, t0);
    let mut current = system.following(&state).unwrap_or_else(|| system.clone());
    loop {
        let mut stepper = method.any_stepper(&current, h, &newton);
        let next = loop {
            while let Some((index, place)) = places.next_if(|(_, at)| f64::from(done + 1) > *at) {
                let mut here = state.clone();
                let time = time(index, t0, h);
                let mut shorter = None;
                if place > f64::from(done) {
                    let rest = time - (t0 + f64::from(done) * h);
                    let mut stepper = method.any_stepper(&current, rest, &newton);
                    shorter = Some(stepper.step(&mut here)?);
                    set_time(&current, &mut here, time);
                }
                rows.push(Made {
                    row: row_at(&current, time, &here, &mut quantities),
                    whole: core::mem::take(&mut whole),
                    shorter,
                });
            }
            if places.peek().is_none() {
                return Ok(rows);
            }
            whole.push(stepper.step(&mut state)?);
            done += 1;
            let time = t0 + f64::from(done) * h;
            set_time(&current, &mut state, time);
            quantities.at(&current, time, &state);
            if let Some(next) = current.following(&state) {
                break next;
            }
        };
        drop(stepper);
        current = next;
    }
}

fn row_at<P: Poisson<f64>>(
    system: &P,
    time: f64,
    mu: &P::State,
    quantities: &mut Quantities<f64>,
) -> Row {
    let mut casimirs = vec![0.0; system.casimir_count()];
    system.casimirs(mu, &mut casimirs);
    let mut row = vec![time];
    row.extend(&mu.as_slice()[..shown(system)]);
    row.push(system.energy(mu));
    row.extend(casimirs);
    row.extend(
        quantities
            .at(system, time, mu)
            .iter()
            .map(|value| comparable(*value)),
    );
    row
}

/// A declared function may have no value at a state: then every row should say so.
fn comparable(value: f64) -> f64 {
    if value.is_nan() { f64::MAX } else { value }
}

/// What an observer kept, and the rows that were written.
type Seen<V> = (Solution<f64, V>, Vec<Row>);

/// The rows of the driver, as an observer keeps them and as a program writes them.
fn run<P: Poisson<f64>>(
    problem: &Problem<f64, P>,
    method: &dyn AnyMethod<f64, P>,
    options: &Options,
) -> Result<Seen<P::State>, StepFailure> {
    let mut said = Vec::new();
    let mut recorder = Recorder::new(&problem.system).without_events();
    let ended;
    {
        let mut session = Session::undisturbed(&mut said);
        let mut writer = RowWriter::new(&problem.system, &mut session).without_events();
        let mut observers = (&mut recorder, &mut writer);
        match integrate(problem, Forgotten(method), options, &mut observers) {
            Ok(outcome) => ended = outcome,
            Err(IntegrateError::Step(error)) => return Err(error.failure),
            // refused options give no rows, and none are as many as by hand
            Err(IntegrateError::Option(_)) => return Ok((recorder.solution, Vec::new())),
        }
        writer.finish();
    }
    (recorder.solution.stats, recorder.solution.status) = ended;
    Ok((recorder.solution, rows(&problem.system, said)))
}

/// The rows of a program, if its columns are those of the system.
fn rows<P: Poisson<f64>>(system: &P, said: Vec<Message<Found>>) -> Vec<Row> {
    let (mut named, mut all) = (false, Vec::new());
    for message in said {
        match message {
            Message::Found(Found::Columns(columns)) => {
                named = match &columns.coordinates {
                    Coordinates::Named(names) => {
                        let mut names = names.iter().enumerate();
                        names.all(|(place, name)| system.coordinate(place) == name)
                    }
                    Coordinates::OfSites(count) => {
                        system.sites().is_some() && *count == shown(system)
                    }
                };
            }
            Message::Found(Found::Rows(rows)) if named => {
                all.extend(rows.numbers.chunks(rows.width).map(|numbers| {
                    let mut row = numbers.to_vec();
                    let declared = &mut row[numbers.len() - system.quantity_count()..];
                    declared
                        .iter_mut()
                        .for_each(|value| *value = comparable(*value));
                    row
                }));
            }
            _ => {}
        }
    }
    all
}
