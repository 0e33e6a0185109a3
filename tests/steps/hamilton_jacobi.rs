//! K-HJ: Poisson maps on any bracket, by generating functions on a symplectic realization.

use crate::frozen_flow::Nambu;
use crate::systems::{
    BodyWithCirculation, Bracketed as _, CanonicalPendulum, FreeRigidBody, LotkaVolterra, distance,
};
use lie_runtime::diagnostics::{order_of_convergence, poisson_defect, reference, symmetry_defect};
use lie_runtime::generic;
use lie_runtime::methods::{
    Compose4, Facts, Gauss4, Generating4, Generating6, HamiltonJacobi2, HamiltonJacobi4,
    HamiltonJacobi6, ImplicitMidpoint, ImplicitStepper, LieMidpoint, Method,
};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use lie_runtime::{Lift, Poisson, State};

/// The state after steps from a start.
fn after<P: Poisson<f64>>(
    system: &P,
    method: &impl Method<f64, P>,
    start: &P::State,
    (h, steps): (f64, u32),
) -> P::State {
    let mut mu = start.clone();
    let mut stepper = method.stepper(system, h, &NewtonOptions::default());
    for _ in 0..steps {
        stepper.step(&mut mu, &mut ()).expect("the step converges");
    }
    mu
}

#[test]
fn orders_and_symmetry() {
    fn check<P, M>(system: &P, start: &P::State, method: &M, counts: &[u32])
    where
        P: Poisson<f64>,
        M: Facts + Method<f64, P> + 'static,
    {
        let exact = reference(system, start, 1.0).expect("a solution").mu;
        let points: Vec<(f64, f64)> = counts
            .iter()
            .map(|&steps| {
                let h = 1.0 / f64::from(steps);
                let end = after(system, method, start, (h, steps));
                (h, distance(end.as_slice(), exact.as_slice()))
            })
            .collect();
        let order = order_of_convergence(&points, 1e-13).unwrap_or_else(|| panic!("{points:?}"));
        let (slope, stated) = (order.slope, f64::from(M::ORDER));
        println!("{} {}: {slope}", system.name(), M::ID);
        assert!(
            (slope - stated).abs() < 0.3,
            "{} on {}: {slope}, {points:?}",
            M::ID,
            system.name()
        );
        let options = NewtonOptions::default();
        let off = symmetry_defect(system, method, 0.1, start, &options).expect("steps");
        assert!(off < 1e-14, "{} on {}: {off:e}", M::ID, system.name());
    }
    let nambu = Nambu::new();
    let (nambu, start) = (nambu.system().expect("constants"), nambu.initial_state());
    let (fine, coarse) = ([20, 28, 40, 56, 80], [8, 11, 16, 22, 32]);
    check(&nambu, &start, &HamiltonJacobi2::new(), &fine);
    check(&nambu, &start, &HamiltonJacobi4::new(), &fine);
    check(&nambu, &start, &HamiltonJacobi6::new(), &coarse);
    check(
        &nambu,
        &start,
        &Compose4::new(HamiltonJacobi2::new()),
        &fine,
    );
    let species = (LotkaVolterra::declared(), LotkaVolterra::initial::<f64>());
    check(&species.0, &species.1, &HamiltonJacobi2::new(), &fine);
    check(&species.0, &species.1, &HamiltonJacobi4::new(), &fine);
    check(&species.0, &species.1, &HamiltonJacobi6::new(), &coarse);
    let body = (
        BodyWithCirculation::declared(),
        BodyWithCirculation::initial::<f64>(),
    );
    check(&body.0, &body.1, &HamiltonJacobi4::new(), &fine);
    check(&body.0, &body.1, &HamiltonJacobi6::new(), &coarse);
}

/// To round-off at any step, on brackets of degree zero to three. The controls are Poisson to their order only.
#[test]
fn steps_are_poisson_maps() {
    macro_rules! defects {
        ($name:literal, $dual:expr, $start:expr) => {{
            let (dual, start) = ($dual, $start);
            let options = NewtonOptions::default();
            let mut worst = 0.0_f64;
            for h in [0.05, 0.2] {
                for defect in [
                    poisson_defect(&dual, &HamiltonJacobi2::new(), h, &start, &options),
                    poisson_defect(&dual, &HamiltonJacobi4::new(), h, &start, &options),
                    poisson_defect(&dual, &HamiltonJacobi6::new(), h, &start, &options),
                ] {
                    worst = worst.max(defect.expect("the step converges"));
                }
            }
            let control = poisson_defect(&dual, &Gauss4, 0.2, &start, &options);
            println!("{}: {worst:e}, control {control:?}", $name);
            assert!(worst < 1e-13, "{}: {worst:e}", $name);
            control.expect("the step converges")
        }};
    }
    let nambu = Nambu::new();
    let start = nambu.initial_state();
    let dual = nambu.system().expect("constants").lift();
    assert!(defects!("Nambu", dual, start.as_slice()) > 1e-6);
    let start = LotkaVolterra::initial::<f64>();
    assert!(
        defects!(
            "species",
            LotkaVolterra::declared::<f64>().lift(),
            start.as_slice()
        ) > 1e-8
    );
    let start = BodyWithCirculation::initial::<f64>();
    let dual = BodyWithCirculation::declared::<f64>().lift();
    assert!(defects!("cocycle", dual, start.as_slice()) > 1e-10);
    // every Gauss method is a Poisson map of a constant bracket
    let start = CanonicalPendulum::initial::<f64>();
    let dual = CanonicalPendulum::declared::<f64>().lift();
    assert!(defects!("canonical", dual, start.as_slice()) < 1e-13);
}

/// The energy swings and does not drift, and the Casimir of degree four stays; midpoint and `gauss4` lose both.
#[test]
fn energy_does_not_drift() {
    const STEPS: u32 = 3000;
    let nambu = Nambu::new();
    let (system, start) = (nambu.system().expect("constants"), nambu.initial_state());
    let casimir = |mu: &_| {
        let mut value = [0.0];
        system.casimirs(mu, &mut value);
        value[0]
    };
    fn walk<P: Poisson<f64>>(
        system: &P,
        method: &impl Method<f64, P>,
        start: &P::State,
        casimir: impl Fn(&P::State) -> f64,
    ) -> [f64; 3] {
        let (energy, level) = (system.hamiltonian(start), casimir(start));
        let mut mu = start.clone();
        let mut stepper = method.stepper(system, 0.1, &NewtonOptions::default());
        let (mut means, mut off) = ([0.0_f64; 2], 0.0_f64);
        for k in 0..STEPS {
            stepper.step(&mut mu, &mut ()).expect("the step converges");
            let error = (system.hamiltonian(&mu) - energy) / f64::from(STEPS / 10);
            match 10 * k / STEPS {
                0 => means[0] += error,
                9 => means[1] += error,
                _ => {}
            }
            off = off.max((casimir(&mu) - level).abs());
        }
        let [first, last] = means;
        [first.abs(), (last - first).abs(), off]
    }
    let [size, drift, off] = walk(&system, &HamiltonJacobi4::new(), &start, casimir);
    println!("k-hj4: mean error {size:e}, drift {drift:e}, Casimir {off:e}");
    assert!(drift < 2e-7 && off < 1e-13, "{drift:e}, {off:e}");
    let [size, drift, off] = walk(&system, &Gauss4, &start, casimir);
    println!("gauss4: mean error {size:e}, drift {drift:e}, Casimir {off:e}");
    assert!(
        drift > 2e-6 && off > 1e-6,
        "control: {size:e}, {drift:e}, {off:e}"
    );
}

/// Functions written out by the compiler and those over dual numbers make the same steps.
#[test]
fn fused_functions_are_the_generic_ones() {
    let nambu = Nambu::new();
    let (system, start) = (nambu.system().expect("constants"), nambu.initial_state());
    let h = 0.2;
    macro_rules! compare {
        ($function:ident) => {
            let function = generic::$function::new(&system, h);
            let equation = generic::RealizationStep::with_function(&system, function, h);
            let options = NewtonOptions::newton();
            let mut stepper = ImplicitStepper::new(equation, system.zero_state(), &options);
            let mut mu = start;
            for _ in 0..5 {
                stepper.step(&mut mu, &mut ()).expect("the step converges");
            }
            let fused = after(&system, &$function::new(), &start, (h, 5));
            let off = distance(fused.as_slice(), mu.as_slice());
            assert!(off < 1e-14, "{}: {off:e}", stringify!($function));
        };
    }
    compare!(HamiltonJacobi4);
    compare!(HamiltonJacobi6);
}

/// With a bracket that is linear the way is the coadjoint action, and the steps are those of generating functions with exp.
#[test]
fn on_an_algebra_they_are_the_methods_along_exp() {
    let body = FreeRigidBody::new();
    let (system, start) = (body.system().expect("constants"), body.initial_state());
    let at = (0.3, 5);
    let pairs = [
        (
            after(&system, &HamiltonJacobi2::new(), &start, at),
            after(&system, &LieMidpoint::exp(), &start, at),
        ),
        (
            after(&system, &HamiltonJacobi4::new(), &start, at),
            after(&system, &Generating4::exp(), &start, at),
        ),
        (
            after(&system, &HamiltonJacobi6::new(), &start, at),
            after(&system, &Generating6::exp(), &start, at),
        ),
    ];
    for (one, other) in &pairs {
        let off = distance(one.as_slice(), other.as_slice());
        assert!(off < 1e-14, "{off:e}");
    }
    let midpoint = after(&system, &ImplicitMidpoint, &start, at);
    assert!(distance(midpoint.as_slice(), pairs[0].0.as_slice()) > 1e-6);
}

/// Eight lanes have the digits of eight runs.
#[test]
fn lanes_have_the_digits_of_their_own_runs() {
    let nambu = Nambu::new();
    let one = nambu.system().expect("constants");
    let lanes = Nambu::<F64x8>::default();
    let eight = lanes.system().expect("constants");
    let start = nambu.initial_state();
    let mut states = lanes.initial_state();
    for (entry, &value) in states.as_mut_slice().iter_mut().zip(start.as_slice()) {
        for lane in 0..8 {
            *entry = entry.with_lane(lane, value + 0.03 * lane as f64);
        }
    }
    let begun = states;
    let h = F64x8::from_f64(0.2);
    let method = HamiltonJacobi4::new();
    let mut stepper = method.stepper(&eight, h, &NewtonOptions::default());
    for _ in 0..5 {
        stepper
            .step(&mut states, &mut ())
            .expect("the steps converge");
    }
    for lane in 0..8 {
        let mut own = start;
        for (own, entry) in own.as_mut_slice().iter_mut().zip(begun.as_slice()) {
            *own = entry.lane(lane);
        }
        let end = after(&one, &method, &own, (0.2, 5));
        for (own, entry) in end.as_slice().iter().zip(states.as_slice()) {
            assert_eq!(own.to_bits(), entry.lane(lane).to_bits(), "lane {lane}");
        }
    }
}
