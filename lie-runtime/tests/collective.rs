//! Collective and isospectral methods, the spherical midpoint method and the discrete rigid body on
//! systems written by hand: single steps against values computed with 60 digits by other code,
//! Jacobians against dual numbers, lanes, the domain of the discrete rigid body.

use crate::systems;

use lie_runtime::methods::{
    Collective2, Collective4, Collective6, Isospectral2, Isospectral4, Isospectral6, MoserVeselov,
    SphericalMidpoint,
};
use lie_runtime::newton::FailureReason;
use lie_runtime::prelude::*;
use lie_runtime::{Equation, Implicit, Lift, Unknown};
use systems::body4::{Body4, coordinates, matrix};
use systems::heavy_top::{HeavyTop, START};
use systems::nonpolynomial::Nonpolynomial;
use systems::rigid_body::RigidBody;
use systems::{distance, state, steps};

const BODY: [f64; 3] = [0.45359612142557737, 0.0, 0.8912073600614353];
const SPIN: [f64; 3] = [0.6, -0.5, 0.7];

/// One step of h against the expected state; a step of half the size must not agree.
fn check<P: Poisson<f64>>(
    system: &P,
    method: &impl Method<f64, P>,
    h: f64,
    start: &[f64],
    expected: &[f64],
) {
    let expected = state(system, expected);
    let mut mu = state(system, start);
    steps(system, method, h, 1, &mut mu).expect("the step converges");
    let error = distance(&mu, &expected);
    assert!(error < 1e-15, "h = {h}: {error:e}");
    let mut half = state(system, start);
    steps(system, method, h / 2.0, 1, &mut half).expect("the step converges");
    assert!(distance(&half, &expected) > 1e-4);
}

#[test]
fn in_the_representation() {
    let body = RigidBody::default();
    let expected = [
        0.45270963866158476,
        -0.04011757747203228,
        0.8907550522117025,
    ];
    check(&body, &Isospectral2::new(), 0.1, &BODY, &expected);
    check(&body, &Collective2::representation(), 0.1, &BODY, &expected);
    let expected = [
        0.45269606214169517,
        -0.04039103619085629,
        0.8907495941715783,
    ];
    check(&body, &Isospectral4::new(), 0.1, &BODY, &expected);
    let expected = [0.45000353715692565, 0.08057709869913106, 0.8893841395659616];
    check(
        &body,
        &Collective4::representation(),
        -0.2,
        &BODY,
        &expected,
    );
    let expected = [0.6696000468530956, -0.5381592495628427, 0.6016813104661721];
    check(&Nonpolynomial, &Isospectral2::new(), -0.2, &SPIN, &expected);
    let expected = [0.6690434651561297, -0.5369553117587733, 0.6033737108176966];
    check(&Nonpolynomial, &Isospectral4::new(), -0.2, &SPIN, &expected);
    // a representation that is not antisymmetric
    let top = HeavyTop::default();
    let expected = [
        0.4442675261197483,
        0.27041760768501044,
        0.8916185707013313,
        0.3869514103271296,
        0.4634825410042103,
        0.7971527709480322,
    ];
    check(&top, &Isospectral2::new(), 0.1, &START, &expected);
    let expected = [
        0.3040117099399502,
        0.3451027742166156,
        0.9197808638964005,
        0.30438904634845326,
        0.5121669225632787,
        0.8031390613680421,
    ];
    check(&top, &Isospectral4::new(), -0.2, &START, &expected);
}

#[test]
fn over_the_hopf_map() {
    let body = RigidBody::default();
    let expected = [0.4526992040499375, -0.04033678405607166, 0.8907504557981247];
    check(&body, &Collective2::hopf(), 0.1, &BODY, &expected);
    let expected = [0.4500031306403577, 0.08058076885394494, 0.8893840127328488];
    check(&body, &Collective4::hopf(), -0.2, &BODY, &expected);
    let expected = [0.6690970609645062, -0.5373812098786154, 0.6029349536044958];
    check(&Nonpolynomial, &Collective2::hopf(), -0.2, &SPIN, &expected);
    let expected = [0.5661113281216886, -0.4694223571075175, 0.7477704292227129];
    check(&Nonpolynomial, &Collective4::hopf(), 0.1, &SPIN, &expected);
}

#[test]
fn on_the_sphere() {
    let body = RigidBody::default();
    let expected = [
        0.45269607019078645,
        -0.04039082584314657,
        0.8907495996190664,
    ];
    check(&body, &SphericalMidpoint, 0.1, &BODY, &expected);
    let expected = [0.6686671642800578, -0.5368550076669222, 0.6038798921611939];
    check(&Nonpolynomial, &SphericalMidpoint, -0.2, &SPIN, &expected);
}

#[test]
fn discrete_body() {
    let body = RigidBody::default();
    let expected = [0.452688455881532, -0.04056114603709798, 0.8907457299048654];
    check(&body, &MoserVeselov, 0.1, &BODY, &expected);
    let expected = [0.4498779580471553, 0.08196663023022391, 0.8893206926593037];
    check(&body, &MoserVeselov, -0.2, &BODY, &expected);
}

/// The Jacobian that an equation writes against the derivative of its residual, by dual numbers.
fn jacobian<P, M>(system: &P, method: &M, start: &[f64]) -> f64
where
    P: Lift<f64> + Implicit<f64, M>,
    P::Lifted: Implicit<Dual<f64>, M>,
{
    let h = 0.3;
    let lifted = system.lift();
    let mut plain = system.equation(method, h);
    let mut dual = lifted.equation(method, Dual::constant_of(h));
    plain.set_base(&state(system, start));
    dual.set_base(&state(&lifted, start));
    let mut unknown = plain.zero_unknown();
    plain.initial_guess(&mut unknown);
    let size = unknown.len();
    for index in 0..size {
        // away from a solution
        let entry = unknown.entry(index);
        unknown.set_entry(index, entry + 0.01 * (index as f64 - 1.3));
    }
    let (mut residual, mut matrix) = (plain.zero_unknown(), plain.zero_matrix());
    plain.linearize(&unknown, &mut residual, &mut matrix);
    let mut error: f64 = 0.0;
    for column in 0..size {
        let mut seeded = dual.zero_unknown();
        for index in 0..size {
            let slope = if index == column { 1.0 } else { 0.0 };
            seeded.set_entry(index, Dual::new(unknown.entry(index), slope));
        }
        let mut out = dual.zero_unknown();
        dual.residual(&seeded, &mut out);
        for row in 0..size {
            let expected = out.entry(row);
            error = error.max((matrix.get(row, column) - expected.derivative).abs());
            error = error.max((residual.entry(row) - expected.value).abs());
        }
    }
    error
}

#[test]
fn jacobians_are_derivatives() {
    let (body, top) = (RigidBody::default(), HeavyTop::default());
    let errors = [
        jacobian(&body, &Isospectral2::new(), &BODY),
        jacobian(&body, &Isospectral4::new(), &BODY),
        jacobian(&Nonpolynomial, &Isospectral4::new(), &SPIN),
        jacobian(&Nonpolynomial, &Isospectral6::new(), &SPIN),
        jacobian(&top, &Isospectral2::new(), &START),
        jacobian(&top, &Isospectral4::new(), &START),
        jacobian(&top, &Isospectral6::new(), &START),
        jacobian(&Nonpolynomial, &Collective2::hopf(), &SPIN),
        jacobian(&Nonpolynomial, &Collective4::hopf(), &SPIN),
        jacobian(&Nonpolynomial, &Collective6::hopf(), &SPIN),
        jacobian(&Nonpolynomial, &SphericalMidpoint, &SPIN),
        jacobian(&body, &MoserVeselov, &BODY),
    ];
    for (index, error) in errors.iter().enumerate() {
        assert!(*error < 3e-15, "{index}: {error:e}");
    }
}

/// The solutions of a ball are known: with `k = |h mu|/(2 I)` the rotation by the angle 2a of
/// `sin 2a = 2k` exists while `k <= 1/2`, and the one with `a > pi/4` is not near the identity.
#[test]
fn the_discrete_body_says_where_it_ends() {
    let ball = RigidBody {
        inertia: [1.0, 1.0, 1.0],
    };
    let start = [0.6, 0.0, 0.8];
    for h in [0.5, -0.9, 0.999] {
        let mut mu = state(&ball, &start);
        steps(&ball, &MoserVeselov, h, 1, &mut mu).expect("a rotation near the identity");
        assert!(distance(&mu, &state(&ball, &start)) < 1e-15);
    }
    for h in [1.001, -1.5, 3.0, 100.0] {
        let mut mu = state(&ball, &start);
        let failure = steps(&ball, &MoserVeselov, h, 1, &mut mu).expect_err("no rotation");
        assert_eq!(failure.reason, FailureReason::RotationTooLarge, "h = {h}");
        assert_eq!(mu, state(&ball, &start));
    }
    // what is not finite is no matter of rotations
    let mut mu = state(&ball, &[f64::NAN, 0.0, 1.0]);
    let failure = steps(&ball, &MoserVeselov, 0.1, 1, &mut mu).expect_err("not finite");
    assert_eq!(failure.reason, FailureReason::NotFinite);
}

#[test]
fn the_domain_of_a_body() {
    let body = RigidBody {
        inertia: [0.95, 1.25, 1.5],
    };
    // |mu| = 0.99
    for (h, inside) in [(1.0, true), (1.5, false), (2.0, false), (4.0, false)] {
        let mut mu = state(&body, &[0.5, 0.3, 0.8]);
        let outcome = steps(&body, &MoserVeselov, h, 1, &mut mu);
        assert_eq!(outcome.is_ok(), inside, "h = {h}");
    }
}

#[test]
fn a_spin_at_rest_stays() {
    for h in [0.1, -3.0] {
        let mut mu = state::<f64, _>(&Nonpolynomial, &[0.0; 3]);
        steps(&Nonpolynomial, &SphericalMidpoint, h, 5, &mut mu).expect("nothing moves");
        steps(&Nonpolynomial, &Collective4::hopf(), h, 5, &mut mu).expect("nothing moves");
        assert_eq!(mu, state::<f64, _>(&Nonpolynomial, &[0.0; 3]));
    }
}

#[test]
fn scales_do_not_matter() {
    // for a quadratic H a state k times as large and a step k times as small give k times the result
    let body = RigidBody::default();
    fn check<M: Method<f64, RigidBody>>(body: &RigidBody, method: M) {
        let mut one = state(body, &BODY);
        steps(body, &method, 0.1, 10, &mut one).expect("converges");
        for power in [-330, -100, -10, 10, 100, 330] {
            let scale = 2.0_f64.powi(power);
            let mut other = state(body, &BODY.map(|x| x * scale));
            steps(body, &method, 0.1 / scale, 10, &mut other).expect("converges");
            assert_eq!(one * scale, other, "{} at {scale:e}", M::ID);
        }
    }
    check(&body, Isospectral2::new());
    check(&body, Isospectral4::new());
    check(&body, Isospectral6::new());
    check(&body, Collective2::hopf());
    check(&body, Collective6::hopf());
    check(&body, SphericalMidpoint);
    check(&body, MoserVeselov);
}

#[test]
fn lanes_have_the_digits_of_scalars() {
    fn check<M, P1, P8>(one: &P1, eight: &P8, method: &M, start: &[f64], per_lane: f64)
    where
        P1: Poisson<f64>,
        P8: Poisson<F64x8>,
        M: Method<f64, P1> + Method<F64x8, P8>,
    {
        let spread = |lane: usize, k: usize| start[k] + per_lane * lane as f64 * (k as f64 - 0.7);
        let mut together = eight.zero_state();
        for (k, entry) in together.as_mut_slice().iter_mut().enumerate() {
            *entry = F64x8::new(core::array::from_fn(|lane| spread(lane, k)));
        }
        steps(eight, method, 0.15, 4, &mut together).expect("lanes converge");
        for lane in 0..8 {
            let numbers: Vec<f64> = (0..start.len()).map(|k| spread(lane, k)).collect();
            let mut mu = state(one, &numbers);
            steps(one, method, 0.15, 4, &mut mu).expect("the lane converges");
            for (a, b) in together.as_slice().iter().zip(mu.as_slice()) {
                assert_eq!(a.lane(lane).to_bits(), b.to_bits(), "{}", M::ID);
            }
        }
    }
    let (body, bodies) = (RigidBody::default(), RigidBody::<F64x8>::default());
    check(&body, &bodies, &MoserVeselov, &BODY, 0.01);
    check(&body, &bodies, &Isospectral4::new(), &BODY, 0.1);
    let spin = Nonpolynomial;
    check(&spin, &spin, &Isospectral6::new(), &SPIN, 0.1);
    check(&spin, &spin, &Collective4::hopf(), &SPIN, 0.1);
    check(&spin, &spin, &SphericalMidpoint, &SPIN, 0.1);
    let (top, tops) = (HeavyTop::default(), HeavyTop::<F64x8>::default());
    check(&top, &tops, &Isospectral4::new(), &START, 0.1);
}

/// A ball in four dimensions that turns in one plane: with `k = h m/(2 c)` the equation `x = k (1 + x^2/4)` of
/// `X = x E` has the solutions x near 0 and 4/x, a rotation that is not near the identity.
#[test]
fn the_discrete_body_stays_on_its_branch() {
    let h = 0.4;
    let start = [0.0, 0.0, 0.7, 0.0, 0.0, 0.0];
    for (moments, sign) in [([0.5; 4], 1.0), ([-0.5; 4], -1.0)] {
        let ball = Body4(moments);
        let mut equation = ball.equation(&MoserVeselov, h);
        let mu = state(&ball, &start);
        equation.set_base(&mu);
        let k = h * start[2] * sign;
        let near = 2.0 * (1.0 - (1.0 - k * k).sqrt()) / k;
        for (x, inside) in [(near, true), (4.0 / near, false)] {
            let unknown = state(
                &ball,
                &start.map(|m| if m == 0.0 { 0.0 } else { sign * x / h }),
            );
            let mut residual = ball.zero_state();
            equation.residual(&unknown, &mut residual);
            assert!(residual.amax() < 1e-13, "{x} is no solution: {residual}");
            let mut end = ball.zero_state();
            equation.result(&unknown, &mut end);
            assert_eq!(end.iter().all(|x| x.is_finite()), inside, "x = {x}");
            assert!(!inside || distance(&end, &mu) < 1e-15);
        }
    }
}

/// A ball in three dimensions, `I = 1`: `sin 2a = h |mu|` has a solution with `a < pi/4` and one with `a > pi/4`, both
/// are solutions of the equation, and only the first is joined to the identity.
#[test]
fn the_discrete_top_stays_on_its_branch() {
    let ball = RigidBody {
        inertia: [1.0, 1.0, 1.0],
    };
    let (h, axis) = (0.7, [0.6, 0.0, 0.8]);
    let near = 0.5 * f64::asin(h);
    for (angle, inside) in [(near, true), (0.5 * core::f64::consts::PI - near, false)] {
        let mut equation = ball.equation(&MoserVeselov, h);
        equation.set_base(&state(&ball, &axis));
        let unknown = state(&ball, &axis.map(|n| 2.0 / h * angle.sin() * n));
        let mut residual = ball.zero_state();
        equation.residual(&unknown, &mut residual);
        assert!(
            residual.amax() < 1e-15,
            "{angle} is no solution: {residual}"
        );
        let mut end = ball.zero_state();
        equation.result(&unknown, &mut end);
        assert_eq!(end.iter().all(|x| x.is_finite()), inside, "{angle}");
        assert!(!inside || distance(&end, &state(&ball, &axis)) < 1e-15);
    }
}

/// A body with one negative moment: `M' = g^T M g` with `h M = g J - J g^T`.
#[test]
fn a_body_in_four_dimensions() {
    let body = Body4([0.9, 0.6, 1.3, -0.2]);
    let start = [0.4, -0.3, 0.2, 0.1, 0.5, -0.2];
    let h = 0.1;
    let mut equation = body.equation(&MoserVeselov, h);
    let mut mu = state(&body, &start);
    equation.set_base(&mu);
    let before = mu;
    steps(&body, &MoserVeselov, h, 1, &mut mu).expect("a rotation near the identity");
    // the rotation by which the step went
    let mut factors = Vec::new();
    let mut again = before;
    let mut stepper = MoserVeselov.stepper(&body, h, &NewtonOptions::default());
    stepper
        .step(&mut again, &mut Collect(&mut factors))
        .expect("as before");
    let mut g = nalgebra::SMatrix::<f64, 4, 4>::identity();
    for k in (1..30).rev() {
        g = nalgebra::SMatrix::identity() + matrix(&factors[0]) * g / f64::from(k);
    }
    let moments = nalgebra::SMatrix::<f64, 4, 4>::from_diagonal(&body.0.into());
    let left = (g * moments - moments * g.transpose()) / h;
    assert!(distance(&coordinates(&left), &before) < 1e-14);
    let moved = g.transpose() * matrix(&before) * g;
    assert!(distance(&coordinates(&moved), &mu) < 1e-14);
}

struct Collect<'a, V>(&'a mut Vec<V>);

impl<V: Clone> lie_runtime::methods::FactorSink<V> for Collect<'_, V> {
    fn push(&mut self, _retraction: lie_runtime::methods::Retraction, xi: &V) {
        self.0.push(xi.clone());
    }
}
