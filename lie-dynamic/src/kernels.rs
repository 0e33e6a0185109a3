//! What runs code, and what it runs on.

use crate::code::Code;
use lie_runtime::Scalar;
use std::sync::Arc;

/// More vector arguments a kernel does not have.
pub const ARGUMENTS: usize = 4;

/// What code reads.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a, S> {
    /// The vector arguments.
    pub arguments: [&'a [S]; ARGUMENTS],
    /// The constants of the system.
    pub system: &'a [S],
    /// The constants of the step size.
    pub of_step: &'a [S],
    /// The parameters.
    pub parameters: &'a [S],
    /// The step size and the time.
    pub scalars: [S; 2],
}

/// What code writes: a number or vector, and a matrix row after row.
pub type Targets<'a, S> = [&'a mut [S]; 2];

/// Codes that can be run over a scalar.
pub trait Machine<S>: Send + Sync {
    /// Runs a code. Entries of the targets that it does not write are cleared where the code says so.
    ///
    /// # Panics
    /// A slice is shorter than the code needs.
    fn run(&self, code: usize, frame: &Frame<'_, S>, targets: Targets<'_, S>);

    /// The same codes over the lanes of the scalar; none where there is nothing better than the interpreter.
    fn wide(&self) -> Option<Arc<dyn Machine<S::Wide>>>
    where
        S: Scalar,
    {
        None
    }
}

/// Makes codes ready to run.
pub trait Engine {
    /// Its name.
    fn name(&self) -> &'static str;
    /// The codes, ready to run over double precision.
    fn machine(&self, codes: &Arc<[Code]>) -> Arc<dyn Machine<f64>>;
}
