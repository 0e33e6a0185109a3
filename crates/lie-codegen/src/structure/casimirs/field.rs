//! The fields over which invariants are looked for: modulo a prime, and rational functions of the parameters.

use lie_symbolic::exact::{Budget, Exhausted, Fraction, Polynomial, Rational};
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::ToPrimitive;

/// Primes below 2^61, the largest first. Modulo the first, a Mersenne prime, products are cheap.
pub const PRIMES: [u64; 6] = [
    (1 << 61) - 1,
    (1 << 61) - 31,
    (1 << 61) - 45,
    (1 << 61) - 229,
    (1 << 61) - 259,
    (1 << 61) - 283,
];

/// A field whose operations are counted.
pub trait Field {
    /// Its elements.
    type Value: Clone;
    /// Zero.
    fn zero(&self) -> Self::Value;
    /// Whether a value is zero.
    fn is_zero(&self, value: &Self::Value) -> bool;
    /// An integer.
    fn integer(&self, value: i64) -> Self::Value;
    /// The sum.
    fn sum(&self, a: &Self::Value, b: &Self::Value) -> Result<Self::Value, Exhausted>;
    /// `-a`.
    fn negative(&self, a: &Self::Value) -> Self::Value;
    /// The product.
    fn product(&self, a: &Self::Value, b: &Self::Value) -> Result<Self::Value, Exhausted>;
    /// The inverse of what is not zero.
    fn inverse(&self, a: &Self::Value) -> Result<Self::Value, Exhausted>;
    /// What the operations are counted by.
    fn budget(&self) -> &Budget;
}

/// The integers modulo a prime.
pub struct Prime<'a> {
    /// The prime.
    pub prime: u64,
    /// What the operations are counted by; a product is counted by whoever makes many.
    pub budget: &'a Budget,
}

impl Prime<'_> {
    /// The value of a rational number; `None` where the prime divides its denominator.
    pub fn rational(&self, value: &Rational) -> Option<u64> {
        let (numerator, denominator) = match value.to_words() {
            Some((n, d)) => (self.word(n), self.word(d)),
            None => {
                let big = value.to_big();
                (self.big(big.numer()), self.big(big.denom()))
            }
        };
        match denominator {
            0 => None,
            1 => Some(numerator),
            _ => Some(self.times(numerator, self.inverted(denominator))),
        }
    }

    /// The value of a rational function at a point; `None` at a pole.
    pub fn fraction(&self, value: &Fraction, point: &dyn Fn(usize) -> u64) -> Option<u64> {
        let polynomial = |p: &Polynomial| {
            let mut sum = 0;
            for (monomial, coefficient) in p.terms() {
                let mut term = self.rational(coefficient)?;
                for (v, e) in monomial.powers() {
                    term = self.times(term, self.raised(point(v), u64::from(e)));
                }
                sum = self.plus(sum, term);
            }
            Some(sum)
        };
        let mut result = polynomial(value.numerator())?;
        for (factor, exponent) in value.denominator() {
            let below = polynomial(factor)?;
            if below == 0 {
                return None;
            }
            result = self.times(
                result,
                self.raised(self.inverted(below), u64::from(exponent)),
            );
        }
        Some(result)
    }

    fn word(&self, word: i64) -> u64 {
        let size = word.unsigned_abs() % self.prime;
        if word < 0 && size > 0 {
            self.prime - size
        } else {
            size
        }
    }

    fn big(&self, value: &BigInt) -> u64 {
        value
            .mod_floor(&BigInt::from(self.prime))
            .to_u64()
            .unwrap_or(0)
    }

    /// The sum.
    pub fn plus(&self, a: u64, b: u64) -> u64 {
        let sum = a + b;
        if sum >= self.prime {
            sum - self.prime
        } else {
            sum
        }
    }

    /// The product.
    pub fn times(&self, a: u64, b: u64) -> u64 {
        let product = u128::from(a) * u128::from(b);
        if self.prime == PRIMES[0] {
            // 2^61 = 1: the upper bits count as lower ones
            let sum = (product as u64 & PRIMES[0]) + (product >> 61) as u64;
            if sum >= PRIMES[0] {
                sum - PRIMES[0]
            } else {
                sum
            }
        } else {
            (product % u128::from(self.prime)) as u64
        }
    }

    fn raised(&self, mut square: u64, mut exponent: u64) -> u64 {
        let mut result = 1;
        while exponent > 0 {
            if exponent & 1 == 1 {
                result = self.times(result, square);
            }
            square = self.times(square, square);
            exponent >>= 1;
        }
        result
    }

    fn inverted(&self, a: u64) -> u64 {
        self.raised(a, self.prime - 2)
    }
}

impl Field for Prime<'_> {
    type Value = u64;
    fn zero(&self) -> u64 {
        0
    }
    fn is_zero(&self, value: &u64) -> bool {
        *value == 0
    }
    fn integer(&self, value: i64) -> u64 {
        self.word(value)
    }
    fn sum(&self, a: &u64, b: &u64) -> Result<u64, Exhausted> {
        Ok(self.plus(*a, *b))
    }
    fn negative(&self, a: &u64) -> u64 {
        if *a == 0 { 0 } else { self.prime - a }
    }
    fn product(&self, a: &u64, b: &u64) -> Result<u64, Exhausted> {
        Ok(self.times(*a, *b))
    }
    fn inverse(&self, a: &u64) -> Result<u64, Exhausted> {
        self.budget.spend(60)?;
        Ok(self.inverted(*a))
    }
    fn budget(&self) -> &Budget {
        self.budget
    }
}

/// What an operation with rational functions takes, in operations modulo a prime.
const OPERATION: u64 = 64;

/// The rational functions of the parameters.
pub struct Functions<'a> {
    /// What the operations are counted by.
    pub budget: &'a Budget,
}

impl Field for Functions<'_> {
    type Value = Fraction;
    fn zero(&self) -> Fraction {
        Fraction::default()
    }
    fn is_zero(&self, value: &Fraction) -> bool {
        value.is_zero()
    }
    fn integer(&self, value: i64) -> Fraction {
        Rational::from(value).into()
    }
    fn sum(&self, a: &Fraction, b: &Fraction) -> Result<Fraction, Exhausted> {
        let (p, q) = (a.numerator().terms().len(), b.numerator().terms().len());
        self.budget.spend(OPERATION + 32 * (p + q) as u64)?;
        a.add(b, self.budget)
    }
    fn negative(&self, a: &Fraction) -> Fraction {
        a.neg()
    }
    fn product(&self, a: &Fraction, b: &Fraction) -> Result<Fraction, Exhausted> {
        let (p, q) = (a.numerator().terms().len(), b.numerator().terms().len());
        self.budget.spend(OPERATION + 32 * (p * q) as u64)?;
        a.mul(b, self.budget)
    }
    fn inverse(&self, a: &Fraction) -> Result<Fraction, Exhausted> {
        Ok(a.recip(self.budget)?.unwrap_or_default())
    }
    fn budget(&self) -> &Budget {
        self.budget
    }
}

/// A number of the prime field for the variable with a number; the same in every run.
pub fn drawn(index: usize) -> u64 {
    let mut z = (index as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (z ^ (z >> 31)) % PRIMES[0]
}
