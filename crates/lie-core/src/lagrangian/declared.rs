//! Systems whose declaration gives a discrete Lagrangian.

use super::DiscreteLagrangian;
use crate::poisson::LiePoisson;
use crate::scalar::Scalar;

/// A Lie–Poisson system that was declared by a discrete Lagrangian `l_d` of a step of size h, in the coordinates x of
/// a retraction: that of the method which makes the step.
///
/// Its Hamiltonian is that of the Lagrangian which `l_d` approximates, `l(xi) = lim l_d(h xi)/h`. Generated for
/// every system with `discrete_lagrangian = …;`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no discrete Lagrangian over the scalar `{S}`",
    note = "the method needs a system given by its discrete Lagrangian: declare `velocity` and `discrete_lagrangian` instead of `hamiltonian`"
)]
pub trait DiscreteLagrangianPoisson<S: Scalar>: LiePoisson<S> {
    /// The value `l_d(tau(x))` for a step of size h.
    fn discrete_lagrangian(&self, h: S, x: &Self::State) -> S;
    /// Its derivative: `out_i = dl_d/dx^i`.
    fn discrete_slope(&self, h: S, x: &Self::State, out: &mut Self::State);
    /// Its second derivative: `out_ij = d^2l_d/dx^i dx^j`.
    fn discrete_curvature(&self, h: S, x: &Self::State, out: &mut Self::Jacobian);
}

/// The discrete Lagrangian of a system's declaration, for one step size.
#[derive(Clone, Copy, Debug)]
pub struct DeclaredDiscreteLagrangian<'a, S, P> {
    system: &'a P,
    step: S,
}

impl<'a, S: Scalar, P: DiscreteLagrangianPoisson<S>> DeclaredDiscreteLagrangian<'a, S, P> {
    /// The discrete Lagrangian of a step of size h.
    pub fn new(system: &'a P, h: S) -> Self {
        Self { system, step: h }
    }
}

impl<S, P> DiscreteLagrangian<S> for DeclaredDiscreteLagrangian<'_, S, P>
where
    S: Scalar,
    P: DiscreteLagrangianPoisson<S>,
{
    type State = P::State;
    type Jacobian = P::Jacobian;

    fn value(&self, x: &P::State) -> S {
        self.system.discrete_lagrangian(self.step, x)
    }

    fn slope(&self, x: &P::State, out: &mut P::State) {
        self.system.discrete_slope(self.step, x, out);
    }

    fn curvature(&self, x: &P::State, out: &mut P::Jacobian) {
        self.system.discrete_curvature(self.step, x, out);
    }
}
