//! The equation of methods of coadjoint form along the exponential map: the Lie–Poisson midpoint
//! method and the generating-function methods.

use super::acting::Acting;
use super::dexp_slope::DexpSlope;
use super::generating::Generating2;
use super::midpoint_force::MidpointForce;
use super::series::coadjoint_action_in;
use crate::equation::Equation;
use crate::generating::GeneratingFunction;
use crate::matrix::SquareMatrix;
use crate::methods::Retraction;
use crate::poisson::LiePoisson;
use crate::scalar::Scalar;
use crate::state::{State, copies};

/// The method `mu1 = Ad*_(exp xi) mu` of a generating function S, for any Lie algebra.
///
/// Unknown: the momentum p of the function. Equation: `(dexp_xi^-1)* p = mu` with `xi = grad S(p)`,
/// in the equivalent entire form `r(p) = p - phi1(ad*_xi) mu`, `phi1(z) = (e^z - 1)/z`.
/// New state: `exp(ad*_xi) mu`, on the coadjoint orbit of mu to round-off whatever the error of p.
/// Jacobian: `1 - d/dxi[phi1(ad*_xi) mu] S''(p)`.
/// Start: `p = mu + (h/2) f(mu)`.
///
/// Where forces act, the force at the midpoint is carried to both ends by half of the motion: in the residual
/// `mu + (h/2) exp(-ad*_xi/2) F(p)` takes the place of mu, and the new state is `exp(ad*_xi) mu + h exp(ad*_xi/2) F(p)`.
#[derive(Debug)]
pub struct ExpRetraction<'a, S: Scalar, P: LiePoisson<S>, G> {
    system: &'a P,
    function: G,
    step: S,
    base: P::State,
    direction: P::State,
    sum: P::State,
    series: DexpSlope<P::State, P::Jacobian, S>,
    hessian: P::Jacobian,
    columns: [P::State; 2],
    /// Where forces act.
    force: Acting<MidpointForce<P::State, P::Jacobian>>,
}

/// The Lie–Poisson midpoint method for any Lie algebra: [`ExpRetraction`] with `S = h H`.
pub type ExpMidpoint<'a, S, P> = ExpRetraction<'a, S, P, Generating2<'a, S, P>>;

impl<'a, S: Scalar, P: LiePoisson<S>> ExpMidpoint<'a, S, P> {
    /// The equation of a step of size h.
    pub fn new(system: &'a P, h: S) -> Self {
        Self::with_function(system, Generating2::new(system, h), h)
    }
}

impl<'a, S, P, G> ExpRetraction<'a, S, P, G>
where
    S: Scalar,
    P: LiePoisson<S>,
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
            direction: zero.clone(),
            sum: zero.clone(),
            series: DexpSlope::new(&zero, system.zero_jacobian()),
            hessian: system.zero_jacobian(),
            columns: copies(&zero),
            force: Acting::of(system, || MidpointForce::new(system)),
        }
    }

    /// Computes the residual from the sum.
    fn subtract(&self, unknown: &P::State, residual: &mut P::State) {
        for (index, out) in residual.as_mut_slice().iter_mut().enumerate() {
            *out = unknown.as_slice()[index] - self.sum.as_slice()[index];
        }
    }
}

impl<S, P, G> Equation<S> for ExpRetraction<'_, S, P, G>
where
    S: Scalar,
    P: LiePoisson<S>,
    G: GeneratingFunction<S, State = P::State, Jacobian = P::Jacobian>,
{
    crate::generic::unknown_of_a_state!();

    fn set_base(&mut self, mu: &P::State) {
        self.base.copy_from(mu);
    }

    fn initial_guess(&mut self, unknown: &mut P::State) {
        self.system.vector_field(&self.base, &mut self.sum);
        unknown.copy_from(&self.base);
        unknown.axpy(self.step * S::ratio(1.0, 2.0), &self.sum);
    }

    fn residual(&mut self, unknown: &P::State, residual: &mut P::State) {
        self.function.gradient(unknown, &mut self.direction);
        let (system, xi, sum) = (self.system, &self.direction, &mut self.sum);
        let base = match self.force.get_mut(self.system) {
            Some(force) => force.pushed(system, self.step, [unknown, xi, &self.base]),
            None => &self.base,
        };
        self.series.evaluate(system, xi, base, sum);
        self.subtract(unknown, residual);
    }

    fn linearize(&mut self, unknown: &P::State, residual: &mut P::State, matrix: &mut P::Jacobian) {
        self.function
            .linearize(unknown, &mut self.direction, &mut self.hessian);
        let (system, xi, sum) = (self.system, &self.direction, &mut self.sum);
        let base = match self.force.get_mut(self.system) {
            Some(force) => force.linearize(system, self.step, [unknown, xi, &self.base]),
            None => &self.base,
        };
        self.series.linearize(system, xi, base, sum);
        self.subtract(unknown, residual);
        let [along, total] = &mut self.columns;
        for column in 0..self.system.dimension() {
            for (row, entry) in along.as_mut_slice().iter_mut().enumerate() {
                *entry = self.hessian.get(row, column);
            }
            match self.force.get_mut(self.system) {
                None => self
                    .series
                    .derivative(self.system, &self.direction, along, total),
                Some(force) => {
                    force.slope(self.system, column, along, total);
                    self.series
                        .along_both(self.system, &self.direction, along, total);
                }
            }
            for (row, &entry) in total.as_slice().iter().enumerate() {
                let identity = if row == column { S::one() } else { S::zero() };
                matrix.set(row, column, identity - entry);
            }
        }
    }

    fn result(&mut self, unknown: &P::State, mu: &mut P::State) {
        self.function.gradient(unknown, &mut self.direction);
        let scratch = self.series.scratch();
        coadjoint_action_in(self.system, &self.direction, &self.base, mu, scratch);
        if let Some(force) = self.force.get_mut(self.system) {
            force.add_to_end(self.system, self.step, [unknown, &self.direction], mu);
        }
    }

    fn group_factor(&mut self, unknown: &P::State, xi: &mut P::State) -> Option<Retraction> {
        self.function.gradient(unknown, xi);
        Some(Retraction::Exp)
    }
}
