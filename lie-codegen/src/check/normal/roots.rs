//! Fractional powers.

use super::atoms::Atom;
use super::primes::factors;
use super::{NormalForm, Stop};
use crate::exact::{Fraction, Rational};
use num_bigint::BigInt;
use num_traits::One;

impl NormalForm<'_> {
    /// `base^exponent` for an exponent that is not an integer; the base is positive where this is real.
    pub(super) fn power(&mut self, base: &Fraction, exponent: &Rational) -> Result<Fraction, Stop> {
        if self.vanishes(base)? {
            return if exponent.is_negative() {
                Err(Stop::Undefined)
            } else {
                Ok(Fraction::default())
            };
        }
        let content = base.numerator().content();
        let mut product = Fraction::from(Rational::ONE);
        for (prime, power) in factors(&content.abs()) {
            let root = self.root(
                &Fraction::from(Rational::from_big(prime, BigInt::one()).unwrap_or(Rational::ONE)),
                &(&power * exponent),
            )?;
            product = product.mul(&root, self.budget)?;
        }
        let mut rest = base.scale(&(&Rational::ONE / &content.abs()));
        // Real exponentials and roots are positive: their powers multiply.
        for (v, power) in self.positive_factors(&rest) {
            let factor = Fraction::variable(v)
                .pow(power, self.budget)?
                .ok_or(Stop::Undefined)?;
            rest = rest.div(&factor, self.budget)?.ok_or(Stop::Undefined)?;
            let exponent = exponent * &Rational::from(i64::from(power));
            let factor = match self.atoms[v].clone() {
                Atom::Exponential {
                    exponent: inner,
                    slot,
                    ..
                } => {
                    let scale = Rational::from(self.scales[slot]);
                    self.exponential(&inner.scale(&(&exponent / &scale)))?
                }
                Atom::Root { base, slot } => {
                    let scale = Rational::from(self.scales[slot]);
                    self.root(&base, &(&exponent / &scale))?
                }
                _ => return Err(Stop::Undefined),
            };
            product = product.mul(&factor, self.budget)?;
        }
        if let Some(sign) = rest.as_constant() {
            return if sign.is_negative() {
                Err(Stop::Undefined)
            } else {
                Ok(product)
            };
        }
        // A pure reciprocal has the root of what stands below.
        let root = if rest.numerator().as_constant().is_some() {
            let inverse = self.reciprocal(&rest)?;
            self.root(&inverse, &-exponent)?
        } else {
            self.root(&rest, exponent)?
        };
        Ok(product.mul(&root, self.budget)?)
    }

    /// Real exponentials and roots that are factors, with their exponents.
    fn positive_factors(&self, value: &Fraction) -> Vec<(usize, i32)> {
        let positive = |v: usize| {
            matches!(
                self.atoms[v],
                Atom::Exponential { complex: false, .. } | Atom::Root { .. }
            )
        };
        let above: Vec<(usize, i32)> = value
            .numerator()
            .monomial_content()
            .powers()
            .map(|(v, e)| (v, e as i32))
            .collect();
        let below = value.denominator().filter_map(|(factor, e)| {
            let (monomial, _) = factor.leading().filter(|_| factor.terms().len() == 1)?;
            Some((monomial.powers().next()?.0, -(e as i32)))
        });
        above
            .into_iter()
            .chain(below)
            .filter(|(v, _)| positive(*v))
            .collect()
    }

    /// `base^exponent` as a power of a root atom.
    fn root(&mut self, base: &Fraction, exponent: &Rational) -> Result<Fraction, Stop> {
        if let Some(integer) = exponent.to_integer() {
            return self.integer_power(base, integer);
        }
        for v in 0..self.atoms.len() {
            if let Atom::Root { base: known, slot } = &self.atoms[v] {
                let slot = *slot;
                if self.vanishes(&known.sub(base, self.budget)?)? {
                    return self.scaled_power(v, slot, exponent);
                }
            }
        }
        let slot = self.next_slot();
        let v = self.push(Atom::Root {
            base: base.clone(),
            slot,
        });
        self.scaled_power(v, slot, exponent)
    }
}
