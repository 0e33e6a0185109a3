//! Functional independence: the gradients are linearly independent at generic points.

use super::ranks;
use crate::symbolic::{ExprId, Graph, Symbol};

/// What a function adds to those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// It is independent of those before it.
    Independent,
    /// It is a function of those before it.
    Dependent,
    /// It does not depend on the state at all.
    Constant,
}

/// Sorts out the functions that depend on earlier ones: their columns in the output and their
/// projections would say nothing new, and would make Jacobians singular.
pub fn check(graph: &Graph, functions: &[ExprId], dimension: usize) -> Vec<Standing> {
    let mut scratch = graph.clone();
    let gradients: Vec<Vec<ExprId>> = functions
        .iter()
        .map(|f| {
            (0..dimension)
                .map(|i| scratch.derivative(*f, Symbol::Coordinate(i)))
                .collect()
        })
        .collect();
    let all: Vec<&Vec<ExprId>> = gradients.iter().collect();
    if rank(&scratch, &all) == Some(functions.len()) {
        return vec![Standing::Independent; functions.len()];
    }
    let mut kept: Vec<usize> = Vec::new();
    let mut standings = Vec::new();
    for (index, gradient) in gradients.iter().enumerate() {
        let standing = if gradient.iter().all(|g| scratch.is_zero(*g))
            || rank(&scratch, &[gradient]) == Some(0)
        {
            Standing::Constant
        } else {
            let mut rows: Vec<&Vec<ExprId>> = kept.iter().map(|k| &gradients[*k]).collect();
            rows.push(gradient);
            // Where nothing can be evaluated, nothing speaks against it.
            match rank(&scratch, &rows) {
                Some(rank) if rank < rows.len() => Standing::Dependent,
                _ => Standing::Independent,
            }
        };
        if standing == Standing::Independent {
            kept.push(index);
        }
        standings.push(standing);
    }
    standings
}

fn rank(graph: &Graph, rows: &[&Vec<ExprId>]) -> Option<usize> {
    ranks::generic(graph, rows, rows.len())
}
