//! Members that take turns in lanes, where each chooses its own steps: as soon as one is at its end, the next has its lane.

use std::ops::Range;

use lie_codegen::methods::Choice;
use lie_dynamic::{Dynamic, Method, Tolerances};
use lie_methods::method_in_lanes;
use lie_runtime::diagnostics::Forgotten;
use lie_runtime::driver::pace::choose;
use lie_runtime::driver::{Crew, Pace, Problem, Save, relay};
use lie_runtime::{Poisson, Scalar};

use super::{LANES, LEAST, Member, Wide, Worker};

impl Worker<'_> {
    /// Runs members from the first on that have the same parameters, where they can take turns: each as it is alone, and those that are to be run
    /// alone as nothing.
    pub(super) fn in_turns(&self, members: Range<usize>) -> Option<Vec<Option<Member>>> {
        let method = self.turns.as_ref()?;
        let first = members.start;
        let parameters = self.members.parameters(first);
        let same = |member: &usize| self.members.parameters(*member) == parameters;
        let members = first..first + members.take_while(same).count();
        if members.len() < LEAST {
            return None;
        }
        let systems = self.members.systems(first..first + 1);
        let system = systems.first()?.as_ref().ok()?;
        let starts = &self.members.starts[members.clone()];
        let dimension = Poisson::<f64>::dimension(system);
        let held = Poisson::<f64>::input_count(system) + Poisson::<f64>::noise_count(system);
        let suits = system.takes_lanes(self.members.choice)
            && held == 0
            && !self.members.await_events(system);
        if !suits || starts.iter().any(|start| start.len() != dimension) {
            return None;
        }
        let lanes = Dynamic::in_lanes(&[system]);
        let mut turns = Turns {
            worker: self,
            system,
            starts,
            next: 0,
            lanes: std::array::from_fn(|_| (0, Member::default())),
            found: vec![None; members.len()],
        };
        let run = (self.members.span, &self.members.options);
        let done = relay(&lanes, &Forgotten(method.as_ref()), run, &mut turns);
        // options that suit no member are refused by a run alone
        done.unwrap_or(false).then_some(turns.found)
    }
}

/// Members that take turns.
struct Turns<'a> {
    worker: &'a Worker<'a>,
    system: &'a Dynamic<f64>,
    starts: &'a [Vec<f64>],
    next: usize,
    /// Who is in each lane, and its rows so far.
    lanes: [(usize, Member); LANES],
    found: Vec<Option<Member>>,
}

impl Turns<'_> {
    /// The step of a member; not a number where none can be chosen.
    fn step(&self, start: &[f64]) -> f64 {
        let members = self.worker.members;
        match members.options.pace {
            Pace::Step(step) => step,
            Pace::Tolerance(tolerance) => {
                let problem = Problem {
                    system: self.system.clone(),
                    mu0: start.to_vec(),
                    span: members.span,
                };
                let method = Forgotten(self.worker.alone.as_ref());
                let newton = &members.options.newton;
                let chosen = choose(&problem, &method, tolerance, newton);
                chosen.map_or(f64::NAN, |chosen| chosen.step)
            }
        }
    }
}

impl Crew<Wide, Vec<Wide>> for Turns<'_> {
    fn enter(&mut self, lane: usize, mu: &mut Vec<Wide>) -> Option<f64> {
        let member = self.next;
        let start = self.starts.get(member)?;
        self.next += 1;
        self.lanes[lane] = (member, Member::default());
        for (entry, value) in mu.iter_mut().zip(start) {
            *entry = entry.with_lane(lane, *value);
        }
        Some(self.step(start))
    }

    fn row(&mut self, lane: usize, time: f64, mu: &Vec<Wide>) {
        let Member { times, states, .. } = &mut self.lanes[lane].1;
        if self.worker.members.options.save == Save::Ends {
            times.clear();
            states.clear();
        }
        if times.try_reserve(1).is_err() || states.try_reserve(mu.len()).is_err() {
            self.worker.watch.is_full();
            return;
        }
        times.push(time);
        states.extend(mu.iter().map(|entry| entry.lane(lane)));
    }

    fn leave(&mut self, lane: usize, is_at_end: bool) {
        let (member, rows) = std::mem::take(&mut self.lanes[lane]);
        if is_at_end {
            self.found[member] = Some(rows);
            self.worker.watch.done(1);
        }
    }

    fn stops(&self) -> bool {
        self.worker.watch.stopped()
    }
}

/// The method in lanes of members that take turns by it.
pub(super) fn method_in_turns(choice: &Choice, tolerances: Tolerances) -> Option<Method<Wide>> {
    method_in_lanes(choice, tolerances).filter(|method| method.claims().own_steps)
}

/// Whether members take turns by a method.
pub fn take_turns(choice: &Choice, tolerances: Tolerances) -> bool {
    method_in_turns(choice, tolerances).is_some()
}
