//! A piece of a step as a quintic, and where functions change their signs on it.

use super::Knot;
use super::samples::{SAMPLES, SignChange, part, sign_changes};
use crate::poisson::Poisson;
use crate::scalar::Scalar;
use crate::state::State;

/// A place where a function changes its sign on the quintics: the time, and the sign behind it.
pub(super) struct Guess {
    pub(super) time: f64,
    pub(super) sign: f64,
}

/// The quintic through two knots.
pub(super) struct Quintic<'a, S: Scalar, P: Poisson<S>> {
    system: &'a P,
    ends: [&'a Knot<P::State>; 2],
    state: P::State,
    values: Vec<S>,
}

impl<'a, S: Scalar, P: Poisson<S>> Quintic<'a, S, P> {
    pub(super) fn new(system: &'a P, ends: [&'a Knot<P::State>; 2]) -> Self {
        Self {
            system,
            ends,
            state: system.zero_state(),
            values: vec![S::zero(); system.event_count()],
        }
    }

    /// The time at a part of the way.
    fn time(&self, part: f64) -> f64 {
        let [from, to] = self.ends;
        from.time + part * (to.time - from.time)
    }

    /// The functions at a part of the way.
    fn all(&mut self, part: f64) -> &[S] {
        let [from, to] = self.ends;
        let span = to.time - from.time;
        let [square, cube] = [part * part, part * part * part];
        self.state.fill(S::zero());
        for (weight, vector) in [
            (1.0 + cube * (-10.0 + part * (15.0 - 6.0 * part)), &from.mu),
            (
                span * (part + cube * (-6.0 + part * (8.0 - 3.0 * part))),
                &from.field,
            ),
            (
                span * span * 0.5 * (square + cube * (-3.0 + part * (3.0 - part))),
                &from.bend,
            ),
            (
                span * span * 0.5 * cube * (1.0 + part * (part - 2.0)),
                &to.bend,
            ),
            (span * cube * (-4.0 + part * (7.0 - 3.0 * part)), &to.field),
            (cube * (10.0 + part * (6.0 * part - 15.0)), &to.mu),
        ] {
            self.state.axpy(S::from_f64(weight), vector);
        }
        self.system.events(&self.state, &mut self.values);
        &self.values
    }

    /// Where each of the functions changes its sign, in order.
    pub(super) fn guesses(&mut self, rules: usize) -> Vec<Vec<Guess>> {
        let mut samples = vec![[0.0; SAMPLES + 1]; rules];
        for place in 1..SAMPLES {
            let values = self.all(part(place));
            for (samples, value) in samples.iter_mut().zip(values) {
                samples[place] = value.to_f64();
            }
        }
        for (index, samples) in samples.iter_mut().enumerate() {
            let [from, to] = self.ends.map(|knot| knot.values[index]);
            (samples[0], samples[SAMPLES]) = (from, to);
        }
        let of = |(index, samples): (usize, &[f64; SAMPLES + 1])| {
            let found = sign_changes(samples, &mut |part| self.all(part)[index].to_f64());
            let guesses = found.into_iter().map(|SignChange { part, sign }| Guess {
                time: self.time(part),
                sign,
            });
            guesses.collect()
        };
        samples.iter().enumerate().map(of).collect()
    }
}
