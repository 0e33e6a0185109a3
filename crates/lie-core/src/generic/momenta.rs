//! The size of the momenta on `T*G`.

use crate::clock::holds;
use crate::scalar::Scalar;
use crate::state::State;
use crate::structure::CotangentPoisson;

/// `|mu|`, or 1 where it is 0: the largest magnitude of the momenta but for that of the time.
#[inline]
pub(super) fn size<S: Scalar, P: CotangentPoisson<S>>(system: &P, mu: &P::State) -> S {
    let mut size = S::zero();
    let momenta = mu.as_slice()[..system.momenta()].iter().enumerate();
    for (_, momentum) in momenta.filter(|(i, _)| !holds(system.clock(), *i)) {
        size = size.max(momentum.magnitude());
    }
    S::select(S::zero().less(size), size, S::one())
}
