use super::*;

/// Angles of all sizes up to pi/4, and those where something may change.
fn small_angles() -> impl Iterator<Item = f64> {
    let even = (0..20_000).map(|k| SMALL * f64::from(k) / 19_999.0);
    let small = (0..200).map(|k| 0.7 * 0.8_f64.powi(k));
    let edges = [TINY, SMALL, VERY_SMALL, f64::MIN_POSITIVE, 5e-324, 0.0].into_iter();
    even.chain(small).chain(edges).flat_map(|x| [x, -x])
}

/// Numbers by lot, of all sizes up to two to that power.
fn by_lot(count: u32, power: i32) -> impl Iterator<Item = f64> {
    let mut word = 0x9e37_79b9_7f4a_7c15_u64;
    (0..count).map(move |_| {
        word = word.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        let size = (word >> 40) as i32 % (power + 20) - 20;
        let part = 1.0 + (word >> 12) as f64 / (1_u64 << 52) as f64;
        let sign = if word & 1 == 0 { 1.0 } else { -1.0 };
        sign * part * 2.0_f64.powi(size)
    })
}

/// The distance in units of the last place of the second, which is of normal size.
fn units(found: f64, expected: f64) -> f64 {
    let size = expected.abs();
    (found - expected).abs() / (f64::from_bits(size.to_bits() + 1) - size)
}

#[test]
fn small_sines_and_cosines_are_those_of_libm() {
    for x in small_angles() {
        assert!(is_small(x));
        for sine in [small::sin(x), sin(x)] {
            assert_eq!(sine.to_bits(), libm::sin(x).to_bits(), "sin {x:e}");
        }
        for cosine in [small::cos(x), cos(x)] {
            assert_eq!(cosine.to_bits(), libm::cos(x).to_bits(), "cos {x:e}");
        }
    }
}

#[test]
fn logarithms_are_those_of_libm() {
    let edges = [
        0.0,
        -0.0,
        5e-324,
        f64::MIN_POSITIVE,
        f64::MAX,
        -1.0,
        f64::INFINITY,
        f64::NEG_INFINITY,
    ];
    let near_one = (0..1000_u64).map(|k| f64::from_bits(1.0_f64.to_bits() - 500 + k));
    for x in by_lot(100_000, 1000).chain(near_one).chain(edges) {
        let (found, expected) = (log(x), libm::log(x));
        let are_none = found.is_nan() && expected.is_nan();
        assert!(
            are_none || found.to_bits() == expected.to_bits(),
            "log {x:e}"
        );
    }
    assert!(log(f64::NAN).is_nan());
}

#[test]
fn tangents_err_by_little_more_than_a_unit_in_the_last_place() {
    let mut worst = 0.0;
    for x in small_angles() {
        let (value, expected) = (small::tan(x), libm::tan(x));
        assert_eq!(value.to_bits(), tan(x).to_bits(), "{x:e}");
        assert_eq!(value.is_sign_negative(), x.is_sign_negative());
        worst = f64::max(worst, units(value, expected));
    }
    // libm's own is within one unit
    assert!(worst <= 1.0, "{worst}");
}

/// `libm` errs by less than a unit, programs by 0.6 of it: they differ by one at most, and seldom.
#[test]
fn programs_are_within_a_unit_of_libm() {
    let large = (1..200_000).map(|k| f64::from(k) * core::f64::consts::FRAC_PI_2);
    let (mut all, mut differ) = (0, 0);
    let mut compare = |name: &str, x: f64, found: f64, expected: f64| {
        let distance = units(found, expected);
        assert!(distance <= 1.0, "{name} {x:e}: {found:e} {expected:e}");
        all += 1;
        differ += u32::from(distance > 0.0);
    };
    for x in by_lot(100_000, 18).chain(large) {
        compare("sin", x, sin(x), libm::sin(x));
        compare("cos", x, cos(x), libm::cos(x));
        if x.abs() < 708.0 {
            compare("exp", x, exp(x), libm::exp(x));
        }
    }
    assert!(differ > 0 && differ * 10 < all, "{differ} of {all}");
}

#[test]
fn limits_are_exact() {
    for function in [sin, tan] {
        for zero in [0.0, -0.0] {
            assert_eq!(function(zero).to_bits(), zero.to_bits());
        }
    }
    assert_eq!([cos(0.0), cos(-0.0), exp(0.0), exp(-0.0)], [1.0; 4]);
    assert_eq!(log(1.0).to_bits(), 0);
    assert_eq!(exp(f64::NEG_INFINITY).to_bits(), 0);
    assert_eq!(exp(-745.2), 0.0);
    assert_eq!(exp(-745.1), 5e-324);
    assert_eq!(exp(709.8), f64::INFINITY);
    assert!(exp(709.7).is_finite() && exp(f64::NAN).is_nan());
    assert_eq!(exp(f64::INFINITY), f64::INFINITY);
    for x in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(sin(x).is_nan() && cos(x).is_nan() && tan(x).is_nan());
    }
    for x in by_lot(10_000, 25) {
        assert_eq!(sin(-x).to_bits(), (-sin(x)).to_bits(), "{x:e}");
        assert_eq!(cos(-x).to_bits(), cos(x).to_bits(), "{x:e}");
    }
    for x in [4.1e5, -1e6, 1e300] {
        assert_eq!([sin(x), cos(x)], [libm::sin(x), libm::cos(x)]);
    }
}

/// Where angles are small, what is left out changes nothing.
#[test]
fn one_number_has_the_bits_of_the_program() {
    for x in small_angles().chain(by_lot(10_000, 25)) {
        assert_eq!(one::sin(x).to_bits(), sin(x).to_bits(), "{x:e}");
        assert_eq!(one::cos(x).to_bits(), cos(x).to_bits(), "{x:e}");
        assert_eq!(one::tan(x).to_bits(), tan(x).to_bits(), "{x:e}");
        assert_eq!(one::sin_cos(x), (one::sin(x), one::cos(x)), "{x:e}");
    }
}

#[cfg(feature = "lanes")]
#[test]
fn lanes_have_the_bits_of_one_number() {
    use super::super::F64x8;
    let special = [f64::NAN, f64::INFINITY, -0.0, 5e-324, 1e300, -709.0, 4.1e5];
    let usual = by_lot(8_000, 9);
    let lists: Vec<f64> = special.into_iter().chain(usual).collect();
    for eight in lists.chunks_exact(8) {
        let eight: [f64; 8] = eight.try_into().unwrap();
        for &function in Elementary::ALL {
            let lanes = function.apply(F64x8::new(eight)).to_array();
            for (x, found) in eight.into_iter().zip(lanes) {
                let expected = function.apply(x);
                let are_none = found.is_nan() && expected.is_nan();
                let same = are_none || found.to_bits() == expected.to_bits();
                assert!(same, "{function:?} {x:e}: {found:e} {expected:e}");
                let program = function.program(x);
                let same = |y: f64| y.to_bits() == expected.to_bits() || (y.is_nan() && are_none);
                assert!(program.is_none_or(same), "{function:?} {x:e}");
            }
        }
    }
}
