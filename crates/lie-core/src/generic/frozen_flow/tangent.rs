//! The derivative of the flow along a direction that is held.

use super::super::kernels::multiply;
use super::{FrozenFlow, MOST_SWEEPS, NODES};
use crate::matrix::SquareMatrix;
use crate::poisson::Poisson;
use crate::scalar::{Mask as _, Scalar};
use crate::state::{State, copies};

/// Sweeps end where they change a derivative by no more than that part of it: an error e of a Jacobian leaves e times the last update of
/// Newton's iteration, which is below the root of round-off.
const DIGITS: f64 = 1.0 / (1u64 << 30) as f64;

/// The derivative with its space.
#[derive(Clone, Debug)]
pub(super) struct Tangent<V, M> {
    /// That of the end in x, and in the start.
    pub(super) of_x: M,
    pub(super) of_start: M,
    /// That of the mean of the states along the way in x.
    pub(super) of_mean: M,
    /// `Pi(y_j)` and `D(Pi x)(y_j)` of a part of the way.
    at_nodes: [(M, M); NODES],
    /// The changes of the increments.
    changes: [V; NODES],
    at: V,
    field: V,
}

impl<V: Clone, M: Clone> Tangent<V, M> {
    pub(super) fn new(zero: &V, matrix: &M) -> Self {
        Self {
            of_x: matrix.clone(),
            of_start: matrix.clone(),
            of_mean: matrix.clone(),
            at_nodes: core::array::from_fn(|_| (matrix.clone(), matrix.clone())),
            changes: copies(zero),
            at: zero.clone(),
            field: zero.clone(),
        }
    }
}

impl<S: Scalar, V: State<S>, M: SquareMatrix<S>> FrozenFlow<S, V, M> {
    /// Computes the derivatives in x, and that in the start where it is asked for, of the motion along x from a start.
    pub(in super::super) fn differentiate<P>(
        &mut self,
        system: &P,
        [x, start]: [&V; 2],
        with_start: bool,
    ) where
        P: Poisson<S, State = V, Jacobian = M>,
    {
        for row in 0..system.dimension() {
            for column in 0..system.dimension() {
                let identity = if row == column { S::one() } else { S::zero() };
                self.tangent.of_x.set(row, column, S::zero());
                self.tangent.of_start.set(row, column, identity);
                self.tangent.of_mean.set(row, column, S::zero());
            }
        }
        self.go(system, [x, start], |flow, lanes| {
            flow.follow(system, with_start, lanes);
        });
    }

    /// Takes the derivatives over a part of the way, in the lanes to which it belongs.
    fn follow<P>(&mut self, system: &P, with_start: bool, lanes: S::Mask)
    where
        P: Poisson<S, State = V, Jacobian = M>,
    {
        for node in 0..NODES {
            self.set_node(node);
            let (matrix, slope) = &mut self.tangent.at_nodes[node];
            system.poisson_matrix(&self.node, matrix);
            system.poisson_slope(&self.node, &self.direction, slope);
        }
        for column in 0..system.dimension() {
            self.slot.fill(S::zero());
            self.slot.as_mut_slice()[column] = S::one() / self.parts;
            get(&self.tangent.of_x, column, &mut self.node);
            self.vary();
            set(&mut self.tangent.of_x, (column, lanes), &self.node);
            for (row, &change) in self.tangent.at.as_slice().iter().enumerate() {
                let share = S::select(lanes, change / self.parts, S::zero());
                let sum = self.tangent.of_mean.get(row, column) + share;
                self.tangent.of_mean.set(row, column, sum);
            }
            if with_start {
                self.slot.fill(S::zero());
                get(&self.tangent.of_start, column, &mut self.node);
                self.vary();
                set(&mut self.tangent.of_start, (column, lanes), &self.node);
            }
        }
    }

    /// The change of the end, in place of that of the start in `node`, and of the mean of the states, in `at`, where x changes by what is
    /// in `slot`: `e_i = e_0 + sum_j a_ij (Pi(y_j) dx + D(Pi x)(y_j) e_j)`, and `sum_i b_i e_i`, where `sum_i b_i a_ij = b_j (1 - c_j)`.
    fn vary(&mut self) {
        let Tangent {
            at_nodes,
            changes,
            at,
            field,
            ..
        } = &mut self.tangent;
        for change in &mut *changes {
            change.fill(S::zero());
        }
        let mut found = S::Mask::splat(false);
        for _ in 0..MOST_SWEEPS {
            let (mut moved, mut size) = (S::zero(), S::zero());
            for (node, (matrix, slope)) in at_nodes.iter().enumerate() {
                for (k, entry) in at.as_mut_slice().iter_mut().enumerate() {
                    *entry = self.node.as_slice()[k];
                    for (&ratio, change) in self.ratios[node].iter().zip(&*changes) {
                        *entry += ratio * change.as_slice()[k];
                    }
                }
                multiply(matrix, &self.slot, field);
                for (row, entry) in field.as_mut_slice().iter_mut().enumerate() {
                    for (column, &at) in at.as_slice().iter().enumerate() {
                        *entry += slope.get(row, column) * at;
                    }
                    let change = &mut changes[node].as_mut_slice()[row];
                    let new = S::select(found, *change, self.weights[node] * *entry);
                    moved = S::largest_magnitude(&[moved, new - *change]);
                    size = S::largest_magnitude(&[size, new]);
                    *change = new;
                }
            }
            found = found | moved.less_equal(S::from_f64(DIGITS) * size);
            if found.all() {
                break;
            }
        }
        let entries = self.node.as_mut_slice().iter_mut();
        for (k, (entry, mean)) in entries.zip(at.as_mut_slice()).enumerate() {
            *mean = *entry;
            for (&left, change) in self.left.iter().zip(&*changes) {
                *mean += left * change.as_slice()[k];
                *entry += change.as_slice()[k];
            }
        }
    }
}

fn get<S: Scalar, V: State<S>, M: SquareMatrix<S>>(matrix: &M, column: usize, out: &mut V) {
    for (row, entry) in out.as_mut_slice().iter_mut().enumerate() {
        *entry = matrix.get(row, column);
    }
}

/// Sets a column of a matrix in some lanes.
fn set<S: Scalar, V: State<S>, M: SquareMatrix<S>>(
    matrix: &mut M,
    (column, lanes): (usize, S::Mask),
    values: &V,
) {
    for (row, &value) in values.as_slice().iter().enumerate() {
        let entry = S::select(lanes, value, matrix.get(row, column));
        matrix.set(row, column, entry);
    }
}
