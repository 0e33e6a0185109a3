//! An iteration over stages side by side as programs: the field, the product with the tableau and the changes in one.

use super::record::{Written, written};
use super::{Ready, Recorded, recording, source_numbers};
use crate::code::{Code, Source};
use crate::compiled::Compiled;
use crate::engine::ARGUMENTS;
use crate::system::Dynamic;
use lie_core::generic::{At, LinearLift, STAGE_TABLE, StageProgram, StageSlopes, StageStep};
use lie_core::methods::{Hopf, Quaternion, Representation, Unitary};
use lie_runtime::{Poisson, Scalar, State, Widen};
use std::fmt;
use std::sync::Arc;

/// The arguments of the codes.
const BASE: u8 = 0;
const INCREMENTS: u8 = 1;
const TABLE: u8 = 2;
const LABELS: u8 = 3;

/// The codes of an iteration, each behind what it has of the parameters alone.
#[derive(Debug)]
pub(crate) struct StageCodes {
    /// The next increments alone.
    iterate: Arc<[Code]>,
    /// The same with the largest change and the end of the step.
    look: Arc<[Code]>,
    /// The increments to start from, with the size of their slopes.
    go_on: Arc<[Code]>,
}

/// What is written down of an iteration.
#[derive(Clone, Copy)]
enum What {
    Iterate,
    Look,
    GoOn,
}

/// An iteration of some slopes, over a scalar that records.
struct Iteration<V> {
    zero: V,
    step: StageStep,
}

impl<V: State<Recorded>> Iteration<V> {
    fn write(&self, what: What, field: impl FnMut(At<'_, V>, &mut V)) -> [Vec<Recorded>; 2] {
        let argument = |argument: u8| {
            let mut all = self.zero.clone();
            let count = all.as_slice().len();
            let numbers = source_numbers(count, |place| Source::Argument(argument, place));
            all.as_mut_slice().copy_from_slice(&numbers);
            all
        };
        let table = source_numbers(STAGE_TABLE, |place| Source::Argument(TABLE, place));
        let given = (&argument(BASE), argument(INCREMENTS));
        let (next, told) = match what {
            What::GoOn => {
                let (next, size) = self.step.go_on::<Recorded, V>(given, &table);
                (next, vec![size])
            }
            What::Iterate | What::Look => {
                let look = self.step.look::<Recorded, V>(given, &table, field);
                let told = [&[look.change], look.end.as_slice()].concat();
                (look.increments, told)
            }
        };
        let told = match what {
            What::Iterate => Vec::new(),
            What::Look | What::GoOn => told,
        };
        [next.as_slice().to_vec(), told]
    }
}

/// The iteration of a lift.
fn of_lift<L>(system: &Dynamic<Recorded>, stages: usize, what: What) -> [Vec<Recorded>; 2]
where
    L: LinearLift<Recorded, Dynamic<Recorded>>,
{
    let mut labels = L::zero_labels(system);
    let count = labels.as_slice().len();
    let numbers = source_numbers(count, |place| Source::Argument(LABELS, place));
    labels.as_mut_slice().copy_from_slice(&numbers);
    let iteration = Iteration {
        zero: L::zero_point(system),
        step: StageStep {
            stages,
            clock: L::clock(system),
            momenta: L::momenta(system),
        },
    };
    iteration.write(what, |at, slopes| {
        L::flow(system, &labels, at.points, slopes);
    })
}

fn of_field(system: &Dynamic<Recorded>, stages: usize, what: What) -> [Vec<Recorded>; 2] {
    let iteration = Iteration {
        zero: system.zero_state(),
        step: StageStep {
            stages,
            clock: system.clock(),
            momenta: None,
        },
    };
    iteration.write(what, |at, slopes| system.vector_field(at.points, slopes))
}

impl StageCodes {
    fn new(compiled: &Arc<Compiled>, slopes: StageSlopes, stages: usize) -> Option<Self> {
        let of = match slopes {
            StageSlopes::Field => of_field,
            StageSlopes::Hopf => of_lift::<Hopf>,
            StageSlopes::Quaternion => of_lift::<Quaternion>,
            StageSlopes::Representation => of_lift::<Representation>,
            StageSlopes::Unitary => of_lift::<Unitary>,
        };
        let codes = |what| -> Option<Arc<[Code]>> {
            let ([vector, told], written): ([Vec<Recorded>; 2], Written) =
                written(|| Some(of(&recording(compiled), stages, what)))?;
            Some(Arc::from(written.codes(&vector, &told)))
        };
        Some(Self {
            iterate: codes(What::Iterate)?,
            look: codes(What::Look)?,
            go_on: codes(What::GoOn)?,
        })
    }
}

/// The programs of an iteration, ready to run.
struct Stages<W: Scalar> {
    system: Dynamic<W>,
    iterate: Ready<W>,
    look: Ready<W>,
    go_on: Ready<W>,
    labels: Vec<W>,
    /// What the last look told: the largest change, and the end of the step.
    told: Vec<W>,
}

impl<W: Scalar> fmt::Debug for Stages<W> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Stages").finish_non_exhaustive()
    }
}

impl<S: Scalar> Dynamic<S> {
    /// The programs of an iteration over stages side by side; none where it is not recorded, or where making them takes longer than
    /// most runs.
    pub(crate) fn stages(
        &self,
        slopes: StageSlopes,
        stages: usize,
    ) -> Option<Box<dyn StageProgram<S::Wide>>> {
        if S::LANES > 1 || !self.is_recordable() || !self.compiles_at_once(None) {
            return None;
        }
        let compiled = &self.values.compiled;
        let make = || StageCodes::new(compiled, slopes, stages);
        let codes = compiled.stages.get(&(slopes, stages > 4), make)?;
        let system = self.widen();
        let none = S::Wide::zero();
        let ready = |codes| Ready::new(&system, codes, none, false);
        Some(Box::new(Stages {
            iterate: ready(&codes.iterate)?,
            look: ready(&codes.look)?,
            go_on: ready(&codes.go_on)?,
            labels: Vec::new(),
            told: Vec::new(),
            system,
        }))
    }
}

impl<W: Scalar> StageProgram<W> for Stages<W> {
    fn iterate(&mut self, count: u32, table: &[W], base: &[W], increments: [&mut [W]; 2]) {
        let Ready { machine, of_step } = &self.iterate;
        let arguments: [&[W]; ARGUMENTS] = [base, &[], table, &self.labels];
        let frame = self.system.values.frame(arguments, of_step, &[]);
        machine.repeat(1, count, &frame, increments);
    }

    fn look(&mut self, table: &[W], base: &[W], [from, to]: [&mut [W]; 2]) -> W {
        let Ready { machine, of_step } = &self.look;
        let arguments: [&[W]; ARGUMENTS] = [base, from, table, &self.labels];
        let frame = self.system.values.frame(arguments, of_step, &[]);
        self.told.resize(1 + base.len(), W::zero());
        machine.run(1, &frame, [to, &mut self.told]);
        self.told[0]
    }

    fn end(&self) -> &[W] {
        &self.told[1..]
    }

    fn go_on(&mut self, table: &[W], base: &[W], [from, to]: [&mut [W]; 2]) -> W {
        let Ready { machine, of_step } = &self.go_on;
        let arguments: [&[W]; ARGUMENTS] = [base, from, table, &[]];
        let frame = self.system.values.frame(arguments, of_step, &[]);
        let mut size = [W::zero()];
        machine.run(1, &frame, [to, &mut size]);
        let [size] = size;
        size
    }

    fn set_labels(&mut self, labels: &[W]) {
        self.labels.clear();
        self.labels.extend_from_slice(labels);
    }
}
