//! The equation of the step of a discrete Lagrangian in exponential coordinates.

use super::dexp_slope::DexpSlope;
use super::kernels::multiply;
use super::series::coadjoint_action_in;
use crate::equation::Equation;
use crate::lagrangian::{
    DeclaredDiscreteLagrangian, DiscreteLagrangian, DiscreteLagrangianPoisson, LagrangianOfStep,
    LagrangianPoisson,
};
use crate::matrix::SquareMatrix;
use crate::methods::Retraction;
use crate::poisson::LiePoisson;
use crate::scalar::Scalar;
use crate::state::{State, copies};

/// The discrete Euler–Poincaré step `(dexp_x^-1)* l_d'(x) = mu`, `mu1 = Ad*_(exp x) mu`, for any Lie algebra.
///
/// Unknown: x, of the reduced Lagrangian l the product `h xi`. Equation, in the equivalent entire form:
/// `r(x) = W (l_d'(x) - phi1(ad*_x) mu)`, `phi1(z) = (e^z - 1)/z`, with the constant matrix `W = l_d''(x0)^-1` that
/// makes the Jacobian `W (l_d''(x) - d/dx[phi1(ad*_x) mu])` dimensionless. New state: `exp(ad*_x) mu`, on the
/// coadjoint orbit of mu to round-off whatever the error of x. Start: `x = x0 + W ad*_x0 mu/2`, where
/// `l_d'(x0) = mu`.
#[derive(Debug)]
pub struct ExpVariational<'a, S: Scalar, P: LiePoisson<S>, L = LagrangianOfStep<'a, S, P>> {
    system: &'a P,
    l_d: L,
    base: P::State,
    start: P::State,
    weight: P::Jacobian,
    series: DexpSlope<P::State, P::Jacobian, S>,
    curvature: P::Jacobian,
    columns: [P::State; 3],
}

impl<'a, S: Scalar, P: LagrangianPoisson<S>> ExpVariational<'a, S, P> {
    /// The equation of a step of size h of the Lagrangian.
    pub fn new(system: &'a P, h: S) -> Self {
        Self::with_discrete(system, LagrangianOfStep::new(system, h))
    }
}

/// The same for a declared discrete Lagrangian.
pub type ExpDiscrete<'a, S, P> = ExpVariational<'a, S, P, DeclaredDiscreteLagrangian<'a, S, P>>;

impl<'a, S, P> ExpDiscrete<'a, S, P>
where
    S: Scalar,
    P: DiscreteLagrangianPoisson<S>,
{
    /// The equation of a step of size h of the declared discrete Lagrangian.
    pub fn new(system: &'a P, h: S) -> Self {
        Self::with_discrete(system, DeclaredDiscreteLagrangian::new(system, h))
    }
}

impl<'a, S, P, L> ExpVariational<'a, S, P, L>
where
    S: Scalar,
    P: LiePoisson<S>,
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
            series: DexpSlope::new(&zero, system.zero_jacobian()),
            curvature: system.zero_jacobian(),
            columns: copies(&zero),
        }
    }

    /// The residual from the sum in `columns[1]`.
    fn weigh(&mut self, unknown: &P::State, residual: &mut P::State) {
        let [slope, sum, _] = &mut self.columns;
        self.l_d.slope(unknown, slope);
        slope.axpy(-S::one(), sum);
        multiply(&self.weight, slope, residual);
    }
}

impl<S, P, L> Equation<S> for ExpVariational<'_, S, P, L>
where
    S: Scalar,
    P: LiePoisson<S>,
    L: DiscreteLagrangian<S, State = P::State, Jacobian = P::Jacobian>,
{
    crate::generic::unknown_of_a_state!();

    fn set_base(&mut self, mu: &P::State) {
        self.base.copy_from(mu);
        self.l_d.start(mu, &mut self.start, &mut self.weight);
    }

    fn initial_guess(&mut self, unknown: &mut P::State) {
        let [action, correction, _] = &mut self.columns;
        self.system.ad_star(&self.start, &self.base, action);
        multiply(&self.weight, action, correction);
        unknown.copy_from(&self.start);
        unknown.axpy(S::ratio(1.0, 2.0), correction);
    }

    fn residual(&mut self, unknown: &P::State, residual: &mut P::State) {
        let [_, sum, _] = &mut self.columns;
        self.series.evaluate(self.system, unknown, &self.base, sum);
        self.weigh(unknown, residual);
    }

    fn linearize(&mut self, unknown: &P::State, residual: &mut P::State, matrix: &mut P::Jacobian) {
        let [_, sum, _] = &mut self.columns;
        self.series.linearize(self.system, unknown, &self.base, sum);
        self.weigh(unknown, residual);
        self.l_d.curvature(unknown, &mut self.curvature);
        let [unit, total, out] = &mut self.columns;
        for column in 0..self.system.dimension() {
            unit.fill(S::zero());
            unit.as_mut_slice()[column] = S::one();
            self.series.derivative(self.system, unknown, unit, total);
            for (row, entry) in total.as_mut_slice().iter_mut().enumerate() {
                *entry = self.curvature.get(row, column) - *entry;
            }
            multiply(&self.weight, total, out);
            for (row, &entry) in out.as_slice().iter().enumerate() {
                matrix.set(row, column, entry);
            }
        }
    }

    fn result(&mut self, unknown: &P::State, mu: &mut P::State) {
        let scratch = self.series.scratch();
        coadjoint_action_in(self.system, unknown, &self.base, mu, scratch);
    }

    fn group_factor(&mut self, unknown: &P::State, xi: &mut P::State) -> Option<Retraction> {
        xi.copy_from(unknown);
        Some(Retraction::Exp)
    }
}
