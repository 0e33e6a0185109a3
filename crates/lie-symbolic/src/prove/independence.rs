//! Functional independence: the gradients are linearly independent at generic points.

use super::ranks;
use crate::exact::elimination::Row;
use crate::symbolic::{ExprId, Graph, Symbol};

/// Functions without a common domain that are compared with those before them.
const MOST_APART: usize = 16;

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
pub fn standings(graph: &Graph, functions: &[ExprId], dimension: usize) -> Vec<Standing> {
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
    let at_a_point = |rows: &[&Vec<ExprId>]| ranks::row_standings(&scratch, rows);
    let rows = at_a_point(&all).unwrap_or_else(|| {
        // No point is in the domain of all: each function with those before it that share a point with it.
        let mut kept: Vec<&Vec<ExprId>> = Vec::new();
        let apart = gradients.iter().map(|gradient| {
            kept.push(gradient);
            let last = |rows: &[&Vec<ExprId>]| at_a_point(rows)?.pop();
            let together = (kept.len() <= MOST_APART).then(|| last(&kept)).flatten();
            // Where nothing can be evaluated, nothing speaks against a function.
            let row = together.or_else(|| last(&[gradient])).unwrap_or(Row::New);
            if row != Row::New {
                kept.pop();
            }
            row
        });
        apart.collect()
    });
    let standings = rows.into_iter().map(|row| match row {
        Row::New => Standing::Independent,
        Row::Dependent => Standing::Dependent,
        Row::Zero => Standing::Constant,
    });
    standings.collect()
}
