//! The equation of K-HJ methods, on any Poisson manifold.

use super::frozen_flow::{FrozenFlow, jacobian_cost};
use crate::equation::Equation;
use crate::generating::GeneratingFunction;
use crate::matrix::SquareMatrix;
use crate::poisson::Poisson;
use crate::scalar::Scalar;
use crate::state::State;

/// The step of a generating function S on the symplectic realization of the flat spray, for any Poisson matrix.
///
/// Unknown: the mean X of the states along the way of the [`FrozenFlow`] `y' = Pi(y) p`, `y(0) = mu`, over unit time. Equation:
/// `r(X) = X - (y's mean)` with `p = grad S(X)`. New state: `y(1)`, on the symplectic leaf of mu to round-off whatever the error of X.
/// Jacobian: `1 - M S''(X)` with the derivative M of the mean in p. Start: `X = mu + (h/2) f(mu)`.
///
/// Of a Lie algebra the mean is `phi1(ad*_p) mu`, and the step that of [`ExpRetraction`](super::ExpRetraction), which gives group elements.
/// Forces are left out, as S knows the Hamiltonian alone.
#[derive(Debug)]
pub struct RealizationStep<'a, S: Scalar, P: Poisson<S>, G> {
    system: &'a P,
    function: G,
    step: S,
    base: P::State,
    covector: P::State,
    mean: P::State,
    end: P::State,
    flow: FrozenFlow<S, P::State, P::Jacobian>,
    hessian: P::Jacobian,
}

impl<'a, S, P, G> RealizationStep<'a, S, P, G>
where
    S: Scalar,
    P: Poisson<S>,
    G: GeneratingFunction<S, State = P::State, Jacobian = P::Jacobian>,
{
    /// The equation of the step of size h of a generating function.
    pub fn with_function(system: &'a P, function: G, h: S) -> Self {
        let zero = system.zero_state();
        Self {
            system,
            function,
            step: h,
            base: zero.clone(),
            covector: zero.clone(),
            mean: zero.clone(),
            end: zero,
            flow: FrozenFlow::new(system),
            hessian: system.zero_jacobian(),
        }
    }

    /// Goes the way along the covector; leaves the mean and the end.
    fn walk(&mut self) {
        let given = [&self.covector, &self.base];
        let found = [&mut self.mean, &mut self.end];
        self.flow.middle(self.system, given, found);
    }

    /// `X` less the mean of the way along the covector.
    fn write_residual(&mut self, unknown: &P::State, residual: &mut P::State) {
        residual.copy_from(unknown);
        residual.axpy(-S::one(), &self.mean);
    }
}

impl<S, P, G> Equation<S> for RealizationStep<'_, S, P, G>
where
    S: Scalar,
    P: Poisson<S>,
    G: GeneratingFunction<S, State = P::State, Jacobian = P::Jacobian>,
{
    crate::generic::unknown_of_a_state!();

    fn set_base(&mut self, mu: &P::State) {
        self.base.copy_from(mu);
        self.flow.begin();
    }

    fn initial_guess(&mut self, unknown: &mut P::State) {
        self.system.vector_field(&self.base, &mut self.mean);
        unknown.copy_from(&self.base);
        unknown.axpy(self.step * S::ratio(1.0, 2.0), &self.mean);
    }

    fn residual(&mut self, unknown: &P::State, residual: &mut P::State) {
        self.function.gradient(unknown, &mut self.covector);
        self.walk();
        self.write_residual(unknown, residual);
    }

    fn approach(&mut self, unknown: &P::State, residual: &mut P::State, active: S::Mask) -> S {
        self.function.gradient(unknown, &mut self.covector);
        let given = [&self.covector, &self.base];
        let mean = &mut self.mean;
        let changed = self.flow.approach_mean(self.system, given, mean, active);
        self.write_residual(unknown, residual);
        changed
    }

    fn linearize(&mut self, unknown: &P::State, residual: &mut P::State, matrix: &mut P::Jacobian) {
        let (covector, hessian) = (&mut self.covector, &mut self.hessian);
        self.function.linearize(unknown, covector, hessian);
        self.walk();
        self.write_residual(unknown, residual);
        let given = [&self.covector, &self.base];
        let slope = self.flow.mean_by_direction(self.system, given);
        for row in 0..self.system.dimension() {
            for column in 0..self.system.dimension() {
                let mut entry = if row == column { S::one() } else { S::zero() };
                for inner in 0..self.system.dimension() {
                    entry -= slope.get(row, inner) * self.hessian.get(inner, column);
                }
                matrix.set(row, column, entry);
            }
        }
    }

    fn jacobian_cost(&self) -> f64 {
        jacobian_cost(self.system.dimension())
    }

    fn resolved(&mut self, _unknown: &P::State, _end: &P::State) -> S::Mask {
        self.flow.is_resolved()
    }

    fn result(&mut self, unknown: &P::State, mu: &mut P::State) {
        // lanes that were solved earlier have seen more iterations
        self.flow.conclude();
        self.function.gradient(unknown, &mut self.covector);
        self.walk();
        mu.copy_from(&self.end);
    }
}
