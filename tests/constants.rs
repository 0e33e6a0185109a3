//! Irrational constants in defaults, in the Hamiltonian and in the initial state.

use lie_runtime::prelude::*;

lie_poisson! { spec = "tests/data/declarations/pass/irrational_constants.json"; }

lie_poisson! {
    system Scaled;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    parameters { I1 = 2.0, positive; exact k = 1/3, positive; free = -1; }
    hamiltonian = x^2/(2*I1) + k*y^2 + free*z^2;
    casimir C = x^2 + y^2 + z^2 + (sqrt(I1^2) - I1)*x + (sqrt(k^2) - k)*y;
}

#[test]
fn positive_parameters_are_checked_when_the_system_is_made() {
    assert!(Scaled::new().system().is_ok());
    let values = |i1: f64, k: f64, free: f64| Scaled { I1: i1, k, free };
    assert!(values(1e-300, 1.0, 0.0).system().is_ok());
    for (name, bad) in [
        ("I1", values(-1.0, 1.0, 1.0)),
        ("I1", values(0.0, 1.0, 1.0)),
        ("k", values(1.0, f64::NAN, 1.0)),
    ] {
        let error = bad.system().expect_err("not positive");
        assert_eq!(
            (error.name, error.fault),
            (name, lie_runtime::ParameterFault::NotPositive)
        );
        assert!(
            error.to_string().contains("was declared positive"),
            "{error}"
        );
    }
}

#[test]
fn constants_have_their_values() {
    use core::f64::consts::PI;
    let parameters = IrrationalConstants::new();
    let q = 1.1_f64.cos() * 5.0_f64.sqrt() / PI;
    let k = 2.0 * PI + 2.0_f64.sqrt() * PI - 1.0;
    let r = 2.0_f64.exp() * 2.0_f64.cbrt();
    let near = |value: f64, expected: f64| {
        assert!((value / expected - 1.0).abs() < 1e-15, "{value} {expected}");
    };
    near(parameters.l, 3.0_f64.sqrt() / 2.0);
    near(parameters.k, k);
    near(parameters.m, 1.0 + PI);
    near(parameters.q, q);
    near(parameters.r, r);
    let mu = parameters.initial_state();
    near(mu[0], 2.0_f64.sqrt() + PI);
    near(mu[1], PI / parameters.l.sqrt());
    let system = parameters.system().expect("valid");
    let factor = 2.0_f64.sqrt() * PI * k * (1.0 + PI) * q * r;
    near(
        system.hamiltonian(&mu),
        parameters.l * mu[0] * mu[0] + factor * mu[1],
    );
    let mut gradient = system.zero_state();
    system.gradient(&mu, &mut gradient);
    near(gradient[1], factor);
}
