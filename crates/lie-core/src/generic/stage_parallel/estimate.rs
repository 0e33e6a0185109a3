//! What the stages of a step tell of its error.

use super::StageParallel;
use crate::clock::holds;
use crate::generic::diagonals::{diagonals, product};
use crate::generic::tableau::gauss_legendre;
use crate::scalar::Scalar;
use crate::state::State;

/// Coefficients of the slopes that shrink more slowly than by so much from one degree to the next tell no error.
const SHRINKS: f64 = 0.8;

/// Coefficients of so many units of round-off are round-off.
const UNSEEN: f64 = 256.0;

impl<S: Scalar, V: State<S::Wide>> StageParallel<S, V> {
    /// The error of the step that was made, relative to the size of its end, by the stages: with the coefficients L_k of h F in
    /// Legendre polynomials, each the largest of all coordinates, it is about
    ///
    /// ```text
    /// e = L_s^2/max_k L_k,    L_s = max(L_(s-1), L_(s-2)) sqrt(max(L_(s-1), L_(s-2))/max(L_(s-3), L_(s-4)))
    /// ```
    ///
    /// because both the defect of the polynomial and the test function that meets it begin with degree s (superconvergence). It
    /// is ten to thirty times too large on smooth orbits. Where the coefficients do not shrink, as across a kink, the last of
    /// them are the error.
    pub fn estimate(&mut self) -> S {
        let Self {
            stages,
            legendre,
            work,
            base,
            ..
        } = self;
        let stages = *stages;
        let table = legendre.get_or_insert_with(|| {
            diagonals(stages, stages, &|k, j| gauss_legendre::<S>(stages, k, j))
        });
        let table = *table;
        let (mut largest, mut size) = (S::Wide::zero(), S::Wide::zero());
        let entries = work.increments.as_slice().iter().zip(base.as_slice());
        for (k, (&increments, &y)) in entries.enumerate() {
            if holds(self.clock, k) {
                continue;
            }
            let per_unit = match &self.momenta {
                Some((entries, per_unit)) if entries.contains(&k) => *per_unit,
                _ => S::one(),
            };
            let coefficients = match stages {
                ..5 => product::<S, 4>(&table, increments),
                _ => product::<S, 8>(&table, increments),
            };
            largest = largest.max(coefficients.magnitude() * per_unit.widen());
            size = size.max(y.magnitude() * per_unit.widen());
        }
        let coefficients = S::scatter(largest);
        let [size, ..] = S::scatter(size);
        let pair = |last: usize| coefficients[last].max(coefficients[last.saturating_sub(1)]);
        let most = coefficients.iter().fold(S::zero(), |most, &c| most.max(c));
        let (high, low) = (pair(stages - 1), pair(stages.saturating_sub(3)));
        let ratio = (high / low).sqrt();
        let shrinks = ratio.less(S::from_f64(SHRINKS));
        let unseen = high.less_equal(S::epsilon() * S::from_f64(UNSEEN) * most);
        let next = S::select(shrinks, high * ratio, high);
        let error = next / most * (next / size);
        let error = S::select(shrinks | unseen, error, high / size);
        S::select(most.less_equal(S::zero()), S::zero(), error)
    }
}
