//! A free rigid body in other axes than those of its moments.
//!
//! Its matrix of second moments J is symmetric, and the momentum of an angular velocity W is `M = J W + W J`. So H'' takes the momentum of each
//! basis element back to that element, which is linear in the entries of J.

use super::Body;
use crate::structure::casimirs::WORK;
use crate::structure::casimirs::solve::{Functions, Sparse, kernel};
use lie_symbolic::exact::{Budget, Fraction, Rational};
use lie_symbolic::symbolic::{ExprId, Graph};

/// The body of so(n) in a basis of these planes with this H'', if it is one.
pub(super) fn body(
    graph: &mut Graph,
    planes: &[(usize, usize)],
    form: &[Vec<ExprId>],
) -> Option<Body> {
    let size = planes.iter().map(|(i, j)| 1 + i.max(j)).max()?;
    let entries: Vec<(usize, usize)> = (0..size)
        .flat_map(|i| (i..size).map(move |j| (i, j)))
        .collect();
    let place = |i: usize, j: usize| {
        let pair = (i.min(j), i.max(j));
        entries.iter().position(|entry| *entry == pair)
    };
    let hessian: Vec<Vec<Fraction>> = form
        .iter()
        .map(|row| {
            row.iter()
                .map(|entry| graph.fraction(*entry, None))
                .collect()
        })
        .collect::<Option<_>>()?;
    // the momentum of a basis element along another: entries of J, with their signs
    let momentum = |turned: (usize, usize), plane: (usize, usize)| {
        let ((from, to), (column, row)) = (turned, plane);
        let parts = [
            (column == from, row, to, false),
            (column == to, row, from, true),
            (row == to, from, column, false),
            (row == from, to, column, true),
        ];
        let parts = parts.into_iter().filter(|(there, ..)| *there);
        parts.filter_map(|(_, i, j, negative)| Some((place(i, j)?, negative)))
    };
    let budget = Budget::new(WORK);
    let field = Functions { budget: &budget };
    let mut rows: Vec<Sparse<Fraction>> = Vec::new();
    for (a, turned) in planes.iter().enumerate() {
        for (c, row) in hessian.iter().enumerate() {
            let mut sums = vec![Fraction::from(Rational::ZERO); entries.len() + 1];
            for (factor, plane) in row.iter().zip(planes) {
                for (place, negative) in momentum(*turned, *plane) {
                    let part = if negative {
                        factor.neg()
                    } else {
                        factor.clone()
                    };
                    sums[place] = sums[place].add(&part, &budget).ok()?;
                }
            }
            if a == c {
                sums[entries.len()] = Fraction::from(Rational::MINUS_ONE);
            }
            let filled = sums.into_iter().enumerate();
            rows.push(filled.filter(|(_, value)| !value.is_zero()).collect());
        }
    }
    let (vectors, _) = kernel(&field, entries.len() + 1, rows.into_iter()).ok()?;
    // one solution, whose last entry is one
    let [solution] = &vectors[..] else {
        return None;
    };
    if solution
        .last()
        .is_none_or(|(place, _)| *place < entries.len())
    {
        return None;
    }
    let mut value = |entry: (usize, usize)| {
        let place = place(entry.0, entry.1)?;
        let known = solution.iter().find(|(known, _)| *known == place);
        known.map(|(_, value)| graph.rational_function(value))
    };
    let off = entries.iter().filter(|(i, j)| i < j);
    let products = off.filter_map(|entry| Some((*entry, value(*entry)?)));
    let products = products.collect();
    let moments: Vec<Option<ExprId>> = (0..size).map(|i| value((i, i))).collect();
    let zero = graph.integer(0);
    Some(Body::Many {
        planes: planes.to_vec(),
        moments: moments
            .into_iter()
            .map(|moment| moment.unwrap_or(zero))
            .collect(),
        products,
    })
}
