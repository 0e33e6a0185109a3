//! The Lie–Poisson midpoint method: one step along a retraction of the group.
//!
//! With a retraction `$\tau$` (exp or Cayley), its right-trivialised tangent `$\mathrm{d}\tau_x$` and the
//! momentum m at the midpoint as the unknown:
//!
//! ```math
//! (\mathrm{d}\tau_x^{-1})^* m = \mu, \qquad x = h\, \nabla H(m), \qquad
//! \mu_1 = \mathrm{Ad}^*_{\tau(x)}\, \mu = (\mathrm{d}\tau_{-x}^{-1})^* m
//! ```
//!
//! It is the discrete Lie–Poisson flow of the discrete Lagrangian `h l(tau^-1(g)/h)`. Order 2,
//! symmetric, a Poisson map; keeps every Casimir and the coadjoint orbit, and the energy without drift
//! though not exactly.
//!
//! exp works for every algebra. Cayley needs a matrix representation whose span is closed under
//! `(abc + cba)/2`, and then is polynomial: no series.
//!
//! Needs: gradient and Hessian of H, ad*, and for Cayley the triple product.
//!
//! References: J. E. Marsden, S. Pekarsky, S. Shkoller, "Discrete Euler–Poincaré and Lie–Poisson
//! equations", Nonlinearity 12 (1999) 1647–1662,
//! [doi:10.1088/0951-7715/12/6/314](https://doi.org/10.1088/0951-7715/12/6/314);
//! N. Bou-Rabee, J. E. Marsden, "Hamilton–Pontryagin integrators on Lie groups", Foundations of
//! Computational Mathematics 9 (2009) 197–219,
//! [doi:10.1007/s10208-008-9030-4](https://doi.org/10.1007/s10208-008-9030-4).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::facts::{Facts, Preserves};
use super::implicit::ImplicitStepper;
use super::stepper::{FactorSink, Method, Retraction, StepFailure, StepReport, Stepper};
use crate::equation::{CayleyEquations, Equation, LieMidpointEquations};
use crate::newton::NewtonOptions;
use crate::poisson::Poisson;
use crate::scalar::{Mask, Scalar};
use crate::state::State;

/// The exponential map, for every algebra.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exp;

/// The Cayley map, for triple-closed representations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cayley;

/// The Lie–Poisson midpoint method, order 2; see the [module's text](self).
///
/// Made by [`LieMidpoint::exp`] or [`LieMidpoint::cayley`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LieMidpoint<T> {
    retraction: T,
}

impl LieMidpoint<Exp> {
    /// With the exponential map.
    pub const fn exp() -> Self {
        Self { retraction: Exp }
    }
}

impl LieMidpoint<Cayley> {
    /// With the Cayley map of the declared representation.
    pub const fn cayley() -> Self {
        Self { retraction: Cayley }
    }
}

impl<T> Facts for LieMidpoint<T> {
    const ID: &'static str = "lie-midpoint";
    const ORDER: u32 = 2;
    const SYMMETRIC: bool = true;
    const EXPLICIT: bool = false;
    const PRESERVES: Preserves = Preserves {
        energy: false,
        casimirs: true,
        orbit: true,
        poisson: true,
        quadratic_invariants: false,
        linear_invariants: false,
    };
}

impl<S: Scalar, P: LieMidpointEquations<S>> Method<S, P> for LieMidpoint<Exp> {
    type Stepper<'a>
        = CoadjointStepper<'a, S, P, P::Exp<'a>>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, newton: &NewtonOptions) -> Self::Stepper<'a> {
        CoadjointStepper::new(system, system.exp_equation(h), h, Retraction::Exp, newton)
    }
}

impl<S: Scalar, P: CayleyEquations<S>> Method<S, P> for LieMidpoint<Cayley> {
    type Stepper<'a>
        = CoadjointStepper<'a, S, P, P::Cayley<'a>>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, newton: &NewtonOptions) -> Self::Stepper<'a> {
        CoadjointStepper::new(
            system,
            system.cayley_equation(h),
            h,
            Retraction::Cayley,
            newton,
        )
    }
}

/// An implicit stepper that gives away the group factor `tau(h grad H(m))` of each step.
pub struct CoadjointStepper<'a, S: Scalar, P: Poisson<S>, E: Equation<S>> {
    system: &'a P,
    implicit: ImplicitStepper<S, E>,
    step: S,
    retraction: Retraction,
    direction: P::State,
}

impl<'a, S, P, E> CoadjointStepper<'a, S, P, E>
where
    S: Scalar,
    P: Poisson<S>,
    E: Equation<S, State = P::State, Unknown = P::State>,
{
    /// A stepper for an equation whose unknown is the momentum at the midpoint.
    pub fn new(
        system: &'a P,
        equation: E,
        h: S,
        retraction: Retraction,
        newton: &NewtonOptions,
    ) -> Self {
        let implicit = ImplicitStepper::new(equation, system.zero_state(), newton);
        Self {
            system,
            implicit,
            step: h,
            retraction,
            direction: system.zero_state(),
        }
    }
}

impl<S, P, E> Stepper<S> for CoadjointStepper<'_, S, P, E>
where
    S: Scalar,
    P: Poisson<S>,
    E: Equation<S, State = P::State, Unknown = P::State>,
{
    type State = P::State;

    fn step<K: FactorSink<P::State>>(
        &mut self,
        mu: &mut P::State,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        let outcome = self.implicit.advance(mu);
        if K::ACTIVE {
            let failed = S::Mask::from_bits(outcome.map_or_else(|failure| failure.lanes, |_| 0));
            if !failed.all() {
                self.system
                    .gradient(self.implicit.unknown(), &mut self.direction);
                for entry in self.direction.as_mut_slice() {
                    *entry = S::select(failed, S::zero(), self.step * *entry);
                }
                sink.push(self.retraction, &self.direction);
            }
        }
        outcome
    }
}
