//! Forces and damping: the order of each method that says it applies, and what stays exact.

use crate::systems;

use lie_runtime::diagnostics::order_of_convergence;
use lie_runtime::methods::{
    CohenHairer2, CohenHairer4, CohenHairer6, CohenHairer8, Compose4, Compose6, CrouchGrossman3,
    Facts, Gauss16, Gonzalez, ItohAbe, LieEuler, LieTaylor, MeanTensor, MeanValue, Method,
    OrbitEnergy, Rkmk2, Rkmk3, Rkmk4, Rkmk6, Taylor, WithTensor,
};
use lie_runtime::prelude::*;
use lie_runtime::{Poisson, State};
use nalgebra::SVector;
use systems::driven_body::{DrivenBody, START};
use systems::forced_top::ForcedTop;
use systems::{distance, state, steps};

const FORCED: DrivenBody = DrivenBody {
    forced: true,
    strength: None,
};
const DAMPED: DrivenBody = DrivenBody {
    forced: false,
    strength: Some(0.4),
};
const BOTH: DrivenBody = DrivenBody {
    forced: true,
    strength: Some(0.4),
};

type V = <DrivenBody as Poisson<f64>>::State;

/// The state at t = 1.
fn end_from<P, M>(system: &P, method: &M, start: &[f64], count: u32) -> P::State
where
    P: Poisson<f64>,
    M: Method<f64, P>,
{
    let mut mu = state(system, start);
    let h = 1.0 / f64::from(count);
    steps(system, method, h, count, &mut mu).expect("the steps converge");
    mu
}

fn end<M: Method<f64, DrivenBody>>(system: &DrivenBody, method: &M, count: u32) -> V {
    end_from(system, method, &START, count)
}

fn slope<M: Method<f64, DrivenBody>>(system: &DrivenBody, method: &M) -> f64 {
    let exact = end(system, &Gauss16::new(), 24);
    slope_to(&exact, |count| end(system, method, count))
}

fn slope_to<W: State<f64>>(exact: &W, end: impl Fn(u32) -> W) -> f64 {
    let points: Vec<(f64, f64)> = [8, 12, 16, 24, 32]
        .into_iter()
        .map(|count| {
            let mu = end(count);
            (1.0 / f64::from(count), distance(&mu, exact))
        })
        .collect();
    let order = order_of_convergence(&points, 3e-14);
    order.expect("enough points above round-off").slope
}

fn check<M: Method<f64, DrivenBody> + Facts>(method: M, tolerance: f64) {
    const { assert!(M::DAMPING) };
    const { assert!(M::FORCES) };
    for (what, system) in [("forced", FORCED), ("both", BOTH)] {
        let slope = slope(&system, &method);
        println!("{} {what}: {slope:.3}", M::ID);
        let order = f64::from(M::ORDER);
        assert!(
            (slope - order).abs() < tolerance,
            "{} {what}: {slope}",
            M::ID
        );
    }
}

#[test]
fn the_field_is_that_of_force_and_damping() {
    let mu = state(&BOTH, &START);
    let (mut field, mut free, mut generator, mut gradient) = (mu, mu, mu, mu);
    BOTH.vector_field(&mu, &mut field);
    DrivenBody::free().vector_field(&mu, &mut free);
    BOTH.generator(&mu, &mut generator);
    BOTH.gradient(&mu, &mut gradient);
    // the power of what acts beside H is taken from the momentum of the time
    let change: f64 = field.dot(&gradient);
    assert!(change.abs() < 1e-15, "{change:e}");
    let torque = BOTH.torque(&mu);
    let bracket = systems::rigid_body::cross(mu.as_slice(), (generator - gradient).as_slice());
    for k in 0..3 {
        let expected = free[k] + torque[k] + bracket[k];
        assert!((field[k] - expected).abs() < 1e-15);
        assert!(
            torque[k].abs() > 0.01 && bracket[k].abs() > 0.01,
            "the control"
        );
    }
    let (mut jacobian, mut slope) = (BOTH.zero_jacobian(), BOTH.zero_jacobian());
    BOTH.jacobian(&mu, &mut jacobian);
    BOTH.generator_slope(&mu, &mut slope);
    let difference = 1e-5;
    for column in 0..6 {
        let around = |sign: f64| {
            let (mut place, mut field, mut generator) = (mu, mu, mu);
            place[column] += sign * difference;
            BOTH.vector_field(&place, &mut field);
            BOTH.generator(&place, &mut generator);
            (field, generator)
        };
        let (after, before) = (around(1.0), around(-1.0));
        let field = (after.0 - before.0) / (2.0 * difference);
        let generator = (after.1 - before.1) / (2.0 * difference);
        assert!((jacobian.column(column) - field).amax() < 1e-9);
        assert!((slope.column(column) - generator).amax() < 1e-9);
    }
}

#[test]
fn methods_of_the_field_have_their_order() {
    check(ImplicitMidpoint, 0.1);
    check(Gauss4, 0.1);
    check(Gauss6, 0.15);
    check(Rk4, 0.1);
    for system in [FORCED, DAMPED, BOTH] {
        let exact = end(&system, &Gauss16::new(), 24);
        let taylor = end(&system, &Taylor::new(), 4);
        assert!(distance(&taylor, &exact) < 1e-14);
        let fine = end(&system, &Rk4, 2048);
        let apart = distance(&fine, &exact);
        assert!(apart < 1e-12, "{apart:e}");
    }
}

#[test]
fn methods_of_the_algebra_have_their_order() {
    check(LieMidpoint::exp(), 0.1);
    check(LieMidpoint::cayley(), 0.1);
    check(LieEuler, 0.15);
    check(CrouchGrossman3, 0.15);
    check(CommutatorFree4, 0.15);
    check(Rkmk2, 0.15);
    check(Rkmk3, 0.15);
    check(Rkmk4, 0.15);
    check(Rkmk6, 0.25);
    check(Compose4::new(LieMidpoint::exp()), 0.15);
    check(Compose6::new(LieMidpoint::cayley()), 0.3);
    let exact = end(&DAMPED, &Gauss16::new(), 24);
    let found = end(&DAMPED, &LieTaylor::new(), 8);
    assert!(distance(&found, &exact) < 1e-13);
}

#[test]
fn methods_that_balance_the_energy_have_their_order() {
    check(Gonzalez, 0.1);
    check(MeanValue, 0.1);
    check(ItohAbe, 0.1);
    check(WithTensor::new(MeanValue, MeanTensor), 0.1);
    check(OrbitEnergy::gonzalez(), 0.1);
    check(OrbitEnergy::mean_value(), 0.1);
    check(OrbitEnergy::itoh_abe(), 0.1);
    check(CohenHairer2::new(), 0.1);
    check(CohenHairer4::new(), 0.1);
    check(CohenHairer6::new(), 0.15);
    check(Compose4::new(OrbitEnergy::gonzalez()), 0.15);
    for system in [FORCED, DAMPED, BOTH] {
        let exact = end(&system, &Gauss16::new(), 24);
        let found = end(&system, &CohenHairer8::new(), 32);
        let apart = distance(&found, &exact);
        assert!(apart < 1e-12, "{apart:e}");
    }
}

/// On an algebra that is not compact, without a time.
#[test]
fn a_heavy_top_is_forced_and_damped() {
    fn check<M: Method<f64, ForcedTop> + Facts>(method: M, exact: &SVector<f64, 6>) {
        let start = &systems::heavy_top::START;
        let slope = slope_to(exact, |count| end_from(&ForcedTop, &method, start, count));
        println!("{}: {slope:.3}", M::ID);
        let order = f64::from(M::ORDER);
        assert!((slope - order).abs() < 0.25, "{}: {slope}", M::ID);
    }
    let start = &systems::heavy_top::START;
    let exact = end_from(&ForcedTop, &Gauss6, start, 600);
    let other = end_from(&ForcedTop, &Rkmk6, start, 600);
    assert!(distance(&exact, &other) < 1e-14);
    check(LieMidpoint::exp(), &exact);
    check(LieMidpoint::cayley(), &exact);
    check(LieEuler, &exact);
    check(CrouchGrossman3, &exact);
    check(CommutatorFree4, &exact);
    check(Rkmk3, &exact);
    check(Rkmk4, &exact);
    check(Rkmk6, &exact);
    check(Gonzalez, &exact);
    check(OrbitEnergy::gonzalez(), &exact);
    check(CohenHairer4::new(), &exact);
}
