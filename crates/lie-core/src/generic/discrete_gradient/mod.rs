//! Discrete gradients: `g(x, y)` with `<g(x, y), y - x> = H(y) - H(x)` and `g(x, x) = grad H(x)`.

mod function;
mod gonzalez;
mod itoh_abe;
mod mean_value;
mod resolution;

pub(super) use function::declared;
pub use function::{Energy, Entropy, Function};
pub use gonzalez::GonzalezGradient;
pub use itoh_abe::ItohAbeGradient;
pub use mean_value::MeanValueGradient;

use crate::poisson::Poisson;
use crate::scalar::{Mask as _, Scalar};
use crate::state::State;

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
    /// The lanes in which `<g(x, y), y - x> = H(y) - H(x)` holds; others need a shorter step.
    fn resolved(&mut self, _system: &P, _end: &P::State) -> S::Mask {
        S::Mask::splat(true)
    }
}

/// `1/|d|` with `d = end - start`, and 0 where d is 0: what a fused discrete gradient multiplies by
/// terms that vanish faster. Squares stay within the range of the scalar. What [`Energy`] does not follow does not count.
pub fn inverse_length<S: Scalar, P: Poisson<S>>(
    system: &P,
    start: &P::State,
    end: &P::State,
) -> [S; 1] {
    let difference = || {
        let pairs = end.as_slice().iter().zip(start.as_slice()).enumerate();
        let counted = pairs.filter(|(i, _)| <Energy as Function<S, P>>::counts(system, *i));
        counted.map(|(_, (&end, &start))| end - start)
    };
    let size = resolution::largest(difference());
    let flat = size.less_equal(S::zero());
    let unit = S::one() / S::select(flat, S::one(), size);
    let mut square = S::zero();
    for entry in difference() {
        let entry = entry * unit;
        square += entry * entry;
    }
    let inverse = unit / S::select(flat, S::one(), square).sqrt();
    [S::select(flat, S::zero(), inverse)]
}
