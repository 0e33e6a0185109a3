//! Splittings of noise: weak orders against the generator of the process, orbits, temperatures.

use std::collections::BTreeMap;

use lie_runtime::diagnostics::order_of_convergence;
use lie_runtime::methods::{FactorSink, Retraction, Stepper};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use lie_runtime::{LiePoisson, Poisson, State};

lie_poisson! {
    /// A body with noise along one direction.
    system OneNoise;
    algebra = so(3);
    state x, y, z;
    hamiltonian = x^2/2 + y^2/4 + z^2/6 + x^3/9 + y/5;
    noise { hamiltonian = (x + 2*y - z)/3; }
    casimir C = x^2 + y^2 + z^2;
}

lie_poisson! {
    /// The same body with noise along two directions that do not commute.
    system TwoNoises;
    algebra = so(3);
    state x, y, z;
    hamiltonian = x^2/2 + y^2/4 + z^2/6 + x^3/9 + y/5;
    noise { hamiltonian = 2*x/5 + y/5; hamiltonian = z/2 - x/3; }
    casimir C = x^2 + y^2 + z^2;
}

lie_poisson! {
    /// A body in a bath: friction, and the noise that belongs to it.
    system Bath;
    algebra = so(3);
    state x, y, z;
    parameters { T = 1/2; }
    hamiltonian = x^2/2 + y^2/4 + z^2/6;
    dissipation { rayleigh(matrix = [[1/5, 0, 0], [0, 2/5, 0], [0, 0, 3/5]], temperature = T); }
}

lie_poisson! {
    /// A spin in a field at a temperature.
    system Spin;
    algebra = so(3);
    state x, y, z;
    parameters { T = 1/2; }
    hamiltonian = z;
    dissipation { double-bracket(strength = 1, temperature = T); }
    casimir C = x^2 + y^2 + z^2;
}

const START: [f64; 3] = [0.6, -0.5, 0.7];

/// A polynomial in three variables: coefficients by exponents.
type Polynomial = BTreeMap<[u32; 3], f64>;

fn plus(mut one: Polynomial, other: Polynomial, factor: f64) -> Polynomial {
    for (powers, value) in other {
        *one.entry(powers).or_default() += factor * value;
    }
    one
}

fn times(one: &Polynomial, other: &Polynomial) -> Polynomial {
    let mut product = Polynomial::new();
    for (a, x) in one {
        for (b, y) in other {
            *product
                .entry([a[0] + b[0], a[1] + b[1], a[2] + b[2]])
                .or_default() += x * y;
        }
    }
    product
}

fn derivative(f: &Polynomial, k: usize) -> Polynomial {
    let terms = f.iter().filter(|(powers, _)| powers[k] > 0);
    let lowered = terms.map(|(powers, value)| {
        let mut less = *powers;
        less[k] -= 1;
        (less, value * f64::from(powers[k]))
    });
    lowered.collect()
}

fn value(f: &Polynomial, at: &[f64]) -> f64 {
    let term = |powers: &[u32; 3]| {
        (0..3)
            .map(|k| at[k].powi(powers[k] as i32))
            .product::<f64>()
    };
    f.iter().map(|(powers, value)| value * term(powers)).sum()
}

fn monomial(value: f64, powers: [u32; 3]) -> Polynomial {
    [(powers, value)].into()
}

/// `mu x grad H`
fn field(h: &Polynomial) -> [Polynomial; 3] {
    [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let x = |i: usize| {
            let mut powers = [0; 3];
            powers[i] = 1;
            monomial(1.0, powers)
        };
        let first = times(&x(j), &derivative(h, k));
        plus(first, times(&x(k), &derivative(h, j)), -1.0)
    })
}

/// What a field makes of a function.
fn along(f: &Polynomial, field: &[Polynomial; 3]) -> Polynomial {
    let parts = (0..3).map(|k| times(&derivative(f, k), &field[k]));
    parts.fold(Polynomial::new(), |sum, part| plus(sum, part, 1.0))
}

/// The equation of Stratonovich: the field of the motion, and those of the noises.
struct Equation {
    motion: [Polynomial; 3],
    noises: Vec<[Polynomial; 3]>,
}

impl Equation {
    /// The mean of a function behind a time h: `exp(h L) f` with `L f = f' . motion + sum_k (f' . g_k)' . g_k/2`.
    fn mean(&self, f: &Polynomial, h: f64) -> f64 {
        let (mut term, mut sum, mut weight) = (f.clone(), value(f, &START), 1.0);
        for order in 1..=7 {
            let mut next = along(&term, &self.motion);
            for noise in &self.noises {
                next = plus(next, along(&along(&term, noise), noise), 0.5);
            }
            term = next;
            weight *= h / f64::from(order);
            sum += weight * value(&term, &START);
        }
        sum
    }
}

/// The energy of the body but for the cubic term and the linear one.
fn squares() -> Polynomial {
    [([2, 0, 0], 0.5), ([0, 2, 0], 0.25), ([0, 0, 2], 1.0 / 6.0)].into()
}

fn body() -> [Polynomial; 3] {
    let more = [([3, 0, 0], 1.0 / 9.0), ([0, 1, 0], 0.2)].into();
    field(&plus(squares(), more, 1.0))
}

fn linear([x, y, z]: [f64; 3]) -> Polynomial {
    [([1, 0, 0], x), ([0, 1, 0], y), ([0, 0, 1], z)].into()
}

/// The function whose mean is looked at.
fn observed() -> Polynomial {
    [([1, 1, 0], 1.0), ([0, 0, 2], 0.5), ([3, 0, 0], 1.0 / 3.0)].into()
}

/// Nodes and weights of the normal distribution, by Hermite's polynomials.
fn hermite<const N: usize>() -> [(f64, f64); N] {
    let values = |z: f64| {
        let (mut before, mut now) = (0.0, 1.0);
        for k in 0..N {
            (before, now) = (now, z * now - k as f64 * before);
        }
        (before, now)
    };
    let mut found = [(0.0, 0.0); N];
    let mut count = 0;
    let grid = |k: i32| -10.0 + f64::from(k) * 0.0101;
    for k in 0..2000 {
        let (mut low, mut high) = (grid(k), grid(k + 1));
        let sign = values(low).1;
        if sign * values(high).1 > 0.0 {
            continue;
        }
        for _ in 0..80 {
            let middle = (low + high) / 2.0;
            match values(middle).1 * sign > 0.0 {
                true => low = middle,
                false => high = middle,
            }
        }
        let below = values(low).0;
        let factorial: f64 = (1..N).map(|k| k as f64).product();
        found[count] = (low, factorial / (N as f64 * below * below));
        count += 1;
    }
    assert_eq!(count, N);
    assert!((found.iter().map(|(_, weight)| weight).sum::<f64>() - 1.0).abs() < 1e-13);
    found
}

/// The mean of the function behind one step, by quadrature over the increments; with two and more noises over the coin, or with it held.
fn mean_of_step<P, M>(system: &P, method: &M, h: f64, coins: &[f64]) -> f64
where
    P: Poisson<f64>,
    M: Method<f64, P>,
{
    let all = system.noise_count();
    let processes = all - usize::from(system.tosses_coin());
    let nodes = hermite::<9>();
    let f = observed();
    let mut stepper = method.stepper(system, h, &NewtonOptions::default());
    let mut sum = 0.0;
    for &coin in coins {
        for index in 0..nodes.len().pow(processes as u32) {
            let mut mu = system.zero_state();
            let mut weight = 1.0 / coins.len() as f64;
            let first = mu.as_slice().len() - all;
            let entries = mu.as_mut_slice();
            entries[..3].copy_from_slice(&START);
            entries[first - 1] = 1.0;
            let mut digits = index;
            for process in 0..processes {
                let (z, part) = nodes[digits % nodes.len()];
                digits /= nodes.len();
                entries[first + process] = z / h.sqrt();
                weight *= part;
            }
            if all > processes {
                entries[all - 1 + first] = coin;
            }
            assert!(stepper.step(&mut mu, &mut ()).is_ok());
            sum += weight * value(&f, mu.as_slice());
        }
    }
    sum
}

/// The order of the mean of one step, less one: the weak order.
fn weak_order<P, M>(system: &P, equation: &Equation, method: M, coins: &[f64]) -> f64
where
    P: Poisson<f64>,
    M: Method<f64, P>,
{
    let points = [16.0, 24.0, 32.0, 48.0, 64.0].map(|count| {
        let h = 1.0 / count;
        let error = mean_of_step(system, &method, h, coins) - equation.mean(&observed(), h);
        (h, error.abs())
    });
    let slope = order_of_convergence(&points, 1e-14);
    slope.expect("errors above round-off").slope - 1.0
}

fn assert_order(what: &str, found: f64, expected: f64) {
    println!("{what}: {found:.3}");
    assert!((found - expected).abs() < 0.15, "{what}: {found}");
}

const BOTH: [f64; 2] = [1.0, -1.0];

#[test]
fn one_noise_has_weak_order_two() {
    let equation = Equation {
        motion: body(),
        noises: vec![field(&linear([1.0 / 3.0, 2.0 / 3.0, -1.0 / 3.0]))],
    };
    let system = OneNoise::new().system().expect("a system");
    let order = |method| weak_order(&system, &equation, method, &[1.0]);
    assert_order("strang", order(Splitting2::new()), 2.0);
    let found = weak_order(&system, &equation, NinomiyaVictoir, &[1.0]);
    assert_order("ninomiya-victoir", found, 2.0);
    // held over the step
    let control = weak_order(&system, &equation, LieMidpoint::exp(), &[1.0]);
    assert_order("lie-midpoint", control, 1.0);
    let control = weak_order(&system, &equation, Gauss6, &[1.0]);
    assert_order("gauss6", control, 1.0);
    let control = weak_order(&system, &equation, Splitting4::new(), &[1.0]);
    assert_order("splitting4", control, 1.0);
}

#[test]
fn two_noises_have_it_by_the_coin() {
    let noises = [[0.4, 0.2, 0.0], [-1.0 / 3.0, 0.0, 0.5]];
    let equation = Equation {
        motion: body(),
        noises: noises.map(|v| field(&linear(v))).to_vec(),
    };
    let system = TwoNoises::new().system().expect("a system");
    assert!(system.tosses_coin() && system.noise_count() == 3);
    let strang = |coins: &[f64]| weak_order(&system, &equation, Splitting2::new(), coins);
    assert_order("strang", strang(&BOTH), 2.0);
    let found = weak_order(&system, &equation, NinomiyaVictoir, &BOTH);
    assert_order("ninomiya-victoir", found, 2.0);
    assert_order("always in their order", strang(&[1.0]), 1.0);
    assert_order("always against it", strang(&[-1.0]), 1.0);
}

#[test]
fn friction_with_its_noise_has_weak_order_two() {
    let drag = [0.2, 0.2, 0.2];
    let mut motion = field(&squares());
    let rates = [0.2, 0.4, 0.6];
    let mut noises = Vec::new();
    for k in 0..3 {
        let mut powers = [0; 3];
        powers[k] = 1;
        let slope = squares()[&powers.map(|power| 2 * power)] * 2.0;
        assert!((rates[k] * slope - drag[k]).abs() < 1e-15);
        let part = monomial(-drag[k], powers);
        motion[k] = plus(motion[k].clone(), part, 1.0);
        let mut noise: [Polynomial; 3] = Default::default();
        noise[k] = monomial(f64::sqrt(2.0 * 0.5 * rates[k]), [0; 3]);
        noises.push(noise);
    }
    let equation = Equation { motion, noises };
    let system = Bath::new().system().expect("a system");
    let found = weak_order(&system, &equation, Splitting2::new(), &BOTH);
    assert_order("strang", found, 2.0);
    let found = weak_order(&system, &equation, NinomiyaVictoir, &BOTH);
    assert_order("ninomiya-victoir", found, 2.0);
    let control = weak_order(&system, &equation, Splitting1::new(), &BOTH);
    assert_order("lie, trotter", control, 1.0);
}

/// A run with the noise of the seed 1 from a state of the momenta.
fn run<P, M>(
    system: P,
    momenta: [f64; 3],
    method: M,
    (step, until): (f64, f64),
) -> Solution<f64, P::State>
where
    P: Poisson<f64>,
    M: Method<f64, P>,
{
    let mut start = system.zero_state();
    let first = start.as_slice().len() - system.noise_count();
    start.as_mut_slice()[..3].copy_from_slice(&momenta);
    start.as_mut_slice()[first - 1] = 1.0;
    let problem = Problem::new(system, start, (0.0, until));
    let run = solve(&problem, method, &Options::new(step));
    run.ok().expect("a run")
}

/// Each path stays on its orbit, over 20,000 steps.
#[test]
fn paths_stay_on_their_orbits() {
    let worst = |run: &Solution<f64, _>| {
        let first = run.casimirs[0][0];
        let casimirs = run
            .casimirs
            .iter()
            .map(|row: &Vec<f64>| (row[0] / first - 1.0).abs());
        casimirs.fold(0.0, f64::max)
    };
    let two = || TwoNoises::new().system().expect("a system");
    let span = (0.1, 2000.0);
    let found = worst(&run(two(), START, Splitting2::new(), span));
    assert!(found < 1e-12, "{found:e}");
    let found = worst(&run(two(), START, NinomiyaVictoir, span));
    assert!(found < 1e-12, "{found:e}");
    let control = worst(&run(two(), START, Rk4, (0.1, 500.0)));
    assert!(control > 1e-5, "the control: {control:e}");
}

/// The factors of a step, one after the other.
#[derive(Default)]
struct Factors(Vec<Vec<f64>>);

impl<V: State<f64>> FactorSink<V> for Factors {
    fn is_active(&self) -> bool {
        true
    }
    fn push(&mut self, retraction: Retraction, xi: &V) {
        assert_eq!(retraction, Retraction::Exp);
        self.0.push(xi.as_slice().to_vec());
    }
}

fn excited(system: &TwoNoisesSystem<f64>) -> <TwoNoisesSystem<f64> as Poisson<f64>>::State {
    let mut mu = system.zero_state();
    mu.as_mut_slice()[..3].copy_from_slice(&START);
    mu.as_mut_slice()[5..].copy_from_slice(&[1.0, 0.9, -1.3, -0.2]);
    mu
}

/// What is given to the group element makes the motion of mu, and a step of -h with the same noise undoes one of h.
#[test]
fn factors_make_the_step_and_steps_backwards_undo_it() {
    fn check<M: Method<f64, TwoNoisesSystem<f64>>>(method: M) {
        let system = TwoNoises::new().system().expect("a system");
        let start = excited(&system);
        let newton = NewtonOptions::default();
        let (mut mu, mut factors) = (start, Factors::default());
        let mut stepper = method.stepper(&system, 0.2, &newton);
        assert!(stepper.step(&mut mu, &mut factors).is_ok());
        let (mut moved, mut next) = (start, start);
        for factor in &factors.0 {
            let mut xi = start;
            xi.as_mut_slice().copy_from_slice(factor);
            system.coadjoint_action(&xi, &moved, &mut next);
            moved = next;
        }
        for k in 0..3 {
            assert!(
                (moved[k] - mu[k]).abs() < 4e-15,
                "{} and {}",
                moved[k],
                mu[k]
            );
        }
        let changes = (0..3).map(|k| (start[k] - mu[k]).abs());
        assert!(changes.fold(0.0, f64::max) > 0.05, "the control");
        let mut stepper = method.stepper(&system, -0.2, &newton);
        assert!(stepper.step(&mut mu, &mut ()).is_ok());
        for k in 0..start.len() {
            assert!(
                (mu[k] - start[k]).abs() < 4e-15,
                "{} and {}",
                mu[k],
                start[k]
            );
        }
    }
    check(Splitting2::new());
    check(Splitting4::new());
    check(NinomiyaVictoir);
    check(Compose4::new(NinomiyaVictoir));
}

/// The means of Boltzmann's distribution, along a path of 60,000 steps: Langevin's function of a spin, and equal parts of the energy for each axis of
/// a body.
#[test]
fn temperatures_are_those_that_were_asked_for() {
    let mean = |values: &mut dyn Iterator<Item = f64>| {
        let (mut sum, mut count) = (0.0, 0.0);
        values.for_each(|x| (sum, count) = (sum + x, count + 1.0));
        sum / count
    };
    let spin = Spin::new().system().expect("a system");
    let path = run(spin, [0.6, 0.0, 0.8], NinomiyaVictoir, (0.1, 6e3));
    let found = mean(&mut path.mu.iter().map(|mu| mu[2]));
    let expected = 0.5 - 1.0 / f64::tanh(2.0);
    println!("<z> = {found:.4}, {expected:.4} by Langevin");
    assert!((found - expected).abs() < 0.03, "{found} and {expected}");
    let bath = Bath::new().system().expect("a system");
    let path = run(bath, START, Splitting2::new(), (0.1, 6e3));
    for (k, weight) in [1.0, 0.5, 1.0 / 3.0].into_iter().enumerate() {
        let found = mean(&mut path.mu.iter().map(|mu| weight * mu[k] * mu[k]));
        println!("<mu_{k}^2/I> = {found:.4}, 0.5 by equipartition");
        assert!((found - 0.5).abs() < 0.08, "{k}: {found}");
    }
}
