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
//! The integrals are exact for a polynomial H of known degree; otherwise they are Gauss quadrature with
//! 10 nodes, and a step that those do not resolve is refused
//! ([`FailureReason::Unresolved`](crate::newton::FailureReason::Unresolved)). The unknowns are
//! the increments `$h\, \dot u(c_i)$`, whose round-off is relative to h f and not to mu.
//!
//! Needs: gradient and Hessian of H, the Poisson matrix; any [`Poisson`](crate::Poisson) system.
//!
//! Reference: D. Cohen, E. Hairer, "Linear energy-preserving integrators for Poisson systems", BIT
//! Numerical Mathematics 51 (2011) 91–101,
//! [doi:10.1007/s10543-011-0310-z](https://doi.org/10.1007/s10543-011-0310-z).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::facts::{Facts, Preserves};
use super::implicit::ImplicitStepper;
use super::stepper::Method;
use crate::equation::Implicit;
use crate::newton::NewtonOptions;
use crate::scalar::Scalar;

/// Energy-preserving collocation with 1, 2 or 3 stages, of order twice that; see the
/// [module's text](self).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CohenHairer<const STAGES: usize>;

/// Energy-preserving collocation with one stage, order 2.
pub type CohenHairer2 = CohenHairer<1>;
/// Energy-preserving collocation with two stages, order 4.
pub type CohenHairer4 = CohenHairer<2>;
/// Energy-preserving collocation with three stages, order 6.
pub type CohenHairer6 = CohenHairer<3>;

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
        _ => "cohen-hairer6",
    };
    const ORDER: u32 = 2 * STAGES as u32;
    const SYMMETRIC: bool = true;
    const EXPLICIT: bool = false;
    const PRESERVES: Preserves = Preserves::ENERGY;
}

impl<S: Scalar, P: Implicit<S, Self>, const STAGES: usize> Method<S, P> for CohenHairer<STAGES> {
    type Stepper<'a>
        = ImplicitStepper<S, P::Equation<'a>>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, newton: &NewtonOptions) -> Self::Stepper<'a> {
        ImplicitStepper::new(system.equation(self, h), system.zero_state(), newton)
    }
}
