//! The length of the steps.

use super::StageParallel;
use super::program::{PER_STEP, PER_WEIGHT, WEIGHTS};
use crate::generic::tableau::gauss_weight;
use crate::scalar::Scalar;
use crate::state::State;
use core::array::from_fn;

/// `h b_i` and `1/|h b_i|` in the places of the stages, 0 in the others.
pub(super) fn weights<S: Scalar>(stages: usize, h: S) -> [S::Wide; 2] {
    let all: [S; 8] = from_fn(|i| match i < stages {
        true => h * gauss_weight::<S>(stages, i),
        false => S::zero(),
    });
    let per = |i: usize| match i < stages {
        true => S::one() / all[i].abs(),
        false => S::zero(),
    };
    [S::gather(all), S::gather(from_fn(per))]
}

impl<S: Scalar, V: State<S::Wide>> StageParallel<S, V> {
    /// Makes the steps to come of size h, with two products. The next one starts from the polynomial of the last one as it would go
    /// on over a step as long as that, times the ratio of both; what is known of iterations stays.
    pub(crate) fn set_step(&mut self, h: S) {
        let longer = (h / self.step).widen();
        for increments in self.work.increments.as_mut_slice() {
            *increments *= longer;
        }
        self.step = h;
        let per_step = (S::one() / h.abs()).widen();
        let [weights, per_weights] = self.unit;
        self.table[WEIGHTS] = weights * h.widen();
        self.table[PER_WEIGHT] = per_weights * per_step;
        self.table[PER_STEP] = per_step;
        self.known_size = None;
    }
}
