//! Central extensions by a cocycle: `[e_i, e_j] = C_ij^k e_k - S_ij Z`, whose Lie–Poisson bracket is `-C_ij^k mu_k + S_ij` where the
//! coordinate of Z is 1.
//!
//! A cocycle `S_ij = C_ij^k s_k` is a coboundary: `mu - s` moves as without it, and where matrices `rho` represent the algebra,
//! `rho(e_i) + s_i rho(Z)` represent the extension, if `rho(Z)` annihilates all of them.

use super::poisson::Entry;
use crate::algebra::{Parametric, Representation, StructureConstants, TripleEntry};
use crate::model::{Algebra, Cocycle, Extension};
use lie_symbolic::exact::matrix::reduce;
use lie_symbolic::exact::{Budget, Fraction, Rational};
use lie_symbolic::symbolic::Graph;
use std::collections::BTreeMap;

/// Work allowed for the shift and the matrices.
const WORK: u64 = 50_000_000;

/// The extension of an algebra whose first elements, so many, are the declared ones, and one of whose others is central. `None` where
/// the cocycle is no rational function of the parameters.
pub fn extension(
    plain: &Algebra,
    cocycle: &[Entry],
    (own, unit): (usize, usize),
    graph: &mut Graph,
) -> Option<Algebra> {
    let entry = |entry: &Entry| Some((entry.row, entry.column, graph.fraction(entry.value, None)?));
    let cocycle: Vec<_> = cocycle.iter().map(entry).collect::<Option<_>>()?;
    let added = cocycle.iter().map(|(i, j, s)| (*i, *j, unit, s.neg()));
    let constants = plain.exact.entries().iter().cloned().chain(added);
    let exact = StructureConstants::new(plain.exact.dimension(), constants.collect());
    let budget = Budget::new(WORK);
    let cocycle = class(&plain.exact, &cocycle, own, &budget).unwrap_or(Cocycle::Undecided);
    let triple = |plain: &Option<Vec<TripleEntry>>| match &cocycle {
        Cocycle::Coboundary(shift) => extended(plain.clone()?, shift, unit, &budget),
        _ => None,
    };
    // the matrices may have parameters, and stay those of the declared algebra
    let representation = plain.representation.as_ref().and_then(|plain| {
        Some(Representation {
            triple: Some(triple(&plain.triple)?),
            dual: None,
            columns: None,
            ..plain.clone()
        })
    });
    let parametric = plain.parametric.as_deref().map(|plain| Parametric {
        triple: triple(&plain.triple),
        ..plain.clone()
    });
    Some(Algebra {
        basis: plain.basis.clone(),
        constants: exact.map(|value| graph.rational_function(value)),
        exact,
        representation,
        parametric: parametric.map(Box::new),
        extension: Some(Box::new(Extension {
            cocycle,
            unit,
            declared: plain.representation.clone(),
        })),
    })
}

/// Whether `S_ij = C_ij^k s_k` has a solution; `None` where that is not decided.
fn class(
    constants: &StructureConstants<Fraction>,
    cocycle: &[(usize, usize, Fraction)],
    own: usize,
    budget: &Budget,
) -> Option<Cocycle> {
    // the elements whose bracket is one of the equations, with its coefficients
    let mut rows: BTreeMap<(usize, usize), Vec<Rational>> = BTreeMap::new();
    for (i, j, k, value) in constants.entries() {
        if *j < own && *k < own {
            let row = rows.entry((*i, *j));
            row.or_insert_with(|| vec![Rational::ZERO; own])[*k] = value.as_constant()?;
        }
    }
    let pairs: Vec<(usize, usize)> = rows.keys().copied().collect();
    let place = |i: &usize, j: &usize| pairs.binary_search(&(*i, *j)).ok();
    let rows: Vec<Vec<Rational>> = rows.into_values().collect();
    // beside the equations stand their numbers, which tell what was made of them
    let equations = rows.len();
    let mut rows: Vec<Vec<Rational>> = rows;
    for (number, row) in rows.iter_mut().enumerate() {
        row.resize(own + equations, Rational::ZERO);
        row[own + number] = Rational::ONE;
    }
    let pivots = reduce(&mut rows, budget).ok()?;
    let mut right = vec![Fraction::from(Rational::ZERO); equations];
    for (i, j, value) in cocycle {
        let Some(place) = place(i, j) else {
            return Some(Cocycle::Proper);
        };
        right[place] = value.clone();
    }
    let mut shift = vec![Fraction::from(Rational::ZERO); own];
    for (row, pivot) in rows.iter().zip(pivots) {
        let mut sum = Fraction::from(Rational::ZERO);
        for (value, factor) in right.iter().zip(&row[own..]) {
            sum = sum.add(&value.scale(factor), budget).ok()?;
        }
        match shift.get_mut(pivot) {
            Some(shift) => *shift = sum,
            // a combination of equations that says 0 = sum
            None if sum.is_zero() => {}
            None => return Some(Cocycle::Proper),
        }
    }
    Some(Cocycle::Coboundary(shift))
}

/// The triple product of the extension, from that of the declared algebra.
fn extended(
    mut triple: Vec<TripleEntry>,
    shift: &[Fraction],
    unit: usize,
    budget: &Budget,
) -> Option<Vec<TripleEntry>> {
    // the product of three is T_abc^d (rho_d + s_d rho(Z)) - T_abc^d s_d rho(Z), since rho(Z) annihilates all
    let of_three = triple.chunk_by(|x, y| (x.0, x.1, x.2) == (y.0, y.1, y.2));
    let mut added = Vec::new();
    for entries in of_three {
        let mut sum = Fraction::from(Rational::ZERO);
        for (.., d, value) in entries {
            let Some(shift) = shift.get(*d) else { continue };
            let product = value.mul(shift, budget).ok()?;
            sum = sum.sub(&product, budget).ok()?;
        }
        if !sum.is_zero() {
            let (a, b, c, ..) = entries[0];
            added.push((a, b, c, unit, sum));
        }
    }
    triple.extend(added);
    triple.sort_by_key(|(a, b, c, d, _)| (*a, *b, *c, *d));
    Some(triple)
}
