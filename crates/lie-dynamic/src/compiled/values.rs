//! A plan whose parameters have values.

use crate::compiled::{Compiled, Kernels, StepConstants};
use crate::engine::{ARGUMENTS, Frame, Interpreter, Machine};
use lie_core::family::LateMatrix;
use lie_runtime::Scalar;
use std::sync::Arc;

/// The codes of a plan, with the values of its parameters and of the constants that depend on them.
pub(crate) struct Values<S> {
    pub compiled: Arc<Compiled>,
    pub machine: Arc<dyn Machine<S>>,
    pub parameters: Vec<S>,
    pub constants: Vec<S>,
    /// Of a family what has a value for each site.
    pub data: Arc<[Vec<S>]>,
    /// Whether programs of the whole are compiled at once, see [`Dynamic::without_patience`](crate::Dynamic::without_patience).
    pub hurry: bool,
}

impl<S: Clone> Clone for Values<S> {
    fn clone(&self) -> Self {
        Self {
            compiled: Arc::clone(&self.compiled),
            machine: Arc::clone(&self.machine),
            parameters: self.parameters.clone(),
            constants: self.constants.clone(),
            data: Arc::clone(&self.data),
            hurry: self.hurry,
        }
    }
}

impl<S: Scalar> Values<S> {
    #[inline]
    pub fn frame<'a>(
        &'a self,
        arguments: [&'a [S]; ARGUMENTS],
        of_step: &'a [S],
        scalars: &'a [S],
    ) -> Frame<'a, S> {
        let constants = [&self.constants, of_step, &self.parameters];
        Frame::new(arguments, constants, scalars)
    }

    pub fn run(&self, code: usize, frame: &Frame<'_, S>, targets: [&mut [S]; 2]) {
        self.machine.run(code, frame, targets);
    }

    /// Runs a kernel of one or two vectors.
    #[inline]
    pub fn call(&self, code: usize, arguments: [&[S]; 2], vector: &mut [S], matrix: &mut [S]) {
        let [a, b] = arguments;
        let frame = self.frame([a, b, &[], &[]], &[], &[]);
        self.machine.run(code, &frame, [vector, matrix]);
    }

    /// The matrix that a kernel of one or two vectors gives.
    #[inline]
    pub fn matrix(&self, code: usize, arguments: [&[S]; 2], out: &mut LateMatrix<S>) {
        self.call(code, arguments, &mut [], out.as_mut_slice());
    }

    /// The number that a kernel of one or two vectors gives.
    #[inline]
    pub fn number(&self, code: usize, arguments: [&[S]; 2]) -> S {
        let mut value = [S::zero()];
        self.call(code, arguments, &mut value, &mut []);
        value[0]
    }

    /// The value of a program without arguments.
    pub fn value(&self, code: usize) -> S {
        self.number(code, [&[], &[]])
    }

    /// The constants of a step size.
    pub fn step_constants(&self, step: &StepConstants, h: S) -> Vec<S> {
        let mut constants = vec![S::zero(); step.count];
        let scalars = [h];
        let frame = self.frame([&[]; ARGUMENTS], &[], &scalars);
        self.machine
            .run(step.constants, &frame, [&mut constants, &mut []]);
        constants
    }

    pub fn kernels(&self) -> &Kernels {
        &self.compiled.kernels
    }

    /// The interpreter of the codes. It is compiled for every scalar for which it is asked.
    pub fn interpreter<T: Scalar>(&self) -> Arc<dyn Machine<T>> {
        Arc::new(Interpreter::new(Arc::clone(&self.compiled.codes)))
    }

    /// The same as other scalars, by this machine.
    pub fn with_scalar<T: Scalar>(
        &self,
        constant: impl Fn(S) -> T,
        machine: Arc<dyn Machine<T>>,
    ) -> Values<T> {
        let all = |values: &[S]| values.iter().map(|value| constant(*value)).collect();
        Values {
            compiled: Arc::clone(&self.compiled),
            machine,
            parameters: all(&self.parameters),
            constants: all(&self.constants),
            data: self.data.iter().map(|values| all(values)).collect(),
            hurry: self.hurry,
        }
    }
}
