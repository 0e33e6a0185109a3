//! The span of vectors, and coordinates in it.

use super::elimination::{self, Row};
use super::matrix::{reduce, spend};
use super::{Budget, Exhausted, Rational, Residue};

/// The span of linearly independent vectors, ready to give coordinates in it.
#[derive(Clone, Debug)]
pub struct Span {
    vectors: Vec<Vec<(usize, Rational)>>,
    /// Entries that determine the coordinates.
    pivots: Vec<usize>,
    /// `coordinates = inverse * (entries at the pivots)`, sparse rows.
    inverse: Vec<Vec<(usize, Rational)>>,
    length: usize,
}

/// Why vectors have no [`Span`].
#[derive(Clone, Debug, PartialEq)]
pub enum NoSpan {
    /// The coefficients of a linear relation between them.
    Dependent(Vec<Rational>),
    /// The numbers become too long for the budget.
    Exhausted,
}

impl From<Exhausted> for NoSpan {
    fn from(Exhausted: Exhausted) -> Self {
        Self::Exhausted
    }
}

impl Span {
    /// The span of vectors of equal length.
    ///
    /// # Errors
    /// [`NoSpan`] where there is none.
    pub fn new(vectors: &[Vec<Rational>], budget: &Budget) -> Result<Self, NoSpan> {
        let (count, length) = (vectors.len(), vectors.first().map_or(0, Vec::len));
        let looked_at = independent_entries(vectors, budget)?;
        let looked_at = looked_at.unwrap_or_else(|| (0..length).collect());
        // [V | 1] -> [R | T] with T V = R: a zero row of R shows a relation.
        let unit = |i: usize, j: usize| Rational::from(i64::from(i == j));
        let rows = vectors.iter().enumerate().map(|(i, vector)| {
            let entries = looked_at.iter().map(|place| vector[*place].clone());
            entries.chain((0..count).map(|j| unit(i, j))).collect()
        });
        let mut rows: Vec<Vec<Rational>> = rows.collect();
        let width = looked_at.len();
        let mut pivots = reduce(&mut rows, budget)?;
        pivots.retain(|&p| p < width);
        if pivots.len() < count {
            return Err(NoSpan::Dependent(rows[pivots.len()][width..].to_vec()));
        }
        // A vector v = sum c_i V_i has the entries v[pivots] = c V[., pivots], and T V[., pivots] = 1,
        // hence c = v[pivots] T.
        let inverse = (0..count).map(|i| sparse(rows.iter().map(|row| &row[width + i])));
        Ok(Self {
            inverse: inverse.collect(),
            vectors: vectors.iter().map(|vector| sparse(vector.iter())).collect(),
            pivots: pivots.into_iter().map(|p| looked_at[p]).collect(),
            length,
        })
    }

    /// The coordinates of a vector, `None` where it is outside the span.
    ///
    /// # Errors
    /// [`Exhausted`] where the numbers become too long for the budget.
    pub fn coordinates(
        &self,
        vector: &[Rational],
        budget: &Budget,
    ) -> Result<Option<Vec<Rational>>, Exhausted> {
        let mut result = Vec::with_capacity(self.inverse.len());
        for row in &self.inverse {
            let mut sum = Rational::ZERO;
            for (i, factor) in row {
                let entry = &vector[self.pivots[*i]];
                if !entry.is_zero() {
                    sum = &sum + &(factor * entry);
                    spend(&sum, budget)?;
                }
            }
            result.push(sum);
        }
        let mut rest = vector.to_vec();
        debug_assert!(self.vectors.is_empty() || rest.len() == self.length);
        let combined = result.iter().zip(&self.vectors);
        for (coordinate, basis) in combined.filter(|(c, _)| !c.is_zero()) {
            for (i, value) in basis {
                rest[*i] = &rest[*i] - &(coordinate * value);
                spend(&rest[*i], budget)?;
            }
        }
        Ok(rest.iter().all(Rational::is_zero).then_some(result))
    }
}

/// As many entries as there are vectors, by which they are already independent; `None` where a prime field finds
/// none. What is independent modulo a prime is independent.
fn independent_entries(
    vectors: &[Vec<Rational>],
    budget: &Budget,
) -> Result<Option<Vec<usize>>, Exhausted> {
    let length = vectors.first().map_or(0, Vec::len);
    budget.spend((vectors.len() * vectors.len() * length / 16) as u64)?;
    let residues = |column: usize| {
        vectors
            .iter()
            .map(move |vector| Residue::from_rational(&vector[column]))
    };
    let columns: Option<Vec<Vec<Residue>>> = (0..length).map(|c| residues(c).collect()).collect();
    let Some(columns) = columns else {
        return Ok(None);
    };
    let found = elimination::rows(columns);
    let new = (0..length).filter(|&c| found[c] == Row::New);
    let new: Vec<usize> = new.collect();
    Ok((new.len() == vectors.len()).then_some(new))
}

/// The entries that are not zero.
fn sparse<'a>(row: impl Iterator<Item = &'a Rational>) -> Vec<(usize, Rational)> {
    let entries = row.enumerate().filter(|(_, v)| !v.is_zero());
    entries.map(|(i, v)| (i, v.clone())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(rows: &[&[i64]]) -> Vec<Vec<Rational>> {
        let row = |row: &&[i64]| row.iter().map(|&v| Rational::from(v)).collect();
        rows.iter().map(row).collect()
    }

    #[test]
    fn coordinates_in_a_span() {
        let budget = Budget::new(10_000);
        let vectors = matrix(&[&[0, 1, 2, 0], &[1, 1, 0, 3], &[0, 0, 1, 1]]);
        let span = Span::new(&vectors, &budget).unwrap();
        let inside = &matrix(&[&[2, -1, -4, 8]])[0];
        let c = span.coordinates(inside, &budget).unwrap().unwrap();
        assert_eq!(c, [-3, 2, 2].map(Rational::from));
        let outside = &matrix(&[&[2, -1, -4, 7]])[0];
        assert_eq!(span.coordinates(outside, &budget), Ok(None));
        let found = Span::new(&matrix(&[&[1, 2], &[2, 4]]), &budget);
        let Err(NoSpan::Dependent(relation)) = found else {
            panic!("{found:?}")
        };
        assert!(!relation.iter().all(Rational::is_zero));
        assert_eq!(
            &relation[0] + &(&relation[1] * &Rational::from(2)),
            Rational::ZERO
        );
        let none = Budget::new(1);
        assert_eq!(Span::new(&vectors, &none).err(), Some(NoSpan::Exhausted));
        assert_eq!(span.coordinates(inside, &none), Err(Exhausted));
    }
}
