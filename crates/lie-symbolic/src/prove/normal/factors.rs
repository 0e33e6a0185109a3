//! Real functions as products, and with them absolute values, their powers and their logarithms.
//!
//! Nothing here takes a function for positive that is not known to be: a fractional power of f is one of
//! `|f|`, and `log f` is `log |f|`; both hold where they are real.

use num_bigint::BigInt;
use num_traits::One;

use super::atoms::Atom;
use super::primes::factors;
use super::{NormalForm, Stop};
use crate::exact::{Fraction, Polynomial, Rational};
use crate::symbolic::{ExprId, Node};

/// A product of powers.
#[derive(Clone, Debug)]
pub(super) struct Factors {
    /// The rational factor, with the sign.
    pub content: Rational,
    /// Variables, primitive polynomials and real functions with complex parts, with their exponents.
    pub parts: Vec<(Fraction, i64)>,
}

impl NormalForm<'_> {
    /// The factors of an expression as they are written: `(x + y)^2` is a square here, not a polynomial.
    pub(super) fn written_factors(&self, id: ExprId) -> Vec<(Fraction, Rational)> {
        let (coefficient, rest) = self.graph.coefficient(id);
        let mut found = vec![(coefficient.into(), Rational::ONE)];
        let value = |id: &ExprId| self.values.get(id).cloned();
        match self.graph.node(rest) {
            Node::Product(powers) => {
                for (base, exponent) in powers {
                    found.extend(value(base).map(|base| (base, exponent.clone())));
                }
                if found.len() == powers.len() + 1 {
                    return found;
                }
                vec![(self.values[&id].clone(), Rational::ONE)]
            }
            _ => match value(&rest) {
                Some(value) => {
                    found.push((value, Rational::ONE));
                    found
                }
                None => vec![(self.values[&id].clone(), Rational::ONE)],
            },
        }
    }

    /// The factors of a real function that is not zero.
    pub(super) fn factors(&mut self, value: &Fraction) -> Result<Factors, Stop> {
        let content = value.numerator().content();
        let mut result = Factors {
            content: content.clone(),
            parts: Vec::new(),
        };
        let monomial = value.numerator().monomial_content();
        let mut whole = value.scale(&(&Rational::ONE / &content));
        let mut split = Vec::new();
        for (v, exponent) in monomial.powers() {
            split.push((Polynomial::variable(v), i64::from(exponent)));
        }
        for (factor, exponent) in value.denominator() {
            split.push((factor.clone(), -i64::from(exponent)));
        }
        for (factor, exponent) in split {
            let factor = Fraction::from(factor);
            if self.is_complex(&factor) {
                continue;
            }
            let power = i32::try_from(exponent).map_err(|_| Stop::Exhausted)?;
            let divisor = factor.pow(-power, self.budget)?.ok_or(Stop::Undefined)?;
            whole = whole.mul(&divisor, self.budget)?;
            match self.as_variable(&factor) {
                Some(_) => result.parts.push((factor, exponent)),
                None => self.split(factor.numerator().clone(), exponent, &mut result)?,
            }
        }
        if self.is_complex(&whole) {
            match self.real_root(&whole)? {
                Some((root, negative)) => {
                    if negative {
                        result.content = -&result.content;
                    }
                    let root = self.factors(&root)?;
                    let scale = root.content.pow(2).ok_or(Stop::Exhausted)?;
                    result.content = &result.content * &scale;
                    let parts = root.parts.into_iter();
                    result.parts.extend(parts.map(|(part, e)| (part, 2 * e)));
                }
                None => self.push_part(whole, 1, &mut result)?,
            }
        } else if whole.as_constant().is_none() {
            self.split(whole.numerator().clone(), 1, &mut result)?;
        }
        Ok(result)
    }

    /// Splits a primitive polynomial by the factors that are known, and into equal ones.
    fn split(
        &mut self,
        mut rest: Polynomial,
        exponent: i64,
        result: &mut Factors,
    ) -> Result<(), Stop> {
        for v in 0..self.atoms.len() {
            let Some(known) = self.atoms[v].base() else {
                continue;
            };
            if known.denominator().next().is_some() || known.numerator().terms().len() < 2 {
                continue;
            }
            let known = known.clone();
            let mut times = 0;
            while rest.as_constant().is_none()
                && let Some(quotient) = rest.divide_exactly(known.numerator(), self.budget)?
            {
                rest = quotient;
                times += exponent;
            }
            if times != 0 {
                result.parts.push((known, times));
            }
        }
        let mut exponent = exponent;
        while rest.as_constant().is_none()
            && let Some(root) = rest.square_root(self.budget)?
        {
            rest = root;
            exponent = exponent.checked_mul(2).ok_or(Stop::Exhausted)?;
        }
        let Some(unit) = rest.as_constant() else {
            return self.push_part(rest.into(), exponent, result);
        };
        let exponent = i32::try_from(exponent).map_err(|_| Stop::Exhausted)?;
        let unit = unit.pow(exponent).ok_or(Stop::Undefined)?;
        result.content = &result.content * &unit;
        Ok(())
    }

    /// Adds a factor, under the form in which it is known.
    fn push_part(
        &mut self,
        part: Fraction,
        exponent: i64,
        result: &mut Factors,
    ) -> Result<(), Stop> {
        let plain = self.is_plain(&part);
        for v in 0..self.atoms.len() {
            let Some(known) = self.atoms[v].base().filter(|_| !plain).cloned() else {
                continue;
            };
            if self.vanishes(&known.sub(&part, self.budget)?)? {
                result.parts.push((known, exponent));
                return Ok(());
            }
            if self.vanishes(&known.add(&part, self.budget)?)? {
                if exponent % 2 != 0 {
                    result.content = -&result.content;
                }
                result.parts.push((known, exponent));
                return Ok(());
            }
        }
        result.parts.push((part, exponent));
        Ok(())
    }

    /// The variable, if the function is one.
    pub(super) fn as_variable(&self, value: &Fraction) -> Option<usize> {
        let polynomial = value.numerator();
        if value.denominator().next().is_some() || polynomial.terms().len() != 1 {
            return None;
        }
        let (monomial, coefficient) = polynomial.leading()?;
        let (v, exponent) = monomial.powers().next()?;
        (coefficient.is_one() && exponent == 1 && monomial.degree() == 1).then_some(v)
    }

    /// `base^exponent` for an exponent that is not an integer, by the factors of the base as they are written.
    pub(super) fn fractional_power(
        &mut self,
        base: ExprId,
        exponent: &Rational,
    ) -> Result<Fraction, Stop> {
        let mut product = Fraction::from(Rational::ONE);
        for (factor, power) in self.written_factors(base) {
            let power = self.absolute_power(&factor, &(&power * exponent))?;
            product = product.mul(&power, self.budget)?;
        }
        Ok(product)
    }

    /// The logarithm, by the factors of the argument as they are written.
    pub(super) fn logarithm(&mut self, argument: ExprId) -> Result<Fraction, Stop> {
        let mut sum = Fraction::default();
        for (factor, power) in self.written_factors(argument) {
            let logarithm = self.absolute_logarithm(&factor)?;
            sum = sum.add(&logarithm.scale(&power), self.budget)?;
        }
        Ok(sum)
    }

    /// `|value|^exponent`
    pub(super) fn absolute_power(
        &mut self,
        value: &Fraction,
        exponent: &Rational,
    ) -> Result<Fraction, Stop> {
        if self.vanishes(value)? {
            return if exponent.is_negative() {
                Err(Stop::Undefined)
            } else {
                Ok(Fraction::default())
            };
        }
        let factored = self.factors(value)?;
        let mut product = Fraction::from(Rational::ONE);
        for (prime, power) in factors(&factored.content.abs()) {
            let prime = prime_constant(prime);
            let root = self.factor_power(&prime, &(&power * exponent))?;
            product = product.mul(&root, self.budget)?;
        }
        for (factor, power) in factored.parts {
            let power = self.factor_power(&factor, &(&Rational::from(power) * exponent))?;
            product = product.mul(&power, self.budget)?;
        }
        Ok(product)
    }

    /// `|factor|^exponent`
    pub(super) fn factor_power(
        &mut self,
        factor: &Fraction,
        exponent: &Rational,
    ) -> Result<Fraction, Stop> {
        let variable = self.as_variable(factor);
        match variable.map(|v| self.atoms[v].clone()) {
            Some(Atom::Sign(_)) => return Ok(Rational::ONE.into()),
            Some(Atom::Exponential {
                exponent: inner,
                slot,
                complex: false,
            }) => {
                let scale = Rational::from(self.scales[slot]);
                return self.exponential(&inner.scale(&(exponent / &scale)));
            }
            Some(Atom::Root { base, slot, .. }) => {
                let scale = Rational::from(self.scales[slot]);
                return self.factor_power(&base, &(exponent / &scale));
            }
            _ => {}
        }
        if let Some(integer) = exponent.to_integer() {
            let power = self.integer_power(factor, integer)?;
            if integer % 2 == 0 {
                return Ok(power);
            }
            let sign = self.factor_sign(factor)?;
            return Ok(power.mul(&sign.value(), self.budget)?);
        }
        let known = self
            .atoms
            .iter()
            .position(|atom| matches!(atom, Atom::Root { base, .. } if base == factor));
        let v = match known {
            Some(v) => v,
            None => {
                let sign = self.factor_sign(factor)?;
                let absolute = sign.value().mul(factor, self.budget)?;
                let slot = self.next_slot();
                let base = factor.clone();
                self.push(Atom::Root {
                    base,
                    absolute,
                    slot,
                })
            }
        };
        let Atom::Root { slot, .. } = self.atoms[v] else {
            return Err(Stop::Undefined);
        };
        self.scaled_power(v, slot, exponent)
    }

    /// `log |value|`
    pub(super) fn absolute_logarithm(&mut self, value: &Fraction) -> Result<Fraction, Stop> {
        if self.vanishes(value)? {
            return Err(Stop::Undefined);
        }
        let factored = self.factors(value)?;
        let mut sum = Fraction::default();
        for (prime, power) in factors(&factored.content.abs()) {
            let logarithm = Fraction::variable(self.atom(Atom::Logarithm(prime_constant(prime))));
            sum = sum.add(&logarithm.scale(&power), self.budget)?;
        }
        for (factor, power) in factored.parts {
            let logarithm = self.factor_logarithm(&factor)?;
            sum = sum.add(&logarithm.scale(&Rational::from(power)), self.budget)?;
        }
        Ok(sum)
    }

    fn factor_logarithm(&mut self, factor: &Fraction) -> Result<Fraction, Stop> {
        let variable = self.as_variable(factor);
        match variable.map(|v| self.atoms[v].clone()) {
            Some(Atom::Sign(_)) => Ok(Fraction::default()),
            Some(Atom::Exponential {
                exponent,
                slot,
                complex: false,
            }) => {
                let scale = Rational::from(self.scales[slot]);
                Ok(exponent.scale(&(&Rational::ONE / &scale)))
            }
            Some(Atom::Root { base, slot, .. }) => {
                let scale = Rational::from(self.scales[slot]);
                let logarithm = self.factor_logarithm(&base)?;
                Ok(logarithm.scale(&(&Rational::ONE / &scale)))
            }
            _ => {
                let atom = self.atom(Atom::Logarithm(factor.clone()));
                Ok(Fraction::variable(atom))
            }
        }
    }
}

fn prime_constant(prime: BigInt) -> Fraction {
    Rational::from_big(prime, BigInt::one())
        .unwrap_or(Rational::ONE)
        .into()
}
