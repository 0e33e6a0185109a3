//! The systems against their reference values: trajectories by the command, kernels and single
//! steps by the golden code and by the generic forms.

use crate::common;

use crate::systems::{
    CotangentEulerArnold, Declared, FreeRigidBody, HeavyTop, Heisenberg, KirchhoffBody, ManakovTop,
    NonpolynomialSpin, Pendulum, Sl2Quadratic, Su3Quadratic, TodaLattice, distance,
    relative_distance, state,
};
use crate::vectors::{Reference, number, numbers, rows, steps};
use lie_runtime::generic;
use lie_runtime::methods::{
    Cayley, ImplicitMidpoint, ImplicitStepper, LieMidpoint, Method, Stepper,
};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::{CayleyPoisson, Implicit, Poisson, SquareMatrix, State};

/// Round-off of a kernel: a few operations on numbers near 1.
const ROUND_OFF: f64 = 4.0 * f64::EPSILON;
/// Round-off of a step, and of some thousand.
const STEP: f64 = 1e-15;
const RUN: f64 = 1e-13;

/// `lie run` with gauss6 at the times of the reference; the error is round-off, that of
/// the method is far smaller.
fn trajectory(name: &str) {
    let reference = Reference::vector(name);
    let times = reference.times().join(",");
    let spec = format!("specs/{name}.json");
    let (header, rows) = common::lie(&format!(
        "run {spec} --method gauss6 --step 0.01 --at {times} --quiet"
    ))
    .ok()
    .csv();
    let states = reference.states();
    let dimension = states[0].len();
    assert_eq!(header[0], "t");
    assert_eq!(header[dimension + 1], "energy");
    assert_eq!(rows.len(), states.len());
    let mut errors = Vec::new();
    for ((row, state), time) in rows.iter().zip(&states).zip(reference.times()) {
        assert_eq!(row[0], number(&time.into()));
        errors.push(distance(&row[1..=dimension], state));
    }
    let largest = errors.iter().copied().fold(0.0, f64::max);
    println!("{name}: error {largest:.1e} of gauss6 with step 0.01");
    assert!(largest < RUN, "{name}: {errors:?}");
}

fn matrix<P: Poisson<f64>>(matrix: &P::Jacobian) -> Vec<f64> {
    let n = matrix.dimension();
    let entries = (0..n).flat_map(|row| (0..n).map(move |column| (row, column)));
    entries
        .map(|(row, column)| matrix.get(row, column))
        .collect()
}

/// Kernels at the initial state.
fn kernels<D: Declared>() {
    let reference = Reference::vector(D::FILE);
    let system = D::declared::<f64>();
    let mu = D::initial::<f64>();
    let check = |what: &str, value: &[f64], expected: &[f64]| {
        let error = relative_distance(value, expected);
        assert!(error <= ROUND_OFF, "{} of {}: {error:e}", what, D::FILE);
    };
    check(
        "initial state",
        mu.as_slice(),
        &numbers(&reference.0["initial_state"]),
    );
    check(
        "energy",
        &[system.hamiltonian(&mu)],
        &[number(&reference.0["energy"])],
    );

    let values = &reference.0["pointwise_at_initial_state"];
    let mut vector = system.zero_state();
    system.gradient(&mu, &mut vector);
    check("gradient", vector.as_slice(), &numbers(&values["gradient"]));
    system.vector_field(&mu, &mut vector);
    check("vector field", vector.as_slice(), &numbers(&values["rhs"]));
    generic::vector_field(&system, &mu, &mut vector);
    check(
        "generic vector field",
        vector.as_slice(),
        &numbers(&values["rhs"]),
    );
    let mut entries = system.zero_jacobian();
    system.hessian(&mu, &mut entries);
    check(
        "Hessian",
        &matrix::<D::System<f64>>(&entries),
        &rows(&values["hessian"]).concat(),
    );
    system.poisson_matrix(&mu, &mut entries);
    let expected = rows(&values["poisson_matrix"]).concat();
    check(
        "Poisson matrix",
        &matrix::<D::System<f64>>(&entries),
        &expected,
    );

    let coadjoint = &reference.0["coadjoint"];
    let xi = state(&system, &numbers(&coadjoint["xi"]));
    generic::coadjoint_action(&system, &xi, &mu, &mut vector);
    check(
        "coadjoint action",
        vector.as_slice(),
        &numbers(&coadjoint["Ad_star_exp_xi_mu0"]),
    );
}

/// Checks single steps of both sizes, made by steppers from the step size.
fn check_steps<D: Declared, T>(method: &str, kind: &str, stepper: impl Fn(f64) -> T)
where
    T: Stepper<f64, State = <D::System<f64> as Poisson<f64>>::State>,
{
    let expected = steps(D::FILE, method);
    assert_eq!(expected.len(), 2, "{method} of {}", D::FILE);
    for (h, expected) in expected {
        let mut mu = D::initial::<f64>();
        let report = stepper(h).step(&mut mu, &mut ());
        let report = report.unwrap_or_else(|failure| panic!("{method} of {}: {failure}", D::FILE));
        let error = distance(mu.as_slice(), &expected);
        println!(
            "{}: {kind} {method}, h = {h}: {error:.1e}, {} iterations",
            D::FILE,
            report.iterations
        );
        assert!(
            error < STEP,
            "{kind} {method} of {}, h = {h}: {error:e}",
            D::FILE
        );
    }
}

fn midpoint<D: Declared>() {
    let (system, newton) = (&D::declared::<f64>(), NewtonOptions::default());
    check_steps::<D, _>("poisson_midpoint", "fused", |h| {
        ImplicitMidpoint.stepper(system, h, &newton)
    });
    check_steps::<D, _>("poisson_midpoint", "generic", |h| {
        ImplicitStepper::new(
            generic::Midpoint::new(system, h),
            system.zero_state(),
            &newton,
        )
    });
}

fn exponential<D: Declared>() {
    let (system, newton) = (&D::declared::<f64>(), NewtonOptions::default());
    check_steps::<D, _>("retraction_exp", "fused", |h| {
        LieMidpoint::exp().stepper(system, h, &newton)
    });
    check_steps::<D, _>("retraction_exp", "generic", |h| {
        let equation = generic::ExpMidpoint::new(system, h);
        ImplicitStepper::new(equation, system.zero_state(), &newton)
    });
}

fn cayley<D: Declared>()
where
    D::System<f64>: CayleyPoisson<f64> + Implicit<f64, LieMidpoint<Cayley>>,
{
    let (system, newton) = (&D::declared::<f64>(), NewtonOptions::default());
    check_steps::<D, _>("retraction_cayley", "fused", |h| {
        LieMidpoint::cayley().stepper(system, h, &newton)
    });
    check_steps::<D, _>("retraction_cayley", "generic", |h| {
        let equation = generic::CayleyMidpoint::new(system, h);
        ImplicitStepper::new(equation, system.zero_state(), &newton)
    });
}

macro_rules! cayley_test {
    ($system:ident, cayley) => {
        #[test]
        fn cayley() {
            super::cayley::<super::$system>();
        }
    };
    ($system:ident, exp) => {
        #[test]
        fn no_cayley() {
            let steps = super::steps(
                <super::$system as super::Declared>::FILE,
                "retraction_cayley",
            );
            assert!(steps.is_empty());
        }
    };
}

macro_rules! tests {
    ($file:ident, $system:ident, $cayley:ident) => {
        mod $file {
            #[test]
            fn trajectory() {
                super::trajectory(stringify!($file));
            }
            #[test]
            fn kernels() {
                super::kernels::<super::$system>();
            }
            #[test]
            fn midpoint() {
                super::midpoint::<super::$system>();
            }
            #[test]
            fn exponential() {
                super::exponential::<super::$system>();
            }
            cayley_test!($system, $cayley);
        }
    };
}

each_system!(tests);

/// The bounds above are no formality: another method misses them.
#[test]
fn another_step_is_caught() {
    let system = HeavyTop::<f64>::default().system().expect("valid");
    let expected = steps("se3_heavy_top", "poisson_midpoint");
    for (h, expected) in expected {
        let mut mu = HeavyTop::<f64>::default().initial_state();
        let mut stepper = LieMidpoint::exp().stepper(&system, h, &NewtonOptions::default());
        stepper.step(&mut mu, &mut ()).expect("converges");
        assert!(distance(mu.as_slice(), &expected) > 1e-6);
    }
}
