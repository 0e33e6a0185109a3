//! Irrational constants in defaults, in the Hamiltonian and in the initial state.

use lie_runtime::prelude::*;

lie_poisson! { spec = "tests/data/declarations/pass/irrational_constants.json"; }

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
