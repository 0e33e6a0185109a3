//! The implicit midpoint rule on a Poisson manifold.
//!
//! ```math
//! \mu_1 = \mu + h\, f\!\left(\tfrac12 (\mu + \mu_1)\right), \qquad f = \Pi\, \nabla H
//! ```
//!
//! Order 2, symmetric. Keeps every quadratic invariant of the equation, among them quadratic
//! Casimirs and a quadratic energy; Casimirs of higher degree and the Poisson structure are kept only
//! to O(h^2) per unit of time (the Poisson defect of a step is O(h^3)), unless Pi is constant: then each
//! step is a Poisson map, in canonical coordinates a symplectic one.
//!
//! Needs: the vector field and its Jacobian; any [`Poisson`] system.
//!
//! Reference: M. A. Austin, P. S. Krishnaprasad, L.-S. Wang, "Almost Poisson integration of rigid
//! body systems", Journal of Computational Physics 107 (1993) 105–117,
//! [doi:10.1006/jcph.1993.1128](https://doi.org/10.1006/jcph.1993.1128).
//!
//! [`Poisson`]: crate::Poisson
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::facts::{Facts, Preserves};

/// The implicit (Poisson) midpoint rule, order 2; see the [module's text](self).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ImplicitMidpoint;

impl Facts for ImplicitMidpoint {
    const ID: &'static str = "midpoint";
    const ORDER: u32 = 2;
    const SYMMETRIC: bool = true;
    const EXPLICIT: bool = false;
    const PRESERVES: Preserves = Preserves::QUADRATIC;
}

by_equation!([] ImplicitMidpoint);
