//! Inverse hyperbolic functions, `cbrt`, `log1p`, `expm1` and `hypot` in generated code.

use lie_runtime::generic::PowerSeries;
use lie_runtime::prelude::*;
use lie_runtime::{Expand, Recurrence, Scalar, Series};

lie_poisson! {
    /// Each of them, of arguments of both signs where they may have them.
    pub system Functions;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    parameters { a = 1.3; b = 0.4; }
    hamiltonian = cbrt(2 + x*y) + cbrt(z - 3) + log1p(x*z) + expm1(b*y + z) + asinh(x + a*y) + acosh(3 + y*z)
        + atanh(x*y/2) + hypot(1 + x, z);
    methods = [taylor, lie-taylor];
}
lie_poisson! {
    /// What loses its digits where it is written with exp and log.
    pub system Small;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    hamiltonian = log1p(x) + expm1(y) + asinh(z);
}
lie_poisson! {
    /// The control: the same with exp and log.
    pub system Written;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    hamiltonian = log(1 + x) + (exp(y) - 1) + log(z + sqrt(z^2 + 1));
}

const STARTS: [[f64; 3]; 3] = [[0.4, -0.3, 0.5], [-0.2, 0.7, 0.1], [0.9, 0.2, -0.6]];

/// Coefficients of the field along a solution.
fn coefficients<R, V: State<f64>>(mut recurrence: R, start: &V) -> Vec<Vec<f64>>
where
    R: Recurrence<f64, State = V>,
{
    let (mut row, mut field) = (start.clone(), start.clone());
    let mut rows = Vec::new();
    let mut carry = recurrence.begin(&row, &mut field);
    for k in 1..=16 {
        rows.push(field.as_slice().to_vec());
        for (row, field) in row.as_mut_slice().iter_mut().zip(field.as_slice()) {
            *row = field / k as f64;
        }
        carry = recurrence.advance(k, carry, &row, &mut field);
    }
    rows
}

fn difference(one: &[Vec<f64>], other: &[Vec<f64>]) -> f64 {
    let of_row = |(one, other): (&Vec<f64>, &Vec<f64>)| {
        let largest = one.iter().fold(f64::MIN_POSITIVE, |m, x| m.max(x.abs()));
        let pairs = one.iter().zip(other);
        pairs.fold(0.0_f64, |m, (a, b)| Scalar::max(m, (a - b).abs())) / largest
    };
    one.iter().zip(other).map(of_row).fold(0.0, Scalar::max)
}

fn compare<P: Series<f64> + Expand<f64>>(system: &P, start: &P::State) {
    let plain = coefficients(PowerSeries::new(system), start);
    let written = difference(&coefficients(system.series(), start), &plain);
    assert!(written < 1e-13, "{written:e}");
    // the bound is no formality
    let mut moved = start.clone();
    moved.as_mut_slice()[0] += 1e-9;
    assert!(difference(&coefficients(system.series(), &moved), &plain) > 1e-13);
}

#[test]
fn written_recurrences_are_those_of_power_series() {
    let system = Functions::new().system().expect("sound");
    for start in STARTS {
        compare(&system, &start.into());
    }
}

#[test]
fn gradients_are_the_slopes_of_the_hamiltonian() {
    let system = Functions::new().system().expect("sound");
    for start in STARTS {
        let state = start.into();
        let mut gradient = system.zero_state();
        system.gradient(&state, &mut gradient);
        for i in 0..3 {
            let h = 1e-5;
            let at = |shift: f64| {
                let mut moved = state;
                moved[i] += shift;
                system.hamiltonian(&moved)
            };
            let slope = (at(h) - at(-h)) / (2.0 * h);
            assert!(
                (slope - gradient[i]).abs() < 1e-8,
                "{i}: {slope} {gradient}"
            );
        }
    }
}

#[test]
fn small_arguments_keep_their_digits() {
    let t = 3e-11;
    // the series to the third order, all of whose terms are positive but one
    let exact = (t - t * t / 2.0) + (t + t * t / 2.0) + t;
    let error = |value: f64| ((value - exact) / exact).abs();
    let state = [t; 3].into();
    let kept = error(Small::new().system().expect("sound").hamiltonian(&state));
    let lost = error(Written::new().system().expect("sound").hamiltonian(&state));
    assert!(kept < 4.0 * f64::EPSILON, "{kept:e}");
    assert!(lost > 1e-8, "{lost:e}");
}

#[test]
fn every_scalar_has_them() {
    type Eight = F64x8;
    let system = Functions::new().system().expect("sound");
    let single = Functions::<f32>::default().system().expect("sound");
    let lanes = Functions::<Eight>::default().system().expect("sound");
    for start in STARTS {
        let energy = system.hamiltonian(&start.into());
        let narrow = single.hamiltonian(&start.map(|x| x as f32).into());
        assert!((f64::from(narrow) - energy).abs() < 1e-5);
        let wide = lanes.hamiltonian(&start.map(Eight::splat).into());
        for k in 0..8 {
            assert_eq!(wide.lane(k).to_bits(), energy.to_bits());
        }
    }
}
