//! Functional independence: the gradients are linearly independent at generic points.

use std::collections::HashMap;

use super::sample::{Sample, Samples};
use crate::exact::{Rational, matrix};
use crate::symbolic::{ExprId, Graph, Node, Symbol};

/// Points that are looked at.
const POINTS: usize = 4;
/// Points that are tried where functions are not defined everywhere.
const TRIES: usize = 60;
/// Longer numbers count as undefined.
const MAX_BITS: u64 = 1 << 16;

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

/// The greatest rank found, `None` where no point is in the domain.
fn rank(graph: &Graph, rows: &[&Vec<ExprId>]) -> Option<usize> {
    let entries: Vec<ExprId> = rows.iter().flat_map(|row| row.iter().copied()).collect();
    let columns = rows.first()?.len();
    let mut best = None;
    let mut evaluated = 0;
    for point in Samples::new().take(TRIES) {
        let found = match exact(graph, &entries, point) {
            Some(values) => {
                let rows: Vec<Vec<Rational>> =
                    values.chunks(columns).map(<[Rational]>::to_vec).collect();
                matrix::rank(&rows, rows.len().min(columns))
            }
            None => {
                let values = graph.evaluate_all(&entries, &|symbol| point.value(symbol));
                if values.iter().any(|v| !v.is_finite()) {
                    continue;
                }
                numerical(values.chunks(columns).map(<[f64]>::to_vec).collect())
            }
        };
        best = best.max(Some(found));
        evaluated += 1;
        if evaluated == POINTS || found == rows.len() {
            break;
        }
    }
    best
}

/// The values at an integer point, `None` where they are not rational.
fn exact(graph: &Graph, roots: &[ExprId], point: Sample) -> Option<Vec<Rational>> {
    let mut values: HashMap<ExprId, Rational> = HashMap::new();
    for id in graph.dependencies(roots) {
        let value = match graph.node(id) {
            Node::Number(value) => value.clone(),
            Node::Symbol(symbol) => point.integer(*symbol),
            Node::Sum { constant, terms } => {
                terms.iter().fold(constant.clone(), |sum, (term, c)| {
                    &sum + &(c * &values[term])
                })
            }
            Node::Product(factors) => {
                let mut product = Rational::ONE;
                for (base, exponent) in factors {
                    let exponent = i32::try_from(exponent.to_integer()?).ok()?;
                    let base = &values[base];
                    if base.bits().saturating_mul(exponent.unsigned_abs().into()) > MAX_BITS {
                        return None;
                    }
                    product = &product * &base.pow(exponent)?;
                }
                product
            }
            Node::Pi | Node::Call(..) => return None,
        };
        if value.bits() > MAX_BITS {
            return None;
        }
        values.insert(id, value);
    }
    Some(roots.iter().map(|root| values[root].clone()).collect())
}

/// The rank by elimination with full pivoting, rows scaled to one.
fn numerical(mut rows: Vec<Vec<f64>>) -> usize {
    for row in &mut rows {
        let scale = row.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        if scale > 0.0 {
            row.iter_mut().for_each(|v| *v /= scale);
        }
    }
    let columns = rows.first().map_or(0, Vec::len);
    let mut rank = 0;
    while rank < rows.len() {
        let mut best = (0.0, rank, 0);
        for (r, row) in rows.iter().enumerate().skip(rank) {
            for (c, value) in row.iter().enumerate() {
                if value.abs() > best.0 {
                    best = (value.abs(), r, c);
                }
            }
        }
        let (size, row, column) = best;
        if size < 1e-9 {
            break;
        }
        rows.swap(rank, row);
        let pivot = rows[rank].clone();
        for other in &mut rows[rank + 1..] {
            let factor = other[column] / pivot[column];
            for c in 0..columns {
                other[c] -= factor * pivot[c];
            }
            other[column] = 0.0;
        }
        rank += 1;
    }
    rank
}
