//! Sparse multivariate polynomials over the rationals.

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
        use std::collections::btree_map::Entry;
        match self.0.entry(monomial) {
            Entry::Vacant(entry) => {
                if !coefficient.is_zero() {
                    entry.insert(coefficient.clone());
                }
            }
            Entry::Occupied(mut entry) => {
                let sum = entry.get() + coefficient;
                if sum.is_zero() {
                    entry.remove();
                } else {
                    entry.insert(sum);
                }
            }
        }
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
                let product = a * b;
                budget.spend_on(&product)?;
                result.accumulate(m.mul(n)?, &product);
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

    /// The quotient where the division leaves no remainder; `None` otherwise and for a zero divisor.
    ///
    /// # Errors
    /// [`Exhausted`] where the budget is too small for it.
    pub fn divide_exactly(
        &self,
        divisor: &Self,
        budget: &Budget,
    ) -> Result<Option<Self>, Exhausted> {
        let Some((lead, inverse)) = divisor.leading().and_then(|(m, c)| Some((m, c.recip()?)))
        else {
            return Ok(None);
        };
        let (mut rest, mut quotient) = (self.clone(), Self::default());
        while let Some((monomial, coefficient)) = rest.leading() {
            // With a single divisor and a monomial order the leading terms must divide at each step.
            let Some(shift) = monomial.divide(lead) else {
                return Ok(None);
            };
            let factor = coefficient * &inverse;
            for (m, c) in &divisor.0 {
                let product = c * &factor;
                budget.spend_on(&product)?;
                rest.accumulate(m.mul(&shift)?, &-&product);
            }
            quotient.accumulate(shift, &factor);
        }
        Ok(Some(quotient))
    }

    /// The square root with a positive leading coefficient, where it is a polynomial.
    ///
    /// # Errors
    /// [`Exhausted`] where the budget is too small for it.
    pub fn square_root(&self, budget: &Budget) -> Result<Option<Self>, Exhausted> {
        let Some((monomial, coefficient)) = self.leading() else {
            return Ok(None);
        };
        let Some(lead) = monomial
            .square_root()
            .zip(coefficient.square_root())
            .map(|(monomial, coefficient)| Self::term(monomial, coefficient))
        else {
            return Ok(None);
        };
        let lowest = self.0.first_key_value().map(|(m, _)| m.degree());
        let twice = lead.scale(&Rational::from(2));
        let (mut root, mut rest) = (lead.clone(), self - &lead.mul(&lead, budget)?);
        // each round settles one term of the root, from the highest down
        while let Some((monomial, coefficient)) = rest.leading() {
            let (leading, factor) = match twice.leading() {
                Some(term) if Some(monomial.degree()) >= lowest => term,
                _ => return Ok(None),
            };
            let Some(shift) = monomial.divide(leading) else {
                return Ok(None);
            };
            let term = Self::term(shift, coefficient / factor);
            let change = &root.scale(&Rational::from(2)) + &term;
            rest = &rest - &change.mul(&term, budget)?;
            root = &root + &term;
        }
        Ok(Some(root))
    }

    /// The rational that leaves integer coefficients without common divisor and a positive leading
    /// one; one for zero.
    pub fn content(&self) -> Rational {
        use num_integer::Integer;
        let Some((_, lead)) = self.leading() else {
            return Rational::ONE;
        };
        let first = lead.to_big();
        let (mut n, mut d) = first.into_raw();
        for value in self.0.values() {
            let value = value.to_big();
            n = n.gcd(value.numer());
            d = d.lcm(value.denom());
        }
        let content = Rational::from_big(n, d).unwrap_or(Rational::ONE).abs();
        if lead.is_negative() {
            -content
        } else {
            content
        }
    }

    /// The greatest monomial that divides every term.
    pub fn monomial_content(&self) -> Monomial {
        let mut keys = self.0.keys();
        let first = keys.next().cloned().unwrap_or_default();
        keys.fold(first, |common, m| {
            if common.is_one() {
                common
            } else {
                common.gcd(m)
            }
        })
    }

    /// The quotient by a monomial that divides every term.
    pub fn strip(&self, monomial: &Monomial) -> Self {
        if monomial.is_one() {
            return self.clone();
        }
        Self(
            self.0
                .iter()
                .filter_map(|(m, c)| Some((m.divide(monomial)?, c.clone())))
                .collect(),
        )
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
    fn exact_division_undoes_products() {
        let b = Budget::new(100_000);
        let [x, y, z] = variables();
        let p = (&(&x + &y) + &z.scale(&Rational::new(2, 3).unwrap()))
            .pow(5, &b)
            .unwrap();
        let q = (&x.mul(&y, &b).unwrap() - &z).pow(3, &b).unwrap();
        let product = p.mul(&q, &b).unwrap();
        assert_eq!(product.divide_exactly(&p, &b).unwrap().unwrap(), q);
        assert_eq!(product.divide_exactly(&q, &b).unwrap().unwrap(), p);
        assert_eq!((&product + &x).divide_exactly(&q, &b).unwrap(), None);
        assert_eq!(p.divide_exactly(&Polynomial::default(), &b).unwrap(), None);
    }

    #[test]
    fn squares_have_roots() {
        let b = Budget::new(100_000);
        let [x, y, z] = variables();
        let root =
            &(&x.mul(&y, &b).unwrap().scale(&Rational::from(2)) - &z) + &y.pow(3, &b).unwrap();
        let square = root.mul(&root, &b).unwrap();
        assert_eq!(square.square_root(&b).unwrap(), Some(root.clone()));
        assert_eq!(
            (-&root).mul(&-&root, &b).unwrap().square_root(&b),
            Ok(Some(root))
        );
        assert_eq!((&square + &z).square_root(&b), Ok(None));
        assert_eq!(
            (&square + &Polynomial::constant(Rational::ONE)).square_root(&b),
            Ok(None)
        );
        assert_eq!((-&square).square_root(&b), Ok(None));
        assert_eq!(square.scale(&Rational::from(3)).square_root(&b), Ok(None));
    }

    #[test]
    fn content_and_monomials_are_split_off() {
        let b = Budget::new(1000);
        let [x, y, _] = variables();
        let p = &x.mul(&y, &b).unwrap().scale(&Rational::new(-4, 3).unwrap())
            + &x.mul(&x, &b).unwrap().scale(&Rational::new(-2, 5).unwrap());
        assert_eq!(p.content(), Rational::new(-2, 15).unwrap());
        assert_eq!(p.monomial_content(), Monomial::power(0, 1));
        assert_eq!(p.strip(&Monomial::power(0, 1)).degree(), 1);
        let at = |v: usize| Rational::from(v as i64 + 2);
        assert_eq!(
            p.derivative(0).evaluate(&at),
            &Rational::new(-4, 3).unwrap() * &Rational::from(3) - Rational::new(8, 5).unwrap()
        );
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
