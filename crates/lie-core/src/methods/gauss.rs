//! Gauss collocation on mu' = f(mu).
//!
//! ```math
//! Y_i = \mu + h \sum_{j=1}^s a_{ij}\, f(Y_j), \qquad \mu_1 = \mu + h \sum_{i=1}^s b_i\, f(Y_i)
//! ```
//!
//! with the nodes of Gauss and Legendre: order 2s with s stages, symmetric, keeps every quadratic
//! invariant of the equation, and is a Poisson map where the Poisson matrix is constant. The unknowns are the increments
//! `D_i = h b_i f(Y_i)`, whose round-off is relative to h f and not to mu, with coefficients for which rounding leaves
//! every quadratic invariant ([`generic::gauss_ratio`](crate::generic::gauss_ratio)).
//!
//! From four stages on, all stages are evaluated together, in the lanes of one register, and the iteration is
//! `D_i <- h b_i f(mu + sum_j (a_ij/b_j) D_j)` from the continued polynomial of the last step (see [`StageParallel`]). A step on which it
//! does not contract is solved by Newton's iteration like those of [`Gauss4`] and [`Gauss6`].
//!
//! Needs: the vector field and its Jacobian; any [`Poisson`] system, and [`Widen`] from four stages on.
//!
//! Reference: E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration", 2nd edition,
//! Springer 2006, sections II.1.3 and IV.2,
//! [doi:10.1007/3-540-30666-8](https://doi.org/10.1007/3-540-30666-8).
//!
//! [`Poisson`]: crate::Poisson
//! [`StageParallel`]: crate::generic::StageParallel
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::facts::{Facts, Preserves};
use super::stage_parallel::{Field, StageParallelStepper, solve};
use super::stepper::{Method, StepFailure, StepReport};
use crate::generic::Gauss;
use crate::newton::NewtonOptions;
use crate::poisson::{Poisson, Widen};
use crate::scalar::Scalar;

/// The most stages of a Gauss method that is solved by Newton's iteration from the start, and has an equation for it.
pub const BY_NEWTON: usize = 3;

macro_rules! gauss {
    ($(#[$doc:meta])* $name:ident, $stages:literal, $id:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub struct $name;

        impl Facts for $name {
            const ID: &'static str = $id;
            const ORDER: u32 = 2 * $stages;
            const SYMMETRIC: bool = true;
            const EXPLICIT: bool = false;
            const FIXED_POINT: bool = $stages > BY_NEWTON;
            const PRESERVES: Preserves = Preserves::QUADRATIC;
            const FORCES: bool = true;
            const DAMPING: bool = true;
        }
    };
}

/// A step by Newton's iteration.
fn by_newton<S: Scalar, P: Poisson<S>, const STAGES: usize>(
    system: &P,
    h: S,
    options: &NewtonOptions,
    mu: &mut P::State,
    show: &mut dyn FnMut(&[P::State]),
) -> Result<StepReport, StepFailure> {
    let equation = &mut Gauss::<S, P, STAGES>::new(system, h);
    solve((equation, system.zero_state()), options, mu, show)
}

/// A method whose stages are evaluated together.
macro_rules! stage_parallel {
    ($name:ident, $stages:literal) => {
        impl<S: Scalar, P: Widen<S>> Method<S, P> for $name {
            type Stepper<'a>
                = StageParallelStepper<'a, S, P, Field>
            where
                P: 'a;

            fn stepper<'a>(
                &self,
                system: &'a P,
                h: S,
                newton: &NewtonOptions,
            ) -> Self::Stepper<'a> {
                let rule = ($stages, by_newton::<S, P, $stages> as _);
                StageParallelStepper::new(rule, system, h, newton)
            }
        }
    };
}

gauss!(
    /// Gauss collocation with two stages, order 4; see the [module's text](self).
    Gauss4, 2, "gauss4"
);
gauss!(
    /// Gauss collocation with three stages, order 6; see the [module's text](self).
    Gauss6, 3, "gauss6"
);
gauss!(
    /// Gauss collocation with four stages, order 8; see the [module's text](self).
    Gauss8, 4, "gauss8"
);
gauss!(
    /// Gauss collocation with five stages, order 10; see the [module's text](self).
    Gauss10, 5, "gauss10"
);
gauss!(
    /// Gauss collocation with six stages, order 12; see the [module's text](self).
    Gauss12, 6, "gauss12"
);
gauss!(
    /// Gauss collocation with seven stages, order 14; see the [module's text](self).
    Gauss14, 7, "gauss14"
);
gauss!(
    /// Gauss collocation with eight stages, order 16; see the [module's text](self).
    Gauss16, 8, "gauss16"
);
by_equation!([] Gauss4);
by_equation!([] Gauss6);
stage_parallel!(Gauss8, 4);
stage_parallel!(Gauss10, 5);
stage_parallel!(Gauss12, 6);
stage_parallel!(Gauss14, 7);
stage_parallel!(Gauss16, 8);
