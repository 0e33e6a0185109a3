//! Splittings of systems with friction and noise: exact flows of what acts, orders, what is kept, and what is not.

use lie_runtime::Dual;
use lie_runtime::diagnostics::order_of_convergence;
use lie_runtime::methods::{Facts, Gauss16, Stepper};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::poisson::{Lift, Poisson};
use lie_runtime::prelude::*;

lie_poisson! {
    /// A body whose every component decays alike, with an energy that is not quadratic.
    system Decaying;
    algebra = so(3);
    state x, y, z;
    parameters { k = 1/5; }
    hamiltonian = x^2/2 + y^2/4 + z^2/6 + x^4/12 + z^3/9;
    forces { x = -k*x; y = -k*y; z = -k*z; }
    casimir C = x^2 + y^2 + z^2;
}

lie_poisson! {
    /// A body with another drag about each axis, one of which is pushed; the drag about z grows with the time.
    system Dragged;
    algebra = so(3);
    state x, y, z;
    inputs { u = 1/3; }
    hamiltonian = x^2/2 + y^2/4 + z^2/6 + x^4/12 + y/5;
    forces { x = cos(t) - x/5; y = u; z = 1/7 - z*(2 + sin(t))/4; }
}

lie_poisson! {
    /// The energy is a Casimir: nothing moves but what decays.
    system Resting;
    algebra = so(3);
    state x, y, z;
    hamiltonian = (x^2 + y^2 + z^2)/2;
    dissipation { rayleigh(matrix = [[1/5, 0, 0], [0, 1/5, 0], [0, 0, 1/5]]); }
}

lie_poisson! {
    /// A body whose drag about an axis depends on the momenta about the others, by a factor that changes with the time.
    system Coupled;
    algebra = so(3);
    state x, y, z;
    inputs { u = 1/3; }
    hamiltonian = x^2/2 + y^2/4 + z^2/6 + x^4/12 + y/5;
    forces { x = cos(t) - x/5 + y/7; y = u - x*sin(t)/4 - y/3; z = 1/7 - z/6 + x/9; }
}

lie_poisson! {
    /// The energy is a Casimir, and friction mixes two of three coordinates: its rates are 3/5 along x + y, 1/5 along x - y.
    system Mixed;
    algebra = so(3);
    state x, y, z;
    hamiltonian = (x^2 + y^2 + z^2)/2;
    dissipation { rayleigh(matrix = [[2/5, 1/5, 0], [1/5, 2/5, 0], [0, 0, 1/5]]); }
}

const START: [f64; 3] = [0.8, 0.3, -0.5];

/// The state with the coordinates that carry the time, and what is held.
fn with_time<const N: usize>(held: &[f64]) -> [f64; N] {
    let all = [&START[..], &[0.0, 0.0, 1.0], held].concat();
    all.try_into().expect("a state")
}

fn end<P, M>(system: P, start: P::State, method: M, count: u32, until: f64) -> P::State
where
    P: Poisson<f64>,
    M: Method<f64, P>,
{
    let problem = Problem::new(system, start, (0.0, until));
    let options = Options::new(until / f64::from(count)).save(Save::Ends);
    let run = solve(&problem, method, &options).ok();
    run.and_then(|mut run| run.mu.pop()).expect("a run")
}

/// The slope of the error of momenta and work.
fn slope<P, M>(system: P, method: M, counts: &[u32]) -> f64
where
    P: Poisson<f64> + Clone,
    P::State: From<[f64; 7]>,
    M: Method<f64, P> + Copy,
    Gauss16: Method<f64, P>,
{
    let start = || with_time::<7>(&[1.0 / 3.0]).into();
    let run = |count| end(system.clone(), start(), method, count, 2.0);
    let exact = end(system.clone(), start(), Gauss16, 40, 2.0);
    let points: Vec<(f64, f64)> = counts
        .iter()
        .map(|&count| {
            let pairs = run(count);
            let pairs = pairs.as_slice().iter().zip(exact.as_slice()).take(4);
            let error = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            (2.0 / f64::from(count), error)
        })
        .collect();
    order_of_convergence(&points, 1e-13)
        .expect("errors above round-off")
        .slope
}

fn check<M>(method: M, counts: &[u32])
where
    M: Method<f64, DraggedSystem<f64>> + Method<f64, CoupledSystem<f64>> + Facts + Copy,
{
    const { assert!(M::FORCES) };
    let dragged = Dragged::new().system().expect("a system");
    let coupled = Coupled::new().system().expect("a system");
    for found in [
        slope(dragged, method, counts),
        slope(coupled, method, counts),
    ] {
        println!("{}: {found:.3}", M::ID);
        let above = found - f64::from(M::ORDER);
        assert!((-0.2..0.3).contains(&above), "{} has {found}", M::ID);
    }
}

/// Linear drag, about each axis alone and mixed, pushes of the time and inputs are pieces like others: every splitting has its order, in the work too.
#[test]
fn splittings_with_friction_have_their_order() {
    check(Splitting1::new(), &[64, 96, 128, 192]);
    check(Splitting2::new(), &[16, 24, 32, 48]);
    check(Splitting2::new().coordinate(), &[16, 24, 32, 48]);
    check(Splitting4::new(), &[8, 12, 16, 24]);
    check(Splitting4::new().scheme(Scheme::Suzuki), &[8, 12, 16, 24]);
    check(Splitting6::new(), &[8, 10, 12, 16]);
    check(Compose4::new(Splitting2::new()), &[8, 12, 16, 24]);
    check(Compose6::new(Splitting2::new()), &[8, 10, 12, 16]);
}

/// The map of momenta of one step, by dual numbers, with its derivative.
fn tangent<M>(method: M, h: f64) -> ([f64; 3], [[f64; 3]; 3])
where
    M: Method<Dual<f64>, <DecayingSystem<f64> as Lift<f64>>::Lifted>,
{
    let system = Decaying::new().system().expect("a system").lift();
    let mut columns = [[0.0; 3]; 3];
    let mut image = START;
    for column in 0..3 {
        let mut mu = with_time::<6>(&[]).map(Dual::constant_of);
        mu[column].derivative = 1.0;
        let mut mu = <DecayingSystem<Dual<f64>> as Poisson<Dual<f64>>>::State::from(mu);
        let mut stepper = method.stepper(&system, Dual::constant_of(h), &NewtonOptions::default());
        assert!(stepper.step(&mut mu, &mut ()).is_ok());
        for row in 0..3 {
            columns[column][row] = mu[row].derivative;
            image[row] = mu[row].value;
        }
    }
    (image, columns)
}

/// `D Phi Pi(mu) D Phi^T - factor Pi(Phi(mu))`
fn conformal_defect((image, columns): ([f64; 3], [[f64; 3]; 3]), factor: f64) -> f64 {
    let pi = |m: [f64; 3]| [[0.0, -m[2], m[1]], [m[2], 0.0, -m[0]], [-m[1], m[0], 0.0]];
    let (before, after) = (pi(START), pi(image));
    let mut worst = 0.0_f64;
    for i in 0..3 {
        for j in 0..3 {
            let mut sum = 0.0;
            for a in 0..3 {
                for b in 0..3 {
                    sum += columns[a][i] * before[a][b] * columns[b][j];
                }
            }
            worst = worst.max((sum - factor * after[i][j]).abs());
        }
    }
    worst
}

/// `D Phi Pi D Phi^T = e^(-k h) Pi o Phi` to round-off, whatever the sizes of the substeps, negative ones too; Gauss methods have it to their
/// order.
#[test]
fn friction_alike_is_conformally_poisson() {
    let (h, k) = (0.3, 0.2_f64);
    let factor = (-k * h).exp();
    for tangent in [
        tangent(Splitting2::new(), h),
        tangent(Splitting4::new(), h),
        tangent(Splitting6::new().scheme(Scheme::KahanLi), h),
        tangent(Compose4::new(Splitting2::new()), h),
        tangent(Compose6::new(Splitting2::new()), h),
    ] {
        let defect = conformal_defect(tangent, factor);
        assert!(defect < 4e-15, "{defect:e}");
        let control = conformal_defect(tangent, 1.0);
        assert!(control > 1e-2, "a Poisson map it is not: {control:e}");
    }
    let control = conformal_defect(tangent(Gauss4, h), factor);
    assert!(control > 1e-8, "the control: {control:e}");
}

/// A Casimir of degree two decays as `e^(-2 k t)`, to round-off over 10,000 steps of a size at which nothing else is right.
#[test]
fn casimirs_decay_exactly() {
    let start = START.iter().map(|x| x * x).sum::<f64>();
    let relative = |mu: &[f64], until: f64| {
        let square = mu[..3].iter().map(|x| x * x).sum::<f64>();
        (square / (start * (-0.4 * until).exp()) - 1.0).abs()
    };
    let run = |method: Splitting4, count, until| {
        let system = Decaying::new().system().expect("a system");
        relative(
            end(system, with_time::<6>(&[]).into(), method, count, until).as_slice(),
            until,
        )
    };
    let short = run(Splitting4::new(), 30, 15.0);
    assert!(short < 2e-14, "{short:e}");
    let long = run(Splitting4::new(), 10_000, 1000.0);
    assert!(long < 1e-12, "{long:e}");
    let system = Decaying::new().system().expect("a system");
    let control = end(system, with_time::<6>(&[]).into(), Gauss4, 30, 15.0);
    assert!(relative(control.as_slice(), 15.0) > 1e-6, "the control");
}

/// What friction takes from H is work, to round-off.
#[test]
fn work_is_what_friction_takes() {
    let system = Resting::new().system().expect("a system");
    let mu = end(
        system,
        with_time::<6>(&[]).into(),
        Splitting2::new(),
        10,
        5.0,
    );
    let system = Resting::new().system().expect("a system");
    let (first, last) = (with_time::<6>(&[]).into(), mu);
    let expected = system.energy(&first) * (-2.0_f64).exp();
    assert!((system.energy(&last) - expected).abs() < 1e-15);
    let balance = system.hamiltonian(&last) - system.hamiltonian(&first);
    assert!(balance.abs() < 1e-15, "{balance:e}");
    assert!(last[3] > 0.3, "something was taken: {}", last[3]);
}

/// Friction that mixes coordinates takes each of its directions at its own rate, whatever the time: by one part of the series, or by 64.
#[test]
fn mixed_friction_is_exact() {
    let [x, y, z] = START;
    for (until, bound) in [(0.3, 4e-16), (5.0, 1e-15), (-4.0, 4e-15), (60.0, 1e-15)] {
        let system = Mixed::new().system().expect("a system");
        assert!(Poisson::<f64>::force_mixes(&system), "the control");
        let mut mu = with_time::<6>(&[]).into();
        let newton = NewtonOptions::default();
        let method = Splitting1::new();
        let mut stepper = Method::<f64, _>::stepper(&method, &system, until, &newton);
        assert!(stepper.step(&mut mu, &mut ()).is_ok());
        let [fast, slow] = [0.6_f64, 0.2].map(|rate| (-rate * until).exp());
        let (sum, difference) = ((x + y) * fast / 2.0, (x - y) * slow / 2.0);
        let exact = [sum + difference, sum - difference, z * slow];
        // what is left of a state that has decayed has the round-off of the start
        let size = exact.iter().fold(START[0], |most, x| most.max(x.abs()));
        for (found, exact) in mu.iter().zip(exact) {
            let error = (found - exact).abs();
            assert!(error < bound * size, "{until}: {found} for {exact}");
        }
        let work = system.hamiltonian(&mu) - system.hamiltonian(&with_time::<6>(&[]).into());
        let scale = size.max(1.0);
        assert!(
            work.abs() < 10.0 * bound * scale * scale,
            "{until}: {work:e}"
        );
    }
}

/// Its tangent is exact too where the state itself moves along one direction alone, so that its series ends early.
#[test]
fn tangents_of_mixed_friction_are_exact() {
    let system = Mixed::new().system().expect("a system").lift();
    for start in [[0.5, -0.5, 0.3], [0.0, 0.0, 0.0]] {
        let mut mu = [start[0], start[1], start[2], 0.0, 0.0, 1.0].map(Dual::constant_of);
        mu[0].derivative = 1.0;
        mu[1].derivative = 1.0;
        let mut mu = <MixedSystem<Dual<f64>> as Poisson<Dual<f64>>>::State::from(mu);
        let h = Dual::constant_of(1.5);
        let method = Splitting1::new();
        let mut stepper =
            Method::<Dual<f64>, _>::stepper(&method, &system, h, &NewtonOptions::default());
        assert!(stepper.step(&mut mu, &mut ()).is_ok());
        let fast = (-0.9_f64).exp();
        for (found, expected) in mu.iter().zip([fast, fast, 0.0]) {
            let error = (found.derivative - expected).abs();
            assert!(error < 1e-15, "{start:?}: {found:?} for {expected}");
        }
    }
}

/// A time that is too long for the parts of the series ends the step, and the state is as it was.
#[test]
fn too_long_a_time_of_mixed_friction_is_refused() {
    let system = Mixed::new().system().expect("a system");
    let start = with_time::<6>(&[]);
    let mut mu = start.into();
    let newton = NewtonOptions::default();
    let mut stepper = Method::<f64, _>::stepper(&Splitting1::new(), &system, 1e5, &newton);
    assert!(stepper.step(&mut mu, &mut ()).is_err());
    assert_eq!(mu.as_slice(), start);
}

/// A step of -h undoes a step of h, friction included: its flow exists for negative times.
#[test]
fn steps_backwards_undo_steps() {
    undo(&Dragged::new().system().expect("a system"));
    undo(&Coupled::new().system().expect("a system"));
}

fn undo<P>(system: &P)
where
    P: Poisson<f64>,
    P::State: From<[f64; 7]>,
    Splitting4: Method<f64, P>,
{
    let start = with_time::<7>(&[1.0 / 3.0]);
    let mut mu = P::State::from(start);
    let newton = NewtonOptions::default();
    for h in [0.3, -0.3] {
        let method = Splitting4::new();
        let mut stepper = Method::<f64, _>::stepper(&method, system, h, &newton);
        assert!(stepper.step(&mut mu, &mut ()).is_ok());
        if h > 0.0 {
            assert!((mu.as_slice()[0] - start[0]).abs() > 0.05, "the control");
        }
    }
    for (found, expected) in mu.as_slice().iter().zip(start) {
        assert!((found - expected).abs() < 4e-15, "{found} and {expected}");
    }
}
