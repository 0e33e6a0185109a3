//! Generating-function methods in coordinates of a retraction: orders 2, 4, 6.
//!
//! A function `$S$` of the fibre momentum p generates the step; with the right-trivialised tangent
//! `$\mathrm{d}\tau_\xi$` of the retraction `$\tau$` (exp or Cayley):
//!
//! ```math
//! (\mathrm{d}\tau_\xi^{-1})^* p = \mu, \qquad \xi = \nabla S(p), \qquad
//! \mu_1 = \mathrm{Ad}^*_{\tau(\xi)}\, \mu = (\mathrm{d}\tau_{-\xi}^{-1})^* p
//! ```
//!
//! The flow of H belongs to the solution of the Hamilton–Jacobi equation
//! `$\partial_t S = H((\mathrm{d}\tau_{-\nabla S}^{-1})^* p)$`, `$S(0) = 0$`, whose power series is odd in h,
//! because `$\tau(-\xi) = \tau(\xi)^{-1}$`. With `$X = \mathrm{ad}^*_{\nabla H} p$`,
//! `$X_2 = \mathrm{ad}^*_{\nabla H} X$`, `$\eta = \nabla S_3$`:
//!
//! ```math
//! S = h H + h^3 S_3 + h^5 S_5, \qquad S_3 = \tfrac1{24} H''(X, X)
//! ```
//!
//! ```math
//! S_5 = \tfrac15 \Bigl[ -\tfrac1{12} \langle X_2, \eta \rangle + \tfrac14 H''(X, \mathrm{ad}^*_\eta p)
//!     + \tfrac1{288} H''(X_2, X_2) + \tfrac1{96} H'''(X, X, X_2) + \tfrac1{384} H''''(X, X, X, X) \Bigr]
//! ```
//!
//! and in Cayley coordinates, with the triple product T of the representation,
//!
//! ```math
//! S_3 = \tfrac1{24} H''(X, X) - \tfrac1{12} \langle p, T(\nabla H, \nabla H, \nabla H) \rangle .
//! ```
//!
//! Cut after h, h^3 or h^5 the series gives orders 2, 4 and 6: symmetric, Poisson maps, which keep
//! every Casimir and the coadjoint orbit, and the energy without drift though not exactly. Order 2 is
//! [`LieMidpoint`]. There is no order 6 with the Cayley map: its S5 has not been derived.
//!
//! Needs: derivatives of H up to order 4 (for order 4) and 6 (for order 6), ad, ad*, and for Cayley
//! the triple product. Newton's matrix is analytic, through the Hessian of S.
//!
//! References: Z. Ge, J. E. Marsden, "Lie–Poisson Hamilton–Jacobi theory and Lie–Poisson
//! integrators", Physics Letters A 133 (1988) 134–139,
//! [doi:10.1016/0375-9601(88)90773-6](https://doi.org/10.1016/0375-9601%2888%2990773-6);
//! P. J. Channell, J. C. Scovel, "Integrators for Lie–Poisson dynamical systems", Physica D 50
//! (1991) 80–88, [doi:10.1016/0167-2789(91)90081-J](https://doi.org/10.1016/0167-2789%2891%2990081-J).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

#[cfg(doc)]
use super::LieMidpoint;
use super::facts::{Facts, Preserves};
use super::lie_midpoint::{Cayley, Exp};

/// A generating-function method of order 2, 4 or 6; see the [module's text](self).
///
/// Made by [`Generating2`], [`Generating4`] and [`Generating6`], for example `Generating4::exp()`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Generating<T, const ORDER: u32> {
    retraction: T,
}

/// Order 2, the same steps as [`LieMidpoint`]: `Generating2::exp()`, `Generating2::cayley()`.
pub type Generating2<T = Exp> = Generating<T, 2>;
/// Order 4: `Generating4::exp()`, `Generating4::cayley()`.
pub type Generating4<T = Exp> = Generating<T, 4>;
/// Order 6: `Generating6::exp()`.
pub type Generating6<T = Exp> = Generating<T, 6>;

macro_rules! generating {
    ($retraction:ident, $constructor:ident, $doc:literal: $($order:literal $id:literal),+) => {$(
        impl Generating<$retraction, $order> {
            #[doc = $doc]
            pub const fn $constructor() -> Self {
                Self { retraction: $retraction }
            }
        }

        impl Facts for Generating<$retraction, $order> {
            const ID: &'static str = $id;
            const ORDER: u32 = $order;
            const SYMMETRIC: bool = true;
            const EXPLICIT: bool = false;
            const PRESERVES: Preserves = Preserves::POISSON;
        }
    )+};
}

generating!(Exp, exp, "With the exponential map.": 2 "generating2", 4 "generating4", 6 "generating6");
generating!(Cayley, cayley, "With the Cayley map of the declared representation.": 2 "generating2", 4 "generating4");

by_equation!([T, const ORDER: u32] Generating<T, ORDER> where Self: Facts);
