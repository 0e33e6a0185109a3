//! Variational methods along the Cayley map beside the group element and the time: orders by slope, what stays exact, both elements of a
//! step, and controls that must fail.

use crate::systems;

use lie_runtime::diagnostics::{order_of_convergence, poisson_defect};
use lie_runtime::methods::{
    Cayley, Exp, FactorSink, Facts, Method, Retraction, Stepper, Variational,
};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use lie_runtime::{Dual, Lift, Poisson};
use nalgebra::{Matrix3, SVector, Vector3};
use systems::driven_body::{self, DrivenBody};
use systems::driven_top::DrivenTop;
use systems::heavy_top::{HeavyTop, START};
use systems::{distance, jacobian_against_differences, state, steps};

lie_runtime::generic_equations!([S: lie_runtime::Scalar] DrivenBody<S>, S: variational2_cayley, variational4_cayley, variational6_cayley);
lie_runtime::generic_equations!([S: lie_runtime::Scalar] HeavyTop<S>, S: variational2_cayley, variational4_cayley, variational6_cayley);

/// The state at t = 1.
fn end<P: Poisson<f64>, M: Method<f64, P>>(
    system: &P,
    method: &M,
    start: &[f64],
    count: u32,
) -> P::State {
    let mut mu = state(system, start);
    let h = 1.0 / f64::from(count);
    steps(system, method, h, count, &mut mu).expect("the steps converge");
    mu
}

/// The slope is that of the order, and the steps are not those along exp.
fn check_order<P, const ORDER: u32>(system: &P, start: &[f64], exact: &P::State)
where
    P: Poisson<f64>,
    Variational<Cayley, ORDER>: Method<f64, P> + Facts + Default,
    Variational<Exp, ORDER>: Method<f64, P> + Default,
{
    let method = Variational::<Cayley, ORDER>::default();
    let points = [6, 8, 12, 16, 24].map(|count| {
        let mu = end(system, &method, start, count);
        (1.0 / f64::from(count), distance(&mu, exact))
    });
    let order = order_of_convergence(&points, 3e-14);
    let slope = order.expect("enough points above round-off").slope;
    println!("{} {ORDER}: {slope:.3}", system.name());
    let close = (slope - f64::from(ORDER)).abs() < 0.05 * f64::from(ORDER);
    assert!(close, "{} {ORDER}: {slope}", system.name());
    let exponential = end(system, &Variational::<Exp, ORDER>::default(), start, 6);
    let apart = distance(&exponential, &end(system, &method, start, 6));
    assert!(apart > 0.05 * points[0].1, "another retraction: {apart:e}");
}

fn check_orders<P>(system: &P, start: &[f64], exact: &P::State)
where
    P: Poisson<f64>,
    Variational<Cayley, 2>: Method<f64, P>,
    Variational<Cayley, 4>: Method<f64, P>,
    Variational<Cayley, 6>: Method<f64, P>,
    Variational<Exp, 2>: Method<f64, P>,
    Variational<Exp, 4>: Method<f64, P>,
    Variational<Exp, 6>: Method<f64, P>,
{
    check_order::<P, 2>(system, start, exact);
    check_order::<P, 4>(system, start, exact);
    check_order::<P, 6>(system, start, exact);
}

#[test]
fn orders_along_the_cayley_map() {
    for (forced, strength) in [(false, None), (true, None), (true, Some(0.4))] {
        let system = DrivenBody { forced, strength };
        let start = &driven_body::START;
        check_orders(&system, start, &end(&system, &Gauss16::new(), start, 24));
    }
    for system in [
        DrivenTop::new(0.0, false, None),
        DrivenTop::new(0.3, true, None),
        DrivenTop::new(0.3, true, Some(0.3)),
    ] {
        check_orders(&system, &START, &end(&system, &Gauss6, &START, 600));
    }
}

#[test]
fn without_forces_the_step_is_a_poisson_map() {
    fn check<M>(method: &M)
    where
        M: Method<f64, HeavyTop> + Method<Dual<f64>, HeavyTop<Dual<f64>>> + Facts,
    {
        let (system, newton) = (HeavyTop::default(), NewtonOptions::default());
        let defect = poisson_defect(&system.lift(), method, 0.4, &START, &newton);
        let defect = defect.expect("a step");
        assert!(defect < 1e-14, "{}: {defect:e}", M::ID);
        let (start, mut mu) = (state(&system, &START), state(&system, &START));
        steps(&system, method, 0.2, 500, &mut mu).expect("the steps converge");
        let [mut before, mut after] = [[0.0; 2]; 2];
        system.casimirs(&start, &mut before);
        system.casimirs(&mu, &mut after);
        for (before, after) in before.into_iter().zip(after) {
            assert!((before - after).abs() < 1e-13, "{before} {after}");
        }
        let drift = (system.hamiltonian(&mu) - system.hamiltonian(&start)).abs();
        assert!(drift < 5e-3, "{}: {drift:e}", M::ID);
    }
    check(&Variational2::cayley());
    check(&Variational4::cayley());
    check(&Variational6::cayley());
    // the control
    let system = HeavyTop::default();
    let defect = poisson_defect(&system.lift(), &Rk4, 0.4, &START, &NewtonOptions::default());
    assert!(defect.expect("a step") > 1e-6);
}

/// A torque that is constant in space, about the vertical, about which gravity has none: in each step the momentum about it grows by just h times it.
#[test]
fn a_torque_that_is_constant_in_space_is_integrated_exactly() {
    fn worst<M: Method<f64, DrivenTop>>(method: &M) -> f64 {
        let (system, h, along) = (DrivenTop::new(0.3, false, None), 0.2, 0.3);
        let mut mu = state(&system, &START);
        let vertical = |mu: &SVector<f64, 6>| mu.fixed_rows::<3>(0).dot(&mu.fixed_rows::<3>(3));
        let mut worst = 0.0_f64;
        for _ in 0..100 {
            let before = vertical(&mu);
            steps(&system, method, h, 1, &mut mu).expect("the step converges");
            worst = worst.max((vertical(&mu) - before - h * along).abs());
        }
        worst
    }
    for error in [
        worst(&Variational2::cayley()),
        worst(&Variational4::cayley()),
        worst(&Variational6::cayley()),
    ] {
        assert!(error < 1e-14, "{error:e}");
    }
    // the control
    assert!(worst(&Gauss6) > 1e-9);
}

/// About the middle of the step all orders are symmetric, with what acts too.
#[test]
fn every_order_is_symmetric() {
    fn undone<M: Method<f64, DrivenTop>>(method: &M) -> f64 {
        let system = DrivenTop::new(0.3, true, Some(0.3));
        let mut mu = state(&system, &START);
        steps(&system, method, 0.2, 1, &mut mu).expect("a step");
        steps(&system, method, -0.2, 1, &mut mu).expect("a step");
        distance(&mu, &state(&system, &START))
    }
    const { assert!(<Variational4<Cayley> as Facts>::SYMMETRIC) };
    assert!(undone(&Variational2::cayley()) < 2e-15);
    assert!(undone(&Variational4::cayley()) < 2e-15);
    assert!(undone(&Variational6::cayley()) < 2e-15);
    // the control: about the beginning, along exp, it is up to the error only
    assert!(undone(&Variational4::exp()) > 1e-9);
}

/// The elements of the steps, as matrices.
#[derive(Default)]
struct Turns(Vec<Matrix3<f64>>);

impl FactorSink<SVector<f64, 6>> for Turns {
    fn push(&mut self, retraction: Retraction, xi: &SVector<f64, 6>) {
        assert_eq!(retraction, Retraction::Cayley);
        let half = Vector3::from(xi.fixed_rows::<3>(0)).cross_matrix() * 0.5;
        let inverse = (Matrix3::identity() - half).try_inverse();
        self.0
            .push(inverse.expect("regular") * (Matrix3::identity() + half));
    }
}

/// A step is by two elements, and gamma, which is fixed in space, is turned back by their product.
#[test]
fn the_group_moves_by_both_elements() {
    fn check<M: Method<f64, DrivenTop>>(method: &M) {
        let system = DrivenTop::new(0.3, true, Some(0.3));
        let (start, mut mu, mut turns) = (
            state(&system, &START),
            state(&system, &START),
            Turns::default(),
        );
        let mut stepper = method.stepper(&system, 0.2, &NewtonOptions::default());
        for _ in 0..5 {
            stepper.step(&mut mu, &mut turns).expect("a step");
        }
        assert_eq!(turns.0.len(), 10);
        let fixed = |all: &[Matrix3<f64>]| -> f64 {
            let product: Matrix3<f64> = all.iter().product();
            (product * mu.fixed_rows::<3>(3) - start.fixed_rows::<3>(3)).amax()
        };
        assert!(fixed(&turns.0) < 1e-14, "{:e}", fixed(&turns.0));
        // the control
        assert!(fixed(&turns.0[1..]) > 1e-2);
    }
    check(&Variational2::cayley());
    check(&Variational6::cayley());
}

/// The Jacobian of an equation against differences of its residual.
#[test]
fn jacobians_agree_with_differences() {
    let system = DrivenTop::new(0.3, true, Some(0.3));
    let largest = jacobian_against_differences(&system, &Variational4::cayley(), 0.4, &START);
    assert!(largest > 0.1, "it is not the identity alone: {largest}");
}
