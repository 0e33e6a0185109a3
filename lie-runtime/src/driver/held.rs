//! What is held from step to step: inputs that somebody sets, and the rates of Wiener processes.

use super::course::Course;
use super::joints::{Joints, Piece, cross};
use super::observer::Observer;
use super::philox::Wiener;
use super::solve::IntegrateError;
use crate::poisson::Poisson;
use crate::scalar::Scalar;
use crate::state::State;
use std::fmt;
use std::sync::Arc;

/// A time that is nearer to a sampling than this part of the interval is at it.
const NEAR: f64 = 1e-9;

/// A function of time, state and group element, in the order of the coordinates; the last is empty where nothing follows the element.
pub type Controller = Arc<dyn Fn(f64, &[f64], &[f64]) -> f64 + Send + Sync>;

/// Where the values of an input come from.
#[derive(Clone)]
pub enum Source {
    /// From a table: each value is held from its time on to the next time, the first one before its time too. That is a function of the time,
    /// the same one for runs in both directions.
    Table {
        /// The times, ascending.
        times: Arc<[f64]>,
        /// A value for each.
        values: Arc<[f64]>,
    },
    /// From a function of (t, state, group element), asked at each sampling with the state there; again for rows between steps and
    /// for events. A run backwards asks it where it enters an interval, which is at the later end, as the state at the other end is not
    /// known: what a run forwards has held there is not found that way.
    Controller(Controller),
}

impl fmt::Debug for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Table { times, .. } => write!(f, "Table of {} times", times.len()),
            Self::Controller(_) => f.write_str("Controller"),
        }
    }
}

/// Functions that are the same are one.
impl PartialEq for Source {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (
                Self::Table { times, values },
                Self::Table {
                    times: others,
                    values: other,
                },
            ) => times == others && values == other,
            (Self::Controller(a), Self::Controller(b)) => Arc::ptr_eq(a, b),
            _ => false,
        }
    }
}

/// An input of a run.
#[derive(Clone, Debug)]
struct Input {
    source: Option<Source>,
    sampling: Option<f64>,
    /// The sampling that was made last, by its number, and what it gave.
    last: Option<(i64, f64)>,
}

/// The inputs and the noise of a run, in the order of the system.
///
/// An input is sampled at `t0 + k s` for its sampling interval s (at `t0 - k s` by a run backwards), or before every step, and held until the
/// next sampling. The rate of a Wiener
/// process over a step is `z sqrt(1/|h|)` with a normally distributed z, so that a step integrates the equation of Stratonovich along a path
/// that is linear in each step (E. Wong, M. Zakai, 1965, [doi:10.1214/aoms/1177699916](https://doi.org/10.1214/aoms/1177699916)); in implicit steps z is
/// bounded by `2 sqrt(|ln h|)` (G. N. Milstein, Yu. M. Repin, M. V. Tretyakov, 2002,
/// [doi:10.1137/S0036142901395588](https://doi.org/10.1137/S0036142901395588)). The numbers are those of the seed, the stream and the number of the step
/// alone, whoever asks for them, and when.
#[derive(Clone, Debug)]
pub struct Held {
    inputs: Vec<Input>,
    noise: Option<Wiener>,
    /// The number of the step whose noise is set.
    step: Option<u64>,
    start: f64,
    state: Vec<f64>,
    element: Vec<f64>,
}

impl Held {
    /// What a system has of it, with inputs at their defaults and the noise of a seed and a stream for each lane, from a time on; nothing of a
    /// system that has neither.
    pub fn of<S: Scalar, P: Poisson<S>>(
        system: &P,
        start: f64,
        (seed, streams): (u64, &[u64]),
    ) -> Option<Self> {
        let (inputs, noises) = (system.input_count(), system.noise_count());
        let input = |index: usize| Input {
            source: None,
            sampling: system.input_sampling(index),
            last: None,
        };
        (inputs + noises > 0).then(|| Self {
            inputs: (0..inputs).map(input).collect(),
            noise: (noises > 0).then(|| Wiener::new(seed, streams, noises)),
            step: None,
            start,
            state: Vec::new(),
            element: Vec::new(),
        })
    }

    /// The same with a source for an input.
    #[must_use]
    pub fn with(mut self, index: usize, source: Source) -> Self {
        self.inputs[index].source = Some(source);
        self
    }

    /// The same for steps that are solved, with bounded increments of the noise.
    #[must_use]
    pub fn bounded(mut self, bounded: bool) -> Self {
        self.noise = self.noise.map(|noise| noise.bounded(bounded));
        self
    }

    /// Sets what is held at the beginning of a step of a size, or where an input changes within one.
    pub fn set<S: Scalar, P: Poisson<S>>(
        &mut self,
        system: &P,
        (index, time, step): (u64, f64, f64),
        mu: &mut P::State,
        element: &[S],
    ) {
        let Some(clock) = system.clock() else { return };
        let first = clock.time + 2;
        let mut state = std::mem::take(&mut self.state);
        let mut rows = std::mem::take(&mut self.element);
        state.clear();
        rows.clear();
        let asks = |input: &Input| matches!(input.source, Some(Source::Controller(_)));
        if self.inputs.iter().any(asks) {
            state.extend(mu.as_slice().iter().map(|x| x.lane(0).to_f64()));
            rows.extend(element.iter().map(|x| x.lane(0).to_f64()));
        }
        // the values at the start belong to it
        let begins = index == 0 && (time - self.start).abs() <= NEAR * step.abs();
        let before = (!self.inputs.is_empty() && !begins).then(|| system.hamiltonian(mu));
        for (k, input) in self.inputs.iter_mut().enumerate() {
            if let Some(value) = input.value(self.start, time, step, &state, &rows) {
                mu.as_mut_slice()[first + k] = S::from_f64(value);
            }
        }
        if let Some(before) = before {
            // what an input does to H is work
            let change = system.hamiltonian(mu) - before;
            mu.as_mut_slice()[clock.momentum] -= change;
        }
        (self.state, self.element) = (state, rows);
        if let Some(noise) = &self.noise
            && self.step != Some(index)
        {
            self.step = Some(index);
            let rates = &mut mu.as_mut_slice()[first + self.inputs.len()..];
            noise.rates(index, step, rates);
        }
    }

    /// The tables alone: controllers are asked no more.
    pub(super) fn tables(mut self) -> Self {
        let controllers = self.inputs.iter_mut();
        let controllers =
            controllers.filter(|input| matches!(input.source, Some(Source::Controller(_))));
        controllers.for_each(|input| input.source = None);
        self
    }

    /// Whether a run with other steps is the same: there is no noise and no controller.
    pub(super) fn repeats(&self) -> bool {
        let asks = |input: &Input| matches!(input.source, Some(Source::Controller(_)));
        self.noise.is_none() && !self.inputs.iter().any(asks)
    }

    /// Times within a span from which on inputs are largest and smallest in their tables.
    pub(super) fn extremes(&self, (from, to): Piece) -> Vec<f64> {
        // backwards, a value begins where the next one does
        let later = usize::from(to < from);
        let mut found = Vec::new();
        for input in &self.inputs {
            let Some(Source::Table { times, values }) = &input.source else {
                continue;
            };
            let begins = times.iter().skip(later);
            let rows = begins.copied().zip(values.iter().copied());
            let rows = rows.filter(|(time, _)| (*time - from) * (*time - to) < 0.0);
            let by = |a: &(f64, f64), b: &(f64, f64)| a.1.total_cmp(&b.1);
            found.extend(rows.clone().max_by(by).map(|row| row.0));
            found.extend(rows.min_by(by).map(|row| row.0));
        }
        found
    }

    /// Whether an input changes between two times.
    pub(super) fn changes_within(&self, piece: Piece) -> bool {
        !self.changes(piece).is_empty()
    }

    /// Whether a controller is asked between two times.
    pub(super) fn samples_within(&self, piece: Piece) -> bool {
        let mut times = Vec::new();
        let inputs = self.inputs.iter();
        let asked = inputs.filter(|input| matches!(input.source, Some(Source::Controller(_))));
        asked.for_each(|input| input.changes(self.start, piece, &mut times));
        !times.is_empty()
    }

    /// The times between two others at which an input changes, in the order of the run.
    pub(super) fn changes(&self, (from, to): Piece) -> Vec<f64> {
        let mut times: Vec<f64> = Vec::new();
        for input in &self.inputs {
            input.changes(self.start, (from, to), &mut times);
        }
        times.sort_by(|a, b| (a - from).abs().total_cmp(&(b - from).abs()));
        times.dedup();
        times
    }
}

impl Input {
    /// The value that is held from a time on; nothing where it stays what it was.
    fn value(
        &mut self,
        start: f64,
        time: f64,
        step: f64,
        state: &[f64],
        element: &[f64],
    ) -> Option<f64> {
        match self.source.as_ref()? {
            Source::Table { times, values } => {
                let slack = NEAR * step.abs();
                // at a time of the table, the interval that the step enters
                let behind = match step < 0.0 {
                    true => times.partition_point(|known| *known < time - slack),
                    false => times.partition_point(|known| *known <= time + slack),
                };
                values.get(behind.saturating_sub(1)).copied()
            }
            Source::Controller(controller) => {
                let mut number = -1;
                if let Some(sampling) = self.sampling {
                    let count = (time - start).abs() / sampling;
                    number = (count + NEAR).floor() as i64;
                    match self.last {
                        Some((last, value)) if last == number => return Some(value),
                        // a run that is taken up between two samplings has the value in its state
                        None if count - number as f64 > NEAR => return None,
                        _ => {}
                    }
                }
                let value = controller(time, state, element);
                self.last = Some((number, value));
                Some(value)
            }
        }
    }

    /// Adds the times between two others at which it changes.
    fn changes(&self, start: f64, (from, to): Piece, out: &mut Vec<f64>) {
        let (least, span) = (from.min(to), (to - from).abs());
        let inside = |time: &f64| {
            let after = time - least;
            after > NEAR * span && span - after > NEAR * span
        };
        match &self.source {
            None => {}
            Some(Source::Table { times, .. }) => {
                let first = times.partition_point(|time| *time <= least);
                let within = times[first..]
                    .iter()
                    .take_while(|time| **time < least + span);
                out.extend(within.copied().filter(inside));
            }
            Some(Source::Controller(_)) => {
                let Some(sampling) = self.sampling else {
                    return;
                };
                let sign = if to < from { -1.0 } else { 1.0 };
                let mut number = ((from - start).abs() / sampling).floor();
                loop {
                    number += 1.0;
                    let time = start + sign * number * sampling;
                    if (time - from).abs() >= span {
                        return;
                    }
                    if inside(&time) {
                        out.push(time);
                    }
                }
            }
        }
    }
}

impl<S: Scalar, P: Poisson<S>> Course<'_, S, P> {
    /// From one time to another beside the grid, or within a step: in pieces between joints and changes of inputs, if there are any within.
    pub(super) fn through(
        &mut self,
        system: &P,
        mut joints: Option<&mut Joints<S, P>>,
        (from, to): Piece,
        mu: &mut P::State,
        observer: &mut dyn Observer<S, P>,
    ) -> Result<(), IntegrateError> {
        let mut from = from;
        let changes = observer
            .held()
            .map_or_else(Vec::new, |held| held.changes((from, to)));
        for end in changes.into_iter().chain([to]) {
            let whole = [(from, end)];
            let joints = joints.as_deref_mut();
            match joints.map_or(&[][..], |joints| joints.pieces(system, whole[0])) {
                [] => self.in_pieces(system, &whole, mu, observer)?,
                pieces => self.in_pieces(system, pieces, mu, observer)?,
            }
            if end != to {
                cross(system, mu, end);
                observer.hold(system, (self.index, end, self.grid.step()), mu, &[]);
            }
            from = end;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_input_changes_at_its_samplings_alone() {
        let controller: Controller = Arc::new(|time, _, _| time);
        let input = |sampling| Input {
            source: Some(Source::Controller(controller.clone())),
            sampling,
            last: None,
        };
        let changes = |input: &Input, piece: Piece| {
            let mut times = Vec::new();
            input.changes(0.0, piece, &mut times);
            times
        };
        assert_eq!(changes(&input(None), (0.0, 1.0)), [0.0; 0]);
        assert_eq!(changes(&input(Some(0.25)), (0.0, 1.0)), [0.25, 0.5, 0.75]);
        assert_eq!(changes(&input(Some(0.25)), (0.25, 0.5)), [0.0; 0]);
        assert_eq!(changes(&input(Some(0.25)), (-0.1, -0.6)), [-0.25, -0.5]);
        // 0.3 = 3 x 0.1 but for round-off
        assert_eq!(changes(&input(Some(0.1)), (0.2, 0.3)), [0.0; 0]);
        let mut sampled = input(Some(0.1));
        let mut at = |time| sampled.value(0.0, time, 0.01, &[], &[]);
        assert_eq!(
            [at(0.0), at(0.05), at(0.1), at(0.19)],
            [Some(0.0), Some(0.0), Some(0.1), Some(0.1)]
        );
        // the tenth sampling is at 10 x 0.1, whatever the sum of tenths is
        assert_eq!(at(0.99999999999999), Some(0.99999999999999));
    }

    #[test]
    fn a_table_is_held_from_each_of_its_times() {
        let mut input = Input {
            source: Some(Source::Table {
                times: [0.0, 1.0, 2.5].into(),
                values: [3.0, 4.0, 5.0].into(),
            }),
            sampling: None,
            last: None,
        };
        let mut at = |time| input.value(0.0, time, 0.1, &[], &[]);
        assert_eq!(
            [at(-1.0), at(0.5), at(1.0), at(9.0)],
            [Some(3.0), Some(3.0), Some(4.0), Some(5.0)]
        );
        let mut back = |time| input.value(0.0, time, -0.1, &[], &[]);
        assert_eq!(
            [back(9.0), back(2.5), back(1.0), back(0.0)],
            [Some(5.0), Some(4.0), Some(3.0), Some(3.0)]
        );
        for (piece, known) in [((0.9, 2.6), [1.0, 2.5]), ((2.6, 0.9), [2.5, 1.0])] {
            let mut times = Vec::new();
            input.changes(0.0, piece, &mut times);
            times.sort_by(|a, b| (a - piece.0).abs().total_cmp(&(b - piece.0).abs()));
            assert_eq!(times, known);
        }
    }
}
