//! A matrix whose entries are linear forms in x, over the rational functions of the parameters.

use std::collections::{BTreeMap, BTreeSet};

use super::Factor;
use crate::algebra::StructureConstants;
use lie_symbolic::exact::{Budget, Exhausted, Fraction, Rational};

/// The variable of `x_i` in polynomials is `FIRST + i`: parameters come before.
const FIRST: usize = 1 << 20;

/// A linear form in x.
pub(super) type Form = Vec<(usize, Fraction)>;

/// Row, column and entry, none zero.
#[derive(Clone, Debug)]
pub(super) struct Operator {
    pub entries: Vec<(usize, usize, Form)>,
}

impl Operator {
    /// `ad*_x` on momenta: `(ad*_x)_jk = C_ij^k x^i`.
    pub fn coadjoint(constants: &StructureConstants<Fraction>) -> Self {
        let mut entries: BTreeMap<(usize, usize), Form> = BTreeMap::new();
        for (i, j, k, value) in constants.entries() {
            let mut add = |row, form| entries.entry((row, *k)).or_default().push(form);
            add(*j, (*i, value.clone()));
            add(*i, (*j, value.neg()));
        }
        let entries = entries.into_iter().map(|((j, k), form)| (j, k, form));
        Self {
            entries: entries.collect(),
        }
    }

    /// The operator of the elements x with entries at some places alone.
    pub fn restricted(self, elements: &[usize]) -> Self {
        let entries = self.entries.into_iter().map(|(j, k, mut form)| {
            form.retain(|(i, _)| elements.contains(i));
            (j, k, form)
        });
        Self {
            entries: entries.filter(|(.., form)| !form.is_empty()).collect(),
        }
    }

    /// The coordinates that it reads or writes.
    pub fn coordinates(&self) -> Vec<usize> {
        let places = self.entries.iter().flat_map(|(j, k, _)| [*j, *k]);
        let mut places: Vec<usize> = places.collect();
        places.sort_unstable();
        places.dedup();
        places
    }

    /// The operators on sets of coordinates that do not act on each other, nor depend on each other's x.
    pub fn components(self) -> Vec<Self> {
        let variables = |(j, k, form): &(usize, usize, Form)| {
            let inputs = form.iter().map(|(i, _)| *i);
            inputs.chain([*j, *k]).collect::<Vec<_>>()
        };
        let size = self.entries.iter().flat_map(variables).max();
        let mut leader: Vec<usize> = (0..=size.unwrap_or(0)).collect();
        loop {
            let before = leader.clone();
            for entry in &self.entries {
                let all = variables(entry);
                let least = all.iter().map(|i| leader[*i]).min().unwrap_or(0);
                for i in all {
                    leader[i] = least;
                }
            }
            if leader == before {
                break;
            }
        }
        let mut parts: BTreeMap<usize, Vec<_>> = BTreeMap::new();
        for entry in self.entries {
            parts.entry(leader[entry.0]).or_default().push(entry);
        }
        parts
            .into_values()
            .map(|entries| Self { entries })
            .collect()
    }

    /// The trace.
    pub fn trace(&self, budget: &Budget) -> Result<Form, Exhausted> {
        let mut sum: BTreeMap<usize, Fraction> = BTreeMap::new();
        for (_, _, form) in self.entries.iter().filter(|(j, k, _)| j == k) {
            for (i, value) in form {
                let entry = sum.entry(*i).or_default();
                *entry = entry.add(value, budget)?;
            }
        }
        sum.retain(|_, value| !value.is_zero());
        Ok(sum.into_iter().collect())
    }

    /// The trace of the square, by the coefficients of `x_i x_j`, `i <= j`.
    pub fn trace_of_square(
        &self,
        budget: &Budget,
    ) -> Result<Vec<(usize, usize, Fraction)>, Exhausted> {
        let places: BTreeMap<(usize, usize), &Form> = self.places();
        let mut sum: BTreeMap<(usize, usize), Fraction> = BTreeMap::new();
        for ((j, k), form) in &places {
            let Some(other) = places.get(&(*k, *j)) else {
                continue;
            };
            for (a, left) in form.iter() {
                for (b, right) in other.iter() {
                    let entry = sum.entry((*a.min(b), *a.max(b))).or_default();
                    *entry = entry.add(&left.mul(right, budget)?, budget)?;
                }
            }
        }
        sum.retain(|_, value| !value.is_zero());
        Ok(sum.into_iter().map(|((i, j), c)| (i, j, c)).collect())
    }

    fn places(&self) -> BTreeMap<(usize, usize), &Form> {
        let entries = self.entries.iter();
        entries.map(|(j, k, form)| ((*j, *k), form)).collect()
    }

    /// The rows of `A^a` times powers 0, 1, … of the factor's base, below the exponent, that do not vanish; `None` unless
    /// `A^a` times the factor vanishes, as an identity in x and the parameters.
    pub fn supports(
        &self,
        nilpotent: usize,
        factor: &Factor,
        budget: &Budget,
    ) -> Result<Option<Vec<Vec<usize>>>, Exhausted> {
        let matrix = self.entries.iter().map(|(j, k, form)| {
            let form = form.iter().map(|(i, c)| term(c, &[*i], budget));
            Ok((*j, *k, total(form, budget)?))
        });
        let matrix: Vec<_> = matrix.collect::<Result<_, Exhausted>>()?;
        let shift = match factor {
            Factor::None => Fraction::default(),
            Factor::Linear(form, _) => {
                let terms = form.iter().map(|(i, c)| term(&c.neg(), &[*i], budget));
                total(terms, budget)?
            }
            Factor::Quadratic(form, _) => total(
                form.iter().map(|(i, j, c)| term(c, &[*i, *j], budget)),
                budget,
            )?,
        };
        let (applications, power) = match factor {
            Factor::None => (0, 0),
            Factor::Linear(_, power) => (1, *power),
            Factor::Quadratic(_, power) => (2, *power),
        };
        let mut supports = vec![BTreeSet::new(); power];
        for column in self.coordinates() {
            let mut vector = Vector::from([(column, Fraction::from(Rational::ONE))]);
            for _ in 0..nilpotent {
                vector = apply(&matrix, &vector, budget)?;
            }
            for support in &mut supports {
                support.extend(vector.keys().copied());
                let mut moved = vector.clone();
                for _ in 0..applications {
                    moved = apply(&matrix, &moved, budget)?;
                }
                for (row, value) in &vector {
                    let entry = moved.entry(*row).or_default();
                    *entry = entry.add(&value.mul(&shift, budget)?, budget)?;
                }
                moved.retain(|_, value| !value.is_zero());
                vector = moved;
            }
            if !vector.is_empty() {
                return Ok(None);
            }
        }
        let sorted = supports.into_iter().map(|rows| rows.into_iter().collect());
        Ok(Some(sorted.collect()))
    }
}

type Vector = BTreeMap<usize, Fraction>;

fn term(coefficient: &Fraction, inputs: &[usize], budget: &Budget) -> Result<Fraction, Exhausted> {
    let mut product = coefficient.clone();
    for i in inputs {
        product = product.mul(&Fraction::variable(FIRST + i), budget)?;
    }
    Ok(product)
}

fn total(
    mut terms: impl Iterator<Item = Result<Fraction, Exhausted>>,
    budget: &Budget,
) -> Result<Fraction, Exhausted> {
    terms.try_fold(Fraction::default(), |sum, term| sum.add(&term?, budget))
}

fn apply(
    matrix: &[(usize, usize, Fraction)],
    vector: &Vector,
    budget: &Budget,
) -> Result<Vector, Exhausted> {
    let mut out = Vector::new();
    for (row, column, entry) in matrix {
        if let Some(value) = vector.get(column) {
            let sum = out.entry(*row).or_default();
            *sum = sum.add(&entry.mul(value, budget)?, budget)?;
        }
    }
    out.retain(|_, value| !value.is_zero());
    Ok(out)
}
