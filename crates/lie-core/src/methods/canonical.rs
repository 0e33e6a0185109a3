//! Gauss collocation in coordinates in which the bracket is constant.
//!
//! ```math
//! w(Y_i) = w(\mu) + h \sum_{j=1}^s a_{ij}\, g(Y_j), \qquad w(\mu_1) = w(\mu) + h \sum_{i=1}^s b_i\, g(Y_i), \qquad g = w'(\mu)\, f(\mu)
//! ```
//!
//! with coordinates w of the system ([`CanonicalPoisson`](crate::structure::CanonicalPoisson)) in which the Poisson matrix is constant. In
//! these it is Gauss collocation, and so a Poisson map of order 2s that keeps every linear function of w that is a Casimir; the state stays what was
//! declared, and no inverse of w is needed: the stages and the end are found together, as states. For a pair `$\{x, y\} = 1/B(x, y)$` that
//! is `$w = (x, Y)$`, `$Y = \int B\, \mathrm{d}y$`, `$\{x, Y\} = 1$`, the guiding centre of a charged particle; for `$\{x_i, x_j\} = c_{ij} x_i x_j$` it is the logarithms.
//!
//! A step whose stages leave the side of the state, behind a zero or a pole of a slope `$\partial w_i/\partial \mu_i$`, is refused.
//!
//! Needs: such coordinates, with the field in them and its derivative.
//!
//! Reference: E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration", 2nd edition,
//! Springer 2006, sections IV.2 and VII.4,
//! [doi:10.1007/3-540-30666-8](https://doi.org/10.1007/3-540-30666-8).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::facts::{Facts, Preserves};

macro_rules! canonical {
    ($($(#[$doc:meta])* $name:ident $order:literal $id:literal;)+) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub struct $name;

        impl Facts for $name {
            const ID: &'static str = $id;
            const ORDER: u32 = $order;
            const SYMMETRIC: bool = true;
            const EXPLICIT: bool = false;
            const PRESERVES: Preserves = Preserves::POISSON;
            const FORCES: bool = true;
            const DAMPING: bool = true;
        }

        by_equation!([] $name);
    )+};
}

canonical! {
    /// The midpoint rule in canonical coordinates, order 2; see the [module's text](self).
    Canonical2 2 "canonical2";
    /// Gauss collocation with two stages in canonical coordinates, order 4; see the [module's text](self).
    Canonical4 4 "canonical4";
    /// Gauss collocation with three stages in canonical coordinates, order 6; see the [module's text](self).
    Canonical6 6 "canonical6";
}
