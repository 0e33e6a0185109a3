//! Systems by a reduced Lagrangian, and discrete Lagrangians.
//!
//! A left-invariant Lagrangian on a Lie group is a function `$l(\xi)$` of the velocity
//! `$\xi = g^{-1} \dot g$`. Its momentum is `$\mu = l'(\xi)$`, and the Euler–Poincaré equations are
//!
//! ```math
//! \frac{\mathrm d}{\mathrm dt}\, l'(\xi) = \mathrm{ad}^*_\xi\, l'(\xi), \qquad
//! \dot\xi = l''(\xi)^{-1}\, \mathrm{ad}^*_\xi\, l'(\xi)
//! ```
//!
//! Where `$l''$` is regular they are the Lie–Poisson equations of the Legendre transform
//! `$H(\mu) = \langle \mu, \xi \rangle - l(\xi)$`, of which the gradient is `$\xi$`: every system of a Lagrangian is
//! a [`LiePoisson`] system too, and every method applies to it.
//!
//! Reference: J. E. Marsden, T. S. Ratiu, "Introduction to Mechanics and Symmetry", 2nd edition, Springer 1999,
//! chapter 13, [doi:10.1007/978-0-387-21792-5](https://doi.org/10.1007/978-0-387-21792-5).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

mod declared;
mod discrete;
pub mod legendre;
mod path;

pub use declared::{DeclaredDiscreteLagrangian, DiscreteLagrangianPoisson};
pub use discrete::{
    DiscreteLagrangian, LagrangianOfStep, Trivialise, legendre_left, legendre_right,
};

use crate::generic;
use crate::poisson::LiePoisson;
use crate::scalar::Scalar;

/// A Lie–Poisson system that was declared by a reduced Lagrangian `l(xi)`.
///
/// Its Hamiltonian is the Legendre transform of l, so that `grad H(l'(xi)) = xi`. The velocity xi is passed as a
/// state: its coordinates in the basis `e_i`.
///
/// Of a Lagrangian `L(g, xi, t)` that is not quadratic in xi a state has the entries of the group element and the time
/// behind the momenta. The velocity comes first there too, [`velocities`](Self::velocities) components of it, and what is passed
/// as xi is the state with the velocity in place of the momenta. The derivatives are by all of its coordinates.
///
/// Generated for every system with `lagrangian = …;`. By hand: implement it beside
/// [`Poisson`](crate::Poisson), whose H, gradient and Hessian can come from [`legendre`].
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no Lagrangian over the scalar `{S}`",
    note = "the method needs a system given by its reduced Lagrangian: declare `velocity` and `lagrangian` instead of `hamiltonian`"
)]
pub trait LagrangianPoisson<S: Scalar>: LiePoisson<S> {
    /// The Lagrangian l(xi).
    fn lagrangian(&self, xi: &Self::State) -> S;
    /// The momentum `out = l'(xi)`: `out_i = dl/dxi^i`.
    fn momentum(&self, xi: &Self::State, out: &mut Self::State);
    /// The inertia `out = l''(xi)`: `out_ij = d^2l/dxi^i dxi^j`.
    fn inertia(&self, xi: &Self::State, out: &mut Self::Jacobian);

    /// How many of the coordinates are momenta, which come first and have a velocity each: all, unless the Lagrangian
    /// depends on the group element or the time.
    fn velocities(&self) -> usize {
        self.dimension()
    }

    /// The velocity of a momentum, `l'(out) = mu`; not finite where there is none. It is the gradient of H, where all
    /// coordinates are momenta.
    fn velocity(&self, mu: &Self::State, out: &mut Self::State) {
        self.gradient(mu, out);
    }

    /// A velocity of the branch that is meant, where several velocities have the same momentum; `None` for that which
    /// begins at rest. See [`legendre`] and [`Poisson::following`](crate::Poisson::following).
    fn branch(&self) -> Option<Self::State> {
        None
    }

    /// The Euler–Poincaré equations as a field of velocities: `out = xi'`, `l''(xi) xi' = ad*_xi l'(xi)`; not
    /// finite where l'' is singular.
    fn euler_poincare(&self, xi: &Self::State, out: &mut Self::State) {
        generic::euler_poincare(self, xi, out);
    }
}
