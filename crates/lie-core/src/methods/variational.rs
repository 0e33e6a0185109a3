//! Variational integrators on the group, reduced: discrete Euler–Poincaré steps of orders 2, 4, 6.
//!
//! A discrete Lagrangian `$l_d(g)$` stands for the action of one step `$g = q_k^{-1} q_{k+1}$`; the sum over all
//! steps is stationary where the discrete Euler–Poincaré equation
//! `$L_{g_k}^*\, \mathrm dl_d(g_k) = R_{g_{k+1}}^*\, \mathrm dl_d(g_{k+1})$` holds. With the momentum
//! `$\mu_k = R_{g_k}^*\, \mathrm dl_d(g_k)$` and the right-trivialised tangent `$\mathrm{d}\tau_x$` of a retraction,
//! order 2 is the choice `$l_d = h\, l(\tau^{-1}(g)/h)$`:
//!
//! ```math
//! (\mathrm{d}\tau_{h\xi}^{-1})^*\, l'(\xi) = \mu, \qquad
//! \mu_1 = \mathrm{Ad}^*_{\tau(h\xi)}\, \mu = (\mathrm{d}\tau_{-h\xi}^{-1})^*\, l'(\xi)
//! ```
//!
//! Orders 4 and 6 take a path `$\exp(\theta(t))$`, `$\theta$` a polynomial of degree `$s = 2, 3$` with the control
//! points `$\Theta_1, \dots, \Theta_s$`, and Gauss quadrature of its action:
//!
//! ```math
//! l_d(\exp \Theta_s) = \operatorname*{ext}_{\Theta_1, \dots, \Theta_{s-1}}\; h \sum_i b_i\, l(\xi_i), \qquad
//! \xi_i = \mathrm{dexp}_{-\theta(c_i)}\, \theta'(c_i)
//! ```
//!
//! Where a Lagrangian depends on the group element or the time, or forces act or damping does, the same path is that of phase space, with a
//! momentum `$m_i$` at each node: the discrete Lagrange–d'Alembert principle
//!
//! ```math
//! \delta\, h \sum_i b_i \bigl(\langle m_i, \xi_i \rangle - H(m_i, g_i)\bigr) + h \sum_i b_i\, \langle F_i, g_i^{-1} \delta g_i \rangle
//! = \langle \mu_1, g_1^{-1} \delta g_1 \rangle - \langle \mu, g^{-1} \delta g \rangle,
//! \qquad g_i = g \exp \theta(c_i)
//! ```
//!
//! where `$\xi_i$` is the velocity that belongs to `$m_i$`, with damping the generator of the motion. The order stays, and the spatial momentum
//! changes by exactly the impulses `$h b_i F_i$`, those of a potential among them, each carried to space by the group element of its node:
//!
//! ```math
//! \mathrm{Ad}^*_{g_1^{-1}}\, \mu_1 - \mathrm{Ad}^*_{g^{-1}}\, \mu = h \sum_i b_i\, \mathrm{Ad}^*_{g_i^{-1}}\, F_i
//! ```
//!
//! Along the Cayley map the coordinates are those about the middle of the step, `$\theta(1/2) = 0$`, in phase space only, where orders 4 and 6
//! are too; see [`GalerkinCayley`](crate::generic::GalerkinCayley). Along a retraction that the system declares there is order 2 of a reduced
//! Lagrangian, whose equation is that of [`LieMidpoint`].
//!
//! Without forces and damping all are Poisson maps, keep every Casimir and the coadjoint orbit, and the energy without drift though not
//! exactly. Order 2 is symmetric and makes, of a reduced Lagrangian, the steps of [`LieMidpoint`] of the Legendre transform; the others are
//! symmetric along the Cayley map, and along the exponential map up to terms of their error only, because the coordinates are centred at the left
//! end of the step.
//!
//! Needs: a system by its Lagrangian, `$l'$` and `$l''$`, ad, ad*, and for the Cayley map the triple product; in phase space the Legendre transform
//! alone. Newton's matrix is exact: analytic for order 2 of a reduced Lagrangian, by dual numbers for the others.
//!
//! References: J. E. Marsden, S. Pekarsky, S. Shkoller, "Discrete Euler–Poincaré and Lie–Poisson
//! equations", Nonlinearity 12 (1999) 1647–1662,
//! [doi:10.1088/0951-7715/12/6/314](https://doi.org/10.1088/0951-7715/12/6/314);
//! N. Bou-Rabee, J. E. Marsden, "Hamilton–Pontryagin integrators on Lie groups", Foundations of
//! Computational Mathematics 9 (2009) 197–219,
//! [doi:10.1007/s10208-008-9030-4](https://doi.org/10.1007/s10208-008-9030-4);
//! J. Hall, M. Leok, "Lie group spectral variational integrators", Foundations of Computational Mathematics
//! 17 (2017) 199–257, [doi:10.1007/s10208-015-9287-3](https://doi.org/10.1007/s10208-015-9287-3);
//! J. E. Marsden, M. West, "Discrete mechanics and variational integrators", Acta Numerica 10 (2001) 357–514, section 3,
//! [doi:10.1017/S096249290100006X](https://doi.org/10.1017/S096249290100006X).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

#[cfg(doc)]
use super::LieMidpoint;
use super::facts::{Facts, Preserves};
use super::lie_midpoint::{Cayley, Declared, Exp};

/// A variational integrator of order 2, 4 or 6; see the [module's text](self).
///
/// Made by [`Variational2`], [`Variational4`] and [`Variational6`], for example `Variational2::cayley()`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Variational<T, const ORDER: u32> {
    retraction: T,
}

/// Order 2: `Variational2::exp()`, `Variational2::cayley()`, `Variational2::declared()`.
pub type Variational2<T = Exp> = Variational<T, 2>;
/// Order 4: `Variational4::exp()`, `Variational4::cayley()`.
pub type Variational4<T = Exp> = Variational<T, 4>;
/// Order 6: `Variational6::exp()`, `Variational6::cayley()`.
pub type Variational6<T = Exp> = Variational<T, 6>;

/// In place of a retraction: paths by the exponential map in phase space, which is what a system takes that carries the group element or the
/// time. A method with [`Exp`] finds them by itself where they are the equation of the system.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OnGroup;

/// In place of a retraction: paths by the Cayley map in phase space. A method with [`Cayley`] finds them by itself where they are the
/// equation of the system.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CayleyOnGroup;

macro_rules! variational {
    ($retraction:ident, $constructor:ident, $symmetric:literal, $forces:literal, $doc:literal: $($order:literal $id:literal),+) => {$(
        impl Variational<$retraction, $order> {
            #[doc = $doc]
            pub const fn $constructor() -> Self {
                Self { retraction: $retraction }
            }
        }

        impl Facts for Variational<$retraction, $order> {
            const ID: &'static str = $id;
            const ORDER: u32 = $order;
            const SYMMETRIC: bool = $symmetric || $order == 2;
            const EXPLICIT: bool = false;
            const PRESERVES: Preserves = Preserves::POISSON;
            const FORCES: bool = $forces;
            const DAMPING: bool = $forces;
        }
    )+};
}

variational!(Exp, exp, false, true, "With the exponential map.": 2 "variational2", 4 "variational4", 6 "variational6");
variational!(OnGroup, on_group, false, true, "With the exponential map, in phase space.": 2 "variational2", 4 "variational4", 6 "variational6");
variational!(Cayley, cayley, true, true, "With the Cayley map of the declared representation.": 2 "variational2", 4 "variational4", 6 "variational6");
variational!(CayleyOnGroup, cayley_on_group, true, true, "With the Cayley map, in phase space.": 2 "variational2", 4 "variational4", 6 "variational6");
variational!(Declared, declared, true, false, "With the retraction that the system declares.": 2 "variational2");

by_equation!([T, const ORDER: u32] Variational<T, ORDER> where Self: Facts);
