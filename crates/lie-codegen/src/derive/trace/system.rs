//! A declared system over expressions: its traits say how the kernels of the declaration look at a point that is
//! itself an expression.

use lie_core::structure::{Entry, Plane};
use lie_core::{
    CayleyPoisson, InertiaPoisson, LiePoisson, Poisson, SpinPoisson, SquareMatrix, VectorPoisson,
};

use super::sym::{Session, Sym, with_session};
use crate::derive::{Block, Closed, Source};
use crate::structure::inertia::Body;
use crate::structure::vectors::{Component, Vectors};
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Symbol};

/// A square matrix of expressions, row by row.
#[derive(Clone, Debug)]
pub struct Square {
    size: usize,
    pub(super) entries: Vec<Sym>,
}

impl SquareMatrix<Sym> for Square {
    fn dimension(&self) -> usize {
        self.size
    }
    fn get(&self, row: usize, column: usize) -> Sym {
        self.entries[row * self.size + column]
    }
    fn set(&mut self, row: usize, column: usize, value: Sym) {
        self.entries[row * self.size + column] = value;
    }
}

pub(super) type State = Vec<Sym>;

/// so(3) with vectors.
#[derive(Clone, Debug)]
struct SymbolicVectors {
    rotation: [usize; 3],
    vectors: Vec<[Entry; 3]>,
    scale: Sym,
}

impl SymbolicVectors {
    fn new(vectors: &Vectors) -> Self {
        let entry = |(k, factor): &Component| {
            let high = factor.to_f64();
            let low = Rational::from_f64(high).map_or(0.0, |high| (factor - &high).to_f64());
            Entry::parts(*k as u16, 0, high, low)
        };
        let vector = |components: &[Component; 3]| components.each_ref().map(entry);
        Self {
            rotation: vectors.rotation,
            vectors: vectors.vectors.iter().map(vector).collect(),
            scale: Sym(vectors.scale),
        }
    }
}

/// The system of the trace that runs.
#[derive(Clone, Debug)]
pub struct SymbolicSystem {
    dimension: usize,
    spins: Vec<[usize; 3]>,
    scales: Vec<Sym>,
    planes: Vec<Plane>,
    moments: Vec<Sym>,
    products: Vec<((usize, usize), Sym)>,
    vectors: Option<SymbolicVectors>,
    closed: Option<Closed>,
    exponential: bool,
    forced: bool,
    damped: bool,
}

impl SymbolicSystem {
    pub(super) fn new(source: &Source) -> Self {
        let spins = source.spheres().into_iter().flatten();
        let (spins, scales) = spins.map(|s| (s.coordinates, Sym(s.scale))).unzip();
        let (planes, moments, products) = match source.body() {
            Some(Body::Many {
                planes,
                moments,
                products,
            }) => (planes.as_slice(), moments.as_slice(), products.as_slice()),
            _ => Default::default(),
        };
        let (planes, products) = (planes.iter(), products.iter());
        Self {
            dimension: source.dimension,
            spins,
            scales,
            planes: planes
                .map(|&(from, to)| Plane::new(from as u16, to as u16))
                .collect(),
            moments: moments.iter().map(|moment| Sym(*moment)).collect(),
            products: products
                .map(|(axes, product)| (*axes, Sym(*product)))
                .collect(),
            vectors: source.vectors().map(SymbolicVectors::new),
            closed: None,
            exponential: source.exponential.is_some(),
            forced: source.force().is_some(),
            damped: source.is_damped(),
        }
    }

    /// The system with a discrete gradient.
    pub(crate) fn with_gradient(&self, closed: Closed) -> Self {
        Self {
            closed: Some(closed),
            ..self.clone()
        }
    }

    pub(super) fn gradient(&self) -> &Closed {
        self.closed.as_ref().expect("a system with a gradient")
    }

    fn zeros(size: usize) -> Square {
        Square {
            size,
            entries: vec![Sym::default(); size * size],
        }
    }

    /// Expressions in the coordinates, at a point.
    fn at(expressions: impl FnOnce(&mut Source) -> Vec<ExprId>, point: &[Sym]) -> Vec<Sym> {
        let point: Vec<ExprId> = point.iter().map(|x| x.0).collect();
        with_session(|Session { source, .. }| {
            let expressions = expressions(source);
            source
                .at_point(&expressions, &point)
                .into_iter()
                .map(Sym)
                .collect()
        })
    }

    pub(super) fn matrix(&self, rows: Vec<Sym>, out: &mut Square) {
        *out = Square {
            size: self.dimension,
            entries: rows,
        };
    }
}

pub(super) fn ids(vector: &[Sym]) -> Vec<ExprId> {
    vector.iter().map(|x| x.0).collect()
}

pub(super) fn write(values: Vec<ExprId>, out: &mut State) {
    *out = values.into_iter().map(Sym).collect();
}

impl Poisson<Sym> for SymbolicSystem {
    type State = State;
    type Jacobian = Square;

    fn dimension(&self) -> usize {
        self.dimension
    }
    fn name(&self) -> &str {
        ""
    }
    fn coordinate(&self, _index: usize) -> &str {
        ""
    }
    fn zero_state(&self) -> State {
        vec![Sym::default(); self.dimension]
    }
    fn zero_jacobian(&self) -> Square {
        Self::zeros(self.dimension)
    }

    fn hamiltonian(&self, mu: &State) -> Sym {
        Self::at(|source| vec![source.function()], mu)[0]
    }
    fn gradient(&self, mu: &State, out: &mut State) {
        *out = Self::at(Source::gradient_of_h, mu);
    }
    fn hessian(&self, mu: &State, out: &mut Square) {
        self.matrix(Self::at(|s| s.hessian_of_h().concat(), mu), out);
    }
    fn poisson_matrix(&self, mu: &State, out: &mut Square) {
        self.matrix(Self::at(|s| s.poisson_matrix().concat(), mu), out);
    }
    fn is_forced(&self) -> bool {
        self.forced
    }
    fn force(&self, mu: &State, out: &mut State) {
        *out = Self::at(|source| source.force().unwrap_or_default(), mu);
    }
    fn force_slope(&self, mu: &State, out: &mut Square) {
        let entries = |source: &mut Source| {
            let force = source.force().unwrap_or_default();
            source.jacobian_of(&force).concat()
        };
        self.matrix(Self::at(entries, mu), out);
    }
    fn is_damped(&self) -> bool {
        self.damped
    }
    fn generator(&self, mu: &State, out: &mut State) {
        *out = Self::at(Source::generator, mu);
    }
    fn generator_slope(&self, mu: &State, out: &mut Square) {
        let entries = |source: &mut Source| {
            let generator = source.generator();
            source.jacobian_of(&generator).concat()
        };
        self.matrix(Self::at(entries, mu), out);
    }
    fn vector_field(&self, mu: &State, out: &mut State) {
        *out = Self::at(Source::field, mu);
    }
    fn jacobian(&self, mu: &State, out: &mut Square) {
        let entries = |source: &mut Source| {
            let field = source.field();
            source.jacobian_of(&field).concat()
        };
        self.matrix(Self::at(entries, mu), out);
    }
    fn poisson_slope(&self, mu: &State, xi: &State, out: &mut Square) {
        let (mu, xi) = (ids(mu), ids(xi));
        let entries = with_session(|Session { source, .. }| {
            let (entries, vector) = (source.poisson_slope().concat(), source.symbols(Block::Xi));
            source.graph.substitute(&entries, &|symbol| match symbol {
                Symbol::Coordinate(i) => Some(mu[i]),
                other => vector.iter().position(|s| *s == other).map(|i| xi[i]),
            })
        });
        self.matrix(entries.into_iter().map(Sym).collect(), out);
    }
    fn casimirs(&self, _mu: &State, _out: &mut [Sym]) {}
    fn casimir_gradient(&self, _index: usize, _mu: &State, _out: &mut State) {}
}

impl LiePoisson<Sym> for SymbolicSystem {
    fn ad(&self, xi: &State, eta: &State, out: &mut State) {
        let (xi, eta) = (ids(xi), ids(eta));
        write(with_session(|s| s.source.ad_of(&xi, &eta)), out);
    }
    fn ad_star(&self, xi: &State, mu: &State, out: &mut State) {
        let (xi, mu) = (ids(xi), ids(mu));
        write(with_session(|s| s.source.ad_star_of(&xi, &mu)), out);
    }
    fn ad_star_matrix(&self, xi: &State, out: &mut Square) {
        let xi = ids(xi);
        let rows = with_session(|s| s.source.ad_star_matrix_of(&xi));
        self.matrix(rows.concat().into_iter().map(Sym).collect(), out);
    }
    fn has_closed_exponential(&self) -> bool {
        self.exponential
    }
    fn coadjoint_action(&self, xi: &State, mu: &State, out: &mut State) {
        write(closed_function(xi, mu, 0), out);
    }
    fn dexp_dual(&self, xi: &State, mu: &State, out: &mut State) {
        write(closed_function(xi, mu, 1), out);
    }
}

/// `f_k(ad*_x) m` in closed form.
fn closed_function(x: &[Sym], m: &[Sym], k: usize) -> Vec<ExprId> {
    let (x, m) = (ids(x), ids(m));
    with_session(|Session { source, tape, .. }| {
        let x = tape.define_all(source, &x);
        source.closed_function(tape, (&x, &m), k)
    })
}

impl CayleyPoisson<Sym> for SymbolicSystem {
    fn triple(&self, x: &State, z: &State, mu: &State, out: &mut State) {
        let (x, z, mu) = (ids(x), ids(z), ids(mu));
        write(with_session(|s| s.source.triple_of(&x, &z, &mu)), out);
    }
}

impl SpinPoisson<Sym> for SymbolicSystem {
    fn spins(&self) -> &[[usize; 3]] {
        &self.spins
    }
    fn scale(&self, spin: usize) -> Sym {
        self.scales[spin]
    }
    type Spinors = State;
    fn zero_spinors(&self) -> State {
        vec![<Sym as lie_core::Scalar>::zero(); 4 * self.spins.len()]
    }
}

impl VectorPoisson<Sym> for SymbolicSystem {
    fn rotation(&self) -> [usize; 3] {
        self.vectors.as_ref().map_or([0; 3], |found| found.rotation)
    }
    fn vectors(&self) -> &[[Entry; 3]] {
        let found = self.vectors.as_ref();
        found.map_or(&[], |found| found.vectors.as_slice())
    }
    fn scale(&self) -> Sym {
        let found = self.vectors.as_ref();
        found.map_or_else(Sym::default, |found| found.scale)
    }
    type Labels = State;
    type Quaternions = State;
    fn zero_quaternions(&self) -> State {
        vec![Sym::default(); 8]
    }
    fn zero_labels(&self) -> State {
        let count = match self.vectors().len() {
            1 => 1,
            count => 3 * count,
        };
        vec![Sym::default(); count]
    }
}

impl InertiaPoisson<Sym> for SymbolicSystem {
    type Matrix = Square;
    fn planes(&self) -> &[Plane] {
        &self.planes
    }
    fn zero_matrix(&self) -> Square {
        Self::zeros(self.moments.len())
    }
    fn moment(&self, axis: usize) -> Sym {
        self.moments[axis]
    }
    fn is_tilted(&self) -> bool {
        !self.products.is_empty()
    }
    fn product(&self, row: usize, column: usize) -> Sym {
        let axes = (row.min(column), row.max(column));
        let known = self.products.iter().find(|(known, _)| *known == axes);
        known.map(|(_, product)| *product).unwrap_or_default()
    }
}
