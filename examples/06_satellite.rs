//! A satellite in the gravity gradient: a Hamiltonian that depends on the attitude.
//!
//! ```text
//! cargo run --release --example 06_satellite [FILE.svg]
//! ```
//!
//! The system lives on T*SO(3): the entries of the rotation matrix R from body axes to the orbital frame stand in
//! the Hamiltonian, and are coordinates beside the angular momentum. The symplectic method `euler-arnold2` keeps
//! R a rotation and the energy without drift; rk4 loses both. The picture shows how the satellite librates.

use std::error::Error;
use std::path::PathBuf;

use lie_poisson::plot::Plot;
use lie_runtime::diagnostics::{Drift, DriftMonitor};
use lie_runtime::prelude::*;

lie_poisson! { pub spec = "specs/so3_gravity_gradient.json"; }

type State = <SatelliteSystem as Poisson<f64>>::State;

/// Ten orbits of length 2 pi.
const END: f64 = 62.8;
const STEP: f64 = 0.05;

fn run<M: Method<f64, SatelliteSystem>>(
    method: M,
    end: f64,
    step: f64,
) -> Result<(Solution<f64, State>, Drift), Box<dyn Error>> {
    let satellite = Satellite::new();
    let problem = Problem::new(satellite.system()?, satellite.initial_state(), (0.0, end));
    let mut monitor = DriftMonitor::new();
    let solution = solve_observed(&problem, method, &Options::new(step), &mut monitor)?;
    Ok((solution, monitor.drift().clone()))
}

/// Roll, pitch and yaw: how far the body axes are from the orbital frame, in degrees.
fn angles(state: &State) -> [f64; 3] {
    let r = |i: usize, j: usize| state[3 + 3 * i + j];
    let pitch = (-r(2, 0)).asin();
    let roll = r(2, 1).atan2(r(2, 2));
    let yaw = r(1, 0).atan2(r(0, 0));
    [roll, pitch, yaw].map(f64::to_degrees)
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os().nth(1).map_or_else(
        || std::env::temp_dir().join("06_satellite.svg"),
        PathBuf::from,
    );
    println!("over {} orbits:", 100);
    let rotation = |drift: &Drift| drift.casimirs.iter().map(|c| c.max).fold(0.0, f64::max);
    let (_, kept) = run(EulerArnold2::new(), 10.0 * END, STEP)?;
    let (_, lost) = run(Rk4::new(), 10.0 * END, STEP)?;
    for (name, drift) in [("euler-arnold2", &kept), ("rk4", &lost)] {
        let growth = drift.energy.growth().unwrap_or(1.0);
        println!(
            "{name:<14} energy {:.1e} (last tenth over first {growth:.1}), rotation matrix {:.1e}",
            drift.energy.max,
            rotation(drift)
        );
    }
    assert!(rotation(&kept) < 1e-13 && rotation(&lost) > 1e-7);
    assert!(kept.energy.growth().is_some_and(|growth| growth < 1.5));
    assert!(lost.energy.growth().is_some_and(|growth| growth > 5.0));

    let (solution, _) = run(EulerArnold2::new(), END, STEP)?;
    let columns = [
        "t",
        "roll",
        "pitch",
        "yaw",
        "energy",
        "normal",
        "radius",
        "right_angle",
    ];
    let mut plot = Plot::new(
        "A satellite librates in the gravity gradient",
        &columns,
        3,
        (0.0, END),
    )
    .subtitle(format!(
        "euler-arnold2, h = {STEP}; angles in degrees, an orbit takes 2 pi"
    ));
    for (row, state) in solution.mu.iter().enumerate() {
        let mut numbers = vec![solution.t[row]];
        numbers.extend(angles(state));
        numbers.push(solution.energy[row]);
        numbers.extend(&solution.casimirs[row]);
        plot.push(&numbers);
    }
    plot.write_svg(&path)?;
    println!("The picture is in {}.", path.display());
    Ok(())
}
