//! Vectors that H does not see: they turn linearly, and are solved for outside the iteration.

use lie_runtime::diagnostics::DriftMonitor;
use lie_runtime::driver::{Options, Save, integrate};
use lie_runtime::methods::{Method, Stepper};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;

lie_poisson! {
    system Carrier;
    algebra = semidirect(so(3), R^3, R^3);
    state a, b, c, x, y, z, u, v, w;
    hamiltonian = (a^2 + b^2/2 + c^2/3)/2 + b^4/8;
    methods = [midpoint, lie-midpoint, rk4];
}

lie_poisson! {
    system Hyperbolic;
    algebra = semidirect(sl(2), R^2);
    state h, e, f, p, q;
    hamiltonian = h^2/4 + e^2/3 + f^2/2 + e*f/5;
    methods = [midpoint];
}

/// `mu1 = mu + h X((mu + mu1)/2)`, by fixed-point iteration over all coordinates.
fn midpoint<P: Poisson<f64>>(system: &P, mu: &P::State, h: f64) -> P::State {
    let mut next = mu.clone();
    let mut field = system.zero_state();
    for _ in 0..200 {
        let mut middle = next.clone();
        for (middle, before) in middle.as_mut_slice().iter_mut().zip(mu.as_slice()) {
            *middle = (*middle + before) / 2.0;
        }
        system.vector_field(&middle, &mut field);
        next.copy_from(mu);
        next.axpy(h, &field);
    }
    next
}

/// The largest difference of a step of the method and one by fixed-point iteration.
fn difference<P: Poisson<f64>>(system: &P, start: &[f64], h: f64) -> f64
where
    ImplicitMidpoint: Method<f64, P>,
{
    let mut mu = system.zero_state();
    mu.as_mut_slice().copy_from_slice(start);
    let expected = midpoint(system, &mu, h);
    let options = NewtonOptions::default();
    let mut stepper = ImplicitMidpoint.stepper(system, h, &options);
    stepper.step(&mut mu, &mut ()).expect("the step is small");
    let pairs = mu.as_slice().iter().zip(expected.as_slice());
    pairs.fold(0.0, |most, (a, b)| f64::max(most, (a - b).abs()))
}

const START: [f64; 9] = [0.6, 0.8, 0.3, 0.1, 0.2, 0.9, -0.4, 0.7, 0.5];

#[test]
fn the_step_is_that_of_an_iteration_over_all() {
    let carrier = Carrier::new().system().expect("no parameters");
    let hyperbolic = Hyperbolic::new().system().expect("no parameters");
    let start = [0.7, 0.4, -0.2, 1.1, -0.6];
    for h in [0.01, 0.1, 0.4, -0.3] {
        let found = difference(&carrier, &START, h);
        assert!(found < 1e-15, "{h}: {found:e}");
        let found = difference(&hyperbolic, &start, h);
        assert!(found < 2e-15, "{h}: {found:e}");
    }
    // the control: the explicit Euler step is another one
    let mu = carrier.zero_state() + lie_runtime::nalgebra::SVector::from(START);
    let mut euler = mu;
    let mut field = mu;
    carrier.vector_field(&mu, &mut field);
    euler += 0.1 * field;
    assert!((euler - midpoint(&carrier, &mu, 0.1)).amax() > 1e-4);
}

#[test]
fn lengths_and_angles_stay() {
    fn drift<M: Method<f64, CarrierSystem<f64>>>(method: M) -> f64 {
        let problem = Problem {
            system: Carrier::new().system().expect("no parameters"),
            mu0: START.into(),
            span: (0.0, 2_000.0),
        };
        let mut monitor = DriftMonitor::<f64>::new();
        let options = Options::new(0.2).save(Save::Ends);
        integrate(&problem, method, &options, &mut monitor).expect("every step converges");
        let casimirs = monitor.drift().casimirs.iter();
        casimirs.fold(0.0, |most, casimir| f64::max(most, casimir.max))
    }
    // quadratic Casimirs: the lengths of both vectors and the angle between them
    for found in [drift(ImplicitMidpoint), drift(LieMidpoint::exp())] {
        assert!(found < 1e-12, "{found:e}");
    }
    let control = drift(Rk4);
    assert!(control > 1e-8, "{control:e}");
}
