//! What is exact where forces and damping act: energy balance, spatial momentum, orbits, energies that fall.

use crate::systems;

use lie_runtime::methods::{
    CohenHairer2, CohenHairer4, CohenHairer6, CohenHairer8, Collective4, Collective8, Compose4,
    CrouchGrossman3, FactorSink, Facts, Gonzalez, Hopf, Isospectral2, Isospectral4, Isospectral6,
    ItohAbe, LieEuler, LieTaylor, MeanValue, Method, OrbitEnergy, Retraction, Rkmk4, Rkmk6,
    RungeKutta, SphericalMidpoint, Stage, Stepper,
};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use lie_runtime::{LiePoisson, Poisson};
use nalgebra::{Matrix3, SVector, Vector3};
use systems::damped_body::DampedBody;
use systems::driven_body::{DrivenBody, START};
use systems::{distance, state, steps};

const fn body(forced: bool, damped: bool) -> DrivenBody {
    DrivenBody {
        forced,
        strength: if damped { Some(0.4) } else { None },
    }
}

/// The largest change of H with the momentum of the time in a step of 0.1, of 60, and the largest work.
fn balance<M: Method<f64, DrivenBody>>(system: &DrivenBody, method: &M) -> (f64, f64) {
    let mut mu = state(system, &START);
    let (mut before, mut worst, mut work) = (system.hamiltonian(&mu), 0.0_f64, 0.0_f64);
    for _ in 0..60 {
        steps(system, method, 0.1, 1, &mut mu).expect("the step converges");
        let after = system.hamiltonian(&mu);
        worst = worst.max((after - before).abs());
        work = work.max(mu[3].abs());
        before = after;
    }
    (worst, work)
}

#[test]
fn the_balance_of_energy_is_exact() {
    fn check<M: Method<f64, DrivenBody> + Facts>(method: M, exact: bool) {
        for (forced, damped) in [(true, false), (false, true), (true, true)] {
            let (change, work) = balance(&body(forced, damped), &method);
            let what = (M::ID, forced, damped);
            assert_eq!(change < 2e-15, exact, "{what:?}: {change:e}");
            assert!(exact || change > 1e-6, "{what:?}: {change:e}");
            assert!(
                work > 0.1,
                "{what:?}: there is something to balance, {work}"
            );
        }
    }
    check(Gonzalez, true);
    check(MeanValue, true);
    check(ItohAbe, true);
    check(OrbitEnergy::gonzalez(), true);
    check(OrbitEnergy::mean_value(), true);
    check(OrbitEnergy::itoh_abe(), true);
    check(CohenHairer2::new(), true);
    check(CohenHairer4::new(), true);
    check(CohenHairer6::new(), true);
    check(CohenHairer8::new(), true);
    check(ImplicitMidpoint, false);
    check(LieMidpoint::exp(), false);
}

/// `Ad*_(tau(x)) m` on so(3)* by the Cayley map of its matrices.
fn by_cayley(x: Vector3<f64>, m: Vector3<f64>) -> Vector3<f64> {
    let half = x.cross_matrix() * 0.5;
    let one = Matrix3::identity();
    let inverse = (one + half).try_inverse().expect("no pole");
    inverse * ((one - half) * m)
}

#[test]
fn the_spatial_momentum_moves_by_the_force() {
    let system = body(true, true);
    let (mut exp, mut cayley) = ((0.0_f64, f64::MAX), (0.0_f64, f64::MAX));
    let mut mu = state(&system, &START);
    let (method, newton, h) = (LieMidpoint::exp(), NewtonOptions::default(), 0.2);
    let mut stepper = method.stepper(&system, h, &newton);
    let moved = |x: &_, m: &_| {
        let mut out = system.zero_state();
        system.coadjoint_action(x, m, &mut out);
        out
    };
    let at = |p: &_| {
        let (mut xi, mut force) = (system.zero_state(), system.zero_state());
        system.generator(p, &mut xi);
        system.force(p, &mut force);
        (xi * h, force)
    };
    for _ in 0..50 {
        let start = mu;
        stepper.step(&mut mu, &mut ()).expect("the step converges");
        let (x, force) = at(stepper.unknown());
        let change = moved(&-x, &mu) - start;
        exp.0 = exp.0.max((change - moved(&(-x / 2.0), &force) * h).amax());
        // the control: not carried
        exp.1 = exp.1.min((change - force * h).amax());
    }
    assert!(exp.0 < 2e-15 && exp.1 > 1e-5, "{exp:?}");

    let mut mu = state(&system, &START);
    let method = LieMidpoint::cayley();
    let mut stepper = method.stepper(&system, h, &newton);
    for _ in 0..50 {
        let start: Vector3<f64> = mu.fixed_rows::<3>(0).into();
        stepper.step(&mut mu, &mut ()).expect("the step converges");
        let (x, force) = at(stepper.unknown());
        let [x, force] = [x, force].map(|v| Vector3::from(v.fixed_rows::<3>(0)));
        let change = by_cayley(-x, mu.fixed_rows::<3>(0).into()) - start;
        let carried = force - force.cross(&x) * 0.5 + x * (x.dot(&force) * 0.25);
        cayley.0 = cayley.0.max((change - carried * h).amax());
        cayley.1 = cayley.1.min((change - force * h).amax());
    }
    assert!(cayley.0 < 2e-15 && cayley.1 > 1e-5, "{cayley:?}");
}

#[test]
fn damping_keeps_the_orbit() {
    /// The change of the Casimir over 60 steps.
    fn change<P: Poisson<f64>, M: Method<f64, P>>(system: &P, method: &M, start: &[f64]) -> f64 {
        let mut mu = state(system, start);
        let casimir = |mu: &P::State| {
            let mut value = [0.0];
            system.casimirs(mu, &mut value);
            value[0]
        };
        let before = casimir(&mu);
        steps(system, method, 0.1, 60, &mut mu).expect("the steps converge");
        (casimir(&mu) - before).abs()
    }
    fn check<M: Method<f64, DrivenBody> + Facts>(method: M) {
        const { assert!(M::DAMPING && M::PRESERVES.orbit) };
        let change = change(&body(false, true), &method, &START);
        assert!(change < 2e-13, "{}: {change:e}", M::ID);
    }
    fn check_over<M: Method<f64, DampedBody> + Facts>(method: M) {
        const { assert!(M::DAMPING && M::PRESERVES.orbit) };
        let change = change(&DampedBody, &method, &START[..3]);
        assert!(change < 2e-13, "{}: {change:e}", M::ID);
    }
    check(LieMidpoint::exp());
    check(LieMidpoint::cayley());
    check(LieEuler);
    check(CrouchGrossman3);
    check(CommutatorFree4);
    check(Rkmk4);
    check(Rkmk6);
    check(LieTaylor::new());
    check(OrbitEnergy::gonzalez());
    check(OrbitEnergy::mean_value());
    check(Compose4::new(OrbitEnergy::itoh_abe()));
    check_over(Isospectral2::new());
    check_over(Isospectral4::new());
    check_over(Isospectral6::new());
    check_over(Collective4::hopf());
    check_over(Collective8::<Hopf>::hopf());
    check_over(SphericalMidpoint);
    // the controls
    assert!(change(&body(false, true), &Rk4, &START) > 1e-9);
    assert!(change(&body(true, true), &LieMidpoint::exp(), &START) > 1e-2);
}

#[test]
fn methods_on_spaces_over_the_momenta_have_their_order() {
    fn end<M: Method<f64, DampedBody>>(method: &M, count: u32) -> [f64; 3] {
        let mut mu = state(&DampedBody, &START[..3]);
        let h = 1.0 / f64::from(count);
        steps(&DampedBody, method, h, count, &mut mu).expect("the steps converge");
        mu.into()
    }
    fn check<M: Method<f64, DampedBody> + Facts>(method: M) {
        let exact = end(&Rkmk6, 2000);
        let points: Vec<(f64, f64)> = [8, 12, 16, 24, 32, 48]
            .into_iter()
            .map(|count| {
                let error = distance(&end(&method, count), &exact);
                (1.0 / f64::from(count), error)
            })
            .collect();
        let order = lie_runtime::diagnostics::order_of_convergence(&points, 1e-13);
        let slope = order.expect("enough points above round-off").slope;
        println!("{}: {slope:.3}", M::ID);
        assert!(
            (slope - f64::from(M::ORDER)).abs() < 0.2,
            "{}: {slope}",
            M::ID
        );
    }
    check(Isospectral2::new());
    check(Isospectral4::new());
    check(Isospectral6::new());
    check(Collective4::hopf());
    check(SphericalMidpoint);
    let (exact, found) = (end(&Rkmk6, 2000), end(&Collective8::<Hopf>::hopf(), 40));
    assert!(distance(&exact, &found) < 1e-12);
}

#[test]
fn the_energy_falls_at_any_step() {
    /// The largest rise of H in a step, and what it falls by in all, where the time stands still.
    fn falls<M: Method<f64, DrivenBody> + Facts>(method: &M, h: f64) -> (f64, f64) {
        let system = body(false, true);
        let mut mu = state(&system, &START);
        mu[5] = 0.0;
        let energy = |mu: &_| system.energy(mu);
        let (first, mut before, mut rise) = (energy(&mu), energy(&mu), f64::MIN);
        let mut stepper = method.stepper(&system, h, &NewtonOptions::default());
        for _ in 0..25 {
            let step = stepper.step(&mut mu, &mut ());
            assert!(step.is_ok(), "{} {h}: {step:?}", M::ID);
            let after: f64 = energy(&mu);
            rise = rise.max(after - before);
            before = after;
        }
        (rise, first - before)
    }
    fn check<M: Method<f64, DrivenBody> + Facts>(method: M) {
        for h in [0.1, 0.5, 1.0] {
            let (rise, fall) = falls(&method, h);
            println!("{} {h}: {rise:e} {fall}", M::ID);
            assert!(
                rise < 1e-14 && fall > 0.1,
                "{} {h}: {rise:e}, {fall}",
                M::ID
            );
        }
    }
    check(OrbitEnergy::gonzalez());
    check(OrbitEnergy::mean_value());
    check(OrbitEnergy::itoh_abe());
    check(Gonzalez);
    check(MeanValue);
    // the control
    let (rise, _) = falls(&LieEuler, 1.0);
    assert!(rise > 1e-3, "{rise:e}");
}

/// What a step says of its motion on the group: the logarithm of the factor, or the mean of the velocities at the stages.
struct Motion(SVector<f64, 6>);

impl FactorSink<SVector<f64, 6>> for Motion {
    fn push(&mut self, retraction: Retraction, xi: &SVector<f64, 6>) {
        assert_eq!(retraction, Retraction::Exp);
        self.0 += xi;
    }
    fn push_velocity(&mut self, method: RungeKutta, stage: Stage, xi: &SVector<f64, 6>) {
        // one and two stages of Gauss have equal weights
        assert!(method == RungeKutta::Gauss && stage.count <= 2);
        self.0 += xi / stage.count as f64;
    }
}

/// Under damping the group element carries the momentum along.
#[test]
fn the_group_element_moves_along_the_generator() {
    /// What the motion of a step leaves of the momentum at its end.
    fn left<M: Method<f64, DrivenBody>>(method: &M, h: f64) -> f64 {
        let (system, newton) = (body(false, true), NewtonOptions::default());
        let start = state(&system, &START);
        let (mut mu, mut motion) = (start, Motion(start * 0.0));
        let mut stepper = method.stepper(&system, h, &newton);
        stepper
            .step(&mut mu, &mut motion)
            .expect("the step converges");
        let mut carried = start;
        system.coadjoint_action(&motion.0, &start, &mut carried);
        (carried - mu).fixed_rows::<3>(0).amax()
    }
    fn check<M: Method<f64, DrivenBody> + Facts>(method: M, exact: bool) {
        let [first, second] = [0.1, 0.05].map(|h| left(&method, h));
        if exact {
            assert!(first < 2e-15, "{}: {first:e}", M::ID);
        } else {
            // along the gradient it would be of first order
            let order = (first / second).log2();
            assert!(order > 2.7 && first > 1e-9, "{}: {order}, {first:e}", M::ID);
        }
    }
    check(LieMidpoint::exp(), true);
    check(LieEuler, true);
    check(Rkmk4, true);
    check(OrbitEnergy::gonzalez(), true);
    check(ImplicitMidpoint, false);
    check(Gonzalez, false);
    check(MeanValue, false);
    check(Gauss4, false);
    check(CohenHairer4::new(), false);
}

#[test]
fn symmetric_methods_undo_themselves() {
    fn check<M: Method<f64, DrivenBody> + Facts>(method: M) {
        let system = body(true, true);
        let start = state(&system, &START);
        let mut mu = start;
        steps(&system, &method, 0.1, 1, &mut mu).expect("the step converges");
        steps(&system, &method, -0.1, 1, &mut mu).expect("the step converges");
        let distance = distance(&mu, &start);
        assert_eq!(distance < 2e-15, M::SYMMETRIC, "{}: {distance:e}", M::ID);
    }
    check(ImplicitMidpoint);
    check(LieMidpoint::exp());
    check(LieMidpoint::cayley());
    check(Gonzalez);
    check(ItohAbe);
    check(OrbitEnergy::gonzalez());
    check(OrbitEnergy::mean_value());
    check(CohenHairer4::new());
    check(CommutatorFree4);
    check(Rkmk6);
}
