//! The traits of the numeric core, by the kernels of the plan.

use crate::system::Dynamic;
use crate::system::answers::{Families as _, by_family, by_loops, require, without_loops};
use lie_core::family::LateMatrix;
use lie_core::lattice::AXES;
use lie_core::{Clock, EventRule, generic, lagrangian::legendre};
use lie_runtime::{Dual, Poisson, Scalar};
use std::ops::Range;

impl<S: Scalar> Poisson<S> for Dynamic<S> {
    type State = Vec<S>;
    type Jacobian = LateMatrix<S>;

    fn dimension(&self) -> usize {
        by_family!(self.dimension());
        self.values.compiled.plan.dimension()
    }
    fn name(&self) -> &str {
        &self.values.compiled.plan.names.system
    }
    fn coordinate(&self, index: usize) -> &str {
        by_family!(self.coordinate(index));
        &self.values.compiled.plan.names.coordinates[index]
    }
    fn sites(&self) -> Option<[usize; AXES]> {
        self.sizes()
    }
    fn casimir_count(&self) -> usize {
        by_family!(self.casimir_count());
        self.values.compiled.plan.system.casimirs.len()
    }
    fn casimir_name(&self, index: usize) -> &str {
        by_family!(self.casimir_name(index));
        &self.values.compiled.plan.system.casimirs[index].name
    }
    fn hamiltonian_degree(&self) -> Option<u32> {
        self.values.compiled.plan.system.hamiltonian_degree
    }
    fn casimir_degree(&self, index: usize) -> Option<u32> {
        by_family!(self.casimir_degree(index));
        self.values.compiled.casimir_degrees[index]
    }
    fn casimir_is_multivalued(&self, index: usize) -> bool {
        let casimir = self.plan().system.casimirs.get(index);
        casimir.is_some_and(|casimir| casimir.multivalued)
    }
    fn casimir_is_kept(&self, index: usize) -> bool {
        by_family!(self.casimir_is_kept(index));
        let casimir = self.plan().system.casimirs.get(index);
        casimir.is_none_or(|casimir| casimir.kept)
    }
    fn poisson_degree(&self) -> Option<u32> {
        self.values.compiled.plan.system.poisson_degree
    }
    fn clock(&self) -> Option<Clock> {
        by_family!(self.clock());
        self.values.compiled.plan.system.clock
    }
    fn following(&self, mu: &Vec<S>) -> Option<Self> {
        if S::LOOPS && self.is_by_legendre() {
            return self.on_branch(&legendre::follow(self, mu)?);
        }
        None
    }
    fn on_branch(&self, gradient: &Vec<S>) -> Option<Self> {
        let mut following = self.clone();
        following.branch = self.is_by_legendre().then(|| gradient.clone());
        following.branch.is_some().then_some(following)
    }
    fn vector_field_by_parts(
        &self,
        mu: &mut Vec<S>,
        out: &mut Vec<S>,
        mut before: impl FnMut(&mut [S], Range<usize>),
        mut after: impl FnMut(&mut [S], Range<usize>),
    ) {
        by_loops!(self.vector_field_by_parts(mu, out, before, after));
        let all = 0..mu.len();
        before(mu, all.clone());
        self.vector_field(mu, out);
        after(out, all);
    }
    fn has_jacobian(&self) -> bool {
        self.family.is_none()
    }
    fn zero_state(&self) -> Vec<S> {
        vec![S::zero(); Poisson::<S>::dimension(self)]
    }
    fn zero_jacobian(&self) -> LateMatrix<S> {
        LateMatrix::new(Poisson::<S>::dimension(self))
    }
    fn hamiltonian(&self, mu: &Vec<S>) -> S {
        by_loops!(self.hamiltonian(mu));
        let Some(code) = self.values.kernels().hamiltonian else {
            return match S::LOOPS {
                true => legendre::hamiltonian(self, mu),
                false => without_loops(),
            };
        };
        self.values.number(code, [mu, &[]])
    }
    fn energy(&self, mu: &Vec<S>) -> S {
        by_loops!(self.energy(mu));
        let Some(energy) = self.values.kernels().energy else {
            return match self.clock().filter(|_| self.is_by_legendre()) {
                Some(clock) => {
                    let mut mu = mu.clone();
                    mu[clock.momentum] = S::zero();
                    self.hamiltonian(&mu)
                }
                None => self.hamiltonian(mu),
            };
        };
        self.values.number(energy, [mu, &[]])
    }
    fn gradient(&self, mu: &Vec<S>, out: &mut Vec<S>) {
        by_loops!(self.gradient(mu, out));
        match self.values.kernels().gradient {
            Some(code) => self.values.call(code, [mu, &[]], out, &mut []),
            None if S::LOOPS => legendre::gradient(self, mu, out),
            None => without_loops(),
        }
    }
    fn hessian(&self, mu: &Vec<S>, out: &mut LateMatrix<S>) {
        by_loops!(self.hessian(mu, out));
        match self.values.kernels().hessian {
            Some(code) => self.values.matrix(code, [mu, &[]], out),
            None if S::LOOPS && self.is_by_legendre() => legendre::hessian(self, mu, out),
            None => generic::hessian_by_duals(self, mu, out),
        }
    }
    fn poisson_matrix(&self, mu: &Vec<S>, out: &mut LateMatrix<S>) {
        by_loops!(self.poisson_matrix(mu, out));
        let code = require(self.values.kernels().poisson_matrix);
        self.values.matrix(code, [mu, &[]], out);
    }
    fn poisson_slope(&self, mu: &Vec<S>, xi: &Vec<S>, out: &mut LateMatrix<S>) {
        match self.values.kernels().poisson_slope {
            Some(code) => self.values.matrix(code, [mu, xi], out),
            None => generic::poisson_slope(self, xi, out),
        }
    }
    fn input_count(&self) -> usize {
        self.values.compiled.plan.system.inputs.len()
    }
    fn input_sampling(&self, index: usize) -> Option<f64> {
        self.values.compiled.plan.system.inputs[index].map(f64::from_bits)
    }
    fn noise_count(&self) -> usize {
        by_family!(self.noise_count());
        self.values.compiled.plan.system.noises
    }
    fn tosses_coin(&self) -> bool {
        self.family.is_none() && self.values.compiled.plan.system.noises > 1
    }
    fn is_almost_poisson(&self) -> bool {
        self.values.compiled.plan.system.almost_poisson
    }
    fn is_forced(&self) -> bool {
        by_family!(self.is_forced());
        self.values.compiled.plan.system.forced
    }
    fn force_mixes(&self) -> bool {
        self.values.compiled.plan.system.force_mixes
    }
    fn force(&self, mu: &Vec<S>, out: &mut Vec<S>) {
        match self.values.kernels().driving[0] {
            Some(code) => self.values.call(code, [mu, &[]], out, &mut []),
            None => out.fill(S::zero()),
        }
    }
    fn force_slope(&self, mu: &Vec<S>, out: &mut LateMatrix<S>) {
        match self.values.kernels().driving[1] {
            Some(code) => self.values.matrix(code, [mu, &[]], out),
            None => out.as_mut_slice().fill(S::zero()),
        }
    }
    fn is_damped(&self) -> bool {
        by_family!(self.is_damped());
        self.values.compiled.plan.system.damped
    }
    fn damping(&self, mu: &Vec<S>, v: &Vec<S>, out: &mut Vec<S>) {
        match self.values.kernels().driving[4] {
            Some(code) => self.values.call(code, [mu, v], out, &mut []),
            None => out.fill(S::zero()),
        }
    }
    fn generator(&self, mu: &Vec<S>, out: &mut Vec<S>) {
        match self.values.kernels().driving[2] {
            Some(code) => self.values.call(code, [mu, &[]], out, &mut []),
            None => self.gradient(mu, out),
        }
    }
    fn generator_slope(&self, mu: &Vec<S>, out: &mut LateMatrix<S>) {
        match self.values.kernels().driving[3] {
            Some(code) => self.values.matrix(code, [mu, &[]], out),
            None => self.hessian(mu, out),
        }
    }
    fn is_autonomous(&self) -> bool {
        self.values.compiled.plan.system.autonomous
    }
    fn is_metriplectic(&self) -> bool {
        self.values.compiled.plan.system.entropy.is_some()
    }
    fn entropy(&self, mu: &Vec<S>) -> S {
        let code = require(self.values.kernels().metriplectic[0]);
        self.values.number(code, [mu, &[]])
    }
    fn entropy_degree(&self) -> Option<u32> {
        self.values.compiled.plan.system.entropy?.degree
    }
    fn entropy_gradient(&self, mu: &Vec<S>, out: &mut Vec<S>) {
        let code = require(self.values.kernels().metriplectic[1]);
        self.values.call(code, [mu, &[]], out, &mut []);
    }
    fn entropy_hessian(&self, mu: &Vec<S>, out: &mut LateMatrix<S>) {
        let code = require(self.values.kernels().metriplectic[2]);
        self.values.matrix(code, [mu, &[]], out);
    }
    fn metric(&self, mu: &Vec<S>, out: &mut LateMatrix<S>) {
        let code = require(self.values.kernels().metriplectic[3]);
        self.values.matrix(code, [mu, &[]], out);
    }
    fn metric_slope(&self, mu: &Vec<S>, v: &Vec<S>, out: &mut LateMatrix<S>) {
        let code = require(self.values.kernels().metriplectic[4]);
        self.values.matrix(code, [mu, v], out);
    }
    fn vector_field(&self, mu: &Vec<S>, out: &mut Vec<S>) {
        by_loops!(self.vector_field(mu, out));
        match self.values.kernels().vector_field {
            Some(code) => self.values.call(code, [mu, &[]], out, &mut []),
            None => generic::vector_field(self, mu, out),
        }
    }
    fn jacobian(&self, mu: &Vec<S>, out: &mut LateMatrix<S>) {
        by_loops!(self.jacobian(mu, out));
        match self.values.kernels().jacobian {
            Some(code) => self.values.matrix(code, [mu, &[]], out),
            None if self.is_by_legendre() => generic::jacobian(self, mu, out),
            None => generic::jacobian_by_duals(self, mu, out),
        }
    }
    fn linearize(&self, mu: &Vec<S>, field: &mut Vec<S>, jacobian: &mut LateMatrix<S>) {
        match self.values.kernels().linearize {
            Some(code) => self
                .values
                .call(code, [mu, &[]], field, jacobian.as_mut_slice()),
            None => {
                self.vector_field(mu, field);
                self.jacobian(mu, jacobian);
            }
        }
    }
    fn joint_count(&self) -> usize {
        self.values.compiled.plan.system.joints
    }
    fn joints(&self, mu: &Vec<S>, out: &mut [S]) {
        if let Some(code) = self.values.kernels().joints {
            self.values.call(code, [mu, &[]], out, &mut []);
        }
    }
    fn quantity_count(&self) -> usize {
        by_family!(self.quantity_count());
        self.values.compiled.plan.system.quantities.len()
    }
    fn quantity_name(&self, index: usize) -> &str {
        by_family!(self.quantity_name(index));
        &self.values.compiled.plan.system.quantities[index].name
    }
    fn quantity_unwraps(&self, index: usize) -> bool {
        by_family!(self.quantity_unwraps(index));
        self.plan().system.quantities[index].unwrap
    }
    fn quantity_is_conserved(&self, index: usize) -> bool {
        let quantity = self.plan().system.quantities.get(index);
        quantity.is_some_and(|quantity| quantity.conserved)
    }
    fn quantities(&self, mu: &Vec<S>, out: &mut [S]) {
        by_loops!(self.quantities(mu, out));
        if let Some(code) = self.values.kernels().quantities {
            self.values.call(code, [mu, &[]], out, &mut []);
        }
    }
    fn event_count(&self) -> usize {
        self.plan().system.events.len()
    }
    fn event_name(&self, index: usize) -> &str {
        &self.values.compiled.plan.system.events[index].name
    }
    fn event_rule(&self, index: usize) -> EventRule {
        self.plan().system.events[index].rule
    }
    fn events(&self, mu: &Vec<S>, out: &mut [S]) {
        if let Some(code) = self.values.kernels().events {
            self.values.call(code, [mu, &[]], out, &mut []);
        }
    }
    fn casimirs(&self, mu: &Vec<S>, out: &mut [S]) {
        by_loops!(self.casimirs(mu, out));
        if let Some(code) = self.values.kernels().casimirs {
            self.values.call(code, [mu, &[]], out, &mut []);
        }
    }
    fn casimir_gradient(&self, index: usize, mu: &Vec<S>, out: &mut Vec<S>) {
        by_loops!(self.casimir_gradient(index, mu, out));
        match self.values.kernels().casimir_gradients[index] {
            Some(code) => self.values.call(code, [mu, &[]], out, &mut []),
            None => {
                let mut values =
                    vec![Dual::constant_of(S::zero()); Poisson::<S>::casimir_count(self)];
                generic::casimir_gradient_by_duals(self, index, mu, out, &mut values);
            }
        }
    }
}
