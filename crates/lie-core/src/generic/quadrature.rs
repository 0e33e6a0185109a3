//! Gauss–Legendre quadrature on a segment.

use crate::poisson::Poisson;
use crate::scalar::Scalar;

/// The largest number of nodes of a rule.
pub const MAX_NODES: usize = 24;
/// Nodes where the integrand is no polynomial of known degree.
const DEFAULT_NODES: usize = 10;

/// The rule with m nodes: exact for polynomials of degree 2m - 1.
///
/// Nodes are given by their distance from the middle of the segment, in units of its length, and
/// are exactly antisymmetric: seen from the other end, the rule is the same to the last bit.
#[derive(Clone, Copy, Debug)]
pub struct Quadrature<S> {
    count: usize,
    offsets: [S; MAX_NODES],
    weights: [S; MAX_NODES],
    exact: bool,
}

impl<S: Scalar> Quadrature<S> {
    /// The rule with a number of nodes between 1 and [`MAX_NODES`].
    pub fn gauss(nodes: usize) -> Self {
        let count = nodes.clamp(1, MAX_NODES);
        let mut rule = Self {
            count,
            offsets: [S::zero(); MAX_NODES],
            weights: [S::zero(); MAX_NODES],
            exact: false,
        };
        for index in 0..count / 2 {
            let (node, weight) = node(count, index);
            rule.offsets[index] = S::from_f64(-0.5 * node);
            rule.offsets[count - 1 - index] = S::from_f64(0.5 * node);
            rule.weights[index] = S::from_f64(weight);
            rule.weights[count - 1 - index] = S::from_f64(weight);
        }
        if count % 2 == 1 {
            let derivative = legendre(count, 0.0).1;
            rule.weights[count / 2] = S::from_f64(1.0 / (derivative * derivative));
        }
        rule
    }

    /// The rule for gradients of H along a curve of degree `degree` against polynomials of degree
    /// `degree - 1`: exact where H is a polynomial of known degree, with 10 nodes elsewhere, or twice the degree if that is
    /// more.
    pub fn of_hamiltonian<P: Poisson<S>>(system: &P, degree: usize) -> Self {
        Self::of_degree(system.hamiltonian_degree(), degree)
    }

    /// The same for a function of a degree, of which nothing is known where there is none.
    pub fn of_degree(of_function: Option<u32>, degree: usize) -> Self {
        let needed = of_function.map(|of_function| (degree * of_function as usize).div_ceil(2));
        Self {
            exact: needed.is_some_and(|needed| needed <= MAX_NODES),
            ..Self::gauss(needed.unwrap_or(DEFAULT_NODES.max(2 * degree)))
        }
    }

    /// Whether the rule integrates what it was made for exactly.
    pub fn is_exact(&self) -> bool {
        self.exact
    }

    /// The number of nodes.
    #[allow(clippy::len_without_is_empty, reason = "there is at least one node")]
    pub fn len(&self) -> usize {
        self.count
    }

    /// A node, between -1/2 and 1/2 in ascending order, and its weight; the weights add up to 1.
    #[inline]
    pub fn node(&self, index: usize) -> (S, S) {
        (self.offsets[index], self.weights[index])
    }
}

/// The Legendre polynomial of a degree.
pub(super) fn legendre_polynomial<S: Scalar>(degree: usize, t: S) -> S {
    let (mut before, mut value) = (S::zero(), S::one());
    for k in 0..degree {
        let next = S::ratio((2 * k + 1) as f64, (k + 1) as f64) * t * value
            - S::ratio(k as f64, (k + 1) as f64) * before;
        (before, value) = (value, next);
    }
    value
}

/// Whether a rule that is not exact keeps the energy over a step, for which it integrates the slope
/// `<grad H(u(t)), u'(t)>` along a curve u.
///
/// It does where the values of H at both ends agree to round-off: that of H itself, and that of the
/// state in it, `epsilon sum_k |dH/dmu_k mu_k|`. Where they do not, H may have lost digits by
/// cancellation, which is no fault of the rule; then the slope decides. Its Legendre coefficients fall,
/// and the error of m nodes is of the size of that of degree 2m: the last two that the nodes determine,
/// of degrees m - 1 and m - 2, have to be round-off. Two, since one may vanish by parity; round-off,
/// since a part that is small may fall slowly.
#[derive(Clone, Copy, Debug)]
pub(super) struct EnergyBalance<S> {
    change: S,
    energy: S,
    reach: S,
    slope: S,
    tails: [S; 2],
}

impl<S: Scalar> EnergyBalance<S> {
    /// Units of round-off that are allowed.
    const UNITS: f64 = 16.0;

    /// For the energies at both ends.
    pub(super) fn new(start: S, end: S) -> Self {
        Self {
            change: (end - start).abs(),
            energy: start.abs().max(end.abs()),
            reach: S::zero(),
            slope: S::zero(),
            tails: [S::zero(); 2],
        }
    }

    /// The lanes in which there is nothing else to ask.
    pub(super) fn is_even(&self) -> S::Mask {
        let unit = S::epsilon() * S::from_f64(Self::UNITS);
        self.change.less_equal(unit * (self.energy + self.reach))
    }

    /// Adds a node: for each coordinate `dH/dmu_k`, `u_k` and `u'_k`.
    pub(super) fn add(
        &mut self,
        rule: &Quadrature<S>,
        node: usize,
        coordinates: impl Iterator<Item = (S, S, S)>,
    ) {
        let (mut slope, mut size, mut reach) = (S::zero(), S::zero(), S::zero());
        for (gradient, place, velocity) in coordinates {
            slope += gradient * velocity;
            size += (gradient * velocity).abs();
            reach += (gradient * place).abs();
        }
        self.slope = self.slope.max(size);
        self.reach = self.reach.max(reach);
        let (offset, weight) = rule.node(node);
        for (tail, back) in self.tails.iter_mut().zip(1..) {
            let degree = rule.len().saturating_sub(back);
            let norm = S::from_f64((2 * degree + 1) as f64);
            *tail += norm * weight * slope * legendre_polynomial(degree, offset + offset);
        }
    }

    /// The lanes in which the energy is kept.
    pub(super) fn holds(&self) -> S::Mask {
        let bound = S::epsilon() * S::from_f64(Self::UNITS) * self.slope;
        let [last, before] = self.tails.map(|tail| tail.abs().less_equal(bound));
        self.is_even() | (last & before)
    }
}

/// A positive zero t of the Legendre polynomial of degree n, counted from the largest, and the weight
/// `1/((1 - t^2) P_n'(t)^2)` on the segment of length 1.
fn node(n: usize, index: usize) -> (f64, f64) {
    let angle = core::f64::consts::PI * (index as f64 + 0.75) / (n as f64 + 0.5);
    let mut zero = Scalar::cos(angle);
    for _ in 0..8 {
        let (value, derivative) = legendre(n, zero);
        zero -= value / derivative;
    }
    let derivative = legendre(n, zero).1;
    let weight = 1.0 / ((1.0 - zero) * (1.0 + zero) * derivative * derivative);
    (zero, weight)
}

/// The Legendre polynomial of degree n at least 1 and its derivative, at t in (-1, 1).
fn legendre(n: usize, t: f64) -> (f64, f64) {
    let (mut before, mut value) = (1.0, t);
    for k in 1..n {
        let k = k as f64;
        let next = ((2.0 * k + 1.0) * t * value - k * before) / (k + 1.0);
        (before, value) = (value, next);
    }
    let derivative = n as f64 * (t * value - before) / ((t - 1.0) * (t + 1.0));
    (value, derivative)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generic::gauss_tableau;

    /// `sum_q w_q (2 c_q)^k`: the mean of t^k on [-1, 1] is 1/(k + 1) for even k, 0 for odd k.
    #[test]
    fn exact_to_degree_twice_the_nodes_less_one() {
        for count in 1..=MAX_NODES {
            let rule = Quadrature::<f64>::gauss(count);
            let nodes = || (0..rule.len()).map(|index| rule.node(index));
            let moment = |k: i32| -> f64 { nodes().map(|(c, w)| w * (2.0 * c).powi(k)).sum() };
            for k in 0..2 * count as i32 {
                let mean = if k % 2 == 0 {
                    1.0 / f64::from(k + 1)
                } else {
                    0.0
                };
                assert!(
                    (moment(k) - mean).abs() < 1e-15,
                    "{count} nodes, degree {k}"
                );
            }
            let k = 2 * count as i32;
            let gap = (moment(k) - 1.0 / f64::from(k + 1)).abs();
            assert!(gap > 1e-15, "{count} nodes are not exact beyond that");
        }
    }

    #[test]
    fn nodes_are_those_of_collocation() {
        let tableau = gauss_tableau::<f64, 3>();
        let rule = Quadrature::<f64>::gauss(3);
        for index in 0..3 {
            let (offset, weight) = rule.node(index);
            assert!((0.5 + offset - tableau.c[index]).abs() < 2e-16);
            assert!((weight - tableau.b[index]).abs() < 2e-16);
        }
    }
}
