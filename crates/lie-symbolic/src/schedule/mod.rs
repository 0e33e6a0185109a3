//! From expressions to straight-line programs with few operations.
//!
//! A kernel is rewritten in a few ways (`forms`: as derived, combined over common powers, collected by
//! monomials, factored). Each form is lowered to n-ary sums and products, pairs that occur twice are
//! shared over all outputs of the kernel, and differences are turned round where that saves a change of
//! sign (`signs`). A form has two costs: its operations, and the bound of its
//! rounding errors (`rounding`) at points where it matters (`points`). What errs more than the form that
//! was written is out (`judge`), and of the rest the cheapest is kept (`choice`). Everything is
//! deterministic.

mod builder;
mod choice;
mod collect;
mod combine;
mod factor;
mod fold;
mod forms;
mod formula;
mod inverse;
mod judge;
mod linearise;
mod points;
mod program;
mod reuse;
mod rounding;
mod share;
mod signs;

pub use program::{Counts, Operation, Program, Value};

use crate::symbolic::{ExprId, Graph, Symbol};
use choice::{Choice, LONGEST};
use collect::Collector;

/// Which symbols are known before the kernel runs, so that expressions in them are prepared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KnownSymbols {
    /// Nothing but numbers: for what is prepared itself.
    Nothing,
    /// Parameters only: prepared once, at construction.
    Parameters,
    /// Parameters and the step size: prepared once per run.
    Step,
}

impl KnownSymbols {
    /// Whether the symbol is known.
    pub fn covers(self, symbol: Symbol) -> bool {
        match symbol {
            Symbol::Parameter(_) => self != KnownSymbols::Nothing,
            Symbol::Step => self == KnownSymbols::Step,
            _ => false,
        }
    }
}

/// What is to be computed: definitions in order, each may use the earlier ones, then the outputs.
#[derive(Clone, Debug)]
pub struct Task {
    /// Intermediate quantities that stay opaque to rewriting, such as the midpoint of a step.
    pub definitions: Vec<(Symbol, ExprId)>,
    /// The results.
    pub outputs: Vec<ExprId>,
    /// What is known beforehand.
    pub known: KnownSymbols,
}

/// The cheapest straight-line program found for a task, among those that compute as well as the form in
/// which it was written.
pub fn schedule(graph: &mut Graph, task: &Task) -> Program {
    program(graph, &mut Collector::new(task.known), task)
}

fn program(graph: &mut Graph, collector: &mut Collector, task: &Task) -> Program {
    let definitions = task.definitions.iter().map(|(_, e)| *e);
    let roots: Vec<ExprId> = definitions.chain(task.outputs.iter().copied()).collect();
    let symbols: Vec<Symbol> = task.definitions.iter().map(|(s, _)| *s).collect();
    Choice::new(graph, collector, symbols).program(roots)
}

/// One program for two tasks, of which the first is computed by the same operations whether alone or beside
/// the second: alone it is a part of the whole, bit for bit.
pub fn schedule_beside(graph: &mut Graph, first: &Task, second: &Task) -> Program {
    let count = first.outputs.len();
    let mut both = first.clone();
    both.outputs.extend(&second.outputs);
    let collector = &mut Collector::new(first.known);
    let together = program(graph, collector, &both);
    // The other way would take as long again.
    if together.operations.len() > LONGEST {
        return together;
    }
    let alone = program(graph, collector, first);
    let part = together.part(0..count);
    if part.counts.weight() <= alone.counts.weight() {
        return together;
    }
    let rest = program(graph, collector, second);
    let apart = reuse::reuse(alone.clone().followed_by(&rest));
    let weight = |alone: &Program, whole: &Program| alone.counts.weight() + whole.counts.weight();
    if weight(&alone, &apart) < weight(&part, &together) {
        apart
    } else {
        together
    }
}

#[cfg(test)]
mod tests;
