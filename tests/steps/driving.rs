//! Forces and dissipation beside the Hamiltonian, declared by the macro: outside solutions, what is kept, and what is not.

use lie_runtime::Poisson;
use lie_runtime::methods::Facts;
use lie_runtime::prelude::*;

lie_poisson! {
    /// A body whose every component decays alike.
    system Decaying;
    algebra = so(3);
    state x, y, z;
    parameters { k = 1/5; }
    hamiltonian = x^2/2 + y^2/4 + z^2/6;
    forces { x = -k*x; y = -k*y; z = -k*z; }
    casimir C = x^2 + y^2 + z^2;
    methods = [gauss4, gauss16, midpoint, rk4, taylor];
}

lie_poisson! {
    /// The same body without.
    system Free;
    algebra = so(3);
    state x, y, z;
    hamiltonian = x^2/2 + y^2/4 + z^2/6;
    casimir C = x^2 + y^2 + z^2;
    methods = [gauss16];
}

lie_poisson! {
    /// Gilbert's damping of a magnetic moment in a field, with a metric that is not the identity.
    system Switching;
    algebra = so(3);
    state x, y, z;
    parameters { alpha = 1/10; }
    hamiltonian = -z;
    dissipation { double-bracket(strength = alpha); }
    casimir C = x^2 + y^2 + z^2;
    methods = [gauss4, gauss16, midpoint, rk4, taylor];
}

lie_poisson! {
    /// A force of the time, and one that is not linear.
    system Pushed;
    algebra = so(3);
    state x, y, z;
    vectors { m = (x, y, z); b = (1/3, 0, 1); }
    hamiltonian = x^2/2 + y^2/4 + z^2/6;
    forces { m = cos(t)*b - norm(m)*m/4; }
    dissipation { rayleigh(matrix = [[1/10, 0, 0], [0, 1/5, 0], [0, 0, 0]]); }
    methods = [gauss4, gauss6, gauss8, gauss16, midpoint, rk4, dopri5, taylor];
}

lie_poisson! {
    /// The pushed body by its Lagrangian.
    system ByLagrangian;
    algebra = so(3);
    state x, y, z;
    velocity u, v, w;
    vectors { m = (x, y, z); b = (1/3, 0, 1); }
    lagrangian = (u^2 + 2*v^2 + 3*w^2)/2;
    forces { m = cos(t)*b - norm(m)*m/4; }
    dissipation { rayleigh(matrix = [[1/10, 0, 0], [0, 1/5, 0], [0, 0, 0]]); }
}

const START: [f64; 3] = [0.8, 0.3, -0.5];

/// The state with the coordinates that carry the time.
fn start() -> [f64; 6] {
    let [x, y, z] = START;
    [x, y, z, 0.0, 0.0, 1.0]
}

fn run<P, M>(system: P, method: M, step: f64, until: f64) -> Solution<f64, P::State>
where
    P: Poisson<f64>,
    P::State: From<[f64; 6]> + std::fmt::Debug,
    M: Method<f64, P>,
{
    let problem = Problem::new(system, P::State::from(start()), (0.0, until));
    solve(&problem, method, &Options::new(step)).expect("a run")
}

/// A homogeneous quadratic H under friction `-k mu` is the free motion with another time:
/// `mu(t) = e^(-kt) nu((1 - e^(-kt))/k)`.
#[test]
fn linear_friction_is_a_change_of_time() {
    let until = 12.0;
    let damped = run(
        Decaying::new().system().expect("a system"),
        Gauss16,
        0.05,
        until,
    );
    let (k, end) = (0.2_f64, damped.mu.last().expect("a row"));
    let shorter = (1.0 - (-k * until).exp()) / k;
    let free = Problem::new(
        Free::new().system().expect("a system"),
        START,
        (0.0, shorter),
    );
    let free = solve(&free, Gauss16, &Options::new(shorter / 200.0)).expect("a run");
    let nu = free.mu.last().expect("a row");
    for i in 0..3 {
        let expected = (-k * until).exp() * nu[i];
        assert!(
            (end[i] - expected).abs() < 1e-14,
            "{} and {expected}",
            end[i]
        );
        assert!((end[i] - nu[i]).abs() > 1e-3, "the control");
    }
}

/// `H + p` is the balance of the energy: `-p` is the work. A quadratic one is kept by Gauss methods to round-off, and by `rk4` is not.
#[test]
fn the_energy_balance_is_that_of_the_time_and_its_momentum() {
    let drift = |solution: &Solution<f64, <DecayingSystem<f64> as Poisson<f64>>::State>| {
        let system = Decaying::new().system().expect("a system");
        let balance = |mu| system.hamiltonian(mu) - system.hamiltonian(&solution.mu[0]);
        let largest = solution.mu.iter().map(balance);
        largest.fold(0.0_f64, |most, x| most.max(x.abs()))
    };
    let exact = run(
        Decaying::new().system().expect("a system"),
        Gauss4,
        0.1,
        50.0,
    );
    assert!(drift(&exact) < 1e-14, "{}", drift(&exact));
    let plain = run(Decaying::new().system().expect("a system"), Rk4, 0.1, 50.0);
    assert!(drift(&plain) > 1e-9, "the control: {}", drift(&plain));
    let lost = exact.energy[0] - exact.energy[exact.energy.len() - 1];
    assert!(lost > 0.2, "something was taken: {lost}");
}

/// `tan(theta/2)` of the angle to the field decays as `e^(-alpha t)` for |mu| = 1 (L. D. Landau and E. M. Lifshitz, 1935).
#[test]
fn a_moment_switches_in_the_time_of_landau_and_lifshitz() {
    let norm = START.iter().map(|x| x * x).sum::<f64>().sqrt();
    let [x, y, z] = START.map(|x| x / norm);
    let problem = Problem::new(
        Switching::new().system().expect("a system"),
        [x, y, z, 0.0, 0.0, 1.0],
        (0.0, 40.0),
    );
    let found = solve(&problem, Gauss16, &Options::new(0.1)).expect("a run");
    let tangent = |z: f64| ((1.0 - z) / (1.0 + z)).sqrt();
    for (time, mu) in found.t.iter().zip(&found.mu) {
        let expected = tangent(z) * (-0.1 * time).exp();
        assert!(
            (tangent(mu[2]) - expected).abs() < 1e-12 * (1.0 + expected),
            "at {time}"
        );
    }
    let mut energies = found.energy.windows(2);
    assert!(
        energies.all(|pair| pair[1] < pair[0]),
        "H falls in every step"
    );
    assert!(found.drift().casimirs[0].max < 1e-14);
}

#[test]
fn a_moment_stays_on_its_sphere_for_long() {
    let problem = Problem::new(
        Switching::new().system().expect("a system"),
        start(),
        (0.0, 1e4),
    );
    let options = Options::new(0.1).save(Save::Ends);
    let kept = solve(&problem, Gauss4, &options).expect("a run").drift();
    assert!(kept.casimirs[0].max < 1e-13, "{}", kept.casimirs[0].max);
    let problem = Problem::new(
        Switching::new().system().expect("a system"),
        start(),
        (0.0, 10.0),
    );
    let control = solve(&problem, Rk4, &Options::new(0.1))
        .expect("a run")
        .drift();
    assert!(
        control.casimirs[0].max > 1e-10,
        "{}",
        control.casimirs[0].max
    );
}

type State = <PushedSystem<f64> as Poisson<f64>>::State;

/// Where the pushed body is at t = 2.
fn pushed() -> State {
    let system = Pushed::new().system().expect("a system");
    *run(system, Gauss16, 0.01, 2.0).mu.last().expect("a row")
}

/// The order of the error there by two steps.
fn order<P, M>(make: impl Fn() -> P, method: M, steps: [f64; 2], exact: &State) -> f64
where
    P: Poisson<f64, State = State>,
    M: Method<f64, P> + Copy,
{
    let error = |step: f64| {
        let end = run(make(), method, step, 2.0);
        let end = end.mu.last().expect("a row");
        // p too: the work has the order of the motion
        let pairs = end.as_slice().iter().zip(exact.as_slice()).take(4);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    (error(steps[0]) / error(steps[1])).log2()
}

fn near(found: f64, order: u32) {
    let above = found - f64::from(order);
    assert!((-0.3..0.8).contains(&above), "{found} for {order}");
}

/// The generated code of a Lagrangian beside which something acts has its variational methods, with the motion of the Hamiltonian.
#[test]
fn variational_methods_keep_their_orders_under_forces() {
    let exact = &pushed();
    let system = || ByLagrangian::new().system().expect("a system");
    near(order(system, Variational2::exp(), [0.02, 0.01], exact), 2);
    near(order(system, Variational4::exp(), [0.1, 0.05], exact), 4);
    near(order(system, Variational6::exp(), [0.2, 0.1], exact), 6);
    let end = run(system(), Variational6::exp(), 0.05, 2.0);
    let end = end.mu.last().expect("a row");
    assert!((end - exact).amax() < 1e-9);
    let start = State::from(start());
    assert!((start - exact).amax() > 0.1, "the control: it has moved");
}

/// Orders by slope against a run of `gauss16` with small steps.
#[test]
fn methods_keep_their_orders_under_forces() {
    let exact = &pushed();
    fn slope<M>(method: M, steps: [f64; 2], exact: &State) -> f64
    where
        M: Method<f64, PushedSystem<f64>> + Copy,
    {
        let system = || Pushed::new().system().expect("a system");
        order(system, method, steps, exact)
    }
    near(
        slope(ImplicitMidpoint, [0.02, 0.01], exact),
        ImplicitMidpoint::ORDER,
    );
    near(slope(Gauss4, [0.1, 0.05], exact), Gauss4::ORDER);
    near(slope(Gauss6, [0.2, 0.1], exact), Gauss6::ORDER);
    near(slope(Gauss8, [0.4, 0.2], exact), Gauss8::ORDER);
    near(slope(Rk4, [0.05, 0.025], exact), Rk4::ORDER);
}

/// What nothing acts on has none of it.
#[test]
fn a_system_without_forces_says_so() {
    let (free, pushed) = (
        Free::new().system().expect("a system"),
        Pushed::new().system().expect("a system"),
    );
    assert!(!free.is_forced() && !free.is_damped() && free.clock().is_none());
    assert!(pushed.is_forced() && pushed.is_damped());
    let switching = Switching::new().system().expect("a system");
    assert!(!switching.is_forced() && switching.is_damped());
    assert!(
        switching.casimir_is_kept(0)
            && !Decaying::new()
                .system()
                .expect("a system")
                .casimir_is_kept(0)
    );
}
