//! The midpoint discrete gradient method of Gonzalez.
//!
//! ```math
//! \mu_1 = \mu + h\, \Pi(m)\, \overline\nabla H, \qquad m = \tfrac12 (\mu + \mu_1), \quad d = \mu_1 - \mu, \qquad
//! \overline\nabla H = \nabla H(m) + \frac{H(\mu_1) - H(\mu) - \langle \nabla H(m), d \rangle}{\langle d, d \rangle}\, d
//! ```
//!
//! Since `$\langle \overline\nabla H, d \rangle = H(\mu_1) - H(\mu)$` and `$\Pi$` is antisymmetric, the energy is
//! kept whatever H is. Order 2, symmetric; keeps quadratic Casimirs, those of higher degree and the
//! Poisson structure only to O(h^2) per unit of time. For a quadratic H it is the midpoint rule.
//!
//! Where forces act, `$h F(m)$` is added, and where a double bracket damps, `$\overline\nabla H + c\, G\, \Pi(m) \overline\nabla H$` takes the place of the
//! discrete gradient: the energy changes by `$h\, \langle F(m), \overline\nabla H \rangle - h\, c\, \langle v, G v \rangle$` with `$v = \Pi(m) \overline\nabla H$`, to round-off.
//!
//! Where a metriplectic term `$K \nabla S$` acts, `$P K(m) P\, \overline\nabla S$` takes its place, `$P$` the projection along the discrete gradient of H: H
//! stays, and S grows by `$h\, \langle P \overline\nabla S, K P \overline\nabla S \rangle \geq 0$`, to round-off.
//!
//! With another tensor in place of `$\Pi(m)$`: [`WithTensor`](super::WithTensor).
//!
//! The quotient loses digits where d is small. [`GonzalezGradient`](crate::generic::GonzalezGradient)
//! explains how that is avoided, for polynomials and in general.
//!
//! Needs: H, its gradient and Hessian, the Poisson matrix; any [`Poisson`](crate::Poisson) system.
//!
//! References: O. Gonzalez, "Time integration and discrete Hamiltonian systems", Journal of Nonlinear
//! Science 6 (1996) 449–467, [doi:10.1007/BF02440162](https://doi.org/10.1007/BF02440162);
//! R. I. McLachlan, G. R. W. Quispel, N. Robidoux, "Geometric integration using discrete gradients",
//! Philosophical Transactions of the Royal Society A 357 (1999) 1021–1045,
//! [doi:10.1098/rsta.1999.0363](https://doi.org/10.1098/rsta.1999.0363).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::facts::{Facts, Preserves};

/// The midpoint discrete gradient method, order 2; see the [module's text](self).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Gonzalez;

impl Facts for Gonzalez {
    const ID: &'static str = "gonzalez";
    const ORDER: u32 = 2;
    const SYMMETRIC: bool = true;
    const EXPLICIT: bool = false;
    const PRESERVES: Preserves = Preserves::ENERGY;
    const FORCES: bool = true;
    const DAMPING: bool = true;
}

by_equation!([] Gonzalez);
