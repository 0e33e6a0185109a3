//! Sparse multivariate polynomials over the rationals.

mod common;
mod division;

use std::collections::BTreeMap;
use std::fmt::Write;
use std::ops::{Add, Neg, Sub};

use super::budget::{Budget, Exhausted};
use super::{Monomial, Rational};

/// A polynomial: coefficients by monomial, none zero, in a fixed order.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct Polynomial(BTreeMap<Monomial, Rational>);

impl Polynomial {
    /// A constant.
    pub fn constant(value: Rational) -> Self {
        Self::term(Monomial::default(), value)
    }

    /// A variable.
    pub fn variable(variable: usize) -> Self {
        Self::term(Monomial::power(variable, 1), Rational::ONE)
    }

    /// `coefficient * monomial`.
    pub fn term(monomial: Monomial, coefficient: Rational) -> Self {
        let mut result = Self::default();
        result.accumulate(monomial, &coefficient);
        result
    }

    /// Whether it is the zero polynomial.
    pub fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    /// The value of a constant polynomial.
    pub fn as_constant(&self) -> Option<Rational> {
        match self.0.first_key_value() {
            None => Some(Rational::ZERO),
            Some((monomial, value)) if self.0.len() == 1 && monomial.is_one() => {
                Some(value.clone())
            }
            _ => None,
        }
    }

    /// The terms in ascending order.
    pub fn terms(
        &self,
    ) -> impl DoubleEndedIterator<Item = (&Monomial, &Rational)> + ExactSizeIterator {
        self.0.iter()
    }

    /// The coefficient of a monomial.
    pub fn coefficient(&self, monomial: &Monomial) -> Rational {
        self.0.get(monomial).cloned().unwrap_or(Rational::ZERO)
    }

    /// The total degree, 0 for zero.
    pub fn degree(&self) -> u32 {
        self.0.last_key_value().map_or(0, |(m, _)| m.degree())
    }

    /// Whether all terms have one degree.
    pub fn is_homogeneous(&self) -> bool {
        self.0
            .first_key_value()
            .is_none_or(|(m, _)| m.degree() == self.degree())
    }

    /// The term of the greatest monomial.
    pub fn leading(&self) -> Option<(&Monomial, &Rational)> {
        self.0.last_key_value()
    }

    /// Adds one term.
    pub fn accumulate(&mut self, monomial: Monomial, coefficient: &Rational) {
        self.added(monomial, coefficient);
    }

    /// Adds one term; the length of the sum in bits.
    fn added(&mut self, monomial: Monomial, coefficient: &Rational) -> u64 {
        use std::collections::btree_map::Entry;
        match self.0.entry(monomial) {
            Entry::Vacant(entry) => {
                if !coefficient.is_zero() {
                    entry.insert(coefficient.clone());
                }
                0
            }
            Entry::Occupied(mut entry) => {
                let sum = entry.get() + coefficient;
                let bits = sum.bits();
                if sum.is_zero() {
                    entry.remove();
                } else {
                    entry.insert(sum);
                }
                bits
            }
        }
    }

    /// Adds one term within a budget. The sum may be longer than what is added.
    fn accumulate_within(
        &mut self,
        monomial: Monomial,
        coefficient: &Rational,
        budget: &Budget,
    ) -> Result<(), Exhausted> {
        budget.spend_on(coefficient)?;
        budget.spend_on_length(self.added(monomial, coefficient))
    }

    /// The same with other variables, whose order must be that of the old ones.
    pub fn renamed(&self, variable: &dyn Fn(usize) -> usize) -> Self {
        let terms = self.0.iter().map(|(m, c)| (m.renamed(variable), c.clone()));
        Self(terms.collect())
    }

    /// `factor * self`.
    pub fn scale(&self, factor: &Rational) -> Self {
        if factor.is_zero() {
            return Self::default();
        }
        Self(
            self.0
                .iter()
                .map(|(m, c)| (m.clone(), c * factor))
                .collect(),
        )
    }

    /// The product.
    ///
    /// # Errors
    /// [`Exhausted`] where the budget is too small for it.
    pub fn mul(&self, other: &Self, budget: &Budget) -> Result<Self, Exhausted> {
        let mut result = Self::default();
        for (m, a) in &self.0 {
            for (n, b) in &other.0 {
                result.accumulate_within(m.mul(n)?, &(a * b), budget)?;
            }
        }
        Ok(result)
    }

    /// `self^exponent`.
    ///
    /// # Errors
    /// [`Exhausted`] where the budget is too small for it.
    pub fn pow(&self, exponent: u32, budget: &Budget) -> Result<Self, Exhausted> {
        let (mut result, mut square, mut left) =
            (Self::constant(Rational::ONE), self.clone(), exponent);
        while left > 0 {
            if left & 1 == 1 {
                result = result.mul(&square, budget)?;
            }
            left >>= 1;
            if left > 0 {
                square = square.mul(&square, budget)?;
            }
        }
        Ok(result)
    }

    /// The sum.
    ///
    /// # Errors
    /// [`Exhausted`] where the budget is too small for it.
    pub fn sum(&self, other: &Self, budget: &Budget) -> Result<Self, Exhausted> {
        let mut result = self.clone();
        for (m, c) in &other.0 {
            result.accumulate_within(m.clone(), c, budget)?;
        }
        Ok(result)
    }

    /// The partial derivative.
    pub fn derivative(&self, variable: usize) -> Self {
        let mut result = Self::default();
        for (m, c) in &self.0 {
            if let Some(lower) = m.divide(&Monomial::power(variable, 1)) {
                result.accumulate(
                    lower,
                    &(c * &Rational::from(i64::from(m.exponent(variable)))),
                );
            }
        }
        result
    }

    /// The value at a rational point.
    pub fn evaluate(&self, point: &dyn Fn(usize) -> Rational) -> Rational {
        let mut sum = Rational::ZERO;
        for (m, c) in &self.0 {
            let mut product = c.clone();
            for (v, e) in m.powers() {
                let power = point(v).pow(e as i32).unwrap_or(Rational::ZERO);
                product = &product * &power;
            }
            sum = &sum + &product;
        }
        sum
    }

    /// Whether the variable occurs.
    pub fn contains(&self, variable: usize) -> bool {
        self.0.keys().any(|m| m.exponent(variable) > 0)
    }

    /// The polynomial as text, highest terms first.
    pub fn display(&self, name: &dyn Fn(usize) -> String) -> String {
        let mut text = String::new();
        for (m, c) in self.0.iter().rev() {
            let (sign, size) = (c.is_negative(), c.abs());
            text.push_str(match (text.is_empty(), sign) {
                (true, false) => "",
                (true, true) => "-",
                (false, false) => " + ",
                (false, true) => " - ",
            });
            let mut factors = Vec::new();
            if !size.is_one() || m.is_one() {
                factors.push(size.to_string());
            }
            for (v, e) in m.powers() {
                factors.push(if e == 1 {
                    name(v)
                } else {
                    format!("{}^{e}", name(v))
                });
            }
            let _ = write!(text, "{}", factors.join("*"));
        }
        if text.is_empty() { "0".into() } else { text }
    }
}

impl Add for &Polynomial {
    type Output = Polynomial;
    fn add(self, other: &Polynomial) -> Polynomial {
        let mut result = self.clone();
        for (m, c) in &other.0 {
            result.accumulate(m.clone(), c);
        }
        result
    }
}
impl Sub for &Polynomial {
    type Output = Polynomial;
    fn sub(self, other: &Polynomial) -> Polynomial {
        self + &-other
    }
}
impl Neg for &Polynomial {
    type Output = Polynomial;
    fn neg(self) -> Polynomial {
        Polynomial(self.0.iter().map(|(m, c)| (m.clone(), -c)).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn variables() -> [Polynomial; 3] {
        [0, 1, 2].map(Polynomial::variable)
    }

    #[test]
    fn order_is_graded_lexicographic() {
        let b = Budget::new(1000);
        let [x, y, z] = variables();
        let p = &(&x.mul(&z, &b).unwrap() + &y.mul(&y, &b).unwrap()) + &(&x - &z);
        assert_eq!(
            p.display(&|v| ["x", "y", "z"][v].into()),
            "x*z + y^2 + x - z"
        );
        assert!(!p.is_homogeneous());
    }

    #[test]
    fn huge_powers_exhaust_the_budget() {
        let b = Budget::new(100_000);
        let [x, y, z] = variables();
        assert_eq!((&(&x + &y) + &z).pow(1000, &b), Err(Exhausted));
        let one = Polynomial::constant(Rational::from(9));
        assert_eq!(one.pow(387_420_489, &Budget::new(100_000)), Err(Exhausted));
        assert_eq!(x.pow(1 << 30, &Budget::new(100_000)), Err(Exhausted));
    }
}
