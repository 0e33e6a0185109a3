//! A retraction of the user's own, in generated code.

use lie_runtime::methods::{Method, Stepper};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use lie_runtime::{MatrixGroup, Poisson};

lie_poisson! {
    /// A body with a Hamiltonian that is no quadratic form, and the Cayley map of rotations as its retraction.
    pub system Turning;
    algebra {
        basis a, b, c;
        matrix a = [[0, 0, 0], [0, 0, -1], [0, 1, 0]];
        matrix b = [[0, 0, 1], [0, 0, 0], [-1, 0, 0]];
        matrix c = [[0, -1, 0], [1, 0, 0], [0, 0, 0]];
    }
    state x, y, z;
    hamiltonian = x^2/4 + y^2/2 + 3*z^2/4 + x*y^2*z/3 + x^3/5 + y/4;
    retraction {
        map = [
            [1 - (b^2 + c^2)/(2 + (a^2 + b^2 + c^2)/2), (a*b/2 - c)/(1 + (a^2 + b^2 + c^2)/4), (a*c/2 + b)/(1 + (a^2 + b^2 + c^2)/4)],
            [(a*b/2 + c)/(1 + (a^2 + b^2 + c^2)/4), 1 - (a^2 + c^2)/(2 + (a^2 + b^2 + c^2)/2), (b*c/2 - a)/(1 + (a^2 + b^2 + c^2)/4)],
            [(a*c/2 - b)/(1 + (a^2 + b^2 + c^2)/4), (b*c/2 + a)/(1 + (a^2 + b^2 + c^2)/4), 1 - (a^2 + b^2)/(2 + (a^2 + b^2 + c^2)/2)]
        ];
    }
}

fn end<M: Method<f64, TurningSystem<f64>>>(system: &TurningSystem<f64>, method: &M) -> Vec<f64> {
    let mut state = system.zero_state();
    state.as_mut_slice().copy_from_slice(&[0.6, -0.5, 0.7]);
    let mut stepper = method.stepper(system, 0.1, &NewtonOptions::default());
    for _ in 0..20 {
        stepper.step(&mut state, &mut ()).expect("a step");
    }
    state.as_slice().to_vec()
}

#[test]
fn a_declared_retraction_is_generated() {
    let system = Turning::new().system().expect("a system");
    let off = |a: &[f64], b: &[f64]| {
        let pairs = a.iter().zip(b);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    let declared = end(&system, &LieMidpoint::declared());
    assert!(off(&declared, &end(&system, &LieMidpoint::cayley())) < 1e-13);
    // the control
    assert!(off(&declared, &end(&system, &LieMidpoint::exp())) > 1e-6);
    let (mut x, mut rows) = (system.zero_state(), [0.0; 9]);
    x.as_mut_slice().copy_from_slice(&[2.0, 0.0, 0.0]);
    system.retract(&x, &mut rows);
    // a turn by a right angle: tan(pi/4) is half of 2
    let expected = [1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0];
    assert!(off(&rows, &expected) < 1e-15, "{rows:?}");
}
