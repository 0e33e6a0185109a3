//! The loop over the grid.

use super::by_stages::Begun;
use super::checks::check_start;
use super::curve::Curve;
use super::density::{Control, Density, Growth};
use super::events::{Ahead, Events};
use super::grid::{Grid, Place};
use super::joints::Joints;
use super::kept::Kept;
use super::milestone::{MILESTONE, Milestone, gradient};
use super::observer::{MotionSink, Observer};
use super::options::Save;
use super::problem::set_time;
use super::rows::Rows;
use super::solve::IntegrateError;
use super::stats::{Stats, Status};
use super::watch::{Change, From, Guard, Verdict};
use crate::newton::NewtonOptions;
use crate::poisson::Poisson;
use crate::scalar::Scalar;
use crate::state::State;

/// What is shown of a run: its rows, the states between them, its events.
type Shown<'a, V> = (
    &'a mut Rows,
    &'a mut Option<Curve<V>>,
    &'a mut Option<Events<V>>,
);

/// Why a stepper was left.
pub(super) enum Left<P> {
    /// The run is at its end, or was ended.
    Over(Status),
    /// The system has another branch.
    Branch(P),
    /// Steps have another size.
    Divided,
    /// The run can be taken up from here.
    Milestone,
}

/// Where a run begins.
pub(super) enum Beginning<'m, 's, S: Scalar, P: Poisson<S>> {
    /// At its start.
    Start,
    /// With a first step that is made.
    Step(Begun<'s, S, P>),
    /// Where another was.
    Milestone(&'m Milestone<P::State>),
}

/// How far a run has come.
pub(super) struct Course<'r, S: Scalar, P: Poisson<S>> {
    pub(super) grid: Grid,
    pub(super) method: &'r Kept<'r, S, P>,
    pub(super) newton: NewtonOptions,
    pub(super) stats: Stats,
    /// Steps done.
    pub(super) index: u64,
    /// The next milestone.
    pub(super) milestone: u64,
    /// The step at the start, and how many of them there were to be.
    pub(super) step: f64,
    pub(super) planned: u64,
    /// The time of the last row.
    pub(super) shown: Option<f64>,
    /// In so many parts each is made.
    pub(super) parts: u32,
    /// Parts done of the step that is being made.
    pub(super) done: u32,
    /// Whether a step may be divided.
    pub(super) divides: bool,
    /// Whether the observer sees the motion on the group.
    pub(super) shows_motion: bool,
    /// Whether the stages of steps tell their errors: the grid changes then, by small factors, where parts would be halves.
    pub(super) by_stages: bool,
    /// Jacobians that were factored, and steps since the last division for which some were.
    pub(super) slow: (u64, u64),
    /// Whether steps follow the motion, and what says their size then.
    pub(super) follows: bool,
    pub(super) control: Option<Control>,
}

impl<'r, S: Scalar, P: Poisson<S>> Course<'r, S, P> {
    /// Has steps follow the motion.
    pub(super) fn following(mut self, density: Density) -> Self {
        self.follows = density == Density::Reversible;
        self
    }

    /// Has milestones, if they are wanted.
    pub(super) fn with_milestones(mut self, wanted: bool) -> Self {
        self.milestone = if wanted { MILESTONE } else { u64::MAX };
        self
    }

    /// At the start of a grid, with its whole steps.
    pub(super) fn new(grid: Grid, method: &'r Kept<'r, S, P>, newton: NewtonOptions) -> Self {
        Self {
            grid,
            method,
            newton,
            stats: Stats::default(),
            index: 0,
            milestone: u64::MAX,
            step: grid.step(),
            planned: grid.steps(),
            shown: None,
            parts: 1,
            done: 0,
            divides: false,
            shows_motion: false,
            by_stages: false,
            slow: (0, 0),
            follows: false,
            control: None,
        }
    }

    /// Shows the motion of a step to the observer, if it wants to see it.
    pub(super) fn motion<'o>(
        &self,
        system: &'o P,
        observer: &'o mut dyn Observer<S, P>,
    ) -> MotionSink<'o, S, P> {
        MotionSink {
            system,
            observer,
            active: self.shows_motion,
        }
    }

    /// Goes along the grid, from a milestone if there is one, or with a first step that is made; the state at its end.
    pub(super) fn run<'s>(
        &mut self,
        system: &'s P,
        mut mu: P::State,
        beginning: Beginning<'_, 's, S, P>,
        mut guard: Option<Guard<'_, S, P>>,
        save: &Save,
        observer: &mut dyn Observer<S, P>,
    ) -> Result<(P::State, Status), IntegrateError> {
        let first = system;
        self.by_stages = guard.as_ref().is_some_and(Guard::is_by_stages);
        self.shows_motion = observer.follows_motion();
        let (taken_up, begun) = match beginning {
            Beginning::Milestone(milestone) => (Some(milestone), None),
            // what it has shown of the motion on the group is gone
            Beginning::Step(begun) if !self.shows_motion => (None, Some(begun)),
            Beginning::Step(_) | Beginning::Start => (None, None),
        };
        let mut followed = match taken_up {
            Some(milestone) => {
                self.take_up(system, milestone, guard.as_mut())?;
                mu.copy_from(&milestone.mu);
                let branch = milestone.branch.as_ref();
                branch.and_then(|gradient| system.on_branch(gradient))
            }
            None => system.following(&mu),
        };
        let system = followed.as_ref().unwrap_or(first);
        if taken_up.is_none() {
            check_start(system, &mu).map_err(|failure| self.failed(failure))?;
            if self.follows {
                self.begin_control(system, &mu)?;
            }
        }
        let (mut grid, mut rows) = (self.grid, self.rows_left(save)?);
        let mut size = self.size();
        let mut between = mu.clone();
        observer.start(system, self.progress(), &mu);
        let mut begun = begun.filter(|_| followed.is_none());
        let mut events = match observer.awaits_events() {
            true => Events::of(system),
            false => None,
        };
        let mut curve = match observer.draws() {
            true => Curve::along(system, &self.grid, self.shows_motion),
            false => None,
        };
        // once, and again with each branch of the system that has to be followed, each size of steps, and from each milestone
        loop {
            let mut states = (&mut mu, &mut between);
            let shown = (&mut rows, &mut curve, &mut events);
            let left = match begun.take() {
                Some(begun) => {
                    self.go(first, Some(begun), &mut states, shown, &mut guard, observer)
                }
                None => {
                    let system = followed.as_ref().unwrap_or(first);
                    self.go(system, None, &mut states, shown, &mut guard, observer)
                }
            };
            let left = left?;
            if self.size() != size && !self.follows {
                size = self.size();
                observer.shortened(self.progress(), size);
            }
            if self.grid != grid && !self.follows {
                (grid, rows) = (self.grid, self.rows_left(save)?);
            }
            match left {
                Left::Over(status) => {
                    if let Some(factor) = guard.as_ref().and_then(Guard::uneven) {
                        observer.uneven(factor);
                    }
                    return Ok((mu, status));
                }
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

    /// Goes on with one system and one size of steps, the first of which may be made.
    fn go<'s>(
        &mut self,
        system: &'s P,
        begun: Option<Begun<'s, S, P>>,
        (mu, between): &mut (&mut P::State, &mut P::State),
        (rows, curve, events): Shown<'_, P::State>,
        guard: &mut Option<Guard<'_, S, P>>,
        observer: &mut dyn Observer<S, P>,
    ) -> Result<Left<P>, IntegrateError> {
        let size = S::from_f64(self.size());
        let newton = match self.divides_rather(1) {
            true => self.method.cheap(self.newton),
            false => self.newton,
        };
        let (mut stepper, mut made) = match begun {
            Some(begun) => (begun.stepper, Some(Ok((begun.end, begun.report)))),
            None => (self.method.stepper(system, size, &newton), None),
        };
        let mut joints = Joints::of(system);
        let mut growth = self.follows.then(|| Growth::new(system));
        loop {
            if self.index == self.milestone && self.done == 0 {
                return Ok(Left::Milestone);
            }
            if self.done == 0 {
                let step = (self.index, self.grid.time(self.index), self.grid.step());
                observer.hold(system, step, mu, &[]);
            }
            if let Some(curve) = curve.as_mut().filter(|_| self.done == 0) {
                let is_row = rows.peek().map(|row| row.place) == Some(Place::On(self.index));
                curve.arrive(system, (&self.grid, self.index), mu, is_row);
            }
            let mut ahead = match events {
                Some(events) if self.done == 0 => {
                    let first = (&mut stepper, &mut made);
                    self.look_ahead(system, joints.as_mut(), events, mu, first, observer)?
                }
                _ => None,
            };
            let stop = ahead.as_ref().and_then(Ahead::stop);
            while !(curve.is_none() && rows.begin_after(self.index))
                && let Some((row, is_kept)) = self.due(rows, curve, stop)
            {
                let looked = match row.place {
                    _ if !is_kept => {
                        let states = (&**mu, &mut **between);
                        self.sample(system, joints.as_mut(), &row, states, curve, observer);
                        continue;
                    }
                    Place::On(_) => observer.row(system, row.time, mu),
                    Place::After(..) => {
                        between.copy_from(mu);
                        self.off_grid(system, joints.as_mut(), row.time, between, observer)?;
                        let looked = observer.row(system, row.time, between);
                        observer.return_to_grid();
                        looked
                    }
                };
                self.shown = Some(row.time);
                if looked.is_break() {
                    return Ok(Left::Over(Status::Stopped));
                }
            }
            if let Some(last) = ahead
                .as_mut()
                .and_then(|ahead| ahead.take_stop(system, observer))
            {
                return self.stop_at(system, joints.as_mut(), last, (mu, between), observer);
            }
            if self.index == self.grid.steps() {
                ahead
                    .iter_mut()
                    .for_each(|ahead| ahead.tell(system, observer));
                return Ok(Left::Over(Status::Finished));
            }
            let begins = |guard: &mut Guard<'_, S, P>| guard.begins(mu, self.index);
            let mut watched = self.done == 0 && guard.as_mut().is_some_and(begins);
            if self.done == 0 && (joints.is_some() || observer.held().is_some()) {
                let times = [self.index, self.index + 1].map(|index| self.grid.time(index));
                let times = times.into();
                let joint = joints
                    .as_mut()
                    .is_some_and(|joints| !joints.pieces(system, times).is_empty());
                if joint
                    || observer
                        .held()
                        .is_some_and(|held| held.changes_within(times))
                {
                    self.through(system, joints.as_mut(), times, mu, observer)?;
                    self.done = self.parts;
                    (watched, made) = (false, None);
                }
            }
            let (mut iterations, mut slow) = (0, false);
            while self.done < self.parts {
                let stepped = match made.take() {
                    Some(Ok((end, report))) => {
                        mu.copy_from(&end);
                        Ok(report)
                    }
                    Some(Err(failure)) => Err(failure),
                    None => stepper.step(mu, &mut self.motion(system, observer)),
                };
                match stepped {
                    Ok(report) => {
                        if system.clock().is_some() {
                            set_time(system, mu, self.next_time());
                        }
                        self.arrived(system, mu, report)?;
                        iterations = report.iterations;
                    }
                    Err(failure) => return self.divided(system, failure, mu, guard.as_mut()),
                }
                self.done += 1;
                slow |= self.divides && self.method.fixed_point() && self.is_slow();
                if slow && self.done < self.parts {
                    self.done *= 2;
                    self.change(Change::Parts(2 * self.parts), None);
                    return Ok(Left::Divided);
                }
            }
            self.done = 0;
            let looks = |guard: &&mut Guard<'_, S, P>| watched || guard.wonders(iterations);
            let mut change = self.shorter().filter(|_| slow);
            if let Some(guard) = guard.as_mut().filter(looks) {
                let told = || stepper.estimate();
                let step = (self.index, self.grid.step(), self.parts);
                guard.usual(iterations);
                match guard.looks(system, step, mu, told) {
                    Verdict::Kept => {}
                    Verdict::Change(next, from) if self.allows(next) => {
                        // what has been shown of the motion on the group stays
                        if from == From::Before && !self.shows_motion {
                            mu.copy_from(guard.before());
                            self.change(next, Some(guard));
                            return Ok(Left::Divided);
                        }
                        change = Some(next);
                    }
                    Verdict::Change(..) | Verdict::Lost => {
                        if guard.watch.says() {
                            observer.lost(self.progress());
                        }
                    }
                }
            }
            ahead
                .iter_mut()
                .for_each(|ahead| ahead.tell(system, observer));
            self.index += 1;
            if let Some(growth) = &mut growth {
                let size = S::from_f64(self.steer(growth, system, mu)?);
                rows.relocate(&self.grid);
                if !stepper.set_step(size) {
                    stepper = self.method.stepper(system, size, &newton);
                }
            }
            let looked = observer.step(system, self.progress(), mu);
            if looked.is_break() {
                return Ok(Left::Over(Status::Stopped));
            }
            let change = change.filter(|_| self.index < self.grid.steps());
            if let Some(change) = change {
                self.change(change, guard.as_mut());
            }
            if let Some(next) = system.following(mu) {
                return Ok(Left::Branch(next));
            }
            if change.is_some() {
                return Ok(Left::Divided);
            }
        }
    }
}
