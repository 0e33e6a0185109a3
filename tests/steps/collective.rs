//! Collective and isospectral methods, the spherical midpoint method and the discrete rigid body on
//! the systems of `specs/`: single steps against reference values, orders, what is kept over long
//! runs, the Poisson structure, lanes; each beside a control that must fail the same assertion.

// reference values have more digits than a double
#![allow(clippy::excessive_precision)]

use crate::equations;
use crate::errors;
use crate::systems;

use crate::five_body::{FIVE, FiveBody};
use crate::systems::{
    Declared, FreeRigidBody, HeavyTop, Heisenberg, KirchhoffBody, ManakovTop, NonpolynomialSpin,
    Pendulum, Sl2Quadratic, Su3Quadratic, distance, state,
};
use crate::vectors::steps;
use lie_runtime::diagnostics::{order_of_convergence, poisson_defect};
use lie_runtime::generic::{
    DiscreteBody, DiscreteTop, MatrixStages, QuaternionStages, Spherical, StageMomenta,
};
use lie_runtime::methods::{
    Collective2, Collective4, Collective6, Gauss6, Isospectral2, Isospectral4, Isospectral6,
    LieMidpoint, Method, MoserVeselov, Representation, Rk4, SphericalMidpoint, Stepper,
};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::lie_poisson;
use lie_runtime::scalar::F64x8;
use lie_runtime::{Dual, Implicit, Poisson, Scalar, State};

/// Round-off of a step of numbers near 1.
const STEP: f64 = 1e-15;

lie_poisson! {
    /// Two spins that are coupled, in bases of different scales and orientations.
    system TwoSpins;
    algebra {
        basis a1, b1, a2, b2, a3, b3;
        [a1, a2] = 2*a3; [a2, a3] = 2*a1; [a3, a1] = 2*a2;
        [b1, b2] = -b3; [b2, b3] = -b1; [b3, b1] = -b2;
    }
    state x1, y1, x2, y2, x3, y3;
    hamiltonian = x1*y1 + x2*y2/2 - x3*y3/3 + x3^2/4 + sin(y1)/5 + x1*y3^2/7;
    casimir first = x1^2 + x2^2 + x3^2;
    casimir second = y1^2 + y2^2 + y3^2;
}

lie_poisson! {
    /// The free rigid body of Hairer and Vilmart.
    system Body;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state y1, y2, y3;
    parameters { I1 = 0.6; I2 = 0.8; I3 = 1; }
    hamiltonian = y1^2/(2*I1) + y2^2/(2*I2) + y3^2/(2*I3);
    casimir C = y1^2 + y2^2 + y3^2;
    methods = [moser-veselov, spherical-midpoint, collective4];
}

const SPINS: [f64; 6] = [0.3, -0.5, 0.4, 0.2, -0.6, 0.7];

fn advance<S: Scalar, P: Poisson<S>>(
    system: &P,
    method: &impl Method<S, P>,
    h: S,
    count: u32,
    mu: &mut P::State,
) {
    let mut stepper = method.stepper(system, h, &NewtonOptions::default());
    for _ in 0..count {
        stepper.step(mu, &mut ()).expect("a step");
    }
}

/// The largest error of one step of each size that the file has.
fn error<D: Declared>(name: &str, method: &impl Method<f64, D::System<f64>>) -> f64 {
    let expected = steps(D::FILE, name);
    assert_eq!(expected.len(), 2, "{name} of {}", D::FILE);
    let system = D::declared::<f64>();
    let errors = expected.into_iter().map(|(h, expected)| {
        let mut mu = D::initial::<f64>();
        advance(&system, method, h, 1, &mut mu);
        distance(mu.as_slice(), &expected)
    });
    let error = errors.fold(0.0, f64::max);
    println!("{}: {name}: {error:.1e}", D::FILE);
    error
}

/// One and two stages in the representation, by both names.
fn in_the_representation<D: Declared>()
where
    D::System<f64>: Implicit<f64, Isospectral2>
        + Implicit<f64, Isospectral4>
        + Implicit<f64, Collective2<Representation>>
        + Implicit<f64, Collective4<Representation>>,
{
    assert!(error::<D>("clebsch_gauss_1", &Isospectral2::new()) < STEP);
    assert!(error::<D>("clebsch_gauss_2", &Isospectral4::new()) < STEP);
    assert!(error::<D>("clebsch_gauss_1", &Collective2::representation()) < STEP);
    assert!(error::<D>("clebsch_gauss_2", &Collective4::representation()) < STEP);
    // the bound is no formality: another method misses it
    assert!(error::<D>("clebsch_gauss_2", &LieMidpoint::exp()) > 1e-6);
}

#[test]
fn reference_steps_in_the_representation() {
    in_the_representation::<Pendulum>();
    in_the_representation::<Heisenberg>();
    in_the_representation::<HeavyTop>();
    in_the_representation::<KirchhoffBody>();
    in_the_representation::<Sl2Quadratic>();
    in_the_representation::<FreeRigidBody>();
    in_the_representation::<NonpolynomialSpin>();
    in_the_representation::<ManakovTop>();
    in_the_representation::<Su3Quadratic>();
    assert!(error::<Su3Quadratic>("clebsch_gauss_3", &Isospectral6::new()) < STEP);
    assert!(error::<Su3Quadratic>("clebsch_gauss_3", &Collective6::representation()) < STEP);
}

#[test]
fn reference_steps_of_spins() {
    assert!(error::<FreeRigidBody>("hopf_gauss_1", &Collective2::hopf()) < STEP);
    assert!(error::<FreeRigidBody>("hopf_gauss_2", &Collective4::hopf()) < STEP);
    assert!(error::<NonpolynomialSpin>("hopf_gauss_1", &Collective2::hopf()) < STEP);
    assert!(error::<NonpolynomialSpin>("hopf_gauss_2", &Collective4::hopf()) < STEP);
    assert!(error::<FreeRigidBody>("spherical_midpoint", &SphericalMidpoint) < STEP);
    assert!(error::<NonpolynomialSpin>("spherical_midpoint", &SphericalMidpoint) < STEP);
    assert!(error::<FreeRigidBody>("moser_veselov", &MoserVeselov) < STEP);
    assert!(error::<FreeRigidBody>("moser_veselov", &SphericalMidpoint) > 1e-6);
}

/// Values of `lab/tools/spin_steps.py`: by definition, and through the Hopf map and its lift.
#[test]
fn two_coupled_spins() {
    let system = TwoSpins::<f64>::default().system().expect("valid");
    fn run<M: Method<f64, TwoSpinsSystem>>(system: &TwoSpinsSystem, method: M, h: f64) -> Vec<f64> {
        let mut mu = state(system, &SPINS);
        advance(system, &method, h, 1, &mut mu);
        mu.as_slice().to_vec()
    }
    let check = |method: &dyn Fn(f64) -> Vec<f64>, h: f64, expected: [f64; 6]| {
        let error = distance(&method(h), &expected);
        assert!(error < STEP, "h = {h}: {error:e}");
    };
    let spherical = |h: f64| run(&system, SphericalMidpoint, h);
    let two = |h: f64| run(&system, Collective2::hopf(), h);
    let four = |h: f64| run(&system, Collective4::hopf(), h);
    check(
        &spherical,
        0.1,
        [
            0.26393618509547659304,
            -0.48882734281610707798,
            0.47877862038318782007,
            0.15505691510200941519,
            -0.5577712101401592133,
            0.7190307239571841637,
        ],
    );
    check(
        &spherical,
        -0.2,
        [
            0.33635401409228728127,
            -0.50750663659579030865,
            0.21747470879166476781,
            0.29538458243610196771,
            -0.67050035662927578785,
            0.65968550254668937507,
        ],
    );
    check(
        &two,
        0.1,
        [
            0.26401489087680604238,
            -0.4888415116310507062,
            0.47868655058495464966,
            0.15505798454690729158,
            -0.55781298271408657751,
            0.71902086056978929399,
        ],
    );
    check(
        &two,
        -0.2,
        [
            0.33607209325814075695,
            -0.50750300114255781291,
            0.21852314425229517015,
            0.2953012343006803203,
            -0.67030081572319613157,
            0.65972561330585889865,
        ],
    );
    check(
        &four,
        0.1,
        [
            0.26398272815838939178,
            -0.48882155303669757712,
            0.47876400390728348447,
            0.15505355666711394859,
            -0.55776173030848982131,
            0.71903538428346427331,
        ],
    );
    check(
        &four,
        -0.2,
        [
            0.33607334090904013523,
            -0.50756565403634112149,
            0.21763165281069897195,
            0.2954289849914078244,
            -0.67059016785598599511,
            0.65962021017370882573,
        ],
    );
}

/// The slope of the error at the time 1 against the step size.
fn order<P>(system: &P, method: &impl Method<f64, P>, start: &[f64], counts: &[u32]) -> f64
where
    P: Implicit<f64, Gauss6>,
{
    let mut exact = state(system, start);
    advance(system, &Gauss6, 1.0 / 800.0, 800, &mut exact);
    let points: Vec<(f64, f64)> = counts
        .iter()
        .map(|&count| {
            let h = 1.0 / f64::from(count);
            let mut mu = state(system, start);
            advance(system, method, h, count, &mut mu);
            (h, distance(mu.as_slice(), exact.as_slice()))
        })
        .collect();
    order_of_convergence(&points, 1e-13)
        .unwrap_or_else(|| panic!("{points:?}"))
        .slope
}

#[test]
fn orders_are_those_stated() {
    let spin = NonpolynomialSpin::declared::<f64>();
    let start = NonpolynomialSpin::initial::<f64>();
    let top = HeavyTop::declared::<f64>();
    let top_start = HeavyTop::initial::<f64>();
    let su3 = Su3Quadratic::declared::<f64>();
    let su3_start = Su3Quadratic::initial::<f64>();
    let five = FiveBody::<f64>::default().system().expect("valid");
    let many = [10, 14, 20, 28, 40, 56, 80];
    let few = [4, 5, 6, 8, 10, 12, 14];
    let spins = TwoSpins::<f64>::default().system().expect("valid");
    let slopes = [
        (
            2.0,
            order(&spin, &Isospectral2::new(), start.as_slice(), &many),
        ),
        (
            4.0,
            order(&spin, &Isospectral4::new(), start.as_slice(), &many),
        ),
        (
            6.0,
            order(&spin, &Isospectral6::new(), start.as_slice(), &few),
        ),
        (
            2.0,
            order(&spin, &Collective2::hopf(), start.as_slice(), &many),
        ),
        (
            4.0,
            order(&spin, &Collective4::hopf(), start.as_slice(), &many),
        ),
        (
            6.0,
            order(&spin, &Collective6::hopf(), start.as_slice(), &few),
        ),
        (
            2.0,
            order(&spin, &SphericalMidpoint, start.as_slice(), &many),
        ),
        (
            4.0,
            order(&top, &Isospectral4::new(), top_start.as_slice(), &many),
        ),
        (
            6.0,
            order(&top, &Isospectral6::new(), top_start.as_slice(), &few),
        ),
        (
            2.0,
            order(&su3, &Isospectral2::new(), su3_start.as_slice(), &many),
        ),
        (
            4.0,
            order(&su3, &Isospectral4::new(), su3_start.as_slice(), &few),
        ),
        (2.0, order(&five, &MoserVeselov, &FIVE, &many)),
        (2.0, order(&spins, &SphericalMidpoint, &SPINS, &many)),
        (4.0, order(&spins, &Collective4::hopf(), &SPINS, &many)),
    ];
    println!("{slopes:?}");
    for (index, (order, slope)) in slopes.iter().enumerate() {
        assert!((slope - order).abs() < 0.15, "{index}: {slope} for {order}");
    }
}

/// Steps of h and then of -h lead back.
#[test]
fn every_step_is_symmetric_and_a_poisson_map() {
    fn check<P, Q, M>(name: &str, system: &P, dual: &Q, method: &M, start: &[f64])
    where
        P: Poisson<f64>,
        Q: Poisson<Dual<f64>>,
        M: Method<f64, P> + Method<Dual<f64>, Q>,
    {
        for h in [0.1, -0.2] {
            let mut mu = state(system, start);
            advance(system, method, h, 1, &mut mu);
            advance(system, method, -h, 1, &mut mu);
            let back = distance(mu.as_slice(), start);
            let options = NewtonOptions::default();
            let defect = poisson_defect(dual, method, h, start, &options).expect("converges");
            println!(
                "{name} {}, h = {h}: back {back:.1e}, defect {defect:.1e}",
                M::ID
            );
            assert!(back < 2e-15, "{name} {}: {back:e}", M::ID);
            assert!(defect < 8e-15, "{name} {}: {defect:e}", M::ID);
            let control = poisson_defect(dual, &Rk4, h, start, &options).expect("explicit");
            assert!(control > 1e-12, "{name}: {control:e}");
        }
    }
    macro_rules! declared {
        ($system:ident: $($method:expr),+) => {
            let (system, dual) = ($system::declared::<f64>(), $system::declared::<Dual<f64>>());
            let start = $system::initial::<f64>();
            $(check(stringify!($system), &system, &dual, &$method, start.as_slice());)+
        };
    }
    declared!(NonpolynomialSpin: Isospectral2::new(), Isospectral4::new(), Isospectral6::new(),
        Collective2::hopf(), Collective4::hopf(), Collective6::hopf(), SphericalMidpoint);
    declared!(FreeRigidBody: MoserVeselov, SphericalMidpoint, Collective4::hopf());
    declared!(HeavyTop: Isospectral4::new(), Isospectral6::new());
    declared!(Pendulum: Isospectral4::new());
    declared!(Heisenberg: Isospectral4::new());
    declared!(Sl2Quadratic: Isospectral4::new(), Isospectral6::new());
    declared!(ManakovTop: Isospectral4::new(), MoserVeselov);
    declared!(Su3Quadratic: Isospectral2::new(), Isospectral4::new(), Isospectral6::new());
    let (spins, dual) = (
        TwoSpins::<f64>::default().system().expect("valid"),
        TwoSpins::<Dual<f64>>::default().system().expect("valid"),
    );
    check("TwoSpins", &spins, &dual, &SphericalMidpoint, &SPINS);
    check("TwoSpins", &spins, &dual, &Collective4::hopf(), &SPINS);
    let (five, dual) = (
        FiveBody::<f64>::default().system().expect("valid"),
        FiveBody::<Dual<f64>>::default().system().expect("valid"),
    );
    check("FiveBody", &five, &dual, &MoserVeselov, &FIVE);
}

/// The largest relative drift of the Casimirs and of the energy.
fn drift<P: Poisson<f64>>(
    system: &P,
    method: &impl Method<f64, P>,
    start: &[f64],
    h: f64,
    count: u32,
) -> (f64, f64) {
    let mut mu = state(system, start);
    let mut casimirs = vec![0.0; system.casimir_count()];
    system.casimirs(&mu, &mut casimirs);
    let energy = system.hamiltonian(&mu);
    let mut stepper = method.stepper(system, h, &NewtonOptions::default());
    let mut now = casimirs.clone();
    let (mut largest, mut largest_energy) = (0.0_f64, 0.0_f64);
    for _ in 0..count {
        stepper.step(&mut mu, &mut ()).expect("a step");
        system.casimirs(&mu, &mut now);
        for (a, b) in now.iter().zip(&casimirs) {
            largest = largest.max(((a - b) / b).abs());
        }
        largest_energy = largest_energy.max(((system.hamiltonian(&mu) - energy) / energy).abs());
    }
    (largest, largest_energy)
}

/// E. Hairer, G. Vilmart, "Preprocessed discrete Moser–Veselov algorithm for the full dynamics of a rigid
/// body", Journal of Physics A 39 (2006), doi:10.1088/0305-4470/39/42/006: error 0.254 at the time 10 with
/// steps of 0.1.
#[test]
fn published_error_of_the_discrete_body() {
    let system = Body::<f64>::default().system().expect("valid");
    let end = [1.7659625085182075, -0.6954641670330891, 0.7795549814818711];
    let mut mu = state(&system, &[1.8, 0.4, -0.9]);
    advance(&system, &MoserVeselov, 0.1, 100, &mut mu);
    let error = distance(mu.as_slice(), &end);
    println!("error {error:.4}");
    assert!((error - 0.254).abs() < 5e-4, "{error}");
    let mut mu = state(&system, &[1.8, 0.4, -0.9]);
    advance(&system, &Gauss6, 0.1, 100, &mut mu);
    assert!(distance(mu.as_slice(), &end) < 1e-6);
}

/// The energy of one spin with a homogeneous quadratic H; of two spins it is not kept.
#[test]
fn the_spherical_midpoint_method_keeps_quadratic_energies_of_one_spin() {
    let body = FreeRigidBody::declared::<f64>();
    let start = FreeRigidBody::initial::<f64>();
    let (_, energy) = drift(&body, &SphericalMidpoint, start.as_slice(), 0.1, 10_000);
    assert!(energy < 1e-13, "{energy:e}");
    let spin = NonpolynomialSpin::declared::<f64>();
    let start = NonpolynomialSpin::initial::<f64>();
    let (_, control) = drift(&spin, &SphericalMidpoint, start.as_slice(), 0.1, 1000);
    assert!(control > 1e-6, "{control:e}");
}

#[test]
fn lanes_have_the_digits_of_scalars() {
    fn check<D: Declared, M>(method: M)
    where
        M: Method<f64, D::System<f64>> + Method<F64x8, D::System<F64x8>>,
    {
        let (one, eight) = (D::declared::<f64>(), D::declared::<F64x8>());
        let start = D::initial::<f64>();
        let spread = |lane: usize, k: usize| start.as_slice()[k] * (1.0 + 0.01 * lane as f64);
        let mut together = eight.zero_state();
        for (k, entry) in together.as_mut_slice().iter_mut().enumerate() {
            *entry = F64x8::new(std::array::from_fn(|lane| spread(lane, k)));
        }
        advance(&eight, &method, F64x8::from_f64(0.15), 5, &mut together);
        for lane in 0..8 {
            let numbers: Vec<f64> = (0..start.as_slice().len())
                .map(|k| spread(lane, k))
                .collect();
            let mut mu = state(&one, &numbers);
            advance(&one, &method, 0.15, 5, &mut mu);
            for (a, b) in together.as_slice().iter().zip(mu.as_slice()) {
                assert_eq!(
                    a.lane(lane).to_bits(),
                    b.to_bits(),
                    "{} of {}",
                    M::ID,
                    D::FILE
                );
            }
        }
    }
    check::<Su3Quadratic, _>(Isospectral2::new());
    check::<Su3Quadratic, _>(Isospectral4::new());
    check::<HeavyTop, _>(Isospectral6::new());
    check::<ManakovTop, _>(MoserVeselov);
    check::<FreeRigidBody, _>(MoserVeselov);
    check::<FreeRigidBody, _>(SphericalMidpoint);
    check::<NonpolynomialSpin, _>(Collective4::hopf());
    check::<NonpolynomialSpin, _>(SphericalMidpoint);
}

/// Generated equations against the generic ones; with a nudge, the same comparisons must fail.
#[test]
fn fused_equals_generic() {
    fn check<D: Declared>(compare: impl Fn(&D::System<f64>, f64) -> errors::Errors) {
        let system = D::declared::<f64>();
        let errors = compare(&system, 0.0);
        let (largest, name) = errors.largest();
        println!("{}: largest error {largest:.1e} ({name})", D::FILE);
        assert_eq!(errors.beyond_round_off(), Vec::<&str>::new(), "{}", D::FILE);
        let nudged = compare(&system, 1e-9);
        assert_eq!(nudged.beyond_round_off().len(), nudged.names().len());
    }
    macro_rules! compare {
        ($system:ident: $($name:literal, $method:expr, $generic:ty);+ $(;)?) => {
            check::<$system>(|system, nudge| {
                let mut errors = errors::Errors::new(nudge);
                let mut random = systems::Random(2018);
                for _ in 0..20 {
                    let mut mu = $system::initial::<f64>();
                    for entry in mu.as_mut_slice() {
                        *entry += 0.2 * random.number();
                    }
                    $(
                        let mut fused = Implicit::equation(system, &$method, 0.13);
                        let mut generic = <$generic>::new(system, 0.13);
                        equations::equation($name, &mut fused, &mut generic, &mu, &mut random, &mut errors);
                    )+
                }
                errors
            });
        };
    }
    compare!(Su3Quadratic:
        "isospectral2", Isospectral2::new(), StageMomenta<_, _, MatrixStages<_, _, 1>, 1>;
        "isospectral4", Isospectral4::new(), StageMomenta<_, _, MatrixStages<_, _, 2>, 2>;
        "isospectral6", Isospectral6::new(), StageMomenta<_, _, MatrixStages<_, _, 3>, 3>);
    compare!(HeavyTop:
        "isospectral4", Isospectral4::new(), StageMomenta<_, _, MatrixStages<_, _, 2>, 2>);
    compare!(ManakovTop:
        "isospectral4", Isospectral4::new(), StageMomenta<_, _, MatrixStages<_, _, 2>, 2>;
        "moser-veselov", MoserVeselov, DiscreteBody<_, _>);
    compare!(FreeRigidBody:
        "isospectral6", Isospectral6::new(), StageMomenta<_, _, MatrixStages<_, _, 3>, 3>;
        "spherical-midpoint", SphericalMidpoint, Spherical<_, _>;
        "moser-veselov", MoserVeselov, DiscreteTop<_, _>);
    compare!(NonpolynomialSpin:
        "collective2", Collective2::hopf(), StageMomenta<_, _, QuaternionStages<_, 1>, 1>;
        "collective4", Collective4::hopf(), StageMomenta<_, _, QuaternionStages<_, 2>, 2>;
        "collective6", Collective6::hopf(), StageMomenta<_, _, QuaternionStages<_, 3>, 3>;
        "spherical-midpoint", SphericalMidpoint, Spherical<_, _>);
}

/// Where a spin is 0 its ratio is not 0/0.
#[test]
fn a_spin_at_rest_stays_in_fused_code() {
    let system = NonpolynomialSpin::declared::<f64>();
    let mut mu = system.zero_state();
    advance(&system, &SphericalMidpoint, 0.1, 3, &mut mu);
    assert_eq!(mu, system.zero_state());
}
