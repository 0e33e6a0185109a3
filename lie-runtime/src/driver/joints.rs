//! Steps that end where branches of a Hamiltonian meet at a time that is known beforehand.
//!
//! Across such a joint no method has more order than the branches have derivatives in common. So the step that contains one
//! is made in pieces, each by a stepper of its own; the grid stays as it is.

use super::course::Course;
use super::observer::Observer;
use super::problem::set_time;
use super::solve::IntegrateError;
use crate::poisson::Poisson;
use crate::scalar::{Scalar, largest};
use crate::state::State as _;

/// A piece ends so many units of round-off before a joint, and the next one begins as many behind it: which branch holds
/// at the joint itself does not matter.
const BESIDE: f64 = 4.0;
/// A joint nearer to an end of a step than this part of it is at the end.
const SLIVER: f64 = 1e-12;
/// As many halvings as there are bits.
const HALVINGS: u32 = 1100;

/// A piece of a step: its start and its end.
pub(super) type Piece = (f64, f64);

/// The joints of a system.
pub(super) struct Joints<S: Scalar, P: Poisson<S>> {
    state: P::State,
    before: Vec<S>,
    after: Vec<S>,
    pieces: Vec<Piece>,
}

impl<S: Scalar, P: Poisson<S>> Joints<S, P> {
    /// Those of a system, if there are any.
    pub(super) fn of(system: &P) -> Option<Self> {
        let count = system.joint_count();
        (count > 0).then(|| Self {
            state: system.zero_state(),
            before: vec![S::zero(); count],
            after: vec![S::zero(); count],
            pieces: Vec::new(),
        })
    }

    /// The pieces of a step between two times; none where it has no joint inside.
    pub(super) fn pieces(&mut self, system: &P, (start, end): Piece) -> &[Piece] {
        self.pieces.clear();
        let Self {
            state,
            before,
            after,
            ..
        } = self;
        let mut at = |time: f64, out: &mut [S]| {
            set_time(system, state, time);
            system.joints(state, out);
        };
        at(start, before);
        at(end, after);
        let mut times = Vec::new();
        for index in 0..before.len() {
            for lane in 0..S::LANES {
                let of = |values: &[S]| values[index].lane(lane).to_f64();
                let (from, to) = (of(before), of(after));
                // one at an end of the step is there, not inside
                if from == 0.0 {
                    times.push(start);
                }
                if to == 0.0 {
                    times.push(end);
                }
                if from * to < 0.0 {
                    let mut scratch = vec![S::zero(); before.len()];
                    let mut negative = |time: f64| {
                        at(time, &mut scratch);
                        of(&scratch) < 0.0
                    };
                    times.push(crossing((start, end), from < 0.0, &mut negative));
                }
            }
        }
        let unit = largest(S::epsilon());
        cut((start, end), times, unit, &mut self.pieces);
        &self.pieces
    }
}

/// Adds the pieces of a step with joints at these times, and this unit of round-off; none where it has no joint.
fn cut((start, end): Piece, mut times: Vec<f64>, unit: f64, pieces: &mut Vec<Piece>) {
    let least = SLIVER * (end - start).abs();
    let at_start = times.iter().any(|time| (time - start).abs() <= least);
    let at_end = times.iter().any(|time| (time - end).abs() <= least);
    times.retain(|time| (time - start).abs() > least && (time - end).abs() > least);
    if times.is_empty() && !at_start && !at_end {
        return;
    }
    times.sort_by(|a, b| (a - start).abs().total_cmp(&(b - start).abs()));
    times.dedup_by(|b, a| (*a - *b).abs() <= least);
    let beside = |time: f64| {
        let size = time.abs().max((end - start).abs());
        (BESIDE * unit * size).copysign(end - start)
    };
    let mut from = start + if at_start { beside(start) } else { 0.0 };
    for time in times {
        pieces.push((from, time - beside(time)));
        from = time + beside(time);
    }
    let to = end - if at_end { beside(end) } else { 0.0 };
    pieces.push((from, to));
}

impl<S: Scalar, P: Poisson<S>> Course<'_, S, P> {
    /// A shorter step, from a state of the grid to a row between two of them.
    pub(super) fn off_grid(
        &mut self,
        system: &P,
        joints: Option<&mut Joints<S, P>>,
        end: f64,
        mu: &mut P::State,
        observer: &mut dyn Observer<S, P>,
    ) -> Result<(), IntegrateError> {
        observer.leave_grid();
        let whole = (self.grid.time(self.index), end);
        self.through(system, joints, whole, mu, observer)
    }

    /// Goes from piece to piece, each with a stepper of its own.
    pub(super) fn in_pieces(
        &mut self,
        system: &P,
        pieces: &[Piece],
        mu: &mut P::State,
        observer: &mut dyn Observer<S, P>,
    ) -> Result<(), IntegrateError> {
        for &(from, to) in pieces {
            let parts = ((to - from) / self.grid.step() * f64::from(self.parts))
                .ceil()
                .max(1.0);
            let size = (to - from) / parts;
            let mut stepper = self.method.stepper(system, S::from_f64(size), &self.newton);
            cross(system, mu, from);
            for done in 1..=parts as u32 {
                let report = match stepper.step(mu, &mut self.motion(system, observer)) {
                    Ok(report) => report,
                    Err(failure) => return Err(self.stopped(system, failure, to - from, mu)),
                };
                let left = (to - from) * (1.0 - f64::from(done) / parts);
                set_time(system, mu, to - left);
                self.arrived(system, mu, report)?;
            }
        }
        Ok(())
    }
}

/// Sets the time, which may go over a joint: by what H jumps there, the momentum of the time falls, so that the jump is work.
pub(super) fn cross<S: Scalar, P: Poisson<S>>(system: &P, mu: &mut P::State, time: f64) {
    let before = system.energy(mu);
    set_time(system, mu, time);
    if let Some(clock) = system.clock() {
        let jump = system.energy(mu) - before;
        mu.as_mut_slice()[clock.momentum] -= jump;
    }
}

/// Where a function changes its sign between two times: the last number on the side of the start.
fn crossing((start, end): Piece, side: bool, negative: &mut dyn FnMut(f64) -> bool) -> f64 {
    let (mut here, mut there) = (start, end);
    for _ in 0..HALVINGS {
        let middle = here + 0.5 * (there - here);
        if middle == here || middle == there {
            break;
        }
        if negative(middle) == side {
            here = middle;
        } else {
            there = middle;
        }
    }
    here
}
