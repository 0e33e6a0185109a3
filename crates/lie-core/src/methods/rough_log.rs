//! Logarithms to base 2 and powers of two, to a few digits and the same on every machine. As integers, logarithms of powers of
//! two add to others exactly.

/// 1 as a logarithm in integers.
pub(super) const ONE: f64 = (1_u64 << FRACTION) as f64;
const FRACTION: u32 = 40;

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
    m * (1.418_15 + m * (-0.578_51 + m * 0.160_36))
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
    let mantissa = 1.0 + f * (0.695_56 + f * (0.226_17 + f * 0.078_27));
    mantissa * power_of_two(below as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

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
