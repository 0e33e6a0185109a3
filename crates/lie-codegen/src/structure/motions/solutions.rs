//! The constants of the motion among the polynomials of some monomials.
//!
//! The equations are solved modulo a prime, at one point of the parameters, for all monomials. That tells which solutions there
//! are, which of them are functions of what is known (their gradients are combinations of known ones), and of which monomials each
//! consists. Only those that are new are solved for again, over the rational functions of the parameters and in these monomials alone.

use std::collections::BTreeMap;

use super::functions::{Function, changed};
use crate::structure::casimirs::solve::{
    Echelon, Field as _, Functions, PRIMES, Prime, Sparse, cleared, drawn, kernel,
};
use lie_symbolic::exact::{Budget, Exhausted, Fraction, Monomial, Polynomial};

/// A polynomial of the coordinates modulo a prime, at the point of the parameters.
type Residues = Vec<(Monomial, u64)>;

/// A search for constants of one motion.
pub struct Search<'a> {
    field: &'a [Function],
    /// The field modulo the prime.
    residues: Vec<Residues>,
    prime: Prime<'a>,
    /// Gradients of what is known at one point.
    known: Echelon,
    budget: &'a Budget,
}

impl<'a> Search<'a> {
    /// A search for functions that a field leaves alone.
    pub fn new(field: &'a [Function], budget: &'a Budget) -> Result<Self, Exhausted> {
        let prime = Prime {
            prime: PRIMES[0],
            budget,
        };
        let residues = field.iter().map(|f| modulo(&prime, f, field.len()));
        Ok(Self {
            residues: residues.collect::<Option<_>>().ok_or(Exhausted)?,
            field,
            prime,
            known: Echelon::new(field.len()),
            budget,
        })
    }

    /// Takes a function as known; whether it is independent of those before it.
    pub fn know(&mut self, function: &Function) -> Result<bool, Exhausted> {
        let Some(residues) = modulo(&self.prime, function, self.field.len()) else {
            return Ok(false);
        };
        let gradient = self.gradient(&residues)?;
        self.known.insert(&self.prime, gradient)
    }

    /// The solutions modulo the prime that may be new, by their monomials, the shortest first.
    pub fn candidates(&self, columns: &[Monomial]) -> Result<Vec<Vec<(usize, u64)>>, Exhausted> {
        let mut equations: BTreeMap<Monomial, Sparse<u64>> = BTreeMap::new();
        for (column, monomial) in columns.iter().enumerate() {
            for (monomial, value) in self.changed(monomial)? {
                if value != 0 {
                    equations.entry(monomial).or_default().push((column, value));
                }
            }
        }
        let (mut vectors, _) = kernel(&self.prime, columns.len(), equations.into_values())?;
        vectors.sort_by_key(Vec::len);
        Ok(vectors)
    }

    /// Whether the gradient of a candidate is independent of what is known.
    pub fn is_new(
        &self,
        candidate: &[(usize, u64)],
        columns: &[Monomial],
    ) -> Result<bool, Exhausted> {
        let terms = candidate.iter().map(|(c, v)| (columns[*c].clone(), *v));
        let gradient = self.gradient(&terms.collect::<Vec<_>>())?;
        self.known.is_new(&self.prime, &gradient)
    }

    /// The function of which a candidate is the image, if it is one.
    pub fn lifted(
        &self,
        candidate: &[(usize, u64)],
        columns: &[Monomial],
    ) -> Result<Option<Polynomial>, Exhausted> {
        let (n, budget) = (self.field.len(), self.budget);
        let support: Vec<&Monomial> = candidate.iter().map(|(c, _)| &columns[*c]).collect();
        let mut equations: BTreeMap<Monomial, Sparse<Fraction>> = BTreeMap::new();
        for (column, monomial) in support.iter().enumerate() {
            for (monomial, value) in changed(monomial, self.field, budget)? {
                if !value.is_zero() {
                    equations.entry(monomial).or_default().push((column, value));
                }
            }
        }
        let equations: Vec<Sparse<Fraction>> = equations.into_values().collect();
        let residue = |(column, value): &(usize, Fraction)| {
            Some((*column, self.prime.fraction(value, &|p| drawn(n + p))?))
        };
        let rows = equations
            .iter()
            .map(|row| row.iter().map(residue).collect());
        let rows: Option<Vec<Sparse<u64>>> = rows.collect();
        let rows = rows.ok_or(Exhausted)?.into_iter().map(|mut row| {
            row.retain(|(_, value)| !self.prime.is_zero(value));
            row
        });
        let (_, needed) = kernel(&self.prime, support.len(), rows)?;
        let rows = needed.iter().map(|&i| equations[i].clone());
        let (vectors, _) = kernel(&Functions { budget }, support.len(), rows)?;
        // the last monomial is one that no other solution has
        let Some(vector) = vectors.into_iter().last() else {
            return Ok(None);
        };
        if !solves(&vector, &equations, support.len(), budget)? {
            return Ok(None);
        }
        let terms = vector
            .into_iter()
            .map(|(c, value)| (support[c].clone(), value));
        cleared(&terms.collect::<Vec<_>>(), n, budget).map(Some)
    }

    /// `sum_j f_j dm/dmu_j` of a monomial m, modulo the prime.
    fn changed(&self, monomial: &Monomial) -> Result<BTreeMap<Monomial, u64>, Exhausted> {
        let mut sum = BTreeMap::new();
        for (j, exponent) in monomial.powers() {
            let lower = monomial.divide(&Monomial::power(j, 1)).unwrap_or_default();
            self.budget.spend(16 * self.residues[j].len() as u64)?;
            for (other, value) in &self.residues[j] {
                let value = self.prime.times(*value, u64::from(exponent));
                let entry = sum.entry(lower.mul(other)?).or_insert(0);
                *entry = self.prime.plus(*entry, value);
            }
        }
        Ok(sum)
    }

    /// The gradient of a function at the point.
    fn gradient(&self, function: &Residues) -> Result<Vec<u64>, Exhausted> {
        let mut gradient = vec![0; self.field.len()];
        for (monomial, coefficient) in function {
            self.budget.spend(8 * u64::from(monomial.degree()))?;
            for (j, exponent) in monomial.powers() {
                let mut term = self.prime.times(*coefficient, u64::from(exponent));
                for (v, e) in monomial.powers() {
                    for _ in 0..e - u32::from(v == j) {
                        term = self.prime.times(term, drawn(v));
                    }
                }
                gradient[j] = self.prime.plus(gradient[j], term);
            }
        }
        Ok(gradient)
    }
}

/// A function modulo a prime; `None` at a pole.
fn modulo(prime: &Prime<'_>, function: &Function, n: usize) -> Option<Residues> {
    let residue = |(monomial, value): (&Monomial, &Fraction)| {
        Some((monomial.clone(), prime.fraction(value, &|p| drawn(n + p))?))
    };
    function.iter().map(residue).collect()
}

/// Whether a vector solves all equations.
fn solves(
    vector: &Sparse<Fraction>,
    equations: &[Sparse<Fraction>],
    columns: usize,
    budget: &Budget,
) -> Result<bool, Exhausted> {
    let mut values: Vec<Option<&Fraction>> = vec![None; columns];
    for (column, value) in vector {
        values[*column] = Some(value);
    }
    for row in equations {
        let mut sum = Fraction::default();
        for (column, factor) in row {
            if let Some(value) = values[*column] {
                sum = sum.add(&factor.mul(value, budget)?, budget)?;
            }
        }
        if !sum.is_zero() {
            return Ok(false);
        }
    }
    Ok(true)
}
