//! A method of one's own on so(3) and on se(3): stated once in `trapezoid.rs`, it runs on every system; the build script
//! has it fused with these two.
//!
//! `own-method` compares both forms; `own-method generic 100000` and `own-method fused 100000` take so many steps of
//! the heavy top, for a profiler.

use lie_core::Equation;
use lie_core::methods::{ImplicitStepper, Stepper};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::{Implicit, State};
use std::error::Error;
use trapezoid::{Trapezoid, TrapezoidEquation};

mod trapezoid;

/// The free rigid body on so(3)*, with the method fused.
mod body {
    include!(concat!(env!("OUT_DIR"), "/so3_free_rigid_body.rs"));
}
/// The heavy top on se(3)*, with the method fused.
mod top {
    include!(concat!(env!("OUT_DIR"), "/se3_heavy_top.rs"));
}

const STEP: f64 = 0.01;

/// The state after some steps with an equation.
fn run<E: Equation<f64>>(
    equation: E,
    start: &E::State,
    steps: usize,
) -> Result<E::State, Box<dyn Error>> {
    let mut stepper = ImplicitStepper::new(equation, start.clone(), &NewtonOptions::default());
    let mut mu = start.clone();
    for _ in 0..steps {
        stepper.step(&mut mu, &mut ())?;
    }
    Ok(mu)
}

fn compare<P: Implicit<f64, Trapezoid>>(
    system: &P,
    start: &P::State,
) -> Result<(), Box<dyn Error>> {
    let generic = run(TrapezoidEquation::new(system, STEP), start, 1000)?;
    let fused = run(system.equation(&Trapezoid, STEP), start, 1000)?;
    let pairs = generic.as_slice().iter().zip(fused.as_slice());
    let distance = pairs.fold(0.0, |largest, (a, b)| f64::max(largest, (a - b).abs()));
    let drift = system.hamiltonian(&fused) - system.hamiltonian(start);
    println!(
        "{}: generic and fused differ by {distance:.1e} after 1000 steps; energy error {drift:.1e}",
        system.name()
    );
    if distance > 1e-12 {
        return Err("the forms are two methods".into());
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let (body, top) = (body::FreeRigidBody::new(), top::HeavyTop::new());
    let (start, system) = (top.initial_state(), top.system()?);
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [form, steps] = arguments.as_slice() {
        let steps = steps.parse()?;
        let end = match form.as_str() {
            "generic" => run(TrapezoidEquation::new(&system, STEP), &start, steps)?,
            "fused" => run(system.equation(&Trapezoid, STEP), &start, steps)?,
            other => return Err(format!("`{other}`: take `generic` or `fused`").into()),
        };
        println!("{:?}", end.as_slice());
        return Ok(());
    }
    compare(&body.system()?, &body.initial_state())?;
    compare(&system, &start)
}
