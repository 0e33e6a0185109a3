//! From expressions to straight-line programs with few operations.
//!
//! A kernel is rewritten in a few ways (as derived, collected by monomials, factored), each
//! candidate is lowered to n-ary sums and products, pairs that occur twice are shared over all
//! outputs of the kernel, and the cheapest candidate is kept. Everything is deterministic.

mod builder;
mod collect;
mod factor;
mod fold;
mod formula;
mod inverse;
mod linearise;
mod program;
mod reuse;
mod share;

pub use program::{Counts, Operation, Program, Value};

use crate::symbolic::{ExprId, Graph, Symbol};

/// Which symbols are known before the kernel runs, so that expressions in them are prepared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// Nothing but numbers: for what is prepared itself.
    Nothing,
    /// Parameters only: prepared once, at construction.
    Parameters,
    /// Parameters and the step size: prepared once per run.
    Step,
}

impl Known {
    /// Whether the symbol is known.
    pub fn covers(self, symbol: Symbol) -> bool {
        match symbol {
            Symbol::Parameter(_) => self != Known::Nothing,
            Symbol::Step => self == Known::Step,
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
    pub known: Known,
}

/// The cheapest straight-line program found for a task.
pub fn schedule(graph: &mut Graph, task: &Task) -> Program {
    let roots: Vec<ExprId> = task
        .definitions
        .iter()
        .map(|(_, e)| *e)
        .chain(task.outputs.iter().copied())
        .collect();
    let mut candidates = vec![roots.clone()];
    if let Some(collected) = collect::collect(graph, &roots, task.known) {
        candidates.push(collected);
    }
    let symbols: Vec<Symbol> = task.definitions.iter().map(|(s, _)| *s).collect();
    for index in 0..candidates.len() {
        if let Some(folded) = fold::fold(graph, &symbols, &candidates[index]) {
            candidates.push(folded);
        }
    }
    for index in 0..candidates.len() {
        if let Some(factored) = factor::factor(graph, &candidates[index], task.known) {
            candidates.push(factored);
        }
    }
    candidates.dedup();
    let mut budget = share::BUDGET;
    candidates
        .into_iter()
        .flat_map(|roots| [(roots.clone(), false), (roots, true)])
        .map(|(roots, group)| {
            let mut formula = formula::Formula::new(graph, &symbols, &roots, task.known, group);
            share::share(&mut formula, &mut budget);
            reuse::reuse(linearise::linearise(&formula))
        })
        .min_by_key(|program| program.counts.weight())
        .unwrap_or_default()
}

#[cfg(test)]
mod tests;
