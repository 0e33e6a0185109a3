//! The rational roots of a polynomial with rational coefficients, all of them and exactly.

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Signed, Zero};

use lie_symbolic::exact::Rational;

/// The distinct rational roots of `sum_k c_k t^k`, ascending.
///
/// With `t = s/a`, a the leading coefficient of an integer multiple, the polynomial in s is monic with integer coefficients, so
/// that its rational roots are integers. Between the integers around the extrema it is monotone, and bisection ends at the
/// only candidates.
pub fn rational_roots(coefficients: &[Rational]) -> Vec<Rational> {
    let common = coefficients
        .iter()
        .fold(BigInt::one(), |d, c| d.lcm(c.to_big().denom()));
    let scaled = coefficients.iter().map(|c| {
        let big = c.to_big();
        big.numer() * (&common / big.denom())
    });
    let mut integers: Vec<BigInt> = scaled.collect();
    while integers.last().is_some_and(Zero::is_zero) {
        integers.pop();
    }
    let Some(leading) = integers.pop() else {
        return Vec::new();
    };
    let degree = integers.len();
    // a^(d-1) f(s/a) = s^d + sum_k c_k a^(d-1-k) s^k
    let mut monic: Vec<BigInt> = integers
        .into_iter()
        .enumerate()
        .map(|(k, c)| c * leading.pow((degree - 1 - k) as u32))
        .collect();
    monic.push(BigInt::one());
    let mut roots = Vec::new();
    for place in cells(&monic) {
        for s in [place.clone(), place + 1] {
            let root = Rational::from_big(s.clone(), leading.clone());
            if value(&monic, &s).is_zero() {
                roots.extend(root);
            }
        }
    }
    roots.sort_by_key(Rational::to_big);
    roots.dedup();
    roots
}

fn value(polynomial: &[BigInt], at: &BigInt) -> BigInt {
    let terms = polynomial.iter().rev();
    terms.fold(BigInt::zero(), |sum, c| sum * at + c)
}

/// Integers c so that all real roots lie in the intervals `[c, c + 1]`.
fn cells(polynomial: &[BigInt]) -> Vec<BigInt> {
    if polynomial.len() < 2 {
        return Vec::new();
    }
    let slope: Vec<BigInt> = (1..).zip(&polynomial[1..]).map(|(k, c)| c * k).collect();
    let extrema = cells(&slope);
    let leading = polynomial[polynomial.len() - 1].abs();
    let most = polynomial.iter().map(Signed::abs).max().unwrap_or_default();
    let bound = most / leading + 2u8;
    let mut marks = vec![-&bound];
    marks.extend(extrema.iter().flat_map(|c| [c.clone(), c + 1]));
    marks.push(bound);
    let mut found = extrema;
    for pair in marks.windows(2) {
        let (mut low, mut high) = (pair[0].clone(), pair[1].clone());
        let sign = |x: &BigInt| value(polynomial, x).signum();
        let begin = sign(&low);
        if begin == sign(&high) && !begin.is_zero() {
            continue;
        }
        while &high - &low > BigInt::one() {
            let middle: BigInt = (&low + &high).div_floor(&BigInt::from(2));
            let at = sign(&middle);
            if at.is_zero() || at != begin {
                high = middle;
            } else {
                low = middle;
            }
        }
        found.push(low);
    }
    found.sort();
    found.dedup();
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn roots(coefficients: &[i64]) -> Vec<String> {
        let coefficients: Vec<Rational> = coefficients.iter().map(|&c| Rational::from(c)).collect();
        rational_roots(&coefficients)
            .iter()
            .map(Rational::to_string)
            .collect()
    }

    #[test]
    fn all_rational_roots_and_no_others() {
        assert_eq!(roots(&[-6, 11, -6, 1]), ["1", "2", "3"]);
        assert_eq!(roots(&[1, -4, 4]), ["1/2"]);
        assert_eq!(roots(&[-2, 0, 1]), Vec::<String>::new());
        assert_eq!(roots(&[1, 0, 1]), Vec::<String>::new());
        assert_eq!(roots(&[0, 0, 5]), ["0"]);
        // (3 t + 7)(t^2 - 2)(t - 1000003)
        assert_eq!(
            roots(&[14_000_042, 6_000_004, -7_000_027, -3_000_002, 3]),
            ["-7/3", "1000003"]
        );
        assert_eq!(roots(&[7]), Vec::<String>::new());
    }
}
