//! Collocation methods whose stages are evaluated together: order, symmetry, the same step as by Newton's iteration, the same
//! digits in lanes, and what happens where the fixed point does not contract.

use crate::systems;

use crate::systems::Su3Quadratic as Su3;
use crate::systems::{
    Declared, HeavyTop, KirchhoffBody, NonpolynomialSpin, Random, distance, relative_distance,
    se3_heavy_top, se3_kirchhoff, so3_nonpolynomial, su3_quadratic,
};
use crate::vectors::Reference;
use lie_runtime::Equation;
use lie_runtime::generic::{CohenHairerStep, Gauss};
use lie_runtime::methods::{Facts, ImplicitStepper, Method, StepReport, Stepper};
use lie_runtime::newton::{FailureReason, NewtonOptions};
use lie_runtime::prelude::*;
use su3_quadratic::Su3QuadraticSystem as Su3System;

/// Makes steps and returns the reports.
fn run<S: Scalar, P: Poisson<S>>(
    system: &P,
    method: &impl Method<S, P>,
    options: &NewtonOptions,
    mu: &mut P::State,
    h: S,
    steps: usize,
) -> Vec<StepReport> {
    let mut stepper = method.stepper(system, h, options);
    let step = |_| stepper.step(mu, &mut ()).expect("the step is solved");
    (0..steps).map(step).collect()
}

/// The order as a slope of errors at a time of the reference values.
fn order<D: Declared, M: Method<f64, D::System<f64>>>(
    method: &M,
    until: &str,
    steps: &[u32],
) -> f64 {
    let reference = Reference::vector(D::FILE);
    let row = reference.times().iter().position(|&time| time == until);
    let end = &reference.states()[row.expect("a time of the file")];
    let until: f64 = until.parse().expect("a number");
    let points: Vec<(f64, f64)> = steps
        .iter()
        .map(|&steps| {
            let mut mu = D::initial::<f64>();
            let h = until / f64::from(steps);
            let options = NewtonOptions::default();
            run(
                &D::declared::<f64>(),
                method,
                &options,
                &mut mu,
                h,
                steps as usize,
            );
            (h, distance(mu.as_slice(), end))
        })
        .collect();
    println!("{} {}: {points:?}", M::ID, D::FILE);
    slope(&points)
}

/// The slope of the errors between 1e-6 and round-off, by least squares in logarithms.
fn slope(points: &[(f64, f64)]) -> f64 {
    let clear = points
        .iter()
        .filter(|(_, error)| (2e-13..1e-6).contains(error));
    let logs: Vec<(f64, f64)> = clear.map(|(h, error)| (h.ln(), error.ln())).collect();
    assert!(logs.len() >= 3, "{points:?}");
    let count = logs.len() as f64;
    let mean = |part: fn(&(f64, f64)) -> f64| logs.iter().map(part).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let products: f64 = logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    let slope = products / logs.iter().map(|p| (p.0 - x).powi(2)).sum::<f64>();
    println!("    slope {slope:.2} from {} points", logs.len());
    slope
}

#[test]
fn orders_are_those_stated() {
    fn check<M>(method: M, spin: &[u32], bodies: &[u32])
    where
        M: Facts
            + Method<f64, so3_nonpolynomial::NonpolynomialSpinSystem>
            + Method<f64, se3_kirchhoff::KirchhoffBodySystem>
            + Method<f64, se3_heavy_top::HeavyTopSystem>,
    {
        for slope in [
            order::<NonpolynomialSpin, _>(&method, "2", spin),
            order::<KirchhoffBody, _>(&method, "10", bodies),
            order::<HeavyTop, _>(&method, "10", bodies),
        ] {
            let claimed = f64::from(M::ORDER);
            assert!(
                (slope - claimed).abs() < 0.16 * claimed,
                "{}: {slope}",
                M::ID
            );
        }
    }
    check(Gauss8, &[12, 14, 16, 20, 24, 28], &[14, 18, 22, 28, 34, 40]);
    check(
        Gauss10,
        &[5, 6, 7, 8, 10, 12, 14],
        &[8, 10, 12, 14, 17, 20, 24],
    );
    check(Gauss12, &[4, 5, 6, 7, 8, 9], &[6, 7, 8, 9, 10, 12, 14]);
    check(Gauss14, &[3, 4, 5, 6, 7], &[5, 6, 7, 8, 9, 10]);
    check(Gauss16, &[3, 4, 5], &[4, 5, 6, 7, 8]);
}

/// The orders of energy-preserving collocation where it is not that of Gauss, because H is not quadratic.
#[test]
fn orders_of_energy_preserving_collocation() {
    fn check<M>(method: M, spin: &[u32])
    where
        M: Facts + Method<f64, so3_nonpolynomial::NonpolynomialSpinSystem>,
    {
        let slope = order::<NonpolynomialSpin, _>(&method, "2", spin);
        let claimed = f64::from(M::ORDER);
        assert!(
            (slope - claimed).abs() < 0.16 * claimed,
            "{}: {slope}",
            M::ID
        );
    }
    check(CohenHairer8::new(), &[12, 14, 16, 20, 24, 28]);
    check(CohenHairer10::new(), &[5, 6, 7, 8, 10, 12, 14]);
    check(CohenHairer12::new(), &[4, 5, 6, 7, 8, 9]);
    check(CohenHairer14::new(), &[3, 4, 5, 6, 7]);
    check(CohenHairer16::new(), &[2, 3, 4]);
}

/// The energy of an H that is no polynomial is kept to round-off, at steps at which Gauss collocation of the same order
/// loses it; that of a quadratic H is, and the steps are those of Gauss collocation to the last bit.
#[test]
fn the_energy_is_kept() {
    let (system, start) = (
        NonpolynomialSpin::declared::<f64>(),
        NonpolynomialSpin::initial::<f64>(),
    );
    let before = system.hamiltonian(&start);
    let off = |method: &dyn Fn(&mut _)| {
        let mut mu = start;
        method(&mut mu);
        (system.hamiltonian(&mu) - before).abs()
    };
    let options = NewtonOptions::default();
    macro_rules! check {
        ($energy:expr, $gauss:expr, $h:literal) => {
            let kept = off(&|mu| {
                run(&system, &$energy, &options, mu, $h, 400);
            });
            let lost = off(&|mu| {
                run(&system, &$gauss, &options, mu, $h, 400);
            });
            println!("{kept:e}, Gauss {lost:e}");
            assert!(kept < 2e-14 && lost > 1e-11, "{kept:e} {lost:e}");
        };
    }
    check!(CohenHairer8::new(), Gauss8, 0.2);
    check!(CohenHairer12::new(), Gauss12, 0.35);
    check!(CohenHairer16::new(), Gauss16, 0.5);

    let (body, mut mu) = (
        KirchhoffBody::declared::<f64>(),
        KirchhoffBody::initial::<f64>(),
    );
    let mut gauss = mu;
    run(&body, &CohenHairer16::new(), &options, &mut mu, 0.3, 20);
    run(&body, &Gauss16, &options, &mut gauss, 0.3, 20);
    assert_eq!(mu, gauss);
}

/// One step by Newton's iteration.
fn by_newton<P: Poisson<f64>, E>(system: &P, equation: E, mu: &mut P::State)
where
    E: Equation<f64, State = P::State>,
{
    let options = NewtonOptions::default();
    let mut stepper = ImplicitStepper::new(equation, system.zero_state(), &options);
    stepper.step(mu, &mut ()).expect("the step is solved");
}

/// The step does not depend on how its equation is solved, nor on what was computed before, and a step back undoes it.
#[test]
fn a_step_is_the_solution_of_its_equation() {
    fn check<D: Declared, M>(
        method: &M,
        solve: impl Fn(&D::System<f64>, f64, &mut <D::System<f64> as Poisson<f64>>::State),
        h: f64,
    ) where
        M: Method<f64, D::System<f64>>,
    {
        let (system, start) = (D::declared::<f64>(), D::initial::<f64>());
        let options = NewtonOptions::default();
        let mut newton = start.clone();
        solve(&system, h, &mut newton);
        let mut fresh = start.clone();
        run(&system, method, &options, &mut fresh, h, 1);
        let off = relative_distance(fresh.as_slice(), newton.as_slice());
        assert!(off < 1e-15, "{} {}: {off:e}", M::ID, D::FILE);

        // after a walk of thirty steps elsewhere
        let mut stepper = method.stepper(&system, h, &options);
        let mut other = start.clone();
        other.as_mut_slice()[0] += 0.2;
        for _ in 0..30 {
            stepper
                .step(&mut other, &mut ())
                .expect("the step is solved");
        }
        let mut later = start.clone();
        stepper
            .step(&mut later, &mut ())
            .expect("the step is solved");
        assert_eq!(later.as_slice(), fresh.as_slice(), "{} {}", M::ID, D::FILE);

        let mut back = fresh.clone();
        run(&system, method, &options, &mut back, -h, 1);
        let off = relative_distance(back.as_slice(), start.as_slice());
        assert!(off < 1e-15, "{} {}: {off:e} there and back", M::ID, D::FILE);
    }
    check::<NonpolynomialSpin, _>(
        &Gauss8,
        |system, h, mu| by_newton(system, Gauss::<_, _, 4>::new(system, h), mu),
        0.2,
    );
    check::<NonpolynomialSpin, _>(
        &Gauss16,
        |system, h, mu| by_newton(system, Gauss::<_, _, 8>::new(system, h), mu),
        0.2,
    );
    check::<HeavyTop, _>(
        &Gauss10,
        |system, h, mu| by_newton(system, Gauss::<_, _, 5>::new(system, h), mu),
        0.3,
    );
    check::<HeavyTop, _>(
        &Gauss16,
        |system, h, mu| by_newton(system, Gauss::<_, _, 8>::new(system, h), mu),
        0.3,
    );
    check::<KirchhoffBody, _>(
        &Gauss12,
        |system, h, mu| by_newton(system, Gauss::<_, _, 6>::new(system, h), mu),
        0.3,
    );
    check::<KirchhoffBody, _>(
        &Gauss14,
        |system, h, mu| by_newton(system, Gauss::<_, _, 7>::new(system, h), mu),
        0.3,
    );
    check::<NonpolynomialSpin, _>(
        &CohenHairer8::new(),
        |system, h, mu| by_newton(system, CohenHairerStep::<_, _, 4>::new(system, h), mu),
        0.2,
    );
    check::<NonpolynomialSpin, _>(
        &CohenHairer14::new(),
        |system, h, mu| by_newton(system, CohenHairerStep::<_, _, 7>::new(system, h), mu),
        0.2,
    );
    check::<NonpolynomialSpin, _>(
        &CohenHairer16::new(),
        |system, h, mu| by_newton(system, CohenHairerStep::<_, _, 8>::new(system, h), mu),
        0.2,
    );
    check::<HeavyTop, _>(
        &CohenHairer10::new(),
        |system, h, mu| by_newton(system, CohenHairerStep::<_, _, 5>::new(system, h), mu),
        0.2,
    );
}

/// Where the fixed point does not contract, Newton's iteration solves the step, unless it is not wanted.
#[test]
fn a_step_that_does_not_contract_is_solved_by_newton() {
    let (system, start) = (HeavyTop::declared::<f64>(), HeavyTop::initial::<f64>());
    let h = 5.0;
    let mut mu = start;
    let reports = run(&system, &Gauss16, &NewtonOptions::default(), &mut mu, h, 1);
    assert!(reports[0].factorizations > 0, "no Newton at h = {h}");
    let mut newton = start;
    by_newton(&system, Gauss::<_, _, 8>::new(&system, h), &mut newton);
    assert_eq!(mu, newton);

    let mut stepper = Gauss16.stepper(&system, h, &NewtonOptions::fixed_point());
    let mut mu = start;
    let failure = stepper.step(&mut mu, &mut ()).expect_err("no Newton");
    assert_eq!(failure.reason, FailureReason::NotConverged);
    assert_eq!((failure.lanes, mu), (1, start));

    let near = run(
        &system,
        &Gauss16,
        &NewtonOptions::fixed_point(),
        &mut mu,
        0.1,
        1,
    );
    assert_eq!(near[0].factorizations, 0);
}

/// Newton's iteration is made where it is asked for, and only there at an ordinary step; the step is the same.
#[test]
fn the_iteration_that_is_asked_for_is_made() {
    fn check<M: Facts + Method<f64, se3_heavy_top::HeavyTopSystem>>(method: M) {
        let (system, start) = (HeavyTop::declared::<f64>(), HeavyTop::initial::<f64>());
        let mut usual = start;
        run(
            &system,
            &method,
            &NewtonOptions::default(),
            &mut usual,
            0.3,
            20,
        );
        for options in [NewtonOptions::newton(), NewtonOptions::simplified()] {
            let mut mu = start;
            let reports = run(&system, &method, &options, &mut mu, 0.3, 20);
            for report in reports {
                assert!(
                    report.fixed_point == 0 && report.factorizations > 0,
                    "{}",
                    M::ID
                );
            }
            let off = relative_distance(mu.as_slice(), usual.as_slice());
            assert!(off < 1e-13, "{} {:?}: {off:e}", M::ID, options.iteration);
        }
    }
    check(Gauss8);
    check(Gauss16);
    check(CohenHairer16::new());
}

/// Steps at which the fixed point contracts slowly, and those that are left to Newton's iteration, keep both Casimirs.
#[test]
fn casimirs_are_kept_at_every_step_that_is_solved() {
    fn check<M: Facts + Method<f64, se3_heavy_top::HeavyTopSystem>>(method: M) -> usize {
        let system = HeavyTop::declared::<f64>();
        let casimirs = |mu: &_| {
            let mut out = [0.0; 2];
            system.casimirs(mu, &mut out);
            out
        };
        let mut solved = 0;
        for k in 1..=7 {
            let h = 0.4 * f64::from(k);
            let mut mu = HeavyTop::initial::<f64>();
            let before = casimirs(&mu);
            let mut stepper = method.stepper(&system, h, &NewtonOptions::default());
            let (mut steps, mut size) = (0, 1.0_f64);
            while steps < 20 && stepper.step(&mut mu, &mut ()).is_ok() {
                steps += 1;
                size = size.max(mu.as_slice().iter().map(|x| x * x).sum());
            }
            solved += steps;
            for (now, before) in casimirs(&mu).into_iter().zip(before) {
                let lost = (now - before).abs() / size;
                assert!(
                    lost < 1e-13,
                    "{}, h = {h}: {lost:e} in {steps} steps",
                    M::ID
                );
            }
        }
        println!("{}: {solved} steps of {}", M::ID, 7 * 20);
        solved
    }
    for solved in [
        check(Gauss8),
        check(Gauss16),
        check(CohenHairer16::new()),
        check(Collective16::smallest()),
        check(Isospectral16::new()),
    ] {
        assert!(solved > 40, "{solved}");
    }
}

/// A looser tolerance costs fewer iterations, and errs by about as much as it says.
#[test]
fn the_tolerance_bounds_the_error_of_a_step() {
    let (system, start) = (HeavyTop::declared::<f64>(), HeavyTop::initial::<f64>());
    let (h, steps) = (0.3, 40);
    let with = |tolerance: f64| {
        let options = NewtonOptions {
            tolerance,
            ..NewtonOptions::default()
        };
        let mut mu = start;
        let reports = run(&system, &Gauss16, &options, &mut mu, h, steps);
        (
            mu,
            reports.iter().map(|report| report.iterations).sum::<u32>(),
        )
    };
    let (exact, most) = with(1.0 / 1024.0);
    let mut before = most;
    for tolerance in [1e3, 1e6, 1e9] {
        let (mu, iterations) = with(tolerance);
        let error = relative_distance(mu.as_slice(), exact.as_slice());
        println!("{tolerance:e}: error {error:e}, {iterations} iterations of {most}");
        assert!(iterations < before);
        assert!(
            error < 100.0 * tolerance * f64::EPSILON,
            "{tolerance:e}: {error:e}"
        );
        before = iterations;
    }
    assert!(relative_distance(with(1e9).0.as_slice(), exact.as_slice()) > 1e3 * f64::EPSILON);
}

/// Eight trajectories in lanes have the digits of eight runs, also where some lanes need Newton's iteration.
#[test]
fn a_lane_has_the_digits_of_its_own_run() {
    fn check<D: Declared, M>(method: &M, sizes: [f64; 8], h: f64) -> bool
    where
        M: Method<F64x8, D::System<F64x8>> + Method<f64, D::System<f64>>,
    {
        let mut random = Random(2018);
        let (lanes, scalar) = (D::declared::<F64x8>(), D::declared::<f64>());
        let initial = D::initial::<f64>();
        let mut alone = sizes.map(|size| {
            let mut mu = initial.clone();
            for entry in mu.as_mut_slice() {
                *entry = size * (*entry + 0.5 * random.number());
            }
            mu
        });
        let mut together = lanes.zero_state();
        for (row, entry) in together.as_mut_slice().iter_mut().enumerate() {
            *entry = F64x8::new(core::array::from_fn(|lane| alone[lane].as_slice()[row]));
        }
        let options = NewtonOptions::default();
        let reports = run(&lanes, method, &options, &mut together, F64x8::splat(h), 12);
        for (lane, mu) in alone.iter_mut().enumerate() {
            run(&scalar, method, &options, mu, h, 12);
            for (row, x) in mu.as_slice().iter().enumerate() {
                let other = together.as_slice()[row].lane(lane);
                assert_eq!(
                    other.to_bits(),
                    x.to_bits(),
                    "{} {} {lane} {row}",
                    M::ID,
                    D::FILE
                );
            }
        }
        reports.iter().any(|report| report.factorizations > 0)
    }
    let sizes = [1e-6, 1e-3, 0.03, 0.1, 0.3, 0.5, 0.7, 1.0];
    assert!(!check::<NonpolynomialSpin, _>(&Gauss16, sizes, 0.1));
    check::<HeavyTop, _>(&Gauss8, sizes, 0.2);
    check::<HeavyTop, _>(&Gauss12, sizes, 0.3);
    assert!(
        check::<KirchhoffBody, _>(&Gauss8, sizes, 3.5),
        "some lane should need Newton"
    );
}

/// Quadratic Casimirs and a quadratic H stay, whatever the step; a control loses them.
#[test]
fn quadratic_invariants_stay() {
    let (system, start) = (Su3::declared::<f64>(), Su3::initial::<f64>());
    let drift = |mu: &<Su3System as Poisson<f64>>::State| {
        let relative = (system.hamiltonian(mu) / system.hamiltonian(&start) - 1.0).abs();
        let square = |mu: &<Su3System as Poisson<f64>>::State| {
            let mut casimirs = [0.0; 2];
            system.casimirs(mu, &mut casimirs);
            casimirs[0]
        };
        assert_eq!(system.casimir_degree(0), Some(2));
        relative.max((square(mu) / square(&start) - 1.0).abs())
    };
    let mut mu = start;
    run(
        &system,
        &Gauss8,
        &NewtonOptions::default(),
        &mut mu,
        0.2,
        500,
    );
    let kept = drift(&mu);
    assert!(kept < 2e-14, "{kept:e}");
    let mut mu = start;
    run(&system, &Rk4, &NewtonOptions::default(), &mut mu, 0.2, 500);
    let lost = drift(&mu);
    assert!(lost > 1e-6, "{lost:e}");
}

/// Along a walk, where the iteration starts from the step before, each step is that of Newton's iteration to round-off, also
/// where it starts so near that few iterations are made.
#[test]
fn each_step_of_a_walk_is_solved_to_the_end() {
    type System = so3_nonpolynomial::NonpolynomialSpinSystem;
    type Solve = fn(&System, f64, &mut <System as Poisson<f64>>::State);
    fn worst<M>(method: &M, solve: Solve, h: f64) -> f64
    where
        M: Method<f64, so3_nonpolynomial::NonpolynomialSpinSystem>,
    {
        let system = NonpolynomialSpin::declared::<f64>();
        let mut mu = NonpolynomialSpin::initial::<f64>();
        let mut stepper = method.stepper(&system, h, &NewtonOptions::default());
        let step = |_| {
            let mut newton = mu;
            solve(&system, h, &mut newton);
            stepper.step(&mut mu, &mut ()).expect("the step is solved");
            distance(mu.as_slice(), newton.as_slice())
        };
        (0..400).map(step).fold(0.0, f64::max)
    }
    for h in [0.2, 0.05, 0.01, 0.002] {
        let by_gauss = worst(
            &Gauss16,
            |system, h, mu| by_newton(system, Gauss::<_, _, 8>::new(system, h), mu),
            h,
        );
        let worst = worst(
            &CohenHairer12::new(),
            |system, h, mu| by_newton(system, CohenHairerStep::<_, _, 6>::new(system, h), mu),
            h,
        )
        .max(by_gauss);
        println!("h = {h}: {worst:e}");
        assert!(worst < 1e-15, "h = {h}: {worst:e}");
    }
}

/// The collective methods over the Hopf map: on the points of `T*R^2` as in the momenta of the stages.
mod over_the_hopf_map {
    use super::*;
    use lie_runtime::diagnostics::poisson_defect;
    use lie_runtime::generic::{QuaternionStages, StageMomenta};

    type Spin<S> = so3_nonpolynomial::NonpolynomialSpinSystem<S>;
    type Top<S> = systems::so3_free_rigid_body::FreeRigidBodySystem<S>;
    type Reduced<'a, P, const STAGES: usize> =
        StageMomenta<'a, f64, P, QuaternionStages<f64, STAGES>, STAGES>;

    /// One step in the momenta of the stages, by Newton's iteration.
    fn reduced<const STAGES: usize>(
        system: &Spin<f64>,
        mu: &mut <Spin<f64> as Poisson<f64>>::State,
        h: f64,
    ) {
        let equation = Reduced::<_, STAGES>::new(system, h);
        let options = NewtonOptions::default();
        let mut stepper = ImplicitStepper::new(equation, system.zero_state(), &options);
        stepper.step(mu, &mut ()).expect("the step is solved");
    }

    #[test]
    fn a_step_is_that_in_the_momenta() {
        fn check<const STAGES: usize, M: Method<f64, Spin<f64>>>(method: &M) {
            let system = NonpolynomialSpin::declared::<f64>();
            let initial = NonpolynomialSpin::initial::<f64>();
            for turn in 0..4 {
                // above and below the equator, where the points are chosen differently
                let mut start = initial;
                start[2] *= [1.0, -1.0, 0.0, -4.0][turn];
                let mut expected = start;
                reduced::<STAGES>(&system, &mut expected, 0.1);
                let mut mu = start;
                run(&system, method, &NewtonOptions::default(), &mut mu, 0.1, 1);
                let off = relative_distance(mu.as_slice(), expected.as_slice());
                assert!(off < 1e-15, "{} {turn}: {off:e}", M::ID);
                run(&system, method, &NewtonOptions::default(), &mut mu, -0.1, 1);
                let off = relative_distance(mu.as_slice(), start.as_slice());
                assert!(off < 2e-15, "{} {turn}: {off:e} there and back", M::ID);
            }
        }
        check::<4, _>(&Collective8::hopf());
        check::<6, _>(&Collective12::hopf());
        check::<8, _>(&Collective16::hopf());
    }

    #[test]
    fn orders_are_those_stated() {
        fn check<M: Method<f64, Spin<f64>>>(method: M, steps: &[u32]) {
            let slope = order::<NonpolynomialSpin, _>(&method, "2", steps);
            let claimed = f64::from(M::ORDER);
            assert!(
                (slope - claimed).abs() < 0.16 * claimed,
                "{}: {slope}",
                M::ID
            );
        }
        check(Collective8::hopf(), &[8, 10, 12, 14, 16, 20, 24]);
        check(Collective12::hopf(), &[3, 4, 5, 6, 7, 8]);
        check(Collective16::hopf(), &[2, 3, 4, 5]);
    }

    /// The executed map is a Poisson map to round-off at any step that is solved; Gauss collocation on mu is not.
    #[test]
    fn the_step_is_a_poisson_map() {
        let system = NonpolynomialSpin::declared::<Dual<f64>>();
        let mu = NonpolynomialSpin::initial::<f64>();
        let options = NewtonOptions::default();
        let defect = |h: f64| {
            poisson_defect(&system, &Collective16::hopf(), h, mu.as_slice(), &options)
                .expect("the step is solved")
        };
        for h in [0.05, 0.2, -0.5, 1.0] {
            let found = defect(h);
            println!("h = {h}: {found:e}");
            assert!(found < 2e-14, "h = {h}: {found:e}");
        }
        let control = poisson_defect(&system, &Gauss16, 1.0, mu.as_slice(), &options);
        assert!(control.expect("the step is solved") > 1e-10);
    }

    /// The Casimir stays, and the energy error does not grow.
    #[test]
    fn the_orbit_is_kept_and_the_energy_does_not_drift() {
        let system = systems::FreeRigidBody::declared::<f64>();
        let start = systems::FreeRigidBody::initial::<f64>();
        let mut mu = start;
        let mut stepper = Method::<f64, Top<f64>>::stepper(
            &Collective8::hopf(),
            &system,
            0.5,
            &NewtonOptions::default(),
        );
        let energy = |mu: &<Top<f64> as Poisson<f64>>::State| {
            (system.hamiltonian(mu) / system.hamiltonian(&start) - 1.0).abs()
        };
        let (mut early, mut late) = (0.0_f64, 0.0_f64);
        for k in 0..20_000 {
            stepper.step(&mut mu, &mut ()).expect("the step is solved");
            if k < 2_000 {
                early = early.max(energy(&mu));
            } else {
                late = late.max(energy(&mu));
            }
        }
        let length = (mu.norm() / start.norm() - 1.0).abs();
        println!("energy {early:e}, then {late:e}; length {length:e}");
        assert!(early > 1e-12 && late < 1.2 * early, "{early:e} {late:e}");
        assert!(length < 1e-12, "{length:e}");
    }

    #[test]
    fn a_lane_has_the_digits_of_its_own_run() {
        let (lanes, scalar) = (
            NonpolynomialSpin::declared::<F64x8>(),
            NonpolynomialSpin::declared::<f64>(),
        );
        let mut random = Random(2018);
        let mut alone: [_; 8] = core::array::from_fn(|lane| {
            let mut mu = NonpolynomialSpin::initial::<f64>();
            for entry in mu.as_mut_slice() {
                *entry = (*entry + random.number()) * 0.2 * lane as f64;
            }
            mu
        });
        let mut together = lanes.zero_state();
        for (row, entry) in together.as_mut_slice().iter_mut().enumerate() {
            *entry = F64x8::new(core::array::from_fn(|lane| alone[lane][row]));
        }
        let (method, options) = (Collective12::hopf(), NewtonOptions::default());
        run(
            &lanes,
            &method,
            &options,
            &mut together,
            F64x8::splat(0.1),
            12,
        );
        for (lane, mu) in alone.iter_mut().enumerate() {
            run(&scalar, &method, &options, mu, 0.1, 12);
            for (row, x) in mu.iter().enumerate() {
                let other = together[row].lane(lane);
                assert_eq!(other.to_bits(), x.to_bits(), "lane {lane}, row {row}");
            }
        }
    }
}
