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
//! Needs: the gradient of H and ad*; any Lie algebra.
//!
//! Reference: E. Celledoni, A. Marthinsen, B. Owren, "Commutator-free Lie group methods", Future
//! Generation Computer Systems 19 (2003) 341–352,
//! [doi:10.1016/S0167-739X(02)00161-9](https://doi.org/10.1016/S0167-739X(02)00161-9).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::explicit::{accept, coadjoint_facts, combine, direction};
use super::facts::{Facts, Preserves};
use super::stepper::{FactorSink, Method, StepFailure, StepReport, Stepper};
use crate::generic::{Scratch, coadjoint_action_in};
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
            slopes: core::array::from_fn(|_| zero.clone()),
            factors: core::array::from_fn(|_| zero.clone()),
            second: zero.clone(),
            next: zero.clone(),
            scratch: Scratch::new(&zero),
        }
    }
}

/// The stepper of [`CommutatorFree4`].
pub struct CommutatorFreeStepper<'a, S: Scalar, P: LiePoisson<S>> {
    system: &'a P,
    step: S,
    /// The `h k_i`.
    slopes: [P::State; 4],
    factors: [P::State; 2],
    /// The state of the second stage.
    second: P::State,
    next: P::State,
    scratch: Scratch<P::State>,
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
            scratch,
            ..
        } = self;
        direction(*system, self.step, mu, &mut slopes[0]);
        let [first, last] = factors;
        combine(STAGES[0], slopes, first);
        coadjoint_action_in(*system, first, mu, second, scratch);
        direction(*system, self.step, second, &mut slopes[1]);
        combine(STAGES[1], slopes, first);
        coadjoint_action_in(*system, first, mu, next, scratch);
        direction(*system, self.step, next, &mut slopes[2]);
        combine(STAGES[2], slopes, first);
        coadjoint_action_in(*system, first, second, next, scratch);
        direction(*system, self.step, next, &mut slopes[3]);

        combine(&STEP[0], slopes, first);
        combine(&STEP[1], slopes, last);
        coadjoint_action_in(*system, first, mu, second, scratch);
        coadjoint_action_in(*system, last, second, next, scratch);
        accept(mu, next, factors, 4, sink)
    }
}
