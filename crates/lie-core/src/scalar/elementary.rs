//! Elementary functions of small angles, inlined, over one number or lanes alike.
//!
//! Steps turn by small angles: up to pi/4 they are polynomials or a quotient of polynomials here, beyond that those of
//! `libm`. Each is the same sequence of operations whatever the scalar, so that lanes have the bits of one number.
//!
//! Sine and cosine are those of `libm`, bit for bit (S. Moshier's and Sun's coefficients as in fdlibm's `k_sin.c` and
//! `k_cos.c`); the tangent is the quotient of S. Moshier's Cephes library (`tan.c`), with an error below 1.4 units in the
//! last place: 17 operations instead of 40; up to 1/16 a polynomial of 12 operations, without a division.

#[cfg(any(feature = "lanes", test))]
use super::Mask;
use super::Scalar;

/// Angles up to this are small: the double below pi/4.
const SMALL: f64 = core::f64::consts::FRAC_PI_4;
/// The tangent of an angle up to this is a polynomial.
const VERY_SMALL: f64 = 1.0 / 16.0;
/// The sine of an angle below this is the angle.
const TINY: f64 = 1.0 / 134_217_728.0;

/// The lanes in which an angle is small.
#[inline(always)]
pub(super) fn is_small<S: Scalar>(x: S) -> S::Mask {
    x.abs().less_equal(S::from_f64(SMALL))
}

/// Coefficients, highest first.
#[inline(always)]
fn polynomial<S: Scalar, const N: usize>(x: S, coefficients: [f64; N]) -> S {
    let mut value = S::from_f64(coefficients[0]);
    for &coefficient in &coefficients[1..] {
        value = value * x + S::from_f64(coefficient);
    }
    value
}

/// The sine of a small angle.
#[inline(always)]
pub(super) fn sin<S: Scalar>(x: S) -> S {
    let z = x * x;
    let low = polynomial(
        z,
        [
            2.755_731_370_707_006_8e-6,
            -1.984_126_982_985_795e-4,
            8.333_333_333_322_49e-3,
        ],
    );
    let high = polynomial(z, [1.589_690_995_211_55e-10, -2.505_076_025_340_686_3e-8]);
    let r = low + z * (z * z) * high;
    let sine = x + z * x * (S::from_f64(-0.166_666_666_666_666_32) + z * r);
    S::select(x.abs().less(S::from_f64(TINY)), x, sine)
}

/// The cosine of a small angle.
#[inline(always)]
pub(super) fn cos<S: Scalar>(x: S) -> S {
    let z = x * x;
    let w = z * z;
    let low = polynomial(
        z,
        [
            2.480_158_728_947_673e-5,
            -1.388_888_888_887_411e-3,
            0.041_666_666_666_666_6,
        ],
    );
    let high = polynomial(
        z,
        [
            -1.135_964_755_778_819_5e-11,
            2.087_572_321_298_175e-9,
            -2.755_731_435_139_066_3e-7,
        ],
    );
    let r = z * low + w * w * high;
    let half = S::from_f64(0.5) * z;
    let rest = S::one() - half;
    rest + (((S::one() - rest) - half) + z * r)
}

/// The tangent of a small angle.
#[cfg(any(feature = "lanes", test))]
#[inline(always)]
pub(super) fn tan<S: Scalar>(x: S) -> S {
    let very = is_very_small(x);
    let value = tan_polynomial(x);
    if very.all() {
        value
    } else {
        S::select(very, value, tan_quotient(x))
    }
}

/// The lanes in which the tangent is a polynomial.
#[inline(always)]
fn is_very_small<S: Scalar>(x: S) -> S::Mask {
    x.abs().less_equal(S::from_f64(VERY_SMALL))
}

/// The minimax polynomial of that degree for `|x| <= 1/16`, with a relative error of 2^-55.
#[inline(always)]
fn tan_polynomial<S: Scalar>(x: S) -> S {
    let z = x * x;
    let slope = polynomial(
        z,
        [
            0.021_954_092_633_481_01,
            0.053_967_976_048_537_35,
            0.133_333_333_692_985_45,
            0.333_333_333_333_188_7,
        ],
    );
    x + x * (z * slope)
}

#[inline(always)]
fn tan_quotient<S: Scalar>(x: S) -> S {
    let z = x * x;
    let numerator = polynomial(
        z,
        [
            -1.309_369_391_813_837_9e4,
            1.153_516_648_385_874_2e6,
            -1.795_652_519_764_848_8e7,
        ],
    );
    let denominator = polynomial(
        z,
        [
            1.0,
            1.368_129_634_706_929_5e4,
            -1.320_892_344_402_109_7e6,
            2.500_838_018_233_579e7,
            -5.386_957_559_294_546_5e7,
        ],
    );
    x + x * (z * numerator / denominator)
}

/// Functions of one number, which are those of `libm` beyond small angles.
pub(super) mod one {
    macro_rules! function {
        ($name:ident) => {
            #[inline]
            pub(in super::super) fn $name(x: f64) -> f64 {
                if super::is_small(x) {
                    super::$name(x)
                } else {
                    libm::$name(x)
                }
            }
        };
    }
    function!(sin);
    function!(cos);

    #[inline(always)]
    pub(in super::super) fn tan(x: f64) -> f64 {
        if super::is_very_small(x) {
            super::tan_polynomial(x)
        } else {
            tan_beyond(x)
        }
    }

    #[cold]
    #[inline(never)]
    fn tan_beyond(x: f64) -> f64 {
        if super::is_small(x) {
            super::tan_quotient(x)
        } else {
            libm::tan(x)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Angles of all sizes up to pi/4, and those where something may change.
    fn angles() -> impl Iterator<Item = f64> {
        let even = (0..20_000).map(|k| SMALL * f64::from(k) / 19_999.0);
        let small = (0..200).map(|k| 0.7 * 0.8_f64.powi(k));
        let edges = [TINY, SMALL, VERY_SMALL, f64::MIN_POSITIVE, 5e-324, 0.0].into_iter();
        even.chain(small).chain(edges).flat_map(|x| [x, -x])
    }

    #[test]
    fn sines_and_cosines_are_those_of_libm() {
        for x in angles() {
            assert!(is_small(x));
            assert_eq!(sin(x).to_bits(), libm::sin(x).to_bits(), "sin {x:e}");
            assert_eq!(cos(x).to_bits(), libm::cos(x).to_bits(), "cos {x:e}");
        }
    }

    #[test]
    fn tangents_err_by_little_more_than_a_unit_in_the_last_place() {
        let mut worst = 0.0;
        for x in angles() {
            let (value, expected) = (tan(x), libm::tan(x));
            assert_eq!(value.is_sign_negative(), x.is_sign_negative());
            let unit = f64::from_bits(expected.abs().to_bits() + 1) - expected.abs();
            worst = f64::max(worst, (value - expected).abs() / unit);
        }
        // libm's own is within one unit
        assert!(worst <= 1.0, "{worst}");
    }

    #[test]
    fn large_angles_are_those_of_libm() {
        for x in [0.79, 3.0, -1e5, 1e300] {
            assert_eq!(one::sin(x), libm::sin(x));
            assert_eq!(one::cos(x), libm::cos(x));
            assert_eq!(one::tan(x), libm::tan(x));
        }
        for x in [f64::NAN, f64::INFINITY] {
            assert!(one::tan(x).is_nan() && one::sin(x).is_nan() && one::cos(x).is_nan());
        }
    }
}
