//! What steps ask of the flow.

use super::super::kernels::multiply;
use super::super::motion::Motion;
use super::{FrozenFlow, NODES};
use crate::matrix::SquareMatrix as _;
use crate::methods::Retraction;
use crate::poisson::Poisson;
use crate::scalar::{Mask as _, Scalar};
use crate::state::State as _;

/// A whole motion takes so many sweeps.
const SWEEPS: f64 = 8.0;

/// What derivatives of the motion in so many coordinates cost over a sweep: 3.4 whole motions were counted of three, 8 to 10 of five and six, in
/// generated code, since they take sweeps for each.
pub(in crate::generic) fn jacobian_cost(dimension: usize) -> f64 {
    SWEEPS * (2.0 * dimension as f64 - 2.0)
}

impl<S, P> Motion<S, P> for FrozenFlow<S, P::State, P::Jacobian>
where
    S: Scalar,
    P: Poisson<S>,
{
    fn new(system: &P) -> Self {
        Self::new(system)
    }

    fn begin(&mut self) {
        self.begin();
    }

    fn carry(&mut self, system: &P, x: &P::State, start: &P::State, out: &mut P::State) {
        self.go(system, [x, start], |_, _| ());
        out.copy_from(&self.end);
    }

    fn approach(
        &mut self,
        system: &P,
        ends: [&P::State; 2],
        out: &mut P::State,
        active: S::Mask,
    ) -> S {
        let changed = self.approach(system, ends, active);
        out.copy_from(&self.reached);
        changed
    }

    fn conclude(&mut self) {
        self.conclude();
    }

    /// `sum_j b_j Pi(y_j) g`
    fn mean(&mut self, system: &P, [x, start, g]: [&P::State; 3], out: &mut P::State) {
        out.fill(S::zero());
        self.go(system, [x, start], |flow, lanes| {
            for node in 0..NODES {
                flow.set_node(node);
                system.poisson_matrix(&flow.node, &mut flow.matrix);
                multiply(&flow.matrix, g, &mut flow.slot);
                let weight = flow.weights[node] / flow.parts;
                let weight = S::select(lanes, weight, S::zero());
                out.axpy(weight, &flow.slot);
            }
        });
    }

    fn linearize(&mut self, system: &P, x: &P::State, [start, end]: [&P::State; 2]) {
        self.differentiate(system, [x, start], system.is_forced());
        let ends = start.as_slice().iter().zip(end.as_slice());
        for (entry, (&start, &end)) in self.node.as_mut_slice().iter_mut().zip(ends) {
            *entry = S::ratio(1.0, 2.0) * (start + end);
        }
        system.poisson_matrix(&self.node, &mut self.matrix);
    }

    fn slope(
        &mut self,
        _system: &P,
        _x: &P::State,
        [along, out, _]: [&mut P::State; 3],
        _end: &P::State,
    ) -> S::Mask {
        multiply(&self.tangent.of_x, along, out);
        S::Mask::splat(true)
    }

    fn push(&mut self, _system: &P, _x: &P::State, [along, out, _]: [&mut P::State; 3]) {
        multiply(&self.tangent.of_start, along, out);
    }

    /// With the Poisson matrix in the middle between the ends.
    fn mean_slope(
        &mut self,
        system: &P,
        [g, along]: [&P::State; 2],
        unit: usize,
        [out, _spare, _turned]: [&mut P::State; 3],
    ) {
        multiply(&self.matrix, along, out);
        system.poisson_slope(&self.node, g, &mut self.turned);
        for (row, out) in out.as_mut_slice().iter_mut().enumerate() {
            *out += S::ratio(1.0, 2.0) * self.turned.get(row, unit);
        }
    }

    fn jacobian_cost(dimension: usize) -> Option<f64> {
        Some(jacobian_cost(dimension))
    }

    fn resolved(&self) -> S::Mask {
        self.is_resolved()
    }

    fn retraction() -> Option<Retraction> {
        None
    }
}
