//! The step of a declared discrete Lagrangian.
//!
//! The declaration gives `$l_d(g)$` in the coordinates `$x = \tau^{-1}(g)$` of the retraction of the method, exp or Cayley,
//! for steps of size `$h$`. One step is the discrete Euler–Poincaré equation, with the right-trivialised tangent
//! `$\mathrm{d}\tau_x$`:
//!
//! ```math
//! \mu = F^+(g) = (\mathrm{d}\tau_x^{-1})^*\, l_d'(x), \qquad
//! \mu_1 = F^-(g) = (\mathrm{d}\tau_{-x}^{-1})^*\, l_d'(x) = \mathrm{Ad}^*_g\, \mu
//! ```
//!
//! A Poisson map that keeps every Casimir and the coadjoint orbit, whatever `$l_d$` is. Its order is the one to which
//! `$l_d$` approximates the action of its Lagrangian, at least 1: an `$l_d$` with `$l_d(g^{-1}; -h) = -l_d(g; h)$` makes
//! symmetric steps of order 2. With `$l_d = h\, l(x/h)$` it is [`Variational2`], with
//! `$l_d = (\mathrm{tr}\, J - \mathrm{tr}(g J))/h$` on SO(n) [`MoserVeselov`].
//!
//! Needs: a discrete Lagrangian, ad*, and for the Cayley map the triple product.
//!
//! References: J. E. Marsden, S. Pekarsky, S. Shkoller, "Discrete Euler–Poincaré and Lie–Poisson
//! equations", Nonlinearity 12 (1999) 1647–1662,
//! [doi:10.1088/0951-7715/12/6/314](https://doi.org/10.1088/0951-7715/12/6/314);
//! N. Bou-Rabee, J. E. Marsden, "Hamilton–Pontryagin integrators on Lie groups", Foundations of
//! Computational Mathematics 9 (2009) 197–219,
//! [doi:10.1007/s10208-008-9030-4](https://doi.org/10.1007/s10208-008-9030-4).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::facts::{Facts, Preserves};
use super::lie_midpoint::{Cayley, Exp};
#[cfg(doc)]
use super::{MoserVeselov, Variational2};

/// The step of a declared discrete Lagrangian; see the [module's text](self).
///
/// Made by [`DiscreteEulerPoincare::exp`] or [`DiscreteEulerPoincare::cayley`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DiscreteEulerPoincare<T> {
    retraction: T,
}

impl DiscreteEulerPoincare<Exp> {
    /// With l_d in exponential coordinates.
    pub const fn exp() -> Self {
        Self { retraction: Exp }
    }
}

impl DiscreteEulerPoincare<Cayley> {
    /// With l_d in the coordinates of the Cayley map of the declared representation.
    pub const fn cayley() -> Self {
        Self { retraction: Cayley }
    }
}

impl<T> Facts for DiscreteEulerPoincare<T> {
    const ID: &'static str = "discrete-euler-poincare";
    const ORDER: u32 = 1;
    const SYMMETRIC: bool = false;
    const EXPLICIT: bool = false;
    const PRESERVES: Preserves = Preserves::POISSON;
}

by_equation!([T] DiscreteEulerPoincare<T>);
