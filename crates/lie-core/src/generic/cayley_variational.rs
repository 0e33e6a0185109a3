//! The equation of the step of a discrete Lagrangian in Cayley coordinates.

use super::chart::cayley_chart;
use super::inverse_tangent::dcay_inverse_dual;
use super::kernels::multiply;
use crate::equation::Equation;
use crate::lagrangian::{
    DeclaredDiscreteLagrangian, DiscreteLagrangian, DiscreteLagrangianPoisson, LagrangianOfStep,
    LagrangianPoisson,
};
use crate::matrix::SquareMatrix;
use crate::methods::Retraction;
use crate::poisson::CayleyPoisson;
use crate::scalar::Scalar;
use crate::state::{State, copies};

/// The discrete Euler–Poincaré step `(dcay_x^-1)* l_d'(x) = mu`, `mu1 = Ad*_(cay x) mu`, for an algebra with a
/// triple-closed representation.
///
/// Unknown: x, of the reduced Lagrangian l the product `h xi`. Equation, with `m = l_d'(x)` and the constant matrix
/// `W = l_d''(x0)^-1`: `r(x) = W (m - ad*_x m/2 - Q_x m/4 - mu)`, `(Q_x m)_b = T_abc^d x^a x^c m_d`. New state:
/// `mu + ad*_x m`. Jacobian, column j: W times the terms linear in m applied to `l_d''(x) e_j`, and
/// `-ad*_(e_j) m/2 - (T_jbc^d x^c m_d)_b/2`. Start: `x = x0 + W ad*_x0 mu/2`, where `l_d'(x0) = mu`.
#[derive(Debug)]
pub struct CayleyVariational<'a, S: Scalar, P: CayleyPoisson<S>, L = LagrangianOfStep<'a, S, P>> {
    system: &'a P,
    l_d: L,
    base: P::State,
    start: P::State,
    weight: P::Jacobian,
    momentum: P::State,
    curvature: P::Jacobian,
    columns: [P::State; 4],
}

impl<'a, S: Scalar, P: LagrangianPoisson<S> + CayleyPoisson<S>> CayleyVariational<'a, S, P> {
    /// The equation of a step of size h of the Lagrangian.
    pub fn new(system: &'a P, h: S) -> Self {
        Self::with_discrete(system, LagrangianOfStep::new(system, h))
    }
}

/// The same for a declared discrete Lagrangian.
pub type CayleyDiscrete<'a, S, P> =
    CayleyVariational<'a, S, P, DeclaredDiscreteLagrangian<'a, S, P>>;

impl<'a, S, P> CayleyDiscrete<'a, S, P>
where
    S: Scalar,
    P: DiscreteLagrangianPoisson<S> + CayleyPoisson<S>,
{
    /// The equation of a step of size h of the declared discrete Lagrangian.
    pub fn new(system: &'a P, h: S) -> Self {
        Self::with_discrete(system, DeclaredDiscreteLagrangian::new(system, h))
    }
}

impl<'a, S, P, L> CayleyVariational<'a, S, P, L>
where
    S: Scalar,
    P: CayleyPoisson<S>,
    L: DiscreteLagrangian<S, State = P::State, Jacobian = P::Jacobian>,
{
    /// The equation of the step of a discrete Lagrangian.
    pub fn with_discrete(system: &'a P, l_d: L) -> Self {
        let zero = system.zero_state();
        Self {
            system,
            l_d,
            base: zero.clone(),
            start: zero.clone(),
            weight: system.zero_jacobian(),
            momentum: zero.clone(),
            curvature: system.zero_jacobian(),
            columns: copies(&zero),
        }
    }
}

impl<S, P, L> Equation<S> for CayleyVariational<'_, S, P, L>
where
    S: Scalar,
    P: CayleyPoisson<S>,
    L: DiscreteLagrangian<S, State = P::State, Jacobian = P::Jacobian>,
{
    crate::generic::unknown_of_a_state!();

    fn set_base(&mut self, mu: &P::State) {
        self.base.copy_from(mu);
        self.l_d.start(mu, &mut self.start, &mut self.weight);
    }

    fn initial_guess(&mut self, unknown: &mut P::State) {
        let [action, correction, ..] = &mut self.columns;
        self.system.ad_star(&self.start, &self.base, action);
        multiply(&self.weight, action, correction);
        unknown.copy_from(&self.start);
        unknown.axpy(S::ratio(1.0, 2.0), correction);
    }

    fn residual(&mut self, unknown: &P::State, residual: &mut P::State) {
        let [defect, ..] = &mut self.columns;
        self.l_d.slope(unknown, &mut self.momentum);
        dcay_inverse_dual(self.system, unknown, &self.momentum, defect);
        defect.axpy(-S::one(), &self.base);
        multiply(&self.weight, defect, residual);
    }

    fn linearize(&mut self, unknown: &P::State, residual: &mut P::State, matrix: &mut P::Jacobian) {
        self.residual(unknown, residual);
        self.l_d.curvature(unknown, &mut self.curvature);
        let minus_half = S::ratio(-1.0, 2.0);
        let [unit, along, total, out] = &mut self.columns;
        for column in 0..self.system.dimension() {
            for (row, entry) in along.as_mut_slice().iter_mut().enumerate() {
                *entry = self.curvature.get(row, column);
            }
            dcay_inverse_dual(self.system, unknown, along, total);
            unit.fill(S::zero());
            unit.as_mut_slice()[column] = S::one();
            self.system.ad_star(unit, &self.momentum, out);
            total.axpy(minus_half, out);
            self.system.triple(unit, unknown, &self.momentum, out);
            total.axpy(minus_half, out);
            multiply(&self.weight, total, out);
            for (row, &entry) in out.as_slice().iter().enumerate() {
                matrix.set(row, column, entry);
            }
        }
    }

    fn result(&mut self, unknown: &P::State, mu: &mut P::State) {
        self.l_d.slope(unknown, &mut self.momentum);
        let [action, ..] = &mut self.columns;
        self.system.ad_star(unknown, &self.momentum, action);
        mu.copy_from(&self.base);
        mu.axpy(S::one(), action);
    }

    fn within_chart(&mut self, unknown: &P::State) -> S::Mask {
        cayley_chart(self.system, unknown)
    }

    fn group_factor(&mut self, unknown: &P::State, xi: &mut P::State) -> Option<Retraction> {
        xi.copy_from(unknown);
        Some(Retraction::Cayley)
    }
}
