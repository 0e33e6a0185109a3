//! A rigid body that tumbles about its intermediate axis, with its attitude.
//!
//! ```text
//! cargo run --release --example 05_tumbling_body [FILE.svg]
//! ```
//!
//! The body spins about the axis of its middle moment of inertia, nearly: it turns over again and again
//! (the Dzhanibekov effect). Beside the angular momentum in body axes, mu, the run follows the rotation g from
//! body axes to space, `g' = g xi`. The spatial angular momentum `g mu` is what stays: by how much it moves is
//! printed for methods of coadjoint form, for the implicit midpoint rule, which is one on so(3), and for rk4. The
//! picture shows mu and the unit quaternion of g.

use std::error::Error;
use std::path::PathBuf;

use lie_poisson::plot::Plot;
use lie_runtime::driver::{Chart, Reconstruction};
use lie_runtime::prelude::*;

lie_poisson! {
    /// A free rigid body; so(3) brings the matrices of the rotations of space, and the names x, y, z.
    pub system Body;
    algebra = so(3);
    parameters { I1 = 1; I2 = 2; I3 = 3; }
    hamiltonian = x^2/(2*I1) + y^2/(2*I2) + z^2/(2*I3);
    casimir norm2 = x^2 + y^2 + z^2;
    methods = [moser-veselov];
    initial = [1/100, 2, 1/100];
}

type State3 = <BodySystem as Poisson<f64>>::State;
type Run = (Solution<f64, State3>, Reconstruction<f64, State3>);

const END: f64 = 60.0;
const STEP: f64 = 0.05;

fn run<M: Method<f64, BodySystem>>(method: M, chart: Chart) -> Result<Run, Box<dyn Error>> {
    let body = Body::new();
    let system = body.system()?;
    let mut attitude = Reconstruction::new(&system, chart);
    let problem = Problem::new(system, body.initial_state(), (0.0, END));
    let solution = solve_observed(&problem, method, &Options::new(STEP), &mut attitude)?;
    Ok((solution, attitude))
}

/// The largest change of the spatial momentum `g mu` over a run.
fn change<M: Method<f64, BodySystem>>(method: M) -> Result<f64, Box<dyn Error>> {
    let (solution, attitude) = run(method, Chart::Matrix)?;
    let start = Body::<f64>::new().initial_state();
    let mut largest = 0.0_f64;
    for (mu, g) in solution.mu.iter().zip(attitude.rows()) {
        for i in 0..3 {
            let spatial: f64 = (0..3).map(|j| g[3 * i + j] * mu[j]).sum();
            largest = largest.max((spatial - start[i]).abs());
        }
    }
    Ok(largest)
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os().nth(1).map_or_else(
        || std::env::temp_dir().join("05_tumbling_body.svg"),
        PathBuf::from,
    );
    let exact = [
        ("moser-veselov", change(MoserVeselov::new())?),
        ("lie-midpoint", change(LieMidpoint::exp())?),
        ("splitting4", change(Splitting4::new())?),
        ("midpoint", change(ImplicitMidpoint::new())?),
    ];
    println!("largest change of the spatial momentum, {END} time units, step {STEP}");
    for (name, change) in exact {
        println!("{name:<16} {change:.1e}");
        assert!(change < 1e-13, "{name} keeps the spatial momentum");
    }
    let lost = change(Rk4::new())?;
    println!("{:<16} {lost:.1e}", "rk4");
    assert!(lost > 1e-8, "rk4 does not");

    let (solution, attitude) = run(MoserVeselov::new(), Chart::Quaternion)?;
    let signs = solution
        .mu
        .windows(2)
        .filter(|pair| pair[0][1] * pair[1][1] < 0.0);
    println!("the body turns over {} times", signs.count());
    let columns = ["t", "x", "y", "z", "energy", "norm2"];
    let mut plot = Plot::new(
        "A body tumbles about its intermediate axis",
        &columns,
        3,
        (0.0, END),
    )
    .subtitle(format!(
        "moser-veselov, h = {STEP}, attitude as a unit quaternion"
    ))
    .element(&["q0", "q1", "q2", "q3"]);
    for (row, q) in attitude.rows().iter().enumerate() {
        let mut numbers = vec![solution.t[row]];
        numbers.extend(solution.mu[row].iter());
        numbers.extend([solution.energy[row], solution.casimirs[row][0]]);
        numbers.extend(q);
        plot.push(&numbers);
    }
    plot.write_svg(&path)?;
    println!("The picture is in {}.", path.display());
    Ok(())
}
