//! The flow of a Poisson matrix against a direction that is held.

mod motion;
mod reached;
mod tangent;

use super::kernels::multiply;
use super::tableau::{MOST_STAGES, gauss_legendre, gauss_ratio, gauss_weight};
use crate::matrix::SquareMatrix;
use crate::poisson::Poisson;
use crate::scalar::{Mask as _, Scalar};
use crate::state::{State, copies};
pub(super) use motion::jacobian_cost;
use reached::{LAST, RESOLVED, Reached};
use tangent::Tangent;

/// Nodes of Gauss collocation, of order 16.
const NODES: usize = MOST_STAGES;
/// Sweeps over the nodes beyond which the way is divided.
const MOST_SWEEPS: usize = 40;
/// The way has at most so many parts.
const MOST_PARTS: f64 = 64.0;
/// Nodes are found where a sweep changes none by more than so many units of round-off of the state.
const CLOSE: f64 = 2.0;
/// Nodes that were approached are a start where the last sweep changed none by more than so much beside the state.
const NEAR: f64 = 1e-6;

/// `y' = Pi(y) x` over unit time by Gauss collocation at eight nodes,
///
/// ```text
/// y_i = y(0) + sum_j a_ij Pi(y_j) x,   y(1) = y(0) + sum_j b_j Pi(y_j) x
/// ```
///
/// to round-off: where the nodes are not found by iteration, or do not resolve the way, it is divided. So every Casimir of y(0) is that
/// of y(1), for any Poisson matrix, and `<x, y(1)> = <x, y(0)>`, since Pi is antisymmetric, whatever the error of the nodes.
#[derive(Clone, Debug)]
pub struct FrozenFlow<S: Scalar, V, M> {
    ratios: [[S; NODES]; NODES],
    weights: [S; NODES],
    /// `1 - c_j`, what is left of the way behind each node.
    left: [S; NODES],
    /// `(2k + 1) P_k` at the nodes, of the highest degrees.
    last: [[S; NODES]; LAST],
    /// `b_j Pi(y_j) x` of a part of the way.
    increments: [V; NODES],
    /// The lanes in which the increments are those of a direction near to the one that comes.
    warm: S::Mask,
    /// Those of an iteration that changes the direction too, while it goes on, and what they leave at the end of the way.
    approached: [V; NODES],
    /// Whether there are any, and the lanes in which they are near to a way in one part.
    approaching: bool,
    near: S::Mask,
    parts: S,
    resolved: S::Mask,
    /// x over the number of parts, where a part starts and where it comes to, where the way ends.
    direction: V,
    start: V,
    reached: V,
    end: V,
    node: V,
    slot: V,
    matrix: M,
    turned: M,
    tangent: Tangent<V, M>,
}

impl<S: Scalar, V: State<S>, M: SquareMatrix<S>> FrozenFlow<S, V, M> {
    /// The flow with its scratch space.
    pub(super) fn new<P>(system: &P) -> Self
    where
        P: Poisson<S, State = V, Jacobian = M>,
    {
        let zero = system.zero_state();
        let matrix = system.zero_jacobian();
        Self {
            ratios: core::array::from_fn(|i| core::array::from_fn(|j| gauss_ratio(NODES, i, j))),
            weights: core::array::from_fn(|i| gauss_weight(NODES, i)),
            left: core::array::from_fn(|j| {
                // `sum_i b_i a_ij / b_j`
                let mut left = S::zero();
                for i in 0..NODES {
                    left += gauss_weight::<S>(NODES, i) * gauss_ratio(NODES, i, j);
                }
                left
            }),
            last: core::array::from_fn(|k| {
                core::array::from_fn(|j| gauss_legendre(NODES, NODES - LAST + k, j))
            }),
            increments: copies(&zero),
            warm: S::Mask::splat(false),
            approached: copies(&zero),
            approaching: false,
            near: S::Mask::splat(false),
            parts: S::one(),
            resolved: S::Mask::splat(true),
            direction: zero.clone(),
            start: zero.clone(),
            reached: zero.clone(),
            end: zero.clone(),
            node: zero.clone(),
            slot: zero.clone(),
            turned: matrix.clone(),
            tangent: Tangent::new(&zero, &matrix),
            matrix,
        }
    }

    /// A new step begins: nothing of the last one is to be seen in it.
    pub(super) fn begin(&mut self) {
        self.warm = S::Mask::splat(false);
        self.approaching = false;
        self.near = S::Mask::splat(false);
        self.parts = S::one();
    }

    /// The lanes in which the last motion is as exact as its scalar.
    pub(super) fn is_resolved(&self) -> S::Mask {
        self.resolved
    }

    /// The derivative of the mean of the states in the direction x, of the motion along x from a start.
    pub(super) fn mean_by_direction<P>(&mut self, system: &P, given: [&V; 2]) -> &M
    where
        P: Poisson<S, State = V, Jacobian = M>,
    {
        self.differentiate(system, given, false);
        &self.tangent.of_mean
    }

    /// A node from the start of a part.
    fn set_node(&mut self, node: usize) {
        let rows = self.node.as_mut_slice().iter_mut();
        for (k, (entry, &start)) in rows.zip(self.start.as_slice()).enumerate() {
            let mut sum = S::zero();
            for (&ratio, increment) in self.ratios[node].iter().zip(&self.increments) {
                sum += ratio * increment.as_slice()[k];
            }
            *entry = start + sum;
        }
    }

    /// Solves a part of the way from `start` but for lanes that keep their nodes; leaves where it comes to. Returns the lanes in which it is
    /// exact.
    fn part<P>(&mut self, system: &P, kept: S::Mask) -> S::Mask
    where
        P: Poisson<S, State = V, Jacobian = M>,
    {
        let known = self.warm | kept;
        if !known.all() {
            self.set_increments(system, known);
        }
        let mut found = kept;
        for _ in 0..MOST_SWEEPS {
            if found.all() {
                break;
            }
            let change = self.sweep(system, found);
            // a way from zero has the size of what it reaches
            let size = S::largest_magnitude(&[system.norm(&self.start), system.norm(&self.node)]);
            let close = S::from_f64(CLOSE) * S::epsilon() * size;
            // the last sweep is as much nearer as the one before, or not a number
            found = found | change.less_equal(close) | !change.finite();
        }
        self.warm = S::Mask::splat(true);
        let Reached { rest, size } = self.reach(system);
        found & rest.less_equal(size)
    }

    /// Sets the increments of all nodes by the field at the start, but for lanes that know theirs.
    fn set_increments<P>(&mut self, system: &P, known: S::Mask)
    where
        P: Poisson<S, State = V, Jacobian = M>,
    {
        system.poisson_matrix(&self.start, &mut self.matrix);
        multiply(&self.matrix, &self.direction, &mut self.slot);
        for (&weight, increment) in self.weights.iter().zip(&mut self.increments) {
            let fields = self.slot.as_slice().iter();
            for (entry, &field) in increment.as_mut_slice().iter_mut().zip(fields) {
                *entry = S::select(known, *entry, weight * field);
            }
        }
    }

    /// A sweep over the nodes of the way in one part, from those of the sweep before, along a direction near to that: an iteration that
    /// changes the direction finds both. Leaves where they come to, and lanes that are not active as they are. Returns how far the nodes are
    /// from those of a way in one part, by what has changed and by what they do not resolve.
    fn approach<P>(&mut self, system: &P, ends: [&V; 2], active: S::Mask) -> S
    where
        P: Poisson<S, State = V, Jacobian = M>,
    {
        self.parts = S::one();
        self.warm = S::Mask::splat(false);
        self.set_out(ends);
        if self.approaching {
            core::mem::swap(&mut self.increments, &mut self.approached);
        } else {
            self.set_increments(system, S::Mask::splat(false));
            self.sweep(system, !active);
        }
        self.approaching = true;
        let change = self.sweep(system, !active);
        let Reached { rest, size } = self.reach(system);
        core::mem::swap(&mut self.increments, &mut self.approached);
        let resolved = rest.less_equal(size);
        let near = resolved & change.less_equal(S::from_f64(NEAR) * size);
        self.near = near & active | self.near & !active;
        let missing = rest * S::from_f64(RESOLVED[LAST - 1]);
        S::select(resolved, change, S::largest_magnitude(&[change, missing]))
    }

    /// The direction is found: the nodes start from those that were approached along the way to it, where they came near. No other lane,
    /// and nothing that was asked beside, is seen in that.
    pub(super) fn conclude(&mut self) {
        self.parts = S::one();
        self.warm = self.near;
        let pairs = self.increments.iter_mut().zip(&self.approached);
        for (increment, approached) in pairs {
            increment.copy_from(approached);
        }
    }

    /// The mean of the states along the way as far as [`FrozenFlow::approach`] has come: `sum_j b_j y_j`, and
    /// `sum_i b_i a_ij = b_j (1 - c_j)`.
    pub(super) fn approach_mean<P>(
        &mut self,
        system: &P,
        ends: [&V; 2],
        mean: &mut V,
        active: S::Mask,
    ) -> S
    where
        P: Poisson<S, State = V, Jacobian = M>,
    {
        let changed = self.approach(system, ends, active);
        mean.fill(S::zero());
        for (&left, increment) in self.left.iter().zip(&self.approached) {
            mean.axpy(left, increment);
        }
        mean.axpy(S::one(), &self.start);
        changed
    }

    /// Sets one increment after the other by those that are there, but for the lanes that have ended; returns the largest change.
    fn sweep<P>(&mut self, system: &P, ended: S::Mask) -> S
    where
        P: Poisson<S, State = V, Jacobian = M>,
    {
        let mut largest = S::zero();
        for node in 0..NODES {
            self.set_node(node);
            system.poisson_matrix(&self.node, &mut self.matrix);
            multiply(&self.matrix, &self.direction, &mut self.slot);
            let new = self.slot.as_mut_slice().iter_mut();
            let old = self.increments[node].as_mut_slice().iter_mut();
            for (new, old) in new.zip(old) {
                let next = S::select(ended, *old, self.weights[node] * *new);
                (*new, *old) = (next - *old, next);
            }
            largest = S::largest_magnitude(&[largest, system.norm(&self.slot)]);
        }
        largest
    }

    /// Goes all the way from a start, in as many parts as it takes, and shows each of them with the lanes to which it belongs; leaves its end.
    /// No lane sees another.
    fn go<P>(&mut self, system: &P, ends: [&V; 2], mut show: impl FnMut(&mut Self, S::Mask))
    where
        P: Poisson<S, State = V, Jacobian = M>,
    {
        self.resolved = S::Mask::splat(false);
        loop {
            self.resolved = self.resolved | self.walk(system, ends, self.resolved, |_, _| ());
            let divided = self.parts.less(S::from_f64(MOST_PARTS)) & !self.resolved;
            if !divided.any() {
                break;
            }
            self.warm = self.resolved & self.is_whole();
            self.parts = S::select(divided, self.parts + self.parts, self.parts);
        }
        // the nodes of a way in one part are there
        let whole = self.is_whole();
        self.set_out(ends);
        show(self, whole);
        if !whole.all() {
            self.warm = whole;
            self.walk(system, ends, whole, &mut show);
            self.warm = whole;
        }
    }

    /// The mean of the states along the way from a start, and its end: `sum_j b_j y_j` and `y(1)`.
    pub(super) fn middle<P>(&mut self, system: &P, [x, start]: [&V; 2], [mean, end]: [&mut V; 2])
    where
        P: Poisson<S, State = V, Jacobian = M>,
    {
        mean.fill(S::zero());
        self.go(system, [x, start], |flow, lanes| {
            for node in 0..NODES {
                flow.set_node(node);
                let weight = S::select(lanes, flow.weights[node] / flow.parts, S::zero());
                mean.axpy(weight, &flow.node);
            }
        });
        end.copy_from(&self.end);
    }

    /// The lanes in which the way has one part.
    fn is_whole(&self) -> S::Mask {
        self.parts.less_equal(S::one())
    }

    /// Begins with the first part of the way.
    fn set_out(&mut self, [x, start]: [&V; 2]) {
        self.start.copy_from(start);
        for (entry, &x) in self.direction.as_mut_slice().iter_mut().zip(x.as_slice()) {
            *entry = x / self.parts;
        }
    }

    /// Goes through the parts of the way but for lanes that have arrived, which keep their nodes and their end. Returns the lanes in which all
    /// parts are exact.
    fn walk<P>(
        &mut self,
        system: &P,
        ends: [&V; 2],
        arrived: S::Mask,
        mut show: impl FnMut(&mut Self, S::Mask),
    ) -> S::Mask
    where
        P: Poisson<S, State = V, Jacobian = M>,
    {
        self.set_out(ends);
        let mut exact = S::Mask::splat(true);
        let mut left = self.parts;
        loop {
            let open = S::zero().less(left) & exact & !arrived;
            if !open.any() {
                break;
            }
            exact = exact & (self.part(system, !open) | !open);
            show(self, open);
            for (start, &reached) in self
                .start
                .as_mut_slice()
                .iter_mut()
                .zip(self.reached.as_slice())
            {
                *start = S::select(open, reached, *start);
            }
            left -= S::one();
            // the next part has other nodes
            self.warm = self.warm & !open;
        }
        for (end, &there) in self
            .end
            .as_mut_slice()
            .iter_mut()
            .zip(self.start.as_slice())
        {
            *end = S::select(arrived, *end, there);
        }
        self.warm = self.is_whole();
        exact
    }
}
