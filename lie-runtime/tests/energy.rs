//! Methods that keep the energy: discrete gradients, coadjoint motion along them, collocation.

use crate::systems::heavy_top::{HeavyTop, START};
use crate::systems::nonpolynomial::Nonpolynomial;
use crate::systems::quartic::Quartic;
use crate::systems::rigid_body::RigidBody;
use crate::systems::{daily, distance, state, steps};
use lie_runtime::diagnostics::{Drift, DriftMonitor, order_of_convergence};
use lie_runtime::driver::integrate;
use lie_runtime::generic::{
    DiscreteGradient, GonzalezGradient, ItohAbeGradient, MeanValueGradient,
};
use lie_runtime::methods::{
    CohenHairer2, CohenHairer4, CohenHairer6, Compose4, Facts, Gonzalez, ItohAbe, MeanValue,
    Method, OrbitEnergy, Stepper,
};
use lie_runtime::newton::{FailureReason, NewtonOptions};
use lie_runtime::prelude::*;
use lie_runtime::{Equation, Implicit, Unknown};
use nalgebra::SVector;

const BODY: [f64; 3] = [0.6, -0.5, 0.7];

/// Calls a macro once per method.
macro_rules! each_method {
    ($check:ident) => {
        $check!(Gonzalez);
        $check!(MeanValue);
        $check!(ItohAbe);
        $check!(OrbitEnergy::gonzalez());
        $check!(OrbitEnergy::mean_value());
        $check!(OrbitEnergy::itoh_abe());
        $check!(CohenHairer2::new());
        $check!(CohenHairer4::new());
        $check!(CohenHairer6::new());
    };
}

fn one_step<P: Poisson<f64>>(system: &P, method: &impl Method<f64, P>, h: f64) -> P::State {
    let mut mu = state(system, &BODY);
    steps(system, method, h, 1, &mut mu).expect("the step converges");
    mu
}

/// Single steps against values computed with 50 digits by other code.
#[test]
fn steps_of_the_nonpolynomial_system() {
    fn check(method: &impl Method<f64, Nonpolynomial>, expected: [[f64; 3]; 2]) {
        for (h, expected) in [0.1, -0.2].into_iter().zip(expected) {
            let error = distance(&one_step(&Nonpolynomial, method, h), &expected);
            assert!(error < 1e-15, "h = {h}: {error:e}");
        }
    }
    let gonzalez = [
        [0.5661405742333044, -0.4694521478697864, 0.7477295841861739],
        [0.6687492937063249, -0.5368675081622518, 0.6037778240768256],
    ];
    let mean_value = [
        [0.566138057536499, -0.4694495830202708, 0.7477330999834725],
        [0.6687876008531611, -0.5368789109600027, 0.6037252520074626],
    ];
    check(&Gonzalez, gonzalez);
    check(&MeanValue, mean_value);
    check(&CohenHairer2::new(), mean_value);
    let itoh_abe = [
        [0.5661644549091782, -0.4694764833645111, 0.7476962227837486],
        [0.6685367299014664, -0.5368040583907633, 0.6040695685662868],
    ];
    check(&ItohAbe, itoh_abe);
    let orbit_gonzalez = [
        [0.5660974090650565, -0.46940815097267835, 0.7477898844262614],
        [0.6690915581356478, -0.5369690452179847, 0.6033081561766731],
    ];
    check(&OrbitEnergy::gonzalez(), orbit_gonzalez);
    let orbit_mean_value = [
        [0.5660948872467924, -0.4694055801794643, 0.7477934072519107],
        [0.6691302719672613, -0.536980481410464, 0.6032550387035366],
    ];
    check(&OrbitEnergy::mean_value(), orbit_mean_value);
    let orbit_itoh_abe = [
        [0.566121378856284, -0.46943258415683947, 0.747756399727673],
        [0.6688757236736168, -0.536905105425725, 0.6036043191097017],
    ];
    check(&OrbitEnergy::itoh_abe(), orbit_itoh_abe);
    let two_stages = [
        [0.5661113549048921, -0.46942236688368677, 0.7477704028089536],
        [0.6690409979716548, -0.5369540946637944, 0.6033775296254221],
    ];
    check(&CohenHairer4::new(), two_stages);
    let three_stages = [
        [0.5661113592543359, -0.4694223713171588, 0.7477703967329703],
        [0.6690407953395888, -0.5369540347118432, 0.6033778076612059],
    ];
    check(&CohenHairer6::new(), three_stages);
}

/// The derivative of a residual by dual numbers against the Jacobian of the equation.
fn jacobian_error<P, D, M>(system: &P, dual: &D, method: &M, start: &[f64], spread: f64) -> f64
where
    P: Implicit<f64, M>,
    D: Implicit<Dual<f64>, M>,
{
    let h = 0.2;
    let mut equation = system.equation(method, h);
    let mut lifted = dual.equation(method, Dual::constant_of(h));
    equation.set_base(&state(system, start));
    lifted.set_base(&state(dual, start));
    let mut unknown = equation.zero_unknown();
    equation.initial_guess(&mut unknown);
    for index in 0..unknown.len() {
        let noise = spread * (7.3 * (index + 1) as f64).sin();
        unknown.set_entry(index, unknown.entry(index) + noise);
    }
    let mut matrix = equation.zero_matrix();
    let mut residual = equation.zero_unknown();
    equation.linearize(&unknown, &mut residual, &mut matrix);
    let mut error: f64 = 0.0;
    for column in 0..unknown.len() {
        let mut seeded = lifted.zero_unknown();
        for index in 0..unknown.len() {
            let seed = if index == column { 1.0 } else { 0.0 };
            seeded.set_entry(index, Dual::new(unknown.entry(index), seed));
        }
        let mut out = lifted.zero_unknown();
        lifted.residual(&seeded, &mut out);
        for row in 0..unknown.len() {
            let entry = out.entry(row);
            error = Scalar::max(error, (entry.value - residual.entry(row)).abs());
            error = Scalar::max(error, (entry.derivative - matrix.get(row, column)).abs());
        }
    }
    error
}

#[test]
fn jacobians_by_dual_numbers() {
    macro_rules! check {
        ($method:expr) => {
            let method = $method;
            for spread in [0.0, 0.05] {
                let errors = [
                    jacobian_error(&Nonpolynomial, &Nonpolynomial, &method, &BODY, spread),
                    jacobian_error(&Quartic::<true>, &Quartic::<true>, &method, &BODY, spread),
                    jacobian_error(
                        &HeavyTop::default(),
                        &HeavyTop::default(),
                        &method,
                        &START,
                        spread,
                    ),
                ];
                // the series of orbit-energy ends at 2^-30
                let bound = if method_id(&method) == "orbit-energy" {
                    1e-9
                } else {
                    1e-14
                };
                for error in errors {
                    assert!(error < bound, "{}: {errors:?}", method_id(&method));
                }
            }
            // another system is noticed
            let error = jacobian_error(&Nonpolynomial, &Quartic::<true>, &method, &BODY, 0.0);
            assert!(error > 1e-3, "{error:e}");
        };
    }
    each_method!(check);
}

fn method_id<M: Facts>(_method: &M) -> &'static str {
    M::ID
}

fn slope<P: Poisson<f64>>(system: &P, method: &impl Method<f64, P>, end: &[f64]) -> f64 {
    let end = state(system, end);
    let points: Vec<(f64, f64)> = [8, 12, 16, 24, 32, 48, 64]
        .into_iter()
        .map(|count| {
            let mut mu = state(system, &BODY);
            let h = 1.0 / f64::from(count);
            steps(system, method, h, count, &mut mu).expect("the steps converge");
            (h, distance(&mu, &end))
        })
        .collect();
    order_of_convergence(&points, 3e-14)
        .expect("enough points above round-off")
        .slope
}

#[test]
fn orders_and_symmetry() {
    // of the non-polynomial system at t = 1
    let end = [0.18714184953656818, 0.09258594649146742, 1.0278160198519537];
    macro_rules! check {
        ($method:expr) => {
            let method = $method;
            let id = method_id(&method);
            let slope = slope(&Nonpolynomial, &method, &end);
            let order = f64::from(order_of(&method));
            assert!((slope - order).abs() < 0.1, "{id}: {slope}");
            let mut mu = one_step(&Nonpolynomial, &method, 0.1);
            steps(&Nonpolynomial, &method, -0.1, 1, &mut mu).expect("the step converges");
            assert!(distance(&mu, &state(&Nonpolynomial, &BODY)) < 4e-16, "{id}");
        };
    }
    each_method!(check);
    let composed = Compose4::new(OrbitEnergy::gonzalez());
    let slope = slope(&Nonpolynomial, &composed, &end);
    assert!((slope - 4.0).abs() < 0.15, "{slope}");
}

fn order_of<M: Facts>(_method: &M) -> u32 {
    M::ORDER
}

fn drift<P, M>(system: P, method: M, start: &[f64], h: f64, steps: u32) -> Drift
where
    P: Poisson<f64>,
    M: Method<f64, P>,
{
    let mu0 = state(&system, start);
    let problem = Problem {
        system,
        mu0,
        span: (0.0, h * f64::from(steps)),
    };
    let mut monitor = DriftMonitor::<f64>::new();
    let options = Options::new(h).save(Save::Ends);
    integrate(&problem, method, &options, &mut monitor).expect("every step converges");
    monitor.drift().clone()
}

#[test]
fn energy_and_quadratic_casimirs_over_a_long_run() {
    const STEPS: u32 = daily(2_000, 100_000);
    macro_rules! check {
        ($method:expr) => {
            let id = method_id(&$method);
            for drift in [
                drift(Nonpolynomial, $method, &BODY, 0.1, STEPS),
                drift(Quartic::<true>, $method, &BODY, 0.1, STEPS / 5),
            ] {
                println!(
                    "{id}: {:.1e} {:.1e}",
                    drift.energy.max, drift.casimirs[0].max
                );
                // round-off adds up like a random walk: 300 times one step's at most
                assert!(drift.energy.max < 2e-13, "{id}: {:?}", drift.energy);
                assert!(drift.casimirs[0].max < 2e-13, "{id}: {:?}", drift.casimirs);
            }
        };
    }
    each_method!(check);
    // the midpoint rule keeps the Casimir, not the energy; classical Runge–Kutta drifts in both
    let control = drift(Nonpolynomial, ImplicitMidpoint, &BODY, 0.1, STEPS);
    assert!(control.energy.max > 1e-4 && control.casimirs[0].max < 2e-13);
    let control = drift(Nonpolynomial, Rk4, &BODY, 0.1, STEPS);
    assert!(control.energy.max > 1e-6 && control.casimirs[0].max > 1e-6);
    assert!(control.energy.growth().expect("an error") > 3.0);
}

/// H as a polynomial of known degree and as any function: the same steps.
#[test]
fn the_exact_quadrature_changes_nothing() {
    macro_rules! check {
        ($method:expr) => {
            for h in [0.1, -0.2, 1e-3] {
                let known = one_step(&Quartic::<true>, &$method, h);
                let unknown = one_step(&Quartic::<false>, &$method, h);
                let error = distance(&known, &unknown);
                assert!(error < 4e-16, "{}, h = {h}: {error:e}", method_id(&$method));
            }
        };
    }
    each_method!(check);
    let other = one_step(&Quartic::<true>, &ImplicitMidpoint, 0.1);
    assert!(distance(&other, &one_step(&Quartic::<true>, &Gonzalez, 0.1)) > 1e-6);
}

/// For a quadratic H, all of order 2 without orbits are the midpoint rule.
#[test]
fn quadratic_energies_give_the_midpoint_rule() {
    let expected = one_step(&RigidBody::default(), &ImplicitMidpoint, 0.1);
    let check = |mu: SVector<f64, 3>| assert!(distance(&mu, &expected) < 4e-16);
    check(one_step(&RigidBody::default(), &Gonzalez, 0.1));
    check(one_step(&RigidBody::default(), &MeanValue, 0.1));
    check(one_step(&RigidBody::default(), &ItohAbe, 0.1));
    check(one_step(&RigidBody::default(), &CohenHairer2::new(), 0.1));
    let expected = one_step(&RigidBody::default(), &Gauss6, 0.1);
    let collocation = one_step(&RigidBody::default(), &CohenHairer6::new(), 0.1);
    assert!(distance(&collocation, &expected) < 4e-16);
}

/// Iterations of the worst of some steps.
fn worst<P: Poisson<f64>>(
    system: &P,
    method: &impl Method<f64, P>,
    start: &[f64],
    h: f64,
    options: &NewtonOptions,
) -> (u32, f64) {
    let mut mu = state(system, start);
    let energy = system.hamiltonian(&mu);
    let mut stepper = method.stepper(system, h, options);
    let mut iterations = 0;
    for _ in 0..daily(200, 1000) {
        let report = stepper.step(&mut mu, &mut ()).expect("the step converges");
        iterations = iterations.max(report.iterations);
    }
    (iterations, (system.hamiltonian(&mu) - energy).abs())
}

/// `epsilon |H|/|d|` is far above `epsilon |mu|` where a step is short, or the motion slow.
#[test]
fn short_steps_and_slow_motion() {
    // of 1000 steps that round in the same direction
    const ROUND_OFF: f64 = 1000.0 * f64::EPSILON;
    // of Newton's method, and of the fixed point where that is tried
    let options = [(NewtonOptions::newton(), 3), (NewtonOptions::default(), 12)];
    macro_rules! check {
        ($method:expr) => {
            for (options, most) in options {
                check!($method, &options, most);
            }
        };
        ($method:expr, $options:expr, $most:expr) => {
            for h in [1e-2, 1e-4, 1e-6, 1e-9, 1e-12] {
                let (iterations, error) = worst(&Nonpolynomial, &$method, &BODY, h, $options);
                assert!(
                    iterations <= $most && error < ROUND_OFF,
                    "h = {h:e}: {iterations}, {error:e}"
                );
            }
            // rotation about an axis, and next to it; 1000 steps at rest
            for offset in [0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3] {
                let start = [offset, 0.7 * offset, 1.0];
                let (iterations, error) =
                    worst(&RigidBody::default(), &$method, &start, 0.1, $options);
                assert!(
                    iterations <= $most && error < ROUND_OFF,
                    "{offset:e}: {iterations}, {error:e}"
                );
            }
            let (iterations, error) =
                worst(&RigidBody::default(), &$method, &[0.0; 3], 0.1, $options);
            assert_eq!((iterations, error), (1, 0.0));
        };
    }
    each_method!(check);
}

/// mu -> s mu, t -> t/s leaves the equations of the rigid body alone: with a power of two every digit
/// stays, and so does every decision.
#[test]
fn nothing_depends_on_the_scale() {
    macro_rules! check {
        ($method:expr) => {
            let system = RigidBody::default();
            for h in [0.1, 1e-4, 1e-7] {
                let expected = one_step(&system, &$method, h);
                for exponent in [-300, -40, 40, 300] {
                    let scale = 2.0_f64.powi(exponent);
                    let mut mu = state(&system, &BODY.map(|entry| entry * scale));
                    steps(&system, &$method, h / scale, 1, &mut mu).expect("the step converges");
                    assert_eq!(mu / scale, expected, "2^{exponent}, h = {h}");
                }
            }
        };
    }
    each_method!(check);
}

#[test]
fn lanes_have_the_digits_of_the_scalar_run() {
    // from nearly at rest to fast, steps from short to long
    let sizes = [1e-9, 1e-6, 1e-3, 0.1, 0.5, 1.0, 1.5, 2.0];
    let h = [0.1, 1e-6, 0.2, -0.1, 1e-3, 0.05, -0.2, 1e-9];
    macro_rules! check {
        ($method:expr) => {
            for options in [NewtonOptions::default(), NewtonOptions::fixed_point()] {
                let mut many = SVector::<F64x8, 3>::from_fn(|row, _| {
                    F64x8::new(sizes.map(|size| size * BODY[row]))
                });
                let mut stepper = $method.stepper(&Nonpolynomial, F64x8::new(h), &options);
                for _ in 0..5 {
                    stepper
                        .step(&mut many, &mut ())
                        .expect("the lanes converge");
                }
                for lane in 0..8 {
                    let mut one = SVector::from(BODY.map(|entry| sizes[lane] * entry));
                    let mut stepper = $method.stepper(&Nonpolynomial, h[lane], &options);
                    for _ in 0..5 {
                        stepper.step(&mut one, &mut ()).expect("the lane converges");
                    }
                    for row in 0..3 {
                        assert_eq!(many[row].lane(lane).to_bits(), one[row].to_bits(), "{lane}");
                    }
                }
            }
        };
    }
    each_method!(check);
}

/// Steps far too long fail with a message, or keep energy and orbit all the same.
#[test]
fn no_step_loses_what_is_kept_without_a_message() {
    let mut failures = 0;
    for h in [1.4, 3.0, 5.7, 22.8, 1e3] {
        for seed in 0..20 {
            let start = BODY.map(|entry| entry * (1.0 + 0.05 * f64::from(seed)));
            let mut mu = SVector::from(start);
            let energy = Nonpolynomial.hamiltonian(&mu);
            let size = mu.norm();
            let method = OrbitEnergy::gonzalez();
            let mut stepper = method.stepper(&Nonpolynomial, h, &NewtonOptions::default());
            for _ in 0..20 {
                if stepper.step(&mut mu, &mut ()).is_err() {
                    failures += 1;
                    break;
                }
                let error = (Nonpolynomial.hamiltonian(&mu) - energy).abs();
                assert!(error < 1e-11, "h = {h}, start {start:?}: {error:e}");
                assert!((mu.norm() - size).abs() < 1e-12);
            }
        }
    }
    assert!(failures > 10, "{failures}");
}

/// Quadrature that does not resolve the gradient along a long step would lose the energy: such steps are refused.
#[test]
fn what_the_nodes_do_not_resolve_is_refused() {
    macro_rules! check {
        ($method:expr) => {{
            let (mut kept, mut refused) = (0, 0);
            for seed in 0..40 {
                let start = BODY.map(|entry| entry * (1.0 + 0.1 * f64::from(seed)));
                let mut mu = SVector::from(start);
                let energy = Nonpolynomial.hamiltonian(&mu);
                match steps(&Nonpolynomial, &$method, 0.9, 1, &mut mu) {
                    Ok(()) => {
                        kept += 1;
                        let error = (Nonpolynomial.hamiltonian(&mu) - energy).abs();
                        let size = energy.abs() + mu.norm() * mu.norm().powi(3);
                        assert!(error < 1e-13 * size, "{start:?}: {error:e}");
                    }
                    Err(failure) => {
                        refused += u32::from(failure.reason == FailureReason::Unresolved);
                    }
                }
            }
            let id = method_id(&$method);
            assert!(
                kept > 3 && refused > 0,
                "{id}: {kept} kept, {refused} refused"
            );
        }};
    }
    check!(MeanValue);
    check!(CohenHairer4::new());
}

/// In single precision, short and long steps.
#[test]
fn single_precision() {
    macro_rules! check {
        ($method:expr) => {
            for h in [0.2, 1e-3] {
                let mut single = SVector::from(BODY.map(|entry| entry as f32));
                let energy = Poisson::<f32>::hamiltonian(&Nonpolynomial, &single);
                let mut stepper =
                    $method.stepper(&Nonpolynomial, h as f32, &NewtonOptions::default());
                for _ in 0..100 {
                    stepper
                        .step(&mut single, &mut ())
                        .expect("the step converges");
                }
                let error = (Poisson::<f32>::hamiltonian(&Nonpolynomial, &single) - energy).abs();
                assert!(error < 50.0 * f32::EPSILON, "h = {h}: {error:e}");
            }
        };
    }
    each_method!(check);
}

/// A derivative through a whole step, where the increment is zero in one lane of the selection.
#[test]
fn dual_numbers_pass_through_every_branch() {
    macro_rules! check {
        ($method:expr) => {
            // at rest, next to it, and moving
            for start in [[0.0, 0.0, 1.0], [1e-13, 0.0, 1.0], [1e-6, 0.0, 1.0], BODY] {
                let system = RigidBody::<Dual<f64>>::default();
                let mut mu = SVector::<Dual<f64>, 3>::from_fn(|row, _| {
                    Dual::new(start[row], [1.0, 0.5, -0.25][row])
                });
                steps(&system, &$method, 0.1, 1, &mut mu).expect("the step converges");
                let change = |sign: f64| {
                    let mut mu = SVector::<f64, 3>::from_fn(|row, _| {
                        start[row] + sign * 1e-5 * [1.0, 0.5, -0.25][row]
                    });
                    steps(&RigidBody::default(), &$method, 0.1, 1, &mut mu).expect("a step");
                    mu
                };
                let difference = (change(1.0) - change(-1.0)) / 2e-5;
                for row in 0..3 {
                    let error = (mu[row].derivative - difference[row]).abs();
                    assert!(error < 1e-9, "{start:?}: {error:e}");
                }
            }
        };
    }
    each_method!(check);
}

#[test]
fn steps_allocate_nothing() {
    macro_rules! check {
        ($method:expr) => {
            let system = HeavyTop::default();
            let mut mu = state(&system, &START);
            let mut stepper = $method.stepper(&system, 0.1, &NewtonOptions::default());
            let allocations = allocation_counter::measure(|| {
                for _ in 0..10 {
                    stepper.step(&mut mu, &mut ()).expect("the step converges");
                }
            });
            assert_eq!(allocations.count_total, 0);
        };
    }
    each_method!(check);
}

/// The mean of `x + x^3 + y^2 z` over an edge of length d with the middle m is that at m and `m d^2/4`: down to where
/// the second is round-off, all discrete gradients have it.
#[test]
fn short_edges_have_their_curvature() {
    fn check<const KNOWN: bool, G: DiscreteGradient<f64, Quartic<KNOWN>>>(units: f64) {
        let system = Quartic::<KNOWN>;
        let (m, y, z) = (1.0, 0.5, -0.75);
        for k in 0..40 {
            let d = 0.1 * 0.6_f64.powi(k);
            let (start, end) = ([m - 0.5 * d, y, z], [m + 0.5 * d, y, z]);
            // the ends as they are rounded
            let (m, d) = (0.5 * (start[0] + end[0]), end[0] - start[0]);
            let mut gradient = G::new(&system);
            gradient.set_start(&system, &start.into());
            let mut out: SVector<f64, 3> = system.zero_state();
            gradient.value(&system, &end.into(), &mut out);
            let expected = m + m * m * m + y * y * z + 0.25 * m * d * d;
            let error = (out[0] - expected).abs();
            assert!(error < units * f64::EPSILON, "d = {d:e}: {error:e}");
        }
    }
    check::<true, GonzalezGradient<f64, _>>(16.0);
    check::<true, MeanValueGradient<f64, _>>(16.0);
    check::<true, ItohAbeGradient<f64, _>>(16.0);
    // by differences of H where these keep their digits
    check::<false, GonzalezGradient<f64, _>>(64.0);
    check::<false, MeanValueGradient<f64, _>>(16.0);
    check::<false, ItohAbeGradient<f64, _>>(64.0);
}

/// The derivative of a discrete gradient in its second argument is `H''/2` where the two are close, however close.
#[test]
fn derivatives_on_short_edges() {
    fn check<G: DiscreteGradient<f64, Nonpolynomial>>(name: &str) {
        let system = Nonpolynomial;
        let start: SVector<f64, 3> = BODY.into();
        let mut hessian = Poisson::<f64>::zero_jacobian(&system);
        system.hessian(&start, &mut hessian);
        for exponent in 4..16 {
            let d = 10_f64.powi(-exponent);
            let mut end = start;
            for (index, entry) in end.iter_mut().enumerate() {
                *entry += d * (7.3 * (index + 1) as f64).sin();
            }
            let mut gradient = G::new(&system);
            gradient.set_start(&system, &start);
            let (mut out, mut derivative) = (start, hessian);
            gradient.linearize(&system, &end, &mut out, &mut derivative);
            let error = (derivative - hessian * 0.5).amax();
            assert!(error < 2.0 * d + 1e-7, "{name}, d = {d:e}: {error:e}");
        }
    }
    check::<GonzalezGradient<f64, _>>("gonzalez");
    check::<MeanValueGradient<f64, _>>("mean-value");
    check::<ItohAbeGradient<f64, _>>("itoh-abe");
}
