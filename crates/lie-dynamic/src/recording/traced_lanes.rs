//! Systems side by side by traces: where no trace is for all of them, each makes its step alone.

use super::followed::Followed;
use super::traced::TracedStepper;
use super::traces::Traces;
use crate::methods::Method;
use crate::system::Dynamic;
use lie_codegen::methods::Choice;
use lie_runtime::Scalar;
use lie_runtime::diagnostics::{AnyMethod, AnyStepper, Claims};
use lie_runtime::methods::{FactorSink, StepFailure, StepReport, Stepper};
use lie_runtime::newton::NewtonOptions;
use std::rc::Rc;
use std::sync::Arc;

type Wide = <f64 as Scalar>::Wide;

/// A method with a solver over systems side by side.
pub struct TracedInLanes {
    choice: Choice,
    alone: Rc<Method<f64>>,
}

impl TracedInLanes {
    /// The method of a choice, with what makes the steps of a system alone that no trace is for.
    pub fn new(choice: &Choice, alone: Method<f64>) -> Self {
        Self {
            choice: choice.clone(),
            alone: Rc::new(alone),
        }
    }
}

impl AnyMethod<Wide, Dynamic<Wide>> for TracedInLanes {
    fn claims(&self) -> Claims {
        self.alone.claims()
    }

    // for steps to be compiled where the method is asked for, which is optimised more
    #[inline]
    fn any_stepper<'a>(
        &self,
        system: &'a Dynamic<Wide>,
        h: Wide,
        newton: &NewtonOptions,
    ) -> Box<dyn AnyStepper<Wide, Vec<Wide>> + 'a> {
        let members = (0..).zip(system.members.iter());
        let mut members: Vec<TracedStepper<'a>> = members
            .filter_map(|(lane, member)| {
                let h = h.lane(lane);
                TracedStepper::new(&self.choice, member, h, newton, &self.alone).ok()
            })
            .collect();
        let makes_steps = !members.is_empty() && members.len() == system.members.len();
        assert!(makes_steps, "the system does not take lanes by this method");
        let memory = vec![Wide::zero(); members[0].memory().len()];
        let known = system.traces(&self.choice, newton);
        let mut followed = Followed::new(system, h, &memory);
        followed.take_from(&known);
        Box::new(TracedLanes {
            state: Vec::new(),
            known,
            followed,
            members,
            are_ahead: true,
        })
    }
}

/// The stepper of a [`TracedInLanes`].
struct TracedLanes<'a> {
    known: Arc<Traces>,
    followed: Followed<'a, Wide>,
    /// The systems alone, each in its lane; lanes beyond them have the first one.
    members: Vec<TracedStepper<'a>>,
    /// A state of one.
    state: Vec<f64>,
    /// Whether these have made the last step, so that they remember what all together do not.
    are_ahead: bool,
}

impl TracedLanes<'_> {
    /// Which system is in a lane.
    fn member(&self, lane: usize) -> usize {
        if lane < self.members.len() { lane } else { 0 }
    }

    /// Has the memory of all where traces take it from.
    #[inline]
    fn remember(&mut self) {
        if !self.are_ahead {
            return;
        }
        for lane in 0..Wide::LANES {
            let member = self.member(lane);
            let memory = self.members[member].memory().iter();
            for (all, one) in self.followed.memory_mut().iter_mut().zip(memory) {
                *all = all.with_lane(lane, *one);
            }
        }
        self.are_ahead = false;
    }

    /// The same, where each takes its own from.
    fn give_back(&mut self) {
        if self.are_ahead {
            return;
        }
        for (lane, member) in self.members.iter_mut().enumerate() {
            for (one, all) in member.memory().iter_mut().zip(self.followed.memory()) {
                *one = all.lane(lane);
            }
        }
        self.are_ahead = true;
    }

    /// A step of all by a trace, if there is one for it.
    #[inline]
    fn by_trace(&mut self, mu: &mut [Wide]) -> Option<StepReport> {
        if self.followed.rests() {
            return None;
        }
        self.remember();
        let (members, longest) = (&self.members, self.known.instructions());
        self.followed.step(&self.known, mu, |followed, mu| {
            let lane = followed.missed();
            let of_lane = |numbers: &[Wide]| -> Vec<f64> {
                numbers.iter().map(|number| number.lane(lane)).collect()
            };
            let member = members.get(lane).unwrap_or(&members[0]);
            member.trace_for_lanes(&of_lane(mu), &of_lane(followed.memory()), longest)
        })
    }

    /// The step of each alone.
    fn one_by_one(&mut self, mu: &mut [Wide]) -> Result<StepReport, StepFailure> {
        self.give_back();
        let (mut total, mut failure) = (StepReport::default(), None::<StepFailure>);
        for lane in 0..self.members.len() {
            self.state.clear();
            self.state.extend(mu.iter().map(|entry| entry.lane(lane)));
            let report = match Stepper::step(&mut self.members[lane], &mut self.state, &mut ()) {
                Ok(report) => report,
                Err(failed) => {
                    let first = StepFailure { lanes: 0, ..failed };
                    failure.get_or_insert(first).lanes |= 1 << lane;
                    continue;
                }
            };
            total = StepReport {
                iterations: total.iterations.max(report.iterations),
                evaluations: total.evaluations.max(report.evaluations),
                fixed_point: total.fixed_point.max(report.fixed_point),
                factorizations: total.factorizations.max(report.factorizations),
                residual: Scalar::max(total.residual, report.residual),
                ..report
            };
            let last = self.members.len() - 1;
            for (entry, value) in mu.iter_mut().zip(&self.state) {
                *entry = entry.with_lane(lane, *value);
                if lane == 0 {
                    for other in last + 1..Wide::LANES {
                        *entry = entry.with_lane(other, *value);
                    }
                }
            }
        }
        failure.map_or(Ok(total), Err)
    }
}

impl Drop for TracedLanes<'_> {
    fn drop(&mut self) {
        self.known.count_steps(self.followed.steps());
    }
}

impl Stepper<Wide> for TracedLanes<'_> {
    type State = Vec<Wide>;

    fn step<K: FactorSink<Vec<Wide>>>(
        &mut self,
        mu: &mut Vec<Wide>,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        assert!(
            !sink.is_active(),
            "systems side by side show no motion on the group"
        );
        match self.by_trace(mu) {
            Some(report) => Ok(report),
            None => self.one_by_one(mu),
        }
    }
}
