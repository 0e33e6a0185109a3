//! The residual of an equation, and its Jacobian, as one program each.

use super::record::{Written, written};
use super::{PATIENCE, Ready, Recorded, all, recording};
use crate::code::{Code, Source};
use crate::compiled::Compiled;
use crate::elimination::Blocks;
use crate::kernels::ARGUMENTS;
use crate::system::Dynamic;
use lie_codegen::methods::Choice;
use lie_runtime::{Equation, Poisson, Scalar, Unknown};
use std::any::TypeId;
use std::sync::Arc;

/// What is written down of an equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum What {
    Residual,
    /// The residual with its Jacobian.
    Linearize,
}

/// The numbers of a residual, part after part, and of its Jacobian, block after block.
pub(crate) type Numbers = [Vec<Recorded>; 2];

/// Writes down something of the equation of a step, for a system and a step size.
pub(crate) type Write = fn(&Dynamic<Recorded>, Recorded, What) -> Option<Numbers>;

/// More parts of an unknown are not arguments beside the state.
const PARTS: usize = ARGUMENTS - 1;
/// Nor are matrices of more entries stored one by one.
const ENTRIES: usize = 10_000;

/// Something of an equation, of the state that is the first argument and the parts of the unknown behind it.
pub(crate) fn write<E>(mut equation: E, system: &Dynamic<Recorded>, what: What) -> Option<Numbers>
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
        let numbers = all(size, |entry| Source::Argument(1 + part as u8, entry));
        unknown.part_mut(part).copy_from_slice(&numbers);
    }
    equation.set_base(&all(system.dimension(), |entry| Source::Argument(0, entry)));
    let mut residual = equation.zero_unknown();
    let mut blocks = Vec::new();
    match what {
        What::Residual => equation.residual(&unknown, &mut residual),
        What::Linearize => {
            let mut matrix = equation.zero_matrix();
            equation.linearize(&unknown, &mut residual, &mut matrix);
            let across = 0..matrix.across();
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
            let (numbers, written): (Numbers, Written) =
                written(|| write(&recording(compiled), Recorded::of(Source::Step), what))?;
            let [vector, matrix] = numbers;
            // what is asked of numbers on the way the program does not answer
            written
                .asked()
                .is_empty()
                .then(|| Arc::from(written.codes(&vector, &matrix)))
        };
        Some(Self {
            residual: codes(What::Residual)?,
            linearize: codes(What::Linearize),
        })
    }
}

impl Programs {
    /// How many there are.
    pub fn count(&self) -> usize {
        1 + usize::from(self.linearize.is_some())
    }
}

/// An equation is evaluated so often in a step, about, and gains as much less by an evaluation.
const EVALUATIONS: u32 = 5;

/// An equation whose programs are run, once it was evaluated often enough.
pub(crate) struct Running<S> {
    write: Write,
    choice: Choice,
    h: [S; 1],
    base: Vec<S>,
    waits: u32,
    residual: Option<Ready<S>>,
    linearize: Option<Ready<S>>,
    vector: Vec<S>,
    matrix: Vec<S>,
}

impl<S: Scalar> Running<S> {
    /// Of the equation of a method; none where nothing of it is written down.
    pub fn new(system: &Dynamic<S>, choice: &Choice, h: S, write: Write) -> Option<Self> {
        // what is being written down is not run
        if TypeId::of::<S>() == TypeId::of::<Recorded>() || !system.is_written() {
            return None;
        }
        let mut running = Self {
            write,
            choice: choice.clone(),
            h: [h],
            base: system.zero_state(),
            waits: PATIENCE * EVALUATIONS,
            residual: None,
            linearize: None,
            vector: Vec::new(),
            matrix: Vec::new(),
        };
        if system.values.compiled.equations.at_once(choice) {
            running.waits = 0;
            running.compile(system);
        }
        Some(running)
    }

    pub fn set_base(&mut self, mu: &[S]) {
        self.base.copy_from_slice(mu);
    }

    #[cold]
    fn compile(&mut self, system: &Dynamic<S>) {
        let compiled = &system.values.compiled;
        let programs = compiled
            .equations
            .get(&self.choice, || Programs::new(compiled, self.write));
        let Some(programs) = programs else { return };
        let ready = |codes| Ready::new(system, codes, self.h[0], false);
        self.residual = ready(&programs.residual);
        self.linearize = programs.linearize.as_ref().and_then(ready);
        let stored = |target: u8| {
            let codes = programs.linearize.as_ref().unwrap_or(&programs.residual);
            let stores = codes[1].stores.iter();
            stores.filter(|store| store.target == target).count()
        };
        self.vector = vec![S::zero(); stored(0)];
        self.matrix = vec![S::zero(); stored(1)];
    }

    fn wait(&mut self, system: &Dynamic<S>) {
        if self.waits > 0 {
            self.waits -= 1;
            if self.waits == 0 {
                self.compile(system);
            }
        }
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
        let (arguments, across) = ([self.base.as_slice(), &self.h], matrix.across());
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
