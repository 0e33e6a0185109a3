//! The Crouch–Grossman method of order 3: one exponential per coefficient of a tableau.
//!
//! With `$E(\xi) = \exp(h\, \mathrm{ad}^*_\xi)$`, the rightmost applied first:
//!
//! ```math
//! k_1 = \nabla H(\mu), \quad
//! k_2 = \nabla H\!\left(E(\tfrac34 k_1)\, \mu\right), \quad
//! k_3 = \nabla H\!\left(E(\tfrac{17}{108} k_2)\, E(\tfrac{119}{216} k_1)\, \mu\right)
//! ```
//!
//! ```math
//! \mu_1 = E(\tfrac{24}{17} k_3)\, E(-\tfrac23 k_2)\, E(\tfrac{13}{51} k_1)\, \mu
//! ```
//!
//! Explicit, order 3, without commutators. Keeps the coadjoint orbit and with it every Casimir; not
//! symmetric, not a Poisson map, and the energy drifts.
//!
//! Where forces act, the flows `$E$` of frozen fields are affine,
//! `$\exp(h\, \mathrm{ad}^*_\xi)\, \mu + \varphi_1(h\, \mathrm{ad}^*_\xi)\, h F$`, with the same combinations of forces as of elements; the order is the same.
//!
//! Needs: the gradient of H and ad*; any Lie algebra.
//!
//! References: P. E. Crouch, R. Grossman, "Numerical integration of ordinary differential equations on
//! manifolds", Journal of Nonlinear Science 3 (1993) 1–33,
//! [doi:10.1007/BF02429858](https://doi.org/10.1007/BF02429858); the coefficients: B. Owren,
//! A. Marthinsen, "Runge–Kutta methods adapted to manifolds and based on rigid frames", BIT 39 (1999)
//! 116–142, [doi:10.1023/A:1022325426017](https://doi.org/10.1023/A:1022325426017).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::explicit::{Flow, Frozen, accept, coadjoint_facts};
use super::facts::{Facts, Preserves};
use super::stepper::{FactorSink, Method, StepFailure, StepReport, Stepper};
use crate::newton::NewtonOptions;
use crate::poisson::LiePoisson;
use crate::scalar::Scalar;
use crate::state::State;

/// The Crouch–Grossman method of order 3; see the [module's text](self).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CrouchGrossman3;

coadjoint_facts!(CrouchGrossman3, "cg3", 3);

/// Rows of the tableau below the first stage, then the weights.
const ROWS: [&[(f64, f64)]; 3] = [
    &[(3.0, 4.0)],
    &[(119.0, 216.0), (17.0, 108.0)],
    &[(13.0, 51.0), (-2.0, 3.0), (24.0, 17.0)],
];

impl<S: Scalar, P: LiePoisson<S>> Method<S, P> for CrouchGrossman3 {
    type Stepper<'a>
        = CrouchGrossmanStepper<'a, S, P>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, _newton: &NewtonOptions) -> Self::Stepper<'a> {
        let zero = system.zero_state();
        CrouchGrossmanStepper {
            system,
            step: h,
            slopes: core::array::from_fn(|_| Frozen::new(system, &zero)),
            factors: core::array::from_fn(|_| Frozen::new(system, &zero)),
            next: zero.clone(),
            flow: Flow::new(system, &zero),
            point: zero,
        }
    }
}

/// The stepper of [`CrouchGrossman3`].
pub struct CrouchGrossmanStepper<'a, S: Scalar, P: LiePoisson<S>> {
    system: &'a P,
    step: S,
    /// The `h k_i`.
    slopes: [Frozen<P::State>; 3],
    factors: [Frozen<P::State>; 3],
    point: P::State,
    next: P::State,
    flow: Flow<P::State>,
}

impl<S: Scalar, P: LiePoisson<S>> Stepper<S> for CrouchGrossmanStepper<'_, S, P> {
    type State = P::State;

    fn step<K: FactorSink<P::State>>(
        &mut self,
        mu: &mut P::State,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        for (stage, row) in ROWS.iter().enumerate() {
            let place = if stage == 0 { &*mu } else { &self.next };
            self.slopes[stage].freeze(self.system, self.step, place);
            self.next.copy_from(mu);
            for (index, weight) in row.iter().enumerate() {
                let factor = &mut self.factors[index];
                factor.combine(&[*weight], &self.slopes[index..=index]);
                core::mem::swap(&mut self.point, &mut self.next);
                factor.flow(self.system, &self.point, &mut self.next, &mut self.flow);
            }
        }
        accept(mu, &self.next, &mut self.factors, 3, sink)
    }
}
