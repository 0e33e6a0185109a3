//! What runs code, and what it runs on.

use crate::code::Code;
use lie_runtime::Scalar;
use smallvec::SmallVec;
use std::ops::Range;
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

    /// Runs a code at each place of columns: entry k of its first argument is `columns[k][place]`, and entry k of the vector that
    /// it writes goes to `to[k][place]`. Columns have as many places as the first of `to`. All else is as the frame says, of which
    /// the first argument is not read.
    ///
    /// # Panics
    /// A slice is shorter than the code needs, or a column than the first of `to`.
    fn along(&self, code: usize, columns: &[&[S]], frame: &Frame<'_, S>, to: &mut [&mut [S]])
    where
        S: Scalar,
    {
        let places = to.first().map_or(0, |to| to.len());
        place_by_place(0..places, columns, to, |at, out| {
            let [_, b, c, d] = frame.arguments;
            let frame = Frame {
                arguments: [at, b, c, d],
                ..*frame
            };
            self.run(code, &frame, [out, &mut []]);
        });
    }

    /// The same codes over the lanes of the scalar; none where there is nothing better than the interpreter.
    fn wide(&self) -> Option<Arc<dyn Machine<S::Wide>>>
    where
        S: Scalar,
    {
        None
    }
}

/// Runs something at some places of columns.
pub fn place_by_place<S: Scalar>(
    places: Range<usize>,
    columns: &[&[S]],
    to: &mut [&mut [S]],
    mut run: impl FnMut(&[S], &mut [S]),
) {
    let mut at: SmallVec<[S; 24]> = SmallVec::from_elem(S::zero(), columns.len());
    let mut out: SmallVec<[S; 24]> = SmallVec::from_elem(S::zero(), to.len());
    for place in places {
        at.iter_mut()
            .zip(columns)
            .for_each(|(x, column)| *x = column[place]);
        run(&at, &mut out);
        to.iter_mut().zip(&out).for_each(|(to, x)| to[place] = *x);
    }
}

/// Makes codes ready to run.
pub trait Engine {
    /// Its name.
    fn name(&self) -> &'static str;
    /// The codes, ready to run over double precision.
    fn machine(&self, codes: &Arc<[Code]>) -> Arc<dyn Machine<f64>>;
}
