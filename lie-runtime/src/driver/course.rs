//! The loop over the grid.

use super::checks::{check_domain, check_start, smaller};
use super::error::StepError;
use super::grid::{Grid, Place, Rows};
use super::joints::Joints;
use super::milestone::{MILESTONE, Milestone, gradient};
use super::observer::{MotionSink, Observer, Progress};
use super::options::Save;
use super::problem::set_time;
use super::solve::IntegrateError;
use super::stats::{Stats, Status};
use super::trial::Trial;
use super::watch::{Guard, JACOBIAN, SLOW_PARTS, divided};
use crate::methods::{Method, StepFailure, StepReport, Stepper};
use crate::newton::{FailureReason, NewtonOptions};
use crate::poisson::Poisson;
use crate::scalar::Scalar;
use crate::state::State;
use core::iter::Peekable;

/// Why a stepper was left.
enum Left<P> {
    /// The run is at its end, or was ended.
    Over(Status),
    /// The system has another branch.
    Branch(P),
    /// Steps have another size.
    Divided,
    /// The run can be taken up from here.
    Milestone,
}

/// Steps that divided ones may come to in all, unless the grid itself has an eighth of as many.
const MOST_DIVIDED: u64 = 1 << 18;

/// How far a run has come.
pub(super) struct Course<'r, M> {
    pub(super) grid: &'r Grid,
    pub(super) method: &'r M,
    pub(super) newton: NewtonOptions,
    pub(super) stats: Stats,
    /// Steps done.
    pub(super) index: u64,
    /// The next milestone.
    pub(super) milestone: u64,
    /// The step of the grid.
    pub(super) step: f64,
    /// In so many parts each is made.
    pub(super) parts: u32,
    /// Parts done of the step that is being made.
    done: u32,
    /// Whether a step may be divided.
    pub(super) divides: bool,
    /// Jacobians that were factored, and steps since the last division for which some were.
    pub(super) slow: (u64, u64),
    /// The run stops after so many steps, their parts counted, failed ones included.
    most: u64,
}

impl<'r, M> Course<'r, M> {
    /// Whether steps of a method may be divided: of one trajectory, and those that it does not choose itself.
    pub(super) fn may_divide<S: Scalar, P: Poisson<S>>(method: &M) -> bool
    where
        M: Method<S, P>,
    {
        !method.own_steps() && S::LANES == 1
    }

    /// In how many parts the last steps were made.
    pub(super) fn parts(&self) -> u32 {
        self.parts
    }

    /// Divides steps where need be.
    pub(super) fn dividing(mut self, divides: bool) -> Self {
        self.divides = divides;
        self
    }

    /// Has milestones, if they are wanted.
    pub(super) fn with_milestones(mut self, wanted: bool) -> Self {
        self.milestone = if wanted { MILESTONE } else { u64::MAX };
        self
    }

    /// Stops after so many steps, their parts counted.
    pub(super) fn at_most(mut self, steps: u64) -> Self {
        self.most = steps;
        self
    }

    /// At the start of a grid, with its whole steps.
    pub(super) fn new(grid: &'r Grid, method: &'r M, newton: NewtonOptions, step: f64) -> Self {
        Self {
            grid,
            method,
            newton,
            stats: Stats::default(),
            index: 0,
            milestone: u64::MAX,
            step,
            parts: 1,
            done: 0,
            divides: false,
            slow: (0, 0),
            most: u64::MAX,
        }
    }

    /// Goes along the grid, from a milestone if there is one; the state at its end.
    pub(super) fn run<S: Scalar, P: Poisson<S>>(
        &mut self,
        system: &P,
        mut mu: P::State,
        taken_up: Option<&Milestone<P::State>>,
        mut guard: Option<Guard<'_, S, P, M>>,
        save: &Save,
        observer: &mut impl Observer<S, P>,
    ) -> Result<(P::State, Status), IntegrateError>
    where
        M: Method<S, P>,
    {
        let first = system;
        let mut followed = match taken_up {
            Some(milestone) => {
                self.take_up(system, milestone, guard.as_mut())?;
                mu.copy_from(&milestone.mu);
                let branch = milestone.branch.as_ref();
                branch.and_then(|gradient| system.on_branch(gradient))
            }
            None => system.following(&mu),
        };
        let mut rows = self.grid.rows(save)?.from(self.index).peekable();
        while rows.next_if(|row| row.place.index() < self.index).is_some() {}
        let mut between = mu.clone();
        let system = followed.as_ref().unwrap_or(first);
        if taken_up.is_none() {
            check_start(system, &mu).map_err(|failure| self.failed(failure))?;
        }
        observer.start(system, self.progress(), &mu);
        // once, and again with each branch of the system that has to be followed, each size of steps, and from each milestone
        loop {
            let system = followed.as_ref().unwrap_or(first);
            let mut states = (&mut mu, &mut between);
            match self.go(system, &mut states, &mut rows, &mut guard, observer)? {
                Left::Over(status) => return Ok((mu, status)),
                Left::Branch(next) => followed = Some(next),
                Left::Divided => {}
                Left::Milestone => {
                    self.milestone += MILESTONE;
                    let branch = followed.as_ref().map(|system| gradient(system, &mu));
                    let from = branch.as_ref().and_then(|point| first.on_branch(point));
                    followed = from.or(followed);
                    let system = followed.as_ref().unwrap_or(first);
                    let milestone = self.milestone(&mu, branch, guard.as_ref());
                    observer.milestone(system, &milestone);
                }
            }
        }
    }

    /// Goes on with one system and one size of steps.
    #[inline(always)]
    fn go<S: Scalar, P: Poisson<S>, O: Observer<S, P>>(
        &mut self,
        system: &P,
        (mu, between): &mut (&mut P::State, &mut P::State),
        rows: &mut Peekable<Rows<'_>>,
        guard: &mut Option<Guard<'_, S, P, M>>,
        observer: &mut O,
    ) -> Result<Left<P>, IntegrateError>
    where
        M: Method<S, P>,
    {
        let size = S::from_f64(self.step / f64::from(self.parts));
        let newton = match self.divides_rather(1) {
            true => Trial::<S, P, M>::cheap(self.method, self.newton),
            false => self.newton,
        };
        let mut stepper = self.method.stepper(system, size, &newton);
        let mut joints = Joints::of(system);
        loop {
            if self.index == self.milestone && self.done == 0 {
                return Ok(Left::Milestone);
            }
            while let Some(row) =
                rows.next_if(|row| row.place.index() == self.index && self.done == 0)
            {
                let looked = match row.place {
                    Place::On(_) => observer.row(system, row.time, mu),
                    Place::After(..) => {
                        between.copy_from(mu);
                        self.off_grid(system, joints.as_mut(), row.time, between, observer)?;
                        let looked = observer.row(system, row.time, between);
                        observer.return_to_grid();
                        looked
                    }
                };
                if looked.is_break() {
                    return Ok(Left::Over(Status::Stopped));
                }
            }
            if self.index == self.grid.steps() {
                return Ok(Left::Over(Status::Finished));
            }
            let watched = self.done == 0 && guard.as_mut().is_some_and(|guard| guard.begins(mu));
            let pieces = joints.as_mut().filter(|_| self.done == 0).map(|joints| {
                let times = [self.index, self.index + 1].map(|index| self.grid.time(index));
                joints.pieces(system, times.into())
            });
            if let Some(pieces) = pieces.filter(|pieces| !pieces.is_empty()) {
                self.in_pieces(system, pieces, mu, observer)?;
                self.done = self.parts;
            }
            while self.done < self.parts {
                if self.stats.steps + self.stats.failures >= self.most {
                    return Ok(Left::Over(Status::Stopped));
                }
                match stepper.step(mu, &mut MotionSink::new(observer, system)) {
                    Ok(report) => {
                        set_time(system, mu, self.next_time());
                        self.arrived(system, mu, report)?;
                    }
                    Err(failure) => return self.divided(system, failure, mu),
                }
                self.done += 1;
                if self.method.fixed_point() && self.divides && self.is_slow() {
                    return Ok(Left::Divided);
                }
            }
            self.done = 0;
            if let Some(guard) = guard.as_mut().filter(|_| watched) {
                let parts = guard.parts(system, (self.step, self.parts), mu);
                if parts > self.parts && self.may_come_to(parts) {
                    self.parts = parts;
                    observer.divided(self.progress(), parts);
                    // what has been shown of the motion on the group stays
                    if !O::MOTION {
                        mu.copy_from(guard.before());
                        return Ok(Left::Divided);
                    }
                    stepper = self.method.stepper(
                        system,
                        S::from_f64(self.step / f64::from(parts)),
                        &newton,
                    );
                }
            }
            self.index += 1;
            let looked = observer.step(system, self.progress(), mu);
            if looked.is_break() {
                return Ok(Left::Over(Status::Stopped));
            }
            if let Some(next) = system.following(mu) {
                return Ok(Left::Branch(next));
            }
        }
    }

    /// The time at the end of the part that is being made of a step.
    fn next_time(&self) -> f64 {
        let done = self.done + 1;
        if done == self.parts {
            return self.grid.time(self.index + 1);
        }
        let part = self.step * (f64::from(done) / f64::from(self.parts));
        self.grid.time(self.index) + part
    }

    /// Whether all steps that are left may be made in so many parts: a joint or a singularity asks for parts without end.
    fn may_come_to(&self, parts: u32) -> bool {
        let left = (self.grid.steps() - self.index).saturating_mul(u64::from(parts));
        left <= self.grid.steps().saturating_mul(8).max(MOST_DIVIDED)
    }

    /// Whether to divide all steps that are left costs less than some that need Jacobians.
    fn divides_rather(&self, slow: u64) -> bool {
        let left = (self.grid.steps() - self.index).saturating_mul(u64::from(self.parts));
        self.divides && self.parts < SLOW_PARTS && left < slow.saturating_mul(JACOBIAN)
    }

    /// Divides the steps, where too many did not contract.
    fn is_slow(&mut self) -> bool {
        let slow = self.stats.factorizations > self.slow.0;
        self.slow.0 = self.stats.factorizations;
        self.slow.1 += u64::from(slow);
        if !slow || !self.divides_rather(self.slow.1) {
            return false;
        }
        self.slow.1 = 0;
        (self.parts, self.done) = (2 * self.parts, 2 * self.done);
        true
    }

    /// Goes on in smaller steps after one that failed, where that may be.
    #[cold]
    fn divided<S: Scalar, P: Poisson<S>>(
        &mut self,
        system: &P,
        failure: StepFailure,
        mu: &P::State,
    ) -> Result<Left<P>, IntegrateError>
    where
        M: Method<S, P>,
    {
        let next = divided(self.parts).filter(|&parts| self.divides && self.may_come_to(parts));
        let Some(parts) = next else {
            let size = self.step / f64::from(self.parts);
            return Err(self.stopped(system, failure, size, mu));
        };
        self.stats.add_failure(&failure.report);
        self.done *= parts / self.parts;
        self.parts = parts;
        Ok(Left::Divided)
    }

    fn progress(&self) -> Progress {
        Progress {
            step: self.index,
            steps: self.grid.steps(),
            time: self.grid.time(self.index),
        }
    }

    /// The error of the step that comes next.
    fn failed(&self, failure: StepFailure) -> Box<StepError> {
        let mut stats = self.stats;
        stats.add_failure(&failure.report);
        Box::new(StepError {
            step: self.index + 1,
            time: self.grid.time(self.index),
            failure,
            stats,
            works: None,
        })
    }

    /// The same of a step of h from a state: where it left its chart, with one that does not.
    pub(super) fn stopped<S: Scalar, P: Poisson<S>>(
        &self,
        system: &P,
        failure: StepFailure,
        h: f64,
        mu: &P::State,
    ) -> IntegrateError
    where
        M: Method<S, P>,
    {
        let left = failure.reason == FailureReason::OutsideChart;
        let works = left.then(|| smaller(system, self.method, &self.newton, h, mu));
        let error = StepError {
            works: works.flatten(),
            ..*self.failed(failure)
        };
        IntegrateError::from(Box::new(error))
    }

    /// Counts a step that ended at a state.
    pub(super) fn arrived<S: Scalar, P: Poisson<S>>(
        &mut self,
        system: &P,
        mu: &P::State,
        report: StepReport,
    ) -> Result<(), Box<StepError>> {
        check_domain(system, mu, report).map_err(|failure| self.failed(failure))?;
        self.stats.add(&report);
        Ok(())
    }
}
