//! Gauss collocation on mu' = f(mu).
//!
//! ```math
//! Y_i = \mu + h \sum_{j=1}^s a_{ij}\, f(Y_j), \qquad \mu_1 = \mu + h \sum_{i=1}^s b_i\, f(Y_i)
//! ```
//!
//! with the nodes of Gauss and Legendre: order 2s with s stages, symmetric, keeps every quadratic
//! invariant of the equation, and is a Poisson map where the Poisson matrix is constant. The unknowns are the increments `D_i = h f(Y_i)`, of which round-off is
//! relative to h f and not to mu.
//!
//! Needs: the vector field and its Jacobian; any [`Poisson`] system.
//!
//! Reference: E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration", 2nd edition,
//! Springer 2006, sections II.1.3 and IV.2,
//! [doi:10.1007/3-540-30666-8](https://doi.org/10.1007/3-540-30666-8).
//!
//! [`Poisson`]: crate::Poisson
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::facts::{Facts, Preserves};
use super::implicit::ImplicitStepper;
use super::stepper::Method;
use crate::equation::Implicit;
use crate::newton::NewtonOptions;
use crate::scalar::Scalar;

macro_rules! gauss {
    ($(#[$doc:meta])* $name:ident, $stages:literal, $id:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub struct $name;

        impl Facts for $name {
            const ID: &'static str = $id;
            const ORDER: u32 = 2 * $stages;
            const SYMMETRIC: bool = true;
            const EXPLICIT: bool = false;
            const PRESERVES: Preserves = Preserves::QUADRATIC;
        }

        impl<S: Scalar, P: Implicit<S, Self>> Method<S, P> for $name {
            type Stepper<'a>
                = ImplicitStepper<S, P::Equation<'a>>
            where
                P: 'a;

            fn stepper<'a>(
                &self,
                system: &'a P,
                h: S,
                newton: &NewtonOptions,
            ) -> Self::Stepper<'a> {
                ImplicitStepper::new(system.equation(self, h), system.zero_state(), newton)
            }
        }
    };
}

gauss!(
    /// Gauss collocation with two stages, order 4; see the [module's text](self).
    Gauss4, 2, "gauss4"
);
gauss!(
    /// Gauss collocation with three stages, order 6; see the [module's text](self).
    Gauss6, 3, "gauss6"
);
