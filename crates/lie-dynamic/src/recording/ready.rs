//! Programs of a step, ready to run with a step size.

use crate::code::Code;
use crate::engine::{ARGUMENTS, Interpreter, Machine};
use crate::system::Dynamic;
use lie_runtime::Scalar;
use std::sync::Arc;

/// Two codes that are ready to run, with the results of the first.
pub(super) struct Ready<S> {
    pub machine: Arc<dyn Machine<S>>,
    pub of_step: Vec<S>,
}

impl<S: Scalar> Ready<S> {
    /// By the engine of a system, or by the interpreter where that is asked for; none where the engine makes no machine.
    pub fn new(system: &Dynamic<S>, codes: &Arc<[Code]>, h: S, interpret: bool) -> Option<Self> {
        let interpreter =
            || -> Arc<dyn Machine<S>> { Arc::new(Interpreter::new(Arc::clone(codes))) };
        let machine = system.values.machine.compile(codes);
        let machine = machine.or_else(|| interpret.then(interpreter))?;
        let of_step = vec![S::zero(); codes[0].stores.len()];
        let mut ready = Self { machine, of_step };
        ready.set_step(system, h);
        Some(ready)
    }

    /// Computes the results of the first code, which reads the step size.
    pub fn set_step(&mut self, system: &Dynamic<S>, h: S) {
        run_of_step(self.machine.as_ref(), system, h, &mut self.of_step);
    }
}

/// Runs the first code of a machine, which reads the step size and gives constants of it; where it gives any.
pub(super) fn run_of_step<S: Scalar>(
    machine: &dyn Machine<S>,
    system: &Dynamic<S>,
    h: S,
    to: &mut [S],
) {
    if !to.is_empty() {
        let scalars = [h];
        let frame = system.values.frame([&[]; ARGUMENTS], &[], &scalars);
        machine.run(0, &frame, [to, &mut []]);
    }
}
