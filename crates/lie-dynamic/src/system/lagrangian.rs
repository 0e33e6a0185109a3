//! Systems by a Lagrangian or a discrete Lagrangian.

use crate::compiled::Place;
use crate::engine::ARGUMENTS;
use crate::system::Dynamic;
use crate::system::answers::require;
use lie_codegen::plan::Energy;
use lie_core::family::LateMatrix;
use lie_runtime::{DiscreteLagrangianPoisson, LagrangianPoisson, Poisson, Scalar};

impl<S: Scalar> Dynamic<S> {
    /// Whether H is a Legendre transform by Newton's iteration.
    pub(crate) fn is_by_legendre(&self) -> bool {
        self.plan().system.energy == Energy::Legendre
    }

    /// Runs a kernel of a discrete Lagrangian for a step of size h.
    fn discrete(&self, place: Place, h: S, x: &[S], vector: &mut [S], matrix: &mut [S]) {
        let mut arguments: [&[S]; ARGUMENTS] = [&[]; ARGUMENTS];
        arguments[0] = x;
        let scalars = [h];
        let frame = self.values.frame(arguments, &[], &scalars);
        self.values.run(require(place), &frame, [vector, matrix]);
    }
}

impl<S: Scalar> LagrangianPoisson<S> for Dynamic<S> {
    fn lagrangian(&self, xi: &Vec<S>) -> S {
        let [code, ..] = self.values.kernels().lagrangian;
        self.values.number(require(code), [xi, &[]])
    }
    fn momentum(&self, xi: &Vec<S>, out: &mut Vec<S>) {
        let [_, code, _] = self.values.kernels().lagrangian;
        self.values.call(require(code), [xi, &[]], out, &mut []);
    }
    fn inertia(&self, xi: &Vec<S>, out: &mut LateMatrix<S>) {
        let [.., code] = self.values.kernels().lagrangian;
        self.values.matrix(require(code), [xi, &[]], out);
    }
    fn velocities(&self) -> usize {
        let dimension = Poisson::<S>::dimension(self);
        self.plan().system.velocities.unwrap_or(dimension)
    }
    fn branch(&self) -> Option<Vec<S>> {
        self.branch.clone()
    }
}

impl<S: Scalar> DiscreteLagrangianPoisson<S> for Dynamic<S> {
    fn discrete_lagrangian(&self, h: S, x: &Vec<S>) -> S {
        let mut value = [S::zero()];
        self.discrete(self.values.kernels().discrete[0], h, x, &mut value, &mut []);
        value[0]
    }
    fn discrete_slope(&self, h: S, x: &Vec<S>, out: &mut Vec<S>) {
        self.discrete(self.values.kernels().discrete[1], h, x, out, &mut []);
    }
    fn discrete_curvature(&self, h: S, x: &Vec<S>, out: &mut LateMatrix<S>) {
        let matrix = out.as_mut_slice();
        self.discrete(self.values.kernels().discrete[2], h, x, &mut [], matrix);
    }
}
