//! The order of each method, as a slope, and what its constants say.

use crate::systems;

use lie_runtime::diagnostics::order_of_convergence;
use lie_runtime::methods::{Facts, Method};
use lie_runtime::prelude::*;
use systems::heavy_top::{HeavyTop, START};
use systems::nonpolynomial::Nonpolynomial;
use systems::{distance, state, steps};

/// The state of the non-polynomial system at t = 1 from (0.6, -0.5, 0.7).
const NONPOLYNOMIAL: [f64; 3] = [0.18714184953656818, 0.09258594649146742, 1.0278160198519537];
/// The state of the heavy top at t = 1.
const TOP: [f64; 6] = [
    0.702124293102685,
    -0.19397034937192864,
    0.8493552060006306,
    0.6478081064813676,
    0.2690475836433316,
    0.712711761452489,
];

fn slope<P: Poisson<f64>, M: Method<f64, P>>(
    system: &P,
    method: &M,
    start: &[f64],
    end: &[f64],
) -> f64 {
    let end = state(system, end);
    let points: Vec<(f64, f64)> = [8, 12, 16, 24, 32, 48, 64]
        .into_iter()
        .map(|count| {
            let mut mu = state(system, start);
            let h = 1.0 / f64::from(count);
            steps(system, method, h, count, &mut mu).expect("the steps converge");
            (h, distance(&mu, &end))
        })
        .collect();
    order_of_convergence(&points, 3e-14)
        .expect("enough points above round-off")
        .slope
}

/// The same of a state between two steps: the end lies 0.4 of a step beyond the last one.
fn slope_between<P: Poisson<f64> + Clone, M: Method<f64, P> + Clone>(
    system: &P,
    method: &M,
    start: &[f64],
    end: &[f64],
) -> f64 {
    let exact = state(system, end);
    let problem = Problem {
        system: system.clone(),
        mu0: state(system, start),
        span: (0.0, 1.0),
    };
    let points: Vec<(f64, f64)> = [8, 12, 16, 24, 32, 48, 64]
        .into_iter()
        .map(|count| {
            let h = 1.0 / (f64::from(count) + 0.4);
            let options = Options::new(h).save(Save::At(vec![1.0]));
            let solution = solve(&problem, method.clone(), &options).ok();
            let found = solution.expect("the steps converge");
            assert_eq!(found.stats.steps, count as u64 + 1);
            (h, distance(&found.mu[0], &exact))
        })
        .collect();
    let order = order_of_convergence(&points, 3e-14);
    order.expect("enough points above round-off").slope
}

fn check<M>(method: M)
where
    M: Method<f64, Nonpolynomial> + Method<f64, HeavyTop> + Facts + Clone,
{
    let order = f64::from(M::ORDER);
    let first = slope(&Nonpolynomial, &method, &[0.6, -0.5, 0.7], &NONPOLYNOMIAL);
    let second = slope(&HeavyTop::default(), &method, &START, &TOP);
    let start = [0.6, -0.5, 0.7];
    let between = slope_between(&Nonpolynomial, &method, &start, &NONPOLYNOMIAL);
    for slope in [first, second, between] {
        assert!(
            (slope - order).abs() < 0.1,
            "{}: {first} and {second}, between steps {between}",
            M::ID
        );
    }
}

#[test]
fn measured_orders_are_the_declared_ones() {
    check(ImplicitMidpoint);
    check(Gauss4);
    check(Gauss6);
    check(LieMidpoint::exp());
    check(LieMidpoint::cayley());
    check(Rk4);
}

#[test]
fn the_adaptive_method_follows_its_tolerance() {
    let error = |rtol: f64| {
        let system = HeavyTop::<f64>::default();
        let mut mu = state(&system, &START);
        steps(
            &system,
            &Dopri5 {
                rtol,
                atol: rtol * 1e-3,
            },
            1.0,
            1,
            &mut mu,
        )
        .expect("it converges");
        distance(&mu, &state(&system, &TOP))
    };
    for rtol in [1e-4, 1e-6, 1e-8, 1e-10] {
        let error = error(rtol);
        assert!(
            error < 20.0 * rtol && error > 1e-4 * rtol,
            "rtol {rtol:e}: {error:e}"
        );
    }
}

#[test]
fn symmetric_methods_undo_themselves() {
    fn there_and_back<M: Method<f64, HeavyTop>>(method: &M) -> f64 {
        let system = HeavyTop::<f64>::default();
        let start = state(&system, &START);
        let mut mu = start;
        steps(&system, method, 0.1, 1, &mut mu).expect("the step converges");
        steps(&system, method, -0.1, 1, &mut mu).expect("the step converges");
        let distance = distance(&mu, &start);
        assert_eq!(distance < 1e-15, M::SYMMETRIC, "{}: {distance:e}", M::ID);
        distance
    }
    there_and_back(&ImplicitMidpoint);
    there_and_back(&Gauss4);
    there_and_back(&Gauss6);
    there_and_back(&LieMidpoint::exp());
    there_and_back(&LieMidpoint::cayley());
    assert!(there_and_back(&Rk4) > 1e-9);
}

/// `mu -> s mu`, `t -> t/s` leaves the equations of the rigid body alone; tolerances that are scaled too leave
/// every decision of the step control alone, and with a power of two every digit.
#[test]
fn the_step_control_has_no_scale() {
    let system = systems::rigid_body::RigidBody::default();
    let start = [0.8, 0.1, 0.6];
    let run = |scale: f64, rtol: f64| {
        let method = Dopri5 {
            rtol,
            atol: 1e-9 * scale,
        };
        let mut mu = state(&system, &start.map(|entry| entry * scale));
        steps(&system, &method, 5.0 / scale, 3, &mut mu).expect("finite");
        mu / scale
    };
    let expected = run(1.0, 1e-7);
    for exponent in [-60, -7, 5, 40] {
        assert_eq!(run(2.0_f64.powi(exponent), 1e-7), expected, "2^{exponent}");
    }
    assert_ne!(run(1.0, 1e-6), expected);
}
