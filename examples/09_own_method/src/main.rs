//! A method of one's own on so(3) and on se(3): stated once in `trapezoid.rs`, it runs on every system; the build script
//! has it fused with these two.
//!
//! `own-method` compares both forms; `own-method so3 generic 100000` takes so many steps with one of them (`so3` or `se3`,
//! `generic` or `fused`), for a profiler.

use lie_core::Equation;
use lie_core::methods::{ImplicitStepper, Stepper};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::{Implicit, State};
use std::error::Error;
use trapezoid::{Trapezoid, TrapezoidEquation};

mod trapezoid;

/// The free rigid body on so(3)*, with the method fused.
#[allow(dead_code)]
mod body {
    include!(concat!(env!("OUT_DIR"), "/so3_free_rigid_body.rs"));
}
/// The heavy top on se(3)*, with the method fused.
#[allow(dead_code)]
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

/// Steps with one of the forms.
fn profile<P: Implicit<f64, Trapezoid>>(
    system: &P,
    start: &P::State,
    form: &str,
    steps: usize,
) -> Result<(), Box<dyn Error>> {
    let end = match form {
        "generic" => run(TrapezoidEquation::new(system, STEP), start, steps)?,
        "fused" => run(system.equation(&Trapezoid, STEP), start, steps)?,
        other => return Err(format!("`{other}`: take `generic` or `fused`").into()),
    };
    println!("{:?}", end.as_slice());
    Ok(())
}

fn main() -> Result<(), Box<dyn Error>> {
    let (body, top) = (body::FreeRigidBody::new(), top::HeavyTop::new());
    let (body_start, top_start) = (body.initial_state(), top.initial_state());
    let (body, top) = (body.system()?, top.system()?);
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments.as_slice() {
        [] => {
            compare(&body, &body_start)?;
            compare(&top, &top_start)
        }
        ["so3", form, steps] => profile(&body, &body_start, form, steps.parse()?),
        ["se3", form, steps] => profile(&top, &top_start, form, steps.parse()?),
        _ => Err("usage: own-method [so3|se3 generic|fused STEPS]".into()),
    }
}
