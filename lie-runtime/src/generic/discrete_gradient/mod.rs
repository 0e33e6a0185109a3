//! Discrete gradients: `g(x, y)` with `<g(x, y), y - x> = H(y) - H(x)` and `g(x, x) = grad H(x)`.

mod gonzalez;
mod itoh_abe;
mod mean_value;
mod resolution;

pub use gonzalez::GonzalezGradient;
pub use itoh_abe::ItohAbeGradient;
pub use mean_value::MeanValueGradient;

use crate::poisson::Poisson;
use crate::scalar::Scalar;

/// A discrete gradient of the Hamiltonian of a system, with its derivative in the second argument.
///
/// All are symmetric: `g(x, y) = g(y, x)`.
pub trait DiscreteGradient<S: Scalar, P: Poisson<S>> {
    /// The discrete gradient with its scratch space.
    fn new(system: &P) -> Self;
    /// Sets the first argument x.
    fn set_start(&mut self, system: &P, start: &P::State);
    /// The discrete gradient `out = g(x, y)`.
    fn value(&mut self, system: &P, end: &P::State, out: &mut P::State);
    /// The discrete gradient and its derivative in y: `derivative_ij = dg_i/dy_j`, every entry.
    fn linearize(
        &mut self,
        system: &P,
        end: &P::State,
        out: &mut P::State,
        derivative: &mut P::Jacobian,
    );
}
