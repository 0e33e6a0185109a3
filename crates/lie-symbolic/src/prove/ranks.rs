//! Ranks of matrices of expressions: modulo a prime where they are rational functions, elsewhere by balls of 67 digits. A
//! pivot is a number that is certainly not zero, so that a rank is never too large; it is too small only where numbers
//! agree to all these digits.

use std::collections::HashMap;

use super::sample::{Sample, Samples};
use super::{confirmation, residues};
use crate::exact::elimination::{self, Field, Row};
use crate::exact::{Ball, Rational, matrix};
use crate::symbolic::{ExprId, Graph, Node, Symbol};

/// Points of the prime field that are looked at.
const RESIDUES: usize = 2;
/// Points that are looked at by balls, and the products that all of them may take.
const POINTS: usize = 4;
const MOST_PRODUCTS: usize = 1 << 22;
/// Points that are tried where functions are not defined everywhere.
const TRIES: usize = 60;
/// Longer numbers count as undefined.
const MAX_BITS: u64 = 1 << 16;

/// The rank at generic points, up to `bound`; `None` where no point is in the domain. By a prime field where
/// the entries are rational functions, by elimination with balls elsewhere.
pub fn generic(graph: &Graph, rows: &[&Vec<ExprId>], bound: usize) -> Option<usize> {
    let found = at_generic_points(graph, rows, bound)?;
    Some(new(&found).min(bound))
}

/// What each row adds to those before it at generic points, in the same way.
pub fn standings(graph: &Graph, rows: &[&Vec<ExprId>]) -> Option<Vec<Row>> {
    at_generic_points(graph, rows, rows.len())
}

/// The rows at the point where most of them are new.
fn at_generic_points(graph: &Graph, rows: &[&Vec<ExprId>], bound: usize) -> Option<Vec<Row>> {
    let entries: Vec<ExprId> = rows.iter().flat_map(|row| row.iter().copied()).collect();
    let columns = rows.first().map_or(0, |row| row.len()).max(1);
    let modulo = (0..RESIDUES).filter_map(|point| {
        let values = residues::at_point(graph, &entries, point)?;
        Some(elimination::rows(values.chunks(columns).map(<[_]>::to_vec)))
    });
    let balls = Samples::new().take(TRIES).filter_map(|point| {
        let values = at_balls(graph, &entries, point)?;
        Some(elimination::rows(values.chunks(columns).map(<[_]>::to_vec)))
    });
    best(modulo, RESIDUES, bound).or_else(|| best(balls, points(rows.len(), columns), bound))
}

/// The first of some with the most new rows, and none is looked at behind one with as many as there can be.
fn best(all: impl Iterator<Item = Vec<Row>>, count: usize, bound: usize) -> Option<Vec<Row>> {
    let mut best: Option<Vec<Row>> = None;
    for found in all.take(count) {
        if best.as_ref().is_none_or(|best| new(best) < new(&found)) {
            best = Some(found);
        }
        if best.as_ref().is_some_and(|best| new(best) >= bound) {
            break;
        }
    }
    best
}

fn new(rows: &[Row]) -> usize {
    rows.iter().filter(|row| **row == Row::New).count()
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
    let values = exact(graph, &entries, value)?;
    let rows: Vec<Vec<Rational>> = values.chunks(columns).map(<[Rational]>::to_vec).collect();
    Some(matrix::rank(&rows, bound.min(rows.len()).min(columns)))
}

/// The values at a sample point; `None` where something is not defined.
fn at_balls(graph: &Graph, entries: &[ExprId], point: Sample) -> Option<Vec<Digits>> {
    let values = confirmation::values(graph, entries, &|symbol| {
        let (numerator, exponent) = point.dyadic(graph, symbol);
        Some(Ball::dyadic(numerator, exponent))
    })?;
    Some(values.into_iter().map(Digits).collect())
}

/// A number by its first 67 digits.
#[derive(Clone)]
struct Digits(Ball);

impl Field for Digits {
    fn is_nonzero(&self) -> bool {
        self.0.excludes_zero()
    }
    fn is_zero(&self) -> bool {
        self.0.is_zero()
    }
    fn size(&self) -> i64 {
        self.0.magnitude()
    }
    fn inverse(&self) -> Option<Self> {
        self.0.recip(confirmation::precision()).map(Self)
    }
    fn times(&self, other: &Self) -> Self {
        Self(self.0.mul(&other.0, confirmation::precision()))
    }
    fn minus(&self, other: &Self) -> Self {
        Self(self.0.sub(&other.0, confirmation::precision()))
    }
    fn zero() -> Self {
        Self(Ball::integer(0))
    }
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
pub fn exact(
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
