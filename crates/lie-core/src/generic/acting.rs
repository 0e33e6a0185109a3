//! Space that a step needs only where something acts beside the Hamiltonian.

use crate::poisson::Poisson;
use crate::scalar::Scalar;

/// What is there where forces or damping act. It is asked for with the system, whose answer is a constant as a rule: then
/// nothing of it is left in the step of a system where nothing acts.
#[derive(Clone, Debug)]
pub(super) struct Acting<T>(Option<T>);

impl<T> Acting<T> {
    /// Makes it where something acts.
    pub(super) fn of<S: Scalar, P: Poisson<S>>(system: &P, make: impl FnOnce() -> T) -> Self {
        Self(acts(system).then(make))
    }

    /// Makes it where something acts and the condition holds.
    pub(super) fn where_both<S: Scalar, P: Poisson<S>>(
        system: &P,
        condition: bool,
        make: impl FnOnce() -> T,
    ) -> Self {
        Self((condition && acts(system)).then(make))
    }

    /// It, where something acts.
    #[inline(always)]
    pub(super) fn get<S: Scalar, P: Poisson<S>>(&self, system: &P) -> Option<&T> {
        self.0.as_ref().filter(|_| acts(system))
    }

    /// The same to be changed.
    #[inline(always)]
    pub(super) fn get_mut<S: Scalar, P: Poisson<S>>(&mut self, system: &P) -> Option<&mut T> {
        self.0.as_mut().filter(|_| acts(system))
    }
}

#[inline(always)]
fn acts<S: Scalar, P: Poisson<S>>(system: &P) -> bool {
    system.is_forced() || system.is_damped()
}
