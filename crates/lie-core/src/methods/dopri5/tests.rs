use super::*;
use crate::test_systems::Spring;

fn stepper(rtol: f64, atol: f64) -> Dopri5Stepper<'static, f64, Spring> {
    let method = Dopri5 { rtol, atol };
    method.stepper(&Spring, 1.0, &NewtonOptions::default())
}

#[test]
fn sizes_are_in_units_of_the_tolerances() {
    let mut stepper = stepper(1e-3, 1e-5);
    stepper.current = [4.0, -0.5].into();
    let vector = [3e-3, 2e-4];
    let mean = |size: [f64; 2]| {
        let unit = size.map(|size| 1e-5 + 1e-3 * size);
        let square: f64 = vector.iter().zip(unit).map(|(v, u)| (v / u).powi(2)).sum();
        (0.5 * square).sqrt()
    };
    let measured = stepper.measure(|index| vector[index], None);
    assert!((measured / mean([4.0, 0.5]) - 1.0).abs() < 1e-14);
    // of two states the larger component counts
    let other = [-2.0, 8.0].into();
    let measured = stepper.measure(|index| vector[index], Some(&other));
    assert!((measured / mean([4.0, 8.0]) - 1.0).abs() < 1e-14);
}

/// The next step is at most ten times and at least a fifth of the last, and not longer after an error
/// that is too large; in between it follows the error and the one before.
#[test]
fn growth_is_limited() {
    let mut stepper = stepper(1e-6, 1e-9);
    stepper.log_error_before = 1e-4_f64.ln();
    let divisor = |error: f64, accepted| stepper.divisor(error.ln(), accepted);
    assert_eq!(divisor(0.0, true), 0.1);
    assert_eq!(divisor(1e-12, true), 0.1);
    assert_eq!(divisor(1e30, false), 5.0);
    assert_eq!(divisor(0.3, false), 1.0);
    assert_eq!(divisor(f64::NAN, false), 10.0);
    let expected = 0.02_f64.powf(0.17) / 1e-4_f64.powf(0.04) / 0.9;
    assert!((divisor(0.02, true) - expected).abs() < 1e-15);
    let expected = 50.0_f64.powf(0.17) / 0.9;
    assert!((divisor(50.0, false) - expected).abs() < 1e-15);
}
