//! The symplectic method for systems on `T*G`, whose Hamiltonian depends on the group element too.
//!
//! ```math
//! \dot g = g\, \xi, \qquad \dot\mu = \mathrm{ad}^*_\xi \mu - F, \qquad \xi = \frac{\partial H}{\partial \mu}(g, \mu),
//! \qquad F = L_g^* \frac{\partial H}{\partial g}(g, \mu)
//! ```
//!
//! A step is a first half with `h/2`, then a second one:
//!
//! ```math
//! \begin{aligned}
//! A_h:\quad& \mu_0 = (\mathrm{d}\tau_{h\xi}^{-1})^* m + h F(g_0, m), \quad \xi = H_\mu(g_0, m), \quad
//! g_1 = g_0\, \tau(h\xi), \quad \mu_1 = (\mathrm{d}\tau_{-h\xi}^{-1})^* m \\
//! B_h:\quad& \mu_0 = (\mathrm{d}\tau_{h\xi}^{-1})^* m, \quad \xi = H_\mu(g_1, m), \quad
//! g_1 = g_0\, \tau(h\xi), \quad \mu_1 = (\mathrm{d}\tau_{-h\xi}^{-1})^* m - h F(g_1, m)
//! \end{aligned}
//! ```
//!
//! with `$\tau = \exp$`; `$B_h = A_{-h}^{-1}$`. The step `$B_{h/2} \circ A_{h/2}$` has order 2, is symmetric, and keeps the
//! symplectic form of `T*G` (the Poisson structure of the semidirect product) for every Hamiltonian; g stays in
//! the group. Where H is the sum of a function of mu and one of g it is the Störmer–Verlet method.
//!
//! Forces that act beside H are subtracted from F, and with damping `$\xi$` is the generator of the motion: `$B_h = A_{-h}^{-1}$` holds
//! as before, and the step of order 2 is that of the discrete Lagrange–d'Alembert principle with half of the impulse at each end.
//!
//! Needs: a system on `T*G` ([`CotangentPoisson`]), declared with a group element.
//!
//! References: N. Bou-Rabee, J. E. Marsden, "Hamilton–Pontryagin integrators on Lie groups", Foundations of
//! Computational Mathematics 9 (2009) 197–219,
//! [doi:10.1007/s10208-008-9030-4](https://doi.org/10.1007/s10208-008-9030-4);
//! D. Martín de Diego, "Lie–Poisson integrators" (2018), section 3.
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::facts::{Facts, Preserves};
use super::implicit::{ImplicitStepper, clear};
use super::stepper::{FactorSink, Method, Retraction, StepFailure, StepReport, Stepper};
use crate::generic::{EulerArnoldHalf, Half};
use crate::newton::NewtonOptions;
use crate::scalar::{Mask, Scalar};
use crate::state::{State, Unknown, copies};
use crate::structure::CotangentPoisson;

/// The symplectic method on `T*G`, order 2; see the [module's text](self).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EulerArnold2;

impl Facts for EulerArnold2 {
    const ID: &'static str = "euler-arnold2";
    const ORDER: u32 = 2;
    const SYMMETRIC: bool = true;
    const EXPLICIT: bool = false;
    const PRESERVES: Preserves = Preserves::POISSON;
    const FORCES: bool = true;
    const DAMPING: bool = true;
}

impl<S: Scalar, P: CotangentPoisson<S>> Method<S, P> for EulerArnold2 {
    type Stepper<'a>
        = EulerArnoldStepper<'a, S, P>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, newton: &NewtonOptions) -> Self::Stepper<'a> {
        let half = h * S::ratio(1.0, 2.0);
        let equation = EulerArnoldHalf::new(system, half);
        EulerArnoldStepper {
            half: ImplicitStepper::new(equation, system.zero_state(), newton),
            next: system.zero_state(),
            factors: copies(&system.zero_state()),
        }
    }
}

/// The stepper of [`EulerArnold2`].
pub struct EulerArnoldStepper<'a, S: Scalar, P: CotangentPoisson<S>> {
    half: ImplicitStepper<S, EulerArnoldHalf<'a, S, P>>,
    next: P::State,
    /// The elements of the actions of both halves, in their order.
    factors: [P::State; 4],
}

impl<S: Scalar, P: CotangentPoisson<S>> Stepper<S> for EulerArnoldStepper<'_, S, P> {
    type State = P::State;

    fn step<K: FactorSink<P::State>>(
        &mut self,
        mu: &mut P::State,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        self.next.copy_from(mu);
        let mut report = StepReport {
            substeps: 1,
            ..StepReport::default()
        };
        let mut failure: Option<StepFailure> = None;
        for (half, factors) in [Half::First, Half::Second]
            .into_iter()
            .zip(self.factors.chunks_exact_mut(2))
        {
            self.half
                .with_solution(|equation, _| equation.set_half(half));
            let outcome = self.half.step(&mut self.next, &mut ());
            if sink.is_active() {
                let found = self.half.with_solution(EulerArnoldHalf::factors);
                for (factor, xi) in factors.iter_mut().zip(found) {
                    factor.copy_from(xi);
                }
            }
            let part = match outcome {
                Ok(part) => part,
                Err(new) => {
                    let known = failure.get_or_insert(StepFailure { lanes: 0, ..new });
                    known.lanes |= new.lanes;
                    new.report
                }
            };
            report.evaluations += part.evaluations;
            report.iterations += part.iterations;
            report.fixed_point += part.fixed_point;
            report.factorizations += part.factorizations;
            report.residual = Scalar::max(report.residual, part.residual);
            report.pivoted |= part.pivoted;
        }
        let failed = S::Mask::from_bits(failure.map_or(0, |failure| failure.lanes));
        mu.assign_where(!failed, &self.next);
        if sink.is_active() && !failed.all() {
            for factor in &mut self.factors {
                clear(factor, failed);
                sink.push(Retraction::Exp, factor);
            }
        }
        match failure {
            None => Ok(report),
            Some(failure) => Err(StepFailure { report, ..failure }),
        }
    }
}
