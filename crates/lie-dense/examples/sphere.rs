//! The Euler equations on the sphere from a smooth random vorticity, in 64 x 64 matrices.
//!
//! ```text
//! cargo run --release -p lie-dense --example sphere
//! ```
//!
//! Prints how far spectrum and energy move under the isospectral midpoint rule, and under the classical Runge–Kutta method with a quarter
//! of its step.

use std::error::Error;

use lie_dense::{MatrixFlow, SpectrumMonitor, SphereEuler};
use lie_runtime::diagnostics::DriftMonitor;
use lie_runtime::driver::{Options, Save, solve_observed};
use lie_runtime::methods::{Isospectral2, Method, Rk4};

fn run<M>(method: M, step: f64, label: &str) -> Result<(), Box<dyn Error>>
where
    M: Method<f64, MatrixFlow<SphereEuler>>,
{
    let sphere = SphereEuler::new(64)?;
    let w = sphere.random(10, 1)?;
    let problem = MatrixFlow::new(sphere).problem(w, (0.0, 10.0))?;
    let (mut spectrum, mut drift) = (SpectrumMonitor::new(), DriftMonitor::new());
    let options = Options::new(step).save(Save::Interval(1.0));
    let solution = solve_observed(&problem, method, &options, (&mut spectrum, &mut drift))?;
    let energy = drift.drift().energy.relative();
    println!(
        "{label:>12}: {} steps, {} evaluations; spectrum {:.1e}, energy {:.1e}",
        solution.stats.steps,
        solution.stats.evaluations,
        spectrum.change / spectrum.radius(),
        energy.unwrap_or(f64::NAN),
    );
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    run(Isospectral2::new(), 0.01, "isospectral2")?;
    run(Rk4, 0.0025, "rk4")
}
