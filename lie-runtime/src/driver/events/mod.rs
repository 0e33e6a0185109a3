//! Events: zeros of declared functions along a run.
//!
//! A step is looked at before it is shown. Along it the state is known at both ends with two derivatives, which makes a quintic; where the motion turns by more
//! than a radian on the step, states in between are made as rows off the grid are. On these quintics a function is sampled at eight
//! places of each piece, and dips towards zero between them are followed to their ends. A change of its sign is then located in the
//! run itself, whose state at any time is that of one shorter step from the grid point before, to round-off in the time. The grid
//! stays, and an event is told once its step is accepted. Where an input jumps within a step, each piece is looked at by itself.
//!
//! What is missed: two zeros between neighbouring samples, where the dip between them is not on the quintic, and zeros of functions that change much faster than
//! the motion. A jump is no zero, and neither is the start of a run.

mod ahead;
mod quintic;
mod samples;
mod zero;

use super::course::Course;
use super::held::Held;
use super::joints::Joints;
use super::observer::Observer as _;
use super::problem::set_time;
use crate::EventRule;
use crate::poisson::Poisson;
use crate::scalar::{Scalar, largest};
use crate::state::State;
use quintic::{Guess, Quintic};
use zero::zero;

pub(super) use ahead::Ahead;

/// A piece turns by so much at most, unless there were more pieces than this.
const TURN: f64 = 1.0;
const MOST_PIECES: f64 = 64.0;
/// How far from its place on the quintic a zero is looked for first, as a part of the step.
const FIRST: f64 = 1e-4;
/// A function that has still so much of its change at a change of its sign jumps.
const JUMP: f64 = 1e-2;
/// Times that are nearer to each other than so many units of round-off are the same.
const SAME: f64 = 4.0;

/// An event that a run has come to.
#[derive(Clone, Debug, PartialEq)]
pub struct Event<V> {
    /// Which of the declared events it is, see [`Poisson::event_name`].
    pub index: usize,
    /// When.
    pub time: f64,
    /// The state there.
    pub mu: V,
    /// Whether it ends the run.
    pub stops: bool,
}

/// What a run needs to find events.
pub(super) struct Events<V> {
    rules: Vec<EventRule>,
    /// The last end of a step that was looked at.
    last: Option<Knot<V>>,
}

/// A state of a run with its field, how that changes along itself, and the functions there.
#[derive(Clone)]
struct Knot<V> {
    time: f64,
    mu: V,
    field: V,
    bend: V,
    values: Vec<f64>,
}

impl<V> Events<V> {
    /// Those of a system, if it has some and there is one trajectory alone.
    pub(super) fn of<S: Scalar, P: Poisson<S, State = V>>(system: &P) -> Option<Self> {
        let count = system.event_count();
        (count > 0 && S::LANES == 1).then(|| Self {
            rules: (0..count).map(|index| system.event_rule(index)).collect(),
            last: None,
        })
    }
}

impl<V> Knot<V> {
    fn at<S: Scalar, P: Poisson<S, State = V>>(system: &P, time: f64, mu: &V) -> Self
    where
        V: State<S>,
    {
        let mut field = system.zero_state();
        system.vector_field(mu, &mut field);
        let mut values = vec![f64::NAN; system.event_count()];
        fill(system, mu, &mut values);
        Self {
            time,
            mu: mu.clone(),
            bend: bend(system, mu, &field),
            field,
            values,
        }
    }

    /// How fast the field turns, in radians for a unit of time: `|f'(mu) f| / |f|`.
    fn turning<S: Scalar, P: Poisson<S, State = V>>(&self, system: &P) -> f64
    where
        V: State<S>,
    {
        let turning = norm(system, &self.bend) / norm(system, &self.field);
        if turning.is_finite() { turning } else { 0.0 }
    }
}

/// How the field changes along itself, `f'(mu) f`, by a difference; 0 where that is no number.
fn bend<S: Scalar, P: Poisson<S>>(system: &P, mu: &P::State, field: &P::State) -> P::State {
    let mut change = system.zero_state();
    let (speed, size) = (norm(system, field), norm(system, mu).max(f64::MIN_POSITIVE));
    let short = f64::EPSILON.sqrt() * size / speed;
    if !short.is_finite() {
        return change;
    }
    let mut there = mu.clone();
    there.axpy(S::from_f64(short), field);
    system.vector_field(&there, &mut change);
    change.axpy(S::from_f64(-1.0), field);
    let entries = change.as_mut_slice();
    entries
        .iter_mut()
        .for_each(|entry| *entry /= S::from_f64(short));
    if entries.iter().any(|entry| !entry.to_f64().is_finite()) {
        change.fill(S::zero());
    }
    change
}

/// The values of the functions at a state.
fn fill<S: Scalar, P: Poisson<S>>(system: &P, mu: &P::State, values: &mut [f64]) {
    let mut found = vec![S::zero(); values.len()];
    system.events(mu, &mut found);
    for (value, found) in values.iter_mut().zip(found) {
        *value = found.to_f64();
    }
}

/// The largest entry of a vector but for those that carry the time.
fn norm<S: Scalar, P: Poisson<S>>(system: &P, vector: &P::State) -> f64 {
    largest(system.norm(vector))
}

/// Adds events to others that are in the order of a run in this direction, each behind those at its time.
fn insert<V>(found: &mut Vec<Event<V>>, others: Vec<Event<V>>, direction: f64) {
    let at = |event: &Event<V>| event.time * direction;
    for event in others {
        let is_before = |other: &Event<V>| at(other).total_cmp(&at(&event)).is_le();
        found.insert(found.partition_point(is_before), event);
    }
}

/// Leaves out what is behind the first event that ends the run, which becomes the last one. What happens at its time happens, in whatever
/// order it was declared, though the run ends by one event alone.
fn end_at_stop<V>(found: &mut Vec<Event<V>>, span: f64) {
    let Some(place) = found.iter().position(|event| event.stops) else {
        return;
    };
    let stop = found.remove(place);
    let same = SAME * f64::EPSILON * stop.time.abs();
    found.retain(|event| (event.time - stop.time) * span <= same);
    for event in &mut found[place..] {
        (event.time, event.stops) = (stop.time, false);
    }
    found.push(stop);
}

/// 1, -1, or 0 for a zero and for what is no number.
fn sign(value: f64) -> f64 {
    if value > 0.0 {
        1.0
    } else if value < 0.0 {
        -1.0
    } else {
        0.0
    }
}

impl<S: Scalar, P: Poisson<S>> Course<'_, S, P> {
    /// The events from a grid point to a state ahead, in order, up to the first that ends the run. The work for them is not counted.
    pub(super) fn events_until(
        &mut self,
        system: &P,
        mut joints: Option<&mut Joints<S, P>>,
        events: &mut Events<P::State>,
        (mu, end): (&P::State, (f64, &P::State)),
        mut held: Option<Held>,
    ) -> Vec<Event<P::State>> {
        let stats = self.stats;
        let time = self.grid.time(self.index);
        let known = events.last.take();
        let known = known.filter(|knot| knot.time == time && knot.mu.as_slice() == mu.as_slice());
        let start = known.unwrap_or_else(|| Knot::at(system, time, mu));
        let finish = Knot::at(system, end.0, end.1);
        let changes = held
            .as_ref()
            .map_or_else(Vec::new, |held| held.changes((time, end.0)));
        let mut ahead = held.clone();
        let mut reach = |course: &mut Self, to: f64| {
            let mut there = mu.clone();
            let joints = joints.as_deref_mut();
            let made = course.off_grid(system, joints, to, &mut there, &mut ahead);
            made.is_ok().then_some(there)
        };
        let span = (end.0 - time).signum();
        let mut found = Vec::new();
        let mut from = start;
        for change in changes {
            // an input jumps: the motion has a corner, and its functions may jump with it
            let Some(there) = reach(self, change) else {
                continue;
            };
            let before = Knot::at(system, change, &there);
            let passed = self.events_between(system, &events.rules, (&from, &before), &mut reach);
            insert(&mut found, passed, span);
            let mut there = before.mu;
            set_time(system, &mut there, change);
            held.hold(
                system,
                (self.index, change, self.grid.step()),
                &mut there,
                &[],
            );
            from = Knot::at(system, change, &there);
        }
        let passed = self.events_between(system, &events.rules, (&from, &finish), &mut reach);
        insert(&mut found, passed, span);
        end_at_stop(&mut found, span);
        events.last = Some(finish);
        self.stats = stats;
        found
    }

    /// The events between two states with a smooth motion between them.
    fn events_between(
        &mut self,
        system: &P,
        rules: &[EventRule],
        (start, finish): (&Knot<P::State>, &Knot<P::State>),
        reach: &mut impl FnMut(&mut Self, f64) -> Option<P::State>,
    ) -> Vec<Event<P::State>> {
        let knots = self.knots(system, (start, finish), reach);
        let mut guesses: Vec<Vec<Guess>> = (0..rules.len()).map(|_| Vec::new()).collect();
        for pair in knots.windows(2) {
            let found = Quintic::new(system, [&pair[0], &pair[1]]).guesses(rules.len());
            for (guesses, found) in guesses.iter_mut().zip(found) {
                guesses.extend(found);
            }
        }
        let mut found = Vec::new();
        for (index, (rule, guesses)) in rules.iter().zip(&guesses).enumerate() {
            for (place, guess) in guesses.iter().enumerate() {
                if !rule.counts(guess.sign) {
                    continue;
                }
                let low = place
                    .checked_sub(1)
                    .map(|last| 0.5 * (guesses[last].time + guess.time));
                let high = guesses
                    .get(place + 1)
                    .map(|next| 0.5 * (next.time + guess.time));
                let limits = [low.unwrap_or(start.time), high.unwrap_or(finish.time)];
                let mut of = |course: &mut Self, to: f64| {
                    if to == start.time || to == finish.time {
                        let knot = if to == start.time { start } else { finish };
                        return Some((knot.mu.clone(), knot.values[index]));
                    }
                    let there = reach(course, to)?;
                    let mut values = vec![0.0; rules.len()];
                    fill(system, &there, &mut values);
                    let value = values[index];
                    Some((there, value))
                };
                let whole = finish.time - start.time;
                let located = self.located(guess, (limits, whole), &mut of);
                found.extend(located.map(|(time, mu)| Event {
                    index,
                    time,
                    mu,
                    stops: rule.stops,
                }));
            }
            let zeros = at_knots(&knots, index, guesses);
            let zeros = zeros.filter(|(_, sign)| rule.counts(*sign));
            found.extend(zeros.map(|(knot, _)| Event {
                index,
                time: knot.time,
                mu: knot.mu.clone(),
                stops: rule.stops,
            }));
        }
        found
    }

    /// The ends of a piece, and states in between where the motion turns far.
    fn knots(
        &mut self,
        system: &P,
        (start, finish): (&Knot<P::State>, &Knot<P::State>),
        reach: &mut impl FnMut(&mut Self, f64) -> Option<P::State>,
    ) -> Vec<Knot<P::State>> {
        let span = finish.time - start.time;
        let turning = f64::max(start.turning(system), finish.turning(system));
        let pieces = (span.abs() * turning / TURN).ceil().clamp(1.0, MOST_PIECES);
        let mut knots = vec![start.clone()];
        for piece in 1..pieces as u32 {
            let time = start.time + span * (f64::from(piece) / pieces);
            if let Some(mu) = reach(self, time) {
                knots.push(Knot::at(system, time, &mu));
            }
        }
        knots.push(finish.clone());
        knots
    }

    /// The zero of the run near one of the quintics, to round-off in the time, and the state there; none where there is no change of
    /// the sign, or the function jumps.
    fn located<V>(
        &mut self,
        guess: &Guess,
        ([low, high], span): ([f64; 2], f64),
        of: &mut impl FnMut(&mut Self, f64) -> Option<(V, f64)>,
    ) -> Option<(f64, V)> {
        let (before, after) = (-guess.sign, guess.sign);
        let mut width = FIRST * span;
        let limited = |time: f64| {
            let forwards = span > 0.0;
            match forwards {
                true => time.clamp(low, high),
                false => time.clamp(high, low),
            }
        };
        let (from, to) = loop {
            let ends = [limited(guess.time - width), limited(guess.time + width)];
            let [from, to] = ends.map(|time| of(self, time).map(|(_, value)| (time, value)));
            let (from, to) = (from?, to?);
            if sign(from.1) == before && sign(to.1) == after {
                break (from, to);
            }
            if from.0 == low && to.0 == high {
                return None;
            }
            width *= 16.0;
        };
        let size = from.0.abs().max(to.0.abs());
        let mut value = |time: f64| of(self, time).map(|(_, value)| value);
        let (time, change) = zero(from, to, 2.0 * f64::EPSILON * size, &mut value)?;
        if change > JUMP * (from.1 - to.1).abs() {
            return None;
        }
        of(self, time).map(|(mu, _)| (time, mu))
    }
}

/// The knots behind the first at which a function is 0, with the sign that it comes to there.
fn at_knots<'k, V>(
    knots: &'k [Knot<V>],
    index: usize,
    guesses: &'k [Guess],
) -> impl Iterator<Item = (&'k Knot<V>, f64)> {
    let zeros = (1..knots.len()).filter(move |&place| knots[place].values[index] == 0.0);
    zeros.filter_map(move |place| {
        let knot = &knots[place];
        let span = knot.time - knots[0].time;
        let mut passed = guesses.iter().rev();
        let passed = passed.find(|guess| (guess.time - knots[0].time).abs() < span.abs());
        let mut before = knots[..place]
            .iter()
            .rev()
            .map(|knot| sign(knot.values[index]));
        let side = before.find(|side| *side != 0.0);
        let side = passed.map(|guess| guess.sign).or(side)?;
        Some((knot, -side))
    })
}
