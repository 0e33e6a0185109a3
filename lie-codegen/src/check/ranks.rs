//! Ranks of matrices of expressions: at rational points where that is possible, elsewhere by balls of 67 digits. A
//! pivot is a ball that excludes zero, so that a rank is never too large; it is too small only where numbers
//! agree to all these digits.

use std::collections::HashMap;

use super::confirmation;
use super::sample::{Sample, Samples};
use crate::exact::{Ball, Rational, matrix};
use crate::symbolic::{ExprId, Graph, Node, Symbol};

/// Points that are looked at.
const POINTS: usize = 4;
/// Points that are tried where functions are not defined everywhere.
const TRIES: usize = 60;
/// Longer numbers count as undefined.
const MAX_BITS: u64 = 1 << 16;

/// The greatest rank found at generic points, up to `bound`; `None` where no point is in the domain. Exact
/// where the entries are rational functions, by elimination with balls elsewhere.
pub fn generic(graph: &Graph, rows: &[&Vec<ExprId>], bound: usize) -> Option<usize> {
    let mut best = None;
    let mut evaluated = 0;
    for point in Samples::new().take(TRIES) {
        let integer = |symbol| Some(point.integer(graph, symbol));
        let found = match at_rationals(graph, rows, &integer, bound) {
            Some(rank) => rank,
            None => match at_balls(graph, rows, point) {
                Some(rank) => rank.min(bound),
                None => continue,
            },
        };
        best = best.max(Some(found));
        evaluated += 1;
        if evaluated == POINTS || found == bound {
            break;
        }
    }
    best
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
    let values = exact(graph, &entries, value)?;
    let rows: Vec<Vec<Rational>> = values.chunks(columns).map(<[Rational]>::to_vec).collect();
    Some(matrix::rank(&rows, bound.min(rows.len()).min(columns)))
}

/// The rank at a sample point; `None` where something is not defined.
fn at_balls(graph: &Graph, rows: &[&Vec<ExprId>], point: Sample) -> Option<usize> {
    let entries: Vec<ExprId> = rows.iter().flat_map(|row| row.iter().copied()).collect();
    let columns = rows.first()?.len();
    let values = confirmation::values(graph, &entries, &|symbol| {
        let (numerator, exponent) = point.dyadic(graph, symbol);
        Some(Ball::dyadic(numerator, exponent))
    })?;
    let mut rows: Vec<Vec<Ball>> = values
        .chunks(columns.max(1))
        .map(<[Ball]>::to_vec)
        .collect();
    let precision = confirmation::precision();
    let mut rank = 0;
    while rank < rows.len() {
        let places = (rank..rows.len()).flat_map(|r| (0..columns).map(move |c| (r, c)));
        let pivots = places.filter(|&(r, c)| rows[r][c].excludes_zero());
        let Some((row, column)) = pivots.max_by_key(|&(r, c)| rows[r][c].magnitude()) else {
            break;
        };
        rows.swap(rank, row);
        let pivot = rows[rank].clone();
        let inverse = pivot[column].recip(precision)?;
        for other in &mut rows[rank + 1..] {
            let factor = other[column].mul(&inverse, precision);
            for c in 0..columns {
                other[c] = other[c].sub(&factor.mul(&pivot[c], precision), precision);
            }
            other[column] = Ball::integer(0);
        }
        rank += 1;
    }
    Some(rank)
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

/// The values at a point, `None` where they are not rational.
pub(super) fn exact(
    graph: &Graph,
    roots: &[ExprId],
    value: &dyn Fn(Symbol) -> Option<Rational>,
) -> Option<Vec<Rational>> {
    let mut values: HashMap<ExprId, Rational> = HashMap::new();
    for id in graph.dependencies(roots) {
        let value = match graph.node(id) {
            Node::Number(value) => value.clone(),
            Node::Symbol(symbol) => value(*symbol)?,
            Node::Sum { constant, terms } => {
                terms.iter().fold(constant.clone(), |sum, (term, c)| {
                    &sum + &(c * &values[term])
                })
            }
            Node::Written(terms) => terms
                .iter()
                .fold(Rational::ZERO, |sum, (term, c)| &sum + &(c * &values[term])),
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
