//! What is to be integrated.

use crate::poisson::Poisson;
use crate::scalar::Scalar;
use crate::state::State as _;
use nalgebra::SVector;

/// A system, an initial state and a span of time.
///
/// Where the Hamiltonian depends on the time, the time of the initial state is the start of the span, whatever the state says.
#[derive(Clone, Debug)]
pub struct Problem<S: Scalar, P: Poisson<S>> {
    /// The system with its parameters.
    pub system: P,
    /// The state at the start.
    pub mu0: P::State,
    /// Start and end; the end may lie before the start.
    pub span: (f64, f64),
}

/// What a state of type V is made from: a state, or an array with a number for each coordinate.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a state of this system",
    label = "not one number for each coordinate",
    note = "a state is an array with as many numbers as the system has coordinates, or a vector of `lie_runtime::nalgebra` of that length; \
            the declaration lists the coordinates behind `state`"
)]
pub trait IntoState<V> {
    /// The state.
    fn into_state(self) -> V;
}

impl<V> IntoState<V> for V {
    fn into_state(self) -> V {
        self
    }
}

impl<S: Scalar, const N: usize> IntoState<SVector<S, N>> for [S; N] {
    fn into_state(self) -> SVector<S, N> {
        self.into()
    }
}

#[cfg(feature = "std")]
impl<S, const N: usize> IntoState<std::vec::Vec<S>> for [S; N] {
    fn into_state(self) -> std::vec::Vec<S> {
        self.into()
    }
}

#[cfg(feature = "std")]
impl<S: Clone> IntoState<std::vec::Vec<S>> for &[S] {
    fn into_state(self) -> std::vec::Vec<S> {
        self.to_vec()
    }
}

impl<S: Scalar, P: Poisson<S>> Problem<S, P> {
    /// A problem from system, initial state and span `(t0, t1)`.
    pub fn new(system: P, mu0: impl IntoState<P::State>, span: (f64, f64)) -> Self {
        Self {
            system,
            mu0: mu0.into_state(),
            span,
        }
    }

    /// The initial state, at the time of the start.
    pub(super) fn start(&self) -> P::State {
        let mut mu = self.mu0.clone();
        set_time(&self.system, &mut mu, self.span.0);
        mu
    }
}

/// Sets the time of a state, where the Hamiltonian depends on it ([`Poisson::clock`]): whoever makes steps without a driver sets
/// it to `t0 + k h` after each.
#[inline(always)]
pub fn set_time<S: Scalar, P: Poisson<S>>(system: &P, mu: &mut P::State, time: f64) {
    if let Some(clock) = system.clock() {
        mu.as_mut_slice()[clock.time] = S::from_f64(time);
    }
}
