//! The path of a step in phase space: what its equations leave, over some scalar.

use super::body_velocity::BodyVelocity;
use super::node_path::Node;
use crate::generic::series::{Scratch, coadjoint_action_in, dexp_dual_in};
use crate::generic::tableau::{Tableau, gauss_tableau};
use crate::scalar::Scalar;
use crate::state::{State, copies};
use crate::structure::CotangentPoisson;

/// The path `exp(theta(t/h))` of a step with the momenta at its nodes, see [`super::GalerkinOnGroup`].
pub struct PhasePath<S, V, const STAGES: usize> {
    step: S,
    pub(super) tableau: Tableau<S, STAGES>,
    pub(super) nodes: [Node<V>; STAGES],
    /// The state from which the step starts, and then with what the forces of all nodes bring there.
    pushed: V,
    /// `theta(1)`
    end: V,
    body: BodyVelocity<S, V>,
    scratch: Scratch<V>,
    columns: [V; 4],
}

impl<S: Scalar, V: State<S>, const STAGES: usize> PhasePath<S, V, STAGES> {
    pub(super) fn new(zero: &V, h: S) -> Self {
        Self {
            step: h,
            tableau: gauss_tableau(),
            nodes: core::array::from_fn(|_| Node::new(zero)),
            pushed: zero.clone(),
            end: zero.clone(),
            body: BodyVelocity::new(zero),
            scratch: Scratch::new(zero),
            columns: copies(zero),
        }
    }

    /// Sets what is left of the equations of all nodes, for their rates and momenta.
    pub(super) fn set<P>(&mut self, system: &P, base: &V)
    where
        P: CotangentPoisson<S, State = V>,
    {
        self.set_end(system, base);
        let [sum, ..] = &mut self.columns;
        if system.has_closed_exponential() {
            system.dexp_dual(&self.end, &self.pushed, sum);
        } else {
            let scratch = &mut self.scratch;
            dexp_dual_in(system, &self.end, &self.pushed, sum, scratch, |_, _| ());
        }
        for i in 0..STAGES {
            // what changes from the node to the end
            let one = S::one();
            let [sum, total, ..] = &mut self.columns;
            total.fill(S::zero());
            total.axpy(-one, sum);
            let weights = self.tableau.b.iter().zip(&self.tableau.ratios[i]);
            for ((&b, &ratio), node) in weights.zip(&self.nodes) {
                total.axpy(b * (one - ratio), &node.change);
            }
            self.nodes[i].of_momentum.axpy(one, total);
        }
    }

    /// Sets the end of the path and what the forces bring to its beginning, so that the new state is the action of the one on the
    /// other; of the equations all but what one node has of another.
    fn set_end<P>(&mut self, system: &P, base: &V)
    where
        P: CotangentPoisson<S, State = V>,
    {
        self.pushed.copy_from(base);
        self.end.fill(S::zero());
        for i in 0..STAGES {
            self.end.axpy(self.tableau.b[i], &self.nodes[i].rate);
            let [point, ..] = &mut self.columns;
            point.fill(S::zero());
            for j in 0..STAGES {
                let weight = self.tableau.b[j] * self.tableau.ratios[i][j];
                point.axpy(weight, &self.nodes[j].rate);
            }
            self.nodes[i].point.copy_from(point);
            self.set_node(system, i, base);
        }
    }

    fn set_node<P>(&mut self, system: &P, i: usize, base: &V)
    where
        P: CotangentPoisson<S, State = V>,
    {
        let momenta = system.momenta();
        let node = &mut self.nodes[i];
        let [back, at, generator, force] = &mut self.columns;
        coadjoint_action_in(system, &node.point, base, at, &mut self.scratch);
        at.as_mut_slice()[..momenta].copy_from_slice(&node.momentum.as_slice()[..momenta]);
        system.generator(at, generator);
        self.body.set(system, &node.point, &node.rate);
        self.body.pull(system, &node.point, &node.momentum);
        for index in 0..momenta {
            let rest = self.body.xi.as_slice()[index] - self.step * generator.as_slice()[index];
            node.of_rate.as_mut_slice()[index] = rest;
            // what remains of the generator moves the momenta alone
            generator.as_mut_slice()[index] = S::zero();
        }
        node.of_momentum.copy_from(&self.body.adjoint);
        system.ad_star(generator, at, force);
        if system.is_forced() {
            system.force(at, generator);
            force.axpy(S::one(), generator);
        }
        force.as_mut_slice()[momenta..].fill(S::zero());
        for (out, &entry) in back.as_mut_slice().iter_mut().zip(node.point.as_slice()) {
            *out = -entry;
        }
        let (carried, scratch) = (at, &mut self.scratch);
        coadjoint_action_in(system, back, force, carried, scratch);
        self.pushed.axpy(self.step * self.tableau.b[i], carried);
        if system.has_closed_exponential() {
            system.dexp_dual(back, force, carried);
        } else {
            dexp_dual_in(system, back, force, carried, scratch, |_, _| ());
        }
        node.change.copy_from(&self.body.slope);
        node.change.axpy(self.step, carried);
    }

    /// Sets the new state.
    pub(super) fn move_to_end<P>(&mut self, system: &P, base: &V, mu: &mut V)
    where
        P: CotangentPoisson<S, State = V>,
    {
        self.set_end(system, base);
        coadjoint_action_in(system, &self.end, &self.pushed, mu, &mut self.scratch);
    }
}
