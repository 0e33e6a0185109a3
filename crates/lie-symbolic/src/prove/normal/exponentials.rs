//! Reciprocals, integer powers and exponentials.

use std::collections::{BTreeMap, BTreeSet};

use super::atoms::Atom;
use super::{NormalForm, Stop};
use crate::exact::{Fraction, Polynomial, Rational, matrix};

impl NormalForm<'_> {
    /// `1 / value`.
    pub(super) fn reciprocal(&mut self, value: &Fraction) -> Result<Fraction, Stop> {
        if self.vanishes(value)? {
            return Err(Stop::Undefined);
        }
        value.recip(self.budget)?.ok_or(Stop::Undefined)
    }

    /// `base^exponent`.
    pub(super) fn integer_power(
        &mut self,
        base: &Fraction,
        exponent: i64,
    ) -> Result<Fraction, Stop> {
        let exponent = i32::try_from(exponent).map_err(|_| Stop::Exhausted)?;
        if exponent < 0 && self.vanishes(base)? {
            return Err(Stop::Undefined);
        }
        base.pow(exponent, self.budget)?.ok_or(Stop::Undefined)
    }

    /// `exp(exponent)` of a real exponent.
    pub(super) fn exponential(&mut self, exponent: &Fraction) -> Result<Fraction, Stop> {
        let (logarithms, rest) = self.split_logarithms(exponent);
        let mut product = Fraction::from(Rational::ONE);
        for (argument, power) in logarithms {
            // exp(c log |f|) = |f|^c
            let factor = self.factor_power(&argument, &power)?;
            product = product.mul(&factor, self.budget)?;
        }
        let factor = self.in_basis(&rest, false)?;
        Ok(product.mul(&factor, self.budget)?)
    }

    /// `exp(exponent)` in the basis of exponents that are imaginary, or real.
    pub(super) fn in_basis(
        &mut self,
        exponent: &Fraction,
        complex: bool,
    ) -> Result<Fraction, Stop> {
        if exponent.is_zero() {
            return Ok(Rational::ONE.into());
        }
        let known = self.atoms.iter().enumerate();
        let basis: Vec<(usize, usize, Fraction)> = known
            .filter_map(|(v, atom)| match atom {
                Atom::Exponential {
                    exponent,
                    slot,
                    complex: kind,
                } if *kind == complex => Some((v, *slot, exponent.clone())),
                _ => None,
            })
            .collect();
        if let Some(coefficients) = self.combination(exponent, &basis)? {
            let mut product = Fraction::from(Rational::ONE);
            for ((v, slot, _), coefficient) in basis.iter().zip(&coefficients) {
                if !coefficient.is_zero() {
                    let power = self.scaled_power(*v, *slot, coefficient)?;
                    product = product.mul(&power, self.budget)?;
                }
            }
            return Ok(product);
        }
        let slot = self.next_slot();
        let exponent = exponent.clone();
        let v = self.push(Atom::Exponential {
            exponent,
            slot,
            complex,
        });
        self.scaled_power(v, slot, &Rational::ONE)
    }

    /// Splits `sum of c log |f|` with rational `c` off a polynomial exponent.
    fn split_logarithms(&self, exponent: &Fraction) -> (Vec<(Fraction, Rational)>, Fraction) {
        if exponent.denominator().next().is_some() {
            return (Vec::new(), exponent.clone());
        }
        let (mut logarithms, mut rest) = (Vec::new(), Polynomial::default());
        for (monomial, coefficient) in exponent.numerator().terms() {
            let mut powers = monomial.powers();
            if let (Some((v, 1)), None) = (powers.next(), powers.next())
                && let Atom::Logarithm(argument) = &self.atoms[v]
            {
                logarithms.push((argument.clone(), coefficient.clone()));
            } else {
                rest.accumulate(monomial.clone(), coefficient);
            }
        }
        (logarithms, rest.into())
    }

    /// Rational coefficients with `value = sum c_j basis_j`, if there are any.
    fn combination(
        &self,
        value: &Fraction,
        basis: &[(usize, usize, Fraction)],
    ) -> Result<Option<Vec<Rational>>, Stop> {
        if basis.is_empty() {
            return Ok(None);
        }
        let mut common = Polynomial::constant(Rational::ONE);
        let all = || basis.iter().map(|(_, _, b)| b).chain([value]);
        let mut exponents = BTreeMap::new();
        for (factor, exponent) in all().flat_map(Fraction::denominator) {
            let entry = exponents.entry(factor).or_insert(0);
            *entry = exponent.max(*entry);
        }
        for (factor, exponent) in exponents {
            common = common.mul(&factor.pow(exponent, self.budget)?, self.budget)?;
        }
        let common = Fraction::from(common);
        let mut columns = Vec::new();
        for element in all() {
            let column = self.reduce(&element.mul(&common, self.budget)?)?;
            // only numerators over one denominator can be compared
            if column.denominator().next().is_some() {
                return Ok(None);
            }
            columns.push(column.numerator().clone());
        }
        let monomials: BTreeSet<_> = columns
            .iter()
            .flat_map(|p| p.terms().map(|(m, _)| m))
            .collect();
        self.budget
            .spend((monomials.len() * columns.len() * basis.len()) as u64)?;
        let rows: Vec<Vec<Rational>> = monomials
            .iter()
            .map(|m| {
                columns[..basis.len()]
                    .iter()
                    .map(|p| p.coefficient(m))
                    .collect()
            })
            .collect();
        let right: Vec<Rational> = monomials
            .iter()
            .map(|m| columns[basis.len()].coefficient(m))
            .collect();
        Ok(matrix::solve(&rows, &right, self.budget)?)
    }
}
