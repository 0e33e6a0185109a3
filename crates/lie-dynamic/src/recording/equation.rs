//! The residual of an equation, and its Jacobian, as one program each.

use super::record::{Written, written};
use super::{Countdown, Ready, Recorded, recording, source_numbers};
use crate::code::{Code, Source};
use crate::compiled::Compiled;
use crate::compiled::elimination::Blocks;
use crate::engine::ARGUMENTS;
use crate::system::Dynamic;
use lie_codegen::methods::Choice;
use lie_runtime::{Equation, Poisson, Scalar, Unknown};
use std::any::TypeId;
use std::sync::Arc;

/// What is written down of an equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Evaluation {
    Residual,
    /// The residual with its Jacobian.
    Linearize,
}

/// The numbers of a residual, part after part, and of its Jacobian, block after block.
pub(crate) type Numbers = [Vec<Recorded>; 2];

/// Writes down something of the equation of a step, for a system and a step size.
pub(crate) type Write = fn(&Dynamic<Recorded>, Recorded, Evaluation) -> Option<Numbers>;

/// An unknown of more parts does not fit the arguments of a code, beside the state.
const PARTS: usize = ARGUMENTS - 1;
/// A larger matrix is not stored entry by entry.
const ENTRIES: usize = 10_000;
/// A step evaluates its equation about so often, and each evaluation gains that much less than a step does.
const EVALUATIONS: u32 = 5;

/// Something of an equation, of the state that is the first argument and the parts of the unknown behind it.
pub(crate) fn write<E>(
    mut equation: E,
    system: &Dynamic<Recorded>,
    what: Evaluation,
) -> Option<Numbers>
where
    E: Equation<Recorded, State = Vec<Recorded>>,
    E::Matrix: Blocks<Recorded>,
{
    let mut unknown = equation.zero_unknown();
    let parts = unknown.parts();
    let size = unknown.part(0).len();
    if parts > PARTS || (parts * size).pow(2) > ENTRIES {
        return None;
    }
    for part in 0..parts {
        let numbers = source_numbers(size, |entry| Source::Argument(1 + part as u8, entry));
        unknown.part_mut(part).copy_from_slice(&numbers);
    }
    equation.set_base(&source_numbers(system.dimension(), |entry| {
        Source::Argument(0, entry)
    }));
    let mut residual = equation.zero_unknown();
    let mut blocks = Vec::new();
    match what {
        Evaluation::Residual => equation.residual(&unknown, &mut residual),
        Evaluation::Linearize => {
            let mut matrix = equation.zero_matrix();
            equation.linearize(&unknown, &mut residual, &mut matrix);
            let across = 0..matrix.block_count();
            for (row, column) in across
                .clone()
                .flat_map(|i| across.clone().map(move |j| (i, j)))
            {
                blocks.extend_from_slice(matrix.block(row, column));
            }
        }
    }
    let parts = (0..parts).map(|part| residual.part(part));
    Some([parts.collect::<Vec<_>>().concat(), blocks])
}

/// The codes of an equation: of the residual, and of the residual with its Jacobian, each behind what it has of the step size.
#[derive(Debug)]
pub(crate) struct Programs {
    residual: Arc<[Code]>,
    linearize: Option<Arc<[Code]>>,
}

impl Programs {
    fn new(compiled: &Arc<Compiled>, write: Write) -> Option<Self> {
        let codes = |what| -> Option<Arc<[Code]>> {
            let (numbers, written): (Numbers, Written) = written(|| {
                write(
                    &recording(compiled),
                    Recorded::from_source(Source::Step),
                    what,
                )
            })?;
            let [vector, matrix] = numbers;
            // a program does not report numbers that were asked whether they are finite, so there is none
            written
                .finiteness_tests()
                .is_empty()
                .then(|| Arc::from(written.codes(&vector, &matrix)))
        };
        Some(Self {
            residual: codes(Evaluation::Residual)?,
            linearize: codes(Evaluation::Linearize),
        })
    }

    /// The codes of each.
    pub fn codes(&self) -> impl Iterator<Item = &Arc<[Code]>> {
        [&self.residual].into_iter().chain(&self.linearize)
    }

    fn length(&self) -> usize {
        self.codes().map(|codes| codes[1].instructions.len()).sum()
    }
}

/// An equation whose programs are run, once it was evaluated often enough.
pub(crate) struct Running<S> {
    write: Write,
    choice: Choice,
    h: [S; 1],
    base: Vec<S>,
    wait: Countdown,
    residual: Option<Ready<S>>,
    linearize: Option<Ready<S>>,
    vector: Vec<S>,
    matrix: Vec<S>,
}

impl<S: Scalar> Running<S> {
    /// Of the equation of a method; none where nothing of it is written down.
    pub fn new(system: &Dynamic<S>, choice: &Choice, h: S, write: Write) -> Option<Self> {
        // what is being written down is not run
        let recording = TypeId::of::<S>() == TypeId::of::<Recorded>();
        if cfg!(target_arch = "wasm32")
            || recording
            || !system.is_recordable()
            || !system.values.machine.compiles()
        {
            return None;
        }
        let known = system.values.compiled.equations.cached(choice);
        let known = known.as_ref().map(|programs| &programs.residual);
        let at_once = system.compiles_at_once(known);
        let mut running = Self {
            write,
            choice: choice.clone(),
            h: [h],
            base: system.zero_state(),
            wait: Countdown::new(EVALUATIONS, at_once),
            residual: None,
            linearize: None,
            vector: Vec::new(),
            matrix: Vec::new(),
        };
        if at_once {
            running.compile(system);
        }
        Some(running)
    }

    pub fn set_base(&mut self, mu: &[S]) {
        self.base.copy_from_slice(mu);
    }

    fn programs(&self, system: &Dynamic<S>) -> Option<Arc<Programs>> {
        let compiled = &system.values.compiled;
        let make = || Programs::new(compiled, self.write);
        compiled.equations.get(&self.choice, make)
    }

    #[cold]
    fn compile(&mut self, system: &Dynamic<S>) {
        let Some(programs) = self.programs(system) else {
            return;
        };
        let codes = [Some(&programs.residual), programs.linearize.as_ref()];
        let [h] = self.h;
        [self.residual, self.linearize] = codes.map(|codes| Ready::new(system, codes?, h, false));
        let stored = |target: u8| {
            let codes = programs.linearize.as_ref().unwrap_or(&programs.residual);
            let stores = codes[1].stores.iter();
            stores.filter(|store| store.target == target).count()
        };
        self.vector = vec![S::zero(); stored(0)];
        self.matrix = vec![S::zero(); stored(1)];
    }

    #[inline]
    fn wait(&mut self, system: &Dynamic<S>) {
        if self.wait.left > 0 {
            self.count(system);
        }
    }

    #[inline(never)]
    fn count(&mut self, system: &Dynamic<S>) {
        let mut wait = std::mem::replace(&mut self.wait, Countdown::new(0, true));
        let length = || {
            self.programs(system)
                .map_or(0, |programs| programs.length())
        };
        if wait.is_over(length) {
            self.compile(system);
        }
        self.wait = wait;
    }

    /// Computes the residual; false where it is not run as a program.
    pub fn residual<U: Unknown<S>>(
        &mut self,
        system: &Dynamic<S>,
        unknown: &U,
        residual: &mut U,
    ) -> bool {
        self.wait(system);
        let Some(ready) = &self.residual else {
            return false;
        };
        ready.run(
            system,
            [&self.base, &self.h],
            unknown,
            [&mut self.vector, &mut []],
        );
        scatter(&self.vector, residual);
        true
    }

    /// The same with the Jacobian.
    pub fn linearize<U: Unknown<S>, M: Blocks<S>>(
        &mut self,
        system: &Dynamic<S>,
        unknown: &U,
        residual: &mut U,
        matrix: &mut M,
    ) -> bool {
        self.wait(system);
        let Some(ready) = &self.linearize else {
            return false;
        };
        let (arguments, across) = ([self.base.as_slice(), &self.h], matrix.block_count());
        if across == 1 {
            let targets = [residual.part_mut(0), matrix.block_mut(0, 0)];
            ready.run(system, arguments, unknown, targets);
            return true;
        }
        ready.run(
            system,
            arguments,
            unknown,
            [&mut self.vector, &mut self.matrix],
        );
        scatter(&self.vector, residual);
        let size = self.matrix.len() / (across * across);
        for (place, block) in self.matrix.chunks_exact(size).enumerate() {
            matrix
                .block_mut(place / across, place % across)
                .copy_from_slice(block);
        }
        true
    }
}

/// Gives the parts of a vector theirs.
fn scatter<S: Scalar, U: Unknown<S>>(numbers: &[S], vector: &mut U) {
    let size = vector.part(0).len();
    for (part, numbers) in numbers.chunks_exact(size).enumerate() {
        vector.part_mut(part).copy_from_slice(numbers);
    }
}

impl<S: Scalar> Ready<S> {
    fn run<U: Unknown<S>>(
        &self,
        system: &Dynamic<S>,
        [base, h]: [&[S]; 2],
        unknown: &U,
        targets: [&mut [S]; 2],
    ) {
        let mut arguments: [&[S]; ARGUMENTS] = [&[]; ARGUMENTS];
        arguments[0] = base;
        for part in 0..unknown.parts() {
            arguments[1 + part] = unknown.part(part);
        }
        let frame = system.values.frame(arguments, &self.of_step, h);
        self.machine.run(1, &frame, targets);
    }
}
