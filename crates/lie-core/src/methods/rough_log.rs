//! Logarithms to base 2 and powers of two, to a few digits and the same on every machine. As integers, logarithms of powers of
//! two add to others exactly.

/// 1 as a logarithm in integers.
pub(super) const ONE: f64 = (1_u64 << FRACTION) as f64;
const FRACTION: u32 = 40;

/// The logarithm of a mantissa above 1 and the power of 2 of a part of 1, as polynomials without their first terms.
const OF_MANTISSA: [f64; 3] = [1.418_15, -0.578_51, 0.160_36];
const OF_POWER: [f64; 3] = [0.695_56, 0.226_17, 0.078_27];

/// The logarithm to base 2 of a positive number to about three digits, the same on every machine.
pub(super) fn log2(x: f64) -> f64 {
    let bits = x.to_bits();
    let exponent = (bits >> 52) as f64 - 1023.0;
    exponent + of_mantissa(bits)
}

/// The part of a logarithm that is below 1.
fn of_mantissa(bits: u64) -> f64 {
    let mantissa = f64::from_bits((bits & ((1 << 52) - 1)) | (1023 << 52));
    // through 1, sqrt(2) and 2, and a symmetric correction
    let m = mantissa - 1.0;
    let [a, b, c] = OF_MANTISSA;
    m * (a + m * (b + m * c))
}

/// The same logarithm in units of 2^-40, of numbers below the normal ones too; none of 0.
pub(super) fn binary_log(x: f64) -> Option<i64> {
    if x.is_nan() || x <= 0.0 {
        return None;
    }
    let (x, shift) = match x.is_normal() {
        true => (x, 0),
        false => (x * power_of_two(64), 64),
    };
    let bits = x.to_bits();
    let exponent = (bits >> 52) as i64 - 1023 - shift;
    Some((exponent << FRACTION) + (of_mantissa(bits) * ONE) as i64)
}

/// The integer nearest to such a logarithm.
pub(super) fn rounded(log: i64) -> i64 {
    (log + (1 << (FRACTION - 1))) >> FRACTION
}

/// `2^exponent`, for exponents of normal numbers.
pub(super) fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((i64::from(exponent) + 1023) as u64) << 52)
}

/// The power of 2 of such a logarithm to about four digits, the same on every machine; 0 or infinite beyond the range of
/// normal numbers.
pub(super) fn exp2(log: i64) -> f64 {
    let below = log >> FRACTION;
    if below >= 1023 {
        return f64::INFINITY;
    }
    if below < -1022 {
        return 0.0;
    }
    let f = (log - (below << FRACTION)) as f64 / ONE;
    let [a, b, c] = OF_POWER;
    let mantissa = 1.0 + f * (a + f * (b + f * c));
    mantissa * power_of_two(below as i32)
}

/// Whole numbers in double precision, below 2^51 in magnitude: what [`binary_log`] and [`exp2`] do with integers, over lanes and for programs.
pub(crate) mod whole {
    use super::{FRACTION, ONE};
    use crate::scalar::Primitive;

    const MANTISSA: u64 = (1 << 52) - 1;
    const EXPONENT_OF_ONE: u64 = 1023 << 52;
    /// A whole number below 2^52 stands in the last bits of its sum with this.
    const CARRIER: f64 = (1_u64 << 52) as f64;
    /// Added and taken away again, it leaves the nearest whole number.
    const ROUNDING: f64 = 1.5 * CARRIER;

    /// The largest whole number up to x.
    pub(crate) fn floor<P: Primitive>(x: P) -> P {
        let nearest = (x + P::number(ROUNDING)) - P::number(ROUNDING);
        P::blend(x - nearest, nearest - P::number(1.0), nearest)
    }

    /// The largest whole number up to the quotient of two whole numbers, the second of which is small and positive.
    pub(crate) fn quotient<P: Primitive>(x: P, by: usize) -> P {
        let (by, one) = (P::number(by as f64), P::number(1.0));
        let near = floor(x / by);
        let rest = x - near * by;
        let near = P::blend(rest, near - one, near);
        P::blend(rest - by, near, near + one)
    }

    /// [`binary_log`](super::binary_log) of a normal number above 0.
    pub(crate) fn binary_log<P: Primitive>(x: P) -> P {
        let carried = x.right(52).or(P::number(CARRIER));
        let exponent = carried - P::number(CARRIER + 1023.0);
        let mantissa = x
            .and(P::from_word(MANTISSA))
            .or(P::from_word(EXPONENT_OF_ONE));
        let m = mantissa - P::number(1.0);
        let [a, b, c] = super::OF_MANTISSA.map(P::number);
        exponent * P::number(ONE) + floor(m * (a + m * (b + m * c)) * P::number(ONE))
    }

    /// [`rounded`](super::rounded).
    pub(crate) fn rounded<P: Primitive>(log: P) -> P {
        let half = (1_u64 << (FRACTION - 1)) as f64;
        floor((log + P::number(half)) * P::number(1.0 / ONE))
    }

    /// [`exp2`](super::exp2) within the range of normal numbers, and the largest whole number up to the logarithm.
    pub(crate) fn exp2<P: Primitive>(log: P) -> [P; 2] {
        let below = floor(log * P::number(1.0 / ONE));
        let f = (log - below * P::number(ONE)) * P::number(1.0 / ONE);
        let [a, b, c] = super::OF_POWER.map(P::number);
        let mantissa = P::number(1.0) + f * (a + f * (b + f * c));
        let power = (below + P::number(CARRIER + 1023.0)).left(52);
        [mantissa * power, below]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same numbers by both, for all sizes of what they are of.
    #[test]
    fn whole_numbers_are_those_of_integers() {
        let mut bits = 0x9e37_79b9_7f4a_7c15_u64;
        for k in 0..200_000_u64 {
            bits = bits
                .wrapping_mul(0x5851_f42d_4c95_7f2d)
                .wrapping_add(2 * k + 1);
            let x = f64::from_bits(bits >> 1);
            if !x.is_normal() {
                continue;
            }
            let log = binary_log(x).expect("positive");
            assert_eq!(whole::binary_log(x), log as f64, "{x:e}");
            assert_eq!(whole::rounded(log as f64), rounded(log) as f64);
            for by in 1..=40 {
                let exact = log.div_euclid(by) as f64;
                assert_eq!(
                    whole::quotient(log as f64, by as usize),
                    exact,
                    "{log} {by}"
                );
            }
            let [power, below] = whole::exp2(log as f64);
            assert_eq!(below, (log >> FRACTION) as f64);
            if below < 1023.0 {
                assert_eq!(power.to_bits(), exp2(log).to_bits(), "{log}");
            }
        }
        for (x, by) in [
            (-12, 4),
            (-13, 4),
            (-11, 4),
            (11, 4),
            (12, 4),
            (0, 7),
            (-1, 40),
        ] {
            let exact = i64::from(x).div_euclid(by) as f64;
            assert_eq!(
                whole::quotient(f64::from(x), by as usize),
                exact,
                "{x} {by}"
            );
        }
    }

    #[test]
    fn rough_logarithms_and_powers() {
        for k in -2000..2000 {
            let x = f64::from(k) * 0.37;
            let y = libm::exp2(x);
            let close = |log: i64, x: f64| (log as f64 / ONE - x).abs() < 5e-3;
            if y.is_normal() {
                assert!((exp2((x * ONE) as i64) / y - 1.0).abs() < 1e-3, "{x}");
                assert!((log2(y) - x).abs() < 5e-3, "{x}: {}", log2(y) - x);
            }
            if y > 1e-320 && y.is_finite() {
                let log = binary_log(y).expect("positive");
                assert!(close(log, x), "{x}: {log}");
                // powers of two add, exactly
                let other = binary_log(y * 16.0).unwrap_or(0);
                assert!(!y.is_normal() || y > 1e300 || other == log + (4 << FRACTION));
            }
        }
        assert_eq!(exp2(2000 << FRACTION), f64::INFINITY);
        assert_eq!(exp2(-2000 << FRACTION), 0.0);
        assert_eq!([0.0, f64::NAN].map(binary_log), [None; 2]);
        assert_eq!([-7, 7, 9].map(|x| rounded(x << (FRACTION - 2))), [-2, 2, 2]);
    }
}
