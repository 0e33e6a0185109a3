//! The float next to a quotient of big integers.

use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};

/// Correctly rounded quotient: scale to a 55-bit integer quotient with a sticky bit, then scale back.
pub(super) fn nearest(value: &BigRational) -> f64 {
    let (n, d) = (value.numer().magnitude(), value.denom().magnitude());
    if n.is_zero() {
        return 0.0;
    }
    // The quotient has 64 to 65 bits; one conversion rounds it, the sticky bit breaks ties rightly.
    let shift = 64 + d.bits() as i64 - n.bits() as i64;
    // Below the normal range fewer bits may stay, so that rounding happens once.
    let lost = (shift - (1074 + 2)).max(0);
    let shift = shift - lost;
    let (quotient, rest) = if shift >= 0 {
        (n << shift as u64).div_rem(d)
    } else {
        n.div_rem(&(d << (-shift) as u64))
    };
    let sticky = u128::from(!rest.is_zero());
    let quotient = (quotient.to_u128().unwrap_or(0) << 1) | sticky;
    let exponent = -(shift + 1);
    let magnitude = scale(quotient, exponent);
    if value.is_negative() {
        -magnitude
    } else {
        magnitude
    }
}

/// `mantissa * 2^exponent`, rounded once to nearest even.
fn scale(mantissa: u128, exponent: i64) -> f64 {
    if mantissa == 0 {
        return 0.0;
    }
    let bits = i64::from(128 - mantissa.leading_zeros());
    let top = bits + exponent; // the value lies in [2^(top-1), 2^top)
    if top > 1024 {
        return f64::INFINITY;
    }
    let keep = 53.min(top + 1074);
    if keep < 0 {
        return 0.0;
    }
    let drop = bits - keep;
    let (kept, exponent) = if drop <= 0 {
        (mantissa, exponent)
    } else {
        let half = 1u128 << (drop - 1);
        let mut kept = mantissa >> drop;
        let rest = mantissa & ((1u128 << drop) - 1);
        if rest > half || (rest == half && kept & 1 == 1) {
            kept += 1;
        }
        (kept, exponent + drop)
    };
    // `kept` has at most 54 bits (2^53 after a carry), hence both factors and the product are exact.
    let half = exponent / 2;
    kept as f64 * 2f64.powi(half as i32) * 2f64.powi((exponent - half) as i32)
}

#[cfg(test)]
mod tests {
    use super::super::Rational;
    use num_bigint::BigInt;

    #[test]
    fn floats_are_rounded_to_nearest() {
        for text in [
            "0.1",
            "1e-3",
            "123456789012345678901234567890",
            "4.9e-324",
            "2.3e-308",
            "1.7976931348623157e308",
        ] {
            let value: f64 = text.parse().unwrap();
            assert_eq!(Rational::from_f64(value).unwrap().to_f64(), value, "{text}");
        }
        let third = Rational::new(1, 3).unwrap();
        assert_eq!(third.to_f64(), 1.0 / 3.0);
        let n: BigInt = BigInt::from(10).pow(40) + 1;
        let r = Rational::from_big(n, BigInt::from(10).pow(41) * 3).unwrap();
        assert_eq!(r.to_f64(), 1.0 / 30.0);
        assert_eq!(Rational::from(10).pow(400).unwrap().to_f64(), f64::INFINITY);
        assert_eq!(Rational::from(10).pow(-400).unwrap().to_f64(), 0.0);
    }
}
