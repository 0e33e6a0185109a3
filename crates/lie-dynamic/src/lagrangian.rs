//! Systems by a Lagrangian or a discrete Lagrangian, and their methods.

use crate::compiled::Place;
use crate::kernels::ARGUMENTS;
use crate::methods::{Method, boxed};
use crate::system::Dynamic;
use crate::traits::there;
use lie_codegen::methods::{Choice, Retraction};
use lie_codegen::plan::Energy;
use lie_core::family::LateMatrix;
use lie_core::generic_equations;
use lie_runtime::methods as m;
use lie_runtime::{DiscreteLagrangianPoisson, LagrangianPoisson, Scalar};

generic_equations!([S: Scalar] Dynamic<S>, S: variational, variational_cayley, discrete, discrete_cayley);

/// The method of a choice, if it needs a Lagrangian.
pub(crate) fn method<S: Scalar>(choice: &Choice) -> Option<Method<S>> {
    match choice {
        Choice::Variational(2, Retraction::Exp) => boxed(m::Variational2::exp()),
        Choice::Variational(2, Retraction::Cayley) => boxed(m::Variational2::cayley()),
        Choice::Variational(4, _) => boxed(m::Variational4::exp()),
        Choice::Variational(6, _) => boxed(m::Variational6::exp()),
        Choice::DiscreteEulerPoincare(Retraction::Exp) => boxed(m::DiscreteEulerPoincare::exp()),
        Choice::DiscreteEulerPoincare(Retraction::Cayley) => {
            boxed(m::DiscreteEulerPoincare::cayley())
        }
        _ => None,
    }
}

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
        self.values.run(there(place), &frame, [vector, matrix]);
    }
}

impl<S: Scalar> LagrangianPoisson<S> for Dynamic<S> {
    fn lagrangian(&self, xi: &Vec<S>) -> S {
        let [code, ..] = self.values.kernels().lagrangian;
        let mut value = [S::zero()];
        self.values
            .call(there(code), [xi, &[]], &mut value, &mut []);
        value[0]
    }
    fn momentum(&self, xi: &Vec<S>, out: &mut Vec<S>) {
        let [_, code, _] = self.values.kernels().lagrangian;
        self.values.call(there(code), [xi, &[]], out, &mut []);
    }
    fn inertia(&self, xi: &Vec<S>, out: &mut LateMatrix<S>) {
        let [.., code] = self.values.kernels().lagrangian;
        self.values
            .call(there(code), [xi, &[]], &mut [], out.as_mut_slice());
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
