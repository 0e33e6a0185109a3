//! The classical explicit Runge–Kutta method, as a control that keeps no structure.
//!
//! ```math
//! \mu_1 = \mu + \tfrac{h}{6}(k_1 + 2 k_2 + 2 k_3 + k_4), \qquad
//! k_1 = f(\mu),\; k_2 = f(\mu + \tfrac{h}{2} k_1),\; k_3 = f(\mu + \tfrac{h}{2} k_2),\; k_4 = f(\mu + h k_3)
//! ```
//!
//! Order 4.
//!
//! Needs: the vector field.
//!
//! Reference: E. Hairer, S. P. Nørsett, G. Wanner, "Solving Ordinary Differential Equations I",
//! 2nd edition, Springer 1993, section II.1,
//! [doi:10.1007/978-3-540-78862-1](https://doi.org/10.1007/978-3-540-78862-1).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::explicit::direction;
use super::facts::{Facts, Preserves};
use super::implicit::clear;
use super::stepper::{
    FactorSink, Method, RungeKutta, Stage, StepFailure, StepReport, Stepper, not_finite,
};
use crate::newton::NewtonOptions;
use crate::poisson::Poisson;
use crate::scalar::{Mask, Scalar};
use crate::state::{State, Unknown};

/// The classical explicit Runge–Kutta method, order 4; see the [module's text](self).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rk4;

impl Facts for Rk4 {
    const ID: &'static str = "rk4";
    const ORDER: u32 = 4;
    const SYMMETRIC: bool = false;
    const EXPLICIT: bool = true;
    const PRESERVES: Preserves = Preserves::LINEAR;
    const FORCES: bool = true;
    const DAMPING: bool = true;
}

impl<S: Scalar, P: Poisson<S>> Method<S, P> for Rk4 {
    type Stepper<'a>
        = Rk4Stepper<'a, S, P>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, _newton: &NewtonOptions) -> Self::Stepper<'a> {
        let zero = system.zero_state();
        Rk4Stepper {
            system,
            step: h,
            slope: zero.clone(),
            sum: zero.clone(),
            point: zero,
        }
    }
}

/// The stepper of [`Rk4`].
pub struct Rk4Stepper<'a, S: Scalar, P: Poisson<S>> {
    system: &'a P,
    step: S,
    slope: P::State,
    sum: P::State,
    point: P::State,
}

/// The coefficients of the stages after the first, and the weights.
const STAGES: [&[(f64, f64)]; 3] = [
    &[(1.0, 2.0)],
    &[(0.0, 1.0), (1.0, 2.0)],
    &[(0.0, 1.0), (0.0, 1.0), (1.0, 1.0)],
];
const WEIGHTS: [(f64, f64); 4] = [(1.0, 6.0), (1.0, 3.0), (1.0, 3.0), (1.0, 6.0)];

impl<S: Scalar, P: Poisson<S>> Rk4Stepper<'_, S, P> {
    /// Goes through the stages of the step from mu again, for `h grad H` at each; the new state is in `point`.
    fn give_velocities<K: FactorSink<P::State>>(&mut self, mu: &P::State, sink: &mut K) {
        let failed = !self.point.finite();
        let method = RungeKutta::Explicit {
            stages: &STAGES,
            weights: &WEIGHTS,
        };
        let half = self.step * S::ratio(1.0, 2.0);
        self.sum.copy_from(mu);
        for (index, advance) in [half, half, self.step, S::zero()].into_iter().enumerate() {
            direction(self.system, self.step, &self.sum, &mut self.slope);
            clear(&mut self.slope, failed);
            sink.push_velocity(method, Stage { index, count: 4 }, &self.slope);
            self.system.vector_field(&self.sum, &mut self.slope);
            self.sum.copy_from(mu);
            self.sum.axpy(advance, &self.slope);
        }
    }
}

impl<S: Scalar, P: Poisson<S>> Stepper<S> for Rk4Stepper<'_, S, P> {
    type State = P::State;

    fn step<K: FactorSink<P::State>>(
        &mut self,
        mu: &mut P::State,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        let half = self.step * S::ratio(1.0, 2.0);
        self.system.vector_field(mu, &mut self.slope);
        self.sum.copy_from(&self.slope);
        for (weight, advance) in [(2.0, half), (2.0, half), (1.0, self.step)] {
            self.point.copy_from(mu);
            self.point.axpy(advance, &self.slope);
            self.system.vector_field(&self.point, &mut self.slope);
            self.sum.axpy(S::from_f64(weight), &self.slope);
        }
        self.point.copy_from(mu);
        self.point.axpy(self.step * S::ratio(1.0, 6.0), &self.sum);
        if sink.is_active() {
            self.give_velocities(mu, sink);
        }
        let finite = self.point.finite();
        mu.assign_where(finite, &self.point);
        let report = StepReport {
            evaluations: 4,
            substeps: 1,
            ..StepReport::default()
        };
        if finite.all() {
            Ok(report)
        } else {
            Err(not_finite((!finite).bits(), report))
        }
    }
}
