//! Metriplectic systems, `mu' = Pi grad H + K grad S`: steps along discrete gradients keep H and have S grow.

use lie_runtime::Poisson;
use lie_runtime::methods::Facts;
use lie_runtime::prelude::*;

lie_poisson! {
    /// The relaxing rigid body of Morrison: the entropy is the Casimir, the metric projects along grad H.
    system Relaxing;
    algebra = so(3);
    state x, y, z;
    hamiltonian = x^2/2 + y^2/4 + z^2/6;
    dissipation {
        metriplectic(entropy = (x^2 + y^2 + z^2)/8, metric = [
            [y^2/4 + z^2/9, -x*y/2, -x*z/3],
            [-x*y/2, x^2 + z^2/9, -y*z/6],
            [-x*z/3, -y*z/6, x^2 + y^2/4],
        ]);
    }
    casimir C = x^2 + y^2 + z^2;
    methods = [gonzalez, mean-value, itoh-abe, gauss16, rk4];
}

lie_poisson! {
    /// A cubic energy, an entropy of degree 4, and a metric of one direction that grows.
    system Bent;
    algebra = so(3);
    state x, y, z;
    hamiltonian = x^2/2 + y^2/4 + z^2/6 + x*y*z/10;
    dissipation {
        metriplectic(entropy = (x^2 + y^2 + z^2)^2/4, factor = [
            [(1 + z^2)*(y/2 + x*z/10)],
            [-(1 + z^2)*(x + y*z/10)],
            [0],
        ]);
    }
    casimir C = x^2 + y^2 + z^2;
    methods = [gonzalez, mean-value, gauss16, rk4];
}

lie_poisson! {
    /// A symmetric top whose entropy is no Casimir, but constant along the motion.
    system Top;
    algebra = so(3);
    state x, y, z;
    hamiltonian = (x^2 + y^2)/4 + z^2/2;
    dissipation {
        metriplectic(entropy = x^2 + y^2 + z^2 + z^4/2, factor = [
            [z, 0],
            [0, z],
            [-x/2, -y/2],
        ]);
    }
    methods = [gonzalez, gauss16, rk4];
}

const START: [f64; 6] = [0.8, 0.3, -0.5, 0.0, 0.0, 1.0];

/// Steps of a size with H, S and the state after each.
fn course<P, M>(system: &P, method: &M, h: f64, count: usize) -> Vec<(f64, f64, P::State)>
where
    P: Poisson<f64>,
    P::State: From<[f64; 6]>,
    M: Method<f64, P>,
{
    let mut mu = P::State::from(START);
    let mut stepper = method.stepper(system, h, &NewtonOptions::default());
    let mut course = Vec::new();
    let note = |mu: &P::State| (system.energy(mu), system.entropy(mu), mu.clone());
    course.push(note(&mu));
    for _ in 0..count {
        stepper.step(&mut mu, &mut ()).expect("the step converges");
        course.push(note(&mu));
    }
    course
}

/// The largest change of H, the least growth of S in a step, and how much S grows in all.
fn balance<P, M>(system: &P, method: &M, h: f64, count: usize) -> [f64; 3]
where
    P: Poisson<f64>,
    P::State: From<[f64; 6]>,
    M: Method<f64, P>,
{
    let course = course(system, method, h, count);
    let (energy, entropy, _) = &course[0];
    let drift = course.iter().map(|(h, ..)| (h - energy).abs());
    let growth = course.windows(2).map(|pair| pair[1].1 - pair[0].1);
    [
        drift.fold(0.0, f64::max),
        growth.fold(f64::INFINITY, f64::min),
        course.last().expect("rows").1 - entropy,
    ]
}

fn is_kept<P, M>(system: &P, method: &M, growth: f64)
where
    P: Poisson<f64>,
    P::State: From<[f64; 6]>,
    M: Method<f64, P> + Facts,
{
    assert!(system.is_metriplectic());
    for (h, count) in [(0.1, 600), (0.5, 200)] {
        let [drift, least, all] = balance(system, method, h, count);
        assert!(
            drift < 3e-14,
            "{} {} {h}: H {drift:e}",
            system.name(),
            M::ID
        );
        assert!(least > -2e-15, "{} {h}: S {least:e}", M::ID);
        assert!(all > growth, "{} {h}: S grows by {all:e}", M::ID);
    }
}

#[test]
fn the_energy_is_constant_and_the_entropy_never_falls() {
    let relaxing = Relaxing::new().system().expect("a system");
    is_kept(&relaxing, &Gonzalez, 0.03);
    is_kept(&relaxing, &MeanValue, 0.03);
    is_kept(&relaxing, &ItohAbe, 0.03);
    let bent = Bent::new().system().expect("a system");
    is_kept(&bent, &Gonzalez, 0.05);
    is_kept(&bent, &MeanValue, 0.05);
    let top = Top::new().system().expect("a system");
    is_kept(&top, &Gonzalez, 0.05);
    // the control
    let [drift, ..] = balance(&relaxing, &Rk4, 0.5, 200);
    assert!(drift > 1e-6, "{drift:e}");
    let [drift, ..] = balance(&bent, &Rk4, 0.5, 200);
    assert!(drift > 1e-6, "{drift:e}");
}

/// The body ends at rest relative to its axis of least energy for the momentum: grad S along grad H, to round-off.
#[test]
fn it_relaxes_to_an_equilibrium_and_stays_there() {
    let relaxing = Relaxing::new().system().expect("a system");
    let course = course(&relaxing, &Gonzalez, 0.5, 20_000);
    let (energy, _, end) = course.last().expect("rows");
    let [x, y, z] = [end[0], end[1], end[2]];
    assert!(x.abs() < 1e-12 && y.abs() < 1e-12, "{end:?}");
    // H = z^2/6, the largest |mu| that the energy allows
    assert!((z * z / 6.0 - energy).abs() < 1e-14, "{z} {energy}");
    assert!((energy - course[0].0).abs() < 1e-13, "{energy}");
}

fn order<P, M>(system: &P, method: &M, reference: impl Method<f64, P>) -> f64
where
    P: Poisson<f64>,
    P::State: From<[f64; 6]>,
    M: Method<f64, P>,
{
    let exact = course(system, &reference, 0.05, 40);
    let error = |count: u32| {
        let all = course(system, method, 2.0 / f64::from(count), count as usize);
        let (end, exact) = (&all.last().expect("rows").2, &exact.last().expect("rows").2);
        let pairs = end.as_slice().iter().zip(exact.as_slice()).take(4);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    (error(40) / error(80)).log2()
}

#[test]
fn they_are_of_order_two() {
    let relaxing = Relaxing::new().system().expect("a system");
    let bent = Bent::new().system().expect("a system");
    let top = Top::new().system().expect("a system");
    for found in [
        order(&relaxing, &Gonzalez, Gauss16),
        order(&relaxing, &MeanValue, Gauss16),
        order(&relaxing, &ItohAbe, Gauss16),
        order(&bent, &Gonzalez, Gauss16),
        order(&bent, &MeanValue, Gauss16),
        order(&top, &Gonzalez, Gauss16),
    ] {
        assert!((1.9..2.1).contains(&found), "{found}");
    }
}
