//! The polynomial invariants of one degree.

use std::collections::BTreeMap;

use num_bigint::BigInt;
use rustc_hash::FxHashMap;

use super::Kind;
use super::characters::{Signs, graded};
use super::field::{Field, Functions, PRIMES, Prime, drawn};
use super::grading::Grading;
use super::kernel::{Sparse, kernel};
use super::normal::{largest, normal, normal_rational};
use super::operators::{self, Echelon, Operator, Word};
use super::residues::{combine, lifted, reconstructed};
use super::traces;
use crate::algebra::StructureConstants;
use lie_symbolic::exact::{Budget, Exhausted, Fraction, Polynomial, Rational};

/// A function by its terms, highest words last.
pub type Terms<T> = Vec<(Word, T)>;

/// In smaller algebras elimination takes less than traces.
const LARGE: usize = 11;

/// A search, degree by degree.
pub struct Search<'a> {
    constants: &'a StructureConstants<Fraction>,
    budget: &'a Budget,
    grading: Option<(Grading, Signs)>,
    bracket: Kind,
    /// Basis elements that generate the algebra.
    generators: Vec<usize>,
    /// The operators of these elements over the rationals, where no parameter occurs.
    rational: Option<Vec<Operator<Rational>>>,
    /// The point at which gradients are compared.
    point: Vec<u64>,
    gradients: Echelon,
    found: Vec<Polynomial>,
}

impl<'a> Search<'a> {
    /// A search in an algebra, with a unit or without, or where its constants satisfy no Jacobi identity; `None` where a constant has a
    /// pole at the point that is looked at.
    pub fn new(
        constants: &'a StructureConstants<Fraction>,
        bracket: Kind,
        budget: &'a Budget,
    ) -> Result<Option<Self>, Exhausted> {
        let n = constants.dimension();
        let field = Prime {
            prime: PRIMES[0],
            budget,
        };
        let at_point = |c: &Fraction| field.fraction(c, &|p| drawn(n + p));
        let all: Vec<usize> = (0..n).collect();
        budget.spend(8 * constants.entries().len() as u64)?;
        let table = operators::operators(constants, &all, at_point, |v| field.negative(v));
        let Some(table) = table else { return Ok(None) };
        // what generators annihilate all others do by the Jacobi identity
        let generators = match bracket.jacobi {
            true => operators::generators(&field, &table)?,
            false => all,
        };
        let rational = operators::operators(constants, &generators, Fraction::as_constant, |v| -v);
        let mut gradients = Echelon::new(n);
        if let Some(unit) = bracket.unit(n) {
            let mut row = vec![0; n];
            row[unit] = 1;
            gradients.insert(&field, row)?;
        }
        Ok(Some(Self {
            constants,
            budget,
            grading: match bracket.jacobi {
                true => graded(constants, &table, &field)?,
                false => None,
            },
            bracket,
            generators,
            rational,
            point: (0..n).map(drawn).collect(),
            gradients,
            found: Vec::new(),
        }))
    }

    /// What was found.
    pub fn into_found(self) -> Vec<Polynomial> {
        self.found
    }

    /// Looks at one degree; whether as many were found as there are.
    pub fn degree(&mut self, degree: usize, wanted: usize) -> Result<bool, Exhausted> {
        let mut candidates = self.space(degree)?;
        candidates.sort_by_cached_key(|f| (f.terms().len(), largest(f)));
        for candidate in candidates {
            if self.is_new(&candidate)? {
                self.found.push(candidate);
            }
            if self.found.len() == wanted {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Looks at the invariant of degree 4 that is a trace, where elimination would take more than is left of the budget; whether
    /// as many were found as there are.
    pub fn trace(&mut self, wanted: usize) -> Result<bool, Exhausted> {
        let n = self.constants.dimension();
        let affordable = PRIMES.len() as u64 * traces::cost(n) < self.budget.left();
        if n < LARGE
            || !self.bracket.jacobi
            || !affordable
            || self.rational.is_none()
            || self.bracket.with_unit
        {
            return Ok(false);
        }
        let elimination = |class: Vec<Word>| (class.len() as u64).pow(3) / 4;
        let all = self.classes(4)?.into_values().map(elimination).sum::<u64>();
        if all < self.budget.left() {
            return Ok(false);
        }
        let all: Vec<usize> = (0..self.constants.dimension()).collect();
        let adjoint = operators::operators(self.constants, &all, Fraction::as_constant, |v| -v);
        let adjoint = adjoint.unwrap_or_default();
        let Some(terms) = traces::fourth(&adjoint, self.budget)? else {
            return Ok(false);
        };
        for operator in &adjoint {
            if !vanishes(operator, &terms, self.budget)? {
                return Ok(false);
            }
        }
        let trace = normal_rational(&terms, None);
        if self.is_new(&trace)? {
            self.found.push(trace);
        }
        Ok(self.found.len() == wanted)
    }

    /// The invariants of a degree, as a vector space.
    pub fn space(&self, degree: usize) -> Result<Vec<Polynomial>, Exhausted> {
        let mut basis = Vec::new();
        for monomials in self.classes(degree)?.into_values() {
            basis.extend(self.class(&monomials)?);
        }
        Ok(basis)
    }

    /// The monomials of a degree that invariants may have, by their class.
    fn classes(&self, degree: usize) -> Result<BTreeMap<Vec<i64>, Vec<Word>>, Exhausted> {
        let n = self.constants.dimension();
        let count = operators::count(n, degree);
        self.budget.spend(count.saturating_mul(2))?;
        let mut classes: BTreeMap<Vec<i64>, Vec<Word>> = BTreeMap::new();
        for word in operators::words(n, degree) {
            let class = match &self.grading {
                Some((_, signs)) if !signs.keep(&word) => continue,
                Some((grading, _)) => {
                    self.budget.spend(n as u64)?;
                    let mut exponents = vec![0; n];
                    operators::powers(&word).for_each(|(v, e, _)| exponents[v] = i64::from(e));
                    grading.class(exponents)
                }
                None => Vec::new(),
            };
            classes.entry(class).or_default().push(word);
        }
        Ok(classes)
    }

    /// The invariants with monomials of one class.
    fn class(&self, monomials: &[Word]) -> Result<Vec<Polynomial>, Exhausted> {
        let n = self.constants.dimension();
        match &self.rational {
            Some(exact) => {
                let kernel = self.rational_kernel(exact, monomials)?;
                Ok(kernel
                    .iter()
                    .map(|terms| normal_rational(terms, self.bracket.unit(n)))
                    .collect())
            }
            None => {
                let kernel = self.functional_kernel(monomials)?;
                kernel
                    .iter()
                    .map(|terms| normal(terms, n, self.bracket.unit(n), self.budget))
                    .collect()
            }
        }
    }

    /// The kernel over the rationals: modulo as many primes as its numbers need, verified.
    fn rational_kernel(
        &self,
        exact: &[Operator<Rational>],
        monomials: &[Word],
    ) -> Result<Vec<Terms<Rational>>, Exhausted> {
        let mut modulus = BigInt::from(1);
        let mut residues: Vec<Sparse<BigInt>> = Vec::new();
        let mut needed: Option<Vec<usize>> = None;
        for prime in PRIMES {
            let field = Prime {
                prime,
                budget: self.budget,
            };
            let Some(rows) = self.rows_modulo(&field, exact, monomials)? else {
                continue;
            };
            let rows = rows.into_iter().enumerate();
            let rows =
                rows.filter(|(i, _)| needed.as_ref().is_none_or(|n| n.binary_search(i).is_ok()));
            let (vectors, new) = kernel(&field, monomials.len(), rows.map(|(_, row)| row))?;
            if vectors.is_empty() {
                return Ok(Vec::new());
            }
            if needed.is_none() {
                needed = Some(new);
                residues = lifted(&vectors);
            } else if !combine(&mut residues, &modulus, &vectors, prime) {
                // a prime that divides a minor says nothing
                continue;
            }
            modulus *= prime;
            if let Some(terms) = self.verified(exact, monomials, &residues, &modulus)? {
                return Ok(terms);
            }
        }
        Err(Exhausted)
    }

    /// The equations modulo a prime; `None` where it divides a denominator.
    fn rows_modulo(
        &self,
        field: &Prime<'_>,
        exact: &[Operator<Rational>],
        monomials: &[Word],
    ) -> Result<Option<Vec<Sparse<u64>>>, Exhausted> {
        let mut rows = Vec::new();
        for operator in exact {
            let convert = |row: &Vec<(usize, Rational)>| {
                row.iter()
                    .map(|(k, c)| Some((*k, field.rational(c)?)))
                    .collect()
            };
            let operator: Option<Operator<u64>> = operator.iter().map(convert).collect();
            let Some(operator) = operator else {
                return Ok(None);
            };
            rows.extend(operators::rows(field, &operator, monomials)?);
        }
        Ok(Some(rows))
    }

    /// The vectors as rational functions, where they are the kernel.
    fn verified(
        &self,
        exact: &[Operator<Rational>],
        monomials: &[Word],
        residues: &[Sparse<BigInt>],
        modulus: &BigInt,
    ) -> Result<Option<Vec<Terms<Rational>>>, Exhausted> {
        let mut all = Vec::new();
        for vector in residues {
            self.budget.spend(8 * vector.len() as u64)?;
            let terms = vector
                .iter()
                .map(|(column, value)| Some((monomials[*column], reconstructed(value, modulus)?)));
            let Some(terms) = terms.collect::<Option<Terms<Rational>>>() else {
                return Ok(None);
            };
            for operator in exact {
                if !vanishes(operator, &terms, self.budget)? {
                    return Ok(None);
                }
            }
            all.push(terms);
        }
        Ok(Some(all))
    }

    /// The kernel over the rational functions of the parameters.
    fn functional_kernel(&self, monomials: &[Word]) -> Result<Vec<Terms<Fraction>>, Exhausted> {
        let field = Functions {
            budget: self.budget,
        };
        let convert = |c: &Fraction| Some(c.clone());
        let operators =
            operators::operators(self.constants, &self.generators, convert, Fraction::neg);
        let mut rows = Vec::new();
        for operator in operators.unwrap_or_default() {
            rows.extend(operators::rows(&field, &operator, monomials)?);
        }
        let (vectors, _) = kernel(&field, monomials.len(), rows.into_iter())?;
        let terms = vectors.into_iter().map(|vector| {
            vector
                .into_iter()
                .map(|(column, value)| (monomials[column], value))
                .collect()
        });
        Ok(terms.collect())
    }

    /// How many were found.
    pub fn count(&self) -> usize {
        self.found.len()
    }

    /// Whether the gradient of a function is independent of those before it; then it counts from now on.
    fn is_new(&mut self, function: &Polynomial) -> Result<bool, Exhausted> {
        let field = Prime {
            prime: PRIMES[0],
            budget: self.budget,
        };
        match self.at_point(&field, function)? {
            Some((_, gradient)) => self.gradients.insert(&field, gradient),
            None => Ok(false),
        }
    }

    /// The same of a product of powers: its gradient over its value is the sum of those of the factors.
    pub fn is_new_product(&mut self, factors: &Vec<(Polynomial, i64)>) -> Result<bool, Exhausted> {
        let own = Budget::new(1 << 24);
        let field = Prime {
            prime: PRIMES[0],
            budget: &own,
        };
        let mut sum = vec![0; self.constants.dimension()];
        for (function, exponent) in factors {
            let Some((value, gradient)) = self.at_point(&field, function)? else {
                return Ok(false);
            };
            if value == 0 {
                return Ok(false);
            }
            let factor = field.times(field.integer(*exponent), field.inverse(&value)?);
            for (entry, slope) in sum.iter_mut().zip(gradient) {
                *entry = field.plus(*entry, field.times(factor, slope));
            }
        }
        self.gradients.insert(&field, sum)
    }

    /// Value and gradient at the point; `None` where a coefficient has no residue.
    fn at_point(
        &self,
        field: &Prime<'_>,
        function: &Polynomial,
    ) -> Result<Option<(u64, Vec<u64>)>, Exhausted> {
        let n = self.constants.dimension();
        let at = |v: usize| if v < n { self.point[v] } else { drawn(v) };
        let (mut value, mut gradient) = (0, vec![0; n]);
        field.budget.spend(8 * function.terms().len() as u64)?;
        for (monomial, coefficient) in function.terms() {
            let Some(coefficient) = field.rational(coefficient) else {
                return Ok(None);
            };
            let product = |without: Option<usize>| {
                let mut term = coefficient;
                for (v, e) in monomial.powers() {
                    for _ in 0..e - u32::from(Some(v) == without) {
                        term = field.times(term, at(v));
                    }
                }
                term
            };
            value = field.plus(value, product(None));
            for (j, exponent) in monomial.powers().filter(|(j, _)| *j < n) {
                let term = field.times(u64::from(exponent), product(Some(j)));
                gradient[j] = field.plus(gradient[j], term);
            }
        }
        Ok(Some((value, gradient)))
    }
}

/// Whether an operator maps a function to zero.
pub fn vanishes(
    operator: &Operator<Rational>,
    function: &[(Word, Rational)],
    budget: &Budget,
) -> Result<bool, Exhausted> {
    let mut image: FxHashMap<Word, Rational> = FxHashMap::default();
    for (word, coefficient) in function {
        for (j, exponent, place) in operators::powers(word) {
            let factor = coefficient * &Rational::from(i64::from(exponent));
            budget.spend(8 * operator[j].len() as u64)?;
            for (k, c) in &operator[j] {
                let entry = image
                    .entry(operators::replaced(word, place, *k))
                    .or_insert(Rational::ZERO);
                *entry = &*entry + &(&factor * c);
            }
        }
    }
    Ok(image.values().all(Rational::is_zero))
}
