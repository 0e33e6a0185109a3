//! The spherical midpoint method for spins.
//!
//! On a direct sum of algebras so(3), every state is a list of vectors `$\mu_t$`, the spins. The midpoint of
//! both ends is projected to the sphere of each spin:
//!
//! ```math
//! \mu' = \mu + h f(w), \qquad w_t = |\mu_t|\, \frac{\mu_t + \mu'_t}{|\mu_t + \mu'_t|}
//! ```
//!
//! Order 2, symmetric, a Poisson map; keeps the length of every spin and the coadjoint orbit, and the
//! energy without drift though not exactly. The energy of a single spin with a homogeneous quadratic H is kept
//! exactly: there `mu' - mu` is orthogonal to `grad H(w)`, which is parallel to `grad H(mu + mu')`. Undefined only
//! where `$\mu'_t = -\mu_t$`.
//!
//! Needs: a direct sum of algebras so(3) ([`SpinPoisson`](crate::SpinPoisson)); the vector field and its
//! Jacobian.
//!
//! Reference: R. I. McLachlan, K. Modin, O. Verdier, "Symplectic integrators for spin systems", Physical
//! Review E 89 (2014) 061301,
//! [doi:10.1103/PhysRevE.89.061301](https://doi.org/10.1103/PhysRevE.89.061301).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::facts::{Facts, Preserves};

/// The spherical midpoint method, order 2; see the [module's text](self).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SphericalMidpoint;

impl Facts for SphericalMidpoint {
    const ID: &'static str = "spherical-midpoint";
    const ORDER: u32 = 2;
    const SYMMETRIC: bool = true;
    const EXPLICIT: bool = false;
    const PRESERVES: Preserves = Preserves::POISSON;
    const DAMPING: bool = true;
}

by_equation!([] SphericalMidpoint);
