//! Parts of a step, each a code, of which one goes on into another as values decide.

use super::layout::Lengths;
use super::machine::{ARGUMENTS, Frame, Machine};
use crate::code::Code;
use lie_runtime::Scalar;
use lie_runtime::scalar::Mask;
use std::sync::Arc;

/// The argument that has what parts have given to later ones.
pub const BETWEEN: usize = 2;

/// The slice that has constants of the step size.
pub const OF_STEP: usize = ARGUMENTS + 1;

/// What comes after a part of a step. Its code gives as a matrix 1 in the lanes that the part is for and 0 in others, and, where something
/// is asked, 1 where it holds and 0 elsewhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Next {
    /// Nothing: the vector that it gives is that of the step.
    End,
    /// Another part, by an answer. The vector is what later parts are given.
    Question {
        /// Where it stands among what parts give to later ones.
        from: usize,
        /// Whether it is asked of every lane, or of any.
        every: bool,
        /// Where it goes on if the answer is no, and if it is yes.
        parts: [usize; 2],
    },
}

impl Next {
    /// Compares it with what a chain has: so many parts, and so many numbers that are given to later ones.
    ///
    /// # Panics
    /// The chain has less.
    pub fn check(&self, parts: usize, between: usize) {
        if let Self::Question {
            from, parts: next, ..
        } = self
        {
            let known = next.iter().all(|next| *next < parts) && *from <= between;
            assert!(known, "a part goes on to one that is in the chain");
        }
    }
}

/// Where a step stopped, and at which part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// At its end.
    Done(usize),
    /// At a part that is not for all of these lanes; [`Chain::answers`] has those that it is for.
    Missed(usize),
    /// Before a part that was not added. Those before it are done, so that the step goes on from there.
    Unknown(usize),
}

/// Parts of a step that are run one after the other, in one call.
pub trait Chain<S> {
    /// Adds a part, whose code is the only one of these; whether the engine has a program for it. Where it has none the part is not there.
    ///
    /// # Panics
    /// The part goes on to one that the chain does not have, gives more to later ones than there are numbers for, reads what
    /// none before it gives, or gives another matrix than its answers.
    fn add(&mut self, part: usize, code: &Arc<[Code]>, next: Next) -> bool;

    /// What a part that was added reads as constants of the step size, to be written.
    fn of_step(&mut self, part: usize) -> &mut [S];

    /// Goes on from a part, to the end of the step or as far as there are parts. The constants of the step size, and what
    /// parts give to later ones, are not taken from the frame.
    ///
    /// # Panics
    /// A slice is shorter than a part needs.
    fn follow(&mut self, from: usize, frame: &Frame<'_, S>, to: &mut [S]) -> Stop;

    /// Whether the part at which a step stopped is for a lane: 1, or 0.
    fn answers(&self) -> S;
}

/// Parts that an engine runs by a call of each.
pub struct Separate<S> {
    engine: Arc<dyn Machine<S>>,
    parts: Vec<Option<Part<S>>>,
    between: Vec<S>,
    answers: [S; 2],
}

struct Part<S> {
    machine: Arc<dyn Machine<S>>,
    of_step: Vec<S>,
    next: Next,
}

impl<S: Scalar> Separate<S> {
    /// So many parts by an engine, none of them added, with so many numbers that are given to later ones.
    pub fn new(engine: &Arc<dyn Machine<S>>, parts: usize, between: usize) -> Self {
        Self {
            engine: Arc::clone(engine),
            parts: (0..parts).map(|_| None).collect(),
            between: vec![S::zero(); between],
            answers: [S::zero(); 2],
        }
    }
}

impl<S: Scalar> Chain<S> for Separate<S> {
    fn add(&mut self, part: usize, code: &Arc<[Code]>, next: Next) -> bool {
        next.check(self.parts.len(), self.between.len());
        let machine = self.engine.compile(code);
        self.parts[part] = machine.map(|machine| Part {
            machine,
            of_step: vec![S::zero(); Lengths::new(&code[0]).input(OF_STEP)],
            next,
        });
        self.parts[part].is_some()
    }

    fn of_step(&mut self, part: usize) -> &mut [S] {
        let part = self.parts[part].as_mut();
        part.map_or(&mut [], |part| &mut part.of_step)
    }

    fn follow(&mut self, from: usize, frame: &Frame<'_, S>, to: &mut [S]) -> Stop {
        let mut place = from;
        loop {
            let Some(part) = &self.parts[place] else {
                return Stop::Unknown(place);
            };
            let (before, to) = match part.next {
                Next::End => (&self.between[..], &mut *to),
                Next::Question { from, .. } => {
                    let (before, to) = self.between.split_at_mut(from);
                    (&*before, to)
                }
            };
            let frame = frame.with(BETWEEN, before).with(OF_STEP, &part.of_step);
            part.machine.run(0, &frame, [to, &mut self.answers]);
            let [expected, asked] = self.answers.map(|answer| S::ratio(1.0, 2.0).less(answer));
            if !expected.all() {
                return Stop::Missed(place);
            }
            match part.next {
                Next::End => return Stop::Done(place),
                Next::Question { every, parts, .. } => {
                    let is = if every { asked.all() } else { asked.any() };
                    place = parts[usize::from(is)];
                }
            }
        }
    }

    fn answers(&self) -> S {
        self.answers[0]
    }
}
