//! Discrete gradient methods with a Poisson tensor other than the one at the midpoint.
//!
//! ```math
//! \mu_1 = \mu + h\, \tilde\Pi(\mu, \mu_1, h)\, \overline\nabla H(\mu, \mu_1), \qquad
//! \tilde\Pi^T = -\tilde\Pi, \quad \tilde\Pi(\mu, \mu, 0) = \Pi(\mu)
//! ```
//!
//! The energy is kept, because `$\langle \overline\nabla H, \mu_1 - \mu \rangle = H(\mu_1) - H(\mu)$` and the tensor is
//! antisymmetric. [`MidpointTensor`] and [`MeanTensor`] are here; for others implement [`PoissonTensor`]: a
//! tensor with terms of order `$h^2$` can raise the order of the method.
//!
//! Needs: H, its gradient and Hessian, the Poisson matrix and its derivative; any
//! [`Poisson`] system.
//!
//! References: R. I. McLachlan, G. R. W. Quispel, N. Robidoux, "Geometric integration using discrete
//! gradients", Philosophical Transactions of the Royal Society A 357 (1999) 1021–1045,
//! [doi:10.1098/rsta.1999.0363](https://doi.org/10.1098/rsta.1999.0363);
//! G. R. W. Quispel, D. I. McLaren, "A new class of energy-preserving numerical integration methods",
//! Journal of Physics A 41 (2008) 045206,
//! [doi:10.1088/1751-8113/41/4/045206](https://doi.org/10.1088/1751-8113/41/4/045206).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::facts::{Facts, Preserves};
use super::implicit::ImplicitStepper;
use super::stepper::Method;
use super::{Gonzalez, ItohAbe, MeanValue};
use crate::generic::{
    DiscreteGradient, DiscreteGradientStep, GonzalezGradient, ItohAbeGradient, MeanValueGradient,
};
use crate::newton::NewtonOptions;
use crate::poisson::Poisson;
use crate::scalar::Scalar;

pub use crate::generic::{MeanTensor, MidpointTensor, PoissonTensor, TensorFacts};

/// A method along a discrete gradient.
pub trait AlongGradient: Facts {
    /// The discrete gradient of a system.
    type Gradient<S: Scalar, P: Poisson<S>>: DiscreteGradient<S, P>;
}

impl AlongGradient for Gonzalez {
    type Gradient<S: Scalar, P: Poisson<S>> = GonzalezGradient<S, P>;
}

impl AlongGradient for MeanValue {
    type Gradient<S: Scalar, P: Poisson<S>> = MeanValueGradient<S, P>;
}

impl AlongGradient for ItohAbe {
    type Gradient<S: Scalar, P: Poisson<S>> = ItohAbeGradient<S, P>;
}

/// A discrete gradient method G with a tensor T; see the [module's text](self).
///
/// ```
/// use lie_core::methods::{MeanTensor, MeanValue, WithTensor};
/// let method = WithTensor::new(MeanValue::new(), MeanTensor);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WithTensor<G, T> {
    gradient: G,
    tensor: T,
}

impl<G: AlongGradient, T: TensorFacts> WithTensor<G, T> {
    /// The method of a discrete gradient, with a tensor.
    pub const fn new(gradient: G, tensor: T) -> Self {
        Self { gradient, tensor }
    }

    /// The method with its usual tensor.
    pub const fn gradient(&self) -> &G {
        &self.gradient
    }
}

impl<G: AlongGradient, T: TensorFacts> Facts for WithTensor<G, T> {
    const ID: &'static str = G::ID;
    const ORDER: u32 = T::ORDER;
    const SYMMETRIC: bool = G::SYMMETRIC && T::SYMMETRIC;
    const EXPLICIT: bool = false;
    const PRESERVES: Preserves = Preserves {
        quadratic_casimirs: T::QUADRATIC_CASIMIRS,
        ..Preserves::ENERGY
    };
    /// With a tensor of order 2 alone: force and damping are those at the midpoint.
    const FORCES: bool = T::ORDER <= 2;
    const DAMPING: bool = T::ORDER <= 2;
}

impl<S, P, G, T> Method<S, P> for WithTensor<G, T>
where
    S: Scalar,
    P: Poisson<S>,
    G: AlongGradient,
    T: PoissonTensor<S, P> + Clone,
{
    type Stepper<'a>
        = ImplicitStepper<S, DiscreteGradientStep<'a, S, P, G::Gradient<S, P>, T>>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, newton: &NewtonOptions) -> Self::Stepper<'a> {
        let equation = DiscreteGradientStep::with_tensor(system, self.tensor.clone(), h);
        ImplicitStepper::new(equation, system.zero_state(), newton)
    }
}
