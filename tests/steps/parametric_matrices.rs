//! Matrices whose entries have a parameter, in generated code, beside those of numbers.

use lie_runtime::methods::{Generating4, LieMidpoint, Method, Rkmk4, Stepper};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use lie_runtime::{CayleyPoisson, Poisson, Spectrum};

lie_poisson! {
    /// Rotations for positive k, motions of a hyperboloid for negative ones: the brackets are computed.
    pub system Bending;
    algebra {
        basis a, b, c;
        matrix a = [[0, 0, 0], [0, 0, -k], [0, 1, 0]];
        matrix b = [[0, 0, k], [0, 0, 0], [-1, 0, 0]];
        matrix c = [[0, -1, 0], [1, 0, 0], [0, 0, 0]];
    }
    state x, y, z;
    parameters { exact k = 1; }
    hamiltonian = x^2/4 + y^2/2 + 3*z^2/4 + x*y^2*z/3 + x^3/5 + y/4;
    methods = [lie-midpoint];
}

lie_poisson! {
    /// The same, with k = -3/4.
    pub system Boosts;
    algebra {
        basis a, b, c;
        matrix a = [[0, 0, 0], [0, 0, 3/4], [0, 1, 0]];
        matrix b = [[0, 0, -3/4], [0, 0, 0], [-1, 0, 0]];
        matrix c = [[0, -1, 0], [1, 0, 0], [0, 0, 0]];
    }
    state x, y, z;
    hamiltonian = x^2/4 + y^2/2 + 3*z^2/4 + x*y^2*z/3 + x^3/5 + y/4;
    methods = [lie-midpoint];
}

lie_poisson! {
    /// Rotations of another unit.
    pub system Units;
    algebra {
        basis a, b, c;
        matrix a = [[0, 0, 0], [0, 0, -k], [0, k, 0]];
        matrix b = [[0, 0, k], [0, 0, 0], [-k, 0, 0]];
        matrix c = [[0, -k, 0], [k, 0, 0], [0, 0, 0]];
    }
    state x, y, z;
    parameters { exact k = 2; }
    hamiltonian = x^2/4 + y^2/2 + 3*z^2/4;
}

lie_poisson! {
    /// A turn about one axis.
    pub system Axis;
    algebra {
        basis a, b, c;
        matrix a = [[0, 0, 0], [0, 0, -k], [0, 1, 0]];
        matrix b = [[0, 0, k], [0, 0, 0], [-1, 0, 0]];
        matrix c = [[0, -1, 0], [1, 0, 0], [0, 0, 0]];
    }
    state x, y, z;
    parameters { exact k = 1; }
    hamiltonian = x^2/2;
}

fn end<P: Poisson<f64>>(system: &P, method: &impl Method<f64, P>) -> Vec<f64> {
    let mut state = system.zero_state();
    state.as_mut_slice().copy_from_slice(&[0.6, -0.5, 0.7]);
    let mut stepper = method.stepper(system, 0.1, &NewtonOptions::default());
    for _ in 0..20 {
        stepper.step(&mut state, &mut ()).expect("a step");
    }
    state.as_slice().to_vec()
}

fn off(a: &[f64], b: &[f64]) -> f64 {
    let pairs = a.iter().zip(b);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn steps_are_those_of_the_numbers() {
    let at = |k: f64| Bending { k }.system().expect("a system");
    let (bending, boosts, other) = (
        at(-0.75),
        Boosts::new().system().expect("a system"),
        at(-0.7),
    );
    let pairs = [
        (
            end(&bending, &LieMidpoint::cayley()),
            end(&boosts, &LieMidpoint::cayley()),
            end(&other, &LieMidpoint::cayley()),
        ),
        (
            end(&bending, &LieMidpoint::exp()),
            end(&boosts, &LieMidpoint::exp()),
            end(&other, &LieMidpoint::exp()),
        ),
        (
            end(&bending, &Rkmk4::new()),
            end(&boosts, &Rkmk4::new()),
            end(&other, &Rkmk4::new()),
        ),
        (
            end(&bending, &Generating4::cayley()),
            end(&boosts, &Generating4::cayley()),
            end(&other, &Generating4::cayley()),
        ),
    ];
    for (found, expected, other) in &pairs {
        assert!(off(found, expected) < 1e-14, "{found:?} {expected:?}");
        // the control
        assert!(off(other, expected) > 1e-4, "{other:?} {expected:?}");
    }
    // and the retractions are two
    assert!(off(&pairs[0].0, &pairs[1].0) > 1e-5);
}

#[test]
fn the_cayley_map_has_no_pole_where_no_value_of_the_parameter_makes_one() {
    let units = Units::new().system().expect("a system");
    assert!(matches!(
        CayleyPoisson::<f64>::spectrum(&units),
        Spectrum::Imaginary
    ));
    let bending = Bending::new().system().expect("a system");
    assert!(matches!(
        CayleyPoisson::<f64>::spectrum(&bending),
        Spectrum::Unknown
    ));
}

/// The velocity `xi a` of a step from x obeys `xi (1 + k xi^2/4) = x`. For negative k that has a solution this side of the pole
/// `|xi| = 2/sqrt(-k)` up to `x = 4/sqrt(-27 k)` only; what lies beyond the pole is refused.
#[test]
fn poles_depend_on_the_value_of_the_parameter() {
    let step = |k: f64| {
        let system = Axis { k }.system().expect("a system");
        let mut state = system.zero_state();
        state.as_mut_slice().copy_from_slice(&[3.0, 1.0, 0.5]);
        let method = LieMidpoint::cayley();
        let mut stepper = method.stepper(&system, 1.0, &NewtonOptions::default());
        stepper.step(&mut state, &mut ()).is_ok()
    };
    let limit = -16.0 / 27.0 / 9.0;
    for (k, made) in [
        (9.0, true),
        (1.0, true),
        (0.9 * limit, true),
        (1.1 * limit, false),
        (-1.0, false),
    ] {
        assert_eq!(step(k), made, "{k}");
    }
}
