//! What the identities of a Lie algebra need of their coefficients.

use num_bigint::BigInt;
use num_traits::{One, Zero};

use lie_symbolic::exact::{Budget, Exhausted, Fraction, Rational};

/// Exact coefficients: integers or rationals where no parameter occurs (fast), rational
/// functions otherwise.
pub trait Ring: Clone {
    /// Zero.
    fn zero() -> Self;
    /// Whether the value is (identically) zero.
    fn is_zero(&self) -> bool;
    /// `-self`.
    fn negative(&self) -> Self;
    /// `self += a * b`.
    ///
    /// # Errors
    /// [`Exhausted`] where the budget is too small for it.
    fn add_product(&mut self, a: &Self, b: &Self, budget: &Budget) -> Result<(), Exhausted>;
    /// As a rational function.
    fn to_fraction(&self) -> Fraction;
}

impl Ring for Rational {
    fn zero() -> Self {
        Self::ZERO
    }
    fn is_zero(&self) -> bool {
        self.is_zero()
    }
    fn negative(&self) -> Self {
        -self
    }
    fn add_product(&mut self, a: &Self, b: &Self, budget: &Budget) -> Result<(), Exhausted> {
        let product = a * b;
        budget.spend_on(&product)?;
        *self = &*self + &product;
        Ok(())
    }
    fn to_fraction(&self) -> Fraction {
        self.clone().into()
    }
}

impl Ring for BigInt {
    fn zero() -> Self {
        Self::ZERO
    }
    fn is_zero(&self) -> bool {
        Zero::is_zero(self)
    }
    fn negative(&self) -> Self {
        -self
    }
    fn add_product(&mut self, a: &Self, b: &Self, budget: &Budget) -> Result<(), Exhausted> {
        let product = a * b;
        budget.spend(1 + product.bits() / 64)?;
        *self += product;
        Ok(())
    }
    fn to_fraction(&self) -> Fraction {
        Rational::from_big(self.clone(), One::one())
            .unwrap_or(Rational::ZERO)
            .into()
    }
}

impl Ring for Fraction {
    fn zero() -> Self {
        Self::default()
    }
    fn is_zero(&self) -> bool {
        self.is_zero()
    }
    fn negative(&self) -> Self {
        self.neg()
    }
    fn add_product(&mut self, a: &Self, b: &Self, budget: &Budget) -> Result<(), Exhausted> {
        *self = self.add(&a.mul(b, budget)?, budget)?;
        Ok(())
    }
    fn to_fraction(&self) -> Fraction {
        self.clone()
    }
}
