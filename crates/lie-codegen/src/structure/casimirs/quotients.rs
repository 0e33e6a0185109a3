//! Rational Casimirs: products of powers of semi-invariants.
//!
//! A semi-invariant is a polynomial F with `X_i F = chi_i F`. Then chi vanishes on `[g, g]`, so that F is an invariant of that; on the
//! invariants of `[g, g]` of one degree the other elements act by commuting matrices, whose common eigenvectors with rational
//! eigenvalues are the semi-invariants. A product of powers `F_1^a_1 F_2^a_2 …` is a Casimir where `sum_s a_s chi_s = 0`. Where
//! an eigenvalue is irrational, a Casimir has irrational exponents or angles in it, and is not found.

use super::Casimir;
use super::field::Functions;
use super::invariants::Search;
use super::kernel::kernel;
use super::normal::{primitive, sum_of};
use super::operators::{self, Operator, Word};
use crate::algebra::StructureConstants;
use crate::structure::algebra::{Subspace, Table, Vector, eigenvalues};
use lie_symbolic::exact::{Budget, Exhausted, Fraction, Polynomial, Rational};

/// The largest degree of a semi-invariant that is looked for.
pub const HIGHEST: usize = 3;
/// The largest exponent.
pub const LARGEST: i64 = 24;

/// A semi-invariant with its weights.
struct SemiInvariant {
    function: Polynomial,
    weights: Vector,
}

/// Adds rational Casimirs to those that a search has found, until there are as many as there can be.
pub(super) fn add(
    search: &mut Search<'_>,
    constants: &StructureConstants<Fraction>,
    missing: usize,
    budget: &Budget,
) -> Result<Vec<Casimir>, Exhausted> {
    let mut found = Vec::new();
    let Some(rational) = constants.try_map(Fraction::as_constant) else {
        return Ok(found);
    };
    let table = Table::new(&rational);
    let whole = table.as_subspace(budget)?;
    let derived = table.product(&whole, &whole, budget)?;
    let outside = derived.complement_places();
    let mut all: Vec<SemiInvariant> = Vec::new();
    for degree in 1..=HIGHEST {
        all.extend(of_degree(&table, &derived, &outside, degree, budget)?);
        for exponents in relations(&all, outside.len(), budget)? {
            let factors = all.iter().zip(&exponents).filter(|(_, e)| **e != 0);
            let factors = factors.map(|(s, e)| (s.function.clone(), *e)).collect();
            if search.is_new_product(&factors)? {
                found.push(Casimir::Rational(factors));
            }
            if found.len() == missing {
                return Ok(found);
            }
        }
    }
    Ok(found)
}

/// `ad_y` of a vector as an operator on functions.
fn operator(table: &Table, y: &Vector, budget: &Budget) -> Result<Operator<Fraction>, Exhausted> {
    let rows = (0..table.dimension()).map(|j| {
        let value = table
            .bracket(y, &table.unit(j), budget)?
            .into_iter()
            .enumerate();
        let value = value.filter(|(_, c)| !c.is_zero());
        Ok(value.map(|(k, c)| (k, Fraction::from(c))).collect())
    });
    rows.collect()
}

/// The semi-invariants of a degree.
fn of_degree(
    table: &Table,
    derived: &Subspace,
    outside: &[usize],
    degree: usize,
    budget: &Budget,
) -> Result<Vec<SemiInvariant>, Exhausted> {
    let field = Functions { budget };
    budget.spend(operators::count(table.dimension(), degree).saturating_mul(8))?;
    let words = operators::words(table.dimension(), degree);
    let mut rows = Vec::new();
    for y in derived.basis() {
        rows.extend(operators::rows(
            &field,
            &operator(table, y, budget)?,
            &words,
        )?);
    }
    let (vectors, _) = kernel(&field, words.len(), rows.into_iter())?;
    let vectors: Vec<Vec<(Word, Rational)>> = vectors
        .into_iter()
        .map(|v| {
            v.into_iter()
                .filter_map(|(c, value)| Some((words[c], value.as_constant()?)))
                .collect()
        })
        .collect();
    // each vector has a word of its own, its last: the coordinate of a function in this basis
    let own: Vec<Option<Word>> = vectors
        .iter()
        .map(|v| v.last().map(|(word, _)| *word))
        .collect();
    let mut spaces = vec![(
        Vec::new(),
        (0..vectors.len())
            .map(|i| unit(vectors.len(), i))
            .collect::<Vec<_>>(),
    )];
    for &i in outside {
        let operator = operator(table, &table.unit(i), budget)?;
        let columns: Vec<Vector> = vectors
            .iter()
            .map(|vector| coordinates(&operator, vector, &own, budget))
            .collect::<Result<_, Exhausted>>()?;
        spaces = split(spaces, &columns, budget)?;
    }
    let mut found = Vec::new();
    for (weights, basis) in spaces {
        for vector in basis {
            let mut sum = Polynomial::default();
            for (factor, terms) in vector.iter().zip(&vectors).filter(|(f, _)| !f.is_zero()) {
                sum = &sum + &sum_of(terms).scale(factor);
            }
            found.push(SemiInvariant {
                function: primitive(&sum),
                weights: weights.clone(),
            });
        }
    }
    found.sort_by_key(|s| s.function.terms().len());
    Ok(found)
}

fn unit(length: usize, i: usize) -> Vector {
    let mut unit = vec![Rational::ZERO; length];
    unit[i] = Rational::ONE;
    unit
}

/// The coordinates of the image of a function, which is in the span.
fn coordinates(
    operator: &Operator<Fraction>,
    function: &[(Word, Rational)],
    own: &[Option<Word>],
    budget: &Budget,
) -> Result<Vector, Exhausted> {
    let mut image = vec![Rational::ZERO; own.len()];
    for (word, coefficient) in function {
        for (j, exponent, place) in operators::powers(word) {
            for (k, c) in &operator[j] {
                budget.spend(4 + own.len() as u64 / 8)?;
                let target = Some(operators::replaced(word, place, *k));
                let Some(row) = own.iter().position(|word| *word == target) else {
                    continue;
                };
                let factor = coefficient * &Rational::from(i64::from(exponent));
                let c = c.as_constant().unwrap_or(Rational::ZERO);
                image[row] = &image[row] + &(&factor * &c);
            }
        }
    }
    Ok(image)
}

type Weighted = (Vector, Vec<Vector>);

/// The common eigenspaces of one more matrix, which commutes with those before.
fn split(
    spaces: Vec<Weighted>,
    columns: &[Vector],
    budget: &Budget,
) -> Result<Vec<Weighted>, Exhausted> {
    let size = columns.len();
    let mut finer = Vec::new();
    for (weights, basis) in spaces {
        let space = Subspace::span(size, basis, budget)?;
        for (value, vectors) in eigenvalues(columns, &space, budget)? {
            let mut weights = weights.clone();
            weights.push(value);
            finer.push((weights, vectors));
        }
    }
    Ok(finer)
}

/// Integer exponents of products without weight, those of few factors first.
fn relations(
    all: &[SemiInvariant],
    weights: usize,
    budget: &Budget,
) -> Result<Vec<Vec<i64>>, Exhausted> {
    let rows = (0..weights).map(|w| all.iter().map(|s| s.weights[w].clone()).collect());
    let equations = Subspace::span(all.len(), rows, budget)?;
    let exponents = equations.annihilated().into_iter().filter_map(|vector| {
        let function = vector
            .iter()
            .enumerate()
            .fold(Polynomial::default(), |mut sum, (i, c)| {
                sum.accumulate(lie_symbolic::exact::Monomial::power(i, 1), c);
                sum
            });
        let integers = primitive(&function);
        let mut exponents = vec![0; vector.len()];
        for (monomial, c) in integers.terms() {
            let (variable, _) = monomial.powers().next()?;
            exponents[variable] = c.to_integer().filter(|e| e.abs() <= LARGEST)?;
        }
        Some(exponents)
    });
    let mut exponents: Vec<Vec<i64>> = exponents.collect();
    exponents.sort_by_key(|e| e.iter().map(|e| e.abs()).sum::<i64>());
    Ok(exponents)
}
