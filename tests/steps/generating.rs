//! Generating-function methods on declared systems: fused functions against the generic ones, single
//! steps against reference values, order, Poisson structure and Casimirs, lanes.

use crate::equations::equation;
use crate::errors::{Errors, entries};
use crate::systems::{
    Declared, KirchhoffBody, Random, Sl2Quadratic, TodaLattice, distance, relative_distance, state,
};
use crate::vectors::{Reference, number, numbers, steps};
use lie_runtime::diagnostics::{DriftMonitor, order_of_convergence, poisson_defect};
use lie_runtime::driver::integrate;
use lie_runtime::generic::{self, CayleyRetraction, ExpRetraction, SecondKind};
use lie_runtime::methods::{
    Cayley, Exp, Facts, Generating, Generating2, Generating4, Generating6, GeneratingSecondKind2,
    ImplicitStepper, LieMidpoint, Method, Stepper,
};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use lie_runtime::{GeneratingFunction, Implicit};

/// Round-off of a step of numbers near 1.
const STEP: f64 = 1e-15;

/// What every system has.
trait Methods<S: Scalar>:
    Lift<S, Lifted: LiePoisson<Dual<S>> + Lift<Dual<S>, Lifted: LiePoisson<Dual<Dual<S>>>>>
    + LiePoisson<S>
    + Implicit<S, LieMidpoint<Exp>>
    + Implicit<S, Generating<Exp, 2>>
    + Implicit<S, Generating<Exp, 4>>
    + Implicit<S, Generating<Exp, 6>>
    + Implicit<S, GeneratingSecondKind2>
{
}

impl<S: Scalar, P> Methods<S> for P where
    P: Lift<S, Lifted: LiePoisson<Dual<S>> + Lift<Dual<S>, Lifted: LiePoisson<Dual<Dual<S>>>>>
        + LiePoisson<S>
        + Implicit<S, LieMidpoint<Exp>>
        + Implicit<S, Generating<Exp, 2>>
        + Implicit<S, Generating<Exp, 4>>
        + Implicit<S, Generating<Exp, 6>>
        + Implicit<S, GeneratingSecondKind2>
{
}

/// A system with fused generating functions.
trait Fused {
    const FILE: &'static str;
    type System<S: Scalar>: Methods<S>;
    fn declared<S: Scalar>() -> Self::System<S>;
    fn initial<S: Scalar>() -> <Self::System<S> as Poisson<S>>::State;
}

macro_rules! fused {
    ($($file:ident $name:ident $system:ident,)+) => {$(
        impl Fused for $file::$name {
            const FILE: &'static str = stringify!($file);
            type System<S: Scalar> = $file::$system<S>;
            fn declared<S: Scalar>() -> Self::System<S> {
                $file::$name::<S>::default().system().expect("valid")
            }
            fn initial<S: Scalar>() -> <Self::System<S> as Poisson<S>>::State {
                $file::$name::<S>::default().initial_state()
            }
        }
    )+};
}

use spec_systems::generating::{
    e2_pendulum, heisenberg_h3, se3_heavy_top, so3_free_rigid_body, so3_nonpolynomial, so4_manakov,
    toda3_solvable,
};

fused!(
    e2_pendulum Pendulum PendulumSystem,
    heisenberg_h3 Heisenberg HeisenbergSystem,
    se3_heavy_top HeavyTop HeavyTopSystem,
    so3_free_rigid_body FreeRigidBody FreeRigidBodySystem,
    so3_nonpolynomial NonpolynomialSpin NonpolynomialSpinSystem,
    so4_manakov ManakovTop ManakovTopSystem,
    toda3_solvable TodaLattice TodaLatticeSystem,
);

/// Calls a macro once per fused system, `cayley` where that retraction exists, else `exp`.
macro_rules! each_fused {
    ($check:ident) => {
        $check!(e2_pendulum, Pendulum, cayley);
        $check!(heisenberg_h3, Heisenberg, cayley);
        $check!(se3_heavy_top, HeavyTop, cayley);
        $check!(so3_free_rigid_body, FreeRigidBody, cayley);
        $check!(so3_nonpolynomial, NonpolynomialSpin, cayley);
        $check!(so4_manakov, ManakovTop, cayley);
        $check!(toda3_solvable, TodaLattice, exp);
    };
}

/// Random states near the initial one.
fn near<D: Fused>(random: &mut Random) -> Vec<f64> {
    let initial = D::initial::<f64>();
    let entries = initial.as_slice().iter();
    entries.map(|x| x + 0.5 * random.number()).collect()
}

const STATES: usize = 20;

/// Fused equations against the generic ones on random states.
fn errors<D: Fused>(nudge: f64) -> Errors {
    let mut random = Random(1988);
    let mut errors = Errors::new(nudge);
    let system = &D::declared::<f64>();
    for _ in 0..STATES {
        let mu = &state(system, &near::<D>(&mut random));
        let h = 0.1 * random.number();
        let mut fused = system.equation(&Generating4::exp(), h);
        let function = generic::Generating4::new(system, h);
        let mut reference = ExpRetraction::with_function(system, function, h);
        equation(
            "generating4",
            &mut fused,
            &mut reference,
            mu,
            &mut random,
            &mut errors,
        );
        let mut fused = system.equation(&Generating6::exp(), h);
        let function = generic::Generating6::new(system, h);
        let mut reference = ExpRetraction::with_function(system, function, h);
        equation(
            "generating6",
            &mut fused,
            &mut reference,
            mu,
            &mut random,
            &mut errors,
        );
        let mut fused = system.equation(&GeneratingSecondKind2, h);
        let mut reference = SecondKind::new(system, h);
        equation(
            "second kind",
            &mut fused,
            &mut reference,
            mu,
            &mut random,
            &mut errors,
        );
    }
    errors
}

fn cayley_errors<D: Fused>(nudge: f64) -> Errors
where
    D::System<f64>: CayleyPoisson<f64> + Implicit<f64, Generating<Cayley, 4>>,
    <D::System<f64> as Lift<f64>>::Lifted: CayleyPoisson<Dual<f64>>,
{
    let mut random = Random(1988);
    let mut errors = Errors::new(nudge);
    let system = &D::declared::<f64>();
    for _ in 0..STATES {
        let mu = &state(system, &near::<D>(&mut random));
        let h = 0.1 * random.number();
        let mut fused = system.equation(&Generating4::cayley(), h);
        let function = generic::CayleyGenerating4::new(system, h);
        let mut reference = CayleyRetraction::with_function(system, function, h);
        equation(
            "cayley",
            &mut fused,
            &mut reference,
            mu,
            &mut random,
            &mut errors,
        );
    }
    errors
}

fn check(name: &str, errors: impl Fn(f64) -> Errors) {
    let found = errors(0.0);
    let (largest, kernel) = found.largest();
    println!("{name}: largest error {largest:.1e} ({kernel})");
    assert_eq!(found.beyond_round_off(), [""; 0], "{name}: {largest:e}");
    // states that differ in the twelfth digit are noticed
    assert!(!errors(1e-12).beyond_round_off().is_empty());
}

/// One step of each size from the initial state.
fn check_steps<V: State<f64>, T: Stepper<f64, State = V>>(
    what: &str,
    start: &V,
    expected: &[(f64, Vec<f64>)],
    stepper: impl Fn(f64) -> T,
) {
    assert_eq!(expected.len(), 2, "{what}");
    for (h, expected) in expected {
        let mut mu = start.clone();
        let report = stepper(*h).step(&mut mu, &mut ());
        let report = report.unwrap_or_else(|failure| panic!("{what}: {failure}"));
        let error = distance(mu.as_slice(), expected);
        println!(
            "{what}, h = {h}: {error:.1e}, {} iterations",
            report.iterations
        );
        assert!(error < STEP, "{what}, h = {h}: {error:e}");
        let newton = report.iterations - report.fixed_point;
        assert!(newton <= 5, "{what}, h = {h}: {report:?}");
    }
}

/// Steps that the Hamilton–Jacobi equation gave.
fn hamilton_jacobi(name: &str, method: &str, retraction: &str) -> Vec<(f64, Vec<f64>)> {
    let Reference(file) = Reference::read("tests/data/vectors/generating.json");
    let steps = file["systems"][name].as_array().expect("steps");
    let of_method = steps
        .iter()
        .filter(|step| step["method"] == method && step["retraction"] == retraction);
    of_method
        .map(|step| (number(&step["h"]), numbers(&step["state"])))
        .collect()
}

/// Single steps of a system, fused and generic.
fn single_steps<D: Fused>() {
    let (system, newton) = (&D::declared::<f64>(), NewtonOptions::default());
    let start = D::initial::<f64>();
    let zero = || system.zero_state();
    let name = D::FILE;
    let expected = steps(name, "retraction_exp");
    check_steps(&format!("{name}: order 2"), &start, &expected, |h| {
        Generating2::exp().stepper(system, h, &newton)
    });
    let expected = steps(name, "genfun_exp_4");
    check_steps(&format!("{name}: order 4"), &start, &expected, |h| {
        Generating4::exp().stepper(system, h, &newton)
    });
    check_steps(
        &format!("{name}: order 4, generic"),
        &start,
        &expected,
        |h| {
            let function = generic::Generating4::new(system, h);
            let equation = ExpRetraction::with_function(system, function, h);
            ImplicitStepper::new(equation, zero(), &newton)
        },
    );
    let expected = hamilton_jacobi(name, "generating6", "exp");
    check_steps(&format!("{name}: order 6"), &start, &expected, |h| {
        Generating6::exp().stepper(system, h, &newton)
    });
    check_steps(
        &format!("{name}: order 6, generic"),
        &start,
        &expected,
        |h| {
            let function = generic::Generating6::new(system, h);
            let equation = ExpRetraction::with_function(system, function, h);
            ImplicitStepper::new(equation, zero(), &newton)
        },
    );
    let expected = hamilton_jacobi(name, "generating-second-kind2", "second");
    check_steps(&format!("{name}: second kind"), &start, &expected, |h| {
        GeneratingSecondKind2.stepper(system, h, &newton)
    });
    check_steps(
        &format!("{name}: second kind, generic"),
        &start,
        &expected,
        |h| ImplicitStepper::new(SecondKind::new(system, h), zero(), &newton),
    );
}

fn cayley_steps<D: Fused>()
where
    D::System<f64>: CayleyPoisson<f64>
        + Implicit<f64, Generating<Cayley, 2>>
        + Implicit<f64, Generating<Cayley, 4>>,
    <D::System<f64> as Lift<f64>>::Lifted: CayleyPoisson<Dual<f64>>,
{
    let (system, newton) = (&D::declared::<f64>(), NewtonOptions::default());
    let (name, start) = (D::FILE, D::initial::<f64>());
    let expected = steps(name, "retraction_cayley");
    check_steps(
        &format!("{name}: cayley, order 2"),
        &start,
        &expected,
        |h| Generating2::cayley().stepper(system, h, &newton),
    );
    let expected = hamilton_jacobi(name, "generating4", "cayley");
    check_steps(&format!("{name}: cayley"), &start, &expected, |h| {
        Generating4::cayley().stepper(system, h, &newton)
    });
    check_steps(
        &format!("{name}: cayley, generic"),
        &start,
        &expected,
        |h| {
            let function = generic::CayleyGenerating4::new(system, h);
            let equation = CayleyRetraction::with_function(system, function, h);
            ImplicitStepper::new(equation, system.zero_state(), &newton)
        },
    );
}

/// The Poisson defect of a step, over dual numbers through fused functions.
fn poisson<D: Fused>() {
    let (system, newton) = (D::declared::<Dual<f64>>(), NewtonOptions::default());
    let start = D::initial::<f64>();
    let start = start.as_slice();
    for h in [0.1, -0.2] {
        let defects = [
            poisson_defect(&system, &Generating4::exp(), h, start, &newton),
            poisson_defect(&system, &Generating6::exp(), h, start, &newton),
            poisson_defect(&system, &GeneratingSecondKind2, h, start, &newton),
        ]
        .map(|defect| defect.expect("the step converges"));
        println!("{}: Poisson defects {defects:?}", D::FILE);
        assert!(
            defects.iter().all(|d| *d < 5e-15),
            "{}: {defects:?}",
            D::FILE
        );
    }
}

/// Eight lanes with different states and steps have the bits of eight scalar runs.
fn lanes<D: Fused>() {
    fn run<S: Scalar, P: Poisson<S>>(
        system: &P,
        method: &impl Method<S, P>,
        h: S,
        mu: &mut P::State,
    ) {
        let mut stepper = method.stepper(system, h, &NewtonOptions::default());
        for _ in 0..4 {
            stepper.step(mu, &mut ()).expect("the step converges");
        }
    }
    fn compare<D: Fused, M>(method: &M)
    where
        M: Method<f64, D::System<f64>> + Method<F64x8, D::System<F64x8>>,
    {
        let mut random = Random(7);
        let starts: Vec<Vec<f64>> = (0..8).map(|_| near::<D>(&mut random)).collect();
        let h: [f64; 8] = core::array::from_fn(|lane| 0.02 * (lane as f64 - 3.5));
        let (one, many) = (D::declared::<f64>(), D::declared::<F64x8>());
        let mut together = many.zero_state();
        for (row, entry) in together.as_mut_slice().iter_mut().enumerate() {
            *entry = F64x8::new(core::array::from_fn(|lane| starts[lane][row]));
        }
        run(&many, method, F64x8::new(h), &mut together);
        for lane in 0..8 {
            let mut mu = state(&one, &starts[lane]);
            run(&one, method, h[lane], &mut mu);
            let of_lane: Vec<u64> = (together.as_slice().iter())
                .map(|entry| entry.lane(lane).to_bits())
                .collect();
            let alone: Vec<u64> = mu.as_slice().iter().map(|entry| entry.to_bits()).collect();
            assert_eq!(of_lane, alone, "{}, lane {lane}", D::FILE);
        }
    }
    compare::<D, _>(&Generating4::exp());
    compare::<D, _>(&Generating6::exp());
    compare::<D, _>(&GeneratingSecondKind2);
}

mod of {
    macro_rules! tests {
        ($file:ident, $name:ident, $cayley:ident) => {
            mod $file {
                use super::super as root;
                type D = root::$file::$name;
                #[test]
                fn fused_equals_generic() {
                    root::check(stringify!($file), root::errors::<D>);
                }
                #[test]
                fn steps() {
                    root::single_steps::<D>();
                }
                cayley!($cayley);
            }
        };
    }
    macro_rules! cayley {
        (cayley) => {
            #[test]
            fn cayley() {
                root::check("cayley", root::cayley_errors::<D>);
                root::cayley_steps::<D>();
            }
        };
        (exp) => {};
    }
    each_fused!(tests);
}

#[test]
fn poisson_maps() {
    poisson::<so3_nonpolynomial::NonpolynomialSpin>();
    poisson::<toda3_solvable::TodaLattice>();
}

#[test]
fn lanes_have_the_bits_of_scalar_runs() {
    lanes::<so3_nonpolynomial::NonpolynomialSpin>();
}

/// The declarations that do not ask for the methods have the generic forms.
#[test]
fn generic_steps_of_other_systems() {
    fn steps_of<D: Declared>()
    where
        D::System<f64>: Methods<f64>,
    {
        let (system, newton) = (&D::declared::<f64>(), NewtonOptions::default());
        let start = D::initial::<f64>();
        let expected = steps(D::FILE, "genfun_exp_4");
        check_steps(D::FILE, &start, &expected, |h| {
            Generating4::exp().stepper(system, h, &newton)
        });
    }
    steps_of::<KirchhoffBody>();
    steps_of::<Sl2Quadratic>();
    steps_of::<TodaLattice>();
}

/// The slope of the errors at a time for numbers of steps.
fn slope<D: Fused>(method: &impl Method<f64, D::System<f64>>, time: &str, counts: &[u32]) -> f64 {
    let reference = Reference::vector(D::FILE);
    let times = reference.times();
    let row = times
        .iter()
        .position(|&row| row == time)
        .expect("a time of the file");
    let time: f64 = time.parse().expect("a number");
    let end = &reference.states()[row];
    let system = D::declared::<f64>();
    let points: Vec<(f64, f64)> = (counts.iter())
        .map(|&count| {
            let mut mu = D::initial::<f64>();
            let h = time / f64::from(count);
            let mut stepper = method.stepper(&system, h, &NewtonOptions::default());
            for _ in 0..count {
                stepper.step(&mut mu, &mut ()).expect("the step converges");
            }
            (h, distance(mu.as_slice(), end))
        })
        .collect();
    let order = order_of_convergence(&points, 1e-13).unwrap_or_else(|| panic!("{points:?}"));
    println!("{}: slope {:.3} of {points:?}", D::FILE, order.slope);
    order.slope
}

#[test]
fn orders() {
    fn check<D: Fused, M>(method: M, time: &str, counts: &[u32])
    where
        M: Method<f64, D::System<f64>> + Facts,
    {
        let slope = slope::<D>(&method, time, counts);
        let order = f64::from(M::ORDER);
        assert!(
            (slope - order).abs() < 0.1,
            "{} of {}: {slope}",
            M::ID,
            D::FILE
        );
    }
    type Spin = so3_nonpolynomial::NonpolynomialSpin;
    type Top = se3_heavy_top::HeavyTop;
    type So4 = so4_manakov::ManakovTop;
    type Toda = toda3_solvable::TodaLattice;
    const FOUR: [u32; 6] = [40, 56, 80, 112, 160, 224];
    check::<Spin, _>(Generating4::exp(), "2", &FOUR);
    check::<Top, _>(Generating4::exp(), "2", &FOUR);
    check::<So4, _>(Generating4::exp(), "2", &FOUR);
    check::<Toda, _>(Generating4::exp(), "2", &FOUR);
    check::<Spin, _>(Generating4::cayley(), "2", &FOUR);
    check::<Top, _>(Generating4::cayley(), "2", &FOUR);
    check::<Spin, _>(GeneratingSecondKind2, "2", &FOUR);
    check::<Top, _>(GeneratingSecondKind2, "2", &FOUR);
    // larger steps are pre-asymptotic, smaller ones end in round-off
    const SIX: [u32; 6] = [12, 16, 20, 24, 28, 32];
    check::<Spin, _>(Generating6::exp(), "1", &SIX);
    check::<Top, _>(Generating6::exp(), "1", &SIX);
}

#[test]
fn casimirs_over_many_steps() {
    let drift = |method: &dyn Fn(&mut DriftMonitor<f64>)| {
        let mut monitor = DriftMonitor::<f64>::new();
        method(&mut monitor);
        monitor.drift().clone()
    };
    fn run<M: Method<f64, se3_heavy_top::HeavyTopSystem>>(
        method: M,
        monitor: &mut DriftMonitor<f64>,
    ) {
        let top = se3_heavy_top::HeavyTop::<f64>::default();
        let problem = Problem {
            mu0: top.initial_state(),
            system: top.system().expect("valid"),
            span: (0.0, 1000.0),
        };
        let options = Options::new(0.05).save(Save::Ends);
        integrate(&problem, method, &options, monitor).expect("every step converges");
    }
    let kept = [
        drift(&|monitor| run(Generating4::exp(), monitor)),
        drift(&|monitor| run(Generating4::cayley(), monitor)),
        drift(&|monitor| run(Generating6::exp(), monitor)),
        drift(&|monitor| run(GeneratingSecondKind2, monitor)),
    ];
    for drift in &kept {
        let casimirs = drift.casimirs.iter();
        assert!(
            casimirs.clone().all(|casimir| casimir.max < 1e-12),
            "{drift:?}"
        );
    }
    let control = drift(&|monitor| run(Rk4, monitor));
    assert!(control.casimirs[0].max > 1e-8, "{control:?}");
    // the energy error shrinks with the order and does not grow
    let energies = kept.each_ref().map(|drift| drift.energy.max);
    assert!(energies[2] < 0.1 * energies[0], "{energies:?}");
    assert!(kept[2].energy.growth().expect("an error") < 2.0);
}

/// Gradient and Hessian of a fused function are derivatives of each other.
#[test]
fn hessians_are_symmetric_derivatives() {
    let system = so3_nonpolynomial::NonpolynomialSpin::<f64>::default()
        .system()
        .expect("valid");
    let lifted = system.lift();
    let p = state(&system, &[0.3, -0.4, 0.8]);
    let mut function = so3_nonpolynomial::NonpolynomialSpinGenerating6::new(&system, 0.1);
    let mut over =
        so3_nonpolynomial::NonpolynomialSpinGenerating6::new(&lifted, Dual::constant_of(0.1));
    let (mut xi, mut hessian) = (system.zero_state(), system.zero_jacobian());
    function.linearize(&p, &mut xi, &mut hessian);
    let (mut zeta, mut expected) = (system.zero_state(), system.zero_jacobian());
    let zero = lifted.zero_state();
    generic::linearize_by_duals(&mut over, &zero, &p, &mut zeta, &mut expected);
    assert!(relative_distance(xi.as_slice(), zeta.as_slice()) < STEP);
    assert!(relative_distance(&entries(&hessian), &entries(&expected)) < STEP);
    assert_eq!(hessian.transpose(), hessian);
}
