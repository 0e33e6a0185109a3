//! The equation of collective symplectic Runge–Kutta methods in the momenta of their stages.

use super::blocks::factor;
use super::kernels::direction;
use super::matrix_stages::MatrixStages;
use super::quaternion_stages::QuaternionStages;
use super::tableau::{Tableau, gauss_tableau};
use crate::equation::Equation;
use crate::matrix::{SquareMatrix, StageMatrix};
use crate::methods::Retraction;
use crate::poisson::LiePoisson;
use crate::scalar::{Mask as _, Scalar};
use crate::state::{Stages, State, copies};
use crate::structure::MatrixPoisson;

/// The momenta `M_i` of the stages of a Gauss method on a space over g*, on which elements of the algebra
/// act linearly, as functions of the elements `x_j = h b_j grad H(m_j)` along which the stages move.
pub trait StageMap<S: Scalar, P: LiePoisson<S>, const STAGES: usize> {
    /// Whether [`StageMap::within_chart`] is true for all x.
    fn everywhere(system: &P) -> bool;
    /// The map of a system; it may keep scratch space.
    fn new(system: &P, tableau: &Tableau<S, STAGES>) -> Self;
    /// `out_i = M_i(x_1, ..., x_s)` for a step from mu.
    fn momenta(
        &mut self,
        system: &P,
        mu: &P::State,
        x: &Stages<P::State, STAGES>,
        out: &mut Stages<P::State, STAGES>,
    );
    /// The same, and the derivatives: block (i, j) of `slopes` is `dM_i/dx_j`.
    fn linearize(
        &mut self,
        system: &P,
        mu: &P::State,
        x: &Stages<P::State, STAGES>,
        out: &mut Stages<P::State, STAGES>,
        slopes: &mut StageMatrix<P::Jacobian, STAGES>,
    );
    /// The lanes in which the linear systems of the stages have solutions for `s x_j` with every s from 0 to 1, so
    /// that the step is joined to the identity.
    fn within_chart(&mut self, _system: &P, _x: &Stages<P::State, STAGES>) -> S::Mask {
        S::Mask::splat(true)
    }
    /// The element along which a step moves the group element, where it is not that of the Gauss method
    /// applied to the entries of the declared matrices.
    fn group_factor(
        &mut self,
        _system: &P,
        _x: &Stages<P::State, STAGES>,
        _xi: &mut P::State,
    ) -> Option<Retraction> {
        None
    }
}

/// Gauss methods on a space over g*, reduced to g*.
///
/// Unknown: the momenta `m_i` of the stages. Equation: `r_i = m_i - M_i(x_1, ..., x_s)`,
/// `x_j = h b_j grad H(m_j)`, with the [`StageMap`] M. Jacobian: `delta_ij - (dM_i/dx_j) h b_j H''(m_j)`.
/// New state: `mu + sum_i ad*_(x_i) m_i`. Start: `m_i = mu + c_i h f(mu + (c_i/2) h f(mu))`, with one
/// stage `mu + (h/2) f(mu)`.
#[derive(Debug)]
pub struct StageMomenta<'a, S: Scalar, P: LiePoisson<S>, M, const STAGES: usize> {
    system: &'a P,
    step: S,
    tableau: Tableau<S, STAGES>,
    /// `h b_i`
    weights: [S; STAGES],
    map: M,
    base: P::State,
    point: P::State,
    field: P::State,
    x: Stages<P::State, STAGES>,
    momenta: Stages<P::State, STAGES>,
    slopes: StageMatrix<P::Jacobian, STAGES>,
    hessian: P::Jacobian,
}

/// The Gauss methods on `T*V` of the declared representation V: [`StageMomenta`] over matrices.
pub type MatrixMomenta<'a, S, P, const STAGES: usize> =
    StageMomenta<'a, S, P, MatrixStages<S, <P as MatrixPoisson<S>>::Matrix, STAGES>, STAGES>;

/// The Gauss methods on `T*R^2` for each spin: [`StageMomenta`] over quaternions.
pub type QuaternionMomenta<'a, S, P, const STAGES: usize> =
    StageMomenta<'a, S, P, QuaternionStages<S, STAGES>, STAGES>;

impl<'a, S, P, M, const STAGES: usize> StageMomenta<'a, S, P, M, STAGES>
where
    S: Scalar,
    P: LiePoisson<S>,
    M: StageMap<S, P, STAGES>,
{
    /// The equation of a step of size h.
    pub fn new(system: &'a P, h: S) -> Self {
        let zero = system.zero_state();
        let tableau = gauss_tableau::<S, STAGES>();
        let stages = || Stages(copies(&zero));
        Self {
            system,
            step: h,
            map: M::new(system, &tableau),
            weights: tableau.b.map(|b| h * b),
            tableau,
            base: zero.clone(),
            point: zero.clone(),
            field: zero.clone(),
            x: stages(),
            momenta: stages(),
            slopes: StageMatrix(copies(&copies(&system.zero_jacobian()))),
            hessian: system.zero_jacobian(),
        }
    }

    /// Sets `x_i = h b_i grad H(m_i)`.
    fn set_directions(&mut self, unknown: &Stages<P::State, STAGES>) {
        for ((x, momentum), &weight) in self.x.0.iter_mut().zip(&unknown.0).zip(&self.weights) {
            direction(self.system, weight, momentum, x);
        }
    }

    /// `r_i = m_i - M_i`
    fn write_residual(
        &self,
        unknown: &Stages<P::State, STAGES>,
        residual: &mut Stages<P::State, STAGES>,
    ) {
        for stage in 0..STAGES {
            let pairs = unknown.0[stage].as_slice().iter();
            let pairs = pairs.zip(self.momenta.0[stage].as_slice());
            for (out, (&momentum, &map)) in residual.0[stage].as_mut_slice().iter_mut().zip(pairs) {
                *out = momentum - map;
            }
        }
    }
}

impl<S, P, M, const STAGES: usize> Equation<S> for StageMomenta<'_, S, P, M, STAGES>
where
    S: Scalar,
    P: LiePoisson<S>,
    M: StageMap<S, P, STAGES>,
{
    crate::generic::unknown_of_stages!();

    /// As counted of the built maps: the residual has linear systems of its own.
    fn jacobian_cost(&self) -> f64 {
        let size = self.system.dimension() as f64;
        1.0 + size * size / 8.0
    }

    fn set_base(&mut self, mu: &P::State) {
        self.base.copy_from(mu);
    }

    fn initial_guess(&mut self, unknown: &mut Self::Unknown) {
        self.system.vector_field(&self.base, &mut self.field);
        let half = S::ratio(1.0, 2.0);
        for (stage, momentum) in unknown.0.iter_mut().enumerate() {
            let time = self.tableau.c[stage] * self.step;
            momentum.copy_from(&self.base);
            if STAGES == 1 {
                momentum.axpy(time, &self.field);
                continue;
            }
            self.point.copy_from(&self.base);
            self.point.axpy(half * time, &self.field);
            let slope = &mut self.x.0[stage];
            self.system.vector_field(&self.point, slope);
            momentum.axpy(time, slope);
        }
    }

    fn residual(&mut self, unknown: &Self::Unknown, residual: &mut Self::Unknown) {
        self.set_directions(unknown);
        self.map
            .momenta(self.system, &self.base, &self.x, &mut self.momenta);
        self.write_residual(unknown, residual);
    }

    fn linearize(
        &mut self,
        unknown: &Self::Unknown,
        residual: &mut Self::Unknown,
        matrix: &mut Self::Matrix,
    ) {
        self.set_directions(unknown);
        self.map.linearize(
            self.system,
            &self.base,
            &self.x,
            &mut self.momenta,
            &mut self.slopes,
        );
        self.write_residual(unknown, residual);
        for column_stage in 0..STAGES {
            self.system
                .generator_slope(&unknown.0[column_stage], &mut self.hessian);
            for row_stage in 0..STAGES {
                let slopes = &self.slopes.0[row_stage][column_stage];
                let block = &mut matrix.0[row_stage][column_stage];
                for column in 0..self.system.dimension() {
                    for row in 0..self.system.dimension() {
                        let identity = row_stage == column_stage && row == column;
                        block.set(row, column, if identity { S::one() } else { S::zero() });
                    }
                    for through in 0..self.system.dimension() {
                        let curvature =
                            self.weights[column_stage] * self.hessian.get(through, column);
                        if curvature == S::zero() {
                            continue;
                        }
                        for row in 0..self.system.dimension() {
                            let product = slopes.get(row, through) * curvature;
                            block.set(row, column, block.get(row, column) - product);
                        }
                    }
                }
            }
        }
    }

    fn factor(&self, matrix: &mut Self::Matrix) -> S::Mask {
        factor(matrix)
    }

    fn within_chart(&mut self, unknown: &Self::Unknown) -> S::Mask {
        if M::everywhere(self.system) {
            return S::Mask::splat(true);
        }
        self.set_directions(unknown);
        self.map.within_chart(self.system, &self.x)
    }

    fn group_factor(&mut self, unknown: &Self::Unknown, xi: &mut P::State) -> Option<Retraction> {
        self.set_directions(unknown);
        self.map.group_factor(self.system, &self.x, xi)
    }

    fn velocity(&mut self, unknown: &Self::Unknown, stage: usize, xi: &mut P::State) -> usize {
        direction(self.system, self.step, &unknown.0[stage], xi);
        STAGES
    }

    fn result(&mut self, unknown: &Self::Unknown, mu: &mut P::State) {
        // ad*_(x_i) m_i = h b_i f(m_i)
        self.point.fill(S::zero());
        for (momentum, &weight) in unknown.0.iter().zip(&self.weights) {
            self.system.vector_field(momentum, &mut self.field);
            self.point.axpy(weight, &self.field);
        }
        mu.copy_from(&self.base);
        mu.axpy(S::one(), &self.point);
    }
}
