//! The stepper of a method with a solver that runs its steps by traces, and makes the others kernel by kernel.

use super::followed::Followed;
use super::trace::{Taken, Trace};
use super::traces::Traces;
use crate::methods::Method;
use crate::system::Dynamic;
use lie_codegen::methods::Choice;
use lie_runtime::diagnostics::{AnyMethod, AnyStepper, Claims, Forgotten, ForgottenStepper};
use lie_runtime::methods::{FactorSink, Method as _, StepFailure, StepReport, Stepper};
use lie_runtime::newton::NewtonOptions;
use std::rc::Rc;
use std::sync::Arc;

/// So many steps at the beginning of a run are made kernel by kernel: one that has no more is not to wait for traces.
const BEGINNING: u32 = 4;

/// A method whose steps are run by traces.
pub struct TracedMethod {
    choice: Choice,
    claims: Claims,
    apart: Rc<Method<f64>>,
}

impl TracedMethod {
    /// The method of a choice, with what makes the steps that no trace is for.
    pub fn new(choice: &Choice, apart: Method<f64>) -> Self {
        Self {
            choice: choice.clone(),
            claims: apart.claims(),
            apart: Rc::new(apart),
        }
    }
}

impl AnyMethod<f64, Dynamic<f64>> for TracedMethod {
    fn claims(&self) -> Claims {
        self.claims
    }

    // for steps to be compiled where the method is asked for, which is optimised more
    #[inline]
    fn any_stepper<'a>(
        &self,
        system: &'a Dynamic<f64>,
        h: f64,
        newton: &NewtonOptions,
    ) -> Box<dyn AnyStepper<f64, Vec<f64>> + 'a> {
        match TracedStepper::new(&self.choice, system, h, newton, &self.apart) {
            Ok(mut stepper) => {
                stepper.followed.rest(BEGINNING);
                Box::new(stepper)
            }
            Err(apart) => Box::new(apart),
        }
    }
}

/// The stepper of a [`TracedMethod`].
pub(super) struct TracedStepper<'a> {
    choice: Choice,
    newton: NewtonOptions,
    known: Arc<Traces>,
    followed: Followed<'a, f64>,
    /// What makes the steps that no trace is for, kernel by kernel, and the method that it is of.
    apart: ForgottenStepper<'a, Vec<f64>>,
    method: Rc<Method<f64>>,
    /// Whether that has made the last step, so that it remembers what traces do not.
    is_ahead: bool,
    /// Whether its steps have another size by now.
    is_stale: bool,
}

impl<'a> TracedStepper<'a> {
    /// The stepper as it is where the system has no traces, or it does not show all that it remembers.
    pub fn new(
        choice: &Choice,
        system: &'a Dynamic<f64>,
        h: f64,
        newton: &NewtonOptions,
        method: &Rc<Method<f64>>,
    ) -> Result<Self, ForgottenStepper<'a, Vec<f64>>> {
        let mut apart = Forgotten(method.as_ref().as_ref()).stepper(system, h, newton);
        if !system.is_traced() {
            return Err(apart);
        }
        let mut memory = Vec::new();
        if !Stepper::carry(&mut apart, &mut |number| memory.push(*number)) {
            return Err(apart);
        }
        let known = system.traces(choice, newton);
        let mut followed = Followed::new(system, h, &memory);
        followed.take_from(&known);
        Ok(Self {
            choice: choice.clone(),
            newton: *newton,
            known,
            followed,
            apart,
            method: Rc::clone(method),
            is_ahead: false,
            is_stale: false,
        })
    }

    /// What is remembered, to be read and written.
    pub fn memory(&mut self) -> &mut [f64] {
        self.remember();
        self.followed.memory_mut()
    }

    /// Has the memory where traces take it from.
    #[inline]
    fn remember(&mut self) {
        if self.is_ahead {
            let mut places = self.followed.memory_mut().iter_mut();
            Stepper::carry(&mut self.apart, &mut |number| {
                if let Some(place) = places.next() {
                    *place = *number;
                }
            });
            self.is_ahead = false;
        }
    }

    /// The same, where the method takes it from.
    fn give_back(&mut self) {
        if !self.is_ahead {
            let mut places = self.followed.memory().iter();
            Stepper::carry(&mut self.apart, &mut |number| {
                if let Some(place) = places.next() {
                    *number = *place;
                }
            });
            self.is_ahead = true;
        }
    }

    /// Makes anew what makes steps kernel by kernel, where these have another size; what it remembers stays.
    fn renew(&mut self) {
        if self.is_stale {
            self.remember();
            let ([h], system) = (self.followed.h, self.followed.system);
            let method = self.method.as_ref().as_ref();
            self.apart = Forgotten(method).stepper(system, h, &self.newton);
            self.is_stale = false;
        }
    }

    /// A step by a trace, if there is one for it.
    #[inline]
    fn by_trace(&mut self, mu: &mut [f64]) -> Option<StepReport> {
        if self.followed.rests() {
            return None;
        }
        self.remember();
        let Self { choice, newton, .. } = self;
        self.followed.step(&self.known, mu, |followed, mu| {
            let ([h], from) = (followed.h, [mu, followed.memory()]);
            let wanted = (true, self.known.instructions());
            Trace::take(choice, followed.system, h, newton, from, wanted)
        })
    }

    /// A trace for lanes of the step of this system from a state with this memory, with so many instructions at most.
    pub fn trace_for_lanes(&self, state: &[f64], memory: &[f64], longest: usize) -> Taken {
        let ([h], system) = (self.followed.h, self.followed.system);
        let from = [state, memory];
        let wanted = (false, longest);
        Trace::take(&self.choice, system, h, &self.newton, from, wanted)
    }
}

impl Drop for TracedStepper<'_> {
    fn drop(&mut self) {
        self.known.count_steps(self.followed.steps());
    }
}

impl Stepper<f64> for TracedStepper<'_> {
    type State = Vec<f64>;

    fn step<K: FactorSink<Vec<f64>>>(
        &mut self,
        mu: &mut Vec<f64>,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        if !sink.is_active()
            && let Some(report) = self.by_trace(mu)
        {
            return Ok(report);
        }
        self.renew();
        self.give_back();
        Stepper::step(&mut self.apart, mu, sink)
    }

    fn set_step(&mut self, h: f64) -> bool {
        self.followed.set_step(h);
        self.is_stale = true;
        true
    }
}
