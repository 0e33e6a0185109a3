//! Orbit and energy on brackets that are not those of an algebra: cubic, quadratic, with a cocycle, and one without Jacobi's identity.

use crate::systems::{
    BodyWithCirculation, Bracketed as _, CanonicalPendulum, LotkaVolterra, distance,
};
use lie_runtime::diagnostics::{order_of_convergence, reference, symmetry_defect};
use lie_runtime::generic::{
    FrozenFlow, FrozenStep, Generating2, Motion, OrbitEnergyStep, RealizationStep,
};
use lie_runtime::methods::{Compose4, Facts, Gonzalez, HamiltonJacobi2, Method, OrbitEnergy};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use lie_runtime::{Equation, Poisson, State};

lie_poisson! {
    /// Nambu's bracket of a Casimir of degree four: the Poisson matrix is cubic.
    pub system Nambu;
    poisson {
        {x, y} = z^3 + x*y/2;
        {y, z} = x^3 + y*z/2 + x;
        {x, z} = -y^3 - x*z/2;
    }
    state x, y, z;
    hamiltonian = x^2/2 + y^2 + 3*z^2/2 + x*z/3 + y^3/5;
    casimir C = (x^4 + y^4 + z^4)/4 + x*y*z/2 + x^2/2;
    initial = [0.7, 0.5, -0.6];
    methods = [orbit-energy, gonzalez, k-hj2, k-hj4, k-hj6];
}

lie_poisson! {
    /// The same with friction and a torque that depends on the time, and damping on the leaf.
    pub system DrivenNambu;
    poisson {
        {x, y} = z^3 + x*y/2;
        {y, z} = x^3 + y*z/2 + x;
        {x, z} = -y^3 - x*z/2;
    }
    state x, y, z;
    hamiltonian = x^2/2 + y^2 + 3*z^2/2 + x*z/3 + y^3/5;
    forces { x = -x/5 + cos(t)/3; z = -z/10; }
    initial = [0.7, 0.5, -0.6];
    methods = [orbit-energy, gonzalez];
}

lie_poisson! {
    pub system DampedNambu;
    poisson {
        {x, y} = z^3 + x*y/2;
        {y, z} = x^3 + y*z/2 + x;
        {x, z} = -y^3 - x*z/2;
    }
    state x, y, z;
    hamiltonian = x^2/2 + y^2 + 3*z^2/2 + x*z/3 + y^3/5;
    casimir C = (x^4 + y^4 + z^4)/4 + x*y*z/2 + x^2/2;
    dissipation { double-bracket(strength = 3/10); }
    initial = [0.7, 0.5, -0.6];
    methods = [orbit-energy, gonzalez];
}

lie_poisson! {
    /// The way along y is `x' = 1 + x^2`, a tangent.
    pub system Pole;
    poisson { {x, y} = 1 + x^2; }
    state x, y;
    hamiltonian = x^2/2 + y;
    initial = [0, 0];
    methods = [orbit-energy, gonzalez, k-hj2];
}

/// The largest errors of energy and first Casimir along steps.
fn drift<P: Poisson<f64>>(
    system: &P,
    method: &impl Method<f64, P>,
    start: &P::State,
    (h, steps): (f64, u32),
) -> (f64, f64) {
    let casimir = |mu: &P::State| {
        let mut values = vec![0.0; system.casimir_count()];
        system.casimirs(mu, &mut values);
        values.first().copied().unwrap_or(0.0)
    };
    let (energy, level) = (system.hamiltonian(start), casimir(start));
    let mut worst = (0.0_f64, 0.0_f64);
    let mut mu = start.clone();
    let mut stepper = method.stepper(system, h, &NewtonOptions::default());
    for _ in 0..steps {
        stepper.step(&mut mu, &mut ()).expect("the step converges");
        worst.0 = worst.0.max((system.hamiltonian(&mu) - energy).abs());
        worst.1 = worst.1.max((casimir(&mu) - level).abs());
    }
    worst
}

/// Energy and Casimirs to round-off on brackets of degree one, two and three, along each discrete gradient. The control is the
/// discrete gradient method itself, which loses a Casimir of degree four.
#[test]
fn energy_and_casimirs_are_kept() {
    macro_rules! kept {
        ($name:literal, $system:expr, $start:expr, $($method:expr),+) => {
            $(
                let (energy, casimir) = drift($system, &$method, $start, (0.1, 300));
                let method = stringify!($method);
                println!("{}, {method}: energy {energy:e}, Casimir {casimir:e}", $name);
                assert!(energy < 6e-13 && casimir < 6e-13, "{} by {method}: {energy:e}, {casimir:e}", $name);
            )+
        };
    }
    let nambu = Nambu::new().system().expect("finite constants");
    let start = Nambu::new().initial_state();
    kept!(
        "Nambu",
        &nambu,
        &start,
        OrbitEnergy::gonzalez(),
        OrbitEnergy::mean_value(),
        OrbitEnergy::itoh_abe(),
        Compose4::new(OrbitEnergy::gonzalez())
    );
    let species = (LotkaVolterra::declared(), LotkaVolterra::initial::<f64>());
    kept!(
        "Lotka–Volterra",
        &species.0,
        &species.1,
        OrbitEnergy::gonzalez(),
        OrbitEnergy::itoh_abe()
    );
    let body = (
        BodyWithCirculation::declared(),
        BodyWithCirculation::initial::<f64>(),
    );
    kept!("cocycle", &body.0, &body.1, OrbitEnergy::gonzalez());
    let pendulum = (
        CanonicalPendulum::declared(),
        CanonicalPendulum::initial::<f64>(),
    );
    kept!(
        "canonical",
        &pendulum.0,
        &pendulum.1,
        OrbitEnergy::gonzalez()
    );
    let (energy, casimir) = drift(&nambu, &Gonzalez, &start, (0.1, 1000));
    assert!(
        energy < 2e-12 && casimir > 1e-3,
        "control: {energy:e}, {casimir:e}"
    );
}

fn order<P: Poisson<f64>>(system: &P, method: &impl Method<f64, P>, start: &P::State) -> f64 {
    let exact = reference(system, start, 1.0).expect("a solution").mu;
    let points: Vec<(f64, f64)> = [20, 28, 40, 56]
        .into_iter()
        .map(|steps| {
            let h = 1.0 / f64::from(steps);
            let mut mu = start.clone();
            let mut stepper = method.stepper(system, h, &NewtonOptions::default());
            for _ in 0..steps {
                stepper.step(&mut mu, &mut ()).expect("the step converges");
            }
            (h, distance(mu.as_slice(), exact.as_slice()))
        })
        .collect();
    let order = order_of_convergence(&points, 1e-13);
    order.unwrap_or_else(|| panic!("{points:?}")).slope
}

#[test]
fn orders() {
    fn check<P, M>(system: &P, start: &P::State, method: &M)
    where
        P: Poisson<f64>,
        M: Facts + Method<f64, P>,
    {
        let slope = order(system, method, start);
        let stated = f64::from(M::ORDER);
        println!("{} {}: {slope}", system.name(), M::ID);
        assert!(
            (slope - stated).abs() < 0.2,
            "{} on {}: {slope}",
            M::ID,
            system.name()
        );
    }
    let (nambu, start) = (
        Nambu::new().system().expect("constants"),
        Nambu::new().initial_state(),
    );
    check(&nambu, &start, &OrbitEnergy::gonzalez());
    check(&nambu, &start, &OrbitEnergy::mean_value());
    check(&nambu, &start, &Compose4::new(OrbitEnergy::gonzalez()));
    let species = (LotkaVolterra::declared(), LotkaVolterra::initial::<f64>());
    check(&species.0, &species.1, &OrbitEnergy::itoh_abe());
    let driven = DrivenNambu::new();
    let (system, start) = (driven.system().expect("constants"), driven.initial_state());
    check(&system, &start, &OrbitEnergy::gonzalez());
    check(&system, &start, &Compose4::new(OrbitEnergy::gonzalez()));
    let damped = DampedNambu::new();
    check(
        &damped.system().expect("constants"),
        &damped.initial_state(),
        &OrbitEnergy::gonzalez(),
    );
}

#[test]
fn steps_are_symmetric() {
    let (nambu, start) = (
        Nambu::new().system().expect("constants"),
        Nambu::new().initial_state(),
    );
    for h in [0.1, 0.4] {
        let off = symmetry_defect(
            &nambu,
            &OrbitEnergy::gonzalez(),
            h,
            &start,
            &NewtonOptions::default(),
        );
        assert!(off.expect("steps") < 4e-15, "h = {h}");
    }
}

/// Under damping along the leaf H falls at every step size, and the Casimir stays; the discrete gradient method lets it go.
#[test]
fn damping_stays_on_the_leaf() {
    let damped = DampedNambu::new();
    let (system, start) = (damped.system().expect("constants"), damped.initial_state());
    let casimir = |mu: &_| {
        let mut value = [0.0];
        system.casimirs(mu, &mut value);
        value[0]
    };
    let level = casimir(&start);
    let mut off = [0.0_f64; 2];
    for h in [0.05, 0.3] {
        let mut mu = start;
        let mut stepper = OrbitEnergy::gonzalez().stepper(&system, h, &NewtonOptions::default());
        let mut energy = system.energy(&mu);
        for _ in 0..60 {
            stepper.step(&mut mu, &mut ()).expect("the step converges");
            let new = system.energy(&mu);
            assert!(new <= energy + 1e-15, "H rises by {:e}", new - energy);
            energy = new;
            off[0] = off[0].max((casimir(&mu) - level).abs());
        }
        assert!(energy < system.energy(&start) - 0.1, "H falls to {energy}");
        let mut mu = start;
        let mut stepper = Gonzalez.stepper(&system, h, &NewtonOptions::default());
        for _ in 0..60 {
            stepper.step(&mut mu, &mut ()).expect("the step converges");
            off[1] = off[1].max((casimir(&mu) - level).abs());
        }
    }
    assert!(off[0] < 3e-14 && off[1] > 1e-4, "{off:?}");
}

/// H with the momentum of the time stays where forces act: what it changes by is their work.
#[test]
fn the_balance_of_work_is_exact() {
    let driven = DrivenNambu::new();
    let (system, start) = (driven.system().expect("constants"), driven.initial_state());
    let (energy, _) = drift(&system, &OrbitEnergy::gonzalez(), &start, (0.1, 500));
    assert!(energy < 5e-14, "{energy:e}");
}

/// The end of the flow along a direction from a state.
fn ended<P: Poisson<f64>>(system: &P, x: &P::State, start: &P::State) -> P::State {
    let mut end = start.clone();
    let mut flow = <FrozenFlow<f64, P::State, P::Jacobian> as Motion<f64, P>>::new(system);
    flow.carry(system, x, start, &mut end);
    end
}

/// The flow divides its way where eight nodes do not resolve it, and is exact there too: forth and back, and along the Casimir.
#[test]
fn long_ways_are_divided() {
    let (nambu, start) = (
        Nambu::new().system().expect("constants"),
        Nambu::new().initial_state(),
    );
    let casimir = |mu: &_| {
        let mut value = [0.0];
        nambu.casimirs(mu, &mut value);
        value[0]
    };
    for size in [0.3, 3.0, 30.0] {
        let (mut x, mut back) = (start, start);
        for (k, entry) in [0.5, -1.0, 0.7].into_iter().enumerate() {
            (x.as_mut_slice()[k], back.as_mut_slice()[k]) = (size * entry, -size * entry);
        }
        let end = ended(&nambu, &x, &start);
        let again = ended(&nambu, &back, &end);
        let off = distance(again.as_slice(), start.as_slice());
        let level = (casimir(&end) - casimir(&start)).abs();
        println!("{size}: {off:e}, Casimir {level:e}");
        assert!(
            off < 1e-13 * size.max(1.0) && level < 1e-13 * size.max(1.0),
            "{size}: {off:e}, {level:e}"
        );
    }
}

/// From -x to x the slopes of a tangent are even about the middle of the way, so that their odd coefficients are zero however coarse the nodes
/// are.
#[test]
fn a_way_that_is_its_own_mirror_image_is_divided() {
    let pole = Pole::new().system().expect("constants");
    for x in [0.5_f64, 1.5, 3.0] {
        let end = ended(&pole, &[0.0, 2.0 * x.atan()].into(), &[-x, 0.0].into());
        assert!((end[0] - x).abs() < 1e-13 * x * x, "{x}: {end:?}");
    }
}

/// Where a way begins at zero what it reaches is its size.
#[test]
fn ways_from_zero_have_a_size() {
    let pole = Pole::new().system().expect("constants");
    let end = ended(&pole, &[0.0, 0.5].into(), &[0.0, 0.0].into());
    assert!((end[0] - 0.5_f64.tan()).abs() < 1e-15, "{end:?}");
    fn check(system: &PoleSystem<f64>, method: &impl Method<f64, PoleSystem<f64>>) {
        let mut stepper = method.stepper(system, 0.1, &NewtonOptions::default());
        let mut state = [0.0, 0.0].into();
        stepper.step(&mut state, &mut ()).expect("a step");
        let energy = state[0] * state[0] / 2.0 + state[1];
        assert!(energy.abs() < 1e-4 && state[0] > 0.09, "{state:?}");
    }
    check(&pole, &HamiltonJacobi2::new());
    check(&pole, &OrbitEnergy::gonzalez());
}

/// On the dual of a Lie algebra the flow is the coadjoint action, and both steps are the same map.
#[test]
fn on_an_algebra_it_is_the_coadjoint_action() {
    let body = crate::systems::FreeRigidBody::new();
    let system = body.system().expect("constants");
    let start = body.initial_state();
    let h = 0.3;
    let mut frozen =
        FrozenStep::<_, _, lie_runtime::generic::GonzalezGradient<_, _>>::new(&system, h);
    let mut plain =
        OrbitEnergyStep::<_, _, lie_runtime::generic::GonzalezGradient<_, _>>::new(&system, h);
    let mut ends = [start; 2];
    for (equation, end) in [
        (
            &mut frozen as &mut dyn Equation<f64, State = _, Unknown = _, Matrix = _>,
            0,
        ),
        (&mut plain, 1),
    ] {
        equation.set_base(&start);
        let mut unknown = equation.zero_unknown();
        let mut residual = equation.zero_unknown();
        equation.initial_guess(&mut unknown);
        for _ in 0..80 {
            equation.residual(&unknown, &mut residual);
            State::axpy(&mut unknown, -1.0, &residual);
        }
        equation.result(&unknown, &mut ends[end]);
    }
    let off = distance(ends[0].as_slice(), ends[1].as_slice());
    assert!(off < 1e-14, "{off:e}");
}

/// Nodes of the way and the end of the step are found by one iteration, and by Newton's method where the way needs more than one part. The
/// control takes the unknown alone for the end of that iteration.
#[test]
fn nodes_and_end_are_found_together() {
    let nambu = Nambu::new();
    let (system, start) = (nambu.system().expect("constants"), nambu.initial_state());
    let equation = |h: f64| {
        let mut equation = RealizationStep::with_function(&system, Generating2::new(&system, h), h);
        equation.set_base(&start);
        equation
    };
    for (h, is_whole) in [(0.1, true), (0.5, false)] {
        let mut together = equation(h);
        let (mut unknown, mut update) = (together.zero_unknown(), together.zero_unknown());
        together.initial_guess(&mut unknown);
        let mut within = f64::INFINITY;
        for _ in 0..60 {
            within = together.approach(&unknown, &mut update, true);
            unknown -= update;
        }
        let moved = together.norm(&update);
        equation(h).residual(&unknown, &mut update);
        let off = together.norm(&update);
        println!("{h}: the unknown moves by {moved:e}, within {within:e}, off {off:e}");
        assert!(moved < 1e-14, "{h}: {moved:e}");
        assert_eq!((within < 1e-14, off < 1e-14), (is_whole, is_whole), "{h}");
        fn check<M: for<'a> Method<f64, NambuSystem<f64>>>(
            system: &NambuSystem<f64>,
            method: &M,
            start: &<NambuSystem<f64> as Poisson<f64>>::State,
            (h, is_whole): (f64, bool),
        ) {
            let [automatic, newton] = [NewtonOptions::default(), NewtonOptions::newton()];
            let mut states = [*start, *start];
            let mut stepper = method.stepper(system, h, &automatic);
            let report = stepper.step(&mut states[0], &mut ()).expect("a step");
            assert_eq!(report.factorizations == 0, is_whole, "{h}: {report:?}");
            let mut stepper = method.stepper(system, h, &newton);
            stepper.step(&mut states[1], &mut ()).expect("a step");
            let off = distance(states[0].as_slice(), states[1].as_slice());
            assert!(off < 1e-14, "{h}: {off:e}");
        }
        check(&system, &HamiltonJacobi2::new(), &start, (h, is_whole));
        check(&system, &OrbitEnergy::gonzalez(), &start, (h, is_whole));
    }
}
