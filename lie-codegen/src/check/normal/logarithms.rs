//! Logarithms, taken apart by factors.

use super::atoms::Atom;
use super::primes::factors;
use super::{NormalForm, Stop};
use crate::exact::{Fraction, Polynomial, Rational};
use crate::symbolic::Function;
use num_bigint::BigInt;
use num_traits::One;

impl NormalForm<'_> {
    /// `log value`, read as `log |value|`: what holds for that holds wherever the logarithm is real.
    pub(super) fn logarithm(&mut self, value: &Fraction) -> Result<Fraction, Stop> {
        if self.vanishes(value)? {
            return Err(Stop::Undefined);
        }
        if self.is_complex(value) {
            return self.opaque(Function::Log, std::slice::from_ref(value));
        }
        let mut sum = Fraction::default();
        let content = value.numerator().content();
        for (prime, power) in factors(&content.abs()) {
            let prime = Polynomial::constant(
                Rational::from_big(prime, BigInt::one()).unwrap_or(Rational::ONE),
            );
            sum = sum.add(
                &self.atom(Atom::Logarithm(prime)).scale(&power),
                self.budget,
            )?;
        }
        let monomial = value.numerator().monomial_content();
        let rest = value
            .numerator()
            .strip(&monomial)
            .scale(&(&Rational::ONE / &content));
        let above = monomial
            .powers()
            .map(|(v, e)| (Polynomial::variable(v), i64::from(e)))
            .chain([(rest, 1)]);
        let below = value
            .denominator()
            .map(|(factor, e)| (factor.clone(), -i64::from(e)));
        let parts: Vec<(Polynomial, i64)> = above.chain(below).collect();
        for (factor, power) in parts {
            let logarithm = self.log_factor(factor)?;
            sum = sum.add(&logarithm.scale(&Rational::from(power)), self.budget)?;
        }
        Ok(sum)
    }

    fn log_factor(&mut self, mut factor: Polynomial) -> Result<Fraction, Stop> {
        let single = factor
            .leading()
            .filter(|_| factor.terms().len() == 1)
            .and_then(|(m, _)| m.powers().next());
        if let Some((v, _)) = single {
            match self.atoms[v].clone() {
                Atom::Exponential { exponent, slot, .. } => {
                    return Ok(
                        exponent.scale(&(&Rational::ONE / &Rational::from(self.scales[slot])))
                    );
                }
                Atom::Root { base, slot } => {
                    let scale = Rational::from(self.scales[slot]);
                    return Ok(self.logarithm(&base)?.scale(&(&Rational::ONE / &scale)));
                }
                _ => {}
            }
        }
        // Known arguments that divide this one are split off.
        let mut sum = Fraction::default();
        for v in 0..self.atoms.len() {
            let Atom::Logarithm(known) = &self.atoms[v] else {
                continue;
            };
            if known.as_constant().is_some() {
                continue;
            }
            while factor.as_constant().is_none()
                && let Some(quotient) = factor.divide_exactly(known, self.budget)?
            {
                factor = quotient;
                sum = sum.add(&Fraction::variable(v), self.budget)?;
            }
        }
        if factor.as_constant().is_none() {
            sum = sum.add(&self.atom(Atom::Logarithm(factor)), self.budget)?;
        }
        Ok(sum)
    }
}
