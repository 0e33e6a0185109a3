//! The discrete rigid body of Moser and Veselov.
//!
//! For the free rigid body in n dimensions, `$M = \Omega J + J \Omega$` with a symmetric matrix J and `$\Omega = \nabla H(M)$`, in
//! the axes of the moments `$H = \sum_{i<j} M_{ij}^2 / (2 (J_i + J_j))$` on so(n)*:
//!
//! ```math
//! h M = g J - J g^T, \qquad g \in SO(n) \text{ near } 1, \qquad M' = g^T M g
//! ```
//!
//! The discrete Lagrangian is `tr(g J)` up to sign and factor. Integrable like the body itself: order 2,
//! symmetric, a Poisson map; keeps every Casimir, the coadjoint orbit and the energy.
//!
//! * n = 3, any quadratic form H, since the equation is the same in all axes (`$I_k = J_i + J_j$` in those of the moments): the rotation as a unit
//!   quaternion, `h mu = 2 (q0 I v + v x I v)`, `q0 = sqrt(1 - v.v)`; see [`DiscreteTop`](crate::generic::DiscreteTop).
//! * n >= 4: with the Cayley map `g = (1 + X/2)(1 - X/2)^-1` the equation becomes
//!   `X J + J X = h (1 - X/2) M (1 + X/2)`, polynomial in the n(n-1)/2 entries of X, instead of the Riccati
//!   equation of `(g J + J g^T)/2` with its n(n+1)/2; see [`DiscreteBody`](crate::generic::DiscreteBody).
//!
//! The equation has a solution near the identity only while `h |M|` is below the moments of inertia. A
//! step beyond fails with [`FailureReason::RotationTooLarge`], also where a rotation exists that is not on the
//! branch of the identity.
//!
//! Needs: that Hamiltonian ([`InertiaPoisson`](crate::InertiaPoisson), or so(3)).
//!
//! References: J. Moser, A. P. Veselov, "Discrete versions of some classical integrable systems and
//! factorization of matrix polynomials", Communications in Mathematical Physics 139 (1991) 217–243,
//! [doi:10.1007/BF02352494](https://doi.org/10.1007/BF02352494); E. Hairer, G. Vilmart, "Preprocessed
//! discrete Moser–Veselov algorithm for the full dynamics of a rigid body", Journal of Physics A 39 (2006)
//! 13225–13235, [doi:10.1088/0305-4470/39/42/006](https://doi.org/10.1088/0305-4470/39/42/006).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::facts::{Facts, Preserves};
use super::implicit::ImplicitStepper;
use super::stepper::{FactorSink, Method, StepFailure, StepReport, Stepper};
use crate::equation::{Equation, Implicit};
use crate::newton::{FailureReason, NewtonOptions};
use crate::scalar::{Mask, Scalar};
use crate::state::Unknown;

/// The discrete rigid body of Moser and Veselov, order 2; see the [module's text](self).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MoserVeselov;

impl Facts for MoserVeselov {
    const ID: &'static str = "moser-veselov";
    const ORDER: u32 = 2;
    const SYMMETRIC: bool = true;
    const EXPLICIT: bool = false;
    const PRESERVES: Preserves = Preserves {
        energy: true,
        ..Preserves::POISSON
    };
}

impl<S: Scalar, P: Implicit<S, Self>> Method<S, P> for MoserVeselov {
    type Stepper<'a>
        = MoserVeselovStepper<S, P::Equation<'a>>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, newton: &NewtonOptions) -> Self::Stepper<'a> {
        let inner = ImplicitStepper::new(system.equation(self, h), system.zero_state(), newton);
        MoserVeselovStepper { inner }
    }
}

/// Solves the equation of a step; where no rotation near the identity does, it says so.
pub struct MoserVeselovStepper<S: Scalar, E: Equation<S>> {
    inner: ImplicitStepper<S, E>,
}

impl<S: Scalar, E: Equation<S>> Stepper<S> for MoserVeselovStepper<S, E> {
    type State = E::State;

    fn carry(&mut self, visit: &mut dyn FnMut(&mut S)) -> bool {
        self.inner.carry(visit)
    }

    fn step<K: FactorSink<E::State>>(
        &mut self,
        mu: &mut E::State,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        let sound = mu.finite();
        self.inner.step(mu, sink).map_err(|mut failure| {
            let lane = failure.lanes.trailing_zeros() as usize;
            if lane < S::LANES && sound.lane(lane) {
                failure.reason = FailureReason::RotationTooLarge;
            }
            failure
        })
    }
}
