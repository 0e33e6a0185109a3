//! The heavy top from its spec file, with a method of order 6 and with one that keeps the geometry.
//!
//! ```text
//! cargo run --release --example 02_heavy_top_from_spec [FILE.svg]
//! ```
//!
//! Prints, for steps of h, h/2 and h/4, how far the end of the trajectory and the invariants are
//! off, and draws the trajectory of the Cayley form of `lie-midpoint`.

use std::error::Error;
use std::path::PathBuf;

use lie_poisson::plot::Plot;
use lie_runtime::diagnostics::DriftMonitor;
use lie_runtime::prelude::*;

lie_poisson! { pub spec = "specs/se3_heavy_top.json"; }

type Top = HeavyTopSystem<f64>;
type State6 = <Top as Poisson<f64>>::State;

const END: f64 = 20.0;

/// The initial state of the spec.
const START: [f64; 6] = [
    2.0 / 5.0,
    3.0 / 10.0,
    9.0 / 10.0,
    9.0 / 25.0,
    12.0 / 25.0,
    4.0 / 5.0,
];

fn run<M: Method<f64, Top>>(
    method: M,
    step: f64,
    monitor: &mut DriftMonitor<f64>,
) -> Result<Solution<f64, State6>, Box<dyn Error>> {
    let problem = Problem::new(HeavyTop::new().system()?, START, (0.0, END));
    Ok(solve_observed(
        &problem,
        method,
        &Options::new(step),
        monitor,
    )?)
}

fn report<M: Method<f64, Top> + Copy>(
    label: &str,
    method: M,
    reference: &State6,
) -> Result<(), Box<dyn Error>> {
    let mut before = None;
    for step in [0.1, 0.05, 0.025] {
        let mut monitor = DriftMonitor::new();
        let solution = run(method, step, &mut monitor)?;
        let (_, end) = solution.last().ok_or("an empty run")?;
        let error = (0..6)
            .map(|i| (end[i] - reference[i]).abs())
            .fold(0.0, f64::max);
        let order = before.map_or(String::new(), |before: f64| {
            format!("{:.2}", (before / error).log2())
        });
        let drift = monitor.drift();
        let casimirs = drift
            .casimirs
            .iter()
            .map(|casimir| casimir.max)
            .fold(0.0, f64::max);
        let newton = solution.stats.newton as f64 / solution.stats.steps as f64;
        println!(
            "{label:<22} {step:>6} {error:>10.2e} {order:>6} {:>10.2e} {casimirs:>10.2e} {newton:>8.2}",
            drift.energy.max
        );
        before = Some(error);
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut monitor = DriftMonitor::new();
    let fine = run(Gauss6::new(), 0.005, &mut monitor)?;
    let (_, reference) = fine.last().ok_or("an empty run")?;

    println!("heavy top, t = {END}, errors at the end against gauss6 with h = 0.005\n");
    println!(
        "{:<22} {:>6} {:>10} {:>6} {:>10} {:>10} {:>8}",
        "method", "h", "error", "order", "energy", "Casimirs", "Newton"
    );
    report("gauss6", Gauss6::new(), reference)?;
    report("lie-midpoint, exp", LieMidpoint::exp(), reference)?;
    report("lie-midpoint, cayley", LieMidpoint::cayley(), reference)?;

    let solution = run(LieMidpoint::cayley(), 0.025, &mut monitor)?;
    let columns: Vec<&str> = std::iter::once("t")
        .chain(solution.coordinates.iter().map(String::as_str))
        .chain(["energy"])
        .chain(solution.casimir_names.iter().map(String::as_str))
        .collect();
    let mut plot =
        Plot::new("Heavy top", &columns, 6, (0.0, END)).subtitle("lie-midpoint, cayley, h = 0.025");
    for (row, (&t, mu)) in solution.t.iter().zip(&solution.mu).enumerate() {
        let invariants = std::iter::once(&solution.energy[row]).chain(&solution.casimirs[row]);
        let values: Vec<f64> = std::iter::once(&t)
            .chain(mu.iter())
            .chain(invariants)
            .copied()
            .collect();
        plot.push(&values);
    }
    let path = std::env::args_os()
        .nth(1)
        .map_or_else(|| PathBuf::from("02_heavy_top.svg"), PathBuf::from);
    plot.write_svg(&path)?;
    println!("\nThe picture is in {}.", path.display());
    Ok(())
}
