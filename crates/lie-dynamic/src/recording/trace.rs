//! Steps of methods with a solver as programs. Which operations a step makes is decided by values: how many iterations it takes, whether
//! it starts from a prediction. A trace is what one step did, with what was asked meanwhile; it is run for the next steps, and counts
//! where all answers that skip something are the same. Elsewhere the method makes the step, and another trace may be taken.

use super::record::{Guard, Written, followed, with_record};
use super::recorded::reported;
use super::{PATIENCE, Ready, Recorded, following};
use crate::code::{Code, Source};
use crate::methods::implicit;
use crate::system::Dynamic;
use lie_codegen::methods::Choice;
use lie_runtime::Scalar;
use lie_runtime::methods::StepReport;
use lie_runtime::newton::NewtonOptions;
#[cfg(doc)]
use lie_runtime::scalar::Counted;
use lie_runtime::scalar::{Mask, largest};
use std::cell::{Cell, OnceCell};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// More traces of a step are not taken.
const MOST: usize = 12;
/// A trace is taken after so many steps that none was for, at first; for each after it twice as many.
const FIRST: u32 = 16;
/// So many sets of options of a solver have traces: more are not kept for the life of a declaration.
const OPTIONS: usize = 16;
/// After so many that could not be written down no more are taken.
const REFUSALS: u32 = 3;
/// For so many steps at most none is tried after one that none was for.
const LONGEST_REST: u32 = 32;

/// How many numbers a report has: a residual, and by how much less than its own of each thing that is [counted](Counted).
const REPORTED: usize = 4;

/// What one step did.
#[derive(Debug)]
pub(crate) struct Trace {
    /// The second computes, as a vector, the state at the end, the memory of the stepper, and [what it reports](REPORTED); as a matrix
    /// whether the answers to all that is asked are the expected ones.
    codes: Arc<[Code]>,
    report: StepReport,
}

/// The traces of a method with some options of its solver.
#[derive(Debug)]
pub(crate) struct Traces {
    all: Mutex<Vec<Arc<Trace>>>,
    waiting: Mutex<Waiting>,
    /// Whether more are taken.
    open: AtomicBool,
}

/// When the next trace is taken.
#[derive(Debug)]
struct Waiting {
    /// Steps that none was for since the last one was taken, and how many are waited for.
    missed: u32,
    patience: u32,
    /// Those that could not be written down.
    refused: u32,
}

impl Traces {
    /// None yet; the first is waited for so many steps.
    fn new(patience: u32) -> Self {
        Self {
            all: Mutex::default(),
            waiting: Mutex::new(Waiting {
                missed: 0,
                patience,
                refused: 0,
            }),
            open: AtomicBool::new(true),
        }
    }

    fn all(&self) -> MutexGuard<'_, Vec<Arc<Trace>>> {
        self.all.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn waiting(&self) -> MutexGuard<'_, Waiting> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.all().len()
    }

    /// Counts a step that none was for; whether one is to be taken.
    pub fn is_due(&self) -> bool {
        if !self.open.load(Ordering::Relaxed) {
            return false;
        }
        let mut waiting = self.waiting();
        waiting.missed += 1;
        let due = waiting.missed > waiting.patience;
        if due {
            waiting.missed = 0;
            waiting.patience = waiting.patience.saturating_mul(2);
        }
        due
    }

    /// Counts one that could not be written down; after several no more are taken.
    pub fn refuse(&self) {
        let mut waiting = self.waiting();
        waiting.refused += 1;
        if waiting.refused >= REFUSALS {
            self.open.store(false, Ordering::Relaxed);
        }
    }

    /// Adds one, if it is not there.
    pub fn add(&self, trace: Trace) {
        let mut all = self.all();
        if !all.iter().any(|known| known.codes == trace.codes) {
            all.push(Arc::new(trace));
        }
        if all.len() >= MOST {
            self.open.store(false, Ordering::Relaxed);
        }
    }
}

impl<S: Scalar> Dynamic<S> {
    /// The traces of a method.
    pub(super) fn traces(&self, choice: &Choice, newton: &NewtonOptions) -> Arc<Traces> {
        let patience = match self.compiles_at_once(None) {
            true => FIRST,
            false => PATIENCE,
        };
        let all = &self.values.compiled.traces;
        // options have numbers, which are no keys
        let key = (choice.clone(), format!("{newton:?}"));
        if all.cached(&key).is_none() && all.all_of(|(known, _)| known == choice).len() >= OPTIONS {
            let none = Traces::new(patience);
            none.open.store(false, Ordering::Relaxed);
            return Arc::new(none);
        }
        let made = all.get(&key, || Some(Traces::new(patience)));
        made.unwrap_or_else(|| unreachable!("there are always some"))
    }
}

/// 1 in the lanes where the answer to something is the expected one.
fn answer(guard: &Guard) -> Recorded<8> {
    let number = Recorded::of_register(guard.register);
    match guard.expected {
        true => number,
        false => Recorded::one() - number,
    }
}

/// What became of a trace.
pub(crate) enum Taken {
    Trace(Trace),
    /// The step failed.
    Failed,
    /// It is too long, or not all that decides what it does is written down.
    Refused,
}

impl Trace {
    /// The report of a step that gave these numbers.
    fn report<S: Scalar>(&self, numbers: &[S]) -> StepReport {
        // of the lane that misses least
        let fewer = |number: S| (-largest(-number)) as u32;
        let [all, plain, factored] = [1, 2, 3].map(|what| fewer(numbers[what]));
        StepReport {
            residual: largest(numbers[0]),
            iterations: self.report.iterations.saturating_sub(all),
            evaluations: self.report.evaluations.saturating_sub(all),
            fixed_point: self.report.fixed_point.saturating_sub(plain),
            factorizations: self.report.factorizations.saturating_sub(factored),
            ..self.report
        }
    }

    /// Of a step from a state, with this memory.
    pub fn take(
        choice: &Choice,
        system: &Dynamic<f64>,
        h: f64,
        newton: &NewtonOptions,
        [mu, memory]: [&[f64]; 2],
    ) -> Taken {
        let Some(method) = implicit::<Recorded<8>>(choice) else {
            return Taken::Refused;
        };
        let arguments = |argument: u8, values: &[f64]| -> Vec<Recorded<8>> {
            let sources = (0..).map(|place| Source::Argument(argument, place));
            let numbers = sources.zip(values);
            numbers
                .map(|(source, value)| Recorded::of_value(source, *value))
                .collect()
        };
        let failed = Cell::new(false);
        let taken = followed(|| {
            let recording = following(system);
            let h = Recorded::of_value(Source::Step, h);
            let mut stepper = method.any_stepper(&recording, h, newton);
            let mut given = arguments(1, memory).into_iter();
            let whole = stepper.carry(&mut |number| {
                if let Some(given) = given.next() {
                    *number = given;
                }
            });
            let mut mu = arguments(0, mu);
            if !whole {
                return None;
            }
            let stepped = stepper.step(&mut mu);
            failed.set(stepped.is_err());
            let report = stepped.ok()?;
            stepper.carry(&mut |number| mu.push(*number));
            let residual = reported(report.residual).map(Recorded::of_register);
            mu.push(residual.unwrap_or_else(|| Recorded::from_f64(report.residual)));
            mu.extend(missing());
            Some((mu, [answers()], report))
        });
        let Some(((vector, answers, report), written)): Option<(_, Written)> = taken else {
            return match failed.get() {
                true => Taken::Failed,
                false => Taken::Refused,
            };
        };
        Taken::Trace(Self {
            codes: Arc::from(written.codes(&vector, &answers)),
            report,
        })
    }
}

/// 1 in the lanes where all answers are the expected ones.
///
/// Nothing is said of what was asked of all lanes and is false in some, or asked of any and is true: lanes have the bits that they have
/// beside any others, so that each may go the way that one of the others would have to go.
fn answers() -> Recorded<8> {
    let mut guards = with_record(|record| record.take_guards());
    guards.sort_by_key(|guard| guard.register);
    guards.dedup();
    let each = guards.iter().filter(|guard| guard.every == guard.expected);
    let product = each.map(answer).reduce(|all, one| all * one);
    product.unwrap_or_else(Recorded::one)
}

/// By how much a lane took less than was made, of each thing that is counted.
fn missing() -> [Recorded<8>; 3] {
    let missing = with_record(|record| std::mem::take(&mut record.missing));
    missing.map(|all| {
        let all = all.into_iter().map(Recorded::of_register);
        all.fold(Recorded::zero(), |sum, one| sum + one)
    })
}

/// A trace that is made ready when it is first tried; `None` where the engine makes no machine.
struct ReadyTrace<S> {
    trace: Arc<Trace>,
    ready: OnceCell<Option<Ready<S>>>,
}

/// The steps of a system by traces, and what these carry from step to step.
pub(super) struct Followed<'a, S: Scalar> {
    pub system: &'a Dynamic<S>,
    pub h: [S; 1],
    traces: Vec<ReadyTrace<S>>,
    /// How many of the traces of its method it knows.
    known: usize,
    /// For how many steps none is tried after one that none was for, and how many of them are left.
    rest: u32,
    resting: u32,
    /// Whether the trace of the last step made iterations that it did not need.
    is_long: bool,
    /// What the last trace gave and what the next one gives: a state, what the stepper of a method would remember, and a report.
    last: Vec<S>,
    results: Vec<S>,
}

impl<'a, S: Scalar> Followed<'a, S> {
    /// Of a stepper that remembers these numbers.
    pub fn new(system: &'a Dynamic<S>, h: S, memory: &[S]) -> Self {
        let size = system.values.compiled.plan.dimension();
        let mut last = vec![S::zero(); size + memory.len() + REPORTED];
        last[size..][..memory.len()].copy_from_slice(memory);
        Self {
            system,
            h: [h],
            traces: Vec::new(),
            known: 0,
            rest: 0,
            resting: 0,
            is_long: false,
            results: last.clone(),
            last,
        }
    }

    fn places(&self) -> Range<usize> {
        self.system.values.compiled.plan.dimension()..self.last.len() - REPORTED
    }

    /// What the stepper of a method would remember.
    pub fn memory(&self) -> &[S] {
        &self.last[self.places()]
    }

    /// The same, to be written.
    pub fn memory_mut(&mut self) -> &mut [S] {
        let places = self.places();
        &mut self.last[places]
    }

    /// Takes those that have come since.
    pub fn take_from(&mut self, traces: &Traces) {
        let all = traces.all();
        for trace in &all[self.known..] {
            self.add(Arc::clone(trace));
        }
        self.known = all.len();
    }

    fn add(&mut self, trace: Arc<Trace>) {
        let ready = OnceCell::new();
        self.traces.insert(0, ReadyTrace { trace, ready });
        (self.rest, self.resting) = (0, 0);
    }

    /// Whether the trace of the last step made iterations that it did not need; asked once for each.
    pub fn was_long(&mut self) -> bool {
        std::mem::take(&mut self.is_long)
    }

    /// Tries none for so many steps.
    pub fn rest(&mut self, steps: u32) {
        self.resting = steps;
    }

    /// Counts a step; whether none is tried.
    pub fn rests(&mut self) -> bool {
        let rests = self.resting > 0;
        self.resting = self.resting.saturating_sub(1);
        rests
    }

    /// Makes a step by the first trace that is for it; none if there is no such one.
    pub fn step(&mut self, mu: &mut [S]) -> Option<StepReport> {
        let places = self.places();
        for place in 0..self.traces.len() {
            let ReadyTrace { trace, ready } = &self.traces[place];
            let [h] = self.h;
            let made = ready.get_or_init(|| Ready::new(self.system, &trace.codes, h, false));
            let Some(ready) = made else {
                continue;
            };
            let arguments = [&*mu, &self.last[places.clone()], &[], &[]];
            let frame = self.system.values.frame(arguments, &ready.of_step, &self.h);
            let mut answers = [S::zero()];
            let targets = [&mut self.results[..], &mut answers[..]];
            ready.machine.run(1, &frame, targets);
            if !S::ratio(1.0, 2.0).less(answers[0]).all() {
                continue;
            }
            std::mem::swap(&mut self.last, &mut self.results);
            mu.copy_from_slice(&self.last[..mu.len()]);
            let report = trace.report(&self.last[places.end..]);
            // steps are often like the last one; one that took fewer iterations is to have a trace of its own, which comes earlier
            self.is_long = report.iterations < trace.report.iterations;
            match self.is_long {
                false => self.traces[..=place].rotate_right(1),
                true => self.traces[place..].rotate_left(1),
            }
            self.rest /= 2;
            return Some(report);
        }
        if !self.traces.is_empty() {
            self.rest = (2 * self.rest + 1).min(LONGEST_REST);
            self.resting = self.rest;
        }
        None
    }
}
