//! The symmetrised coordinate-increment discrete gradient of Itoh and Abe.

use super::DiscreteGradient;
use super::resolution::{Mean, Rule, difference_serves, largest};
use crate::matrix::SquareMatrix;
use crate::poisson::Poisson;
use crate::scalar::{Mask, Scalar};
use crate::state::State;

/// The mean of the increments of H along two paths of edges from x to y.
///
/// One path changes the coordinates in their order, with the corners
/// `w_i = (y_1, .., y_i, x_(i+1), .., x_n)`, the other one in the opposite order, with
/// `v_i = (x_1, .., x_i, y_(i+1), .., y_n)`:
/// `g_i = [H(w_i) - H(w_(i-1)) + H(v_(i-1)) - H(v_i)]/(2 (y_i - x_i))`. Either quotient is the mean of
/// `dH/dmu_i` along its edge; which form is taken decides the round-off of either, per lane and edge.
///
/// Derivative: of the first quotient q in `y_j`, `(dH/dmu_j(w_i) - dH/dmu_j(w_(i-1)))/(y_i - x_i)` for
/// `j < i`, `(dH/dmu_i(w_i) - q)/(y_i - x_i)` for `j = i`, and 0 for `j > i`; of the second alike. These
/// are means of the Hessian along the edge, and taken as such for a polynomial of known degree and on an
/// edge whose length is below the root of round-off.
#[derive(Clone, Debug)]
pub struct ItohAbeGradient<S: Scalar, P: Poisson<S>> {
    rule: Rule<S>,
    start: P::State,
    /// The corner or point of an edge.
    corner: P::State,
    gradient: P::State,
    /// Gradients at the corners before and after an edge.
    before: P::State,
    after: P::State,
    hessian: P::Jacobian,
    /// Size of the state, of the gradient and of the terms of H.
    size: S,
    steepness: S,
    terms: S,
}

/// Which path, and so which end of it depends on y.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Path {
    /// From x to y.
    There,
    /// From y to x.
    Back,
}

impl<S: Scalar, P: Poisson<S>> ItohAbeGradient<S, P> {
    /// Measures the state, the gradient and the terms of H between x and y.
    fn measure(&mut self, system: &P, end: &P::State) {
        let half = S::ratio(1.0, 2.0);
        let (x, y) = (self.start.as_slice(), end.as_slice());
        self.size = largest(x.iter().chain(y).copied());
        if self.rule.exact {
            return;
        }
        for (index, corner) in self.corner.as_mut_slice().iter_mut().enumerate() {
            *corner = half * (x[index] + y[index]);
        }
        system.gradient(&self.corner, &mut self.gradient);
        self.steepness = largest(self.gradient.as_slice().iter().copied());
        self.terms = S::zero();
        for (&point, &slope) in self.corner.as_slice().iter().zip(self.gradient.as_slice()) {
            self.terms += (point * slope).abs();
        }
    }

    /// The mean of `dH/dmu_i` along an edge from the corner. Leaves the corner in place.
    fn integral(&mut self, system: &P, index: usize, (from, to): (S, S)) -> Mean<S> {
        let rule = &self.rule;
        let mut mean = Mean::new();
        let middle = S::ratio(1.0, 2.0) * (from + to);
        for node in 0..rule.len() {
            self.corner.as_mut_slice()[index] = middle + rule.offset(node) * (to - from);
            system.gradient(&self.corner, &mut self.gradient);
            let value = self.gradient.as_slice()[index];
            mean.add(rule, node, value);
        }
        self.corner.as_mut_slice()[index] = from;
        mean
    }

    /// Adds half the quotients of a path to `out`, and half their derivatives in y.
    fn walk(
        &mut self,
        system: &P,
        end: &P::State,
        path: Path,
        out: &mut P::State,
        mut derivative: Option<&mut P::Jacobian>,
    ) {
        let half = S::ratio(1.0, 2.0);
        let there = path == Path::There;
        self.corner.copy_from(if there { &self.start } else { end });
        let differences = !self.rule.exact;
        let mut energy = S::zero();
        if differences {
            energy = system.hamiltonian(&self.corner);
        }
        if differences && derivative.is_some() {
            system.gradient(&self.corner, &mut self.before);
        }
        for index in 0..system.dimension() {
            let (x, y) = (self.start.as_slice()[index], end.as_slice()[index]);
            let (from, to) = if there { (x, y) } else { (y, x) };
            let length = to - from;
            let short = S::epsilon().sqrt() * self.size;
            let near = S::Mask::splat(!differences) | length.abs().less_equal(short);
            if let Some(matrix) = derivative.as_deref_mut()
                && near.any()
            {
                self.short_edge(system, index, (from, to), path, near, matrix);
            }
            let quotient = if differences {
                let (quotient, after) = self.quotient(system, index, (from, to), energy);
                energy = after;
                quotient
            } else {
                self.integral(system, index, (from, to)).value
            };
            out.as_mut_slice()[index] += half * quotient;
            self.corner.as_mut_slice()[index] = to;
            if let Some(matrix) = derivative.as_deref_mut()
                && differences
            {
                system.gradient(&self.corner, &mut self.after);
                if !near.all() {
                    let inverse = half / S::select(near, S::one(), length);
                    self.long_edge(index, quotient, inverse, path, near, matrix);
                }
                core::mem::swap(&mut self.before, &mut self.after);
            }
        }
    }

    /// The quotient of an edge by whichever form keeps its digits, and H at its end.
    fn quotient(&mut self, system: &P, index: usize, (from, to): (S, S), energy: S) -> (S, S) {
        let length = to - from;
        self.corner.as_mut_slice()[index] = to;
        let after = system.hamiltonian(&self.corner);
        self.corner.as_mut_slice()[index] = from;
        let noise = energy.abs() + after.abs() + self.terms;
        let flat = length.abs().less_equal(S::zero());
        let inverse = S::one() / S::select(flat, S::one(), length);
        let difference = (after - energy) * inverse;
        let serves = difference_serves(noise, self.steepness * length.abs());
        if serves.all() {
            return (difference, after);
        }
        let mean = self.integral(system, index, (from, to));
        let stands = !serves & (mean.stands_for(difference, noise, inverse) | flat);
        (S::select(stands, mean.value, difference), after)
    }

    /// The derivative on an edge that is not short, from the gradients at its corners;
    /// `inverse` is half the inverse of its length.
    fn long_edge(
        &self,
        index: usize,
        quotient: S,
        inverse: S,
        path: Path,
        near: S::Mask,
        matrix: &mut P::Jacobian,
    ) {
        let (before, after) = (self.before.as_slice(), self.after.as_slice());
        let there = path == Path::There;
        // of the other coordinates those that are y on this edge
        let columns = if there {
            0..index
        } else {
            index + 1..matrix.dimension()
        };
        for column in columns {
            let slope = (after[column] - before[column]) * inverse;
            add(matrix, index, column, S::select(near, S::zero(), slope));
        }
        let rise = if there {
            after[index] - quotient
        } else {
            quotient - before[index]
        };
        add(
            matrix,
            index,
            index,
            S::select(near, S::zero(), rise * inverse),
        );
    }

    /// The derivative on a short edge, from the Hessian: the mean along it where the quadrature is
    /// exact, else the value at the middle.
    #[allow(clippy::too_many_arguments, reason = "the edge and where to write")]
    fn short_edge(
        &mut self,
        system: &P,
        index: usize,
        (from, to): (S, S),
        path: Path,
        near: S::Mask,
        matrix: &mut P::Jacobian,
    ) {
        let half = S::ratio(1.0, 2.0);
        let there = path == Path::There;
        let nodes = if self.rule.exact { self.rule.len() } else { 1 };
        for node in 0..nodes {
            let (offset, weight) = if self.rule.exact {
                self.rule.node(node)
            } else {
                (S::zero(), S::one())
            };
            self.corner.as_mut_slice()[index] = half * (from + to) + offset * (to - from);
            system.hessian(&self.corner, &mut self.hessian);
            let weight = half * weight;
            // of the other coordinates those that are y on this edge
            let columns = if there {
                0..index
            } else {
                index + 1..system.dimension()
            };
            for column in columns {
                let slope = weight * self.hessian.get(index, column);
                add(matrix, index, column, S::select(near, slope, S::zero()));
            }
            let share = half + if there { offset } else { -offset };
            let slope = weight * share * self.hessian.get(index, index);
            add(matrix, index, index, S::select(near, slope, S::zero()));
        }
        self.corner.as_mut_slice()[index] = from;
    }

    fn evaluate(
        &mut self,
        system: &P,
        end: &P::State,
        out: &mut P::State,
        mut derivative: Option<&mut P::Jacobian>,
    ) {
        self.measure(system, end);
        out.fill(S::zero());
        for path in [Path::There, Path::Back] {
            self.walk(system, end, path, out, derivative.as_deref_mut());
        }
    }
}

/// Adds to an entry.
fn add<S: Scalar, M: SquareMatrix<S>>(matrix: &mut M, row: usize, column: usize, term: S) {
    matrix.set(row, column, matrix.get(row, column) + term);
}

impl<S: Scalar, P: Poisson<S>> DiscreteGradient<S, P> for ItohAbeGradient<S, P> {
    fn new(system: &P) -> Self {
        let zero = system.zero_state();
        Self {
            rule: Rule::of(system.hamiltonian_degree()),
            start: zero.clone(),
            corner: zero.clone(),
            gradient: zero.clone(),
            before: zero.clone(),
            after: zero,
            hessian: system.zero_jacobian(),
            size: S::zero(),
            steepness: S::zero(),
            terms: S::zero(),
        }
    }

    fn set_start(&mut self, _system: &P, start: &P::State) {
        self.start.copy_from(start);
    }

    fn value(&mut self, system: &P, end: &P::State, out: &mut P::State) {
        self.evaluate(system, end, out, None);
    }

    fn linearize(
        &mut self,
        system: &P,
        end: &P::State,
        out: &mut P::State,
        derivative: &mut P::Jacobian,
    ) {
        for row in 0..system.dimension() {
            for column in 0..system.dimension() {
                derivative.set(row, column, S::zero());
            }
        }
        self.evaluate(system, end, out, Some(derivative));
    }
}
