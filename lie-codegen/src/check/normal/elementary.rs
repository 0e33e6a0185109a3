//! Exponentials, powers and logarithms of rational functions over atoms.

use super::atoms::Atom;
use super::{NormalForm, Stop};
use crate::exact::{Fraction, Polynomial, Rational, matrix};
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Signed, Zero};

/// Primes below this are split off numbers under roots and logarithms.
const TRIAL_DIVISORS: u32 = 1000;

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

    /// `exp(exponent)`.
    pub(super) fn exponential(&mut self, exponent: &Fraction) -> Result<Fraction, Stop> {
        let (logarithms, rest) = self.split_logarithms(exponent);
        let mut product = Fraction::from(Rational::ONE);
        for (argument, power) in logarithms {
            // exp(c log f) = f^c
            let factor = match power.to_integer() {
                Some(integer) => self.integer_power(&argument.into(), integer)?,
                None => self.power(&argument.into(), &power)?,
            };
            product = product.mul(&factor, self.budget)?;
        }
        if rest.is_zero() {
            return Ok(product);
        }
        let basis: Vec<(usize, usize, Fraction)> = self
            .atoms
            .iter()
            .enumerate()
            .filter_map(|(v, atom)| match atom {
                Atom::Exponential { exponent, slot, .. } => Some((v, *slot, exponent.clone())),
                _ => None,
            })
            .collect();
        let factor = match self.combination(&rest, &basis)? {
            Some(coefficients) => {
                let mut factor = Fraction::from(Rational::ONE);
                for ((v, slot, _), coefficient) in basis.iter().zip(&coefficients) {
                    if !coefficient.is_zero() {
                        let power = self.scaled_power(*v, *slot, coefficient)?;
                        factor = factor.mul(&power, self.budget)?;
                    }
                }
                factor
            }
            None => {
                let slot = self.next_slot();
                let complex = self.is_complex(&rest);
                let v = self.push(Atom::Exponential {
                    exponent: rest,
                    slot,
                    complex,
                });
                self.scaled_power(v, slot, &Rational::ONE)?
            }
        };
        Ok(product.mul(&factor, self.budget)?)
    }

    /// Splits `sum of c log f` with rational `c` off a polynomial exponent.
    fn split_logarithms(&self, exponent: &Fraction) -> (Vec<(Polynomial, Rational)>, Fraction) {
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
        let mut exponents = std::collections::BTreeMap::new();
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
            columns.push(
                self.reduce(&element.mul(&common, self.budget)?)?
                    .numerator()
                    .clone(),
            );
        }
        let monomials: std::collections::BTreeSet<_> = columns
            .iter()
            .flat_map(|p| p.terms().map(|(m, _)| m))
            .collect();
        self.budget
            .spend((monomials.len() * columns.len() * basis.len()) as u64)?;
        let entry = |p: &Polynomial, m| {
            p.terms()
                .find(|(n, _)| *n == m)
                .map_or(Rational::ZERO, |(_, c)| c.clone())
        };
        let rows: Vec<Vec<Rational>> = monomials
            .iter()
            .map(|m| {
                columns[..basis.len()]
                    .iter()
                    .map(|p| entry(p, *m))
                    .collect()
            })
            .collect();
        let right: Vec<Rational> = monomials
            .iter()
            .map(|m| entry(&columns[basis.len()], *m))
            .collect();
        Ok(matrix::solve(&rows, &right))
    }

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

    /// `log value`, read as `log |value|`: what holds for that holds wherever the logarithm is real.
    pub(super) fn logarithm(&mut self, value: &Fraction) -> Result<Fraction, Stop> {
        if self.vanishes(value)? {
            return Err(Stop::Undefined);
        }
        if self.is_complex(value) {
            return self.opaque(crate::symbolic::Function::Log, std::slice::from_ref(value));
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

/// The factors of a positive rational with their exponents: small primes, and what is left.
fn factors(value: &Rational) -> Vec<(BigInt, Rational)> {
    let value = value.to_big();
    let mut result = Vec::new();
    for (mut n, sign) in [(value.numer().abs(), 1), (value.denom().clone(), -1)] {
        for p in 2..TRIAL_DIVISORS {
            if n.is_one() {
                break;
            }
            let p = BigInt::from(p);
            let mut exponent = 0i64;
            loop {
                let (quotient, remainder) = n.div_rem(&p);
                if !remainder.is_zero() {
                    break;
                }
                n = quotient;
                exponent += sign;
            }
            if exponent != 0 {
                result.push((p, Rational::from(exponent)));
            }
        }
        if !n.is_one() {
            result.push((n, Rational::from(sign)));
        }
    }
    result
}
