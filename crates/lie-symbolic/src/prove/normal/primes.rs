//! Small prime factors of rational numbers.

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Signed, Zero};

use crate::exact::Rational;

/// Primes below this are split off numbers under roots and logarithms.
const TRIAL_DIVISORS: u32 = 1000;

/// The factors of a positive rational with their exponents: small primes, and what is left.
pub(super) fn factors(value: &Rational) -> Vec<(BigInt, Rational)> {
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
