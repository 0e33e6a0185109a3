//! What is to be integrated.

use crate::poisson::Poisson;
use crate::scalar::Scalar;

/// A system, an initial state and a span of time.
#[derive(Clone, Debug)]
pub struct Problem<S: Scalar, P: Poisson<S>> {
    /// The system with its parameters.
    pub system: P,
    /// The state at the start.
    pub mu0: P::State,
    /// Start and end; the end may lie before the start.
    pub span: (f64, f64),
}

impl<S: Scalar, P: Poisson<S>> Problem<S, P> {
    /// A problem from system, initial state and span `(t0, t1)`.
    pub fn new(system: P, mu0: impl Into<P::State>, span: (f64, f64)) -> Self {
        Self {
            system,
            mu0: mu0.into(),
            span,
        }
    }
}
