//! Inputs and noise of systems declared by the macro: what is held over steps, from tables and controllers.

use std::sync::Arc;

use lie_runtime::Poisson;
use lie_runtime::prelude::*;

lie_poisson! {
    /// A body with a wheel that somebody turns.
    system Wheel;
    algebra = so(3);
    state x, y, z;
    inputs { u = 0, sampling = 1/10; w = 1; }
    hamiltonian = x^2/4 + w*y^2/3 + z^2/2;
    forces { x = u; }
    casimir C = x^2 + y^2 + z^2;
    methods = [gauss6, rk4];
}

lie_poisson! {
    /// A spin in a field that a bath keeps warm.
    system Spin;
    algebra = so(3);
    state x, y, z;
    parameters { T = 1/2; sigma = 1/5; }
    hamiltonian = z;
    dissipation { double-bracket(strength = 1, temperature = T); }
    noise { hamiltonian = sigma*x*y; }
    casimir C = x^2 + y^2 + z^2;
    methods = [lie-midpoint, gauss4, rk4];
}

lie_poisson! {
    /// A body that is kicked.
    system Kicked;
    algebra = so(3);
    state x, y, z;
    parameters { s = 1/2; }
    hamiltonian = x^2/4 + y^2/3 + z^2/2;
    noise { force(x = s, y = s/2); }
    casimir C = x^2 + y^2 + z^2;
    methods = [gauss4, rk4];
}

/// The coordinates, the momentum of the time, the time, the unit, and what is held.
fn state<const N: usize, const M: usize>(mu: [f64; N], held: [f64; M]) -> Vec<f64> {
    [&mu[..], &[0.0, 0.0, 1.0], &held[..]].concat()
}

fn wheel(until: f64) -> Problem<f64, WheelSystem<f64>> {
    let start: [f64; 8] = state([0.8, 0.1, 0.6], [0.0, 1.0])
        .try_into()
        .expect("a state");
    Problem::new(
        Wheel::new().system().expect("a system"),
        start,
        (0.0, until),
    )
}

fn held(problem: &Problem<f64, WheelSystem<f64>>) -> Held {
    Held::of(&problem.system, 0.0, (1, &[0])).expect("inputs")
}

#[test]
fn a_controller_sees_the_state_at_its_samplings() {
    let problem = wheel(5.0);
    let damper = Arc::new(|_: f64, mu: &[f64], _: &[f64]| -2.0 * mu[0]);
    let closed = held(&problem).with(0, Source::Controller(damper));
    let options = Options::new(0.05);
    let run = solve_observed(&problem, Gauss6, &options, closed).expect("a run");
    // the value at the end is sampled there too
    for (row, t) in run.mu.iter().zip(&run.t) {
        let sampled = (t / 0.1 + 1e-6).floor() as usize * 2;
        assert_eq!(row[6], -2.0 * run.mu[sampled][0], "t = {t}");
    }
    // the same values from a table are the same bits
    let samplings = (0..).step_by(2).take(51);
    let times = samplings.clone().map(|row| run.t[row]).collect();
    let values = samplings.map(|row| -2.0 * run.mu[row][0]).collect();
    let table = held(&problem).with(0, Source::Table { times, values });
    let again = solve_observed(&problem, Gauss6, &options, table).expect("a run");
    let apart =
        |(a, b): (&[f64; 8], &[f64; 8])| (0..8).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max);
    let pairs = run
        .mu
        .iter()
        .map(|mu| mu.as_ref())
        .zip(again.mu.iter().map(|mu| mu.as_ref()));
    let differences: Vec<f64> = pairs.map(apart).collect();
    assert!(differences.iter().all(|x| *x == 0.0), "{differences:?}");
    let free = solve(&problem, Gauss6, &options).expect("a run");
    let energy = |run: &Solution<f64, _>| run.energy[run.energy.len() - 1];
    assert!(energy(&run) < 0.9 * energy(&free), "the control");
}

/// A step is divided where a table jumps, so that no method loses its order there.
#[test]
fn jumps_of_a_table_cost_no_order() {
    let problem = wheel(4.0);
    let end = |step: f64| {
        let times: Arc<[f64]> = [0.0, 1.234_567, 2.5].into();
        let jumps = Source::Table {
            times: times.clone(),
            values: [0.3, -0.5, 0.1].into(),
        };
        let inertia = Source::Table {
            times,
            values: [1.0, 1.5, 0.8].into(),
        };
        let held = held(&problem).with(0, jumps).with(1, inertia);
        let run = solve_observed(&problem, Rk4, &Options::new(step), held).expect("a run");
        run.mu[run.mu.len() - 1]
    };
    let exact = end(1.0 / 1024.0);
    let error = |step: f64| {
        let end = end(step);
        (0..3)
            .map(|i| (end[i] - exact[i]).abs())
            .fold(0.0, f64::max)
    };
    let slope = (error(1.0 / 8.0) / error(1.0 / 32.0)).log2() / 2.0;
    assert!((slope - 4.0).abs() < 0.3, "{slope}");
}

/// `H + p` is constant although the input in H jumps: what it does is work.
#[test]
fn jumps_of_the_hamiltonian_are_work() {
    let problem = wheel(4.0);
    let inertia = Source::Table {
        times: [0.0, 1.25, 2.5].into(),
        values: [1.0, 1.5, 0.8].into(),
    };
    let held = held(&problem).with(1, inertia);
    let run = solve_observed(&problem, Gauss6, &Options::new(0.05), held).expect("a run");
    let system = &problem.system;
    let total = |mu| system.hamiltonian(mu);
    let start = total(&run.mu[0]);
    for mu in &run.mu {
        assert!((total(mu) - start).abs() < 1e-13, "{}", total(mu) - start);
    }
    let last = run.mu.len() - 1;
    assert!(
        (run.mu[last][3] - run.mu[0][3]).abs() > 1e-2,
        "the control: no work"
    );
}

fn spin() -> Problem<f64, SpinSystem<f64>> {
    let system = Spin::new().system().expect("a system");
    let held = vec![0.0; system.noise_count()];
    let start = [&[0.6, 0.0, 0.8, 0.0, 0.0, 1.0][..], &held].concat();
    let start: [f64; 11] = start.try_into().expect("a state");
    Problem::new(system, start, (0.0, 20.0))
}

#[test]
fn solve_has_the_noise_of_the_seed_1_and_stays_on_the_orbit() {
    let problem = spin();
    let options = Options::new(0.1);
    let run = solve(&problem, LieMidpoint::exp(), &options).expect("a run");
    let of_seed = |seed| {
        let held = Held::of(&problem.system, 0.0, (seed, &[0])).expect("noise");
        let held = held.bounded(true);
        solve_observed(&problem, LieMidpoint::exp(), &options, held).expect("a run")
    };
    assert_eq!(run.mu, of_seed(1).mu);
    assert_ne!(run.mu, of_seed(2).mu);
    let worst = |run: &Solution<f64, _>| {
        let casimirs = run.casimirs.iter().map(|row| (row[0] - 1.0_f64).abs());
        casimirs.fold(0.0, f64::max)
    };
    assert!(worst(&run) < 1e-13, "{}", worst(&run));
    let plain = solve(&problem, Rk4, &options).expect("a run");
    assert!(worst(&plain) > 1e-6, "the control: {}", worst(&plain));
}

/// The mean square of a path of one kick is `s^2 t`, the mean 0, over streams; without rotation for so short a time.
#[test]
fn kicks_have_the_variance_of_a_wiener_process() {
    let system = Kicked::new().system().expect("a system");
    let start = [0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let problem = Problem::new(system, start, (0.0, 1.0));
    let members = 4000;
    let (mut mean, mut square) = (0.0, 0.0);
    for stream in 0..members {
        let held = Held::of(&problem.system, 0.0, (1, &[stream])).expect("noise");
        let run = solve_observed(&problem, Rk4, &Options::new(0.25), held).expect("a run");
        let x = run.mu[run.mu.len() - 1][0];
        mean += x / members as f64;
        square += x * x / members as f64;
    }
    let error = 0.5 / (members as f64).sqrt();
    assert!(mean.abs() < 4.0 * error, "{mean}");
    assert!(
        (square - 0.25).abs() < 4.0 * 0.25 * (2.0 / members as f64).sqrt(),
        "{square}"
    );
}

/// Sets the rates of noise from a path that is known on a fine grid.
struct Path<'a> {
    /// Increments of each process, all of a fine step together.
    increments: &'a [f64],
    processes: usize,
    /// So many fine steps are one of the run.
    stride: usize,
    /// The place of the first rate.
    first: usize,
}

impl<P: Poisson<f64>> Observer<f64, P> for Path<'_> {
    fn hold(
        &mut self,
        _system: &P,
        (index, _, h): (u64, f64, f64),
        mu: &mut P::State,
        _element: &[f64],
    ) {
        let from = index as usize * self.stride * self.processes;
        let part = self
            .increments
            .get(from..from + self.stride * self.processes);
        for process in 0..self.processes {
            let steps = part
                .into_iter()
                .flat_map(|part| part.chunks(self.processes));
            let sum: f64 = steps.map(|increments| increments[process]).sum();
            mu.as_mut_slice()[self.first + process] = sum / h;
        }
    }
}

/// The root of the mean square of the distance from the run on a fine grid, over paths, for steps of so many fine steps.
fn errors<P: Poisson<f64>>(problem: &Problem<f64, P>, strides: &[usize]) -> Vec<f64> {
    let (fine, paths) = (512, 200);
    let processes = problem.system.noise_count();
    let first = problem.mu0.as_slice().len() - processes;
    let size = (problem.span.1 - problem.span.0) / fine as f64;
    let mut sums = vec![0.0; strides.len()];
    for stream in 0..paths {
        let wiener = lie_runtime::driver::Wiener::new(5, &[stream], processes);
        let mut increments = vec![0.0; fine * processes];
        for (step, out) in increments.chunks_mut(processes).enumerate() {
            wiener.rates(step as u64, size, out);
            out.iter_mut().for_each(|rate| *rate *= size);
        }
        let end = |stride: usize| {
            let path = Path {
                increments: &increments,
                processes,
                stride,
                first,
            };
            let options = Options::new(size * stride as f64).save(Save::Ends);
            let run = solve_observed(problem, Rk4, &options, path);
            let end = run.ok().and_then(|mut run| run.mu.pop()).expect("a row");
            [0, 1, 2].map(|k| end.as_slice()[k])
        };
        let exact = end(1);
        for (sum, &stride) in sums.iter_mut().zip(strides) {
            let found = end(stride);
            let squares = (0..3).map(|k| (found[k] - exact[k]).powi(2));
            *sum += squares.sum::<f64>() / paths as f64;
        }
    }
    sums.into_iter().map(f64::sqrt).collect()
}

/// A path that is held over a step is right to order 1 in the mean square where noises commute, as one that is a force does, and to order
/// 1/2 where not, as the three of a temperature.
#[test]
fn noise_has_order_one_where_it_commutes_and_half_of_it_where_not() {
    let strides = [64, 32, 16];
    let slope = |errors: &[f64]| (errors[0] / errors[2]).log2() / 2.0;
    let thermal = Problem {
        span: (0.0, 1.0),
        ..spin()
    };
    let found = slope(&errors(&thermal, &strides));
    assert!((found - 0.5).abs() < 0.1, "{found}");
    let system = Kicked::new().system().expect("a system");
    let start = [0.8, 0.1, 0.6, 0.0, 0.0, 1.0, 0.0];
    let found = slope(&errors(&Problem::new(system, start, (0.0, 1.0)), &strides));
    assert!((found - 1.0).abs() < 0.1, "{found}");
}
