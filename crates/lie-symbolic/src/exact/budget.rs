//! A bound on exact work, so that hostile input ends in a diagnostic instead of eating memory.

use std::cell::Cell;

use super::Rational;

/// The largest coefficient, numerator and denominator together.
const MAX_BITS: u64 = 1 << 16;

/// What is left of the work that a computation may do.
///
/// One unit is one product of two machine-word coefficients or one stored term.
#[derive(Debug)]
pub struct Budget(Cell<u64>);

/// The budget is spent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exhausted;

impl Budget {
    /// A budget of so many units.
    pub fn new(units: u64) -> Self {
        Self(Cell::new(units))
    }

    /// What is left.
    pub fn left(&self) -> u64 {
        self.0.get()
    }

    /// Takes units away.
    ///
    /// # Errors
    /// [`Exhausted`] where too few are left; then nothing is left.
    pub fn spend(&self, units: u64) -> Result<(), Exhausted> {
        let left = self.0.get().checked_sub(units);
        self.0.set(left.unwrap_or(0));
        left.map(drop).ok_or(Exhausted)
    }

    /// Takes the cost of one product of coefficients away.
    ///
    /// # Errors
    /// [`Exhausted`] where too little is left or the number is too long.
    pub fn spend_on(&self, product: &Rational) -> Result<(), Exhausted> {
        let bits = product.bits();
        if bits > MAX_BITS {
            Err(Exhausted)
        } else {
            self.spend(1 + bits / 64)
        }
    }
}
