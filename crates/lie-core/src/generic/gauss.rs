//! The equation of Gauss collocation.

use super::kernels::direction;
use super::tableau::{Tableau, gauss_tableau};
use crate::equation::Equation;
use crate::matrix::SquareMatrix;
use crate::poisson::Poisson;
use crate::scalar::Scalar;
use crate::state::{Stages, State};

/// Gauss collocation with 1, 2 or 3 stages for any Poisson system.
///
/// Unknown: the increments `D_i` of the stages. Equation: `r_i = D_i - h b_i f(Y_i)` with
/// `Y_i = mu + sum_j (a_ij/b_j) D_j`, the tableau (a, b, c), the step size h and the vector field f. New
/// state: `mu + sum_i D_i`. Jacobian: `dr_i/dD_j = delta_ij - h b_i (a_ij/b_j) Df(Y_i)`.
/// Start: `D_i = h b_i f(mu + c_i h f(mu))`.
#[derive(Debug)]
pub struct Gauss<'a, S: Scalar, P: Poisson<S>, const STAGES: usize> {
    system: &'a P,
    step: S,
    tableau: Tableau<S, STAGES>,
    /// `h b_i`
    weights: [S; STAGES],
    base: P::State,
    point: P::State,
    field: P::State,
    jacobian: P::Jacobian,
}

impl<'a, S: Scalar, P: Poisson<S>, const STAGES: usize> Gauss<'a, S, P, STAGES> {
    /// The equation of a step of size h.
    pub fn new(system: &'a P, h: S) -> Self {
        let zero = system.zero_state();
        let tableau = gauss_tableau();
        Self {
            system,
            step: h,
            weights: tableau.b.map(|b| h * b),
            tableau,
            base: zero.clone(),
            point: zero.clone(),
            field: zero,
            jacobian: system.zero_jacobian(),
        }
    }

    /// Sets the point to `Y_i`.
    fn set_point(&mut self, stage: usize, increments: &Stages<P::State, STAGES>) {
        for (index, point) in self.point.as_mut_slice().iter_mut().enumerate() {
            let mut sum = S::zero();
            for (&ratio, increment) in self.tableau.ratios[stage].iter().zip(&increments.0) {
                sum += ratio * increment.as_slice()[index];
            }
            *point = self.base.as_slice()[index] + sum;
        }
    }

    /// `r_i = D_i - h b_i f` with the field at the point already computed.
    fn write_residual(&self, stage: usize, increment: &P::State, residual: &mut P::State) {
        let pairs = increment.as_slice().iter().zip(self.field.as_slice());
        for (out, (&increment, &field)) in residual.as_mut_slice().iter_mut().zip(pairs) {
            *out = increment - self.weights[stage] * field;
        }
    }
}

impl<S: Scalar, P: Poisson<S>, const STAGES: usize> Equation<S> for Gauss<'_, S, P, STAGES> {
    crate::generic::unknown_of_stages!();

    fn set_base(&mut self, mu: &P::State) {
        self.base.copy_from(mu);
    }

    fn initial_guess(&mut self, unknown: &mut Self::Unknown) {
        // the slope at the base is kept in the last increment until that one is due
        self.system
            .vector_field(&self.base, &mut unknown.0[STAGES - 1]);
        for stage in 0..STAGES {
            self.point.copy_from(&self.base);
            self.point
                .axpy(self.tableau.c[stage] * self.step, &unknown.0[STAGES - 1]);
            self.system.vector_field(&self.point, &mut self.field);
            let pairs = unknown.0[stage]
                .as_mut_slice()
                .iter_mut()
                .zip(self.field.as_slice());
            for (increment, &field) in pairs {
                *increment = self.weights[stage] * field;
            }
        }
    }

    fn residual(&mut self, unknown: &Self::Unknown, residual: &mut Self::Unknown) {
        for stage in 0..STAGES {
            self.set_point(stage, unknown);
            self.system.vector_field(&self.point, &mut self.field);
            self.write_residual(stage, &unknown.0[stage], &mut residual.0[stage]);
        }
    }

    fn linearize(
        &mut self,
        unknown: &Self::Unknown,
        residual: &mut Self::Unknown,
        matrix: &mut Self::Matrix,
    ) {
        for stage in 0..STAGES {
            self.set_point(stage, unknown);
            self.system
                .linearize(&self.point, &mut self.field, &mut self.jacobian);
            self.write_residual(stage, &unknown.0[stage], &mut residual.0[stage]);
            for (other, block) in matrix.0[stage].iter_mut().enumerate() {
                let factor = self.weights[stage] * self.tableau.ratios[stage][other];
                for row in 0..self.system.dimension() {
                    for column in 0..self.system.dimension() {
                        block.set(row, column, -(factor * self.jacobian.get(row, column)));
                    }
                    if stage == other {
                        block.set(row, row, S::one() + block.get(row, row));
                    }
                }
            }
        }
    }

    fn velocity(&mut self, unknown: &Self::Unknown, stage: usize, xi: &mut P::State) -> usize {
        self.set_point(stage, unknown);
        direction(self.system, self.step, &self.point, xi);
        STAGES
    }

    fn result(&mut self, unknown: &Self::Unknown, mu: &mut P::State) {
        for (index, out) in mu.as_mut_slice().iter_mut().enumerate() {
            let mut sum = S::zero();
            for increment in &unknown.0 {
                sum += increment.as_slice()[index];
            }
            *out = self.base.as_slice()[index] + sum;
        }
    }
}
