//! Three species with a bracket that is quadratic in the coordinates, from a spec.
//!
//! ```text
//! cargo run --release --example 08_lotka_volterra [FILE.svg]
//! ```
//!
//! `{y1, y2} = c y1 y2`, `{y1, y3} = b c y1 y3`, `{y2, y3} = -y2 y3` has the Casimir
//! `a b log y1 - b log y2 + log y3`: orbits are closed curves. Prints how far energy and Casimir move under
//! methods that keep the energy, with the Poisson matrix at the midpoint and with its mean over the ends of
//! a step, and under the classical Runge–Kutta method.

use std::error::Error;
use std::path::PathBuf;

use lie_poisson::plot::Plot;
use lie_runtime::diagnostics::DriftMonitor;
use lie_runtime::methods::{CohenHairer4, MeanTensor, MeanValue, WithTensor};
use lie_runtime::prelude::*;

lie_poisson! { pub spec = "specs/lotka_volterra.json"; }

const STEP: f64 = 0.02;
const END: f64 = 200.0;

type State3 = <LotkaVolterraSystem<f64> as Poisson<f64>>::State;

/// Runs a method and follows energy and Casimir over every step.
fn run<M>(method: M, label: &str) -> Result<(Solution<f64, State3>, f64), Box<dyn Error>>
where
    M: Method<f64, LotkaVolterraSystem<f64>>,
{
    let problem = Problem {
        system: LotkaVolterra::new().system()?,
        mu0: LotkaVolterra::new().initial_state(),
        span: (0.0, END),
    };
    let mut monitor = DriftMonitor::new();
    let solution = solve_observed(&problem, method, &Options::new(STEP), &mut monitor)?;
    let drift = monitor.drift();
    println!(
        "{label:<26} {:>8.1e} {:>8.1e} {:>8.1}",
        drift.energy.max,
        drift.casimirs[0].max,
        drift.casimirs[0].growth().unwrap_or(f64::NAN)
    );
    Ok((solution, drift.energy.max))
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("Lotka and Volterra, h = {STEP}, t = {END}, largest |I - I0| over every step\n");
    println!(
        "{:<26} {:>8} {:>8} {:>8}",
        "method", "energy", "Casimir", "growth"
    );
    let (kept, first) = run(CohenHairer4::new(), "cohen-hairer4")?;
    let (_, second) = run(MeanValue::new(), "mean-value")?;
    let mean = WithTensor::new(MeanValue::new(), MeanTensor);
    let (_, third) = run(mean, "mean-value --tensor mean")?;
    let (lost, control) = run(Rk4::new(), "rk4")?;
    assert!(
        first.max(second).max(third) < 1e-12,
        "the energy is not kept"
    );
    assert!(control > 1e-8, "the control keeps the energy");

    let columns = [
        "t",
        "y1",
        "y2",
        "y3",
        "energy, cohen-hairer4",
        "C, cohen-hairer4",
        "energy, rk4",
        "C, rk4",
    ];
    let mut plot = Plot::new("Lotka and Volterra", &columns, 3, (0.0, END)).subtitle(format!(
        "cohen-hairer4 and rk4, h = {STEP}; the components are those of cohen-hairer4"
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
        .map_or_else(|| PathBuf::from("08_lotka_volterra.svg"), PathBuf::from);
    plot.write_svg(&path)?;
    println!("\nThe picture is in {}.", path.display());
    Ok(())
}
