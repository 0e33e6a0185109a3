//! A declaration that names explicit methods alone has no second derivatives written out. What needs them finds them by dual
//! numbers, to the same digits.

use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;

macro_rules! declared {
    ($name:ident $(, $methods:tt)?) => {
        lie_poisson! {
            pub system $name;
            algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
            state x, y, z;
            parameters { k = 0.7; }
            hamiltonian = x^2/2 + k*exp(y)*z + sin(x*z) + y^4/5;
            casimir C = x^2 + y^2 + z^2;
            $(methods = $methods;)?
        }
    };
}

declared!(Everything);
declared!(Explicit, [rk4]);

#[test]
fn derivatives_are_those_that_are_written_out() {
    let (whole, explicit) = (
        Everything::new().system().expect("sound parameters"),
        Explicit::new().system().expect("sound parameters"),
    );
    for mu in [[0.9, -0.3, 0.4], [-1.2, 0.6, 2.0], [0.0, 0.0, 0.0]] {
        let mu = mu.into();
        let (mut a, mut b) = (whole.zero_jacobian(), explicit.zero_jacobian());
        whole.hessian(&mu, &mut a);
        explicit.hessian(&mu, &mut b);
        assert!((a - b).norm() <= 1e-14 * (1.0 + a.norm()), "{a} {b}");
        whole.jacobian(&mu, &mut a);
        explicit.jacobian(&mu, &mut b);
        assert!((a - b).norm() <= 1e-14 * (1.0 + a.norm()), "{a} {b}");
        let (mut field, mut other) = (whole.zero_state(), explicit.zero_state());
        explicit.linearize(&mu, &mut field, &mut b);
        whole.vector_field(&mu, &mut other);
        assert!((a - b).norm() <= 1e-14 * (1.0 + a.norm()));
        assert!((field - other).norm() <= 1e-14 * (1.0 + other.norm()));
    }
}

#[test]
fn every_other_method_works() {
    let whole = Everything::new().system().expect("sound parameters");
    let explicit = Explicit::new().system().expect("sound parameters");
    let (mut a, mut b) = ([0.9, -0.3, 0.4].into(), [0.9, -0.3, 0.4].into());
    let newton = NewtonOptions::default();
    for _ in 0..10 {
        Gauss4
            .stepper(&whole, 0.1, &newton)
            .step(&mut a, &mut ())
            .expect("a step");
        Gauss4
            .stepper(&explicit, 0.1, &newton)
            .step(&mut b, &mut ())
            .expect("a step");
    }
    assert!((a - b).norm() < 1e-13, "{a} {b}");
    let mut c = b;
    Rk4.stepper(&explicit, 0.1, &newton)
        .step(&mut c, &mut ())
        .expect("a step");
    assert!((c - b).norm() > 1e-3, "the state moves");
}
