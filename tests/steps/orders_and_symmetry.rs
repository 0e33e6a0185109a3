//! What the constants of each method promise, measured with golden code: order, symmetry, the Poisson
//! structure; each beside a control that must fail the same assertion. Drifts are in `lab`.

use crate::systems::{
    Declared, HeavyTop, KirchhoffBody, NonpolynomialSpin, distance, e2_pendulum, heisenberg_h3,
    relative_distance, se3_heavy_top, se3_kirchhoff, se3_kirchhoff_full, sl2_quadratic,
    so3_cotangent_euler_arnold, so3_cotangent_group, so3_discrete_lagrangian, so3_free_rigid_body,
    so3_gravity_gradient, so3_gyrostat_lagrangian, so3_nonpolynomial, so3_quartic_lagrangian,
    so4_manakov, state, su3_quadratic, toda3_solvable,
};
use crate::vectors::Reference;
use lie_runtime::diagnostics::{order_of_convergence, poisson_defect};
use lie_runtime::methods::{Facts, Method, Stepper};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;

/// Runs a number of steps from the initial state of a declaration.
fn run<P: Poisson<f64>>(
    system: &P,
    method: &impl Method<f64, P>,
    mu: &mut P::State,
    h: f64,
    steps: u32,
) {
    let mut stepper = method.stepper(system, h, &NewtonOptions::default());
    for _ in 0..steps {
        stepper.step(mu, &mut ()).expect("the step converges");
    }
}

/// The order as a slope of errors at t = 2 over eight step sizes.
fn order<D: Declared>(method: &impl Method<f64, D::System<f64>>) -> f64 {
    let reference = Reference::vector(D::FILE);
    let row = reference
        .times()
        .iter()
        .position(|&time| time == "2")
        .expect("the time 2");
    let end = &reference.states()[row];
    let points: Vec<(f64, f64)> = [10, 14, 20, 28, 40, 56, 80, 112, 160]
        .into_iter()
        .map(|steps| {
            let mut mu = D::initial::<f64>();
            let h = 2.0 / f64::from(steps);
            run(&D::declared::<f64>(), method, &mut mu, h, steps);
            (h, distance(mu.as_slice(), end))
        })
        .collect();
    let order = order_of_convergence(&points, 1e-13).unwrap_or_else(|| panic!("{points:?}"));
    println!(
        "{}: slope {:.3} from {} points, errors {:.1e} to {:.1e}",
        D::FILE,
        order.slope,
        order.points,
        points[0].1,
        points[order.points - 1].1
    );
    order.slope
}

/// Within 0.1 of the order that the method states, on three systems with generic data.
fn check_order<M>(method: M)
where
    M: Facts
        + Method<f64, so3_nonpolynomial::NonpolynomialSpinSystem>
        + Method<f64, se3_kirchhoff::KirchhoffBodySystem>
        + Method<f64, se3_heavy_top::HeavyTopSystem>,
{
    println!("{} of order {}", M::ID, M::ORDER);
    for slope in [
        order::<NonpolynomialSpin>(&method),
        order::<KirchhoffBody>(&method),
        order::<HeavyTop>(&method),
    ] {
        assert!(
            (slope - f64::from(M::ORDER)).abs() < 0.1,
            "{}: {slope}",
            M::ID
        );
    }
}

#[test]
fn orders_are_those_stated() {
    check_order(ImplicitMidpoint);
    check_order(LieMidpoint::exp());
    check_order(LieMidpoint::cayley());
    check_order(Gauss4);
    check_order(Gauss6);
    check_order(Rk4);
}

/// The distance after a step of h and one of -h.
fn there_and_back<P: Poisson<f64>>(
    system: &P,
    method: &impl Method<f64, P>,
    start: &P::State,
) -> f64 {
    let mut mu = start.clone();
    run(system, method, &mut mu, 0.1, 1);
    run(system, method, &mut mu, -0.1, 1);
    relative_distance(mu.as_slice(), start.as_slice())
}

const SYMMETRIC: f64 = 4.0 * f64::EPSILON;

macro_rules! symmetry {
    (@cayley $system:ident, $mu:ident, cayley) => {
        assert!(there_and_back(&$system, &LieMidpoint::cayley(), &$mu) < SYMMETRIC);
    };
    (@cayley $system:ident, $mu:ident, exp) => {};
    ($file:ident, $name:ident, $cayley:ident) => {
        let system = $file::$name::<f64>::default()
            .system()
            .expect("valid parameters");
        let mu = $file::$name::<f64>::default().initial_state();
        assert!(there_and_back(&system, &ImplicitMidpoint, &mu) < SYMMETRIC);
        assert!(there_and_back(&system, &Gauss4, &mu) < SYMMETRIC);
        assert!(there_and_back(&system, &Gauss6, &mu) < SYMMETRIC);
        assert!(there_and_back(&system, &LieMidpoint::exp(), &mu) < SYMMETRIC);
        symmetry!(@cayley system, mu, $cayley);
        let control = there_and_back(&system, &Rk4, &mu);
        println!("{}: rk4 there and back {control:.1e}", stringify!($file));
        assert!(control > 100.0 * SYMMETRIC, "{}: {control:e}", stringify!($file));
    };
}

#[test]
fn symmetric_methods_undo_themselves() {
    each_system!(symmetry);
    each_further_system!(symmetry);
}

fn defect<P: Poisson<Dual<f64>>>(
    system: &P,
    method: &impl Method<Dual<f64>, P>,
    mu: &[f64],
    h: f64,
) -> f64 {
    poisson_defect(system, method, h, mu, &NewtonOptions::default()).expect("the step converges")
}

macro_rules! poisson_map {
    (@cayley $system:ident, $mu:ident, $h:ident, $bound:ident, cayley) => {
        assert!(defect(&$system, &LieMidpoint::cayley(), $mu.as_slice(), $h) < $bound);
    };
    (@cayley $system:ident, $mu:ident, $h:ident, $bound:ident, exp) => {};
    ($file:ident, $name:ident, $cayley:ident) => {
        let system = $file::$name::<Dual<f64>>::default().system().expect("valid parameters");
        let mu = $file::$name::<f64>::default().initial_state();
        for h in [0.1, -0.2, 0.5] {
            let size = mu.amax().max(1.0);
            let bound = 32.0 * f64::EPSILON * size;
            let exp = defect(&system, &LieMidpoint::exp(), mu.as_slice(), h);
            println!("{}: h = {h}, defect {exp:.1e}", stringify!($file));
            assert!(exp < bound, "{}: {exp:e}", stringify!($file));
            poisson_map!(@cayley system, mu, h, bound, $cayley);
        }
        let control = defect(&system, &Rk4, mu.as_slice(), 0.1);
        assert!(control > 1e-10, "{}: the control has {control:e}", stringify!($file));
    };
}

/// D Pi D^T = Pi o Phi to round-off, with D by dual numbers through the step.
#[test]
fn lie_midpoint_is_a_poisson_map() {
    each_system!(poisson_map);
    each_further_system!(poisson_map);
}

#[test]
fn the_poisson_defect_of_midpoint_falls_with_the_third_power() {
    let system = HeavyTop::<Dual<f64>>::default()
        .system()
        .expect("valid parameters");
    let mu = HeavyTop::<f64>::default().initial_state();
    let points = [0.4, 0.2, 0.1, 0.05, 0.025]
        .map(|h| (h, defect(&system, &ImplicitMidpoint, mu.as_slice(), h)));
    let order = order_of_convergence(&points, 1e-14).expect("five points");
    println!(
        "Poisson defect of midpoint: slope {:.3}, {points:?}",
        order.slope
    );
    assert!((order.slope - 3.0).abs() < 0.2, "{order:?} of {points:?}");
    assert_eq!(order.points, points.len());
}

/// The same bits from two runs.
#[test]
fn runs_are_reproducible() {
    fn bits<D: Declared>(method: impl Method<f64, D::System<f64>>) -> Vec<u64> {
        let mut mu = D::initial::<f64>();
        run(&D::declared::<f64>(), &method, &mut mu, 0.05, 1000);
        mu.as_slice().iter().map(|x| x.to_bits()).collect()
    }
    assert_eq!(
        bits::<HeavyTop>(LieMidpoint::exp()),
        bits::<HeavyTop>(LieMidpoint::exp())
    );
    assert_eq!(
        bits::<NonpolynomialSpin>(Gauss4),
        bits::<NonpolynomialSpin>(Gauss4)
    );
    let solution = |h: f64| {
        let system = HeavyTop::<f64>::default()
            .system()
            .expect("valid parameters");
        let mu0 = state(&system, &[0.4, 0.3, 0.9, 0.36, 0.48, 0.8]);
        let problem = Problem {
            system,
            mu0,
            span: (0.0, 10.0),
        };
        let mut csv = Vec::new();
        let solution = solve(&problem, Gauss6, &Options::new(h)).expect("it converges");
        solution
            .write_csv(&mut csv)
            .expect("a vector takes everything");
        csv
    };
    assert_eq!(solution(0.01), solution(0.01));
    assert_ne!(solution(0.01), solution(0.02));
}
