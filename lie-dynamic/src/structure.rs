//! The structure of a system that methods need: spins, a representation, a motion in closed form.

use crate::code::Code;
use crate::matrix::Matrix;
use crate::names;
use crate::system::{Dynamic, Making};
use lie_codegen::exact::Rational;
use lie_codegen::plan::{self, Plan};
use lie_codegen::structure::integrable::Motion;
use lie_core::structure::{Entry, Representation};
use lie_runtime::{IntegrablePoisson, MatrixPoisson, Scalar, Spectrum, SpinPoisson};

/// Tables, and codes of constants.
#[derive(Debug)]
pub struct Codes {
    spins: Vec<[usize; 3]>,
    scales: Vec<usize>,
    matrices: &'static [&'static [Entry]],
    dual: &'static [&'static [Entry]],
    skew: bool,
    size: usize,
    bounds: Option<Vec<f64>>,
    imaginary: bool,
    motion: Option<Motion>,
}

/// The nonzero entries of a matrix.
fn entries(matrix: &[Vec<Rational>]) -> Vec<Entry> {
    let mut list = Vec::new();
    for (row, values) in matrix.iter().enumerate() {
        for (column, value) in values
            .iter()
            .enumerate()
            .filter(|(_, value)| !value.is_zero())
        {
            let high = value.to_f64();
            let low = Rational::from_f64(high).map_or(0.0, |high| (value - &high).to_f64());
            list.push(Entry::parts(row as u16, column as u16, high, low));
        }
    }
    list
}

impl Codes {
    pub(crate) fn new(plan: &Plan, making: &mut Making) -> Self {
        let structure = &plan.structure;
        let spins = structure.spins.as_ref();
        let scales = spins
            .map(|spins| spins.scales.as_slice())
            .unwrap_or_default();
        let representation = structure.representation.as_ref();
        let tables = |matrices: &[Vec<Vec<Rational>>]| {
            let all: Vec<Vec<Entry>> = matrices.iter().map(|matrix| entries(matrix)).collect();
            names::matrices(&all)
        };
        let spectrum = representation.map(|representation| &representation.spectrum);
        Self {
            spins: spins
                .map(|spins| spins.coordinates.clone())
                .unwrap_or_default(),
            scales: scales
                .iter()
                .map(|scale| making.push(Code::of_program(scale)))
                .collect(),
            matrices: representation.map_or(&[], |known| tables(&known.matrices)),
            dual: representation.map_or(&[], |known| tables(&known.dual)),
            skew: representation.is_some_and(|known| known.skew),
            size: representation.map_or(0, |known| known.size),
            bounds: match spectrum {
                Some(plan::Spectrum::Bounded(weights)) => {
                    Some(weights.iter().map(Rational::to_f64).collect())
                }
                _ => None,
            },
            imaginary: matches!(spectrum, Some(plan::Spectrum::Imaginary)),
            motion: structure.motion,
        }
    }

    /// What is known of the eigenvalues of the representation.
    pub fn spectrum(&self) -> Spectrum<'_> {
        match &self.bounds {
            Some(weights) => Spectrum::Bounded(weights),
            None if self.imaginary => Spectrum::Imaginary,
            None => Spectrum::Unknown,
        }
    }
}

impl<S: Scalar> SpinPoisson<S> for Dynamic<S> {
    type Spinors = Vec<S>;

    fn spins(&self) -> &[[usize; 3]] {
        &self.compiled.structure.spins
    }
    fn scale(&self, spin: usize) -> S {
        self.value(self.compiled.structure.scales[spin])
    }
    fn zero_spinors(&self) -> Vec<S> {
        vec![S::zero(); 4 * self.compiled.structure.spins.len()]
    }
}

impl<S: Scalar> MatrixPoisson<S> for Dynamic<S> {
    type Matrix = Matrix<S>;

    fn representation(&self) -> Representation<'_> {
        let structure = &self.compiled.structure;
        Representation {
            matrices: structure.matrices,
            dual: structure.dual,
            skew: structure.skew,
        }
    }
    fn spectrum(&self) -> Spectrum<'_> {
        self.compiled.structure.spectrum()
    }
    fn zero_matrix(&self) -> Matrix<S> {
        Matrix::zero(self.compiled.structure.size)
    }
}

impl<S: Scalar> IntegrablePoisson<S> for Dynamic<S> {
    fn motion(&self) -> lie_core::Motion {
        match self.compiled.structure.motion {
            Some(Motion::Bodies) => lie_core::Motion::Bodies,
            _ => lie_core::Motion::Uniform,
        }
    }
    fn bodies(&self) -> &[[usize; 3]] {
        match self.compiled.structure.motion {
            Some(Motion::Bodies) => self.spins(),
            _ => &[],
        }
    }
    fn body_scale(&self, body: usize) -> S {
        match self.compiled.structure.motion {
            Some(Motion::Bodies) => self.scale(body),
            _ => S::one(),
        }
    }
}
