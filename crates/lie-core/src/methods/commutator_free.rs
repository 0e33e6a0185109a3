//! The commutator-free method of order 4 of Celledoni, Marthinsen and Owren.
//!
//! With `$E(\xi) = \exp(h\, \mathrm{ad}^*_\xi)$`, the rightmost applied first:
//!
//! ```math
//! k_1 = \nabla H(\mu), \quad \mu_2 = E(\tfrac12 k_1)\, \mu, \quad k_2 = \nabla H(\mu_2), \quad
//! k_3 = \nabla H\!\left(E(\tfrac12 k_2)\, \mu\right), \quad
//! k_4 = \nabla H\!\left(E(k_3 - \tfrac12 k_1)\, \mu_2\right)
//! ```
//!
//! ```math
//! \mu_1 = E\!\left(-\tfrac1{12} k_1 + \tfrac16 k_2 + \tfrac16 k_3 + \tfrac14 k_4\right)
//!   E\!\left(\tfrac14 k_1 + \tfrac16 k_2 + \tfrac16 k_3 - \tfrac1{12} k_4\right) \mu
//! ```
//!
//! The tableau is the classical Runge–Kutta tableau, with its last row split between two
//! exponentials. Explicit, order 4, without commutators. Keeps the coadjoint orbit and with it every
//! Casimir; not symmetric, not a Poisson map, and the energy drifts.
//!
//! Where forces act, the flows `$E$` of frozen fields are affine,
//! `$\exp(h\, \mathrm{ad}^*_\xi)\, \mu + \varphi_1(h\, \mathrm{ad}^*_\xi)\, h F$`, with the same combinations of forces as of elements; the order is the same.
//!
//! Needs: the gradient of H and ad*; any Lie algebra.
//!
//! Reference: E. Celledoni, A. Marthinsen, B. Owren, "Commutator-free Lie group methods", Future
//! Generation Computer Systems 19 (2003) 341–352,
//! [doi:10.1016/S0167-739X(02)00161-9](https://doi.org/10.1016/S0167-739X(02)00161-9).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::explicit::{Flow, Frozen, accept, coadjoint_facts};
use super::facts::{Facts, Preserves};
use super::stepper::{FactorSink, Method, StepFailure, StepReport, Stepper};
use crate::newton::NewtonOptions;
use crate::poisson::LiePoisson;
use crate::scalar::Scalar;

/// The commutator-free method of order 4; see the [module's text](self).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CommutatorFree4;

coadjoint_facts!(CommutatorFree4, "cf4", 4);

const ZERO: (f64, f64) = (0.0, 1.0);
/// Weights of the stages in the exponentials of stages 2, 3 and 4.
const STAGES: [&[(f64, f64)]; 3] = [
    &[(1.0, 2.0)],
    &[ZERO, (1.0, 2.0)],
    &[(-1.0, 2.0), ZERO, (1.0, 1.0)],
];
/// The same in the two exponentials of the step, in the order in which they are applied.
const STEP: [[(f64, f64); 4]; 2] = [
    [(1.0, 4.0), (1.0, 6.0), (1.0, 6.0), (-1.0, 12.0)],
    [(-1.0, 12.0), (1.0, 6.0), (1.0, 6.0), (1.0, 4.0)],
];

impl<S: Scalar, P: LiePoisson<S>> Method<S, P> for CommutatorFree4 {
    type Stepper<'a>
        = CommutatorFreeStepper<'a, S, P>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, _newton: &NewtonOptions) -> Self::Stepper<'a> {
        let zero = system.zero_state();
        CommutatorFreeStepper {
            system,
            step: h,
            slopes: core::array::from_fn(|_| Frozen::new(system, &zero)),
            factors: core::array::from_fn(|_| Frozen::new(system, &zero)),
            second: zero.clone(),
            next: zero.clone(),
            flow: Flow::new(system, &zero),
        }
    }
}

/// The stepper of [`CommutatorFree4`].
pub struct CommutatorFreeStepper<'a, S: Scalar, P: LiePoisson<S>> {
    system: &'a P,
    step: S,
    /// The `h k_i`.
    slopes: [Frozen<P::State>; 4],
    factors: [Frozen<P::State>; 2],
    /// The state of the second stage.
    second: P::State,
    next: P::State,
    flow: Flow<P::State>,
}

impl<S: Scalar, P: LiePoisson<S>> Stepper<S> for CommutatorFreeStepper<'_, S, P> {
    type State = P::State;

    fn step<K: FactorSink<P::State>>(
        &mut self,
        mu: &mut P::State,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        let Self {
            system,
            slopes,
            factors,
            second,
            next,
            flow,
            ..
        } = self;
        slopes[0].freeze(*system, self.step, mu);
        let [first, last] = factors;
        first.combine(STAGES[0], slopes);
        first.flow(*system, mu, second, flow);
        slopes[1].freeze(*system, self.step, second);
        first.combine(STAGES[1], slopes);
        first.flow(*system, mu, next, flow);
        slopes[2].freeze(*system, self.step, next);
        first.combine(STAGES[2], slopes);
        first.flow(*system, second, next, flow);
        slopes[3].freeze(*system, self.step, next);

        first.combine(&STEP[0], slopes);
        last.combine(&STEP[1], slopes);
        first.flow(*system, mu, second, flow);
        last.flow(*system, second, next, flow);
        accept(mu, next, factors, 4, sink)
    }
}
