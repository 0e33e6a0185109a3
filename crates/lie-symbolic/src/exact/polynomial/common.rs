//! Greatest common divisors of polynomials, by remainders of primitive parts (W. S. Brown, Journal of the ACM 18 (1971) 478–504,
//! doi:10.1145/321662.321664).

use std::collections::BTreeMap;

use super::{Budget, Exhausted, Monomial, Polynomial, Rational};

impl Polynomial {
    /// The greatest common divisor, with integer coefficients without common divisor; the other one where one is 0.
    ///
    /// # Errors
    /// [`Exhausted`] where the budget is too small for it.
    pub fn gcd(&self, other: &Self, budget: &Budget) -> Result<Self, Exhausted> {
        if self.is_zero() || other.is_zero() {
            let whole = if self.is_zero() { other } else { self };
            return Ok(whole.without_content());
        }
        let variable = |of: &Self| {
            let first = of.0.keys().filter_map(|m| Some(m.powers().next()?.0));
            first.min()
        };
        let (Some(first), Some(second)) = (variable(self), variable(other)) else {
            return Ok(Self::constant(Rational::ONE));
        };
        // what does not have a variable divides every coefficient by it
        if first != second {
            let (with, without, v) = match first < second {
                true => (self, other, first),
                false => (other, self, second),
            };
            return with
                .by_powers(v)
                .into_values()
                .try_fold(without.without_content(), |common, coefficient| {
                    common.gcd(&coefficient, budget)
                });
        }
        let [one, another] = [self.parts(first, budget)?, other.parts(first, budget)?];
        let content = one.0.gcd(&another.0, budget)?;
        let (mut above, mut below) = (one.1, another.1);
        if above.degree_in(first) < below.degree_in(first) {
            std::mem::swap(&mut above, &mut below);
        }
        while !below.is_zero() {
            let rest = above.pseudo_remainder(&below, first, budget)?;
            above = below;
            below = match rest.is_zero() {
                true => rest,
                false => rest.parts(first, budget)?.1,
            };
        }
        Ok(content.mul(&above, budget)?.without_content())
    }

    fn without_content(&self) -> Self {
        match self.content().recip() {
            Some(inverse) => self.scale(&inverse),
            None => self.clone(),
        }
    }

    /// The coefficients of the powers of a variable.
    fn by_powers(&self, variable: usize) -> BTreeMap<u32, Self> {
        let mut all: BTreeMap<u32, Self> = BTreeMap::new();
        for (monomial, coefficient) in &self.0 {
            let (power, rest) = monomial.split(variable);
            all.entry(power).or_default().accumulate(rest, coefficient);
        }
        all
    }

    fn degree_in(&self, variable: usize) -> u32 {
        let powers = self.0.keys().map(|m| m.exponent(variable));
        powers.max().unwrap_or_default()
    }

    /// The greatest common divisor of the coefficients by a variable, and the quotient by it.
    fn parts(&self, variable: usize, budget: &Budget) -> Result<(Self, Self), Exhausted> {
        let mut content = Self::default();
        for coefficient in self.by_powers(variable).values() {
            content = content.gcd(coefficient, budget)?;
        }
        let quotient = self.divide_exactly(&content, budget)?;
        let primitive = quotient.unwrap_or_else(|| self.clone());
        Ok((content, primitive.without_content()))
    }

    /// The remainder of a multiple by a power of the leading coefficient.
    fn pseudo_remainder(
        &self,
        divisor: &Self,
        variable: usize,
        budget: &Budget,
    ) -> Result<Self, Exhausted> {
        let degree = divisor.degree_in(variable);
        let leading = |of: &Self| of.by_powers(variable).pop_last();
        let Some((_, lead)) = leading(divisor) else {
            return Ok(self.clone());
        };
        let mut rest = self.clone();
        while let Some((power, top)) = leading(&rest)
            && power >= degree
        {
            let shift = Self::term(Monomial::power(variable, power - degree), Rational::ONE);
            let taken = divisor.mul(&top, budget)?.mul(&shift, budget)?;
            rest = &rest.mul(&lead, budget)? - &taken;
        }
        Ok(rest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polynomial(terms: &[(i64, [u32; 3])]) -> Polynomial {
        let mut sum = Polynomial::default();
        for (coefficient, exponents) in terms {
            let mut monomial = Monomial::default();
            for (variable, exponent) in exponents.iter().enumerate() {
                let power = Monomial::power(variable, *exponent);
                monomial = monomial.mul(&power).expect("a small degree");
            }
            sum.accumulate(monomial, &Rational::from(*coefficient));
        }
        sum
    }

    /// Of products with a common factor it is that factor, whatever the others.
    #[test]
    fn common_factors_are_found() {
        let budget = Budget::new(1_000_000);
        let factors = [
            polynomial(&[(1, [2, 0, 0]), (1, [0, 0, 0])]),
            polynomial(&[(2, [1, 1, 0]), (-3, [0, 0, 2]), (5, [0, 0, 0])]),
            polynomial(&[(1, [0, 1, 0])]),
            polynomial(&[(1, [0, 3, 1]), (1, [1, 0, 0]), (-7, [0, 1, 0])]),
        ];
        let first = polynomial(&[(1, [1, 0, 0]), (1, [0, 1, 0])]);
        let second = polynomial(&[(1, [0, 0, 1]), (-2, [1, 0, 0]), (1, [0, 0, 0])]);
        let times = |a: &Polynomial, b: &Polynomial| a.mul(b, &budget).expect("work");
        for one in &factors {
            for another in &factors {
                let common = times(one, another);
                let [a, b] = [&first, &second].map(|other| times(&common, other));
                let found = a.gcd(&b, &budget).expect("work");
                assert_eq!(found, common.without_content());
            }
            let without = one.gcd(&first, &budget).expect("work");
            assert_eq!(without, Polynomial::constant(Rational::ONE));
            let zero = Polynomial::default();
            let found = zero.gcd(one, &budget).expect("work");
            assert_eq!(found, one.without_content());
        }
    }

    #[test]
    fn work_is_limited() {
        let one = polynomial(&[(1, [9, 9, 9]), (1, [0, 0, 0])]);
        assert!(one.gcd(&one, &Budget::new(1)).is_err());
    }
}
