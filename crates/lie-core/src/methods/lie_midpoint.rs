//! The Lie–Poisson midpoint method: one step along a retraction of the group.
//!
//! With a retraction `$\tau$` (exp or Cayley), its right-trivialised tangent `$\mathrm{d}\tau_x$` and the
//! momentum m at the midpoint as the unknown:
//!
//! ```math
//! (\mathrm{d}\tau_x^{-1})^* m = \mu, \qquad x = h\, \nabla H(m), \qquad
//! \mu_1 = \mathrm{Ad}^*_{\tau(x)}\, \mu = (\mathrm{d}\tau_{-x}^{-1})^* m
//! ```
//!
//! It is the discrete Lie–Poisson flow of the discrete Lagrangian `h l(tau^-1(g)/h)`. Order 2,
//! symmetric, a Poisson map; keeps every Casimir and the coadjoint orbit, and the energy without drift
//! though not exactly.
//!
//! exp works for every algebra. Cayley needs a matrix representation whose span is closed under
//! `(abc + cba)/2`, and then is polynomial: no series. It has a pole where an element has the real eigenvalue 2 or -2: steps
//! along x are refused where one of the x s, 0 <= s <= 1, has it ([`OutsideChart`](crate::newton::FailureReason)).
//!
//! A retraction of the user's own is any map with `$\tau(0) = e$`, `$\mathrm{d}\tau_0 = 1$` and `$\tau(x)\, \tau(-x) = e$`, such as
//! `$\tau(x) = R(-x/2)^{-1} R(x/2)$` of any R with the first two. The equation is `$m = (\mathrm{d}\tau_x)^* \mu$`, without the inverse of the
//! tangent, and the new state `$\mathrm{Ad}^*_{\tau(x)} \mu$`.
//!
//! Where forces act, the force F at the midpoint m enters half before and half after the motion, as in the discrete
//! Lagrange–d'Alembert principle:
//!
//! ```math
//! (\mathrm{d}\tau_x^{-1})^* m = \mu + \tfrac h2 F_a, \qquad \mu_1 = (\mathrm{d}\tau_{-x}^{-1})^* m + \tfrac h2 F_b, \qquad
//! F_b = \mathrm{Ad}^*_{\tau(x)} F_a
//! ```
//!
//! so that the spatial momentum moves by `$\mathrm{Ad}^*_{g_1^{-1}} \mu_1 - \mathrm{Ad}^*_{g^{-1}} \mu = h\, \mathrm{Ad}^*_{g^{-1}} F_a$` to round-off. For
//! exp, `$F_a = \mathrm{Ad}^*_{\exp(-x/2)} F$`: the force is carried by the group element in the middle of the step. For Cayley
//! `$F_a = (\mathrm{d}\tau_x^{-1})^* F$`, which is polynomial, as the method is. Symmetric, order 2.
//!
//! Damping has the generator `$\nabla H + c\, G\, \mathrm{ad}^*_{\nabla H} m$` in place of `$\nabla H$`.
//!
//! Needs: gradient and Hessian of H, ad*, and for Cayley the triple product.
//!
//! References: J. E. Marsden, S. Pekarsky, S. Shkoller, "Discrete Euler–Poincaré and Lie–Poisson
//! equations", Nonlinearity 12 (1999) 1647–1662,
//! [doi:10.1088/0951-7715/12/6/314](https://doi.org/10.1088/0951-7715/12/6/314);
//! N. Bou-Rabee, J. E. Marsden, "Hamilton–Pontryagin integrators on Lie groups", Foundations of
//! Computational Mathematics 9 (2009) 197–219,
//! [doi:10.1007/s10208-008-9030-4](https://doi.org/10.1007/s10208-008-9030-4).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::facts::{Facts, Preserves};

/// The exponential map, for every algebra.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exp;

/// The Cayley map, for triple-closed representations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cayley;

/// The retraction that the system declares ([`RetractedPoisson`](crate::structure::RetractedPoisson)).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Declared;

/// The Lie–Poisson midpoint method, order 2; see the [module's text](self).
///
/// Made by [`LieMidpoint::exp`], [`LieMidpoint::cayley`] or [`LieMidpoint::declared`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LieMidpoint<T> {
    retraction: T,
}

impl LieMidpoint<Exp> {
    /// With the exponential map.
    pub const fn exp() -> Self {
        Self { retraction: Exp }
    }
}

impl LieMidpoint<Cayley> {
    /// With the Cayley map of the declared representation.
    pub const fn cayley() -> Self {
        Self { retraction: Cayley }
    }
}

impl LieMidpoint<Declared> {
    /// With the retraction that the system declares.
    pub const fn declared() -> Self {
        Self {
            retraction: Declared,
        }
    }
}

impl<T> Facts for LieMidpoint<T> {
    const ID: &'static str = "lie-midpoint";
    const ORDER: u32 = 2;
    const SYMMETRIC: bool = true;
    const EXPLICIT: bool = false;
    const PRESERVES: Preserves = Preserves::POISSON;
    const FORCES: bool = true;
    const DAMPING: bool = true;
}

by_equation!([T] LieMidpoint<T>);
