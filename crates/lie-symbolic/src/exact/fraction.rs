//! Rational functions over the rationals.

use std::collections::BTreeMap;

use super::budget::{Budget, Exhausted};
use super::{Monomial, Polynomial, Rational};

/// A rational function: an expanded numerator over a product of factors.
///
/// The denominator stays factored as it was written, which keeps sums of quotients small without
/// a multivariate greatest common divisor. Factors are variables, or primitive polynomials without
/// monomial content; the numerator is freed of them by trial division. The representation is not
/// unique (`==` compares representations), but a function is zero exactly where its numerator is.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Fraction {
    numerator: Polynomial,
    denominator: BTreeMap<Polynomial, u32>,
}

impl From<Polynomial> for Fraction {
    fn from(numerator: Polynomial) -> Self {
        Self {
            numerator,
            denominator: BTreeMap::new(),
        }
    }
}
impl From<Rational> for Fraction {
    fn from(value: Rational) -> Self {
        Polynomial::constant(value).into()
    }
}

impl Fraction {
    /// A variable.
    pub fn variable(variable: usize) -> Self {
        Polynomial::variable(variable).into()
    }

    /// The expanded numerator.
    pub fn numerator(&self) -> &Polynomial {
        &self.numerator
    }

    /// The factors of the denominator with their exponents.
    pub fn denominator(&self) -> impl Iterator<Item = (&Polynomial, u32)> {
        self.denominator.iter().map(|(f, e)| (f, *e))
    }

    /// Whether it is identically zero.
    pub fn is_zero(&self) -> bool {
        self.numerator.is_zero()
    }

    /// The value of a constant function.
    pub fn as_constant(&self) -> Option<Rational> {
        if self.denominator.is_empty() {
            self.numerator.as_constant()
        } else {
            None
        }
    }

    /// `factor * self`.
    pub fn scale(&self, factor: &Rational) -> Self {
        if factor.is_zero() {
            return Self::default();
        }
        Self {
            numerator: self.numerator.scale(factor),
            denominator: self.denominator.clone(),
        }
    }

    /// `-self`.
    pub fn neg(&self) -> Self {
        self.scale(&Rational::MINUS_ONE)
    }

    /// The sum.
    ///
    /// # Errors
    /// [`Exhausted`] where the budget is too small for it.
    pub fn add(&self, other: &Self, budget: &Budget) -> Result<Self, Exhausted> {
        budget.spend((self.numerator.terms().len() + other.numerator.terms().len()) as u64)?;
        if self.denominator == other.denominator {
            let numerator = self.numerator.sum(&other.numerator, budget)?;
            return Self {
                numerator,
                denominator: self.denominator.clone(),
            }
            .reduce(budget);
        }
        // Long denominators are work too, where each factor is short.
        budget.spend((self.denominator.len() + other.denominator.len()) as u64)?;
        let mut common = self.denominator.clone();
        for (factor, &exponent) in &other.denominator {
            let entry = common.entry(factor.clone()).or_insert(0);
            *entry = exponent.max(*entry);
        }
        let lift = |part: &Self| -> Result<Polynomial, Exhausted> {
            let mut numerator = part.numerator.clone();
            for (factor, exponent) in &common {
                let missing = exponent - part.denominator.get(factor).copied().unwrap_or(0);
                if missing > 0 {
                    numerator = numerator.mul(&factor.pow(missing, budget)?, budget)?;
                }
            }
            Ok(numerator)
        };
        let numerator = lift(self)?.sum(&lift(other)?, budget)?;
        Self {
            numerator,
            denominator: common,
        }
        .reduce(budget)
    }

    /// The difference.
    ///
    /// # Errors
    /// [`Exhausted`] where the budget is too small for it.
    pub fn sub(&self, other: &Self, budget: &Budget) -> Result<Self, Exhausted> {
        self.add(&other.neg(), budget)
    }

    /// The product.
    ///
    /// # Errors
    /// [`Exhausted`] where the budget is too small for it.
    pub fn mul(&self, other: &Self, budget: &Budget) -> Result<Self, Exhausted> {
        // Cancelling crosswise first keeps the product small.
        let mut left = Self {
            numerator: self.numerator.clone(),
            denominator: other.denominator.clone(),
        }
        .reduce(budget)?;
        let right = Self {
            numerator: other.numerator.clone(),
            denominator: self.denominator.clone(),
        }
        .reduce(budget)?;
        left.numerator = left.numerator.mul(&right.numerator, budget)?;
        if left.numerator.is_zero() {
            return Ok(Self::default());
        }
        for (factor, exponent) in right.denominator {
            let entry = left.denominator.entry(factor).or_insert(0);
            *entry = entry.checked_add(exponent).ok_or(Exhausted)?;
        }
        Ok(left)
    }

    /// `1 / self`; `None` for zero.
    ///
    /// # Errors
    /// [`Exhausted`] where the budget is too small for it.
    pub fn recip(&self, budget: &Budget) -> Result<Option<Self>, Exhausted> {
        if self.is_zero() {
            return Ok(None);
        }
        let mut numerator = Polynomial::constant(Rational::ONE);
        for (factor, exponent) in &self.denominator {
            numerator = numerator.mul(&factor.pow(*exponent, budget)?, budget)?;
        }
        let content = self.numerator.content();
        let monomial = self.numerator.monomial_content();
        let inverse = content.recip().unwrap_or(Rational::ONE);
        let rest = self.numerator.strip(&monomial).scale(&inverse);
        let mut denominator: BTreeMap<Polynomial, u32> = monomial
            .powers()
            .map(|(v, e)| (Polynomial::variable(v), e))
            .collect();
        if rest.as_constant().is_none() {
            denominator.insert(rest, 1);
        }
        Ok(Some(Self {
            numerator: numerator.scale(&inverse),
            denominator,
        }))
    }

    /// The quotient; `None` for a zero divisor.
    ///
    /// # Errors
    /// [`Exhausted`] where the budget is too small for it.
    pub fn div(&self, other: &Self, budget: &Budget) -> Result<Option<Self>, Exhausted> {
        other
            .recip(budget)?
            .map(|inverse| self.mul(&inverse, budget))
            .transpose()
    }

    /// `self^exponent`; `None` for a negative power of zero.
    ///
    /// # Errors
    /// [`Exhausted`] where the budget is too small for it.
    pub fn pow(&self, exponent: i32, budget: &Budget) -> Result<Option<Self>, Exhausted> {
        let base = if exponent < 0 {
            self.recip(budget)?
        } else {
            Some(self.clone())
        };
        let Some(base) = base else { return Ok(None) };
        let exponent = exponent.unsigned_abs();
        let numerator = base.numerator.pow(exponent, budget)?;
        let mut denominator = base.denominator;
        if exponent == 0 {
            denominator.clear();
        }
        for e in denominator.values_mut() {
            *e = e.checked_mul(exponent).ok_or(Exhausted)?;
        }
        Ok(Some(Self {
            numerator,
            denominator,
        }))
    }

    /// Whether both are the same function.
    ///
    /// # Errors
    /// [`Exhausted`] where the budget is too small for the difference.
    pub fn equals(&self, other: &Self, budget: &Budget) -> Result<bool, Exhausted> {
        Ok(self.sub(other, budget)?.is_zero())
    }

    /// The value at a rational point; `None` where the denominator vanishes.
    pub fn evaluate(&self, point: &dyn Fn(usize) -> Rational) -> Option<Rational> {
        let mut value = self.numerator.evaluate(point);
        for (factor, exponent) in &self.denominator {
            let power = factor
                .evaluate(point)
                .recip()?
                .pow(i32::try_from(*exponent).ok()?)?;
            value = &value * &power;
        }
        Some(value)
    }

    /// An estimate of the work of [`Fraction::evaluate`] at numbers of so many bits.
    pub fn evaluation_work(&self, bits: u64) -> u64 {
        let work = |p: &Polynomial, exponent: u32| {
            let words =
                u64::from(p.degree().saturating_mul(exponent)).saturating_mul(bits) / 64 + 1;
            (p.terms().len() as u64)
                .saturating_mul(words)
                .saturating_mul(words)
        };
        let below = self
            .denominator
            .iter()
            .map(|(factor, exponent)| work(factor, *exponent));
        below.fold(work(&self.numerator, 1), u64::saturating_add)
    }

    /// The function as text.
    pub fn display(&self, name: &dyn Fn(usize) -> String) -> String {
        let bracketed = |p: &Polynomial| {
            let text = p.display(name);
            if p.terms().len() > 1 {
                format!("({text})")
            } else {
                text
            }
        };
        if self.denominator.is_empty() {
            return self.numerator.display(name);
        }
        let mut text = bracketed(&self.numerator);
        for (factor, exponent) in &self.denominator {
            text.push('/');
            text.push_str(&bracketed(factor));
            if *exponent > 1 {
                text.push_str(&format!("^{exponent}"));
            }
        }
        text
    }

    /// Divides numerator and denominator by the factors that they share.
    fn reduce(mut self, budget: &Budget) -> Result<Self, Exhausted> {
        if self.numerator.is_zero() {
            return Ok(Self::default());
        }
        if self.denominator.is_empty() {
            return Ok(self);
        }
        let monomial = self.numerator.monomial_content();
        let mut common = Monomial::default();
        for (v, e) in monomial.powers() {
            if let Some(exponent) = self.denominator.get_mut(&Polynomial::variable(v)) {
                let shared = e.min(*exponent);
                *exponent -= shared;
                common = common.mul(&Monomial::power(v, shared))?;
            }
        }
        self.numerator = self.numerator.strip(&common);
        for (factor, exponent) in &mut self.denominator {
            if factor.terms().len() == 1 {
                continue;
            }
            while *exponent > 0 && factor.degree() <= self.numerator.degree() {
                // what the division copies, whether or not it succeeds
                budget.spend(1 + self.numerator.terms().len() as u64 / 8)?;
                let Some(quotient) = self.numerator.divide_exactly(factor, budget)? else {
                    break;
                };
                self.numerator = quotient;
                *exponent -= 1;
            }
        }
        self.denominator.retain(|_, exponent| *exponent > 0);
        Ok(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name(v: usize) -> String {
        ["x", "y"][v].into()
    }

    #[test]
    fn field_axioms_hold() {
        let b = Budget::new(1_000_000);
        let (x, y) = (Fraction::variable(0), Fraction::variable(1));
        let one = Fraction::from(Rational::ONE);
        let sum = x.add(&y, &b).unwrap();
        // 1/(x+y) + x/(x+y) - (1+x)/(x+y) = 0
        let a = one.div(&sum, &b).unwrap().unwrap();
        let c = x.div(&sum, &b).unwrap().unwrap();
        let d = one.add(&x, &b).unwrap().div(&sum, &b).unwrap().unwrap();
        assert!(a.add(&c, &b).unwrap().equals(&d, &b).unwrap());
        assert!(!a.equals(&d, &b).unwrap());
        // (x^2 - y^2)/(x + y) = x - y, with nothing left below
        let squares = x
            .pow(2, &b)
            .unwrap()
            .unwrap()
            .sub(&y.pow(2, &b).unwrap().unwrap(), &b)
            .unwrap();
        let quotient = squares.div(&sum, &b).unwrap().unwrap();
        assert_eq!(quotient.display(&name), "x - y");
        // 1/x - 1/y = (y - x)/(x y)
        let e = x
            .recip(&b)
            .unwrap()
            .unwrap()
            .sub(&y.recip(&b).unwrap().unwrap(), &b)
            .unwrap();
        assert_eq!(e.display(&name), "(-x + y)/y/x");
        assert_eq!(e.recip(&b).unwrap().unwrap().display(&name), "-x*y/(x - y)");
        assert!(Fraction::default().recip(&b).unwrap().is_none());
        assert!(
            squares
                .pow(-3, &b)
                .unwrap()
                .unwrap()
                .mul(&squares.pow(3, &b).unwrap().unwrap(), &b)
                .unwrap()
                .equals(&one, &b)
                .unwrap()
        );
    }

    #[test]
    fn values_are_exact() {
        let b = Budget::new(1_000_000);
        let (x, y) = (Fraction::variable(0), Fraction::variable(1));
        let f = x.div(&x.sub(&y, &b).unwrap(), &b).unwrap().unwrap();
        let at = |p: i64, q: i64| f.evaluate(&move |v| Rational::from([p, q][v]));
        assert_eq!(at(3, 1), Rational::new(3, 2));
        assert_eq!(at(1, 1), None);
    }
}
