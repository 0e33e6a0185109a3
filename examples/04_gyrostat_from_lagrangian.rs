//! A satellite with a momentum wheel, declared by its Lagrangian and by the Hamiltonian that one
//! derives from it by hand.
//!
//! ```text
//! cargo run --release --example 04_gyrostat_from_lagrangian [FILE.svg]
//! ```
//!
//! The wheel turns about the third axis of the body, with the spin s relative to it: the algebra is
//! so(3) + R and the reduced Lagrangian `l = <I w, w>/2 + J (w3 + s)^2/2`. Its Hessian is not diagonal,
//! and the Legendre transform `mu = dl/dxi`, `H(mu) = <mu, xi> - l(xi)` is found when the declaration is
//! compiled. Prints how far the two forms are apart, step by step, and how far energy and Casimirs move.

use std::error::Error;
use std::path::PathBuf;

use lie_poisson::plot::Plot;
use lie_runtime::diagnostics::DriftMonitor;
use lie_runtime::prelude::*;

lie_poisson! {
    /// A gyrostat by its Lagrangian: angular velocity (w1, w2, w3) and relative spin s of the wheel.
    pub system Gyrostat;
    algebra { basis e1, e2, e3, turn; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z, p;
    velocity w1, w2, w3, s;
    parameters { I1 = 2.0; I2 = 1.0; I3 = 1.2; J = 0.1; }
    lagrangian = (I1*w1^2 + I2*w2^2 + I3*w3^2)/2 + J*(w3 + s)^2/2;
    casimir momentum = x^2 + y^2 + z^2;
    casimir wheel = p;
    initial = [0.3, 1, 0.2, 0.4];
    methods = [lie-midpoint];
}

lie_poisson! {
    /// The same by its Hamiltonian: the wheel takes its momentum p out of the third component.
    pub system ByHand;
    algebra { basis e1, e2, e3, turn; [e1, e2] = e3; [e2, e3] = e1; [e3, e1] = e2; }
    state x, y, z, p;
    parameters { I1 = 2.0; I2 = 1.0; I3 = 1.2; J = 0.1; }
    hamiltonian = x^2/(2*I1) + y^2/(2*I2) + (z - p)^2/(2*I3) + p^2/(2*J);
    initial = [0.3, 1, 0.2, 0.4];
    methods = [lie-midpoint];
}

const STEP: f64 = 0.1;
const END: f64 = 100.0;

fn main() -> Result<(), Box<dyn Error>> {
    let problem = Problem {
        system: Gyrostat::new().system()?,
        mu0: Gyrostat::new().initial_state(),
        span: (0.0, END),
    };
    let mut monitor = DriftMonitor::new();
    let solution = solve_observed(
        &problem,
        LieMidpoint::exp(),
        &Options::new(STEP),
        &mut monitor,
    )?;
    let by_hand = Problem {
        system: ByHand::new().system()?,
        mu0: ByHand::new().initial_state(),
        span: (0.0, END),
    };
    let by_hand = solve(&by_hand, LieMidpoint::exp(), &Options::new(STEP))?;

    let apart = solution.mu.iter().zip(&by_hand.mu);
    let apart = apart.fold(0.0, |largest, (a, b)| f64::max(largest, (a - b).amax()));
    println!("gyrostat, lie-midpoint, h = {STEP}, t = {END}");
    println!("Lagrangian and Hamiltonian form are at most {apart:.1e} apart");
    for drift in std::iter::once(&monitor.drift().energy).chain(&monitor.drift().casimirs) {
        println!("{:<9} moves by {:.1e}", drift.name, drift.max);
    }

    let columns = ["t", "x", "y", "z", "p", "energy", "momentum", "wheel"];
    let mut plot = Plot::new("Satellite with a momentum wheel", &columns, 4, (0.0, END))
        .subtitle(format!("lie-midpoint, h = {STEP}, from its Lagrangian"));
    for (row, (t, mu)) in solution.t.iter().zip(&solution.mu).enumerate() {
        plot.push(&[
            *t,
            mu[0],
            mu[1],
            mu[2],
            mu[3],
            solution.energy[row],
            solution.casimirs[row][0],
            solution.casimirs[row][1],
        ]);
    }
    let path = std::env::args_os().nth(1).map_or_else(
        || PathBuf::from("04_gyrostat_from_lagrangian.svg"),
        PathBuf::from,
    );
    plot.write_svg(&path)?;
    println!("The picture is in {}.", path.display());
    Ok(())
}
