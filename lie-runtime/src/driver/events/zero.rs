//! Zeros of a function of one number.

use super::sign;

/// Evaluations for a zero at most: bisection to the last bit.
const MOST: u32 = 80;

/// A zero between two places with different signs, to within a distance, by inverse quadratic interpolation where that converges and
/// by halves where not (T. R. Chandrupatla, Adv. Eng. Softw. 28, 145, 1997): its place, and how much the function
/// changes there.
pub(super) fn zero(
    from: (f64, f64),
    to: (f64, f64),
    close: f64,
    of: &mut dyn FnMut(f64) -> Option<f64>,
) -> Option<(f64, f64)> {
    // the last place, the one with another sign, and below the one before
    let (mut a, mut b) = (to, from);
    let mut part = 0.5;
    for _ in 0..MOST {
        let at = a.0 + part * (b.0 - a.0);
        let value = of(at)?;
        let c = match sign(value) == sign(a.1) {
            true => a,
            false => std::mem::replace(&mut b, a),
        };
        a = (at, value);
        let best = if a.1.abs() < b.1.abs() { a } else { b };
        let limit = close / (b.0 - a.0).abs();
        if best.1 == 0.0 {
            return Some((best.0, 0.0));
        }
        if limit >= 0.5 || limit.is_nan() {
            return Some((best.0, (a.1 - b.1).abs()));
        }
        let (xi, phi) = ((a.0 - b.0) / (c.0 - b.0), (a.1 - b.1) / (c.1 - b.1));
        let smooth = phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi;
        part = match smooth {
            true => {
                let first = a.1 / (b.1 - a.1) * c.1 / (b.1 - c.1);
                let second = (c.0 - a.0) / (b.0 - a.0) * a.1 / (c.1 - a.1) * b.1 / (c.1 - b.1);
                first + second
            }
            false => 0.5,
        };
        part = part.clamp(limit, 1.0 - limit);
    }
    let best = if a.1.abs() < b.1.abs() { a } else { b };
    Some((best.0, (a.1 - b.1).abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A function with its zero between 1 and 2.
    type Case = (fn(f64) -> f64, f64);

    #[test]
    fn zeros_are_found_to_the_last_bits() {
        let functions: [Case; 4] = [
            (|x| x * x - 2.0, 2.0_f64.sqrt()),
            (|x| (x - 1.3).cbrt(), 1.3),
            (|x| (x - 1.1).powi(9), 1.1),
            (|x| (20.0 * (x - 1.25)).tanh(), 1.25),
        ];
        for (f, expected) in functions {
            let mut count = 0;
            let mut of = |x: f64| {
                count += 1;
                Some(f(x))
            };
            let (found, _) = zero((1.0, f(1.0)), (2.0, f(2.0)), f64::EPSILON, &mut of).unwrap();
            // a zero of order nine is a zero to round-off over a wide stretch
            let wide = if f(expected + 1e-6) < 1e-50 {
                1e-6
            } else {
                1e-15
            };
            assert!((found - expected).abs() <= wide, "{found} {expected}");
            assert!(count <= 70, "{count}");
        }
        assert_eq!(zero((0.0, -1.0), (1.0, 1.0), 1e-9, &mut |_| None), None);
        // met at once, it is no jump
        let met = zero((0.0, -0.5), (1.0, 0.5), 1e-9, &mut |x| Some(x - 0.5));
        assert_eq!(met, Some((0.5, 0.0)));
        let jump = zero((0.0, -1.0), (1.0, 1.0), 1e-9, &mut |x| {
            Some(if x < 0.3 { -1.0 } else { 1.0 })
        });
        assert!(jump.unwrap().1 == 2.0);
    }
}
