//! Methods that keep the energy, on the systems of `specs/`: fused against generic forms, single steps
//! against reference values, and what they keep.

use crate::equations::Comparison;
use crate::errors::Errors;
use crate::systems::{
    CotangentEulerArnold, Declared, FreeRigidBody, HeavyTop, Heisenberg, KirchhoffBody, ManakovTop,
    NonpolynomialSpin, Pendulum, Random, Sl2Quadratic, Su3Quadratic, TodaLattice, distance, state,
};
use crate::vectors::steps;
use lie_runtime::diagnostics::{Drift, DriftMonitor};
use lie_runtime::driver::integrate;
use lie_runtime::generic::{
    self, DiscreteGradientStep, GonzalezGradient, ItohAbeGradient, MeanValueGradient,
    OrbitEnergyStep,
};
use lie_runtime::methods::{
    CohenHairer, CohenHairer2, CohenHairer4, CohenHairer6, Gonzalez, ImplicitStepper, ItohAbe,
    MeanValue, Method, OrbitEnergy, Rk4, Stepper,
};
use lie_runtime::newton::{FailureReason, NewtonOptions};
use lie_runtime::prelude::*;
use lie_runtime::{Equation, Implicit, LiePoisson, Poisson, State};

/// The methods of this file, all of them.
trait Energy<S: Scalar>:
    LiePoisson<S>
    + Implicit<S, Gonzalez>
    + Implicit<S, MeanValue>
    + Implicit<S, ItohAbe>
    + Implicit<S, OrbitEnergy<Gonzalez>>
    + Implicit<S, OrbitEnergy<MeanValue>>
    + Implicit<S, OrbitEnergy<ItohAbe>>
    + Implicit<S, CohenHairer<1>>
    + Implicit<S, CohenHairer<2>>
    + Implicit<S, CohenHairer<3>>
{
}

impl<S: Scalar, P> Energy<S> for P where
    P: LiePoisson<S>
        + Implicit<S, Gonzalez>
        + Implicit<S, MeanValue>
        + Implicit<S, ItohAbe>
        + Implicit<S, OrbitEnergy<Gonzalez>>
        + Implicit<S, OrbitEnergy<MeanValue>>
        + Implicit<S, OrbitEnergy<ItohAbe>>
        + Implicit<S, CohenHairer<1>>
        + Implicit<S, CohenHairer<2>>
        + Implicit<S, CohenHairer<3>>
{
}

/// Every fused equation against its generic form on random states.
fn compare<D: Declared>(fused: &D::System<f64>, nudge: f64) -> Errors
where
    D::System<f64>: Energy<f64>,
{
    let reference = &D::declared::<f64>();
    let (mut random, mut errors) = (Random(2018), Errors::new(nudge));
    for _ in 0..20 {
        let initial = D::initial::<f64>();
        let near = initial.as_slice().iter();
        let near: Vec<f64> = near.map(|x| x + 0.5 * random.number()).collect();
        let mu = state(fused, &near);
        let h = 0.1 * random.number();
        let mut compare = Comparison {
            mu: &mu,
            random: &mut random,
            errors: &mut errors,
        };
        let gonzalez = DiscreteGradientStep::<_, _, GonzalezGradient<_, _>>::new(reference, h);
        let mean_value = DiscreteGradientStep::<_, _, MeanValueGradient<_, _>>::new(reference, h);
        let itoh_abe = DiscreteGradientStep::<_, _, ItohAbeGradient<_, _>>::new(reference, h);
        compare.run("gonzalez", fused.equation(&Gonzalez, h), gonzalez);
        compare.run("mean-value", fused.equation(&MeanValue, h), mean_value);
        compare.run("itoh-abe", fused.equation(&ItohAbe, h), itoh_abe);
        let gonzalez = OrbitEnergyStep::<_, _, GonzalezGradient<_, _>>::new(reference, h);
        let mean_value = OrbitEnergyStep::<_, _, MeanValueGradient<_, _>>::new(reference, h);
        let itoh_abe = OrbitEnergyStep::<_, _, ItohAbeGradient<_, _>>::new(reference, h);
        let method = OrbitEnergy::gonzalez();
        compare.run("orbit gonzalez", fused.equation(&method, h), gonzalez);
        let method = OrbitEnergy::mean_value();
        compare.run("orbit mean-value", fused.equation(&method, h), mean_value);
        let method = OrbitEnergy::itoh_abe();
        compare.run("orbit itoh-abe", fused.equation(&method, h), itoh_abe);
        // with one stage it runs on the equation of the mean value
        let one = DiscreteGradientStep::<_, _, MeanValueGradient<_, _>>::new(reference, h);
        compare.run(
            "cohen-hairer2",
            fused.equation(&CohenHairer2::new(), h),
            one,
        );
        let two = generic::CohenHairerStep::<_, _, 2>::new(reference, h);
        compare.run(
            "cohen-hairer4",
            fused.equation(&CohenHairer4::new(), h),
            two,
        );
        let three = generic::CohenHairerStep::<_, _, 3>::new(reference, h);
        compare.run(
            "cohen-hairer6",
            fused.equation(&CohenHairer6::new(), h),
            three,
        );
    }
    errors
}

fn fused_equals_generic<D: Declared>()
where
    D::System<f64>: Energy<f64>,
{
    let errors = compare::<D>(&D::declared::<f64>(), 0.0);
    let (largest, name) = errors.largest();
    println!("{}: largest error {largest:.1e} ({name})", D::FILE);
    assert_eq!(errors.beyond_round_off(), [""; 0], "{}", D::FILE);
}

/// One step from the initial state.
fn one_step<D: Declared>(
    stepper: &mut impl Stepper<f64, State = <D::System<f64> as Poisson<f64>>::State>,
) -> Vec<f64> {
    let mut mu = D::initial::<f64>();
    stepper.step(&mut mu, &mut ()).expect("the step converges");
    mu.as_slice().to_vec()
}

fn check_steps<D: Declared, M, E>(
    key: &str,
    method: &M,
    reference: impl Fn(&'static D::System<f64>, f64) -> E,
) -> usize
where
    M: Method<f64, D::System<f64>>,
    E: Equation<f64, State = <D::System<f64> as Poisson<f64>>::State>,
    D::System<f64>: 'static,
{
    let system: &'static D::System<f64> = Box::leak(Box::new(D::declared::<f64>()));
    let newton = NewtonOptions::default();
    let expected = steps(D::FILE, key);
    for (h, expected) in &expected {
        let fused = one_step::<D>(&mut method.stepper(system, *h, &newton));
        let zero = system.zero_state();
        let plain = ImplicitStepper::new(reference(system, *h), zero, &newton);
        let plain = one_step::<D>(&mut { plain });
        let errors = [distance(&fused, expected), distance(&plain, expected)];
        println!("{}: {key}, h = {h}: {errors:?}", D::FILE);
        for error in errors {
            assert!(error < 1e-15, "{key} of {}: {errors:?}", D::FILE);
        }
    }
    expected.len()
}

/// Single steps against reference values, fused and generic; returns how many there were.
fn reference_steps<D: Declared>() -> usize
where
    D::System<f64>: Energy<f64> + 'static,
{
    type Plain<'a, P, G> = DiscreteGradientStep<'a, f64, P, G>;
    type Orbit<'a, P, G> = OrbitEnergyStep<'a, f64, P, G>;
    type MidpointGradient<D> = GonzalezGradient<f64, <D as Declared>::System<f64>>;
    type Mean<D> = MeanValueGradient<f64, <D as Declared>::System<f64>>;
    check_steps::<D, _, _>("discrete_gradient_gonzalez", &Gonzalez, |system, h| {
        Plain::<_, MidpointGradient<D>>::new(system, h)
    }) + check_steps::<D, _, _>("discrete_gradient_mean_value", &MeanValue, |system, h| {
        Plain::<_, Mean<D>>::new(system, h)
    }) + check_steps::<D, _, _>(
        "orbit_energy_gonzalez",
        &OrbitEnergy::gonzalez(),
        Orbit::<_, MidpointGradient<D>>::new,
    ) + check_steps::<D, _, _>(
        "orbit_energy_mean_value",
        &OrbitEnergy::mean_value(),
        Orbit::<_, Mean<D>>::new,
    ) + check_steps::<D, _, _>("cohen_hairer_2", &CohenHairer4::new(), |system, h| {
        generic::CohenHairerStep::<_, _, 2>::new(system, h)
    })
}

/// Energy and Casimirs over a run.
fn drift<D: Declared>(method: impl Method<f64, D::System<f64>>, h: f64, steps: u32) -> Drift {
    let problem = Problem {
        system: D::declared::<f64>(),
        mu0: D::initial::<f64>(),
        span: (0.0, h * f64::from(steps)),
    };
    let mut monitor = DriftMonitor::<f64>::new();
    let options = Options::new(h).save(Save::Ends);
    integrate(&problem, method, &options, &mut monitor).expect("every step converges");
    monitor.drift().clone()
}

/// Energy and quadratic Casimirs; with orbits, every Casimir.
fn kept<D: Declared>()
where
    D::System<f64>: Energy<f64>,
{
    const BOUND: f64 = 1e-13;
    let system = D::declared::<f64>();
    macro_rules! check {
        ($method:expr, $orbit:expr) => {
            let drift = drift::<D>($method, 0.05, 1000);
            assert!(drift.energy.max < BOUND, "{}: {:?}", D::FILE, drift.energy);
            for (index, casimir) in drift.casimirs.iter().enumerate() {
                let quadratic = system.casimir_degree(index).is_some_and(|d| d <= 2);
                if $orbit || quadratic {
                    assert!(casimir.max < BOUND, "{}: {casimir:?}", D::FILE);
                }
            }
        };
    }
    check!(Gonzalez, false);
    check!(MeanValue, false);
    check!(ItohAbe, false);
    check!(OrbitEnergy::gonzalez(), true);
    check!(OrbitEnergy::itoh_abe(), true);
    check!(CohenHairer4::new(), false);
    check!(CohenHairer6::new(), false);
    assert!(drift::<D>(Rk4, 0.05, 1000).energy.max > 100.0 * BOUND);
}

/// Steps in lanes from eight states against steps of each alone, to the bit.
fn lanes<D: Declared>()
where
    D::System<f64>: Energy<f64>,
    D::System<F64x8>: Energy<F64x8>,
{
    let (many, one) = (D::declared::<F64x8>(), D::declared::<f64>());
    let start = D::initial::<f64>();
    let options = NewtonOptions::default();
    let size = |lane: usize| 1.0 - 0.1 * lane as f64;
    macro_rules! check {
        ($method:expr) => {
            let mut together = many.zero_state();
            for (entry, &start) in together.as_mut_slice().iter_mut().zip(start.as_slice()) {
                *entry = F64x8::new(core::array::from_fn(|lane| size(lane) * start));
            }
            let h = core::array::from_fn(|lane| 0.02 * (lane as f64 - 3.0));
            let mut stepper = $method.stepper(&many, F64x8::new(h), &options);
            for _ in 0..3 {
                stepper
                    .step(&mut together, &mut ())
                    .expect("the lanes converge");
            }
            for lane in 0..8 {
                let mut alone = start.clone();
                for entry in alone.as_mut_slice() {
                    *entry *= size(lane);
                }
                let mut stepper = $method.stepper(&one, h[lane], &options);
                for _ in 0..3 {
                    stepper
                        .step(&mut alone, &mut ())
                        .expect("the lane converges");
                }
                let pairs = together.as_slice().iter().zip(alone.as_slice());
                for (together, alone) in pairs {
                    assert_eq!(
                        together.lane(lane).to_bits(),
                        alone.to_bits(),
                        "{}",
                        D::FILE
                    );
                }
            }
        };
    }
    check!(Gonzalez);
    check!(MeanValue);
    check!(ItohAbe);
    check!(OrbitEnergy::gonzalez());
    check!(OrbitEnergy::mean_value());
    check!(OrbitEnergy::itoh_abe());
    check!(CohenHairer2::new());
    check!(CohenHairer4::new());
    check!(CohenHairer6::new());
}

macro_rules! tests {
    ($file:ident, $system:ident, $cayley:ident) => {
        mod $file {
            use super::$system;
            #[test]
            fn fused_equals_generic() {
                super::fused_equals_generic::<$system>();
            }
            #[test]
            fn reference_steps() {
                // mean values and collocation are given only where H is a polynomial, collocation not
                // for twelve coordinates
                let count = super::reference_steps::<$system>();
                let expected = match stringify!($file) {
                    "so3_nonpolynomial" => 4,
                    "so3_cotangent_euler_arnold" => 8,
                    _ => 10,
                };
                assert_eq!(count, expected);
            }
            #[test]
            fn energy_and_casimirs_are_kept() {
                super::kept::<$system>();
            }
        }
    };
}

each_system!(tests);

/// One system of each kind: any function, a polynomial, a quadratic one.
#[test]
fn lanes_have_the_digits_of_the_scalar_run() {
    lanes::<NonpolynomialSpin>();
    lanes::<Heisenberg>();
    lanes::<HeavyTop>();
}

/// Differences of 1e-9 are noticed by every comparison.
#[test]
fn every_comparison_notices_another_state() {
    for errors in [
        compare::<NonpolynomialSpin>(&NonpolynomialSpin::declared(), 1e-9),
        compare::<Heisenberg>(&Heisenberg::declared(), 1e-9),
        compare::<HeavyTop>(&HeavyTop::declared(), 1e-9),
    ] {
        let mut noticed = errors.beyond_round_off();
        noticed.sort_unstable();
        assert_eq!(noticed, errors.names());
    }
}

/// Where H is no polynomial the integrals are quadratures: a step that they do not resolve is refused,
/// and no accepted one loses the energy.
#[test]
fn steps_that_a_quadrature_does_not_resolve_are_refused() {
    fn largest_error<M>(method: M, h: f64) -> (f64, Option<FailureReason>)
    where
        M: Method<f64, <NonpolynomialSpin as Declared>::System<f64>>,
    {
        let system = NonpolynomialSpin::declared::<f64>();
        let mut mu = NonpolynomialSpin::initial::<f64>();
        let energy = system.hamiltonian(&mu);
        let mut stepper = method.stepper(&system, h, &NewtonOptions::default());
        let mut largest = 0.0;
        for _ in 0..200 {
            if let Err(failure) = stepper.step(&mut mu, &mut ()) {
                return (largest, Some(failure.reason));
            }
            largest = Scalar::max(largest, (system.hamiltonian(&mu) - energy).abs());
        }
        (largest, None)
    }
    fn check<M>(name: &str, method: M)
    where
        M: Copy + Method<f64, <NonpolynomialSpin as Declared>::System<f64>>,
    {
        let ladder = (0..20).map(|k| 0.1 * 1.4_f64.powi(k));
        let outcomes: Vec<_> = ladder.map(|h| (h, largest_error(method, h))).collect();
        println!("{name}: {outcomes:?}");
        assert!(
            outcomes.iter().all(|(_, (error, _))| *error < 1e-12),
            "{name}: {outcomes:?}"
        );
        assert!(
            outcomes[..5]
                .iter()
                .all(|(_, (_, reason))| reason.is_none()),
            "{name}: {outcomes:?}"
        );
        let refused = |(_, (_, reason)): &(f64, (f64, Option<FailureReason>))| {
            *reason == Some(FailureReason::Unresolved)
        };
        assert!(outcomes.iter().any(refused), "{name}: {outcomes:?}");
    }
    check("mean-value", MeanValue);
    check("cohen-hairer2", CohenHairer2::new());
    check("cohen-hairer4", CohenHairer4::new());
    check("cohen-hairer6", CohenHairer6::new());
    check("orbit-energy", OrbitEnergy::mean_value());
}
