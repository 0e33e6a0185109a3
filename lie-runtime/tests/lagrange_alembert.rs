//! The discrete Lagrange–d'Alembert principle beside the group element and the time, with forces and damping: orders by slope, what stays exact,
//! and controls that must fail.

use crate::systems;

use lie_runtime::diagnostics::{order_of_convergence, poisson_defect};
use lie_runtime::generic::{GalerkinOnGroup, GalerkinStep};
use lie_runtime::methods::{
    EulerArnold2, Exp, Facts, ImplicitStepper, Method, Stepper, Variational,
};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use lie_runtime::{Implicit, Lift, Poisson};
use nalgebra::SVector;
use systems::driven_body::{self, DrivenBody};
use systems::driven_top::{DrivenTop, turned};
use systems::heavy_top::{HeavyTop, START};
use systems::quartic_lagrangian::{BODY, QuarticBody};
use systems::{daily, distance, jacobian_against_differences, state, steps};

lie_runtime::generic_equations!([S: lie_runtime::Scalar] DrivenBody<S>, S: variational2_on_group, variational4_on_group, variational6_on_group);
lie_runtime::generic_equations!([S: lie_runtime::Scalar] HeavyTop<S>, S: variational2_on_group, variational4_on_group, variational6_on_group);

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

fn check_order<P, M>(system: &P, method: &M, start: &[f64], exact: &P::State)
where
    P: Poisson<f64>,
    M: Method<f64, P> + Facts,
{
    const { assert!(M::FORCES && M::DAMPING) };
    let points: Vec<(f64, f64)> = [6, 8, 12, 16, 24]
        .into_iter()
        .map(|count| {
            let mu = end(system, method, start, count);
            (1.0 / f64::from(count), distance(&mu, exact))
        })
        .collect();
    let order = order_of_convergence(&points, 3e-14);
    let slope = order.expect("enough points above round-off").slope;
    println!("{} {}: {slope:.3}", system.name(), M::ID);
    let close = (slope - f64::from(M::ORDER)).abs() < 0.05 * f64::from(M::ORDER);
    assert!(close, "{} {}: {slope}", system.name(), M::ID);
}

#[test]
fn orders_where_the_time_is_carried() {
    for (forced, strength) in [(true, None), (false, Some(0.4)), (true, Some(0.4))] {
        let system = DrivenBody { forced, strength };
        let start = &driven_body::START;
        let exact = end(&system, &Gauss16::new(), start, 24);
        check_order(&system, &Variational2::exp(), start, &exact);
        check_order(&system, &Variational4::exp(), start, &exact);
        check_order(&system, &Variational6::exp(), start, &exact);
        // the control: without the force or the damping it goes elsewhere
        let free = end(&DrivenBody::free(), &Variational6::exp(), start, 24);
        assert!(distance(&free, &exact) > 1e-2);
    }
}

#[test]
fn orders_on_the_group() {
    for system in [
        DrivenTop::new(0.0, false, None),
        DrivenTop::new(0.3, true, None),
        DrivenTop::new(0.0, false, Some(0.3)),
        DrivenTop::new(0.3, true, Some(0.3)),
    ] {
        let exact = end(&system, &Gauss6, &START, 600);
        check_order(&system, &Variational2::exp(), &START, &exact);
        check_order(&system, &Variational4::exp(), &START, &exact);
        check_order(&system, &Variational6::exp(), &START, &exact);
        check_order(&system, &EulerArnold2, &START, &exact);
        check_order(&system, &LieMidpoint::exp(), &START, &exact);
    }
}

/// On momenta alone the principle in phase space is that of the Lagrangian.
#[test]
fn in_phase_space_the_steps_are_those_of_the_lagrangian() {
    fn check<const STAGES: usize>() {
        let (system, newton) = (QuarticBody, NewtonOptions::default());
        let zero = system.zero_state();
        let lagrangian = GalerkinStep::<f64, QuarticBody, STAGES>::new(&system, 0.3);
        let phase = GalerkinOnGroup::<f64, QuarticBody, STAGES>::new(&system, 0.3);
        let mut first = ImplicitStepper::new(lagrangian, zero, &newton);
        let mut second = ImplicitStepper::new(phase, zero, &newton);
        let (mut a, mut b) = (SVector::from(BODY), SVector::from(BODY));
        for _ in 0..20 {
            first.step(&mut a, &mut ()).expect("a step");
            second.step(&mut b, &mut ()).expect("a step");
            assert!((a - b).amax() < 2e-14, "{STAGES}: {a} {b}");
        }
    }
    check::<1>();
    check::<2>();
    check::<3>();
}

#[test]
fn without_forces_the_step_is_a_poisson_map() {
    fn check<M>(method: &M)
    where
        M: Method<f64, HeavyTop>
            + Method<lie_runtime::Dual<f64>, HeavyTop<lie_runtime::Dual<f64>>>
            + Facts,
    {
        let (system, newton) = (HeavyTop::default(), NewtonOptions::default());
        let defect = poisson_defect(&system.lift(), method, 0.4, &START, &newton);
        let defect = defect.expect("a step");
        assert!(defect < 1e-14, "{}: {defect:e}", M::ID);
        let (start, mut mu) = (state(&system, &START), state(&system, &START));
        steps(&system, method, 0.2, daily(150, 500), &mut mu).expect("the steps converge");
        let [mut before, mut after] = [[0.0; 2]; 2];
        system.casimirs(&start, &mut before);
        system.casimirs(&mu, &mut after);
        for (before, after) in before.into_iter().zip(after) {
            assert!((before - after).abs() < 1e-13, "{before} {after}");
        }
        let drift = (system.hamiltonian(&mu) - system.hamiltonian(&start)).abs();
        assert!(drift < 6e-3, "{}: {drift:e}", M::ID);
    }
    check(&Variational2::exp());
    check(&Variational4::exp());
    check(&Variational6::exp());
    // the control
    let system = HeavyTop::default();
    let defect = poisson_defect(&system.lift(), &Rk4, 0.4, &START, &NewtonOptions::default());
    assert!(defect.expect("a step") > 1e-6);
}

/// `Ad*_(g1^-1) m1 - m` is the sum of the impulses, each carried to the beginning by the group element of its node.
#[test]
fn the_spatial_momentum_moves_by_the_force() {
    /// The largest differences over 40 steps, and the smallest where nothing is carried.
    fn balance<const ORDER: u32, const STAGES: usize>(method: Variational<Exp, ORDER>) -> (f64, f64)
    where
        Variational<Exp, ORDER>: Facts,
        for<'a> DrivenBody: Implicit<
                f64,
                Variational<Exp, ORDER>,
                Equation<'a> = GalerkinOnGroup<'a, f64, DrivenBody, STAGES>,
            >,
    {
        let system = DrivenBody {
            forced: true,
            strength: Some(0.4),
        };
        let (h, newton) = (0.2, NewtonOptions::default());
        let mut mu = state(&system, &driven_body::START);
        let mut stepper = method.stepper(&system, h, &newton);
        let tableau = lie_runtime::generic::gauss_tableau::<f64, STAGES>();
        let first = |v: &[f64]| [v[0], v[1], v[2]];
        let (mut exact, mut plain) = (0.0_f64, f64::MAX);
        for _ in 0..40 {
            let start = mu;
            let size = first(start.as_slice())
                .into_iter()
                .map(f64::abs)
                .fold(0.0, f64::max);
            stepper.step(&mut mu, &mut ()).expect("the step converges");
            let pairs = &stepper.unknown().0;
            let rates = pairs
                .clone()
                .map(|pair| first(pair.0[0].as_slice()).map(|y| y / size));
            let along = |weights: &[f64]| -> [f64; 3] {
                let sum = |k| {
                    weights
                        .iter()
                        .zip(&rates)
                        .map(|(w, rate)| w * rate[k])
                        .sum()
                };
                core::array::from_fn(sum)
            };
            let mut carried = turned(along(&tableau.b).map(|x| -x), first(mu.as_slice()));
            let mut still = carried;
            for (i, pair) in pairs.iter().enumerate().take(STAGES) {
                let mut at = start;
                at.as_mut_slice()[..4].copy_from_slice(pair.0[1].as_slice());
                at[4] = start[4] + h * tableau.c[i];
                let impulse = system.torque(&at).map(|f| h * tableau.b[i] * f);
                let weights: Vec<f64> = (0..STAGES)
                    .map(|j| tableau.b[j] * tableau.ratios[i][j])
                    .collect();
                let moved = turned(along(&weights).map(|x| -x), impulse);
                for k in 0..3 {
                    carried[k] -= moved[k];
                    still[k] -= impulse[k];
                }
            }
            let left = |v: [f64; 3]| (0..3).map(|k| (v[k] - start[k]).abs()).fold(0.0, f64::max);
            exact = exact.max(left(carried));
            plain = plain.min(left(still));
        }
        (exact, plain)
    }
    for (exact, plain) in [
        balance::<2, 1>(Variational2::exp()),
        balance::<4, 2>(Variational4::exp()),
        balance::<6, 3>(Variational6::exp()),
    ] {
        assert!(exact < 2e-15 && plain > 1e-4, "{exact:e} {plain:e}");
    }
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
        worst(&Variational2::exp()),
        worst(&Variational4::exp()),
        worst(&Variational6::exp()),
        worst(&EulerArnold2),
    ] {
        assert!(error < 1e-14, "{error:e}");
    }
    // the controls
    assert!(worst(&Rk4) > 1e-7);
    assert!(worst(&Gauss6) > 1e-9);
}

#[test]
fn damping_stays_on_the_orbit_and_order_two_is_symmetric() {
    let damped = DrivenBody {
        forced: false,
        strength: Some(0.4),
    };
    let casimir = |mu: &SVector<f64, 6>| mu.fixed_rows::<3>(0).norm_squared();
    let start = state(&damped, &driven_body::START);
    let change = |end: SVector<f64, 6>| (casimir(&end) - casimir(&start)).abs();
    let far = &driven_body::START;
    assert!(change(end(&damped, &Variational2::exp(), far, 10)) < 1e-14);
    assert!(change(end(&damped, &Variational4::exp(), far, 10)) < 1e-14);
    assert!(change(end(&damped, &Variational6::exp(), far, 10)) < 1e-14);
    assert!(change(end(&damped, &Rk4, far, 10)) > 1e-8, "the control");

    fn undone<M: Method<f64, DrivenTop>>(method: &M) -> f64 {
        let system = DrivenTop::new(0.3, true, Some(0.3));
        let mut mu = state(&system, &START);
        steps(&system, method, 0.2, 1, &mut mu).expect("a step");
        steps(&system, method, -0.2, 1, &mut mu).expect("a step");
        distance(&mu, &state(&system, &START))
    }
    assert!(undone(&Variational2::exp()) < 2e-15);
    assert!(undone(&EulerArnold2) < 2e-15);
    // only up to their error
    assert!(undone(&Variational4::exp()) > 1e-9);
}

/// The Jacobian of an equation against differences of its residual.
#[test]
fn jacobians_agree_with_differences() {
    let system = DrivenTop::new(0.3, true, Some(0.3));
    let largest = jacobian_against_differences(&system, &Variational4::exp(), 0.4, &START);
    assert!(largest > 0.1, "it is not the identity alone: {largest}");
}
