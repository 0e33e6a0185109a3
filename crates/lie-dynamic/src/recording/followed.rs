//! Steps that are run by traces, and what these carry from step to step.

use super::ready::run_of_step;
use super::trace::{REPORTED, Taken};
use super::traces::Traces;
use super::tree::Tree;
use crate::engine::{Chain, Machine, Separate, Stop};
use crate::system::Dynamic;
use lie_runtime::Scalar;
use lie_runtime::methods::StepReport;
use lie_runtime::scalar::{Mask, largest};
use std::ops::Range;
use std::sync::Arc;

/// For so many steps at most none is tried after several, one behind the other, that none was for.
const LONGEST_REST: u32 = 32;

/// The steps of a system by traces, and what these carry from step to step.
pub(super) struct Followed<'a, S: Scalar> {
    pub system: &'a Dynamic<S>,
    pub h: [S; 1],
    /// How many numbers a state has.
    size: usize,
    tree: Arc<Tree>,
    /// The parts of the tree, each added when it is reached; none where there are none.
    chain: Option<Box<dyn Chain<S>>>,
    /// Of each part that was added what computes its constants of the step size, if it has any.
    of_step: Vec<Option<Arc<dyn Machine<S>>>>,
    /// For how many steps none is tried after one that none was for, and how many of them are left.
    rest: u32,
    resting: u32,
    /// Whether the trace of the last step made iterations that it did not need.
    is_long: bool,
    /// The lane of the step that another trace would be for: the first that the last one was not for, or the one that took most.
    missed: usize,
    /// Steps that were made by traces.
    steps: u64,
    /// What the last trace gave and what the next one gives: a state, what the stepper of a method would remember, and a report.
    last: Vec<S>,
    results: Vec<S>,
}

impl<'a, S: Scalar> Followed<'a, S> {
    /// Of a stepper that remembers these numbers.
    pub fn new(system: &'a Dynamic<S>, h: S, memory: &[S]) -> Self {
        let size = system.values.compiled.plan.dimension();
        let mut last = vec![S::zero(); size + memory.len() + REPORTED];
        last[size..][..memory.len()].copy_from_slice(memory);
        Self {
            system,
            h: [h],
            size,
            tree: Arc::default(),
            chain: None,
            of_step: Vec::new(),
            rest: 0,
            resting: 0,
            is_long: false,
            missed: 0,
            steps: 0,
            results: last.clone(),
            last,
        }
    }

    /// Makes the steps to come of size h: what of a part depends on that alone is computed again.
    pub fn set_step(&mut self, h: S) {
        self.h = [h];
        let Some(chain) = &mut self.chain else {
            return;
        };
        for (part, machine) in self.of_step.iter().enumerate() {
            if let Some(machine) = machine {
                run_of_step(machine.as_ref(), self.system, h, chain.of_step(part));
            }
        }
    }

    fn places(&self) -> Range<usize> {
        self.size..self.last.len() - REPORTED
    }

    /// What the stepper of a method would remember.
    pub fn memory(&self) -> &[S] {
        &self.last[self.places()]
    }

    /// The same, to be written.
    pub fn memory_mut(&mut self) -> &mut [S] {
        let places = self.places();
        &mut self.last[places]
    }

    /// Takes those that have come since.
    pub fn take_from(&mut self, traces: &Traces) {
        let tree = traces.tree();
        if Arc::ptr_eq(&tree, &self.tree) {
            return;
        }
        let (parts, machine) = (tree.parts.len(), &self.system.values.machine);
        let apart =
            || -> Box<dyn Chain<S>> { Box::new(Separate::new(machine, parts, tree.between)) };
        let chain = machine.chain(parts, tree.between);
        self.chain = (parts > 0).then(|| chain.unwrap_or_else(apart));
        self.of_step = vec![None; parts];
        self.tree = tree;
        (self.rest, self.resting) = (0, 0);
    }

    /// The lane of the last step that another trace would be for.
    pub fn missed(&self) -> usize {
        self.missed
    }

    /// How many steps were made by traces.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Tries none for so many steps.
    pub fn rest(&mut self, steps: u32) {
        self.resting = steps;
    }

    /// Counts a step; whether none is tried.
    #[inline]
    pub fn rests(&mut self) -> bool {
        let rests = self.resting > 0;
        self.resting = self.resting.saturating_sub(1);
        rests
    }

    /// Makes a step by the trace that is for it, none if there is no such one. Where that is due `take` takes another one of the step.
    #[inline]
    pub fn step(
        &mut self,
        known: &Traces,
        mu: &mut [S],
        take: impl Fn(&Self, &[S]) -> Taken,
    ) -> Option<StepReport> {
        // steps are often like the last one
        if std::mem::take(&mut self.is_long) && known.is_due() {
            known.add(take(self, mu));
            self.take_from(known);
        }
        let made = self.follow(mu);
        if made.is_some() {
            self.rest = 0;
            self.steps += 1;
            return made;
        }
        if self.chain.is_some() {
            // one alone costs a part of a step
            self.resting = self.rest;
            self.rest = (2 * self.rest + 1).min(LONGEST_REST);
        } else if !known.is_open() {
            // there will be none
            self.resting = u32::MAX;
        }
        if known.is_due() {
            known.add(take(self, mu));
        }
        self.take_from(known);
        None
    }

    #[inline]
    fn follow(&mut self, mu: &mut [S]) -> Option<StepReport> {
        let places = self.places();
        let mut from = 0;
        let end = loop {
            let arguments = [&*mu, &self.last[places.clone()], &[], &[]];
            let frame = self.system.values.frame(arguments, &[], &self.h);
            let chain = self.chain.as_mut()?;
            match chain.follow(from, &frame, &mut self.results) {
                Stop::Done(part) => break part,
                Stop::Missed(_) => {
                    let expected = S::ratio(1.0, 2.0).less(chain.answers());
                    self.missed = (!expected).bits().trailing_zeros() as usize;
                    return None;
                }
                Stop::Unknown(part) => {
                    self.add(part)?;
                    from = part;
                }
            }
        };
        std::mem::swap(&mut self.last, &mut self.results);
        mu.copy_from_slice(&self.last[..mu.len()]);
        let most = &self.tree.parts[end].report;
        let report = reported(most, &self.last[places.end..]);
        self.is_long = report.iterations < most.iterations;
        if self.is_long {
            let fewer = self.last[places.end + 1];
            let of_lane = |lane: &usize| fewer.lane(*lane).to_f64();
            let lanes = 0..S::LANES;
            let slowest = lanes.min_by(|a, b| of_lane(a).total_cmp(&of_lane(b)));
            self.missed = slowest.unwrap_or(0);
        }
        Some(report)
    }

    /// Adds a part to the chain; none where the engine has no program for it.
    #[cold]
    fn add(&mut self, place: usize) -> Option<()> {
        let (part, engine) = (&self.tree.parts[place], &self.system.values.machine);
        let machine = match part.codes.of_step[0].stores.is_empty() {
            true => None,
            false => Some(engine.compile(&part.codes.of_step)?),
        };
        let chain = self.chain.as_mut()?;
        if !chain.add(place, &part.codes.body, part.next) {
            return None;
        }
        if let Some(machine) = &machine {
            let of_step = chain.of_step(place);
            run_of_step(machine.as_ref(), self.system, self.h[0], of_step);
        }
        self.of_step[place] = machine;
        Some(())
    }
}

/// The report of a step that gave these numbers, by a trace that made at most so much.
#[inline]
fn reported<S: Scalar>(most: &StepReport, numbers: &[S]) -> StepReport {
    // of the lane that misses least
    let fewer = |what: usize| (-largest(-numbers[what])) as u32;
    let (all, plain, factored) = (fewer(1), fewer(2), fewer(3));
    StepReport {
        residual: largest(numbers[0]),
        iterations: most.iterations.saturating_sub(all),
        evaluations: most.evaluations.saturating_sub(all),
        fixed_point: most.fixed_point.saturating_sub(plain),
        factorizations: most.factorizations.saturating_sub(factored),
        ..*most
    }
}
