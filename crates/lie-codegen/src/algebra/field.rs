//! Spans over the rationals, and over rational functions of exact parameters.
//!
//! What is independent over the rational functions is so for almost all values of the parameters, and coordinates that are rational
//! functions are right for each at which they are finite.

use std::collections::BTreeMap;

use super::ring::Ring;
use lie_symbolic::exact::span::{self, Span};
use lie_symbolic::exact::{Budget, Exhausted, Fraction, Rational};

/// Coefficients of which there are quotients.
pub trait Field: Ring {
    /// The span of vectors of such entries.
    type Span: Coordinates<Self>;

    /// The span of vectors of equal length.
    ///
    /// # Errors
    /// [`NoSpan`] where there is none.
    fn span(vectors: &[Vec<Self>], budget: &Budget) -> Result<Self::Span, NoSpan<Self>>;

    /// The value of a rational function, if it is one of the field.
    fn from_fraction(value: &Fraction) -> Option<Self>;
}

/// Coordinates in a span of vectors.
pub trait Coordinates<T> {
    /// The coordinates of a vector, `None` where it is outside the span.
    ///
    /// # Errors
    /// [`Exhausted`] where the budget is too small.
    fn coordinates(&self, vector: &[T], budget: &Budget) -> Result<Option<Vec<T>>, Exhausted>;
}

/// Why vectors have no span with coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum NoSpan<T> {
    /// The coefficients of a linear relation between them.
    Dependent(Vec<T>),
    /// The budget is too small.
    Exhausted,
}

impl<T> From<Exhausted> for NoSpan<T> {
    fn from(Exhausted: Exhausted) -> Self {
        Self::Exhausted
    }
}

impl Field for Rational {
    type Span = Span;

    fn span(vectors: &[Vec<Self>], budget: &Budget) -> Result<Span, NoSpan<Self>> {
        Span::new(vectors, budget).map_err(|none| match none {
            span::NoSpan::Dependent(relation) => NoSpan::Dependent(relation),
            span::NoSpan::Exhausted => NoSpan::Exhausted,
        })
    }

    fn from_fraction(value: &Fraction) -> Option<Self> {
        value.as_constant()
    }
}

impl Coordinates<Rational> for Span {
    fn coordinates(
        &self,
        vector: &[Rational],
        budget: &Budget,
    ) -> Result<Option<Vec<Rational>>, Exhausted> {
        Span::coordinates(self, vector, budget)
    }
}

impl Field for Fraction {
    type Span = FunctionSpan;

    fn span(vectors: &[Vec<Self>], budget: &Budget) -> Result<FunctionSpan, NoSpan<Self>> {
        FunctionSpan::new(vectors, budget)
    }

    fn from_fraction(value: &Fraction) -> Option<Self> {
        Some(value.clone())
    }
}

/// Entries that are not zero, by their place.
type Row = BTreeMap<usize, Fraction>;

/// The span of vectors of rational functions.
#[derive(Clone, Debug)]
pub struct FunctionSpan {
    vectors: Vec<Row>,
    /// Of each pivot its place, and the coefficients of the vectors in the combination that is 1 there and 0 at the other pivots.
    pivots: Vec<(usize, Row)>,
}

impl FunctionSpan {
    fn new(vectors: &[Vec<Fraction>], budget: &Budget) -> Result<Self, NoSpan<Fraction>> {
        let length = vectors.first().map_or(0, Vec::len);
        let vectors: Vec<Row> = vectors.iter().map(|vector| sparse(vector)).collect();
        // [V | 1] -> [R | T] with T V = R: a zero row of R shows a relation.
        let rows = vectors.iter().enumerate();
        let mut left: Vec<Row> = rows
            .map(|(i, row)| {
                let mut row = row.clone();
                row.insert(length + i, Rational::ONE.into());
                row
            })
            .collect();
        let mut done: Vec<(usize, Row)> = Vec::new();
        while !left.is_empty() {
            let Some((index, place)) = simplest(&left, length, budget)? else {
                let relation = left[0]
                    .range(length..)
                    .map(|(k, c)| (k - length, c.clone()));
                let mut coefficients = vec![Fraction::default(); vectors.len()];
                relation.for_each(|(k, c)| coefficients[k] = c);
                return Err(NoSpan::Dependent(coefficients));
            };
            let mut row = left.swap_remove(index);
            let inverse = row[&place].recip(budget)?.unwrap_or_default();
            for entry in row.values_mut() {
                *entry = entry.mul(&inverse, budget)?;
            }
            let others = done.iter_mut().map(|(_, other)| other);
            for other in others.chain(&mut left) {
                if let Some(factor) = other.get(&place).cloned() {
                    subtract(other, &factor, &row, budget)?;
                }
            }
            done.push((place, row));
        }
        let coefficients = |row: Row| row.into_iter().filter(|(k, _)| *k >= length);
        let pivots = done.into_iter().map(|(place, row)| {
            let row = coefficients(row).map(|(k, c)| (k - length, c));
            (place, row.collect())
        });
        Ok(Self {
            pivots: pivots.collect(),
            vectors,
        })
    }
}

impl Coordinates<Fraction> for FunctionSpan {
    fn coordinates(
        &self,
        vector: &[Fraction],
        budget: &Budget,
    ) -> Result<Option<Vec<Fraction>>, Exhausted> {
        let mut found = vec![Fraction::default(); self.vectors.len()];
        for (place, row) in self.pivots.iter().filter(|(p, _)| !vector[*p].is_zero()) {
            for (k, factor) in row {
                found[*k].add_product(&vector[*place], factor, budget)?;
            }
        }
        let mut rest = sparse(vector);
        for (coordinate, basis) in found.iter().zip(&self.vectors) {
            if !coordinate.is_zero() {
                subtract(&mut rest, coordinate, basis, budget)?;
            }
        }
        Ok(rest.is_empty().then_some(found))
    }
}

/// The simplest entry of some rows before a place, by row and place: a number where there is one, so that few quotients arise.
fn simplest(
    rows: &[Row],
    length: usize,
    budget: &Budget,
) -> Result<Option<(usize, usize)>, Exhausted> {
    let mut best: Option<((bool, usize, usize), usize, usize)> = None;
    for (index, row) in rows.iter().enumerate() {
        budget.spend(1 + row.len() as u64 / 16)?;
        for (place, entry) in row.range(..length) {
            let size = (entry.as_constant().is_none(), size(entry), row.len());
            if best.is_none_or(|(least, ..)| size < least) {
                best = Some((size, index, *place));
            }
        }
    }
    Ok(best.map(|(_, index, place)| (index, place)))
}

fn size(value: &Fraction) -> usize {
    value.numerator().terms().len() + value.denominator().count()
}

/// `row -= factor other`
fn subtract(
    row: &mut Row,
    factor: &Fraction,
    other: &Row,
    budget: &Budget,
) -> Result<(), Exhausted> {
    for (place, value) in other {
        let product = value.mul(factor, budget)?;
        let entry = row.entry(*place).or_default();
        *entry = entry.sub(&product, budget)?;
        if entry.is_zero() {
            row.remove(place);
        }
    }
    Ok(())
}

fn sparse(vector: &[Fraction]) -> Row {
    let entries = vector.iter().cloned().enumerate();
    entries.filter(|(_, value)| !value.is_zero()).collect()
}
