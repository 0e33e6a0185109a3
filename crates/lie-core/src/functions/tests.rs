use super::*;
use crate::scalar::Truncated;

#[test]
fn power_series_are_integrals_over_slopes() {
    for &function in Elementary::ALL {
        let start = match function.domain() {
            Domain::FromOne => 1.7,
            _ => 0.3,
        };
        let x = Truncated::from_fn(8, |k| if k == 0 { start } else { 0.4 / (k + 1) as f64 });
        let y = function.apply(x);
        let slope = function.slope(x, y);
        assert_eq!(y.coefficient(0), function.apply(start));
        for k in 1..8 {
            let terms = (1..=k).map(|j| j as f64 * x.coefficient(j) * slope.coefficient(k - j));
            let (found, expected) = (y.coefficient(k), terms.sum::<f64>() / k as f64);
            let error = (found - expected).abs() / (1.0 + expected.abs());
            assert!(error < 1e-13, "{function:?}, term {k}: {found} {expected}");
        }
    }
}

#[test]
fn facts_of_the_rows_are_those_of_the_values() {
    for &function in Elementary::ALL {
        let (here, there) = (function.evaluate(0.5), function.evaluate(-0.5));
        assert_eq!(function.is_odd(), here == -there, "{function:?}");
        for x in [-2, -1, 0, 1, 2] {
            if let Some(exact) = function.exact(x) {
                assert_eq!(
                    function.evaluate(x as f64),
                    exact as f64,
                    "{function:?} at {x}"
                );
            }
        }
        for x in [-1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5] {
            let inside = match function.domain() {
                Domain::Everywhere | Domain::NotRight => true,
                Domain::Positive => x > 0.0,
                Domain::AboveMinusOne => x > -1.0,
                Domain::FromOne => x >= 1.0,
                Domain::WithinOne => f64::abs(x) <= 1.0,
                Domain::BetweenOnes => f64::abs(x) < 1.0,
            };
            let value = function.evaluate(x);
            assert_eq!(value.is_finite(), inside, "{function:?} at {x}");
        }
    }
}
