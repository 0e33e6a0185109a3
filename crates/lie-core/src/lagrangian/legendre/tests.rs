use super::*;
use crate::scalar::Dual;
use nalgebra::{SMatrix, SVector};

type V<S> = SVector<S, 1>;

/// Solves `map(xi) = mu` in one variable.
fn root<S: Scalar>(map: fn(S) -> S, slope: fn(S) -> S, mu: S) -> S {
    let mut xi = V::from([S::zero()]);
    let mut matrix = SMatrix::<S, 1, 1>::repeat(S::zero());
    solve(
        1,
        |xi: &V<S>, out: &mut V<S>| out[0] = map(xi[0]),
        |xi: &V<S>, out: &mut SMatrix<S, 1, 1>| out[(0, 0)] = slope(xi[0]),
        &V::from([mu]),
        From::Rest,
        &mut xi,
        &mut matrix,
    );
    xi[0]
}

/// `l = -sqrt(1 - xi^2)`: `mu = xi/sqrt(1 - xi^2)`, a full step from rest leaves the domain.
fn relativistic<S: Scalar>(xi: S) -> S {
    xi / (S::one() - xi * xi).sqrt()
}

fn relativistic_slope<S: Scalar>(xi: S) -> S {
    let root = (S::one() - xi * xi).sqrt();
    S::one() / (root * root * root)
}

fn cubic<S: Scalar>(xi: S) -> S {
    xi + xi * xi * xi
}

fn cubic_slope<S: Scalar>(xi: S) -> S {
    S::one() + S::from_f64(3.0) * xi * xi
}

/// `l = xi^2/2 - xi^4/12` has momenta up to 2/3 on the branch through rest, and beyond its folds others.
#[test]
fn no_velocity_beyond_a_fold() {
    fn map<S: Scalar>(xi: S) -> S {
        xi - xi * xi * xi * S::ratio(1.0, 3.0)
    }
    fn slope<S: Scalar>(xi: S) -> S {
        S::one() - xi * xi
    }
    for mu in [0.0, 0.3, -0.6] {
        let xi = root::<f64>(map, slope, mu);
        assert!(xi.abs() < 1.0 && (map(xi) - mu).abs() < 1e-15, "{mu}: {xi}");
    }
    for mu in [0.7, 3.0, -5.0] {
        assert!(root::<f64>(map, slope, mu).is_nan(), "{mu}");
    }
}

#[test]
fn closed_forms() {
    for mu in [0.0, 1e-12, 0.3, -1.0, 7.0, 1e3] {
        let xi = root(relativistic, relativistic_slope, mu);
        let exact = mu / (1.0 + mu * mu).sqrt();
        assert!(
            (xi - exact).abs() <= 4e-16 * exact.abs(),
            "{mu}: {xi} {exact}"
        );
        // sinh(3 arsinh) solves the cubic
        let xi = root(cubic, cubic_slope, mu);
        let c = 2.0 / 3.0_f64.sqrt();
        let exact = c * ((1.5 * 3.0_f64.sqrt() * mu).asinh() / 3.0).sinh();
        assert!(
            (xi - exact).abs() <= 1e-15 * exact.abs(),
            "{mu}: {xi} {exact}"
        );
        let single = root(cubic, cubic_slope, mu as f32);
        assert!(
            (f64::from(single) - exact).abs() <= 4e-7 * exact.abs(),
            "{mu}"
        );
    }
}

/// `xi = mu/sqrt(1 + mu^2)` has the derivatives `r^-3`, `-3 mu r^-5`, `(12 mu^2 - 3) r^-7`.
#[test]
fn derivatives_are_exact() {
    let mu = 0.75_f64;
    let nested = Dual::new(
        Dual::new(Dual::variable(mu), Dual::one()),
        Dual::new(Dual::one(), Dual::zero()),
    );
    let xi = root(relativistic, relativistic_slope, nested);
    let r = (1.0 + mu * mu).sqrt();
    let first = xi.value.value.derivative;
    assert!((first - r.powi(-3)).abs() < 1e-15);
    let second = xi.value.derivative.derivative;
    assert!((second + 3.0 * mu * r.powi(-5)).abs() < 4e-15);
    let third = xi.derivative.derivative.derivative;
    assert!((third - (12.0 * mu * mu - 3.0) * r.powi(-7)).abs() < 4e-14);
}

#[test]
fn what_has_no_velocity_is_not_a_number() {
    // l = log cosh xi: |mu| < 1
    let map = |xi: f64| xi.tanh();
    let slope = |xi: f64| 1.0 - xi.tanh().powi(2);
    assert!((root(map, slope, 0.5) - 0.5_f64.atanh()).abs() < 1e-15);
    assert!(root(map, slope, 1.5).is_nan());
    assert!(root(map, slope, f64::NAN).is_nan());
    // singular at rest
    assert!(!root(|xi: f64| xi.powi(3), |xi| 3.0 * xi * xi, 1.0).is_finite());
}

#[cfg(feature = "lanes")]
#[test]
fn a_lane_has_the_bits_of_a_run_of_its_own() {
    use crate::scalar::F64x4;
    let values = [0.3, 2000.0, -5.0, 1e-9];
    let mut mu = F64x4::zero();
    for (lane, value) in values.into_iter().enumerate() {
        mu = mu.with_lane(lane, value);
    }
    let xi = root(relativistic, relativistic_slope, mu);
    for (lane, value) in values.into_iter().enumerate() {
        assert_eq!(xi.lane(lane), root(relativistic, relativistic_slope, value));
    }
}
