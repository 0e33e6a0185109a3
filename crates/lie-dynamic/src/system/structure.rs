//! The structure of a system that methods need: spins, a representation, a motion in closed form.

use crate::code::Code;
use crate::compiled::CodeBuilder;
use crate::system::{Dynamic, names};
use lie_codegen::plan::{self, Function, Plan};
use lie_codegen::structure::integrable::Motion;
use lie_core::family::LateMatrix;
use lie_core::generic::{
    flow_over_columns, flow_over_factors, flow_over_quaternions, flow_over_spins,
};
use lie_core::structure::{Columns, Entry, Group, Plane, Representation};
use lie_runtime::{
    ColumnPoisson, CotangentPoisson, InertiaPoisson, IntegrablePoisson, MatrixGroup, MatrixPoisson,
    Scalar, Spectrum, SpinPoisson, UnitaryPoisson, VectorPoisson,
};
use lie_symbolic::exact::Rational;

/// Tables, and codes of constants.
#[derive(Debug)]
pub struct Codes {
    spins: Vec<[usize; 3]>,
    scales: Vec<usize>,
    matrices: &'static [&'static [Entry]],
    dual: &'static [&'static [Entry]],
    skew: bool,
    size: usize,
    column: usize,
    point: usize,
    bounds: Option<Vec<f64>>,
    imaginary: bool,
    motion: Option<Motion>,
    indices: Vec<u16>,
    covectors: &'static [&'static [Entry]],
    rotation: [usize; 3],
    vectors: Vec<[Entry; 3]>,
    scale: Option<usize>,
    planes: Vec<Plane>,
    moments: Vec<usize>,
    products: Vec<((usize, usize), usize)>,
    momenta: usize,
    group: Option<Group<'static>>,
    spinor_flow: Option<usize>,
    column_flow: Option<usize>,
    quaternion_flow: Option<usize>,
    degree: usize,
    factor: usize,
    unitary_flow: Option<usize>,
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
            list.push(entry(row, column, value));
        }
    }
    list
}

/// The components of a vector.
fn components(components: &[(usize, Rational); 3]) -> [Entry; 3] {
    components
        .each_ref()
        .map(|(k, factor)| entry(*k, 0, factor))
}

fn entry(row: usize, column: usize, value: &Rational) -> Entry {
    let high = value.to_f64();
    let low = Rational::from_f64(high).map_or(0.0, |high| (value - &high).to_f64());
    Entry::parts(row as u16, column as u16, high, low)
}

impl Codes {
    /// Whether the rigid body has four dimensions or more.
    pub fn is_body_of_many(&self) -> bool {
        !self.planes.is_empty()
    }

    pub(crate) fn new(plan: &Plan, making: &mut CodeBuilder) -> Self {
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
        let spectrum = structure.spectrum();
        let columns = representation.and_then(|known| known.columns.as_ref());
        let vectors = structure.vectors.as_ref();
        let inertia = structure.inertia.as_ref();
        let points = |count: usize, function: Option<&Function>, making: &mut CodeBuilder| {
            function.map(|function| making.push(Code::from_kernel(function, count)))
        };
        let of_columns = representation.map_or(0, |known| known.point);
        let flow = spins.and_then(|spins| spins.flow.as_ref());
        let spinor_flow = points(4 * scales.len(), flow, making);
        let flow = representation.and_then(|known| known.flow.as_ref());
        let column_flow = points(of_columns, flow, making);
        let flow = vectors.and_then(|vectors| vectors.flow.as_ref());
        let quaternion_flow = points(8, flow, making);
        let unitary = structure.unitary.as_ref();
        let factor = unitary.map_or(0, |known| known.point);
        let flow = unitary.and_then(|unitary| unitary.flow.as_ref());
        let unitary_flow = points(factor, flow, making);
        Self {
            spins: spins
                .map(|spins| spins.coordinates.clone())
                .unwrap_or_default(),
            scales: scales
                .iter()
                .map(|scale| making.push(Code::from_program(scale)))
                .collect(),
            matrices: representation.map_or(&[], |known| tables(&known.matrices)),
            dual: representation.map_or(&[], |known| tables(&known.dual)),
            skew: representation.is_some_and(|known| known.skew),
            size: representation.map_or(0, |known| known.size),
            column: representation.map_or(0, |known| known.column),
            point: of_columns,
            bounds: match spectrum {
                Some(plan::Spectrum::Bounded(weights)) => {
                    Some(weights.iter().map(Rational::to_f64).collect())
                }
                _ => None,
            },
            imaginary: matches!(spectrum, Some(plan::Spectrum::Imaginary)),
            motion: structure.motion,
            indices: columns
                .map(|known| known.indices.iter().map(|k| *k as u16).collect())
                .unwrap_or_default(),
            covectors: columns.map_or(&[], |known| tables(&known.covectors)),
            rotation: vectors.map_or([0; 3], |vectors| vectors.rotation),
            vectors: vectors
                .map(|vectors| vectors.vectors.iter().map(components).collect())
                .unwrap_or_default(),
            scale: vectors.map(|vectors| making.push(Code::from_program(&vectors.scale))),
            planes: inertia
                .map(|inertia| {
                    inertia
                        .planes
                        .iter()
                        .map(|(from, to)| Plane::new(*from as u16, *to as u16))
                        .collect()
                })
                .unwrap_or_default(),
            moments: inertia
                .map(|inertia| {
                    inertia
                        .moments
                        .iter()
                        .map(|moment| making.push(Code::from_program(moment)))
                        .collect()
                })
                .unwrap_or_default(),
            products: inertia
                .into_iter()
                .flat_map(|inertia| &inertia.products)
                .map(|(axes, product)| (*axes, making.push(Code::from_program(product))))
                .collect(),
            momenta: structure.momenta.unwrap_or(0),
            group: structure.group.as_ref().map(|group| Group {
                size: group.size,
                matrices: tables(&group.matrices),
                closed: group.closed,
                orthogonal: group.orthogonal,
                right: group.right,
            }),
            spinor_flow,
            column_flow,
            quaternion_flow,
            degree: unitary.map_or(0, |known| known.degree),
            factor,
            unitary_flow,
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
        &self.values.compiled.structure.spins
    }
    fn scale(&self, spin: usize) -> S {
        self.values
            .value(self.values.compiled.structure.scales[spin])
    }
    fn zero_spinors(&self) -> Vec<S> {
        vec![S::zero(); 4 * self.values.compiled.structure.spins.len()]
    }
    fn spinor_flow(&self, point: &Vec<S>, out: &mut Vec<S>) {
        match self.values.compiled.structure.spinor_flow {
            Some(code) => self.values.call(code, [point, &[]], out, &mut []),
            None => flow_over_spins(self, point, out),
        }
    }
}

impl<S: Scalar> MatrixPoisson<S> for Dynamic<S> {
    type Matrix = LateMatrix<S>;

    fn representation(&self) -> Representation<'_> {
        let structure = &self.values.compiled.structure;
        Representation {
            matrices: structure.matrices,
            dual: structure.dual,
            skew: structure.skew,
        }
    }
    fn spectrum(&self) -> Spectrum<'_> {
        self.values.compiled.structure.spectrum()
    }
    fn zero_matrix(&self) -> LateMatrix<S> {
        LateMatrix::new(self.values.compiled.structure.size)
    }
}

impl<S: Scalar> IntegrablePoisson<S> for Dynamic<S> {
    fn motion(&self) -> lie_core::Motion {
        match self.values.compiled.structure.motion {
            Some(Motion::Bodies) => lie_core::Motion::Bodies,
            _ => lie_core::Motion::Uniform,
        }
    }
    fn bodies(&self) -> &[[usize; 3]] {
        match self.values.compiled.structure.motion {
            Some(Motion::Bodies) => self.spins(),
            _ => &[],
        }
    }
    fn body_scale(&self, body: usize) -> S {
        match self.values.compiled.structure.motion {
            Some(Motion::Bodies) => SpinPoisson::scale(self, body),
            _ => S::one(),
        }
    }
}

impl<S: Scalar> ColumnPoisson<S> for Dynamic<S> {
    type Columns = Vec<S>;

    fn zero_columns(&self) -> Vec<S> {
        vec![S::zero(); self.values.compiled.structure.point]
    }
    fn column_size(&self) -> usize {
        self.values.compiled.structure.column
    }
    fn columns(&self) -> Columns<'_> {
        Columns {
            indices: &self.values.compiled.structure.indices,
            covectors: self.values.compiled.structure.covectors,
        }
    }
    fn column_flow(&self, point: &Vec<S>, out: &mut Vec<S>) {
        match self.values.compiled.structure.column_flow {
            Some(code) => self.values.call(code, [point, &[]], out, &mut []),
            None => flow_over_columns(self, point, out),
        }
    }
}

impl<S: Scalar> VectorPoisson<S> for Dynamic<S> {
    type Labels = Vec<S>;
    type Quaternions = Vec<S>;

    fn rotation(&self) -> [usize; 3] {
        self.values.compiled.structure.rotation
    }
    fn vectors(&self) -> &[[Entry; 3]] {
        &self.values.compiled.structure.vectors
    }
    fn scale(&self) -> S {
        self.values
            .compiled
            .structure
            .scale
            .map_or_else(S::one, |scale| self.values.value(scale))
    }
    fn zero_labels(&self) -> Vec<S> {
        let labels = match self.values.compiled.structure.vectors.len() {
            1 => 1,
            count => 3 * count,
        };
        vec![S::zero(); labels]
    }
    fn zero_quaternions(&self) -> Vec<S> {
        vec![S::zero(); 8]
    }
    fn quaternion_flow(&self, labels: &Vec<S>, point: &Vec<S>, out: &mut Vec<S>) {
        match self.values.compiled.structure.quaternion_flow {
            Some(code) => self.values.call(code, [labels, point], out, &mut []),
            None => flow_over_quaternions(self, labels, point, out),
        }
    }
}

impl<S: Scalar> UnitaryPoisson<S> for Dynamic<S> {
    type Shift = Vec<S>;
    type Factor = Vec<S>;
    type Hermitian = Vec<S>;

    fn degree(&self) -> usize {
        self.values.compiled.structure.degree
    }
    fn zero_shift(&self) -> Vec<S> {
        vec![S::zero()]
    }
    fn zero_factor(&self) -> Vec<S> {
        vec![S::zero(); self.values.compiled.structure.factor]
    }
    fn zero_hermitian(&self) -> Vec<S> {
        vec![S::zero(); 4 * self.values.compiled.structure.degree.pow(2)]
    }
    fn unitary_flow(&self, shift: &Vec<S>, point: &Vec<S>, out: &mut Vec<S>) {
        match self.values.compiled.structure.unitary_flow {
            Some(code) => self.values.call(code, [shift, point], out, &mut []),
            None => flow_over_factors(self, shift, point, out),
        }
    }
}

impl<S: Scalar> InertiaPoisson<S> for Dynamic<S> {
    type Matrix = LateMatrix<S>;

    fn planes(&self) -> &[Plane] {
        &self.values.compiled.structure.planes
    }
    fn zero_matrix(&self) -> LateMatrix<S> {
        LateMatrix::new(self.values.compiled.structure.moments.len())
    }
    fn moment(&self, axis: usize) -> S {
        self.values
            .value(self.values.compiled.structure.moments[axis])
    }
    fn is_tilted(&self) -> bool {
        !self.values.compiled.structure.products.is_empty()
    }
    fn product(&self, row: usize, column: usize) -> S {
        let axes = (row.min(column), row.max(column));
        let mut products = self.values.compiled.structure.products.iter();
        let known = products.find(|(known, _)| *known == axes);
        known.map_or_else(S::zero, |(_, code)| self.values.value(*code))
    }
}

impl<S: Scalar> CotangentPoisson<S> for Dynamic<S> {
    type Momentum = Vec<S>;
    type MomentumMatrix = LateMatrix<S>;

    fn momenta(&self) -> usize {
        self.values.compiled.structure.momenta
    }
    fn zero_momentum(&self) -> Vec<S> {
        vec![S::zero(); self.values.compiled.structure.momenta]
    }
    fn zero_momentum_matrix(&self) -> LateMatrix<S> {
        LateMatrix::new(self.values.compiled.structure.momenta)
    }
}

impl<S: Scalar> MatrixGroup<S> for Dynamic<S> {
    fn group(&self) -> Group<'_> {
        const NONE: Group<'static> = Group {
            size: 0,
            matrices: &[],
            closed: false,
            orthogonal: false,
            right: false,
        };
        self.values.compiled.structure.group.unwrap_or(NONE)
    }
    fn retract(&self, x: &Vec<S>, out: &mut [S]) {
        let code = self.retraction().element;
        self.values.call(code, [x, &[]], out, &mut []);
    }
}
