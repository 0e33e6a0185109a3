//! Power series with bounds of what is left out.

use super::{Ball, Precision};

/// `sum_k sign^k x^(2k+1)/(2k+1)` for `|x| < 1/2`: atan for the sign -1, artanh for 1.
pub(super) fn odd_powers(x: &Ball, sign: i64, precision: &Precision) -> Option<Ball> {
    if x.magnitude() > -1 && !x.is_exact_zero() {
        return None;
    }
    let square = x.mul(x, precision);
    let mut power = x.clone();
    let mut sum = Ball::integer(0);
    let enough = x.magnitude() - precision.bits as i64 - 4;
    for k in 0i64.. {
        if power.magnitude() < enough || power.is_exact_zero() {
            break;
        }
        let term = power.div(&Ball::integer(2 * k + 1), precision)?;
        sum = sum.add(&term, precision);
        power = power.mul(&square, precision);
        if sign < 0 {
            power = power.neg();
        }
    }
    // the rest is less than |power|/(1 - x^2), at most twice the first term that is left out
    let rest = power.magnitude() + 1;
    Some(if power.is_exact_zero() {
        sum
    } else {
        sum.widened(rest, precision)
    })
}

/// `sum_k x^(2k + first) sign^k/(2k + first)!` for `|x| < 2`: sin, cos, sinh, cosh.
pub(super) fn factorial(x: &Ball, first: i64, sign: i64, precision: &Precision) -> Option<Ball> {
    let square = x.mul(x, precision);
    let mut term = if first == 0 {
        Ball::integer(1)
    } else {
        x.clone()
    };
    let mut sum = Ball::integer(0);
    let enough = term.magnitude() - precision.bits as i64 - 4;
    let mut k = first;
    while !term.is_exact_zero() && term.magnitude() >= enough {
        sum = sum.add(&term, precision);
        term = term
            .mul(&square, precision)
            .div(&Ball::integer(sign * (k + 1) * (k + 2)), precision)?;
        k += 2;
    }
    // the terms fall faster than a geometric series of ratio 1/2
    let rest = term.magnitude() + 1;
    Some(if term.is_exact_zero() {
        sum
    } else {
        sum.widened(rest, precision)
    })
}

/// `pi = 16 atan(1/5) - 4 atan(1/239)`
pub(super) fn pi(precision: &Precision) -> Ball {
    combination(&[(16, 5), (-4, 239)], -1, precision)
}

/// `log 2 = 18 artanh(1/26) - 2 artanh(1/4801) + 8 artanh(1/8749)`
pub(super) fn log_two(precision: &Precision) -> Ball {
    combination(&[(18, 26), (-2, 4801), (8, 8749)], 1, precision)
}

fn combination(terms: &[(i64, i64)], sign: i64, precision: &Precision) -> Ball {
    let mut sum = Ball::integer(0);
    for (factor, divisor) in terms {
        let value = Ball::integer(*divisor)
            .recip(precision)
            .and_then(|x| odd_powers(&x, sign, precision))
            .expect("the divisors are not zero");
        sum = sum.add(&value.mul(&Ball::integer(*factor), precision), precision);
    }
    sum
}
