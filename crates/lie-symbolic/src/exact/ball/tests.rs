use super::*;
use lie_core::Elementary;

/// The value of a line of `values.txt`, which `lab/tools/ball_values.py` writes by mpmath.
fn value(name: &str, x: &[Ball], p: &Precision) -> Option<Ball> {
    match name {
        "sqrt" => x[0].sqrt(p),
        "cuberoot" => x[0].power(&Rational::new(1, 3)?, p),
        "atan2" => x[0].atan2(&x[1], p),
        _ => x[0].function(Elementary::from_name(name)?, p),
    }
}

fn rational(text: &str) -> Rational {
    let (n, d) = text.split_once('/').unwrap();
    Rational::from_big(n.parse().unwrap(), d.parse().unwrap()).unwrap()
}

/// A decimal fraction, exactly.
fn decimal(text: &str) -> Rational {
    let (whole, part) = text.split_once('.').unwrap();
    let digits: BigInt = format!("{whole}{part}").parse().unwrap();
    Rational::from_big(digits, BigInt::from(10).pow(part.len() as u32)).unwrap()
}

#[test]
fn values_are_those_of_mpmath() {
    for bits in [80, 224] {
        let p = Precision::new(bits);
        for line in include_str!("values.txt").lines() {
            let (call, expected) = line.split_once(" = ").unwrap();
            let mut words = call.split(' ');
            let name = words.next().unwrap();
            let x: Vec<Ball> = words.map(|word| p.rational(&rational(word))).collect();
            let found = value(name, &x, &p).unwrap_or_else(|| panic!("{line}"));
            let wide = Precision::new(320);
            let difference = found.sub(&wide.rational(&decimal(expected)), &wide);
            // the true value is in the ball, up to the digits of the table
            let slack = wide.rational(&decimal(expected)).magnitude() - 290;
            assert!(
                !difference.widened(slack, &wide).excludes_zero(),
                "{line}: {found:?}"
            );
            // and the ball is narrow; near a zero of sine the digits of pi are lost
            let width = found.radius.bits() as i64 + found.exponent;
            let scale = found.magnitude().max(-60);
            assert!(width < scale - bits as i64 + 30, "{line}: {found:?}");
        }
    }
}

#[test]
fn what_may_be_undefined_has_no_value() {
    let p = Precision::new(128);
    let (zero, one, wide) = (
        Ball::integer(0),
        Ball::integer(1),
        Ball::dyadic(1, -100).widened(-99, &p),
    );
    assert!(wide.sign().is_none() && !wide.excludes_zero());
    for ball in [&zero, &wide, &one.neg()] {
        assert!(ball.log(&p).is_none());
    }
    assert!(wide.sqrt(&p).is_none() && one.neg().sqrt(&p).is_none());
    assert!(wide.recip(&p).is_none() && zero.recip(&p).is_none());
    assert!(Ball::integer(2).asin(&p).is_none());
    assert!(zero.acosh(&p).is_none() && Ball::integer(2).atanh(&p).is_none());
    assert!(one.atanh(&p).is_none() && one.neg().atanh(&p).is_none());
    assert!(one.neg().log1p(&p).is_none() && wide.cbrt(&p).is_none());
    assert_eq!(one.acosh(&p).unwrap().sign(), Some(0));
    assert!(wide.atan2(&one.neg(), &p).is_none() && zero.atan2(&zero, &p).is_none());
    assert!(Ball::dyadic(1, 60).sin_cos(&p).is_none());
    assert_eq!(zero.sqrt(&p).unwrap().sign(), Some(0));
    let pi = zero.atan2(&one.neg(), &p).unwrap();
    assert!(!pi.sub(&p.pi(), &p).excludes_zero());
    assert!((one.asin(&p).unwrap().to_f64() - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
}

#[test]
fn balls_contain_what_their_members_become() {
    // (x + y)^2 - x^2 - 2 x y - y^2 = 0 and log(exp x) = x, for balls of any width
    for power in [-200, -60, -20] {
        let p = Precision::new(160);
        let x = Ball::dyadic(7, -3).widened(power, &p);
        let y = Ball::dyadic(-5, -4).widened(power, &p);
        let left = x.add(&y, &p).powi(2, &p).unwrap();
        let cross = x.mul(&y, &p).shifted(1);
        let right = x.mul(&x, &p).add(&cross, &p).add(&y.mul(&y, &p), &p);
        assert!(!left.sub(&right, &p).excludes_zero());
        let back = x.exp(&p).unwrap().log(&p).unwrap();
        assert!(!back.sub(&x, &p).excludes_zero());
        // a difference beyond the width is seen
        let far = x.add(&Ball::dyadic(1, power.max(-140) + 4), &p);
        assert!(
            far.exp(&p)
                .unwrap()
                .sub(&x.exp(&p).unwrap(), &p)
                .excludes_zero()
        );
    }
}
