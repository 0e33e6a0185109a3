//! Steps of methods with a solver as programs. Which operations a step makes is decided by values: how many iterations it takes, whether
//! it starts from a prediction. A trace is what one step did, with what was asked meanwhile; those that there are make one tree of programs,
//! which is run for the next steps. Where a step has an answer that is in no trace the method makes it, and another trace may be taken.

use super::record::{Guard, Unwritten, Written, followed, with_record};
use super::recorded::reported;
use super::{Recorded, following};
use crate::code::{Register, Source};
use crate::methods::implicit;
use crate::system::Dynamic;
use lie_codegen::methods::Choice;
use lie_runtime::Scalar;
use lie_runtime::methods::StepReport;
use lie_runtime::newton::NewtonOptions;
#[cfg(doc)]
use lie_runtime::scalar::Counted;
use std::cell::Cell;
use std::sync::OnceLock;

/// How many numbers a report has: a residual, and by how much less than its own of each thing that is [counted](Counted).
pub(super) const REPORTED: usize = 4;

/// What one step did.
#[derive(Debug)]
pub(crate) struct Trace {
    pub(super) written: Written,
    /// What was asked, in its order.
    pub(super) guards: Vec<Guard>,
    /// The state at the end, the memory of the stepper, and [what it reports](REPORTED).
    pub(super) gives: Vec<Register>,
    pub(super) report: StepReport,
    /// What crosses each of the things that were asked, once it was wanted.
    pub(super) crossings: Box<[OnceLock<Vec<Register>>]>,
}

/// What became of a trace.
pub(crate) enum Taken {
    Trace(Box<Trace>),
    /// The step failed.
    Failed,
    /// It has more than so many instructions, which were asked for.
    TooLong(usize),
    /// Not all that decides what it does is written down.
    Refused,
}

impl Trace {
    /// Of a step from a state, with this memory; for one number alone, or for lanes; with so many instructions at most.
    pub fn take(
        choice: &Choice,
        system: &Dynamic<f64>,
        h: f64,
        newton: &NewtonOptions,
        [mu, memory]: [&[f64]; 2],
        (single, longest): (bool, usize),
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
        let taken = followed(single, longest, || {
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
            let guards = with_record(|record| record.take_guards());
            Some((mu, guards, report))
        });
        let ((gives, guards, report), written) = match taken {
            Ok(taken) => taken,
            Err(_) if failed.get() => return Taken::Failed,
            Err(Unwritten::TooLong) => return Taken::TooLong(longest),
            Err(Unwritten::Undecided) => return Taken::Refused,
        };
        Taken::Trace(Box::new(Self {
            gives: gives.into_iter().map(|number| number.register).collect(),
            crossings: guards.iter().map(|_| OnceLock::new()).collect(),
            guards,
            written,
            report,
        }))
    }

    /// Which of the things that were asked has the first answer that is another one in another trace; none if there is no such one,
    /// or if something else was asked.
    pub fn parting(&self, other: &Self) -> Option<usize> {
        let mut pairs = self.guards.iter().zip(&other.guards);
        let place = pairs.position(|(one, other)| one != other)?;
        let [one, other] = [self, other].map(|trace| trace.guards[place]);
        let asked = |guard: Guard| (guard.register, guard.at, guard.every);
        (asked(one) == asked(other)).then_some(place)
    }

    /// Whether something was asked that has another answer in the other trace.
    pub fn parts_from(&self, other: &Self) -> bool {
        self.parting(other).is_some()
    }
}

/// By how much a lane took less than was made, of each thing that is counted.
fn missing() -> [Recorded<8>; 3] {
    let missing = with_record(|record| std::mem::take(&mut record.missing));
    missing.map(|all| {
        let all = all.into_iter().map(Recorded::of_register);
        all.fold(Recorded::zero(), |sum, one| sum + one)
    })
}
