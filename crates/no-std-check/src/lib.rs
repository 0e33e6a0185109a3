//! The free rigid body stepped without std and without an allocator.
#![no_std]
#![forbid(unsafe_code)]

#[path = "../../../lie-runtime/tests/systems/rigid_body.rs"]
mod rigid_body;

use core::panic::PanicInfo;
use lie_runtime::methods::{
    Dopri5, FactorSink, Gauss4, Gauss6, ImplicitMidpoint, LieMidpoint, Method, Retraction, Rk4,
    StepFailure, Stepper,
};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::scalar::{Dual, F64x8, Scalar};
use nalgebra::SVector;
use rigid_body::RigidBody;

#[panic_handler]
fn panic(_info: &PanicInfo<'_>) -> ! {
    loop {}
}

/// Adds up the group factors.
struct Total<S>(SVector<S, 3>);

impl<S: Scalar> FactorSink<SVector<S, 3>> for Total<S> {
    fn push(&mut self, _retraction: Retraction, xi: &SVector<S, 3>) {
        for (total, &entry) in self.0.iter_mut().zip(xi.iter()) {
            *total += entry;
        }
    }
}

fn step<S: Scalar, M: Method<S, RigidBody<S>>>(
    method: &M,
    mu: &mut SVector<S, 3>,
) -> Result<(), StepFailure> {
    let system = RigidBody::default();
    let mut stepper = method.stepper(&system, S::ratio(1.0, 10.0), &NewtonOptions::default());
    stepper.step(mu, &mut Total(SVector::repeat(S::zero())))?;
    Ok(())
}

fn steps<S: Scalar>(mu: &mut SVector<S, 3>) -> Result<(), StepFailure> {
    step(&ImplicitMidpoint, mu)?;
    step(&Gauss4, mu)?;
    step(&Gauss6, mu)?;
    step(&LieMidpoint::exp(), mu)?;
    step(&LieMidpoint::cayley(), mu)?;
    step(&Rk4, mu)?;
    step(&Dopri5::default(), mu)
}

/// One step of every method in f64, f32, lanes and dual numbers; false if one fails.
pub extern "C" fn every_method(x: f64, y: f64, z: f64) -> bool {
    let start = [x, y, z];
    steps::<f64>(&mut SVector::from(start)).is_ok()
        && steps::<f32>(&mut SVector::from(start.map(f32::from_f64))).is_ok()
        && steps::<F64x8>(&mut SVector::from(start.map(F64x8::from_f64))).is_ok()
        && steps::<Dual<f64>>(&mut SVector::from(start.map(Dual::from_f64))).is_ok()
}

/// Keeps the function in the library without an exported name.
#[used]
static ENTRY: extern "C" fn(f64, f64, f64) -> bool = every_method;
