//! The implicit midpoint rule on a Poisson manifold.
//!
//! ```math
//! \mu_1 = \mu + h\, f\!\left(\tfrac12 (\mu + \mu_1)\right), \qquad f = \Pi\, \nabla H
//! ```
//!
//! Order 2, symmetric. Keeps every quadratic invariant of the equation, among them quadratic
//! Casimirs and a quadratic energy; Casimirs of higher degree and the Poisson structure are kept only
//! to O(h^2) per unit of time (the Poisson defect of a step is O(h^3)), unless Pi is constant: then each
//! step is a Poisson map, in canonical coordinates a symplectic one.
//!
//! Needs: the vector field and its Jacobian; any [`Poisson`] system.
//!
//! Reference: M. A. Austin, P. S. Krishnaprasad, L.-S. Wang, "Almost Poisson integration of rigid
//! body systems", Journal of Computational Physics 107 (1993) 105–117,
//! [doi:10.1006/jcph.1993.1128](https://doi.org/10.1006/jcph.1993.1128).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::facts::{Facts, Preserves};
use crate::equation::Equation;
use crate::generic::direction;
use crate::newton::dense;
use crate::poisson::Poisson;
use crate::scalar::Scalar;
use crate::state::State;

/// The implicit (Poisson) midpoint rule, order 2; see the [module's text](self).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ImplicitMidpoint;

impl Facts for ImplicitMidpoint {
    const ID: &'static str = "midpoint";
    const ORDER: u32 = 2;
    const SYMMETRIC: bool = true;
    const EXPLICIT: bool = false;
    const PRESERVES: Preserves = Preserves::QUADRATIC;
    const FORCES: bool = true;
    const DAMPING: bool = true;
}

by_equation!([] ImplicitMidpoint);

/// The implicit midpoint rule for any Poisson system.
///
/// Unknown: the new state u. Equation: `r(u) = u - mu - h f((mu + u)/2)`, with the state mu before
/// the step, the step size h and the vector field f. Jacobian: `1 - (h/2) Df((mu + u)/2)`.
/// Start: `mu + h f(mu)`.
#[derive(Debug)]
pub struct Midpoint<'a, S: Scalar, P: Poisson<S>> {
    system: &'a P,
    step: S,
    base: P::State,
    middle: P::State,
    field: P::State,
}

impl<'a, S: Scalar, P: Poisson<S>> Midpoint<'a, S, P> {
    /// The equation of a step of size h.
    pub fn new(system: &'a P, h: S) -> Self {
        let zero = system.zero_state();
        Self {
            system,
            step: h,
            base: zero.clone(),
            middle: zero.clone(),
            field: zero,
        }
    }

    fn set_middle(&mut self, unknown: &P::State) {
        let half = S::ratio(1.0, 2.0);
        let pairs = self.base.as_slice().iter().zip(unknown.as_slice());
        for (middle, (&mu, &u)) in self.middle.as_mut_slice().iter_mut().zip(pairs) {
            *middle = half * (mu + u).quantity();
        }
    }

    /// `r = u - mu - h f` with the field at the midpoint already computed.
    fn write_residual(&self, unknown: &P::State, residual: &mut P::State) {
        let (base, field) = (self.base.as_slice(), self.field.as_slice());
        for (index, out) in residual.as_mut_slice().iter_mut().enumerate() {
            *out = unknown.as_slice()[index] - base[index] - self.step * field[index];
        }
    }
}

impl<S: Scalar, P: Poisson<S>> Equation<S> for Midpoint<'_, S, P> {
    crate::generic::unknown_of_a_state!();

    fn set_base(&mut self, mu: &P::State) {
        self.base.copy_from(mu);
    }

    fn initial_guess(&mut self, unknown: &mut P::State) {
        self.system.vector_field(&self.base, &mut self.field);
        unknown.copy_from(&self.base);
        unknown.axpy(self.step, &self.field);
    }

    fn residual(&mut self, unknown: &P::State, residual: &mut P::State) {
        self.set_middle(unknown);
        self.system.vector_field(&self.middle, &mut self.field);
        self.write_residual(unknown, residual);
    }

    fn linearize(&mut self, unknown: &P::State, residual: &mut P::State, matrix: &mut P::Jacobian) {
        self.set_middle(unknown);
        self.system.linearize(&self.middle, &mut self.field, matrix);
        self.write_residual(unknown, residual);
        dense::identity_minus(self.step * S::ratio(1.0, 2.0), matrix);
    }

    fn velocity(&mut self, unknown: &P::State, _stage: usize, xi: &mut P::State) -> usize {
        self.set_middle(unknown);
        direction(self.system, self.step, &self.middle, xi);
        1
    }

    fn result(&mut self, unknown: &P::State, mu: &mut P::State) {
        mu.copy_from(unknown);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::newton::pivoted;
    use crate::test_systems::Spring;

    #[test]
    fn residual_vanishes_at_the_known_step() {
        // of q' = p, p' = -q with h = 2: ((1 - 1) q + 2 p)/2 = p, and -q
        let system = Spring;
        let mut equation = Midpoint::new(&system, 2.0);
        equation.set_base(&[3.0, 5.0].into());
        let mut residual = system.zero_state();
        equation.residual(&[5.0, -3.0].into(), &mut residual);
        assert_eq!(residual.as_slice(), [0.0, 0.0]);
        let mut matrix = system.zero_jacobian();
        let unknown = nalgebra::SVector::from([4.0, -3.0]);
        equation.linearize(&unknown, &mut residual, &mut matrix);
        assert!(pivoted::solve_lane::<f64, _, _>(
            &mut matrix,
            &mut residual,
            0
        ));
        assert_eq!((unknown - residual).as_slice(), [5.0, -3.0]);
    }
}
