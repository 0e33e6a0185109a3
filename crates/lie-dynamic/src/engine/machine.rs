//! What runs code, and what it runs on.

use super::chain::Chain;
use crate::code::Code;
use lie_runtime::Scalar;
use smallvec::SmallVec;
use std::ops::Range;
use std::sync::Arc;

/// More vector arguments a kernel does not have.
pub const ARGUMENTS: usize = 4;

/// So many numbers of a site and those around it need no memory from the heap: three coordinates of each of the thirteen sites that a sum
/// over bonds along three axes brings together, and some coefficients.
pub const AROUND: usize = 64;

/// The number of slices in a [`Frame`].
pub const SLICES: usize = ARGUMENTS + 4;

/// What code reads, in the order of [`Source::place`](crate::Source::place): the vector arguments, the constants of the system
/// and of the step size, the parameters, the step size with the time.
#[derive(Clone, Copy, Debug)]
pub struct Frame<'a, S>([&'a [S]; SLICES]);

impl<'a, S> Frame<'a, S> {
    /// Of these slices; what no code that it is for reads may be empty.
    #[inline]
    pub fn new(
        [a, b, c, d]: [&'a [S]; ARGUMENTS],
        [system, of_step, parameters]: [&'a [S]; 3],
        scalars: &'a [S],
    ) -> Self {
        Self([a, b, c, d, system, of_step, parameters, scalars])
    }

    /// All slices.
    #[inline]
    pub fn slices(&self) -> &[&'a [S]; SLICES] {
        &self.0
    }

    /// The same with another first argument.
    #[inline]
    #[must_use]
    pub fn with_first<'b>(&self, first: &'b [S]) -> Frame<'b, S>
    where
        'a: 'b,
    {
        self.with(0, first)
    }

    /// The same with another second argument.
    #[inline]
    #[must_use]
    pub fn with_second<'b>(&self, second: &'b [S]) -> Frame<'b, S>
    where
        'a: 'b,
    {
        self.with(1, second)
    }

    /// The same with another slice at a place.
    #[inline]
    pub(super) fn with<'b>(&self, place: usize, argument: &'b [S]) -> Frame<'b, S>
    where
        'a: 'b,
    {
        let mut slices: [&'b [S]; SLICES] = self.0;
        slices[place] = argument;
        Frame(slices)
    }
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
    fn run_columns(&self, code: usize, columns: &[&[S]], frame: &Frame<'_, S>, to: &mut [&mut [S]])
    where
        S: Scalar,
    {
        let places = to.first().map_or(0, |to| to.len());
        place_by_place(0..places, columns, to, |at, out| {
            self.run(code, &frame.with_first(at), [out, &mut []]);
        });
    }

    /// Runs a code so many times, each time with what it gave before as its second argument: from the first of these vectors to the
    /// second one, and back, in turn. The second argument of the frame is not read.
    ///
    /// # Panics
    /// A slice is shorter than the code needs.
    fn repeat(&self, code: usize, count: u32, frame: &Frame<'_, S>, vectors: [&mut [S]; 2]) {
        in_turns(count, vectors, |from, to| {
            self.run(code, &frame.with_second(from), [to, &mut []]);
        });
    }

    /// Whether [`Machine::compile`] takes so little time that nobody waits for it.
    fn compiles_quickly(&self) -> bool {
        false
    }

    /// Whether [`Machine::compile`] makes machines.
    fn compiles(&self) -> bool {
        false
    }

    /// Whether [`Machine::compile`] has made a machine for these codes.
    fn has_compiled(&self, _codes: &Arc<[Code]>) -> bool {
        false
    }

    /// A machine of the same engine for other codes, made once for each set of them; none where the engine cannot make one, or
    /// nothing better than the interpreter.
    fn compile(&self, _codes: &Arc<[Code]>) -> Option<Arc<dyn Machine<S>>> {
        None
    }

    /// So many parts of a step, none of them added yet, with so many numbers that are given to later ones; none where the engine has
    /// nothing better than a call of each.
    fn chain(&self, _parts: usize, _between: usize) -> Option<Box<dyn Chain<S>>> {
        None
    }

    /// The same codes over the lanes of the scalar; none where there is nothing better than the interpreter.
    fn wide(&self) -> Option<Arc<dyn Machine<S::Wide>>>
    where
        S: Scalar,
    {
        None
    }
}

/// Runs something so many times, from the first of two vectors to the second one, and back, in turn.
pub fn in_turns<S>(count: u32, [one, other]: [&mut [S]; 2], mut run: impl FnMut(&[S], &mut [S])) {
    for turn in 0..count {
        match turn % 2 {
            0 => run(one, other),
            _ => run(other, one),
        }
    }
}

/// Runs something at some places of columns.
pub fn place_by_place<S: Scalar>(
    places: Range<usize>,
    columns: &[&[S]],
    to: &mut [&mut [S]],
    mut run: impl FnMut(&[S], &mut [S]),
) {
    let mut at: SmallVec<[S; AROUND]> = SmallVec::from_elem(S::zero(), columns.len());
    let mut out: SmallVec<[S; AROUND]> = SmallVec::from_elem(S::zero(), to.len());
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
