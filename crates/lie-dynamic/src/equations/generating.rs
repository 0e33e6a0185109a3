//! Generating functions in code.

use crate::compiled::GeneratingCodes;
use crate::system::Dynamic;
use lie_core::family::LateMatrix;
use lie_core::generic;
use lie_runtime::{Dual, GeneratingFunction, Lift, Poisson, Scalar};

/// A generating function of a step: in code, or the generic one where the plan has none.
pub struct Planned<'a, S: Scalar, G> {
    system: &'a Dynamic<S>,
    suffix: &'static str,
    h: S,
    of_step: Vec<S>,
    generic: G,
}

impl<'a, S: Scalar, G> Planned<'a, S, G> {
    /// The function under the end of its type's name.
    pub fn new(system: &'a Dynamic<S>, suffix: &'static str, h: S, generic: G) -> Self {
        let codes = system.values.compiled.generating.get(suffix);
        let of_step = codes.map(|codes| system.values.step_constants(&codes.step, h));
        Self {
            system,
            suffix,
            h,
            of_step: of_step.unwrap_or_default(),
            generic,
        }
    }

    fn codes(&self) -> Option<&'a GeneratingCodes> {
        self.system.values.compiled.generating.get(self.suffix)
    }

    fn run(&self, code: usize, p: &[S], xi: &mut [S], hessian: &mut [S]) {
        let (values, scalars) = (&self.system.values, [self.h]);
        let frame = values.frame([p, &[], &[], &[]], &self.of_step, &scalars);
        values.run(code, &frame, [xi, hessian]);
    }
}

/// The gradient alone, over dual numbers.
struct Gradient<'a, S: Scalar> {
    system: &'a Dynamic<S>,
    code: usize,
    h: S,
    of_step: Vec<S>,
}

impl<S: Scalar> GeneratingFunction<S> for Gradient<'_, S> {
    type State = Vec<S>;
    type Jacobian = LateMatrix<S>;

    fn gradient(&mut self, p: &Vec<S>, xi: &mut Vec<S>) {
        let (values, scalars) = (&self.system.values, [self.h]);
        let frame = values.frame([p, &[], &[], &[]], &self.of_step, &scalars);
        values.run(self.code, &frame, [xi, &mut []]);
    }

    fn linearize(&mut self, _p: &Vec<S>, _xi: &mut Vec<S>, _hessian: &mut LateMatrix<S>) {
        unreachable!("only the gradient is asked for over dual numbers")
    }
}

impl<S, G> GeneratingFunction<S> for Planned<'_, S, G>
where
    S: Scalar,
    G: GeneratingFunction<S, State = Vec<S>, Jacobian = LateMatrix<S>>,
{
    type State = Vec<S>;
    type Jacobian = LateMatrix<S>;

    fn gradient(&mut self, p: &Vec<S>, xi: &mut Vec<S>) {
        match self.codes() {
            Some(codes) => self.run(codes.gradient, p, xi, &mut []),
            None => self.generic.gradient(p, xi),
        }
    }

    fn linearize(&mut self, p: &Vec<S>, xi: &mut Vec<S>, hessian: &mut LateMatrix<S>) {
        let Some(codes) = self.codes() else {
            return self.generic.linearize(p, xi, hessian);
        };
        if let Some(code) = codes.linearize {
            return self.run(code, p, xi, hessian.as_mut_slice());
        }
        let lifted = self.system.lift();
        let h = Dual::constant_of(self.h);
        let mut function = Gradient {
            system: &lifted,
            code: codes.gradient,
            h,
            of_step: lifted.values.step_constants(&codes.step, h),
        };
        let zero = lifted.zero_state();
        generic::linearize_by_duals(&mut function, &zero, p, xi, hessian);
    }
}
