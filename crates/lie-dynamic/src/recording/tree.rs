//! The traces of a step as one tree. What several have in common is one part; where answers differ each goes on by parts of its own, so
//! that a step makes no iterations that it does not need, and nothing twice.

use super::record::Guard;
use super::trace::Trace;
use crate::code::{Code, Register, Source};
use lie_runtime::methods::StepReport;
use std::collections::BTreeSet;
use std::sync::Arc;

/// The argument that has what parts have given to later ones.
const BETWEEN: u8 = 2;

/// Parts of steps, the first one first.
#[derive(Debug, Default)]
pub(super) struct Tree {
    pub parts: Vec<Part>,
    /// How many numbers the parts of a step give to later ones, at most.
    pub between: usize,
}

/// What some steps do between two things that are asked.
#[derive(Debug)]
pub(super) struct Part {
    /// The second computes, as a vector, what the parts after it need, or what the step gives; as a matrix whether all answers that
    /// are not told apart are the expected ones, and the one by which it goes on.
    pub codes: Arc<[Code]>,
    pub next: Next,
}

/// What comes after a part.
#[derive(Debug)]
pub(super) enum Next {
    /// Nothing: the step made so much, at most.
    End(StepReport),
    /// What was given stands from one of the numbers [between](Tree::between) parts on.
    Question {
        from: usize,
        /// Whether it is asked of every lane, or of any.
        every: bool,
        /// Where it goes on if the answer is no, and if it is yes.
        parts: [usize; 2],
    },
}

impl Tree {
    /// Of traces that part from one another, with the codes of a tree of some of them where they are the same.
    pub fn new(traces: &[Arc<Trace>], before: &Self) -> Self {
        let mut tree = Self::default();
        let all: Vec<&Trace> = traces.iter().map(Arc::as_ref).collect();
        tree.grow(&all, 0, &[], before);
        tree
    }

    /// Adds what these traces do from one of the things on that are asked, given numbers of parts before; its place.
    fn grow(
        &mut self,
        traces: &[&Trace],
        asked: usize,
        given: &[Register],
        before: &Self,
    ) -> usize {
        let [first, others @ ..] = traces else {
            unreachable!("every answer is that of a trace");
        };
        let place = self.parts.len();
        let parting = others.iter().filter_map(|other| first.parting(other)).min();
        let conditions = &first.guards[asked..parting.unwrap_or(first.guards.len())];
        let Some(parting) = parting else {
            self.push(first, conditions, given, (&first.gives, None), before);
            return place;
        };
        let question = first.guards[parting];
        let crossing = traces.iter().flat_map(|trace| trace.crossing(parting));
        let gives: BTreeSet<Register> = crossing.filter(|new| !given.contains(new)).collect();
        let gives: Vec<Register> = gives.into_iter().collect();
        self.push(first, conditions, given, (&gives, Some(question)), before);
        let all = [given, &gives].concat();
        self.between = self.between.max(all.len());
        let parts = [false, true].map(|answer| {
            let such = traces.iter().copied();
            let such: Vec<&Trace> = such
                .filter(|trace| trace.guards[parting].expected == answer)
                .collect();
            self.grow(&such, parting + 1, &all, before)
        });
        self.parts[place].next = Next::Question {
            from: given.len(),
            every: question.every,
            parts,
        };
        place
    }

    fn push(
        &mut self,
        trace: &Trace,
        conditions: &[Guard],
        given: &[Register],
        (gives, question): (&[Register], Option<Guard>),
        before: &Self,
    ) {
        let sources = (0..).zip(given);
        let sources = sources.map(|(place, number)| (*number, Source::Argument(BETWEEN, place)));
        let sources: Vec<(Register, Source)> = sources.collect();
        let conditions = conditions.iter().filter(|guard| guard.is_condition);
        let conditions: Vec<Guard> = conditions.copied().collect();
        let asked = question.map(|question| question.register);
        let codes = trace.written.part(&sources, gives, &conditions, asked);
        let mut known = before.parts.iter().map(|part| &part.codes);
        let known = known.find(|known| known[..] == codes).cloned();
        self.parts.push(Part {
            codes: known.unwrap_or_else(|| Arc::from(codes)),
            next: Next::End(trace.report),
        });
    }
}

impl Trace {
    /// The numbers that were there when something was asked, and are needed after it.
    fn crossing(&self, asked: usize) -> Vec<Register> {
        let later = &self.guards[asked + 1..];
        let later = later.iter().map(|guard| guard.register);
        let wanted: Vec<Register> = self.gives.iter().copied().chain(later).collect();
        self.written.crossing(self.guards[asked].at, &wanted)
    }
}
