//! A declared retraction: its tangents, and what its elements do.

use crate::code::Code;
use crate::compiled::CodeBuilder;
use crate::system::Dynamic;
use lie_codegen::plan::Structure;
use lie_runtime::{RetractedPoisson, Scalar};

/// The codes of a retraction.
#[derive(Debug)]
pub struct Codes {
    pullback: usize,
    slope: usize,
    action: usize,
    pub(super) element: usize,
}

impl Codes {
    /// Of the kernels of a plan, in their order; none where there are none.
    pub(crate) fn new(plan: &Structure, making: &mut CodeBuilder) -> Option<Self> {
        let [pullback, slope, action, element] = &plan.retraction[..] else {
            return None;
        };
        let size = plan.group.as_ref()?.size;
        Some(Self {
            pullback: making.kernel(pullback),
            slope: making.kernel(slope),
            action: making.kernel(action),
            element: making.push(Code::from_kernel(element, size * size)),
        })
    }
}

impl<S: Scalar> Dynamic<S> {
    pub(super) fn retraction(&self) -> &Codes {
        match &self.values.compiled.retraction {
            Some(codes) => codes,
            None => panic!("the system has no retraction of its own"),
        }
    }
}

impl<S: Scalar> RetractedPoisson<S> for Dynamic<S> {
    fn retraction_pullback(&self, x: &Vec<S>, mu: &Vec<S>, out: &mut Vec<S>) {
        let code = self.retraction().pullback;
        self.values.call(code, [x, mu], out, &mut []);
    }
    fn retraction_slope(&self, x: &Vec<S>, mu: &Vec<S>, out: &mut Self::Jacobian) {
        let code = self.retraction().slope;
        let out = out.as_mut_slice();
        self.values.call(code, [x, mu], &mut [], out);
    }
    fn retraction_action(&self, x: &Vec<S>, mu: &Vec<S>, out: &mut Vec<S>) {
        let code = self.retraction().action;
        self.values.call(code, [x, mu], out, &mut []);
    }
}
