//! What methods of the algebra ask of a system, and its forms over other scalars.

use crate::system::Dynamic;
use crate::system::answers::{Families as _, by_loops, require};
use lie_core::family::LateMatrix;
use lie_core::generic;
use lie_core::generic::{StageProgram, StageSlopes};
use lie_runtime::scalar::Truncated;
use lie_runtime::{CayleyPoisson, Dual, Expand, LiePoisson, Lift, Scalar, Spectrum, Widen};

impl<S: Scalar> LiePoisson<S> for Dynamic<S> {
    fn ad(&self, xi: &Vec<S>, eta: &Vec<S>, out: &mut Vec<S>) {
        by_loops!(self.ad(xi, eta, out));
        match self.values.kernels().ad {
            Some(code) => self.values.call(code, [xi, eta], out, &mut []),
            None => generic::ad(self, xi, eta, out),
        }
    }
    fn ad_star(&self, xi: &Vec<S>, mu: &Vec<S>, out: &mut Vec<S>) {
        by_loops!(self.ad_star(xi, mu, out));
        match self.values.kernels().ad_star {
            Some(code) => self.values.call(code, [xi, mu], out, &mut []),
            None => generic::ad_star(self, xi, mu, out),
        }
    }
    fn ad_star_matrix(&self, xi: &Vec<S>, out: &mut LateMatrix<S>) {
        by_loops!(self.ad_star_matrix(xi, out));
        match self.values.kernels().ad_star_matrix {
            Some(code) => self.values.matrix(code, [xi, &[]], out),
            None => generic::ad_star_matrix(self, xi, out),
        }
    }
    fn has_closed_exponential(&self) -> bool {
        !self.values.compiled.plan.system.exponential.is_empty()
    }
    fn has_closed_slope(&self) -> bool {
        self.values.kernels().dexp_dual_slope.is_some()
    }
    fn coadjoint_action(&self, xi: &Vec<S>, mu: &Vec<S>, out: &mut Vec<S>) {
        match self.values.kernels().coadjoint_action {
            Some(code) => self.values.call(code, [xi, mu], out, &mut []),
            None => generic::coadjoint_action(self, xi, mu, out),
        }
    }
    fn dexp_dual(&self, xi: &Vec<S>, mu: &Vec<S>, out: &mut Vec<S>) {
        match self.values.kernels().dexp_dual {
            Some(code) => self.values.call(code, [xi, mu], out, &mut []),
            None => generic::dexp_dual(self, xi, mu, out),
        }
    }
    fn dexp_dual_slope(
        &self,
        xi: &Vec<S>,
        mu: &Vec<S>,
        out: &mut Vec<S>,
        slope: &mut LateMatrix<S>,
    ) {
        match self.values.kernels().dexp_dual_slope {
            Some(code) => self.values.call(code, [xi, mu], out, slope.as_mut_slice()),
            None => generic::dexp_dual_slope(self, xi, mu, out, slope),
        }
    }
}

impl<S: Scalar> CayleyPoisson<S> for Dynamic<S> {
    fn spectrum(&self) -> Spectrum<'_> {
        self.values.compiled.structure.spectrum()
    }
    fn triple(&self, x: &Vec<S>, z: &Vec<S>, mu: &Vec<S>, out: &mut Vec<S>) {
        let frame = self.values.frame([x, z, mu, &[]], &[], &[]);
        self.values.machine.run(
            require(self.values.kernels().triple),
            &frame,
            [out, &mut []],
        );
    }
}

impl<S: Scalar> Lift<S> for Dynamic<S> {
    type Lifted = Dynamic<Dual<S>>;
    fn lift(&self) -> Self::Lifted {
        self.with_scalar(Dual::constant_of, self.values.interpreter())
    }
}

impl<S: Scalar> Widen<S> for Dynamic<S> {
    type Widened = Dynamic<S::Wide>;
    fn widen(&self) -> Self::Widened {
        let machine = self.values.machine.wide();
        let machine = machine.unwrap_or_else(|| self.values.interpreter());
        self.with_scalar(S::widen, machine)
    }
    fn stage_program(
        &self,
        slopes: StageSlopes,
        stages: usize,
    ) -> Option<Box<dyn StageProgram<S::Wide>>> {
        self.stages(slopes, stages)
    }
}

impl<S: Scalar> Expand<S> for Dynamic<S> {
    type Expanded = Dynamic<Truncated<S>>;
    fn expand(&self) -> Self::Expanded {
        self.with_scalar(Truncated::constant_of, self.values.interpreter())
    }
}
