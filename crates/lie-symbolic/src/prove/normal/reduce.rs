//! The relations between atoms: `i^2 = -1`, `r^q = |base|`, `s^2 = 1` and those between signs,
//! `exp(i pi/q)^q = -1`.

use std::collections::BTreeMap;

use super::atoms::Atom;
use super::{NormalForm, Stop};
use crate::exact::{Fraction, Monomial, Polynomial, Rational};

impl NormalForm<'_> {
    /// Whether a function is zero modulo the relations.
    pub(super) fn vanishes(&self, value: &Fraction) -> Result<bool, Stop> {
        Ok(value.is_zero() || self.reduce_polynomial(value.numerator())?.is_zero())
    }

    /// The function with a numerator that is reduced by the relations.
    pub(super) fn reduce(&self, value: &Fraction) -> Result<Fraction, Stop> {
        let mut result = self.reduce_polynomial(value.numerator())?;
        for (factor, exponent) in value.denominator() {
            let exponent = i32::try_from(exponent).map_err(|_| Stop::Exhausted)?;
            let inverse = Fraction::from(factor.clone())
                .pow(-exponent, self.budget)?
                .ok_or(Stop::Undefined)?;
            result = result.mul(&inverse, self.budget)?;
        }
        Ok(result)
    }

    fn order(&self, slot: usize) -> Result<u32, Stop> {
        u32::try_from(self.scales[slot]).map_err(|_| Stop::Exhausted)
    }

    /// The base of an atom refers to earlier atoms only, so that one descending pass is enough.
    fn reduce_polynomial(&self, polynomial: &Polynomial) -> Result<Fraction, Stop> {
        let mut value = Fraction::from(polynomial.clone());
        for v in (0..self.atoms.len()).rev() {
            let (order, base) = match &self.atoms[v] {
                Atom::Imaginary => (2, Fraction::from(Rational::MINUS_ONE)),
                Atom::Root { absolute, slot, .. } => (self.order(*slot)?, absolute.clone()),
                Atom::Exponential {
                    exponent,
                    slot,
                    complex: true,
                } if self.is_half_turn(exponent) => {
                    (self.order(*slot)?, Fraction::from(Rational::MINUS_ONE))
                }
                Atom::Sign(_) => match self.relations.get(v) {
                    Some(equal) => (1, equal.value()),
                    None => (2, Fraction::from(Rational::ONE)),
                },
                _ => continue,
            };
            if value
                .numerator()
                .terms()
                .all(|(m, _)| m.exponent(v) < order)
            {
                continue;
            }
            let mut parts: BTreeMap<u32, Polynomial> = BTreeMap::new();
            for (monomial, coefficient) in value.numerator().terms() {
                let (exponent, rest) = monomial.split(v);
                let kept = rest.mul(&Monomial::power(v, exponent % order))?;
                parts
                    .entry(exponent / order)
                    .or_default()
                    .accumulate(kept, coefficient);
            }
            let mut sum = Fraction::default();
            for (power, part) in parts {
                let power = i32::try_from(power).map_err(|_| Stop::Exhausted)?;
                let factor = base.pow(power, self.budget)?.ok_or(Stop::Undefined)?;
                sum = sum.add(&factor.mul(&part.into(), self.budget)?, self.budget)?;
            }
            for (factor, exponent) in value.denominator() {
                let exponent = i32::try_from(exponent).map_err(|_| Stop::Exhausted)?;
                let inverse = Fraction::from(factor.clone())
                    .pow(-exponent, self.budget)?
                    .ok_or(Stop::Undefined)?;
                sum = sum.mul(&inverse, self.budget)?;
            }
            value = sum;
        }
        Ok(value)
    }
}
