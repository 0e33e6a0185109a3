//! The generating-function method in coordinates of the second kind, order 2.
//!
//! With `$g(\xi) = \exp(\xi_1 e_1) \cdots \exp(\xi_n e_n)$` and the left- and right-trivialised tangents of these
//! coordinates, whose columns are `$\mathrm{Ad}$` of the factors to the right and to the left of `$e_i$`:
//!
//! ```math
//! D_R(\xi)^{-T} p = \mu, \qquad \xi = \nabla S(p), \qquad \mu_1 = D_L(\xi)^{-T} p = \mathrm{Ad}^*_{g(\xi)}\, \mu
//! ```
//!
//! ```math
//! S = h H + h^2 S_2, \qquad
//! S_2 = \tfrac12 \sum_{i<j} \frac{\partial H}{\partial p_i} \frac{\partial H}{\partial p_j}\, C_{ji}^k\, p_k
//! ```
//!
//! The equation is solved in the form `$p_i = \bigl( e^{\xi_{i-1} \mathrm{ad}^*_{e_{i-1}}} \cdots
//! e^{\xi_1 \mathrm{ad}^*_{e_1}} \mu \bigr)_i$`: only actions of single basis elements, which have closed forms.
//! `$g(-\xi)$` is not the inverse of `$g(\xi)$`, hence `$S_2 \ne 0$` and the method is not symmetric; without
//! `$S_2$` it has order 1. A Poisson map that keeps every Casimir and the coadjoint orbit. The order
//! of the basis matters.
//!
//! Needs: derivatives of H up to order 3, ad, ad*.
//!
//! References: Z. Ge, J. E. Marsden, "Lie–Poisson Hamilton–Jacobi theory and Lie–Poisson
//! integrators", Physics Letters A 133 (1988) 134–139,
//! [doi:10.1016/0375-9601(88)90773-6](https://doi.org/10.1016/0375-9601%2888%2990773-6);
//! P. J. Channell, J. C. Scovel, "Integrators for Lie–Poisson dynamical systems", Physica D 50
//! (1991) 80–88, [doi:10.1016/0167-2789(91)90081-J](https://doi.org/10.1016/0167-2789%2891%2990081-J).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::facts::{Facts, Preserves};

/// The generating-function method in coordinates of the second kind, order 2; see the
/// [module's text](self).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GeneratingSecondKind2;

impl Facts for GeneratingSecondKind2 {
    const ID: &'static str = "generating-second-kind2";
    const ORDER: u32 = 2;
    const SYMMETRIC: bool = false;
    const EXPLICIT: bool = false;
    const PRESERVES: Preserves = Preserves::POISSON;
}

by_equation!([] GeneratingSecondKind2);
