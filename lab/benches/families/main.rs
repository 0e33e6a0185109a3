//! Steps of a ring and of lattices of classical spins, generated, and of the ring written by hand, in a loop for a profiler to
//! count. `tests/family_counts.rs` builds and runs this under callgrind.
//!
//! Prints the energy, the mean of the squares of the spins, and the largest memory of the process.

mod chain;

use lie_runtime::newton::NewtonOptions;
use lie_runtime::prelude::*;
use std::process::ExitCode;

lie_poisson! {
    /// Classical spins on a ring.
    pub system Ring;
    algebra = so(3)^N;
    state x[i], y[i], z[i];
    parameters { N = 1000; J = 1; }
    hamiltonian = -J*sum(i in 0..N: x[i]*x[i+1] + y[i]*y[i+1] + z[i]*z[i+1]);
    initial = random(unit-sphere, 1);
}

lie_poisson! {
    /// Classical spins on a square lattice, periodic along both axes.
    pub system Square;
    algebra = so(3)^(N, M);
    state x[i, j], y[i, j], z[i, j];
    parameters { N = 32; M = 32; J = 1; }
    hamiltonian = -J*sum(i in 0..N, j in 0..M: x[i, j]*x[i+1, j] + y[i, j]*y[i+1, j] + z[i, j]*z[i+1, j]
        + x[i, j]*x[i, j+1] + y[i, j]*y[i, j+1] + z[i, j]*z[i, j+1]);
    initial = random(unit-sphere, 1);
}

lie_poisson! {
    /// Classical spins on a cubic lattice, periodic along all axes.
    pub system Cube;
    algebra = so(3)^(L, N, M);
    state x[i, j, k], y[i, j, k], z[i, j, k];
    parameters { L = 10; N = 10; M = 10; J = 1; }
    hamiltonian = -J*sum(i in 0..L, j in 0..N, k in 0..M: x[i, j, k]*x[i+1, j, k] + y[i, j, k]*y[i+1, j, k] + z[i, j, k]*z[i+1, j, k]
        + x[i, j, k]*x[i, j+1, k] + y[i, j, k]*y[i, j+1, k] + z[i, j, k]*z[i, j+1, k]
        + x[i, j, k]*x[i, j, k+1] + y[i, j, k]*y[i, j, k+1] + z[i, j, k]*z[i, j, k+1]);
    initial = random(unit-sphere, 1);
}

/// So many steps.
fn steps<P, M>(system: &P, method: M, mut mu: Vec<f64>, [h, count]: [f64; 2]) -> bool
where
    P: Poisson<f64, State = Vec<f64>>,
    M: Method<f64, P>,
{
    let before = system.hamiltonian(&mu);
    let mut stepper = method.stepper(system, h, &NewtonOptions::default());
    for _ in 0..count as u32 {
        if stepper.step(&mut mu, &mut ()).is_err() {
            return false;
        }
    }
    let (energy, sites) = (system.hamiltonian(&mu), mu.len() / 3);
    let square = mu.iter().map(|x| x * x).sum::<f64>() / sites as f64;
    let change = (energy - before) / before.abs();
    println!(
        "energy {energy} changed by {change:e}, squares {square}, {}",
        memory()
    );
    true
}

/// The largest memory of the process, where the system says it.
fn memory() -> String {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with("VmHWM"));
    line.unwrap_or("VmHWM: unknown").to_owned()
}

fn by_method<P>(system: &P, method: &str, mu: Vec<f64>, how: [f64; 2]) -> bool
where
    P: Poisson<f64, State = Vec<f64>>,
    Rk4: Method<f64, P>,
    Gauss16: Method<f64, P>,
    Splitting6: Method<f64, P>,
{
    match method {
        "rk4" => steps(system, Rk4, mu, how),
        "gauss16" => steps(system, Gauss16, mu, how),
        "splitting6" => steps(system, Splitting6::new(), mu, how),
        _ => false,
    }
}

fn run(system: &str, method: &str, sites: f64, how: [f64; 2]) -> Option<bool> {
    let ring = Ring { N: sites, J: 1.0 };
    let mu = ring.initial_state().ok()?;
    match system {
        "ring" => Some(by_method(&ring.system().ok()?, method, mu, how)),
        "by_hand" => {
            let spins: Vec<f64> = (0..mu.len())
                .map(|k| mu[k % 3 * (mu.len() / 3) + k / 3])
                .collect();
            let by_hand = chain::Chain::new(spins.len() / 3);
            Some(by_method(&by_hand, method, chain::state(&spins), how))
        }
        "square" => {
            let square = Square {
                N: sites,
                M: sites,
                J: 1.0,
            };
            let mu = square.initial_state().ok()?;
            Some(by_method(&square.system().ok()?, method, mu, how))
        }
        "cube" => {
            let cube = Cube {
                L: sites,
                N: sites,
                M: sites,
                J: 1.0,
            };
            let mu = cube.initial_state().ok()?;
            Some(by_method(&cube.system().ok()?, method, mu, how))
        }
        _ => None,
    }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args()
        .skip(1)
        .filter(|argument| argument != "--bench")
        .collect();
    if let [system, method, sites, h, count] = arguments.as_slice() {
        let numbers = [sites, h, count].map(|text| text.parse().unwrap_or(f64::NAN));
        if run(system, method, numbers[0], [numbers[1], numbers[2]]) == Some(true) {
            return ExitCode::SUCCESS;
        }
        return ExitCode::FAILURE;
    }
    println!("usage: ring|by_hand|square|cube rk4|gauss16|splitting6 SITES STEP STEPS");
    ExitCode::SUCCESS
}
