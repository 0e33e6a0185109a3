//! The traces of a method that there are by now, and when another one is taken.

use super::PATIENCE;
use super::record::LONGEST;
use super::trace::{Taken, Trace};
use super::tree::Tree;
use crate::system::Dynamic;
use lie_codegen::methods::Choice;
use lie_runtime::Scalar;
use lie_runtime::newton::NewtonOptions;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// More traces of a step are not taken.
const MOST: usize = 24;
/// A trace is taken after so many steps that none was for, at first; for each after it twice as many, up to so many times as many: they
/// cost as much as a few hundred steps kernel by kernel lose.
const FIRST: u32 = 16;
const LONGER: u32 = 16;
/// Where steps were too long so often, and programs are made quickly, one is tried once more, with so many instructions at most. Such a
/// trace takes the time of a few hundred steps, which is about how many were made by then. The assembler takes twice as many, as codes
/// have over two registers for each number.
const LONGEST_AT_LAST: usize = 100_000;
/// So many sets of options of a solver have traces: more are not kept for the life of a declaration.
const OPTIONS: usize = 16;
/// After so many that could not be written down no more are taken.
const REFUSALS: u32 = 3;

/// The traces of a method with some options of its solver.
#[derive(Debug)]
pub(crate) struct Traces {
    known: Mutex<Known>,
    waiting: Mutex<Waiting>,
    /// Whether more are taken.
    open: AtomicBool,
    /// Steps that were made by them.
    steps: AtomicU64,
}

/// Those there are, and the same as one tree.
#[derive(Debug, Default)]
struct Known {
    all: Vec<Arc<Trace>>,
    tree: Arc<Tree>,
}

/// When the next trace is taken.
#[derive(Debug)]
struct Waiting {
    /// Steps that none was for since the last one was taken, and how many are waited for.
    missed: u32,
    patience: u32,
    most_patience: u32,
    /// Those that could not be written down.
    refused: u32,
    /// How many instructions a trace may have, and at last.
    instructions: [usize; 2],
}

impl Waiting {
    /// Counts one that could not be written down; whether no more are taken.
    fn refused(&mut self) -> bool {
        self.refused += 1;
        self.refused >= REFUSALS
    }

    /// The same of one that had more than so many instructions. At last one may have more.
    fn too_long(&mut self, instructions: usize) -> bool {
        let [now, at_last] = self.instructions;
        // another thread has found out before
        if instructions < now || !self.refused() {
            return false;
        }
        let more = now < at_last;
        if more {
            self.instructions[0] = at_last;
            self.refused -= 1;
        }
        !more
    }
}

impl Traces {
    /// None yet; the first is waited for so many steps, and may have so many instructions at last.
    fn new((patience, instructions): (u32, usize)) -> Self {
        Self {
            known: Mutex::default(),
            waiting: Mutex::new(Waiting {
                missed: 0,
                patience,
                most_patience: LONGER * patience,
                refused: 0,
                instructions: [LONGEST, instructions],
            }),
            open: AtomicBool::new(true),
            steps: AtomicU64::new(0),
        }
    }

    fn known(&self) -> MutexGuard<'_, Known> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// All that there are by now.
    pub(super) fn tree(&self) -> Arc<Tree> {
        Arc::clone(&self.known().tree)
    }

    fn waiting(&self) -> MutexGuard<'_, Waiting> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.known().all.len()
    }

    /// Counts a step that none was for; whether one is to be taken.
    pub fn is_due(&self) -> bool {
        if !self.is_open() {
            return false;
        }
        let mut waiting = self.waiting();
        waiting.missed += 1;
        let due = waiting.missed > waiting.patience;
        if due {
            waiting.missed = 0;
            waiting.patience = (2 * waiting.patience).min(waiting.most_patience);
        }
        due
    }

    /// How many instructions the next one may have.
    pub fn instructions(&self) -> usize {
        self.waiting().instructions[0]
    }

    /// Adds one, if it is not there. After several that could not be written down no more are taken.
    pub fn add(&self, taken: Taken) {
        let full = match taken {
            Taken::Failed => false,
            Taken::TooLong(instructions) => self.waiting().too_long(instructions),
            Taken::Refused => self.waiting().refused(),
            Taken::Trace(trace) => self.grow(trace),
        };
        if full {
            self.open.store(false, Ordering::Relaxed);
        }
    }

    /// The tree with another trace, if it is not there; whether there are as many as there may be. The tree is made while others go on
    /// with the one before.
    fn grow(&self, trace: Box<Trace>) -> bool {
        let (mut all, mut before) = {
            let mut known = self.known();
            if known.all.iter().all(|other| trace.parts_from(other)) {
                known.all.push(Arc::from(trace));
            }
            (known.all.clone(), Arc::clone(&known.tree))
        };
        loop {
            let tree = Arc::new(Tree::new(&all, &before));
            let mut known = self.known();
            if known.all.len() == all.len() {
                known.tree = tree;
                return all.len() >= MOST;
            }
            // another one was added meanwhile
            (all, before) = (known.all.clone(), tree);
        }
    }

    /// Whether more are taken.
    pub fn is_open(&self) -> bool {
        self.open.load(Ordering::Relaxed)
    }

    /// Counts steps that were made by traces.
    pub fn count_steps(&self, steps: u64) {
        self.steps.fetch_add(steps, Ordering::Relaxed);
    }

    /// How many steps were made by traces, of steppers that are there no more.
    pub fn steps(&self) -> u64 {
        self.steps.load(Ordering::Relaxed)
    }
}

impl<S: Scalar> Dynamic<S> {
    /// The traces of a method.
    pub(super) fn traces(&self, choice: &Choice, newton: &NewtonOptions) -> Arc<Traces> {
        let wait = match self.compiles_at_once(None) {
            true => (FIRST, LONGEST_AT_LAST),
            false => (PATIENCE, LONGEST),
        };
        let all = &self.values.compiled.traces;
        // options have numbers, which are no keys
        let kind = (choice.clone(), S::LANES == 1);
        let key = (kind.clone(), format!("{newton:?}"));
        if all.cached(&key).is_none() && all.all_of(|(known, _)| *known == kind).len() >= OPTIONS {
            let none = Traces::new(wait);
            none.open.store(false, Ordering::Relaxed);
            return Arc::new(none);
        }
        let made = all.get(&key, || Some(Traces::new(wait)));
        made.unwrap_or_else(|| unreachable!("there are always some"))
    }
}
