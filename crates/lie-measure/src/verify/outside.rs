//! Whether the driver stops where a step ends outside the domain of H.

use crate::facts::Ground;
use core::marker::PhantomData;
use lie_runtime::driver::{IntegrateError, Options, Problem, Save, integrate};
use lie_runtime::methods::{
    FactorSink, Facts, Method, Preserves, StepFailure, StepReport, Stepper,
};
use lie_runtime::newton::{FailureReason, NewtonOptions};
use lie_runtime::poisson::{Lift, Poisson};
use lie_runtime::state::State;

/// A method whose every step ends where nothing is a number, and which says that all is well.
struct Leap;

struct LeapStepper<V>(PhantomData<V>);

impl Facts for Leap {
    const ID: &'static str = "";
    const ORDER: u32 = 0;
    const SYMMETRIC: bool = false;
    const EXPLICIT: bool = true;
    const PRESERVES: Preserves = Preserves::NOTHING;
}

impl<P: Poisson<f64>> Method<f64, P> for Leap {
    type Stepper<'a>
        = LeapStepper<P::State>
    where
        P: 'a;

    fn stepper<'a>(&self, _system: &'a P, _h: f64, _newton: &NewtonOptions) -> Self::Stepper<'a> {
        LeapStepper(PhantomData)
    }
}

impl<V: State<f64>> Stepper<f64> for LeapStepper<V> {
    type State = V;

    fn step<K: FactorSink<V>>(
        &mut self,
        mu: &mut V,
        _sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        mu.fill(f64::NAN);
        Ok(StepReport::default())
    }
}

/// Whether a run with such a method ends at its first step, on the grid and off it; where H is a polynomial the driver
/// does not look.
pub(super) fn is_refused<P: Lift<f64> + Clone>(system: &P, ground: &Ground<P>) -> bool {
    if system.hamiltonian_degree().is_some() {
        return true;
    }
    let h = ground.step;
    let problem = Problem {
        system: system.clone(),
        mu0: ground.states[0].clone(),
        span: (0.0, 2.0 * h),
    };
    [Save::Every(1), Save::At(vec![0.5 * h])]
        .into_iter()
        .all(|save| {
            let options = Options::new(h).save(save);
            match integrate(&problem, Leap, &options, &mut ()) {
                Err(IntegrateError::Step(error)) => {
                    error.failure.reason == FailureReason::OutsideDomain && error.step == 1
                }
                _ => false,
            }
        })
}
