//! The traces of a step as one tree. What several have in common is one part; where answers differ each goes on by parts of its own, so
//! that a step makes no iterations that it does not need, and nothing twice.

use super::record::Guard;
use super::trace::Trace;
use crate::code::{Code, Register, Source};
use crate::engine::{BETWEEN, Next};
use lie_runtime::methods::StepReport;
use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::Arc;

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
    /// What it does.
    pub codes: PartCodes,
    /// What comes after it.
    pub next: Next,
    /// What a step that ends here made, at most.
    pub report: StepReport,
    origin: Origin,
}

/// The codes of a part, each an engine's only one.
#[derive(Clone, Debug)]
pub(super) struct PartCodes {
    /// What depends on the step size alone.
    pub of_step: Arc<[Code]>,
    /// As a vector, what the parts after it need, or what the step gives; as a matrix whether all answers that are not told apart are the
    /// expected ones, and the one by which it goes on.
    pub body: Arc<[Code]>,
}

/// What a part is made of: the same has the same codes in every tree of these traces.
#[derive(Debug, PartialEq)]
struct Origin {
    /// The trace, by its number.
    trace: usize,
    /// What is asked of it within the part.
    asked: Range<usize>,
    /// What parts before give, and what this one gives to others, or as the end of the step.
    given: Vec<Register>,
    gives: Vec<Register>,
}

impl Tree {
    /// Of traces that part from one another, with the codes of a tree of the first of them where they are the same.
    pub fn new(traces: &[Arc<Trace>], before: &Self) -> Self {
        let mut tree = Self::default();
        let all: Vec<(usize, &Trace)> = traces.iter().map(Arc::as_ref).enumerate().collect();
        tree.grow(&all, 0, &[], before);
        tree
    }

    /// Adds what these traces do from one of the things on that are asked, given numbers of parts before; its place.
    fn grow(
        &mut self,
        traces: &[(usize, &Trace)],
        asked: usize,
        given: &[Register],
        before: &Self,
    ) -> usize {
        let [(number, first), others @ ..] = traces else {
            unreachable!("every answer is that of a trace");
        };
        let place = self.parts.len();
        let partings = others.iter().filter_map(|(_, other)| first.parting(other));
        let parting = partings.min();
        let mut origin = Origin {
            trace: *number,
            asked: asked..parting.unwrap_or(first.guards.len()),
            given: given.to_vec(),
            gives: first.gives.clone(),
        };
        let Some(parting) = parting else {
            self.push(first, origin, before);
            return place;
        };
        let crossing = traces.iter().flat_map(|(_, trace)| trace.crossing(parting));
        let gives: BTreeSet<Register> = crossing.copied().collect();
        let gives = gives.into_iter().filter(|new| !given.contains(new));
        origin.gives = gives.collect();
        let all = [given, &origin.gives].concat();
        self.push(first, origin, before);
        self.between = self.between.max(all.len());
        let parts = [false, true].map(|answer| {
            let such = traces.iter().copied();
            let such: Vec<(usize, &Trace)> = such
                .filter(|(_, trace)| trace.guards[parting].expected == answer)
                .collect();
            self.grow(&such, parting + 1, &all, before)
        });
        self.parts[place].next = Next::Question {
            from: given.len(),
            every: first.guards[parting].every,
            parts,
        };
        place
    }

    fn push(&mut self, trace: &Trace, origin: Origin, before: &Self) {
        let known = before.parts.iter().find(|part| part.origin == origin);
        let codes = match known {
            Some(known) => known.codes.clone(),
            None => trace.part(&origin),
        };
        self.parts.push(Part {
            codes,
            next: Next::End,
            report: trace.report,
            origin,
        });
    }
}

impl Trace {
    /// The codes of a part of it.
    fn part(&self, origin: &Origin) -> PartCodes {
        let sources = (0..).zip(&origin.given);
        let sources =
            sources.map(|(place, number)| (*number, Source::Argument(BETWEEN as u8, place)));
        let sources: Vec<(Register, Source)> = sources.collect();
        let conditions = self.guards[origin.asked.clone()].iter();
        let conditions = conditions.filter(|guard| guard.is_condition);
        let conditions: Vec<Guard> = conditions.copied().collect();
        let question = self.guards.get(origin.asked.end);
        let asked = question.map(|question| question.register);
        let written = &self.written;
        let codes = written.part(&sources, &origin.gives, &conditions, asked);
        let [of_step, body] = codes.map(|code| Arc::from([code]));
        PartCodes { of_step, body }
    }

    /// The numbers that were there when something was asked, and are needed after it.
    fn crossing(&self, asked: usize) -> &[Register] {
        self.crossings[asked].get_or_init(|| {
            let later = &self.guards[asked + 1..];
            let later = later.iter().map(|guard| guard.register);
            let wanted: Vec<Register> = self.gives.iter().copied().chain(later).collect();
            self.written.crossing(self.guards[asked].at, &wanted)
        })
    }
}
