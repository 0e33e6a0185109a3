//! Energy-preserving collocation for Poisson systems.
//!
//! With the Gauss nodes `$c_i$` and weights `$b_i$` of s stages and the Lagrange polynomials `$\ell_i$` on the
//! nodes, the polynomial u of degree s with `$u(0) = \mu$`:
//!
//! ```math
//! \dot u(c_i) = h\, \Pi(u(c_i))\, \frac{1}{b_i} \int_0^1 \ell_i(t)\, \nabla H(u(t))\, \mathrm{d}t, \qquad i = 1, …, s, \qquad
//! \mu_1 = u(1)
//! ```
//!
//! Order 2s, symmetric. The energy is kept, because its change is `$\sum_i b_i \langle g_i, \Pi g_i \rangle h = 0$` with the
//! means `$g_i$` of the gradient; quadratic Casimirs are kept, others and the Poisson structure to the order
//! of the method. With one stage it is the mean-value discrete gradient method, for a quadratic H it
//! is Gauss collocation.
//!
//! Forces act at the stages, `$F(u(c_i))$`, and damping has `$g_i + c\, G\, \Pi\, g_i$` in place of the means: the order stays 2s, and H changes by
//! `$h \sum_i b_i \left(\langle F(u(c_i)), g_i \rangle - c\, \langle \Pi g_i, G\, \Pi g_i \rangle\right)$` to round-off.
//!
//! The integrals are exact for a polynomial H of known degree; otherwise they are Gauss quadrature with
//! 10 nodes or 2s, whichever is more, and a step that those do not resolve is refused
//! ([`FailureReason::Unresolved`](crate::newton::FailureReason::Unresolved)). The unknowns are
//! the increments `$h\, b_i\, \dot u(c_i)$`, whose round-off is relative to h f and not to mu.
//!
//! From four stages on, all stages are evaluated together, in the lanes of one register, by fixed-point iteration from
//! the continued polynomial of the last step (see [`StageParallel`](crate::generic::StageParallel)), and so are the nodes of
//! the quadrature, in blocks of eight. A step on which that does not contract is solved by Newton's iteration like those
//! of fewer stages.
//!
//! Needs: gradient and Hessian of H, the Poisson matrix; any [`Poisson`] system, and
//! [`Widen`] from four stages on.
//!
//! Reference: D. Cohen, E. Hairer, "Linear energy-preserving integrators for Poisson systems", BIT
//! Numerical Mathematics 51 (2011) 91–101,
//! [doi:10.1007/s10543-011-0310-z](https://doi.org/10.1007/s10543-011-0310-z).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::facts::{Facts, Preserves};
use super::gauss::BY_NEWTON;
use super::stage_parallel::{Slopes, StageParallelStepper, WideState, solve};
use super::stepper::{Method, StepFailure, StepReport};
use crate::equation::Equation as _;
use crate::generic::{At, CohenHairerStep, MeanGradients, StageSlopes};
use crate::newton::NewtonOptions;
use crate::poisson::{Poisson, Widen};
use crate::scalar::{Mask as _, Scalar};
use crate::state::Stages;

/// Energy-preserving collocation with 1 to 8 stages, of order twice that; see the
/// [module's text](self).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CohenHairer<const STAGES: usize>;

/// Energy-preserving collocation with one stage, order 2.
pub type CohenHairer2 = CohenHairer<1>;
/// Energy-preserving collocation with two stages, order 4.
pub type CohenHairer4 = CohenHairer<2>;
/// Energy-preserving collocation with three stages, order 6.
pub type CohenHairer6 = CohenHairer<3>;
/// Energy-preserving collocation with four stages, order 8.
pub type CohenHairer8 = CohenHairer<4>;
/// Energy-preserving collocation with five stages, order 10.
pub type CohenHairer10 = CohenHairer<5>;
/// Energy-preserving collocation with six stages, order 12.
pub type CohenHairer12 = CohenHairer<6>;
/// Energy-preserving collocation with seven stages, order 14.
pub type CohenHairer14 = CohenHairer<7>;
/// Energy-preserving collocation with eight stages, order 16.
pub type CohenHairer16 = CohenHairer<8>;

impl<const STAGES: usize> CohenHairer<STAGES> {
    /// The method; it has no options.
    pub const fn new() -> Self {
        Self
    }
}

impl<const STAGES: usize> Facts for CohenHairer<STAGES> {
    const ID: &'static str = match STAGES {
        1 => "cohen-hairer2",
        2 => "cohen-hairer4",
        3 => "cohen-hairer6",
        4 => "cohen-hairer8",
        5 => "cohen-hairer10",
        6 => "cohen-hairer12",
        7 => "cohen-hairer14",
        _ => "cohen-hairer16",
    };
    const ORDER: u32 = 2 * STAGES as u32;
    const SYMMETRIC: bool = true;
    const EXPLICIT: bool = false;
    const FIXED_POINT: bool = STAGES > BY_NEWTON;
    const PRESERVES: Preserves = Preserves::ENERGY;
    const FORCES: bool = true;
    const DAMPING: bool = true;
}

/// A step by Newton's iteration.
fn by_newton<S: Scalar, P: Poisson<S>, const STAGES: usize>(
    system: &P,
    h: S,
    options: &NewtonOptions,
    mu: &mut P::State,
    show: &mut dyn FnMut(&[P::State]),
) -> Result<StepReport, StepFailure> {
    let equation = &mut CohenHairerStep::<S, P, STAGES>::new(system, h);
    solve((equation, system.zero_state()), options, mu, show)
}

/// Methods whose stages are evaluated together.
macro_rules! stage_parallel {
    ($($stages:literal)+) => {$(
        impl<S: Scalar, P: Widen<S>> Method<S, P> for CohenHairer<$stages> {
            type Stepper<'a>
                = StageParallelStepper<'a, S, P, MeanField<'a, S, P, $stages>>
            where
                P: 'a;

            fn stepper<'a>(&self, system: &'a P, h: S, newton: &NewtonOptions) -> Self::Stepper<'a> {
                let rule = ($stages, by_newton::<S, P, $stages> as _);
                StageParallelStepper::new(rule, system, h, newton)
            }
        }
    )+};
}

by_equation!([] CohenHairer<1>);
by_equation!([] CohenHairer<2>);
by_equation!([] CohenHairer<3>);
stage_parallel!(4 5 6 7 8);

/// A matrix of the system over eight numbers.
type WideMatrix<S, P> = <<P as Widen<S>>::Widened as Poisson<<S as Scalar>::Wide>>::Jacobian;

/// `F_i = Pi(Y_i) g_i` with the means `g_i` of the gradient.
pub struct MeanField<'a, S: Scalar, P: Widen<S>, const STAGES: usize> {
    means: MeanGradients<S, WideState<S, P>, WideMatrix<S, P>, STAGES>,
    equation: CohenHairerStep<'a, S, P, STAGES>,
    increments: Stages<P::State, STAGES>,
}

impl<'a, S: Scalar, P: Widen<S> + 'a, const STAGES: usize> Slopes<'a, S, P>
    for MeanField<'a, S, P, STAGES>
{
    fn new(system: &'a P, wide: &P::Widened, h: S) -> Self {
        let equation = CohenHairerStep::new(system, h);
        Self {
            means: MeanGradients::new(system, wide),
            increments: equation.zero_unknown(),
            equation,
        }
    }

    fn known(&self) -> Option<StageSlopes> {
        self.means.are_at_stages().then_some(StageSlopes::Field)
    }

    #[inline(always)]
    fn next(&mut self, wide: &P::Widened, at: At<'_, WideState<S, P>>, out: &mut WideState<S, P>) {
        self.means.slopes(wide, &at, out);
    }

    fn directions(
        &mut self,
        wide: &P::Widened,
        at: At<'_, WideState<S, P>>,
        out: &mut WideState<S, P>,
    ) {
        let mut slopes = out.clone();
        out.clone_from(self.means.directions(wide, &at, &mut slopes));
    }

    fn resolved(
        &mut self,
        mu: &P::State,
        end: &P::State,
        increments: impl FnOnce(&mut [P::State]),
    ) -> S::Mask {
        if !self.equation.may_be_unresolved() {
            return S::Mask::splat(true);
        }
        increments(&mut self.increments.0);
        self.equation.set_base(mu);
        self.equation.resolved(&self.increments, end)
    }
}
