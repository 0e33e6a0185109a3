//! The Lie–Euler method: one exponential of the gradient at the start.
//!
//! ```math
//! \mu_1 = \mathrm{Ad}^*_{\exp(h\, \nabla H(\mu))}\, \mu = \exp\!\left(\mathrm{ad}^*_{h\, \nabla H(\mu)}\right) \mu
//! ```
//!
//! Where forces act, the flow of the field frozen at the start, `$\exp(h\, \mathrm{ad}^*_\xi)\, \mu + \varphi_1(h\, \mathrm{ad}^*_\xi)\, h F$`.
//!
//! Explicit, order 1. Keeps the coadjoint orbit and with it every Casimir; not symmetric, not a
//! Poisson map, and the energy drifts.
//!
//! Needs: the gradient of H and ad*; any Lie algebra.
//!
//! Reference: H. Munthe-Kaas, "High order Runge–Kutta methods on manifolds", Applied Numerical
//! Mathematics 29 (1999) 115–127,
//! [doi:10.1016/S0168-9274(98)00030-0](https://doi.org/10.1016/S0168-9274(98)00030-0).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::explicit::{Flow, Frozen, accept, coadjoint_facts};
use super::facts::{Facts, Preserves};
use super::stepper::{FactorSink, Method, StepFailure, StepReport, Stepper};
use crate::newton::NewtonOptions;
use crate::poisson::LiePoisson;
use crate::scalar::Scalar;

/// The Lie–Euler method, order 1; see the [module's text](self).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LieEuler;

coadjoint_facts!(LieEuler, "lie-euler", 1);

impl<S: Scalar, P: LiePoisson<S>> Method<S, P> for LieEuler {
    type Stepper<'a>
        = LieEulerStepper<'a, S, P>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, _newton: &NewtonOptions) -> Self::Stepper<'a> {
        let zero = system.zero_state();
        LieEulerStepper {
            system,
            step: h,
            flow: Flow::new(system, &zero),
            factor: [Frozen::new(system, &zero)],
            next: zero,
        }
    }
}

/// The stepper of [`LieEuler`].
pub struct LieEulerStepper<'a, S: Scalar, P: LiePoisson<S>> {
    system: &'a P,
    step: S,
    factor: [Frozen<P::State>; 1],
    next: P::State,
    flow: Flow<P::State>,
}

impl<S: Scalar, P: LiePoisson<S>> Stepper<S> for LieEulerStepper<'_, S, P> {
    type State = P::State;

    fn step<K: FactorSink<P::State>>(
        &mut self,
        mu: &mut P::State,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        let [factor] = &mut self.factor;
        factor.freeze(self.system, self.step, mu);
        factor.flow(self.system, mu, &mut self.next, &mut self.flow);
        accept(mu, &self.next, &mut self.factor, 1, sink)
    }
}
