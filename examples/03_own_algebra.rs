//! An algebra of one's own, with a parameter in its brackets: so(3) for k > 0, e(2) for k = 0 and
//! sl(2, R) for k < 0, one declaration for all three.
//!
//! ```text
//! cargo run --release --example 03_own_algebra [FILE.svg]
//! ```
//!
//! The Jacobi identity and the Casimir are verified at compile time, identically in k. The example
//! shows what a false bracket is told, measures the same identities in numbers, integrates the three
//! systems and draws the one on sl(2, R).

use std::error::Error;
use std::path::PathBuf;

use lie_poisson::plot::Plot;
use lie_runtime::diagnostics::DriftMonitor;
use lie_runtime::prelude::*;

lie_poisson! {
    /// A body whose algebra depends on k: `[a, b] = k c`, the other brackets as in so(3).
    pub system Body;
    algebra { basis a, b, c; [a, b] = k*c; [b, c] = a; [c, a] = b; }
    state x, y, z;
    parameters { exact k = 1; I1 = 2; I2 = 1; I3 = 2/3; q = 1/5; }
    hamiltonian = x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3) + q*(x^4 + z^4)/4;
    casimir C = x^2 + y^2 + k*z^2;
    methods = [lie-midpoint];
}

/// The same brackets with a sign and an element changed; no k makes them a Lie algebra.
const FALSE: &str = r#"{
  "format": 1, "name": "False",
  "algebra": { "basis": ["a", "b", "c"], "brackets": ["[a, b] = k*c", "[b, c] = a", "[c, a] = b + c"] },
  "parameters": { "k": { "default": 1, "exact": true } },
  "state": ["x", "y", "z"], "hamiltonian": "x^2"
}"#;

type System = BodySystem<f64>;
type State3 = <System as Poisson<f64>>::State;

const START: [f64; 3] = [0.4, 0.8, 0.5];
const STEP: f64 = 0.05;
const END: f64 = 500.0;

/// The largest entry of `[u, [v, w]] + [v, [w, u]] + [w, [u, v]]`.
fn jacobiator(system: &System, elements: [State3; 3]) -> f64 {
    let mut sum = system.zero_state();
    let (mut inner, mut outer) = (system.zero_state(), system.zero_state());
    for turn in 0..3 {
        let [u, v, w] = [0, 1, 2].map(|i| &elements[(turn + i) % 3]);
        system.ad(v, w, &mut inner);
        system.ad(u, &inner, &mut outer);
        sum += outer;
    }
    sum.amax()
}

/// The largest entry of `Pi(mu) grad C(mu) = ad*_(grad C) mu`, zero for a Casimir.
fn casimir_residual(system: &System, mu: &State3) -> f64 {
    let (mut gradient, mut field) = (system.zero_state(), system.zero_state());
    system.casimir_gradient(0, mu, &mut gradient);
    system.ad_star(&gradient, mu, &mut field);
    field.amax()
}

fn main() -> Result<(), Box<dyn Error>> {
    println!("what a false bracket is told:");
    for mistake in lie_codegen::compile::compile_spec(FALSE)
        .err()
        .unwrap_or_default()
    {
        println!("  error[{}]: {}", mistake.kind, mistake.message);
    }

    println!("\nlie-midpoint, h = {STEP}, t = {END}\n");
    println!(
        "{:>4} {:>12} {:>9} {:>9} {:>11} {:>7} {:>11} {:>7} {:>7}",
        "k", "algebra", "Jacobi", "Casimir", "energy", "growth", "C", "Newton", "pivots"
    );
    for (k, algebra) in [(1.0, "so(3)"), (0.0, "e(2)"), (-1.0, "sl(2, R)")] {
        let system = Body {
            k,
            ..Body::default()
        }
        .system()?;
        let elements = [[0.3, -0.7, 0.2], [-0.5, 0.1, 0.9], [0.8, 0.6, -0.4]].map(State3::from);
        let jacobi = jacobiator(&system, elements);
        let casimir = casimir_residual(&system, &START.into());

        let problem = Problem::new(system, START, (0.0, END));
        let mut monitor = DriftMonitor::new();
        let solution = solve_observed(
            &problem,
            LieMidpoint::exp(),
            &Options::new(STEP),
            &mut monitor,
        )?;
        let (drift, stats) = (monitor.drift(), &solution.stats);
        println!(
            "{k:>4} {algebra:>12} {jacobi:>9.0e} {casimir:>9.0e} {:>11.2e} {:>7.2} {:>11.2e} {:>7.2} {:>7}",
            drift.energy.max,
            drift.energy.growth().unwrap_or(f64::NAN),
            drift.casimirs[0].max,
            stats.newton as f64 / stats.steps as f64,
            stats.pivoted,
        );
        if k < 0.0 {
            draw(&solution)?;
        }
    }
    Ok(())
}

/// The first tenth of the run, where the motion can be followed by eye.
fn draw(solution: &Solution<f64, State3>) -> Result<(), Box<dyn Error>> {
    let end = END / 10.0;
    let mut plot = Plot::new(
        "A body on sl(2, R)",
        &["t", "x", "y", "z", "energy", "C"],
        3,
        (0.0, end),
    )
    .subtitle(format!("lie-midpoint, h = {STEP}"));
    for (row, (&t, mu)) in solution.t.iter().zip(&solution.mu).enumerate() {
        if t <= end {
            plot.push(&[
                t,
                mu[0],
                mu[1],
                mu[2],
                solution.energy[row],
                solution.casimirs[row][0],
            ]);
        }
    }
    let path = std::env::args_os()
        .nth(1)
        .map_or_else(|| PathBuf::from("03_own_algebra.svg"), PathBuf::from);
    Ok(plot.write_svg(path)?)
}
