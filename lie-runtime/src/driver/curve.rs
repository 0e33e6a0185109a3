//! Between the steps: what a picture of a run needs beside its rows.
//!
//! Straight lines from step to step are no curve where a step is long: one of order 16 goes a good part of a period. So each step
//! is shown in as many parts as the motion bends on it. Their ends are made as rows off the grid are, by one shorter step from the
//! grid point before, which is not continued from: they have the order of the method, and lie on its orbit. The trajectory, its
//! rows and its counts stay as they are, and steps that hardly bend have no parts.
//!
//! How far a step bends is `2 |mu1 - mu0 - h f(mu0)| / (h |f|)`, with the largest |f| so far: the angle by which the motion turns,
//! to first order. It is known behind a step, and used for those after it; before the first one `f(mu0 + s f(mu0))` tells it.
//! Where the motion on the group is followed, its angle `h |xi|` counts too.

use super::course::Course;
use super::grid::{Grid, Place};
use super::joints::Joints;
use super::observer::Observer;
use super::rows::{Row, Rows};
use crate::poisson::Poisson;
use crate::scalar::{Scalar, largest};
use crate::state::State;

/// Runs of so many steps are shown by these alone.
const MOST_STEPS: u64 = 10_000;
/// States between steps, at most, and their numbers together, so that families have fewer.
const MOST_STATES: u64 = 20_000;
const MOST_NUMBERS: u64 = 2_000_000;
/// A step is shown in so many parts at most: enough for a whole turn.
const MOST_PARTS: u64 = 48;
/// A part bends by so much: lines through 78 points of a circle are less than half a pixel away from it.
const BEND: f64 = 0.08;
/// A step that bends by no more has no parts.
const STRAIGHT: f64 = 0.25;
/// Beyond this the angle is not to be told any more.
const FAR: f64 = 1.0;
/// The first guess looks no farther than this part of the size of the state.
const AHEAD: f64 = 0.1;

/// A state that was seen, with the field there; what carries the time is 0 in both.
#[derive(Clone)]
struct Seen<V> {
    time: f64,
    mu: V,
    field: V,
}

/// What is shown of a run between its rows.
pub(super) struct Curve<V> {
    /// Whether the motion on the group is followed.
    motion: bool,
    /// Parts of a step at most.
    most: u64,
    /// The last grid point.
    last: Seen<V>,
    /// The last state that was shown at a grid point.
    shown: Seen<V>,
    /// How many grid points were seen.
    points: u64,
    /// The largest field so far.
    fastest: f64,
    /// By how much a step bends, at most.
    bend: f64,
    /// Samples of the step that comes next: its parts, and the next one of them.
    parts: u64,
    next: u64,
    /// The length of that step.
    length: f64,
    /// The time up to which samples were shown: behind the point where a step was given up that was too long.
    reached: f64,
}

impl<V> Curve<V> {
    /// For a run along a grid; none where its steps are so many that they are a curve by themselves.
    pub(super) fn along<S: Scalar, P: Poisson<S, State = V>>(
        system: &P,
        grid: &Grid,
        motion: bool,
    ) -> Option<Self>
    where
        V: State<S>,
    {
        let steps = grid.steps().max(1);
        let states = MOST_STATES.min(MOST_NUMBERS / system.dimension().max(1) as u64);
        let most = (states / steps).min(MOST_PARTS);
        let seen = || Seen {
            time: f64::NAN,
            mu: system.zero_state(),
            field: system.zero_state(),
        };
        (steps < MOST_STEPS && most > 1).then(|| Self {
            motion,
            most,
            last: seen(),
            shown: seen(),
            points: 0,
            fastest: 0.0,
            bend: 0.0,
            parts: 1,
            next: 1,
            length: 0.0,
            reached: f64::NAN,
        })
    }

    /// Looks at a grid point, which is a row or not, and plans what is shown until the next one.
    pub(super) fn arrive<S: Scalar, P: Poisson<S, State = V>>(
        &mut self,
        system: &P,
        (grid, index): (&Grid, u64),
        mu: &V,
        is_row: bool,
    ) where
        V: State<S>,
    {
        let time = grid.time(index);
        if self.last.time == time {
            // once more, in smaller steps: what there was to show was shown
            return;
        }
        let here = Seen::at(system, time, mu);
        self.fastest = self.fastest.max(size(&here.field));
        self.length = grid.length(index);
        let bend = match self.points {
            0 => here.ahead(system, mu, self.length),
            _ => self.last.bend(&here, self.fastest),
        };
        self.bend = self.bend.max(bend);
        let turn = match self.motion {
            true => turn(system, mu) * self.length.abs(),
            false => 0.0,
        };
        let parts = |angle: f64| match angle > STRAIGHT {
            true => (angle / BEND).ceil() as u64,
            false => 1,
        };
        self.parts = match self.bend > FAR {
            true => self.most,
            false => parts(self.bend).max(parts(turn)).min(self.most),
        };
        let away = self.points > 0 && self.shown.bend(&here, self.fastest) > STRAIGHT;
        let shows = is_row || self.parts > 1 || away;
        // the grid point itself is the first sample, unless it is a row
        self.next = u64::from(is_row || !shows);
        while self.next < self.parts && (self.time(time) - self.reached) * self.length <= 0.0 {
            self.next += 1;
        }
        if shows || self.points == 0 {
            self.shown.clone_from(&here);
        }
        self.points += 1;
        self.last = here;
    }

    /// The next state to be shown, before a row if there is one.
    pub(super) fn before(&self, (grid, index): (&Grid, u64), row: Option<&Row>) -> Option<Row> {
        if self.next >= self.parts || self.last.time != grid.time(index) {
            return None;
        }
        let after = self.length * (self.next as f64 / self.parts as f64);
        let sample = match self.next {
            0 => Row {
                place: Place::On(index),
                time: self.last.time,
            },
            _ => Row {
                place: Place::After(index, after),
                time: self.last.time + after,
            },
        };
        let earlier = |row: &Row| match row.place {
            Place::On(_) => false,
            Place::After(_, there) => after.abs() < there.abs(),
        };
        row.is_none_or(earlier).then_some(sample)
    }

    /// The time of the next sample, of the step from a time.
    fn time(&self, start: f64) -> f64 {
        start + self.length * (self.next as f64 / self.parts as f64)
    }

    /// Goes on to the sample after it.
    pub(super) fn advance(&mut self) {
        self.reached = self.time(self.last.time);
        self.next += 1;
    }

    /// Shows no more of this step.
    pub(super) fn skip(&mut self) {
        self.next = self.parts;
    }
}

impl<S: Scalar, P: Poisson<S>> Course<'_, S, P> {
    /// What is shown next of the step that begins here, up to a time at which the run stops: a row, which is kept, or a state
    /// between rows.
    pub(super) fn due<V>(
        &self,
        rows: &mut Rows,
        curve: &mut Option<Curve<V>>,
        stop: Option<f64>,
    ) -> Option<(Row, bool)> {
        if self.done > 0 {
            return None;
        }
        let sign = self.grid.step().signum();
        let is_before = |row: &Row| stop.is_none_or(|stop| (row.time - stop) * sign <= 0.0);
        if let Some(curve) = curve {
            let row = rows.peek().filter(|row| row.place.index() == self.index);
            let sample = curve.before((&self.grid, self.index), row);
            if let Some(sample) = sample.filter(is_before) {
                curve.advance();
                return Some((sample, false));
            }
        }
        let row = rows.next_if(|row| row.place.index() == self.index && is_before(row));
        row.map(|row| (row, true))
    }

    /// Shows a state between rows. The run does not depend on it: its work is not counted, and where the shorter step fails the
    /// rest of the step is not shown.
    #[cold]
    pub(super) fn sample(
        &mut self,
        system: &P,
        joints: Option<&mut Joints<S, P>>,
        row: &Row,
        (mu, between): (&P::State, &mut P::State),
        curve: &mut Option<Curve<P::State>>,
        observer: &mut dyn Observer<S, P>,
    ) {
        if let Place::On(_) = row.place {
            return observer.between(system, row.time, mu);
        }
        let stats = self.stats;
        between.copy_from(mu);
        match self.off_grid(system, joints, row.time, between, observer) {
            Ok(()) => observer.between(system, row.time, between),
            Err(_) => curve.iter_mut().for_each(Curve::skip),
        }
        observer.return_to_grid();
        self.stats = stats;
    }
}

impl<V> Seen<V> {
    fn at<S: Scalar, P: Poisson<S, State = V>>(system: &P, time: f64, mu: &V) -> Self
    where
        V: State<S>,
    {
        let (mut mu, mut field) = (mu.clone(), system.zero_state());
        system.vector_field(&mu, &mut field);
        if let Some(clock) = system.clock() {
            for place in [clock.time, clock.momentum] {
                mu.as_mut_slice()[place] = S::zero();
                field.as_mut_slice()[place] = S::zero();
            }
        }
        Self { time, mu, field }
    }

    /// By how much the motion bends from here to another state.
    fn bend<S: Scalar>(&self, to: &Self, fastest: f64) -> f64
    where
        V: State<S>,
    {
        let span = to.time - self.time;
        let mut off = to.mu.clone();
        off.axpy(S::from_f64(-1.0), &self.mu);
        off.axpy(S::from_f64(-span), &self.field);
        angle(2.0 * size(&off), span.abs() * fastest)
    }

    /// By how much a step from here bends, about.
    fn ahead<S: Scalar, P: Poisson<S, State = V>>(&self, system: &P, mu: &V, length: f64) -> f64
    where
        V: State<S>,
    {
        let (speed, reach) = (size(&self.field), AHEAD * size(&self.mu));
        let short = match reach < length.abs() * speed {
            true if reach > 0.0 => (reach / speed).copysign(length),
            _ => length,
        };
        let mut there = mu.clone();
        there.axpy(S::from_f64(short), &self.field);
        let mut change = Self::at(system, self.time, &there).field;
        change.axpy(S::from_f64(-1.0), &self.field);
        angle(size(&change) * (length / short).abs(), speed)
    }
}

/// How fast the group element turns.
fn turn<S: Scalar, P: Poisson<S>>(system: &P, mu: &P::State) -> f64 {
    let mut xi = system.zero_state();
    system.gradient(mu, &mut xi);
    let squares = xi.as_slice().iter().map(|&entry| largest(entry * entry));
    squares.sum::<f64>().sqrt()
}

/// The quotient, or 0 where it is none.
fn angle(off: f64, whole: f64) -> f64 {
    let angle = off / whole;
    if angle.is_finite() { angle } else { 0.0 }
}

/// The largest absolute value of an entry.
fn size<S: Scalar, V: State<S>>(vector: &V) -> f64 {
    let entries = vector.as_slice().iter();
    entries.fold(0.0, |most, entry| f64::max(most, largest(entry.abs())))
}
