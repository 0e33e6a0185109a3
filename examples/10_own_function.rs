//! A spinning ball on an arm inside a heavy ring: a potential that is a function of Rust.
//!
//! ```text
//! cargo run --release --example 10_own_function
//! ```
//!
//! The ring of radius a lies in the plane through the pivot. At the distance rho from its axis and the height z its
//! potential is `-m/M(far, near)`, where M is the arithmetic-geometric mean of the largest and the smallest distance to the
//! ring (Gauss). The mean is a loop, for which the grammar has no word. Its derivatives come from dual numbers.

use std::error::Error;
use std::path::PathBuf;

use lie_poisson::plot::Plot;
use lie_runtime::diagnostics::DriftMonitor;
use lie_runtime::driver::Solution;
use lie_runtime::prelude::*;

/// The arithmetic-geometric mean: each turn doubles the digits.
fn mean<S: Scalar>(a: S, b: S) -> S {
    let (mut a, mut b) = (a, b);
    for _ in 0..6 {
        (a, b) = ((a + b) * S::ratio(1.0, 2.0), (a * b).sqrt());
    }
    a
}

/// The potential of a ring of mass 1 and radius 1.5.
fn ring<S: Scalar>(rho: S, z: S) -> S {
    let radius = S::ratio(3.0, 2.0);
    let distance = |x: S| (x * x + z * z).sqrt();
    -S::one() / mean(distance(radius + rho), distance(radius - rho))
}

lie_poisson! {
    /// A symmetric top whose centre of mass is drawn to a ring.
    pub system RingTop;
    algebra = se(3);
    state Pi1, Pi2, Pi3, Gamma1, Gamma2, Gamma3;
    parameters { I1 = 1.0; I3 = 0.4; mass = 2.0; }
    functions { ring(rho, z) = crate::ring; }
    hamiltonian = (Pi1^2 + Pi2^2)/(2*I1) + Pi3^2/(2*I3) + mass*ring(hypot(Gamma1, Gamma2), Gamma3);
    methods = [lie-midpoint];
}

const START: [f64; 6] = [0.3, 0.2, 1.1, 0.6, 0.0, 0.8];

const END: f64 = 500.0;

/// The solution, and how far energy and Casimirs move over all steps.
fn run<M: Method<f64, RingTopSystem>>(
    name: &str,
    method: M,
) -> Result<Solution<f64, <RingTopSystem as Poisson<f64>>::State>, Box<dyn Error>> {
    let problem = Problem::new(RingTop::new().system()?, START, (0.0, END));
    let mut monitor = DriftMonitor::new();
    let solution = solve_observed(&problem, method, &Options::new(0.1), &mut monitor)?;
    let drift = monitor.drift();
    let casimirs = drift.casimirs.iter().map(|casimir| casimir.max);
    let casimirs: Vec<String> = casimirs.map(|max| format!("{max:.1e}")).collect();
    let growth = drift.energy.growth().unwrap_or(1.0);
    println!(
        "{name:<13} energy {:.1e} (last tenth over first {growth:.1}), Casimirs {}",
        drift.energy.max,
        casimirs.join(", ")
    );
    Ok(solution)
}

fn main() -> Result<(), Box<dyn Error>> {
    let kept = run("lie-midpoint", LieMidpoint::exp())?;
    let lost = run("rk4", Rk4::new())?;
    let columns = [
        "t",
        "Gamma1",
        "Gamma2",
        "Gamma3",
        "energy, lie-midpoint",
        "length, lie-midpoint",
        "energy, rk4",
        "length, rk4",
    ];
    let mut plot = Plot::new("A top drawn to a ring", &columns, 3, (0.0, END))
        .subtitle("lie-midpoint and rk4, h = 0.1; the components are those of lie-midpoint");
    for (row, (t, mu)) in kept.t.iter().zip(&kept.mu).enumerate() {
        plot.push(&[
            *t,
            mu[3],
            mu[4],
            mu[5],
            kept.energy[row],
            kept.casimirs[row][0],
            lost.energy[row],
            lost.casimirs[row][0],
        ]);
    }
    let path = std::env::args_os()
        .nth(1)
        .map_or_else(|| PathBuf::from("10_own_function.svg"), PathBuf::from);
    plot.write_svg(&path)?;
    println!("\nThe picture is in {}.", path.display());
    Ok(())
}
