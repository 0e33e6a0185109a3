//! Energy and Casimirs by a projection behind the steps of explicit methods: kept to round-off, beside controls that drift.

use crate::systems::{daily, deep};
use lie_runtime::diagnostics::order_of_convergence;
use lie_runtime::driver::{IntegrateError, OptionError, integrate};
use lie_runtime::methods::{Levels, Method, Projection, Stepper, Unkept};
use lie_runtime::newton::{FailureReason, NewtonOptions};
use lie_runtime::prelude::*;
use lie_runtime::{Poisson, Scalar, State};

lie_poisson! {
    /// A free rigid body.
    pub system Body;
    algebra = so(3);
    state x, y, z;
    hamiltonian = x^2/4 + y^2/2 + 3*z^2/4;
    methods = [taylor];
}

lie_poisson! {
    /// A free rigid body on the unit sphere, whose declared Casimir is a square: its gradient is zero there.
    pub system Squared;
    algebra = so(3);
    state x, y, z;
    hamiltonian = x^2/4 + y^2/2 + 3*z^2/4;
    casimir C = (x^2 + y^2 + z^2 - 1)^2;
    methods = [taylor];
}

lie_poisson! {
    /// A heavy top.
    pub system Top;
    algebra = se(3);
    state m1, m2, m3, g1, g2, g3;
    parameters { I1 = 2.0; I2 = 1.5; I3 = 1.0; w = 0.9; }
    hamiltonian = m1^2/(2*I1) + m2^2/(2*I2) + m3^2/(2*I3) + w*(g1/3 + g2/7 + g3);
    initial = [2/5, -1/5, 9/10, 3/10, 1/2, 4/5];
    methods = [taylor];
}

lie_poisson! {
    /// A spin whose energy is no polynomial.
    pub system Spin;
    algebra = so(3);
    state x, y, z;
    hamiltonian = sin(x) + exp(y/2) + sqrt(1 + z^2) + x*y^2*z;
    initial = [3/5, -1/2, 7/10];
    methods = [taylor];
}

lie_poisson! {
    /// A spin in a field that turns.
    pub system Driven;
    algebra = so(3);
    state x, y, z;
    hamiltonian = z^2 + x*cos(t) + y*sin(t);
    initial = [3/5, -1/2, 7/10];
    methods = [taylor];
}

lie_poisson! {
    /// A pendulum in canonical coordinates.
    pub system Pendulum;
    poisson { {q, p} = 1; }
    state q, p;
    hamiltonian = p^2/2 - cos(q);
    initial = [1, 0];
    methods = [taylor];
}

fn top() -> (TopSystem, <TopSystem as Poisson<f64>>::State) {
    let top = Top::<f64>::new();
    (top.system().expect("sound"), top.initial_state())
}

fn spin() -> (SpinSystem, <SpinSystem as Poisson<f64>>::State) {
    let spin = Spin::<f64>::new();
    (spin.system().expect("sound"), spin.initial_state())
}

const DOPRI5: Dopri5 = Dopri5 {
    rtol: 1e-6,
    atol: 1e-9,
};

/// The drift over so many steps of a size.
fn drift<P: Poisson<f64>, M: Method<f64, P>>(
    (system, mu0): (P, P::State),
    method: M,
    (h, steps): (f64, u32),
    keep: Keep,
) -> Drift {
    let problem = Problem {
        system,
        mu0,
        span: (0.0, h * f64::from(steps)),
    };
    let mut monitor = DriftMonitor::<f64>::new();
    let options = Options::new(h).save(Save::Ends).keep(keep);
    integrate(&problem, method, &options, &mut monitor).expect("every step succeeds");
    monitor.drift().clone()
}

/// Whether drift is round-off that does not add up, of values whose terms have the size of 1.
#[track_caller]
fn stays(what: &str, drift: &Drift) {
    for invariant in drift.casimirs.iter().chain([&drift.energy]) {
        println!("{what}: {invariant:?}");
        assert!(invariant.max < 1e-14, "{what}: {invariant:?}");
        let growth = invariant.growth().expect("round-off shows");
        assert!(growth < 3.0, "{what}: {invariant:?}");
    }
}

const STEPS: (f64, u32) = (0.05, daily(10_000, 100_000));
/// So many, for drift to show.
const MORE: (f64, u32) = (0.05, 100_000);

#[test]
fn many_steps_keep_energy_and_casimirs() {
    let taylor = Taylor::with_tolerance(1e-7);
    stays("top, rk4", &drift(top(), Rk4, STEPS, Keep::ALL));
    stays("top, dopri5", &drift(top(), DOPRI5, STEPS, Keep::ALL));
    stays("top, taylor", &drift(top(), taylor, STEPS, Keep::ALL));
    stays("spin, dopri5", &drift(spin(), DOPRI5, STEPS, Keep::ALL));
    stays("spin, taylor", &drift(spin(), taylor, STEPS, Keep::ALL));
    // the controls
    for (what, drift) in [
        ("rk4", drift(top(), Rk4, MORE, Keep::NOTHING)),
        ("dopri5", drift(top(), DOPRI5, MORE, Keep::NOTHING)),
        ("taylor", drift(top(), taylor, MORE, Keep::NOTHING)),
    ] {
        println!("{what}, nothing kept: {drift:?}");
        assert!(drift.energy.max > 1e-9, "{what}: {drift:?}");
        assert!(drift.casimirs[0].max > 1e-9, "{what}: {drift:?}");
        let growth = drift.energy.growth().expect("an error");
        assert!(growth > 3.0, "{what}: {drift:?}");
    }
}

#[test]
fn what_is_not_asked_for_is_not_kept() {
    let some = (0.05, 10_000);
    let energy = drift(top(), Rk4, some, Keep::ENERGY);
    assert!(energy.energy.max < 1e-14, "{energy:?}");
    assert!(energy.casimirs[0].max > 1e-9, "{energy:?}");
    let casimirs = drift(top(), Rk4, some, Keep::CASIMIRS);
    assert!(casimirs.energy.max > 1e-9, "{casimirs:?}");
    let kept = casimirs.casimirs.iter();
    assert!(kept.clone().all(|casimir| casimir.max < 1e-14));
}

#[test]
fn casimirs_are_kept_where_the_energy_is_not_constant() {
    let driven = || {
        let driven = Driven::<f64>::new();
        (driven.system().expect("sound"), driven.initial_state())
    };
    let of = |keep| drift(driven(), Rk4, (0.1, 10_000), keep).casimirs;
    let (kept, plain) = (of(Keep::CASIMIRS), of(Keep::NOTHING));
    assert!(!kept.is_empty());
    for (kept, plain) in kept.iter().zip(&plain) {
        println!("{kept:?}, {plain:?}");
        assert!(kept.max < 1e-14, "{kept:?}");
    }
    assert!(plain.iter().any(|casimir| casimir.max > 1e-9), "{plain:?}");
}

/// The end of a run to t = 5.
fn end<P: Poisson<f64>, M: Method<f64, P>>(
    (system, mu0): (P, P::State),
    method: M,
    h: f64,
    keep: Keep,
) -> Vec<f64> {
    let problem = Problem {
        system,
        mu0,
        span: (0.0, 5.0),
    };
    let options = Options::new(h).save(Save::Ends).keep(keep);
    let solution = solve(&problem, method, &options)
        .ok()
        .expect("it is solved");
    solution.mu.last().expect("an end").as_slice().to_vec()
}

fn difference(one: &[f64], other: &[f64]) -> f64 {
    let pairs = one.iter().zip(other);
    pairs.fold(0.0, |most, (a, b)| Scalar::max(most, (a - b).abs()))
}

fn order<P: Poisson<f64>>(made: impl Fn() -> (P, P::State), keep: Keep) -> f64
where
    Taylor: Method<f64, P>,
{
    let exact = end(made(), Taylor::default(), 0.05, Keep::NOTHING);
    let points = (3..9).map(|k| {
        let h = 1.0 / f64::from(1 << k);
        let error = difference(&end(made(), Rk4, h, keep), &exact);
        println!("{keep:?}, h {h}: {error:.2e}");
        (h, error)
    });
    let points: Vec<(f64, f64)> = points.collect();
    order_of_convergence(&points, 1e-13)
        .expect("an order")
        .slope
}

#[test]
fn the_order_stays() {
    for keep in [Keep::ALL, Keep::ENERGY, Keep::CASIMIRS, Keep::NOTHING] {
        for slope in [order(top, keep), order(spin, keep)] {
            println!("{keep:?}: {slope}");
            assert!((slope - 4.0).abs() < 0.3, "{keep:?}: {slope}");
        }
    }
}

#[test]
fn a_tolerance_holds_as_it_does_without() {
    let exact = end(top(), Taylor::default(), 0.05, Keep::NOTHING);
    for rtol in [1e-4, 1e-6, 1e-8, 1e-10] {
        let atol = rtol * 1e-3;
        let error = |keep| difference(&end(top(), Dopri5 { rtol, atol }, 5.0, keep), &exact);
        let (kept, plain) = (error(Keep::ALL), error(Keep::NOTHING));
        println!("rtol {rtol:e}: {kept:.1e}, plain {plain:.1e}");
        assert!(kept < 3.0 * plain, "rtol {rtol:e}: {kept:e}, {plain:e}");
    }
}

#[test]
fn states_off_the_grid_are_on_the_levels_too() {
    fn off<M: Method<f64, TopSystem>>(method: M, keep: Keep) -> f64 {
        let (system, mu0) = top();
        let problem = Problem {
            system,
            mu0,
            span: (0.0, 30.0),
        };
        let times = (0..300).map(|k| 0.0913 * f64::from(k)).collect();
        let options = Options::new(1.0).save(Save::At(times)).keep(keep);
        let solution = solve(&problem, method, &options).expect("it is solved");
        assert_eq!(solution.t.len(), 300);
        let drift = solution.drift();
        let all = drift.casimirs.iter().chain([&drift.energy]);
        all.fold(0.0, |most, invariant| invariant.max.max(most))
    }
    let taylor = Taylor::with_tolerance(1e-6);
    assert!(off(DOPRI5, Keep::ALL) < 1e-14);
    assert!(off(taylor, Keep::ALL) < 1e-14);
    assert!(off(DOPRI5, Keep::NOTHING) > 1e-9);
    assert!(off(taylor, Keep::NOTHING) > 1e-9);
}

#[test]
fn lanes_have_the_bits_of_their_members() {
    fn run<S: Scalar, M: Method<S, TopSystem<S>>>(method: M, scale: S) -> Vec<S> {
        let top = Top::<S>::default();
        let mut mu0 = top.initial_state();
        for entry in mu0.as_mut_slice() {
            *entry *= scale;
        }
        let problem = Problem {
            system: top.system().expect("sound"),
            mu0,
            span: (0.0, 20.0),
        };
        let options = Options::new(0.3).save(Save::Ends).keep(Keep::ALL);
        let solution = solve(&problem, method, &options).expect("it is solved");
        solution.mu.last().expect("an end").as_slice().to_vec()
    }
    let scales: [f64; 8] = core::array::from_fn(|lane| 1.0 + 0.1 * lane as f64);
    macro_rules! check {
        ($method:expr) => {
            deep(move || {
                let wide = run($method, F64x8::new(scales));
                for (lane, scale) in scales.into_iter().enumerate() {
                    let lane: Vec<f64> = wide.iter().map(|entry| entry.lane(lane)).collect();
                    assert_eq!(lane, run($method, scale));
                }
            });
        };
    }
    check!(Rk4);
    check!(DOPRI5);
    check!(Taylor::with_tolerance(1e-6));
}

#[test]
fn an_equilibrium_stays_and_a_level_that_is_too_far_is_an_error() {
    let body = |start: [f64; 3], h: f64| {
        let system = Body::<f64>::new().system().expect("sound");
        let problem = Problem::new(system, start, (0.0, 20.0 * h));
        integrate(&problem, Rk4, &Options::new(h).keep(Keep::ALL), &mut ())
    };
    // the gradients of energy and Casimir depend on each other there
    for start in [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]] {
        body(start, 0.1).expect("nothing is to be corrected");
    }
    // and nearly do beside it
    for start in [[1e-7, 1.0, 1e-7], [1e-10, 1e-10, 1.0]] {
        body(start, 0.1).expect("it is corrected");
    }
    for (start, h) in [([0.5, 0.6, 0.7], 1000.0), ([0.5, 0.6, 0.7], 20.0)] {
        match body(start, h) {
            Err(IntegrateError::Step(error)) => {
                assert_eq!(error.failure.reason, FailureReason::OffLevel, "{error}");
                assert!(error.to_string().contains("a smaller step"), "{error}");
            }
            other => panic!("h = {h}: {other:?}"),
        }
    }
}

#[test]
fn a_casimir_whose_gradient_is_zero_on_its_level_is_kept() {
    for start in [[0.6, 0.0, 0.8], [0.6, 0.48, 0.64]] {
        for h in [0.3, 0.1, 0.01] {
            let length = |keep| {
                let problem = Problem::new(
                    Squared::<f64>::new().system().expect("sound"),
                    start,
                    (0.0, 200.0 * h),
                );
                let options = Options::new(h).save(Save::Ends).keep(keep);
                let solution = solve(&problem, Rk4, &options).expect("it is kept");
                let end = solution.mu.last().expect("an end");
                (end.iter().map(|x| x * x).sum::<f64>() - 1.0).abs()
            };
            let (kept, plain) = (length(Keep::CASIMIRS), length(Keep::NOTHING));
            println!("h = {h}: {kept:e}, {plain:e}");
            // the square of this is round-off of the terms of C
            assert!(kept < 1e-14, "h = {h}: {kept:e}");
            assert!(h < 0.1 || plain > 1e-8, "the control: {plain:e}");
        }
    }
}

#[test]
fn where_gradients_depend_on_each_other_the_remedy_is_to_keep_less() {
    let system = Body::<f64>::new().system().expect("sound");
    let back = |keep, far: [f64; 3]| {
        let start = [0.3, 1.0, 0.2].into();
        let levels = Levels::at(&system, &start, keep).expect("they can be kept");
        let mut projection = Projection::new(&system, levels);
        let mut mu = far.into();
        let lost = projection.bring_back(&system, true, &mut mu);
        (lost, projection.reason(lost))
    };
    // energy and Casimir have the same direction there
    let (lost, reason) = back(Keep::ALL, [0.0, 1.1, 0.0]);
    assert_eq!((lost, reason), (true, FailureReason::DependentLevels));
    assert!(reason.remedy().contains("keep less"), "{reason}");
    assert!(!FailureReason::OffLevel.remedy().contains("keep less"));
    for less in [Keep::ENERGY, Keep::CASIMIRS] {
        assert!(!back(less, [0.0, 1.1, 0.0]).0, "{less:?}");
    }
    // both gradients are zero at the origin, from which no level but its own is reached
    assert_eq!(
        back(Keep::CASIMIRS, [0.0; 3]),
        (true, FailureReason::DependentLevels)
    );
    // a projection that was lost says nothing of the next one
    assert!(!back(Keep::ALL, [0.3, 1.1, 0.2]).0);
}

/// A method with steps of its own comes back behind each of them, not behind those of the grid: what an error of the energy does to
/// the phase is not done.
#[test]
fn methods_with_steps_of_their_own_come_back_behind_each() {
    fn check<M: Method<f64, TopSystem>>(method: impl Fn() -> M) {
        let (system, mu0) = top();
        let levels = Levels::at(&system, &mu0, Keep::ALL).expect("they can be kept");
        let projection = || Projection::new(&system, levels);
        let method = method();
        let mut stepper = method.stepper(&system, LONG, &NewtonOptions::default());
        let mut behind = mu0;
        stepper.step(&mut behind, &mut ()).expect("it is solved");
        assert!(!projection().bring_back(&system, true, &mut behind));
        let mut stepper = method.stepper(&system, LONG, &NewtonOptions::default());
        let left = stepper.keep(projection());
        assert!(left.is_none(), "{} leaves the projection to others", M::ID);
        let mut within = mu0;
        stepper.step(&mut within, &mut ()).expect("it is solved");
        let moved = system.hamiltonian(&within) - system.hamiltonian(&mu0);
        assert!(moved.abs() < 1e-14, "{}: {moved:e}", M::ID);
        let apart = difference(within.as_slice(), behind.as_slice());
        assert!(apart > 1e-9, "{}: {apart:e}", M::ID);
    }
    /// One step of the grid, many of the methods.
    const LONG: f64 = 50.0;
    check(|| DOPRI5);
    check(|| Taylor::with_tolerance(1e-6));
    // one with steps of the grid leaves it to the driver
    let (system, mu0) = top();
    let levels = Levels::at(&system, &mu0, Keep::ALL).expect("they can be kept");
    let mut stepper = Rk4.stepper(&system, 0.1, &NewtonOptions::default());
    let left = stepper.keep(Projection::new(&system, levels));
    assert!(left.is_some());
}

#[test]
fn what_cannot_be_kept_is_refused_before_the_first_step() {
    fn refused<P: Poisson<f64>>((system, mu0): (P, P::State), keep: Keep) -> Option<Unkept> {
        let problem = Problem {
            system,
            mu0,
            span: (0.0, 1.0),
        };
        match integrate(&problem, Rk4, &Options::new(0.1).keep(keep), &mut ()) {
            Err(IntegrateError::Option(OptionError::Keep(why))) => Some(why),
            _ => None,
        }
    }
    let pendulum = || {
        let pendulum = Pendulum::<f64>::new();
        (pendulum.system().expect("sound"), pendulum.initial_state())
    };
    let driven = || {
        let driven = Driven::<f64>::new();
        (driven.system().expect("sound"), driven.initial_state())
    };
    assert_eq!(refused(pendulum(), Keep::ALL), Some(Unkept::NoCasimirs));
    assert_eq!(refused(pendulum(), Keep::ENERGY), None);
    assert_eq!(refused(driven(), Keep::ENERGY), Some(Unkept::Driven));
    assert_eq!(refused(driven(), Keep::CASIMIRS), None);
    let (system, mut mu0) = spin();
    mu0[0] = f64::INFINITY;
    assert_eq!(refused((system, mu0), Keep::ALL), Some(Unkept::NotFinite));
}
