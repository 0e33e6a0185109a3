//! A declared realization of the bracket: points, and the map from them to the state.

use crate::code::Code;
use crate::compiled::CodeBuilder;
use crate::system::Dynamic;
use lie_codegen::plan;
use lie_core::family::LateMatrix;
use lie_runtime::{ClosedRealization, RealizedPoisson, Scalar};

/// The codes of a realization.
#[derive(Debug)]
pub struct Codes {
    momentum_map: usize,
    pullback: usize,
    pushforward: usize,
    curvature: usize,
    start: Vec<usize>,
}

impl Codes {
    /// # Panics
    /// The plan of the realization lacks one of its kernels.
    pub(crate) fn new(realization: &plan::Realization, making: &mut CodeBuilder) -> Self {
        let points = realization.names.len();
        let mut code = |name: &str, of_points: bool| {
            let mut functions = realization.functions.iter();
            let Some(function) = functions.find(|function| function.name == name) else {
                panic!("a realization has the kernel `{name}`")
            };
            match of_points {
                true => making.push(Code::from_kernel(function, points)),
                false => making.kernel(function),
            }
        };
        Self {
            momentum_map: code("momentum_map", false),
            pullback: code("pullback", true),
            pushforward: code("pushforward", false),
            curvature: code("curvature", true),
            start: realization
                .start
                .iter()
                .map(|value| making.push(Code::from_program(value)))
                .collect(),
        }
    }
}

impl<S: Scalar> Dynamic<S> {
    fn realization(&self) -> (&plan::Realization, &Codes) {
        let declared = self.plan().structure.realization.as_ref();
        match declared.zip(self.values.compiled.realization.as_ref()) {
            Some(both) => both,
            None => panic!("the system has no realization"),
        }
    }
}

impl<S: Scalar> RealizedPoisson<S> for Dynamic<S> {
    type Point = Vec<S>;
    type PointMatrix = LateMatrix<S>;

    fn point_dimension(&self) -> usize {
        self.realization().0.names.len()
    }
    fn canonical_name(&self, index: usize) -> &str {
        &self.realization().0.names[index]
    }
    fn start_is_given(&self) -> bool {
        self.realization().0.given
    }
    fn zero_point(&self) -> Vec<S> {
        vec![S::zero(); self.point_dimension()]
    }
    fn zero_point_matrix(&self) -> LateMatrix<S> {
        LateMatrix::new(self.point_dimension())
    }
    fn momentum_map(&self, z: &Vec<S>, out: &mut Vec<S>) {
        let (_, codes) = self.realization();
        self.values.call(codes.momentum_map, [z, &[]], out, &mut []);
    }
    fn pullback(&self, z: &Vec<S>, xi: &Vec<S>, out: &mut Vec<S>) {
        let (_, codes) = self.realization();
        self.values.call(codes.pullback, [z, xi], out, &mut []);
    }
    fn pushforward(&self, z: &Vec<S>, v: &Vec<S>, out: &mut Vec<S>) {
        let (_, codes) = self.realization();
        self.values.call(codes.pushforward, [z, v], out, &mut []);
    }
    fn curvature(&self, z: &Vec<S>, xi: &Vec<S>, out: &mut LateMatrix<S>) {
        let (_, codes) = self.realization();
        self.values.matrix(codes.curvature, [z, xi], out);
    }
    fn start(&self, out: &mut Vec<S>) {
        let (_, codes) = self.realization();
        for (entry, code) in out.iter_mut().zip(&codes.start) {
            *entry = self.values.value(*code);
        }
    }
}

impl<S: Scalar> ClosedRealization<S> for Dynamic<S> {}
