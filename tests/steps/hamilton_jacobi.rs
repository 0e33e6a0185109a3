//! K-HJ: Poisson maps on any bracket, by generating functions on a symplectic realization.

use crate::frozen_flow::{Nambu, NambuSystem};
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
use lie_runtime::{Equation, Implicit, Lift, Poisson, Scalar, State};

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

/// The energy swings and does not drift, and the Casimir of degree four stays; `gauss4` loses both.
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

lie_poisson! {
    /// A bracket of degree two.
    pub system Species;
    poisson {
        {x, y} = -x*y/2;
        {x, z} = x*z/2;
        {y, z} = -y*z;
    }
    state x, y, z;
    hamiltonian = 2*x + y + 2*z + log(y) - 2*log(z) + x*z/5;
    initial = [1, 1.9, 0.5];
    methods = [k-hj4, k-hj6];
}

lie_poisson! {
    /// A bracket of degree one beside a constant that is not rational: no extension has it.
    pub system Shifted;
    algebra {
        basis m, p, q;
        [m, p] = q;
        [m, q] = -p;
    }
    state x, y, z;
    cocycle { {y, z} = sqrt(2)/2; }
    hamiltonian = x^2/2 + y^2/3 + z^4/5 + x*y/4;
    initial = [0.4, 0.7, -0.5];
    methods = [k-hj4, k-hj6];
}

/// Functions written out by the compiler and those over dual numbers make the same steps.
#[test]
fn fused_functions_are_the_generic_ones() {
    let h = 0.2;
    macro_rules! compare {
        ($($declared:ident $function:ident;)+) => { $({
            let declared = $declared::new();
            let (system, start) = (declared.system().expect("constants"), declared.initial_state());
            let fused = system.equation(&$function::new(), h);
            let code = concat!(stringify!($declared), stringify!($function));
            let name = std::any::type_name_of_val(&fused);
            assert!(name.contains(code), "{name}");
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
            assert!(off < 1e-14, "{name}: {off:e}");
        })+ };
    }
    compare!(
        Nambu HamiltonJacobi4;
        Nambu HamiltonJacobi6;
        Species HamiltonJacobi4;
        Species HamiltonJacobi6;
        Shifted HamiltonJacobi4;
        Shifted HamiltonJacobi6;
    );
}

/// The step of a direction so long that the way is divided, as an equation over any scalar.
fn long_step<S: Scalar>(
    system: &NambuSystem<S>,
    h: S,
) -> generic::RealizationStep<'_, S, NambuSystem<S>, generic::Generating2<'_, S, NambuSystem<S>>> {
    generic::RealizationStep::with_function(system, generic::Generating2::new(system, h), h)
}

/// Newton's matrix is the derivative of the residual, also where the way has many parts.
#[test]
fn matrices_are_derivatives() {
    let nambu = Nambu::new();
    let (system, start) = (nambu.system().expect("constants"), nambu.initial_state());
    for h in [0.1, 3.0, 30.0] {
        let mut equation = long_step(&system, h);
        equation.set_base(&start);
        let (mut residual, mut matrix) = (equation.zero_unknown(), equation.zero_matrix());
        let mut at = start;
        at[0] -= 0.05;
        equation.linearize(&at, &mut residual, &mut matrix);
        for column in 0..3 {
            let size = 1e-5;
            let mut ends = [equation.zero_unknown(), equation.zero_unknown()];
            for (end, sign) in ends.iter_mut().zip([1.0, -1.0]) {
                let mut beside = at;
                beside[column] += sign * size;
                equation.residual(&beside, end);
            }
            for row in 0..3 {
                let slope = (ends[0][row] - ends[1][row]) / (2.0 * size);
                let off = (slope - matrix[(row, column)]).abs();
                // the difference is right to size^2 times the third derivative, h^3
                assert!(
                    off < 1e-8 * (1.0 + h * h * h),
                    "h = {h}: {row}, {column}: {off:e}"
                );
            }
        }
    }
}

/// Lanes whose ways have different numbers of parts have the residuals of their own equations.
#[test]
fn lanes_divide_their_ways_alone() {
    let nambu = Nambu::new();
    let (one, start) = (nambu.system().expect("constants"), nambu.initial_state());
    let lanes = Nambu::<F64x8>::default();
    let eight = lanes.system().expect("constants");
    let sizes = [0.1, 30.0, 0.2, 3.0, 12.0, 0.05, 50.0, 1.0];
    let mut h = F64x8::splat(0.0);
    for (lane, size) in sizes.into_iter().enumerate() {
        h = h.with_lane(lane, size);
    }
    let mut together = long_step(&eight, h);
    let base = lanes.initial_state();
    together.set_base(&base);
    let (mut residual, mut matrix) = (together.zero_unknown(), together.zero_matrix());
    together.linearize(&base, &mut residual, &mut matrix);
    for (lane, size) in sizes.into_iter().enumerate() {
        let mut alone = long_step(&one, size);
        alone.set_base(&start);
        let (mut own, mut rows) = (alone.zero_unknown(), alone.zero_matrix());
        alone.linearize(&start, &mut own, &mut rows);
        let off = (0..3).map(|k| (own[k] - residual[k].lane(lane)).abs());
        let turned = (0..9).map(|k| (rows[k] - matrix[k].lane(lane)).abs() / (1.0 + size * size));
        let worst = off.chain(turned).fold(0.0, f64::max);
        assert!(worst < 1e-13, "lane {lane}, h = {size}: {worst:e}");
    }
}

/// With a bracket that is linear the way is the coadjoint action, and the steps are those of generating functions with exp, by which a
/// declared algebra has them.
#[test]
fn on_an_algebra_they_are_the_methods_along_exp() {
    let body = FreeRigidBody::new();
    let (system, start) = (body.system().expect("constants"), body.initial_state());
    let h = 0.3;
    macro_rules! compare {
        ($($function:ident, $method:expr, $other:expr;)+) => { $(
            let function = generic::$function::new(&system, h);
            let equation = generic::RealizationStep::with_function(&system, function, h);
            let options = NewtonOptions::newton();
            let mut stepper = ImplicitStepper::new(equation, system.zero_state(), &options);
            let mut mu = start;
            for _ in 0..5 {
                stepper.step(&mut mu, &mut ()).expect("the step converges");
            }
            let other = after(&system, &$other, &start, (h, 5));
            let off = distance(other.as_slice(), mu.as_slice());
            assert!(off < 1e-14, "{}: {off:e}", stringify!($function));
            assert_eq!(after(&system, &$method, &start, (h, 5)), other);
        )+ };
    }
    compare!(
        Generating2, HamiltonJacobi2::new(), LieMidpoint::exp();
        HamiltonJacobi4, HamiltonJacobi4::new(), Generating4::exp();
        HamiltonJacobi6, HamiltonJacobi6::new(), Generating6::exp();
    );
    let midpoint = after(&system, &ImplicitMidpoint, &start, (h, 5));
    let exact = after(&system, &LieMidpoint::exp(), &start, (h, 5));
    assert!(distance(midpoint.as_slice(), exact.as_slice()) > 1e-6);
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
