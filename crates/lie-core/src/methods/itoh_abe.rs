//! The discrete gradient method of Itoh and Abe, symmetrised.
//!
//! ```math
//! \mu_1 = \mu + h\, \Pi\!\left(\tfrac12 (\mu + \mu_1)\right) \tfrac12 \left(\overline\nabla H(\mu, \mu_1) + \overline\nabla H(\mu_1, \mu)\right),
//! \qquad
//! \overline\nabla_i H(x, y) = \frac{H(y_1, …, y_i, x_{i+1}, …, x_n) - H(y_1, …, y_{i-1}, x_i, …, x_n)}{y_i - x_i}
//! ```
//!
//! The products `$\overline\nabla_i H\, (y_i - x_i)$` add up to `$H(y) - H(x)$`, and `$\Pi$` is antisymmetric: the
//! energy is kept whatever H is, from values of H alone. The quotients of one path depend on the order
//! of the coordinates and give order 1; the mean of both directions is symmetric and of order 2. It
//! keeps quadratic Casimirs, those of higher degree and the Poisson structure only to O(h^2) per
//! unit of time. For a quadratic H it is the midpoint rule.
//!
//! Where forces act, `$h F(m)$` is added, and where a double bracket damps, `$\overline\nabla H + c\, G\, \Pi(m) \overline\nabla H$` takes the place of the
//! discrete gradient: the energy changes by `$h\, \langle F(m), \overline\nabla H \rangle - h\, c\, \langle v, G v \rangle$` with `$v = \Pi(m) \overline\nabla H$`, to round-off.
//!
//! A quotient loses digits where its increment is small. [`ItohAbeGradient`](crate::generic::ItohAbeGradient)
//! explains how that is avoided, for polynomials and in general.
//!
//! Needs: H, its gradient and Hessian (for Newton's matrix), the Poisson matrix; any
//! [`Poisson`](crate::Poisson) system.
//!
//! References: T. Itoh, K. Abe, "Hamiltonian-conserving discrete canonical equations based on
//! variational difference quotients", Journal of Computational Physics 76 (1988) 85–102,
//! [doi:10.1016/0021-9991(88)90132-5](https://doi.org/10.1016/0021-9991(88)90132-5);
//! R. I. McLachlan, G. R. W. Quispel, N. Robidoux, "Geometric integration using discrete gradients",
//! Philosophical Transactions of the Royal Society A 357 (1999) 1021–1045,
//! [doi:10.1098/rsta.1999.0363](https://doi.org/10.1098/rsta.1999.0363).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::facts::{Facts, Preserves};

/// The symmetrised coordinate-increment method, order 2; see the [module's text](self).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ItohAbe;

impl Facts for ItohAbe {
    const ID: &'static str = "itoh-abe";
    const ORDER: u32 = 2;
    const SYMMETRIC: bool = true;
    const EXPLICIT: bool = false;
    const PRESERVES: Preserves = Preserves::ENERGY;
    const FORCES: bool = true;
    const DAMPING: bool = true;
}

by_equation!([] ItohAbe);
