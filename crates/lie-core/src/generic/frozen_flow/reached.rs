//! Where a part of the way comes to, and whether its nodes resolve it.

use super::FrozenFlow;
use crate::matrix::SquareMatrix;
use crate::poisson::Poisson;
use crate::scalar::Scalar;
use crate::state::State;

/// Coefficients 6 and 7 of the slopes in Legendre polynomials, beside the state, up to which the end has all its digits: coefficients fall by
/// a factor r from one to the next, and the error at the end is as large as coefficient 16, `r^16 <= 2^-57`. Slopes that are even about the
/// middle of the way have no odd coefficients, and odd ones no even ones.
pub(super) const RESOLVED: [f64; LAST] = [1.0 / (1u64 << 21) as f64, 1.0 / (1u64 << 25) as f64];
/// So many coefficients are looked at.
pub(super) const LAST: usize = 2;

/// What is known of a part of the way at its end.
pub(super) struct Reached<S> {
    /// The largest of the last coefficients of its slopes, over what its digits allow.
    pub rest: S,
    /// The size of the states, above which `rest` resolves nothing.
    pub size: S,
}

impl<S: Scalar, V: State<S>, M: SquareMatrix<S>> FrozenFlow<S, V, M> {
    /// Leaves where a part comes to.
    pub(super) fn reach<P>(&mut self, system: &P) -> Reached<S>
    where
        P: Poisson<S, State = V, Jacobian = M>,
    {
        let mut rest = S::zero();
        for (bound, weights) in RESOLVED.iter().zip(&self.last) {
            self.slot.fill(S::zero());
            for (&weight, increment) in weights.iter().zip(&self.increments) {
                self.slot.axpy(weight, increment);
            }
            let coefficient = system.norm(&self.slot) / S::from_f64(*bound);
            rest = S::largest_magnitude(&[rest, coefficient]);
        }
        // the sum is rounded at its own size, and once at that of the state
        self.reached.fill(S::zero());
        for increment in &self.increments {
            self.reached.axpy(S::one(), increment);
        }
        self.reached.axpy(S::one(), &self.start);
        let ends = [system.norm(&self.start), system.norm(&self.reached)];
        Reached {
            rest,
            size: S::largest_magnitude(&ends),
        }
    }
}
