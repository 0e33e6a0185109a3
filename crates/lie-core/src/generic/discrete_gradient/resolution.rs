//! Increments of H without loss of digits.
//!
//! A discrete gradient contains `(H(y) - H(x))/|y - x|`, whose round-off `epsilon |H|/|y - x|` grows
//! without bound as the step becomes small, or the motion slow. The increment is also the integral
//! `int_0^1 <grad H(x + s (y - x)), y - x> ds`, whose round-off is that of the gradient. Hence:
//!
//! - H is a polynomial of known degree: always the integral, by the quadrature that is exact.
//! - Otherwise the difference where its round-off stays near that of the gradient. Where it does not,
//!   the integral by 10 nodes, if they resolve the integrand and the two forms agree to round-off; if not,
//!   y is not close to x on the scale on which H varies, and the difference is taken after all.
//!
//! All thresholds are ratios of like quantities: there is no absolute scale.

use crate::generic::quadrature::{MAX_NODES, Quadrature, legendre_polynomial};
use crate::scalar::Scalar;

/// The difference serves while its round-off is below that many times the gradient's.
const AMPLIFICATION: f64 = 16.0;

/// A quadrature that notices what it does not resolve.
///
/// The Legendre coefficients of the integrand fall, and the error of m nodes is of the size of that of
/// degree 2m. The last two that the nodes determine, of degrees m - 1 and m - 2, are asked to be
/// round-off: two, since one may vanish by parity, and round-off, since a part of the integrand that is
/// small may fall slowly.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rule<S> {
    quadrature: Quadrature<S>,
    /// Weights of the last two coefficients, up to a factor, per node.
    tails: [[S; 2]; MAX_NODES],
    /// Whether it is exact.
    pub(super) exact: bool,
}

impl<S: Scalar> Rule<S> {
    /// The rule for increments of a function of that degree.
    pub(super) fn of(degree: Option<u32>) -> Self {
        Self::new(Quadrature::of_degree(degree, 1))
    }

    fn new(quadrature: Quadrature<S>) -> Self {
        let count = quadrature.len();
        let degrees = [count.saturating_sub(2), count - 1];
        let mut tails = [[S::zero(); 2]; MAX_NODES];
        for (node, tails) in tails.iter_mut().enumerate().take(count) {
            let (offset, weight) = quadrature.node(node);
            *tails = degrees.map(|degree| weight * legendre_polynomial(degree, offset + offset));
        }
        let exact = quadrature.is_exact();
        Self {
            quadrature,
            tails,
            exact,
        }
    }

    pub(super) fn len(&self) -> usize {
        self.quadrature.len()
    }

    /// The place of a node, from -1/2 to 1/2, and its weight.
    #[inline]
    pub(super) fn node(&self, node: usize) -> (S, S) {
        self.quadrature.node(node)
    }

    /// The place of a node, from -1/2 to 1/2.
    #[inline]
    pub(super) fn offset(&self, node: usize) -> S {
        self.quadrature.node(node).0
    }
}

/// The lanes in which the difference of two values of H, of round-off `epsilon * energy`, serves as
/// the integral of a gradient over a distance, `reach` the product of their sizes.
pub(super) fn difference_serves<S: Scalar>(energy: S, reach: S) -> S::Mask {
    energy.less(reach * S::from_f64(AMPLIFICATION))
}

/// The mean of a function over a segment, and whether its nodes resolve it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mean<S> {
    pub(super) value: S,
    tails: [S; 2],
}

impl<S: Scalar> Mean<S> {
    pub(super) fn new() -> Self {
        Self {
            value: S::zero(),
            tails: [S::zero(); 2],
        }
    }

    /// Adds the value at a node.
    #[inline]
    pub(super) fn add(&mut self, rule: &Rule<S>, node: usize, value: S) {
        self.value += rule.quadrature.node(node).1 * value;
        for (sum, &tail) in self.tails.iter_mut().zip(&rule.tails[node]) {
            *sum += tail * value;
        }
    }

    /// The lanes in which the mean may stand for `quotient`, an increment of H times `inverse`: the
    /// integrand is resolved to the round-off of the quotient, and the two agree to it.
    pub(super) fn stands_for(&self, quotient: S, energy: S, inverse: S) -> S::Mask {
        let round_off = (S::epsilon() * energy * inverse).abs();
        let [first, second] = self.tails.map(|tail| tail.abs().less_equal(round_off));
        let limit = round_off * S::from_f64(AMPLIFICATION);
        first & second & (self.value - quotient).abs().less_equal(limit)
    }
}

/// The largest absolute value in a vector; of dual numbers that of their values.
pub(super) fn largest<S: Scalar>(entries: impl IntoIterator<Item = S>) -> S {
    entries
        .into_iter()
        .fold(S::zero(), |largest, entry| largest.max(entry.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mean of a function on [1, 1 + length], whether it may stand for its exact value, and the
    /// error.
    fn mean(nodes: usize, length: f64, of: impl Fn(f64) -> f64, expected: f64) -> (bool, f64) {
        let rule = Rule::<f64>::new(Quadrature::gauss(nodes));
        let mut mean = Mean::new();
        for node in 0..nodes {
            mean.add(&rule, node, of(1.0 + length * (0.5 + rule.offset(node))));
        }
        let stands = mean.stands_for(expected, 16.0, 1.0);
        (stands, (mean.value - expected).abs())
    }

    #[test]
    fn resolved_means_are_exact() {
        let cosine = |nodes: usize, length: f64| {
            let expected = 2.0 * (1.0 + 0.5 * length).cos() * (0.5 * length).sin() / length;
            mean(nodes, length, Scalar::cos, expected)
        };
        for (nodes, short, long) in [(6, 0.001, 3.0), (10, 0.25, 12.0)] {
            let (stands, error) = cosine(nodes, short);
            assert!(stands && error < 4e-16, "{nodes}: {stands} {error:e}");
            let (stands, error) = cosine(nodes, long);
            assert!(!stands && error > 1e-12, "{error:e}");
            // in between, no mean that is accepted has an error beyond round-off
            for k in 1..=200 {
                let (stands, error) = cosine(nodes, 0.06 * f64::from(k));
                assert!(!stands || error < 4e-16, "{k}: {error:e}");
            }
        }
    }

    #[test]
    fn a_small_part_that_is_not_resolved_is_noticed() {
        // a kink of 1e-10 at 3/2 in the middle
        let kinked = |t: f64| t + 1e-10 * (t - 1.5).abs();
        let (stands, error) = mean(10, 1.0, kinked, 1.5 + 0.25e-10);
        assert!(!stands && error > 1e-14, "{error:e}");
        assert!(mean(10, 1.0, |t| t, 1.5).0);
        assert!(!mean(10, 1.0, |t| t, 1.5 + 1e-13).0, "the two must agree");
    }

    #[test]
    fn a_point_is_resolved() {
        assert!(mean(5, 0.0, |_| 0.0, 0.0).0);
        assert!(!difference_serves(0.0_f64, 0.0));
    }
}
