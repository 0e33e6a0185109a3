//! What the equation of a step in phase space asks of its path.

use super::cayley_path::CayleyPath;
use super::phase_path::PhasePath;
use crate::methods::{Cayley, Exp, Retraction};
use crate::poisson::CayleyPoisson;
use crate::scalar::{Mask, Scalar};
use crate::state::State;
use crate::structure::CotangentPoisson;

/// What belongs to a node.
#[derive(Debug)]
pub struct Node<V> {
    /// `h theta'`, an element of the algebra of the group.
    pub(super) rate: V,
    /// The momentum m.
    pub(super) momentum: V,
    /// What is left of `dtau_(-theta) (h theta') = h xi`.
    pub(super) of_rate: V,
    /// What is left of the equation of the momentum.
    pub(super) of_momentum: V,
    /// theta
    pub(super) point: V,
    /// h times the derivative of `(dtau_(-theta))* m`, with the force on it.
    pub(super) change: V,
}

impl<V: Clone> Node<V> {
    pub(super) fn new(zero: &V) -> Self {
        Self {
            rate: zero.clone(),
            momentum: zero.clone(),
            of_rate: zero.clone(),
            of_momentum: zero.clone(),
            point: zero.clone(),
            change: zero.clone(),
        }
    }
}

/// The path of a step with rates and momenta at its nodes.
pub trait NodePath<S: Scalar, P: CotangentPoisson<S>, const STAGES: usize> {
    /// The path of a step of size h.
    fn new(system: &P, h: S) -> Self;
    /// The nodes.
    fn nodes(&self) -> &[Node<P::State>; STAGES];
    /// The nodes, whose rates and momenta are set before anything else is asked.
    fn nodes_mut(&mut self) -> &mut [Node<P::State>; STAGES];
    /// Sets what is left of the equations of all nodes, for a step from a state.
    fn set(&mut self, system: &P, base: &P::State);
    /// Sets the new state.
    fn move_to_end(&mut self, system: &P, base: &P::State, mu: &mut P::State);
    /// The element by which the step moves the group element before the last one.
    fn earlier_factor(&mut self, xi: &mut P::State) -> Option<Retraction>;
    /// The element by which the step moves the group element, the last one.
    fn factor(&mut self, xi: &mut P::State) -> Retraction;
    /// The lanes in which these elements are joined to the identity.
    fn within_chart(&mut self, system: &P) -> S::Mask;
}

/// A retraction along which there are paths.
pub trait Along<S: Scalar, P: CotangentPoisson<S>, const STAGES: usize> {
    /// They.
    type Path: NodePath<S, P, STAGES>;
}

impl<S: Scalar, P: CotangentPoisson<S>, const STAGES: usize> Along<S, P, STAGES> for Exp {
    type Path = PhasePath<S, P::State, STAGES>;
}

impl<S, P, const STAGES: usize> Along<S, P, STAGES> for Cayley
where
    S: Scalar,
    P: CotangentPoisson<S> + CayleyPoisson<S>,
{
    type Path = CayleyPath<S, P::State, P::Jacobian, STAGES>;
}

impl<S, P, const STAGES: usize> NodePath<S, P, STAGES> for PhasePath<S, P::State, STAGES>
where
    S: Scalar,
    P: CotangentPoisson<S>,
{
    fn new(system: &P, h: S) -> Self {
        Self::new(&system.zero_state(), h)
    }

    fn nodes(&self) -> &[Node<P::State>; STAGES] {
        &self.nodes
    }

    fn nodes_mut(&mut self) -> &mut [Node<P::State>; STAGES] {
        &mut self.nodes
    }

    fn set(&mut self, system: &P, base: &P::State) {
        self.set(system, base);
    }

    fn move_to_end(&mut self, system: &P, base: &P::State, mu: &mut P::State) {
        self.move_to_end(system, base, mu);
    }

    fn earlier_factor(&mut self, _xi: &mut P::State) -> Option<Retraction> {
        None
    }

    fn factor(&mut self, xi: &mut P::State) -> Retraction {
        xi.fill(S::zero());
        for (&b, node) in self.tableau.b.iter().zip(&self.nodes) {
            xi.axpy(b, &node.rate);
        }
        Retraction::Exp
    }

    fn within_chart(&mut self, _system: &P) -> S::Mask {
        S::Mask::splat(true)
    }
}
