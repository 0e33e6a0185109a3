//! Irrational constants in defaults, in the Hamiltonian and in the initial state.

use lie_runtime::prelude::*;
use spec_systems::se3_heavy_top::HeavyTop;

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

/// Whether the parts of the derivative of `m.g` along the field cancel exactly, read off at sums of unit vectors.
fn is_kept<S: Scalar>(field: impl Fn(&[usize]) -> [S; 6]) -> bool {
    (0..3).all(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        // the coefficients of m_i m_j g_k
        let terms = [
            field(&[i, j])[k],
            field(&[i, k + 3])[j + 3],
            field(&[j, k + 3])[i + 3],
        ];
        let [a, b, c] = terms.map(S::to_f64);
        let sum = b + c;
        let lost = (b - (sum - (sum - b))) + (c - (sum - b));
        sum == -a && lost == 0.0
    })
}

fn is_kept_by<S: Scalar>(moments: [f64; 3]) -> bool {
    let [i1, i2, i3] = moments.map(S::from_f64);
    let top = HeavyTop::<S> {
        I1: i1,
        I2: i2,
        I3: i3,
        ..HeavyTop::default()
    };
    let system = top.system().expect("valid");
    is_kept(|units| {
        let (mut mu, mut f) = (system.zero_state(), system.zero_state());
        units.iter().for_each(|place| mu[*place] = S::one());
        system.vector_field(&mu, &mut f);
        f.into()
    })
}

#[test]
fn the_casimirs_of_a_top_are_kept_by_its_coefficients() {
    let mut draw = 1_u64;
    let mut moment = || {
        draw = draw.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        0.2 + (draw >> 11) as f64 / 2.0_f64.powi(51)
    };
    let mut control = 0;
    for _ in 0..200 {
        let moments = [moment(), moment(), moment()];
        assert!(is_kept_by::<f64>(moments), "{moments:?}");
        assert!(is_kept_by::<f32>(moments), "{moments:?}");
        assert!(is_kept_by::<Dual<f64>>(moments), "{moments:?}");
        assert!(is_kept_by::<F64x8>(moments), "{moments:?}");
        let inverse = moments.map(|moment| 1.0 / moment);
        let apart = |units: &[usize]| {
            let mut f = [0.0; 6];
            if let [i, j] = *units {
                let (k, sign) = if (i + 1) % 3 == j % 3 {
                    ((i + 2) % 3, 1.0)
                } else {
                    ((i + 1) % 3, -1.0)
                };
                match j < 3 {
                    true => f[k] = sign * (inverse[i] - inverse[j]),
                    false => f[k + 3] = -sign * inverse[i],
                }
            }
            f
        };
        control += usize::from(!is_kept(apart));
    }
    assert!(control > 50, "rounded apart, {control} of 200 fail");
}
