//! Jordan-triple closure `(rho_a rho_b rho_c + rho_c rho_b rho_a)/2 = T_abc^d rho_d`: where it
//! holds, the Cayley retraction has a polynomial form in coordinates.

use super::field::{Coordinates, Field};
use super::representation::TripleEntry;
use super::sparse::SparseMatrix;
use lie_symbolic::exact::{Budget, Exhausted, Rational};

/// The triple product of the matrices, `None` where their span is not closed under it.
pub(super) fn closure<T: Field>(
    matrices: &[SparseMatrix<T>],
    span: &T::Span,
    budget: &Budget,
) -> Result<Option<Vec<TripleEntry>>, Exhausted> {
    let n = matrices.len();
    let half = &Rational::ONE / &Rational::from(2);
    let mut entries = Vec::new();
    for b in 0..n {
        // rho_b rho_c is needed for every a.
        let right: Vec<SparseMatrix<T>> = matrices
            .iter()
            .map(|c| SparseMatrix::product(&matrices[b], c, budget))
            .collect::<Result<_, _>>()?;
        for a in 0..n {
            for c in a..n {
                let both = [
                    (&matrices[a], &right[c], true),
                    (&matrices[c], &right[a], true),
                ];
                let sum = SparseMatrix::combine(&both, budget)?.flat();
                budget.spend(sum.len() as u64)?;
                let Some(coordinates) = span.coordinates(&sum, budget)? else {
                    return Ok(None);
                };
                for (d, value) in coordinates.iter().enumerate().filter(|(_, v)| !v.is_zero()) {
                    let value = value.to_fraction().scale(&half);
                    if a != c {
                        entries.push((c, b, a, d, value.clone()));
                    }
                    entries.push((a, b, c, d, value));
                }
            }
        }
    }
    entries.sort_by_key(|&(a, b, c, d, _)| (a, b, c, d));
    Ok(Some(entries))
}
