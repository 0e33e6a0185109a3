//! Collective methods over a declared realization.

use lie_runtime::generic::Lifting;
use lie_runtime::methods::{Method, Stepper};
use lie_runtime::newton::{FailureReason, NewtonOptions};
use lie_runtime::prelude::*;
use lie_runtime::{Poisson, RealizedPoisson, State};

lie_poisson! {
    /// A body with a Hamiltonian that is no polynomial, over T*R^2 by the Hopf map.
    pub system Hopf;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    parameters { a = 1/3; }
    hamiltonian = x^2/4 + y^2/2 + 3*z^2/4 + a*sin(x - z) + x*y*z/5;
    realization {
        positions q1, q2;
        momenta p1, p2;
        x = (q1*q2 + p1*p2)/2;
        y = (q2*p1 - q1*p2)/2;
        z = (q1^2 + p1^2 - q2^2 - p2^2)/4;
    }
    casimir C = x^2 + y^2 + z^2;
    initial = [1/2, -3/10, 4/5];
}

mod angular {
    use lie_runtime::prelude::*;
    lie_poisson! {
        /// The same body over T*R^3 by the angular momentum.
        pub system Angular;
        algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
        state x, y, z;
        parameters { a = 1/3; scale = 2; }
        hamiltonian = x^2/4 + y^2/2 + 3*z^2/4 + a*sin(x - z) + x*y*z/5;
        realization {
            positions q1, q2, q3;
            momenta p1, p2, p3;
            x = p2*q3 - p3*q2;
            y = p3*q1 - p1*q3;
            z = p1*q2 - p2*q1;
            start = [scale, 0, 0, 0, scale, 1];
        }
        casimir C = x^2 + y^2 + z^2;
    }
}

fn step<P: Poisson<f64>, M: Method<f64, P>>(
    system: &P,
    method: &M,
    h: f64,
    mu: &[f64],
) -> Vec<f64> {
    let mut state = system.zero_state();
    state.as_mut_slice().copy_from_slice(mu);
    let mut stepper = method.stepper(system, h, &NewtonOptions::default());
    stepper.step(&mut state, &mut ()).expect("a step");
    state.as_slice().to_vec()
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .fold(0.0, |largest, (a, b)| f64::max(largest, (a - b).abs()))
}

const MU: [f64; 3] = [0.5, -0.3, 0.8];

#[test]
fn the_declared_hopf_map_gives_the_built_in_lift() {
    let system = Hopf::new().system().unwrap();
    for h in [0.1, -0.3, 0.6] {
        let pairs = [
            (
                step(&system, &Collective2::given(), h, &MU),
                step(&system, &Collective2::hopf(), h, &MU),
            ),
            (
                step(&system, &Collective4::given(), h, &MU),
                step(&system, &Collective4::hopf(), h, &MU),
            ),
            (
                step(&system, &Collective6::given(), h, &MU),
                step(&system, &Collective6::hopf(), h, &MU),
            ),
        ];
        for (given, built_in) in pairs {
            assert!(
                distance(&given, &built_in) < 2e-15,
                "{given:?} {built_in:?}"
            );
        }
    }
}

#[test]
fn another_realization_of_the_same_algebra_gives_another_method_of_the_same_order() {
    let hopf = Hopf::new().system().unwrap();
    let angular = angular::Angular::new().system().unwrap();
    let gap = |h: f64| {
        let one = step(&hopf, &Collective4::given(), h, &MU);
        let other = step(&angular, &Collective4::given(), h, &MU);
        distance(&one, &other)
    };
    // both have a local error of order 5
    let slope = (gap(0.2) / gap(0.1)).log2();
    assert!(gap(0.2) > 1e-9 && (slope - 5.0).abs() < 0.4, "{slope}");
}

/// A step of the canonical system from a given point over mu, and J of its end.
fn from_point<P: RealizedPoisson<f64>>(system: &P, z: &P::Point, h: f64) -> Vec<f64> {
    use lie_runtime::generic::{Canonical, Gauss};
    use lie_runtime::methods::ImplicitStepper;
    let canonical = Canonical::new(system);
    let equation = Gauss::<f64, _, 2>::new(&canonical, h);
    let mut stepper =
        ImplicitStepper::new(equation, system.zero_point(), &NewtonOptions::default());
    let mut point = z.clone();
    stepper.step(&mut point, &mut ()).expect("a step");
    let mut mu = system.zero_state();
    system.momentum_map(&point, &mut mu);
    mu.as_slice().to_vec()
}

/// The largest distance of steps from different points over one state.
fn descent<P: RealizedPoisson<f64>>(system: &P) -> f64 {
    let mut mu = system.zero_state();
    mu.as_mut_slice().copy_from_slice(&MU);
    let mut ends: Vec<Vec<f64>> = Vec::new();
    let mut points: Vec<Vec<f64>> = Vec::new();
    for seed in 0..8 {
        let mut z = system.zero_point();
        for (k, entry) in z.as_mut_slice().iter_mut().enumerate() {
            *entry = (1.7 * f64::from(seed) + 2.3 * k as f64 + 0.4).sin();
        }
        if !Lifting::new(system).lift(system, &mu, &mut z) {
            continue;
        }
        ends.push(from_point(system, &z, 0.3));
        points.push(z.as_slice().to_vec());
    }
    assert!(points.len() >= 4, "{} lifts", points.len());
    assert!(distance(&points[0], &points[1]) > 0.1, "different points");
    ends.iter()
        .map(|end| distance(end, &ends[0]))
        .fold(0.0, f64::max)
}

#[test]
fn a_step_does_not_depend_on_the_point_over_the_state() {
    let hopf = descent(&Hopf::new().system().unwrap());
    let angular = descent(&angular::Angular::new().system().unwrap());
    println!("descent: {hopf:.1e}, {angular:.1e}");
    assert!(hopf < 5e-15 && angular < 5e-15);
}

#[test]
fn casimirs_are_kept_and_the_energy_does_not_drift() {
    let angular = angular::Angular::new().system().unwrap();
    let problem = Problem::new(angular, MU, (0.0, 1000.0));
    let solution = solve(&problem, Collective4::given(), &Options::new(0.1))
        .ok()
        .unwrap();
    let drift = solution.drift();
    assert!(drift.casimirs[0].max < 5e-14, "{:?}", drift.casimirs[0].max);
    assert!(drift.energy.max < 1e-5);
    assert!(drift.energy.growth().unwrap() < 2.0);
}

#[test]
fn a_state_without_a_point_over_it_is_a_failure() {
    let angular = angular::Angular {
        scale: 0.0,
        ..angular::Angular::new()
    };
    // the map has not full rank at the start with this parameter
    let system = angular.system().unwrap();
    let mut state = system.zero_state();
    state.as_mut_slice().copy_from_slice(&MU);
    let before = state;
    let method = Collective2::given();
    let mut stepper = Method::<f64, _>::stepper(&method, &system, 0.1, &NewtonOptions::default());
    let failure = stepper.step(&mut state, &mut ()).expect_err("no lift");
    assert_eq!(failure.reason, FailureReason::NoLift);
    assert_eq!(state, before);
}
