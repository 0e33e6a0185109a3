//! Discrete Lagrangians on the group, their two Legendre maps, and what a step is in their terms.

use super::LagrangianPoisson;
use super::legendre;
use crate::generic;
use crate::matrix::SquareMatrix;
use crate::methods::{Cayley, Exp};
use crate::newton::exchanging;
use crate::poisson::{CayleyPoisson, LiePoisson};
use crate::scalar::Scalar;
use crate::state::State;

/// A discrete Lagrangian `l_d(g)` of one step, as a function of the coordinates `x = tau^-1(g)` of a retraction.
///
/// The sum of `l_d(g_k)`, `g_k = q_k^-1 q_(k+1)`, is stationary where the discrete Euler–Poincaré equation
/// holds. With the right-trivialised tangent of the retraction it reads
///
/// ```text
/// F+(g_k) = mu_k,   F-(g_k) = mu_(k+1) = Ad*_(g_k) mu_k,   F-(g_k) = F+(g_(k+1))
/// F+(g) = R_g^* dl_d(g) = (d tau_x^-1)* l_d'(x)      see legendre_right
/// F-(g) = L_g^* dl_d(g) = (d tau_(-x)^-1)* l_d'(x)   see legendre_left
/// ```
///
/// The step of a momentum mu solves `F+(tau(x)) = mu`, see [`crate::generic::ExpVariational`] and
/// [`crate::generic::CayleyVariational`]. Moser and Veselov's discrete body is the instance
/// `l_d(g) = (tr J - tr(g J))/h`.
///
/// References: J. E. Marsden, S. Pekarsky, S. Shkoller, "Discrete Euler–Poincaré and Lie–Poisson equations",
/// Nonlinearity 12 (1999) 1647–1662,
/// [doi:10.1088/0951-7715/12/6/314](https://doi.org/10.1088/0951-7715/12/6/314); A. I. Bobenko, Yu. B. Suris,
/// "Discrete Lagrangian reduction, discrete Euler–Poincaré equations, and semidirect products", Letters in
/// Mathematical Physics 49 (1999) 79–93, [doi:10.1023/A:1007654605901](https://doi.org/10.1023/A:1007654605901).
pub trait DiscreteLagrangian<S: Scalar> {
    /// The coordinates x.
    type State: State<S>;
    /// An n x n matrix.
    type Jacobian: SquareMatrix<S>;

    /// The value `l_d(tau(x))`.
    fn value(&self, x: &Self::State) -> S;
    /// The derivative: `out_i = dl_d/dx^i`.
    fn slope(&self, x: &Self::State, out: &mut Self::State);
    /// The second derivative: `out_ij = d^2l_d/dx^i dx^j`.
    fn curvature(&self, x: &Self::State, out: &mut Self::Jacobian);

    /// The point x with `l_d'(x) = mu` near the unit, and `inverse = l_d''(x)^-1`; not finite where there is none.
    ///
    /// The provided body goes along a path from `x = 0`, see [`legendre::solve`].
    fn start(&self, mu: &Self::State, x: &mut Self::State, inverse: &mut Self::Jacobian) {
        let mut matrix = inverse.clone();
        x.fill(S::zero());
        legendre::solve(
            mu.as_slice().len(),
            |x, out| self.slope(x, out),
            |x, out| self.curvature(x, out),
            mu,
            legendre::From::Rest,
            x,
            &mut matrix,
        );
        self.curvature(x, &mut matrix);
        exchanging::invert(&mut matrix, inverse);
    }
}

/// The discrete Lagrangian `l_d(g) = h l(tau^-1(g)/h)` of a step of size h, for every retraction: that of
/// [`Variational2`](crate::methods::Variational2).
#[derive(Clone, Copy, Debug)]
pub struct LagrangianOfStep<'a, S, P> {
    system: &'a P,
    step: S,
}

impl<'a, S: Scalar, P: LagrangianPoisson<S>> LagrangianOfStep<'a, S, P> {
    /// The discrete Lagrangian of a step of size h.
    pub fn new(system: &'a P, h: S) -> Self {
        Self { system, step: h }
    }

    fn velocity(&self, x: &P::State) -> P::State {
        let mut xi = x.clone();
        for entry in xi.as_mut_slice() {
            *entry /= self.step;
        }
        xi
    }
}

impl<S: Scalar, P: LagrangianPoisson<S>> DiscreteLagrangian<S> for LagrangianOfStep<'_, S, P> {
    type State = P::State;
    type Jacobian = P::Jacobian;

    fn value(&self, x: &P::State) -> S {
        self.step * self.system.lagrangian(&self.velocity(x))
    }

    fn slope(&self, x: &P::State, out: &mut P::State) {
        self.system.momentum(&self.velocity(x), out);
    }

    fn curvature(&self, x: &P::State, out: &mut P::Jacobian) {
        self.system.inertia(&self.velocity(x), out);
        scale(S::one() / self.step, out);
    }

    fn start(&self, mu: &P::State, x: &mut P::State, inverse: &mut P::Jacobian) {
        self.system.velocity(mu, x);
        for entry in x.as_mut_slice() {
            *entry *= self.step;
        }
        self.system.hessian(mu, inverse);
        scale(self.step, inverse);
    }
}

fn scale<S: Scalar, M: SquareMatrix<S>>(factor: S, matrix: &mut M) {
    for row in 0..matrix.dimension() {
        for column in 0..matrix.dimension() {
            matrix.set(row, column, factor * matrix.get(row, column));
        }
    }
}

/// A retraction whose tangent can be inverted on a system: [`Exp`] on every Lie algebra, [`Cayley`] where there is a
/// Cayley map.
pub trait Trivialise<S: Scalar, P: LiePoisson<S>> {
    /// `out = (d tau_x^-1)* m`, the inverse of the right-trivialised tangent; not finite where it is singular.
    fn inverse_tangent_dual(system: &P, x: &P::State, m: &P::State, out: &mut P::State);
}

impl<S: Scalar, P: LiePoisson<S>> Trivialise<S, P> for Exp {
    fn inverse_tangent_dual(system: &P, x: &P::State, m: &P::State, out: &mut P::State) {
        generic::dexp_inverse_dual(system, x, m, out);
    }
}

impl<S: Scalar, P: CayleyPoisson<S>> Trivialise<S, P> for Cayley {
    fn inverse_tangent_dual(system: &P, x: &P::State, m: &P::State, out: &mut P::State) {
        generic::dcay_inverse_dual(system, x, m, out);
    }
}

/// The discrete Legendre map `F+(g) = R_g^* dl_d(g)`, the momentum `mu_k` before the step `g = tau(x)`.
pub fn legendre_right<S, P, L, T>(
    _retraction: &T,
    system: &P,
    l_d: &L,
    x: &P::State,
    out: &mut P::State,
) where
    S: Scalar,
    P: LiePoisson<S>,
    L: DiscreteLagrangian<S, State = P::State>,
    T: Trivialise<S, P>,
{
    let mut slope = system.zero_state();
    l_d.slope(x, &mut slope);
    T::inverse_tangent_dual(system, x, &slope, out);
}

/// The discrete Legendre map `F-(g) = L_g^* dl_d(g)`, the momentum `mu_(k+1)` after the step `g = tau(x)`.
pub fn legendre_left<S, P, L, T>(
    _retraction: &T,
    system: &P,
    l_d: &L,
    x: &P::State,
    out: &mut P::State,
) where
    S: Scalar,
    P: LiePoisson<S>,
    L: DiscreteLagrangian<S, State = P::State>,
    T: Trivialise<S, P>,
{
    let mut slope = system.zero_state();
    l_d.slope(x, &mut slope);
    let mut back = x.clone();
    for entry in back.as_mut_slice() {
        *entry = -*entry;
    }
    T::inverse_tangent_dual(system, &back, &slope, out);
}
