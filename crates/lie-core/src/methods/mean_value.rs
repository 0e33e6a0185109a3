//! The mean-value discrete gradient method, also called averaged vector field.
//!
//! ```math
//! \mu_1 = \mu + h\, \Pi\!\left(\tfrac12 (\mu + \mu_1)\right) \int_0^1 \nabla H(\mu + s\, (\mu_1 - \mu))\, \mathrm{d}s
//! ```
//!
//! The mean g of the gradient satisfies `$\langle g, \mu_1 - \mu \rangle = H(\mu_1) - H(\mu)$`, and `$\Pi$` is
//! antisymmetric: the energy is kept. Order 2, symmetric; keeps quadratic Casimirs, those of higher
//! degree and the Poisson structure only to O(h^2) per unit of time. For a quadratic H it is the
//! midpoint rule.
//!
//! Where forces act, `$h F(m)$` is added, and where a double bracket damps, `$\overline\nabla H + c\, G\, \Pi(m) \overline\nabla H$` takes the place of the
//! discrete gradient: the energy changes by `$h\, \langle F(m), \overline\nabla H \rangle - h\, c\, \langle v, G v \rangle$` with `$v = \Pi(m) \overline\nabla H$`, to round-off.
//!
//! With another tensor in place of `$\Pi(m)$`: [`WithTensor`](super::WithTensor).
//!
//! The integral is exact for a polynomial H of known degree; otherwise it is Gauss quadrature with 10
//! nodes: a step that they do not resolve, so that the energy would change by more than round-off, is
//! refused ([`FailureReason::Unresolved`](crate::newton::FailureReason::Unresolved)).
//!
//! Needs: gradient and Hessian of H, the Poisson matrix; any [`Poisson`](crate::Poisson) system.
//!
//! References: A. Harten, P. D. Lax, B. van Leer, "On upstream differencing and Godunov-type schemes for
//! hyperbolic conservation laws", SIAM Review 25 (1983) 35–61,
//! [doi:10.1137/1025002](https://doi.org/10.1137/1025002);
//! R. I. McLachlan, G. R. W. Quispel, N. Robidoux, "Geometric integration using discrete gradients",
//! Philosophical Transactions of the Royal Society A 357 (1999) 1021–1045,
//! [doi:10.1098/rsta.1999.0363](https://doi.org/10.1098/rsta.1999.0363).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::facts::{Facts, Preserves};

/// The mean-value discrete gradient method, order 2; see the [module's text](self).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeanValue;

impl Facts for MeanValue {
    const ID: &'static str = "mean-value";
    const ORDER: u32 = 2;
    const SYMMETRIC: bool = true;
    const EXPLICIT: bool = false;
    const PRESERVES: Preserves = Preserves::ENERGY;
    const FORCES: bool = true;
    const DAMPING: bool = true;
}

by_equation!([] MeanValue);
