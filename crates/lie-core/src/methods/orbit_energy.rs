//! Motion along a discrete gradient on the coadjoint orbit, or symplectic leaf: the orbit and the energy at once.
//!
//! ```math
//! \mu_1 = \mathrm{Ad}^*_{\exp(h \xi)}\, \mu, \qquad \xi = \overline\nabla H(\mu, \mu_1)
//! ```
//!
//! with a symmetric discrete gradient, `$\langle \overline\nabla H(x, y), y - x \rangle = H(y) - H(x)$`. The new state
//! lies on the coadjoint orbit of the old one, so every Casimir is kept, of whatever degree. The energy
//! is kept because `$\langle \xi, \mathrm{ad}^*_\xi\, \cdot\, \rangle = \langle \cdot, [\xi, \xi] \rangle = 0$`, hence
//! `$\langle \xi, (\exp(\mathrm{ad}^*_{h\xi}) - 1)\, \mu \rangle = 0$`. Both hold for every Lie algebra. Order 2, symmetric, so
//! that compositions raise the order and keep both. Not a Poisson map.
//!
//! Where forces act, half of the force at the midpoint is added before the motion and half after it,
//! `$\mu_1 = \mathrm{Ad}^*_{\exp(h \xi)}(\mu + \tfrac h2 F) + \tfrac h2 F$`, and H changes by `$h\, \langle F, \overline\nabla H \rangle$`. Damping has
//! `$\xi = \overline\nabla H + c\, G\, v$`, `$v = \mathrm{ad}^*_{\overline\nabla H} \varphi_1(h\, \mathrm{ad}^*_\xi)(\mu + \tfrac h2 F)$`, with which H falls by
//! `$h\, c\, \langle v, G v \rangle$` on the orbit, at any step. Both to round-off.
//!
//! On any other Poisson manifold the end of the flow of `$\dot y = \Pi(y)\, h \xi$` over unit time takes the place of the coadjoint action, with `$\xi$`
//! held ([`FrozenFlow`](crate::generic::FrozenFlow)): it moves along the symplectic leaf, so that every Casimir is kept, and since
//! `$\langle \xi, \Pi\, \xi \rangle = 0$` so is the energy, also where `$\Pi$` fails the Jacobi identity. Forces and damping act in the same way, with the
//! mean of `$\Pi(y)\, \overline\nabla H$` on the way for v.
//!
//! The unknown is the new state: the round-off of a discrete gradient then enters multiplied by h.
//!
//! Needs: what the discrete gradient needs, ad and ad* of an algebra, of other brackets the Poisson matrix and its derivative; any
//! [`Poisson`](crate::Poisson) system.
//!
//! Reference: K. Engø, S. Faltinsen, "Numerical integration of Lie–Poisson systems while preserving
//! coadjoint orbits and energy", SIAM Journal on Numerical Analysis 39 (2001) 128–145,
//! [doi:10.1137/S0036142999364212](https://doi.org/10.1137/S0036142999364212).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::facts::{Facts, Preserves};
use super::{Gonzalez, ItohAbe, MeanValue};

/// Coadjoint motion along the discrete gradient G, order 2; see the [module's text](self).
///
/// Made by [`OrbitEnergy::gonzalez`], [`OrbitEnergy::mean_value`] or [`OrbitEnergy::itoh_abe`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OrbitEnergy<G = Gonzalez> {
    gradient: G,
}

impl OrbitEnergy<Gonzalez> {
    /// Along the midpoint discrete gradient.
    pub const fn gonzalez() -> Self {
        Self { gradient: Gonzalez }
    }
}

impl OrbitEnergy<MeanValue> {
    /// Along the mean of the gradient.
    pub const fn mean_value() -> Self {
        Self {
            gradient: MeanValue,
        }
    }
}

impl OrbitEnergy<ItohAbe> {
    /// Along the symmetrised coordinate increments.
    pub const fn itoh_abe() -> Self {
        Self { gradient: ItohAbe }
    }
}

impl<G> Facts for OrbitEnergy<G> {
    const ID: &'static str = "orbit-energy";
    const ORDER: u32 = 2;
    const SYMMETRIC: bool = true;
    const EXPLICIT: bool = false;
    const PRESERVES: Preserves = Preserves::ORBIT_ENERGY;
    const FORCES: bool = true;
    const DAMPING: bool = true;
}

by_equation!([G] OrbitEnergy<G>);
