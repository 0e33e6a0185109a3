//! The equation of the Lie–Poisson midpoint method along a retraction that the system declares.

use super::generating::Generating2;
use crate::equation::Equation;
use crate::generating::GeneratingFunction;
use crate::matrix::SquareMatrix;
use crate::methods::Retraction;
use crate::scalar::Scalar;
use crate::state::State;
use crate::structure::RetractedPoisson;

/// The method `mu1 = Ad*_tau(x) mu`, `x = h grad H(m)`, of a declared retraction tau.
///
/// Unknown: the momentum m. Equation: `r(m) = m - (dtau_x)^* mu`, dtau the right-trivialised tangent. New state: `Ad*_tau(x) mu`, on the
/// coadjoint orbit to round-off whatever the error of m. Jacobian: `1 - h d/dx[(dtau_x)^* mu] H''(m)`.
/// Start: `m = mu + (h/2) f(mu)`.
#[derive(Debug)]
pub struct DeclaredMidpoint<'a, S: Scalar, P: RetractedPoisson<S>> {
    system: &'a P,
    function: Generating2<'a, S, P>,
    step: S,
    base: P::State,
    x: P::State,
    hessian: P::Jacobian,
    slope: P::Jacobian,
}

impl<'a, S: Scalar, P: RetractedPoisson<S>> DeclaredMidpoint<'a, S, P> {
    /// The equation of a step of size h.
    pub fn new(system: &'a P, h: S) -> Self {
        let zero = system.zero_state();
        Self {
            system,
            function: Generating2::new(system, h),
            step: h,
            base: zero.clone(),
            x: zero,
            hessian: system.zero_jacobian(),
            slope: system.zero_jacobian(),
        }
    }

    /// The residual for the element x.
    fn evaluate(&self, unknown: &P::State, residual: &mut P::State) {
        self.system
            .retraction_pullback(&self.x, &self.base, residual);
        let entries = residual.as_mut_slice().iter_mut();
        for (entry, &m) in entries.zip(unknown.as_slice()) {
            *entry = m - *entry;
        }
    }
}

impl<S: Scalar, P: RetractedPoisson<S>> Equation<S> for DeclaredMidpoint<'_, S, P> {
    crate::generic::unknown_of_a_state!();

    fn set_base(&mut self, mu: &P::State) {
        self.base.copy_from(mu);
    }

    fn initial_guess(&mut self, unknown: &mut P::State) {
        self.system.vector_field(&self.base, &mut self.x);
        unknown.copy_from(&self.base);
        unknown.axpy(self.step * S::ratio(1.0, 2.0), &self.x);
    }

    fn residual(&mut self, unknown: &P::State, residual: &mut P::State) {
        self.function.gradient(unknown, &mut self.x);
        self.evaluate(unknown, residual);
    }

    fn linearize(&mut self, unknown: &P::State, residual: &mut P::State, matrix: &mut P::Jacobian) {
        self.function
            .linearize(unknown, &mut self.x, &mut self.hessian);
        self.evaluate(unknown, residual);
        self.system
            .retraction_slope(&self.x, &self.base, &mut self.slope);
        let n = self.system.dimension();
        for row in 0..n {
            for column in 0..n {
                let mut entry = if row == column { S::one() } else { S::zero() };
                for k in 0..n {
                    entry -= self.slope.get(row, k) * self.hessian.get(k, column);
                }
                matrix.set(row, column, entry);
            }
        }
    }

    fn result(&mut self, unknown: &P::State, mu: &mut P::State) {
        self.function.gradient(unknown, &mut self.x);
        self.system.retraction_action(&self.x, &self.base, mu);
    }

    fn group_factor(&mut self, unknown: &P::State, xi: &mut P::State) -> Option<Retraction> {
        self.function.gradient(unknown, xi);
        Some(Retraction::Declared)
    }
}
