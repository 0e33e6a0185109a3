//! A free rigid body declared in place, integrated by a method that keeps its geometry and by one
//! that does not.
//!
//! ```text
//! cargo run --release --example 01_rigid_body [FILE.svg]
//! ```
//!
//! Prints how far energy and Casimir move under `lie-midpoint` and under the classical Runge–Kutta
//! method, at the same step, and draws both into one picture.

use std::error::Error;
use std::path::PathBuf;

use lie_poisson::plot::Plot;
use lie_runtime::diagnostics::DriftMonitor;
use lie_runtime::prelude::*;

lie_poisson! {
    /// Free rigid body in the body frame: angular momentum (x, y, z), moments of inertia I1, I2, I3.
    pub system RigidBody;
    algebra { basis e1, e2, e3; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z;
    parameters { I1 = 2.0; I2 = 1.0; I3 = 2/3; }
    hamiltonian = x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3);
    casimir C = x^2 + y^2 + z^2;
    methods = [lie-midpoint];
}

const START: [f64; 3] = [0.9, 0.3, 0.4];
const STEP: f64 = 0.5;
const END: f64 = 200.0;

/// Runs a method and follows energy and Casimir over every step.
fn run<M>(method: M, label: &str) -> Result<Solution<f64, State3>, Box<dyn Error>>
where
    M: Method<f64, RigidBodySystem<f64>>,
{
    let problem = Problem::new(RigidBody::new().system()?, START, (0.0, END));
    let mut monitor = DriftMonitor::new();
    let options = Options::new(STEP);
    let solution = solve_observed(&problem, method, &options, &mut monitor)?;
    for drift in std::iter::once(&monitor.drift().energy).chain(&monitor.drift().casimirs) {
        println!(
            "{label:<13} {:<7} {:>11.2e} {:>13.2e} {:>13.2e} {:>8.2}",
            drift.name,
            drift.max,
            drift.windows[0],
            drift.windows[9],
            drift.growth().unwrap_or(f64::NAN),
        );
    }
    Ok(solution)
}

type State3 = <RigidBodySystem<f64> as Poisson<f64>>::State;

fn main() -> Result<(), Box<dyn Error>> {
    println!("free rigid body, h = {STEP}, t = {END}, largest |I - I0| over every step\n");
    println!(
        "{:<13} {:<7} {:>11} {:>13} {:>13} {:>8}",
        "method", "", "all", "first tenth", "last tenth", "growth"
    );
    let kept = run(LieMidpoint::exp(), "lie-midpoint")?;
    let lost = run(Rk4::new(), "rk4")?;

    let columns = [
        "t",
        "x",
        "y",
        "z",
        "energy, lie-midpoint",
        "C, lie-midpoint",
        "energy, rk4",
        "C, rk4",
    ];
    let mut plot = Plot::new("Free rigid body", &columns, 3, (0.0, END)).subtitle(format!(
        "lie-midpoint and rk4, h = {STEP}; the components are those of lie-midpoint"
    ));
    for (row, (t, mu)) in kept.t.iter().zip(&kept.mu).enumerate() {
        plot.push(&[
            *t,
            mu[0],
            mu[1],
            mu[2],
            kept.energy[row],
            kept.casimirs[row][0],
            lost.energy[row],
            lost.casimirs[row][0],
        ]);
    }
    let path = std::env::args_os()
        .nth(1)
        .map_or_else(|| PathBuf::from("01_rigid_body.svg"), PathBuf::from);
    plot.write_svg(&path)?;
    println!("\nThe picture is in {}.", path.display());
    Ok(())
}
