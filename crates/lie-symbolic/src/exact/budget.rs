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

    /// Takes the cost of one product or sum of coefficients away: common divisors take the square of the length.
    ///
    /// # Errors
    /// [`Exhausted`] where too little is left or the number is too long.
    pub fn spend_on(&self, value: &Rational) -> Result<(), Exhausted> {
        self.spend(1)?;
        self.spend_on_length(value.bits())
    }

    /// Takes away what the length of a coefficient adds to that cost: nothing of machine words.
    pub(super) fn spend_on_length(&self, bits: u64) -> Result<(), Exhausted> {
        let words = bits / 128;
        match bits > MAX_BITS {
            true => Err(Exhausted),
            false => self.spend(16 * words * words),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The greatest common divisor of numbers of w words takes the square of w.
    #[test]
    fn long_numbers_cost_the_square_of_their_length() {
        let cost = |exponent| {
            let budget = Budget::new(1 << 40);
            let value = Rational::from(2).pow(exponent).unwrap();
            budget.spend_on(&value).unwrap();
            (1 << 40) - budget.left()
        };
        assert_eq!(cost(60), 1);
        let (short, long) = (cost(128 * 10), cost(128 * 40));
        assert!((15..=17).contains(&(long / short)), "{short} {long}");
        let too_long = Rational::from(2).pow(70_000).unwrap();
        assert_eq!(Budget::new(1 << 60).spend_on(&too_long), Err(Exhausted));
    }
}
