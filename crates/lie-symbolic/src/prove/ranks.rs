//! Ranks of matrices of expressions: modulo a prime where they are rational functions, elsewhere by balls of 67 digits. A
//! pivot is a number that is certainly not zero, so that a rank is never too large; it is too small only where numbers
//! agree to all these digits.

use super::sample::Samples;
use super::{digits, residues};
use crate::exact::elimination::{self, Row};
use crate::exact::{Rational, matrix};
use crate::symbolic::{ExprId, Graph, Symbol};

/// Points of the prime field that are looked at.
const RESIDUES: usize = 2;
/// Points that are looked at by balls, and the products that all of them may take.
const POINTS: usize = 4;
const MOST_PRODUCTS: usize = 1 << 22;
/// Points that are tried where functions are not defined everywhere.
const TRIES: usize = 60;

/// The rank at generic points, up to `bound`; `None` where no point is in the domain. By a prime field where
/// the entries are rational functions, by elimination with balls elsewhere.
pub fn generic(graph: &Graph, rows: &[&Vec<ExprId>], bound: usize) -> Option<usize> {
    let found = at_generic_points(graph, rows, bound)?;
    Some(elimination::new_rows(&found).min(bound))
}

/// What each row adds to those before it at generic points, in the same way.
pub fn row_standings(graph: &Graph, rows: &[&Vec<ExprId>]) -> Option<Vec<Row>> {
    at_generic_points(graph, rows, rows.len())
}

/// The rows at the point where most of them are new.
fn at_generic_points(graph: &Graph, rows: &[&Vec<ExprId>], bound: usize) -> Option<Vec<Row>> {
    let entries: Vec<ExprId> = rows.iter().flat_map(|row| row.iter().copied()).collect();
    let columns = rows.first().map_or(0, |row| row.len()).max(1);
    let modulo = (0..RESIDUES).filter_map(|point| residues::at_point(graph, &entries, point));
    let samples = Samples::new().take(TRIES);
    let balls = samples.filter_map(|point| digits::at_sample(graph, &entries, point));
    let balls = balls.take(points(rows.len(), columns));
    elimination::most_new(modulo, columns, bound)
        .or_else(|| elimination::most_new(balls, columns, bound))
}

/// How many points are looked at by balls: fewer of large matrices, where one takes seconds.
fn points(rows: usize, columns: usize) -> usize {
    let products = rows * columns * rows.min(columns);
    (MOST_PRODUCTS / products.max(1)).clamp(1, POINTS)
}

/// The rank at a point, exactly; `None` where the values are not rational.
pub fn at_rationals(
    graph: &Graph,
    rows: &[&Vec<ExprId>],
    value: &dyn Fn(Symbol) -> Option<Rational>,
    bound: usize,
) -> Option<usize> {
    let entries: Vec<ExprId> = rows.iter().flat_map(|row| row.iter().copied()).collect();
    let columns = rows.first()?.len();
    let values = graph.evaluate_exactly(&entries, value)?;
    let rows: Vec<Vec<Rational>> = values.chunks(columns).map(<[Rational]>::to_vec).collect();
    Some(matrix::rank(&rows, bound.min(rows.len()).min(columns)))
}

/// The rank at a point in double precision, for the state where a run begins, which is given so; `None` where the values are not finite.
pub fn at_numbers(
    graph: &Graph,
    rows: &[&Vec<ExprId>],
    value: &dyn Fn(Symbol) -> f64,
) -> Option<usize> {
    let entries: Vec<ExprId> = rows.iter().flat_map(|row| row.iter().copied()).collect();
    let columns = rows.first()?.len();
    let values = graph.evaluate_all(&entries, value);
    let finite = values.iter().all(|v| v.is_finite());
    finite.then(|| numerical(values.chunks(columns).map(<[f64]>::to_vec).collect()))
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
