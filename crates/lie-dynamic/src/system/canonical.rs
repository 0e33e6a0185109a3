//! Coordinates in which the bracket is constant.

use crate::compiled::CodeBuilder;
use crate::system::Dynamic;
use lie_codegen::plan::Structure;
use lie_runtime::{CanonicalPoisson, Scalar};

/// The codes of the coordinates: of themselves, their sides, what moves them, the field in them and its derivative.
#[derive(Debug)]
pub struct Codes([usize; 5]);

impl Codes {
    /// Of the kernels of a plan, in their order; none where there are none.
    pub(crate) fn new(plan: &Structure, making: &mut CodeBuilder) -> Option<Self> {
        let [value, sides, pull, field, jacobian] = &plan.canonical[..] else {
            return None;
        };
        let kernels = [value, sides, pull, field, jacobian];
        Some(Self(kernels.map(|kernel| making.kernel(kernel))))
    }
}

impl<S: Scalar> Dynamic<S> {
    fn canonical_code(&self, place: usize) -> usize {
        match &self.values.compiled.canonical {
            Some(codes) => codes.0[place],
            None => panic!("no coordinates are known in which the bracket is constant"),
        }
    }
}

impl<S: Scalar> CanonicalPoisson<S> for Dynamic<S> {
    fn canonical(&self, mu: &Vec<S>, out: &mut Vec<S>) {
        let code = self.canonical_code(0);
        self.values.call(code, [mu, &[]], out, &mut []);
    }
    fn canonical_sides(&self, mu: &Vec<S>, xi: &Vec<S>, out: &mut Vec<S>) {
        let code = self.canonical_code(1);
        self.values.call(code, [mu, xi], out, &mut []);
    }
    fn canonical_pull(&self, mu: &Vec<S>, xi: &Vec<S>, out: &mut Vec<S>) {
        let code = self.canonical_code(2);
        self.values.call(code, [mu, xi], out, &mut []);
    }
    fn canonical_field(&self, mu: &Vec<S>, out: &mut Vec<S>) {
        let code = self.canonical_code(3);
        self.values.call(code, [mu, &[]], out, &mut []);
    }
    fn canonical_jacobian(&self, mu: &Vec<S>, out: &mut Self::Jacobian) {
        let code = self.canonical_code(4);
        self.values.matrix(code, [mu, &[]], out);
    }
}
