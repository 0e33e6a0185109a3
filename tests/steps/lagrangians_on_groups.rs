//! Lagrangians `L(g, xi, t)` that are not quadratic in the velocity: H is their Legendre transform by iteration, with the group element
//! and the time beside the velocity.

use lie_runtime::Poisson;
use lie_runtime::methods::Method;
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use nalgebra::SVector;

// `L = -c^2 sqrt(1 - <A xi, xi>/c^2) + b R13 u - (1 + cos(t)/5) R33`, of which the Hamiltonian is
// `c^2 sqrt(1 + <A^-1 n, n>/c^2) + (1 + cos(t)/5) R33` with `n = mu - b R13 e1`.
lie_poisson! {
    pub system TurnedByLagrangian;
    algebra {
        basis e1, e2, e3;
        [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2;
        matrix e1 = [[0, 0, 0], [0, 0, -1], [0, 1, 0]];
        matrix e2 = [[0, 0, 1], [0, 0, 0], [-1, 0, 0]];
        matrix e3 = [[0, -1, 0], [1, 0, 0], [0, 0, 0]];
    }
    group R;
    state x, y, z;
    velocity u, v, w;
    parameters { c = 1.25; b = 2/5; }
    lagrangian = -c^2*sqrt(1 - (u^2 + 2*v^2 + w^2/2)/c^2) + b*R13*u - (1 + cos(t)/5)*R33;
    initial = [9/10, -3/2, 2, 3/5, 0, 4/5, 0, 1, 0, -4/5, 0, 3/5];
}

lie_poisson! {
    pub system TurnedByHamiltonian;
    algebra {
        basis e1, e2, e3;
        [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2;
        matrix e1 = [[0, 0, 0], [0, 0, -1], [0, 1, 0]];
        matrix e2 = [[0, 0, 1], [0, 0, 0], [-1, 0, 0]];
        matrix e3 = [[0, -1, 0], [1, 0, 0], [0, 0, 0]];
    }
    group R;
    state x, y, z;
    parameters { c = 1.25; b = 2/5; }
    hamiltonian = c^2*sqrt(1 + ((x - b*R13)^2 + y^2/2 + 2*z^2)/c^2) + (1 + cos(t)/5)*R33;
    initial = [9/10, -3/2, 2, 3/5, 0, 4/5, 0, 1, 0, -4/5, 0, 3/5];
}

type State = SVector<f64, 15>;

/// A state on the group, with a time and a momentum of the time that are not 0.
fn somewhere(k: u32) -> State {
    let body = TurnedByHamiltonian::<f64>::new();
    let system = body.system().expect("finite");
    let mut mu = body.initial_state();
    mu[3] = 0.7;
    let mut stepper = Rk4.stepper(&system, 0.05, &NewtonOptions::default());
    for _ in 0..20 * k {
        stepper.step(&mut mu, &mut ()).expect("a step");
    }
    mu
}

#[test]
fn the_transform_by_iteration_is_the_closed_one() {
    let lagrangian = TurnedByLagrangian::new().system().expect("finite");
    let hamiltonian = TurnedByHamiltonian::new().system().expect("finite");
    for k in 0..5 {
        let mu = somewhere(k);
        let (a, b) = (lagrangian.hamiltonian(&mu), hamiltonian.hamiltonian(&mu));
        assert!((a - b).abs() < 4e-15 * b.abs(), "{k}: {a} {b}");
        let (a, b) = (lagrangian.energy(&mu), hamiltonian.energy(&mu));
        assert!((a - b).abs() < 4e-15 * b.abs(), "{k}: {a} {b}");
        assert!(
            (a - hamiltonian.hamiltonian(&mu)).abs() > 1e-3,
            "the momentum of the time is apart"
        );
        let (mut a, mut b) = (mu, mu);
        lagrangian.gradient(&mu, &mut a);
        hamiltonian.gradient(&mu, &mut b);
        assert!((a - b).amax() < 4e-15 * b.amax(), "{k}: {a} {b}");
        let (mut a, mut b) = (lagrangian.zero_jacobian(), hamiltonian.zero_jacobian());
        lagrangian.hessian(&mu, &mut a);
        hamiltonian.hessian(&mu, &mut b);
        assert!((a - b).amax() < 1e-13 * b.amax(), "{k}: {a} {b}");
        assert!(
            b.fixed_view::<3, 12>(0, 3).amax() > 1e-2,
            "mixed derivatives are there"
        );
        lagrangian.jacobian(&mu, &mut a);
        hamiltonian.jacobian(&mu, &mut b);
        assert!((a - b).amax() < 1e-13 * b.amax(), "{k}: {a} {b}");
    }
}

/// So many steps to the time 2 from the initial state.
fn end<P: Poisson<f64, State = State>>(
    system: &P,
    method: &impl Method<f64, P>,
    steps: u32,
) -> State {
    let mut mu = TurnedByLagrangian::<f64>::new().initial_state();
    let mut stepper = method.stepper(system, 2.0 / f64::from(steps), &NewtonOptions::default());
    for _ in 0..steps {
        stepper.step(&mut mu, &mut ()).expect("a step");
    }
    mu
}

/// The time and its momentum are given, and how large they are says nothing of how near the velocity is.
#[test]
fn late_times_leave_the_velocity_all_its_digits() {
    let lagrangian = TurnedByLagrangian::new().system().expect("finite");
    let hamiltonian = TurnedByHamiltonian::new().system().expect("finite");
    for (time, momentum) in [(1e3, 0.7), (1e6, -2.0), (1.7e9, 0.0), (3.0, 1e9)] {
        let mut mu = somewhere(2);
        (mu[3], mu[13]) = (momentum, time);
        let (mut a, mut b) = (mu, mu);
        lagrangian.gradient(&mu, &mut a);
        hamiltonian.gradient(&mu, &mut b);
        assert!(
            (a - b).amax() < 4e-15 * b.amax(),
            "{time:e} {momentum:e}: {a} {b}"
        );
    }
}

#[test]
fn methods_make_the_steps_of_the_closed_hamiltonian() {
    let lagrangian = TurnedByLagrangian::new().system().expect("finite");
    let hamiltonian = TurnedByHamiltonian::new().system().expect("finite");
    macro_rules! same {
        ($method:expr) => {{
            let difference =
                (end(&lagrangian, &$method, 5) - end(&hamiltonian, &$method, 5)).amax();
            assert!(
                difference < 2e-14,
                "{}: {difference:e}",
                stringify!($method)
            );
        }};
    }
    same!(LieMidpoint::exp());
    same!(EulerArnold2);
    same!(Gauss4);
    same!(Rkmk4);
    same!(Gonzalez);
    let (here, there) = (
        end(&lagrangian, &Gauss4, 5),
        end(&hamiltonian, &LieMidpoint::exp(), 5),
    );
    assert!(
        (here - there).amax() > 1e-4,
        "another method is another one"
    );
}

#[test]
fn variational_methods_have_their_order() {
    let system = TurnedByLagrangian::new().system().expect("finite");
    let closed = TurnedByHamiltonian::new().system().expect("finite");
    let exact = end(&closed, &Gauss6, 400);
    let group = |end: State| (end - exact).fixed_rows::<12>(0).amax();
    macro_rules! slope {
        ($method:expr, $steps:expr, $order:expr) => {{
            let (coarse, fine) = (
                group(end(&system, &$method, $steps)),
                group(end(&system, &$method, 2 * $steps)),
            );
            let slope = (coarse / fine).log2();
            println!(
                "{}: {coarse:.1e} {fine:.1e} slope {slope:.2}",
                stringify!($method)
            );
            assert!(
                (slope - $order).abs() < 0.2,
                "{}: {slope}",
                stringify!($method)
            );
        }};
    }
    slope!(Variational2::exp(), 20, 2.0);
    slope!(Variational4::exp(), 10, 4.0);
    slope!(Variational6::exp(), 6, 6.0);
    slope!(Variational2::cayley(), 20, 2.0);
    slope!(Variational4::cayley(), 10, 4.0);
    slope!(Variational6::cayley(), 6, 6.0);
}
