//! A pendulum in canonical coordinates, held against the same pendulum on e(2)*.
//!
//! ```text
//! cargo run --release --example 07_canonical_pendulum [FILE.svg]
//! ```
//!
//! `{q, p} = 1` with `H = p^2/2 - g cos q`, and on e(2)* `H = L^2/2 - g x` with `L = p`, `x = cos q`,
//! `y = -sin q`. Prints how far the two are apart, and how far the energy of the first moves under the
//! midpoint rule, which is symplectic for a constant bracket, and under the classical Runge–Kutta method.

use std::error::Error;
use std::path::PathBuf;

use lie_poisson::plot::Plot;
use lie_runtime::diagnostics::DriftMonitor;
use lie_runtime::prelude::*;

lie_poisson! {
    /// A pendulum: angle q and angular momentum p.
    pub system Canonical;
    poisson { {q, p} = 1; }
    state q, p;
    parameters { g = 1; }
    hamiltonian = p^2/2 - g*cos(q);
    methods = [midpoint, gauss6];
}

lie_poisson! {
    /// The same on e(2)*: angular momentum L and the position (x, y) on the unit circle.
    pub system OnCircle;
    algebra { basis J, P1, P2; [J, P1] = P2; [J, P2] = -P1; }
    state L, x, y;
    parameters { g = 1; }
    hamiltonian = L^2/2 - g*x;
    casimir radius2 = x^2 + y^2;
    methods = [gauss6];
}

const START: [f64; 2] = [-0.9, 1.1];
const END: f64 = 50.0;

/// How far the energy moves under a method, over every step, and the run.
fn run<M>(method: M, label: &str) -> Result<Solution<f64, State2>, Box<dyn Error>>
where
    M: Method<f64, CanonicalSystem<f64>>,
{
    let problem = Problem::new(Canonical::new().system()?, START, (0.0, 40.0 * END));
    let mut monitor = DriftMonitor::new();
    let solution = solve_observed(&problem, method, &Options::new(0.5), &mut monitor)?;
    let drift = &monitor.drift().energy;
    println!(
        "{label:<9} energy moves by {:.1e}, growth from the first to the last tenth {:.1}",
        drift.max,
        drift.growth().unwrap_or(f64::NAN)
    );
    Ok(solution)
}

type State2 = <CanonicalSystem<f64> as Poisson<f64>>::State;

fn main() -> Result<(), Box<dyn Error>> {
    let [q, p] = START;
    let options = Options::new(0.02);
    let canonical = Problem::new(Canonical::new().system()?, START, (0.0, END));
    let canonical = solve(&canonical, Gauss6::new(), &options)?;
    let circle = [p, q.cos(), -q.sin()];
    let on_circle = Problem::new(OnCircle::new().system()?, circle, (0.0, END));
    let on_circle = solve(&on_circle, Gauss6::new(), &options)?;
    let mut apart = 0.0_f64;
    for (a, b) in canonical.mu.iter().zip(&on_circle.mu) {
        let expected = [a[1], a[0].cos(), -a[0].sin()];
        for (e, b) in expected.iter().zip(b.as_slice()) {
            apart = apart.max((e - b).abs());
        }
    }
    println!(
        "pendulum, gauss6, h = 0.02, t = {END}: canonical and on e(2)* at most {apart:.1e} apart"
    );
    assert!(
        apart < 1e-11,
        "the two pendulums move differently: {apart:e}"
    );

    println!(
        "\nthe same in canonical coordinates, h = 0.5, t = {}",
        40.0 * END
    );
    let kept = run(ImplicitMidpoint::new(), "midpoint")?;
    let lost = run(Rk4::new(), "rk4")?;
    let columns = ["t", "q", "p", "energy, midpoint", "energy, rk4"];
    let mut plot = Plot::new(
        "Pendulum in canonical coordinates",
        &columns,
        2,
        (0.0, 40.0 * END),
    )
    .subtitle("midpoint and rk4, h = 0.5; the components are those of midpoint".to_owned());
    for (row, (t, mu)) in kept.t.iter().zip(&kept.mu).enumerate() {
        plot.push(&[*t, mu[0], mu[1], kept.energy[row], lost.energy[row]]);
    }
    let path = std::env::args_os()
        .nth(1)
        .map_or_else(|| PathBuf::from("07_canonical_pendulum.svg"), PathBuf::from);
    plot.write_svg(&path)?;
    println!("\nThe picture is in {}.", path.display());
    Ok(())
}
