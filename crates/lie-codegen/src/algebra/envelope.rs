//! Dual matrices of a representation, for methods on `T*V` that are reduced to g*.
//!
//! Such a method forms words `T rho_k Q` in the matrices. They lie in the closure E of the span under
//! `(abc + cba)/2` and `ab - ba`. A matrix W determines the momentum `mu_k = tr(W rho_k)`, but the method
//! needs `tr(W e)` for all e in E. If E = rho(g) + Z, where every matrix of Z commutes with those of
//! rho(g), then `tr(W z) = 0` for all z is consistent with the motion, and mu determines the step: the
//! dual matrices D^k are those of E^T with `tr(D^k rho_l) = delta_kl` and `tr(D^k z) = 0`. On any other E the
//! step would depend on more than mu and leave the coadjoint orbit.

use super::sparse::SparseMatrix;
use lie_symbolic::exact::matrix::solve;
use lie_symbolic::exact::span::{NoSpan, Span};
use lie_symbolic::exact::{Budget, Exhausted, Rational};

/// Work allowed to leave columns out.
const WORK: u64 = 20_000_000;

/// Columns of the unit matrix from which a method on `T*V^r` may start, r as small as that allows, and beside them rows
/// whose matrix is dual.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Columns {
    /// Which columns, ascending.
    pub indices: Vec<usize>,
    /// `y_j^k` with `sum_j y_j^k e x_j` equal to 1 for the k-th matrix e and 0 for the others and what commutes with them:
    /// for each k the rows in the order of the columns.
    pub covectors: Vec<Vec<Vec<Rational>>>,
}

/// What a representation pairs with.
#[derive(Clone, Debug, PartialEq)]
pub struct Duals {
    /// The dual matrices by rows.
    pub matrices: Vec<Vec<Vec<Rational>>>,
    /// The same with few columns.
    pub columns: Columns,
}

/// The dual matrices, `None` where there are none; `closed` says that the span is closed under triple products.
pub(super) fn dual(
    matrices: &[SparseMatrix],
    closed: bool,
    budget: &Budget,
) -> Result<Option<Duals>, Exhausted> {
    let basis = if closed {
        matrices.to_vec()
    } else {
        match closure(matrices, budget)? {
            Some(basis) => basis,
            None => return Ok(None),
        }
    };
    let flat: Vec<Vec<Rational>> = basis.iter().map(SparseMatrix::flat).collect();
    let size = basis[0].rows().len();
    let Some(all) = paired(&flat, matrices.len(), size, budget)? else {
        return Ok(None);
    };
    // as many columns are left out as leave the matrices independent
    let mut kept = vec![true; size];
    let mut covectors = all.clone();
    let budget = &Budget::new(WORK);
    for column in (0..size).rev() {
        kept[column] = false;
        let restricted = flat.iter().map(|matrix| {
            let entries = matrix.iter().enumerate();
            let entries = entries.map(|(place, entry)| match kept[place % size] {
                true => entry.clone(),
                false => Rational::ZERO,
            });
            entries.collect()
        });
        let restricted: Vec<Vec<Rational>> = restricted.collect();
        match paired(&restricted, matrices.len(), size, budget) {
            Ok(Some(found)) => covectors = found,
            // more columns than are needed do as well
            Ok(None) | Err(Exhausted) => kept[column] = true,
        }
    }
    let indices: Vec<usize> = (0..size).filter(|&column| kept[column]).collect();
    for covector in &mut covectors {
        *covector = indices.iter().map(|&row| covector[row].clone()).collect();
    }
    Ok(Some(Duals {
        matrices: all,
        columns: Columns { indices, covectors },
    }))
}

/// The dual matrices of the first so many of some matrices, combinations of their transposes; `None` where they are dependent.
fn paired(
    flat: &[Vec<Rational>],
    count: usize,
    size: usize,
    budget: &Budget,
) -> Result<Option<Vec<Vec<Vec<Rational>>>>, Exhausted> {
    budget.spend((flat.len() * flat.len() * size * size) as u64)?;
    // D^k = sum_b c_b basis_b^T has tr(D^k basis_a) = sum_b c_b (basis_b . basis_a)
    let gram: Vec<Vec<Rational>> = flat
        .iter()
        .map(|a| flat.iter().map(|b| dot(a, b)).collect())
        .collect();
    // c is a row of the inverse, and the matrix is symmetric
    let inverse = match Span::new(&gram, budget) {
        Ok(inverse) => inverse,
        Err(NoSpan::Dependent(_)) => return Ok(None),
        Err(NoSpan::Exhausted) => return Err(Exhausted),
    };
    let mut duals = Vec::new();
    for k in 0..count {
        let unit = |a: usize| Rational::from(i64::from(a == k));
        let unit: Vec<Rational> = (0..flat.len()).map(unit).collect();
        let Some(coefficients) = inverse.coordinates(&unit, budget)? else {
            return Ok(None);
        };
        let mut rows = vec![vec![Rational::ZERO; size]; size];
        for (coefficient, matrix) in coefficients.iter().zip(flat) {
            for (position, entry) in matrix.iter().enumerate().filter(|(_, v)| !v.is_zero()) {
                let place = &mut rows[position % size][position / size];
                *place = &*place + &(coefficient * entry);
            }
        }
        duals.push(rows);
    }
    Ok(Some(duals))
}

/// The matrices, which must be independent, and a basis of Z; `None` where the closure has another form.
pub(super) fn closure(
    matrices: &[SparseMatrix],
    budget: &Budget,
) -> Result<Option<Vec<SparseMatrix>>, Exhausted> {
    let mut basis = matrices.to_vec();
    let mut known = 0;
    while known < basis.len() {
        let Some(mut span) = span(&basis, budget)? else {
            return Ok(None);
        };
        // triples in which something new takes part
        let (first, count) = (known, basis.len());
        known = count;
        for a in 0..count {
            for b in 0..count {
                for c in a..count {
                    if a.max(b).max(c) < first {
                        continue;
                    }
                    let left = SparseMatrix::product(&basis[a], &basis[b], budget)?;
                    let right = SparseMatrix::product(&basis[c], &basis[b], budget)?;
                    let sum = SparseMatrix::combine(
                        &[(&left, &basis[c], true), (&right, &basis[a], true)],
                        budget,
                    )?;
                    if !extend(&sum, matrices, &mut basis, &mut span, budget)? {
                        return Ok(None);
                    }
                }
            }
            for b in (a + 1..count).filter(|&b| b >= first) {
                let commutator = SparseMatrix::commutator(&basis[a], &basis[b], budget)?;
                if !extend(&commutator, matrices, &mut basis, &mut span, budget)? {
                    return Ok(None);
                }
            }
        }
    }
    Ok(Some(basis))
}

/// Adds what a matrix has beyond the span, if it commutes with the representation up to elements of it;
/// false where it does not.
fn extend(
    matrix: &SparseMatrix,
    matrices: &[SparseMatrix],
    basis: &mut Vec<SparseMatrix>,
    span: &mut Span,
    budget: &Budget,
) -> Result<bool, Exhausted> {
    let flat = matrix.flat();
    budget.spend(flat.len() as u64)?;
    if span.coordinates(&flat, budget)?.is_some() {
        return Ok(true);
    }
    // z = matrix - sum_i c_i rho_i with [z, rho_j] = 0 for all j
    let mut rows = Vec::new();
    let mut right = Vec::new();
    for other in matrices {
        let commutators: Vec<Vec<Rational>> = matrices
            .iter()
            .map(|rho| Ok(SparseMatrix::commutator(rho, other, budget)?.flat()))
            .collect::<Result<_, Exhausted>>()?;
        let target = SparseMatrix::commutator(matrix, other, budget)?.flat();
        for (position, value) in target.into_iter().enumerate() {
            let row: Vec<Rational> = commutators.iter().map(|c| c[position].clone()).collect();
            if !value.is_zero() || row.iter().any(|entry| !entry.is_zero()) {
                rows.push(row);
                right.push(value);
            }
        }
    }
    budget.spend((rows.len() * matrices.len() * matrices.len()) as u64)?;
    let coefficients = if rows.is_empty() {
        vec![Rational::ZERO; matrices.len()]
    } else {
        match solve(&rows, &right, budget)? {
            Some(coefficients) => coefficients,
            None => return Ok(false),
        }
    };
    let mut rest = flat;
    for (coefficient, rho) in coefficients.iter().zip(matrices) {
        for (position, entry) in rho.entries() {
            rest[position] = &rest[position] - &(coefficient * entry);
        }
    }
    let size = matrix.rows().len();
    let rows: Vec<Vec<Rational>> = rest.chunks(size).map(<[Rational]>::to_vec).collect();
    basis.push(SparseMatrix::from_rows(&rows));
    let larger = self::span(basis, budget)?;
    let found = larger.is_some();
    if let Some(larger) = larger {
        *span = larger;
    }
    Ok(found)
}

/// The span of matrices, `None` where they are dependent.
fn span(basis: &[SparseMatrix], budget: &Budget) -> Result<Option<Span>, Exhausted> {
    let flat: Vec<Vec<Rational>> = basis.iter().map(SparseMatrix::flat).collect();
    match Span::new(&flat, budget) {
        Ok(span) => Ok(Some(span)),
        Err(NoSpan::Dependent(_)) => Ok(None),
        Err(NoSpan::Exhausted) => Err(Exhausted),
    }
}

fn dot(a: &[Rational], b: &[Rational]) -> Rational {
    let mut sum = Rational::ZERO;
    for (x, y) in a.iter().zip(b) {
        if !x.is_zero() && !y.is_zero() {
            sum = &sum + &(x * y);
        }
    }
    sum
}
