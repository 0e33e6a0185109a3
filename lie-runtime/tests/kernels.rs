//! Kernels written by hand against the generic forms, and the generic forms against the algebra.

use crate::systems;

use lie_runtime::methods::{FactorSink, Method, Retraction, Stepper};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use lie_runtime::{Poisson, Scalar, Unknown, generic};
use nalgebra::{Matrix4, SMatrix, SVector, Vector3};
use systems::heavy_top::{HeavyTop, START};
use systems::nonpolynomial::Nonpolynomial;
use systems::rigid_body::{RigidBody, hat};
use systems::{distance, state};

const X: [f64; 6] = [0.3, -0.2, 0.5, 0.7, -0.4, 0.1];
const Z: [f64; 6] = [-0.6, 0.4, 0.25, 0.35, 0.9, -0.8];

fn matrix_distance<const N: usize>(a: &SMatrix<f64, N, N>, b: &SMatrix<f64, N, N>) -> f64 {
    (a - b).amax()
}

/// Field, Jacobian, Hessian, coadjoint action, Casimirs of one system, each in two ways.
fn check<const N: usize, P, D>(system: &P, dual: &D, mu: [f64; N])
where
    P: LiePoisson<f64, State = SVector<f64, N>, Jacobian = SMatrix<f64, N, N>>,
    D: LiePoisson<Dual<f64>, State = SVector<Dual<f64>, N>>,
{
    let (mu, x) = (
        SVector::from(mu),
        SVector::<f64, N>::from_fn(|row, _| X[row]),
    );
    let (mut first, mut second) = (system.zero_state(), system.zero_state());
    system.vector_field(&mu, &mut first);
    generic::vector_field(system, &mu, &mut second);
    assert!(distance(&first, &second) < 1e-15);
    system.ad_star(&x, &mu, &mut first);
    generic::ad_star(system, &x, &mu, &mut second);
    assert!(distance(&first, &second) < 1e-15);
    // <ad*_x mu, y> = <mu, [x, y]>
    let y = SVector::<f64, N>::from_fn(|row, _| Z[row]);
    system.ad(&x, &y, &mut second);
    assert!((first.dot(&y) - mu.dot(&second)).abs() < 1e-15);

    let (mut left, mut right) = (system.zero_jacobian(), system.zero_jacobian());
    system.jacobian(&mu, &mut left);
    generic::jacobian(system, &mu, &mut right);
    assert!(matrix_distance(&left, &right) < 1e-15);
    system.linearize(&mu, &mut first, &mut right);
    assert_eq!(left, right);
    system.ad_star_matrix(&x, &mut left);
    generic::ad_star_matrix(system, &x, &mut right);
    assert_eq!(left, right);
    generic::poisson_slope(system, &x, &mut right);
    assert!(matrix_distance(&left, &right) < 1e-15);

    system.jacobian(&mu, &mut left);
    system.hessian(&mu, &mut right);
    let mut gradient = system.zero_state();
    system.gradient(&mu, &mut gradient);
    for column in 0..N {
        let seeded = SVector::<Dual<f64>, N>::from_fn(|row, _| {
            Dual::new(mu[row], if row == column { 1.0 } else { 0.0 })
        });
        let mut out = dual.zero_state();
        dual.vector_field(&seeded, &mut out);
        (0..N).for_each(|row| assert!((out[row].derivative - left[(row, column)]).abs() < 2e-15));
        dual.gradient(&seeded, &mut out);
        (0..N).for_each(|row| assert!((out[row].derivative - right[(row, column)]).abs() < 2e-15));
        assert!((dual.hamiltonian(&seeded).derivative - gradient[column]).abs() < 2e-15);
    }
    for index in 0..system.casimir_count() {
        system.casimir_gradient(index, &mu, &mut gradient);
        system.ad_star(&gradient, &mu, &mut first);
        assert!(Unknown::<f64>::max_norm(&first) < 1e-15, "Casimir {index}");
        assert!(Unknown::<f64>::max_norm(&gradient) > 0.1, "Casimir {index}");
    }
}

#[test]
fn kernels_agree_with_their_generic_forms() {
    check(
        &RigidBody::default(),
        &RigidBody::default(),
        [0.6, -0.5, 0.7],
    );
    check(&Nonpolynomial, &Nonpolynomial, [0.6, -0.5, 0.7]);
    check(&HeavyTop::default(), &HeavyTop::default(), START);
}

/// Rodrigues' formula for `exp(-hat x) mu`, the coadjoint action of so(3).
fn rotated(x: &Vector3<f64>, mu: &Vector3<f64>) -> Vector3<f64> {
    let angle = x.norm();
    let matrix = hat(x.as_slice());
    mu - matrix * mu * (angle.sin() / angle)
        + matrix * matrix * mu * ((1.0 - angle.cos()) / (angle * angle))
}

#[test]
fn the_exponential_series_is_the_closed_form() {
    let system = RigidBody::<f64>::default();
    let mu = Vector3::new(0.6, -0.5, 0.7);
    for size in [1e-9, 1e-3, 0.1, 1.0, 3.0, 10.0, 100.0] {
        let x = Vector3::new(0.3, -0.2, 0.5) * size;
        let mut out = system.zero_state();
        generic::coadjoint_action(&system, &x, &mu, &mut out);
        let error = (out - rotated(&x, &mu)).amax();
        assert!(
            error < 1e-15 * (2.0 + 20.0 * size),
            "size {size}: {error:e}"
        );
        // repeated application must not lose digits of the norm
        assert!(
            (out.norm() - mu.norm()).abs() < 3e-15 * (1.0 + size),
            "size {size}"
        );
    }
    let mut out = system.zero_state();
    generic::coadjoint_action(
        &system,
        &Vector3::new(f64::INFINITY, 0.0, 0.0),
        &mu,
        &mut out,
    );
    assert!(!out.iter().all(|entry| entry.is_finite()));
}

/// In lanes each argument is scaled by itself: the digits are those of one lane.
#[test]
fn the_exponential_series_in_lanes() {
    let sizes = [1e-9, 1e-3, 0.1, 1.0, 3.0, 10.0, 30.0, 100.0];
    let system = RigidBody::<F64x8>::default();
    let x = SVector::<F64x8, 3>::from_fn(|row, _| F64x8::new(sizes.map(|size| size * X[row])));
    let mu = SVector::<F64x8, 3>::from_fn(|row, _| F64x8::splat(Z[row]));
    let (mut action, mut dexp) = (system.zero_state(), system.zero_state());
    generic::coadjoint_action(&system, &x, &mu, &mut action);
    generic::dexp_dual(&system, &x, &mu, &mut dexp);
    let system = RigidBody::<f64>::default();
    for lane in 0..8 {
        let x = SVector::<f64, 3>::from_fn(|row, _| x[row].lane(lane));
        let mu = SVector::<f64, 3>::from_fn(|row, _| Z[row]);
        let mut alone = system.zero_state();
        generic::coadjoint_action(&system, &x, &mu, &mut alone);
        assert_eq!(
            alone,
            SVector::<f64, 3>::from_fn(|row, _| action[row].lane(lane))
        );
        generic::dexp_dual(&system, &x, &mu, &mut alone);
        assert_eq!(
            alone,
            SVector::<f64, 3>::from_fn(|row, _| dexp[row].lane(lane))
        );
    }
}

/// `d/dt exp(t ad*_x) mu` integrated: `ad*_x phi1(ad*_x) mu = exp(ad*_x) mu - mu`.
#[test]
fn the_dual_of_dexp_integrates_the_action() {
    let system = HeavyTop::<f64>::default();
    let (mu, x) = (state(&system, &START), state(&system, &X));
    let (mut sum, mut moved, mut end) = (
        system.zero_state(),
        system.zero_state(),
        system.zero_state(),
    );
    generic::dexp_dual(&system, &x, &mu, &mut sum);
    system.ad_star(&x, &sum, &mut moved);
    generic::coadjoint_action(&system, &x, &mu, &mut end);
    assert!(distance(&(mu + moved), &end) < 1e-15);
}

/// The triple product of se(3) against products of 4x4 matrices.
#[test]
fn the_triple_product_is_that_of_the_representation() {
    let matrix = |x: &[f64]| {
        let mut matrix = Matrix4::zeros();
        matrix.fixed_view_mut::<3, 3>(0, 0).copy_from(&hat(&x[..3]));
        matrix.fixed_view_mut::<3, 1>(0, 3).copy_from_slice(&x[3..]);
        matrix
    };
    let system = HeavyTop::<f64>::default();
    let (mu, x, z) = (
        state(&system, &START),
        state(&system, &X),
        state(&system, &Z),
    );
    let mut out = system.zero_state();
    system.triple(&x, &z, &mu, &mut out);
    for direction in 0..6 {
        let mut unit = [0.0; 6];
        unit[direction] = 1.0;
        let (a, b, c) = (matrix(&X), matrix(&unit), matrix(&Z));
        let product = (a * b * c + c * b * a) * 0.5;
        let coordinates = [
            product[(2, 1)],
            product[(0, 2)],
            product[(1, 0)],
            product[(0, 3)],
            product[(1, 3)],
            product[(2, 3)],
        ];
        let paired: f64 = coordinates
            .iter()
            .zip(&START)
            .map(|(entry, mu)| entry * mu)
            .sum();
        assert!(
            (out[direction] - paired).abs() < 1e-15,
            "direction {direction}"
        );
    }
}

/// Keeps the last group factor.
struct Last<V>(Option<(Retraction, V)>);

impl<V: Clone> FactorSink<V> for Last<V> {
    fn push(&mut self, retraction: Retraction, xi: &V) {
        self.0 = Some((retraction, xi.clone()));
    }
}

#[test]
fn the_group_factor_of_a_step_carries_the_momentum() {
    let system = HeavyTop::<f64>::default();
    let mut mu = state(&system, &START);
    let mut sink = Last(None);
    let method = LieMidpoint::exp();
    let mut stepper = method.stepper(&system, 0.1, &NewtonOptions::default());
    stepper
        .step(&mut mu, &mut sink)
        .expect("the step converges");
    let (retraction, xi) = sink.0.expect("a factor was pushed");
    assert_eq!(retraction, Retraction::Exp);
    let mut moved = system.zero_state();
    generic::coadjoint_action(&system, &xi, &state(&system, &START), &mut moved);
    assert_eq!(moved, mu);
    let mut sink = Last(None);
    let mut stepper = Rk4.stepper(&system, 0.1, &NewtonOptions::default());
    stepper
        .step(&mut mu, &mut sink)
        .expect("the step is finite");
    assert!(sink.0.is_none());
}
