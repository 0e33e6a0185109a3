//! Brackets that are declared by their entries, canonical and quadratic, or have some beside an algebra, a cocycle: generated
//! kernels and equations against generic ones and against dual numbers, what is kept, orders, tensors.

use crate::equations::{Comparison, of_field};
use crate::errors::{Errors, entries, unknown_entries};
use crate::kernels::of_poisson;
use crate::systems::{
    BodyWithCirculation, Bracketed, CanonicalPendulum, LotkaVolterra, OfPoisson, Random, distance,
    lotka_volterra::LotkaVolterraSystem, state,
};
use lie_runtime::diagnostics::{order_of_convergence, poisson_defect, reference};
use lie_runtime::generic::{
    self, CohenHairerStep, DiscreteGradientStep, GonzalezGradient, ItohAbeGradient,
    MeanValueGradient,
};
use lie_runtime::methods::{
    CohenHairer, Compose4, Facts, Gauss4, Gauss6, Gonzalez, ImplicitMidpoint, ItohAbe, MeanTensor,
    MeanValue, Method, Rk4, Stepper, WithTensor,
};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use lie_runtime::{Equation, Implicit, Poisson, State, Unknown};

lie_poisson! {
    /// so(3)* with a bracket that is changed by a function of the state: the Casimir is the same.
    pub system Scaled;
    poisson { {x, y} = -(1 + x^2/4)*z; {y, z} = -(1 + x^2/4)*x; {z, x} = -(1 + x^2/4)*y; }
    state x, y, z;
    hamiltonian = x^2/2 + y^2 + z^4/4;
    casimir C = x^2 + y^2 + z^2;
    initial = [0.6, -0.5, 0.7];
    methods = [midpoint, gauss4, gonzalez, mean-value, itoh-abe, cohen-hairer4];
}

/// A state near the initial one.
fn near<D: Bracketed>(random: &mut Random) -> Vec<f64> {
    let initial = D::initial::<f64>();
    let near = initial.as_slice().iter();
    let mut near: Vec<f64> = near.map(|x| x + 0.2 * random.number()).collect();
    // brackets beside an algebra are those where the unit is 1
    if let Some(clock) = D::declared::<f64>().clock() {
        near[clock.time + 1] = 1.0;
    }
    near
}

/// All kernels and equations on random states.
fn compare<D: Bracketed>(nudge: f64) -> Errors {
    let (mut random, mut errors) = (Random(2018), Errors::new(nudge));
    let (fused, system) = (D::declared::<f64>(), D::declared::<f64>());
    let dual = D::declared::<Dual<f64>>();
    for _ in 0..20 {
        let mu = near::<D>(&mut random);
        of_poisson(&fused, &system, &dual, &mu, &mut random, &mut errors);
        let mu = state(&fused, &mu);
        let h = 0.1 * random.number();
        of_field(&fused, &system, &mu, h, &mut random, &mut errors);
        let mut compare = Comparison {
            mu: &mu,
            random: &mut random,
            errors: &mut errors,
        };
        let step = DiscreteGradientStep::<_, _, GonzalezGradient<_, _>>::new(&system, h);
        compare.run("gonzalez", fused.equation(&Gonzalez, h), step);
        let step = DiscreteGradientStep::<_, _, MeanValueGradient<_, _>>::new(&system, h);
        compare.run("mean-value", fused.equation(&MeanValue, h), step);
        let step = DiscreteGradientStep::<_, _, ItohAbeGradient<_, _>>::new(&system, h);
        compare.run("itoh-abe", fused.equation(&ItohAbe, h), step);
        let step = DiscreteGradientStep::<_, _, MeanValueGradient<_, _>>::new(&system, h);
        let one = CohenHairer::<1>::new();
        compare.run("cohen-hairer2", fused.equation(&one, h), step);
        let (two, three) = (CohenHairer::<2>::new(), CohenHairer::<3>::new());
        let step = CohenHairerStep::<_, _, 2>::new(&system, h);
        compare.run("cohen-hairer4", fused.equation(&two, h), step);
        let step = CohenHairerStep::<_, _, 3>::new(&system, h);
        compare.run("cohen-hairer6", fused.equation(&three, h), step);
    }
    errors
}

/// The Jacobian of an equation against its residual over dual numbers, from a start.
fn jacobian<E, F>(name: &str, real: (E, E::State), dual: (F, F::State), errors: &mut Errors)
where
    E: Equation<f64>,
    F: Equation<Dual<f64>>,
{
    let ((mut real, start), (mut dual, lifted)) = (real, dual);
    real.set_base(&start);
    dual.set_base(&lifted);
    let mut unknown = real.zero_unknown();
    real.initial_guess(&mut unknown);
    let mut random = Random(7);
    let size = unknown.len();
    for index in 0..size {
        unknown.set_entry(index, unknown.entry(index) + 0.05 * random.number());
    }
    let (mut residual, mut matrix) = (real.zero_unknown(), real.zero_matrix());
    real.linearize(&unknown, &mut residual, &mut matrix);
    let mut expected = vec![0.0; size * size];
    let (mut seeded, mut image) = (dual.zero_unknown(), dual.zero_unknown());
    for column in 0..size {
        for index in 0..size {
            let seed = if index == column {
                1.0 + errors.nudge
            } else {
                0.0
            };
            seeded.set_entry(index, Dual::new(unknown.entry(index), seed));
        }
        dual.residual(&seeded, &mut image);
        for row in 0..size {
            expected[row * size + column] = image.entry(row).derivative;
        }
    }
    errors.compare(&format!("{name}, Jacobian"), &entries(&matrix), &expected);
    let values: Vec<f64> = (0..size).map(|row| image.entry(row).value).collect();
    let residual = unknown_entries(&residual);
    errors.compare(&format!("{name}, residual"), &residual, &values);
}

/// The Jacobians of all equations, fused and generic, against dual numbers.
fn jacobians<P, Q>(system: &P, lifted: &Q, mu: &[f64], h: f64, errors: &mut Errors)
where
    P: OfPoisson<f64>,
    Q: OfPoisson<Dual<f64>>,
{
    let (start, dual, step) = (state(system, mu), state(lifted, mu), Dual::constant_of(h));
    macro_rules! fused {
        ($method:expr) => {
            let (method, name) = ($method, format!("fused {}", stringify!($method)));
            let real = (system.equation(&method, h), start.clone());
            jacobian(
                &name,
                real,
                (lifted.equation(&method, step), dual.clone()),
                errors,
            );
        };
    }
    fused!(ImplicitMidpoint);
    fused!(Gauss4);
    fused!(Gauss6);
    fused!(Gonzalez);
    fused!(MeanValue);
    fused!(ItohAbe);
    fused!(CohenHairer::<1>::new());
    fused!(CohenHairer::<2>::new());
    fused!(CohenHairer::<3>::new());
    macro_rules! generic {
        ($new:expr) => {
            jacobian(
                stringify!($new),
                ($new(system, h), start.clone()),
                ($new(lifted, step), dual.clone()),
                errors,
            );
        };
    }
    generic!(generic::Midpoint::new);
    generic!(generic::Gauss::<_, _, 2>::new);
    generic!(DiscreteGradientStep::<_, _, GonzalezGradient<_, _>>::new);
    generic!(DiscreteGradientStep::<_, _, MeanValueGradient<_, _>>::new);
    generic!(DiscreteGradientStep::<_, _, ItohAbeGradient<_, _>>::new);
    generic!(CohenHairerStep::<_, _, 2>::new);
    generic!(CohenHairerStep::<_, _, 3>::new);
    macro_rules! mean {
        ($gradient:ident) => {
            let real = DiscreteGradientStep::<_, _, $gradient<_, _>, _>::with_tensor(
                system, MeanTensor, h,
            );
            let over_duals = DiscreteGradientStep::<_, _, $gradient<_, _>, _>::with_tensor(
                lifted, MeanTensor, step,
            );
            let name = format!("{} with the mean tensor", stringify!($gradient));
            jacobian(
                &name,
                (real, start.clone()),
                (over_duals, dual.clone()),
                errors,
            );
        };
    }
    mean!(GonzalezGradient);
    mean!(MeanValueGradient);
    mean!(ItohAbeGradient);
}

macro_rules! tests {
    ($file:ident, $system:ident) => {
        mod $file {
            use super::*;

            #[test]
            fn fused_equals_generic() {
                let errors = compare::<$system>(0.0);
                println!("{}: {:?}", $system::FILE, errors.largest());
                assert_eq!(errors.beyond_round_off(), [""; 0], "{:?}", errors.largest());
                // a reference at another state is noticed by everything that depends on the state
                let control = compare::<$system>(1e-11).beyond_round_off().len();
                assert!(control > 20, "{control}");
            }

            #[test]
            fn jacobians_equal_dual_numbers() {
                let (system, lifted) = ($system::declared(), $system::declared());
                let (mut random, mut errors) = (Random(5), Errors::new(0.0));
                let mut control = Errors::new(1e-11);
                for _ in 0..10 {
                    let (mu, h) = (near::<$system>(&mut random), 0.1 * random.number());
                    jacobians(&system, &lifted, &mu, h, &mut errors);
                    jacobians(&system, &lifted, &mu, h, &mut control);
                }
                // increments of H over small distances cost digits
                let (largest, name) = errors.largest();
                assert!(largest < 64.0 * f64::EPSILON, "{name}: {largest:e}");
                assert!(control.beyond_round_off().len() >= 19);
            }
        }
    };
}
each_bracket!(tests);

/// The Poisson matrix times the gradient, from the declarations and not from the generated field.
#[test]
fn the_fields_are_those_of_the_declarations() {
    let mut random = Random(11);
    for _ in 0..50 {
        let mu = near::<LotkaVolterra>(&mut random);
        let system = LotkaVolterra::declared::<f64>();
        let mut field = system.zero_state();
        system.vector_field(&state(&system, &mu), &mut field);
        let (a, b, c, nu, m) = (-2.0, -1.0, -0.5, 1.0, 2.0);
        let slope = [a * b, 1.0 + nu / mu[1], -a - m / mu[2]];
        let matrix = [
            [0.0, c * mu[0] * mu[1], b * c * mu[0] * mu[2]],
            [-c * mu[0] * mu[1], 0.0, -mu[1] * mu[2]],
            [-b * c * mu[0] * mu[2], mu[1] * mu[2], 0.0],
        ];
        let product = matrix.map(|row| row.iter().zip(&slope).map(|(p, s)| p * s).sum::<f64>());
        assert!(distance(field.as_slice(), &product) < 1e-14, "{mu:?}");
    }
    let system = BodyWithCirculation::declared::<f64>();
    let mut field = system.zero_state();
    // the time, its momentum and the unit, which is 1, come last
    system.vector_field(
        &state(&system, &[0.5, 1.0, -0.3, 0.0, 0.0, 1.0]),
        &mut field,
    );
    // L' = p1 v2 - p2 v1, p' = (w p2 + kappa v2, -w p1 - kappa v1) with w = L/I, v = p/m
    let (w, v1, v2, kappa) = (0.25, 1.0, -0.1, 0.5);
    let expected = [
        1.0 * v2 - -0.3 * v1,
        w * -0.3 + kappa * v2,
        -w * 1.0 - kappa * v1,
    ];
    assert!(
        distance(&field.as_slice()[..3], &expected) < 1e-15,
        "{field}"
    );
}

fn defect<M>(method: &M, h: f64) -> f64
where
    M: Method<Dual<f64>, <CanonicalPendulum as Bracketed>::System<Dual<f64>>>,
{
    let system = CanonicalPendulum::declared::<Dual<f64>>();
    let mut random = Random(3);
    let mut largest = 0.0;
    for _ in 0..20 {
        let mu = near::<CanonicalPendulum>(&mut random);
        let defect = poisson_defect(&system, method, h, &mu, &NewtonOptions::default());
        largest = f64::max(largest, defect.expect("the step converges"));
    }
    largest
}

/// Of a constant Poisson matrix the midpoint rule and Gauss collocation are Poisson maps.
#[test]
fn symplectic_methods_on_the_canonical_pendulum() {
    let bound = 32.0 * f64::EPSILON;
    for h in [0.3, -0.2, 1.0] {
        for found in [
            defect(&ImplicitMidpoint, h),
            defect(&Gauss4, h),
            defect(&Gauss6, h),
            defect(&Compose4::new(ImplicitMidpoint), h),
        ] {
            assert!(found < bound, "h = {h}: {found:e}");
        }
        for control in [defect(&Rk4, h), defect(&Gonzalez, h), defect(&MeanValue, h)] {
            assert!(control > 1e4 * bound, "h = {h}: {control:e}");
        }
    }
    const { assert!(<ImplicitMidpoint as Facts>::PRESERVES.constant_poisson) };
    const { assert!(!<Rk4 as Facts>::PRESERVES.constant_poisson) };
    fn degree<B: Bracketed>() -> Option<u32> {
        B::declared::<f64>().poisson_degree()
    }
    assert_eq!(degree::<CanonicalPendulum>(), Some(0));
    // that of a central extension is the bracket of an algebra
    assert_eq!(degree::<BodyWithCirculation>(), None);
    assert_eq!(degree::<LotkaVolterra>(), Some(2));
}

fn end<P: Poisson<f64>>(
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

/// The order on Lotka and Volterra's equations, at t = 1, as a slope of errors.
fn order<M: Method<f64, LotkaVolterraSystem>>(method: &M) -> f64 {
    let (system, start) = (LotkaVolterra::declared(), LotkaVolterra::initial::<f64>());
    let exact = reference(&system, &start, 1.0).expect("a solution").mu;
    let points: Vec<(f64, f64)> = [20, 28, 40, 56, 80, 112]
        .into_iter()
        .map(|steps| {
            let h = 1.0 / f64::from(steps);
            let mu = end(&system, method, &start, (h, steps));
            (h, distance(mu.as_slice(), exact.as_slice()))
        })
        .collect();
    let order = order_of_convergence(&points, 1e-13);
    order.unwrap_or_else(|| panic!("{points:?}")).slope
}

#[test]
fn orders_with_a_quadratic_bracket() {
    fn check<M: Facts + Method<f64, LotkaVolterraSystem>>(method: M) {
        let slope = order(&method);
        assert!(
            (slope - f64::from(M::ORDER)).abs() < 0.15,
            "{}: {slope}",
            M::ID
        );
    }
    check(ImplicitMidpoint);
    check(Gauss4);
    check(Gonzalez);
    check(MeanValue);
    check(ItohAbe);
    check(WithTensor::new(Gonzalez, MeanTensor));
    check(WithTensor::new(MeanValue, MeanTensor));
    check(WithTensor::new(ItohAbe, MeanTensor));
    check(CohenHairer::<2>::new());
    check(Compose4::new(WithTensor::new(MeanValue, MeanTensor)));
}

/// How far energy and Casimir move in a hundred steps.
fn drift<M: Method<f64, ScaledSystem>>(method: &M) -> (f64, f64) {
    let system = Scaled::new().system().expect("finite constants");
    let start = Scaled::new().initial_state();
    let casimir = |mu: &_| {
        let mut value = [0.0];
        system.casimirs(mu, &mut value);
        value[0]
    };
    let mut drift = (0.0_f64, 0.0_f64);
    let mut mu = start;
    let mut stepper = method.stepper(&system, 0.1, &NewtonOptions::default());
    for _ in 0..100 {
        stepper.step(&mut mu, &mut ()).expect("the step converges");
        let energy = (system.hamiltonian(&mu) - system.hamiltonian(&start)).abs();
        drift.0 = drift.0.max(energy);
        drift.1 = drift.1.max((casimir(&mu) - casimir(&start)).abs());
    }
    drift
}

/// A Poisson matrix that is not affine, with a quadratic Casimir: `grad C` at the midpoint is in the
/// kernel of the Poisson matrix there, but not of its mean over the ends.
#[test]
fn quadratic_casimirs_and_tensors() {
    let kept = 1e-14;
    for (energy, casimir) in [drift(&ImplicitMidpoint), drift(&Gauss4)] {
        assert!(casimir < kept && energy > 1e-9, "{energy:e} {casimir:e}");
    }
    for (energy, casimir) in [
        drift(&Gonzalez),
        drift(&MeanValue),
        drift(&ItohAbe),
        drift(&CohenHairer::<2>::new()),
    ] {
        assert!(casimir < kept && energy < kept, "{energy:e} {casimir:e}");
    }
    for (energy, casimir) in [
        drift(&WithTensor::new(Gonzalez, MeanTensor)),
        drift(&WithTensor::new(MeanValue, MeanTensor)),
        drift(&WithTensor::new(ItohAbe, MeanTensor)),
    ] {
        assert!(casimir > 1e-6 && energy < kept, "{energy:e} {casimir:e}");
    }
    let (energy, casimir) = drift(&Rk4);
    assert!(casimir > 1e-9 && energy > 1e-9, "{energy:e} {casimir:e}");
}

/// The largest difference of an entry to that of Newton's method from the guess of its equation, relative to the entry, in
/// steps from states of this scale with a solver of this tolerance; and the Jacobians of both. Entries grow and shrink by
/// decades.
fn entry_errors<M>(method: &M, scale: f64, tolerance: f64) -> (f64, [u32; 2])
where
    M: Method<f64, LotkaVolterraSystem>,
{
    let newton = NewtonOptions {
        tolerance,
        ..NewtonOptions::default()
    };
    let (system, mut mu) = (
        LotkaVolterra::declared(),
        LotkaVolterra::initial::<f64>() * scale,
    );
    let mut stepper = method.stepper(&system, 0.05, &newton);
    let (mut largest, mut jacobians) = (0.0_f64, [0; 2]);
    for _ in 0..400 {
        let [mut expected, mut closer] = [mu; 2];
        let mut fresh = method.stepper(&system, 0.05, &NewtonOptions::newton());
        // discrete gradients leave the domain from some states
        let Ok(report) = fresh.step(&mut expected, &mut ()) else {
            break;
        };
        jacobians[1] += report.factorizations;
        let tight = NewtonOptions {
            tolerance: 1e-7,
            ..NewtonOptions::newton()
        };
        let mut fresh = method.stepper(&system, 0.05, &tight);
        fresh.step(&mut closer, &mut ()).expect("a step");
        // the maximum norm ends Newton's method too early where an entry is very small
        let known = |index: usize| (closer[index] / expected[index] - 1.0).abs() < f64::EPSILON;
        let report = stepper.step(&mut mu, &mut ()).expect("a step");
        jacobians[0] += report.factorizations;
        for index in (0..3).filter(|&index| known(index)) {
            largest = largest.max((mu[index] / expected[index] - 1.0).abs());
        }
    }
    (largest, jacobians)
}

/// H depends on small entries by their logarithms: a start from a prediction leaves them as exact as the large ones.
#[test]
fn entries_of_all_sizes_converge() {
    // H is a difference of logarithms up to 230
    const BOUND: f64 = 512.0 * f64::EPSILON;
    fn check<M: Facts + Method<f64, LotkaVolterraSystem>>(method: M) {
        let tolerance = NewtonOptions::default().tolerance;
        for scale in [1.0, 1e-5, 1e-20, 1e-100] {
            let (error, [jacobians, newton]) = entry_errors(&method, scale, tolerance);
            println!("{} {scale:e}: {error:.1e}, {jacobians} {newton}", M::ID);
            assert!(error < BOUND, "{} {scale:e}: {error:e}", M::ID);
            assert!(jacobians < newton, "{jacobians} {newton}");
        }
    }
    check(ImplicitMidpoint);
    check(Gauss4);
    check(Gauss6);
    check(Gonzalez);
    check(MeanValue);
    check(CohenHairer::<2>::new());
    // the control: an iteration that ends too early
    let (error, _) = entry_errors(&ImplicitMidpoint, 1.0, 1e9);
    assert!(error > BOUND, "{error:e}");
}
