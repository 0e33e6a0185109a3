//! The flow of a stream map as a system of the runtime.

use crate::product::Planes;
use crate::skew::{ShapeError, SkewHermitian};
use crate::stream::StreamMap;
use lie_runtime::driver::Problem;
use lie_runtime::{Poisson, SquareMatrix, State};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The isospectral flow `W' = [P(W), W]` of a stream map: a Lie–Poisson system on the dual of u(N).
///
/// In the convention of the project, `mu' = ad*_(grad H) mu` with the trace form `<A, B> = Re tr(A^H B)`, this is
/// `W' = [W, grad H]`, `P = -grad H`. There are no structure constants: an evaluation is one product of matrices.
///
/// Casimirs are `tr F^2`, `tr F^3`, `tr F^4` of the Hermitian matrix `F = -i W`; all of them are functions of the
/// [`spectrum`](crate::spectrum()). Jacobians, of `N^2` rows, are for small N: they are there for measurements.
#[derive(Debug)]
pub struct MatrixFlow<M> {
    map: M,
    names: Vec<String>,
    work: Mutex<Work>,
}

/// Scratch space of an evaluation.
#[derive(Debug)]
struct Work {
    stream: SkewHermitian,
    streams: Planes,
    vorticity: Planes,
    product: Planes,
}

impl Work {
    fn new(size: usize) -> Self {
        Self {
            stream: SkewHermitian::zeros(size),
            streams: Planes::zeros(size),
            vorticity: Planes::zeros(size),
            product: Planes::zeros(size),
        }
    }

    /// The product of W with itself, once its planes are there.
    fn square(&mut self) {
        let (product, vorticity) = (&mut self.product, &self.vorticity);
        product.multiply(vorticity, vorticity, &mut self.stream);
    }

    /// `out = [P, W]`.
    fn commutator(&mut self, p: &SkewHermitian, w: &SkewHermitian, out: &mut SkewHermitian) {
        self.streams.spread(p, 1.0);
        self.vorticity.spread(w, 1.0);
        self.product.multiply(&self.streams, &self.vorticity, out);
    }
}

const CASIMIRS: [&str; 3] = ["tr_F2", "tr_F3", "tr_F4"];

impl<M: StreamMap> MatrixFlow<M> {
    /// The flow of a stream map.
    pub fn new(map: M) -> Self {
        let size = map.size();
        let mut names = Vec::with_capacity(size * size);
        for (part, first) in [("im", 0), ("re", 1)] {
            for column in 0..size {
                names.extend((column + first..size).map(|row| format!("{part}_{row}_{column}")));
            }
        }
        Self {
            names,
            work: Mutex::new(Work::new(size)),
            map,
        }
    }

    /// The stream map.
    pub fn map(&self) -> &M {
        &self.map
    }

    /// A problem with this system; `span` is start and end.
    ///
    /// # Errors
    /// [`ShapeError::Size`] if the matrix is not of the system's size.
    pub fn problem(
        self,
        w: SkewHermitian,
        span: (f64, f64),
    ) -> Result<Problem<f64, Self>, ShapeError> {
        let (system, state) = (self.map.size(), w.size());
        if system != state {
            return Err(ShapeError::Size { system, state });
        }
        Ok(Problem::new(self, w, span))
    }

    /// The scratch space, for one evaluation at a time; what a panic has left in it is overwritten.
    fn work(&self) -> MutexGuard<'_, Work> {
        self.work.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(crate) fn check(&self, w: &SkewHermitian) {
        let size = self.map.size();
        assert!(
            w.size() == size,
            "{}",
            ShapeError::Size {
                system: size,
                state: w.size()
            }
        );
    }

    fn unit(&self, index: usize) -> SkewHermitian {
        let mut unit = SkewHermitian::zeros(self.map.size());
        unit.as_mut_slice()[index] = 1.0;
        unit
    }
}

impl<M: StreamMap + Clone> Clone for MatrixFlow<M> {
    fn clone(&self) -> Self {
        Self::new(self.map.clone())
    }
}

/// A matrix of `N^2` rows, which takes no memory before its first entry is set.
#[derive(Clone, Debug, PartialEq)]
pub struct FlowJacobian {
    rows: usize,
    entries: Vec<f64>,
}

impl SquareMatrix<f64> for FlowJacobian {
    fn dimension(&self) -> usize {
        self.rows
    }
    fn get(&self, row: usize, column: usize) -> f64 {
        let place = row * self.rows + column;
        self.entries.get(place).copied().unwrap_or_default()
    }
    fn set(&mut self, row: usize, column: usize, value: f64) {
        if self.entries.is_empty() {
            self.entries.resize(self.rows * self.rows, 0.0);
        }
        self.entries[row * self.rows + column] = value;
    }
}

impl FlowJacobian {
    fn set_column(&mut self, column: usize, values: &[f64]) {
        for (row, &value) in values.iter().enumerate() {
            self.set(row, column, value);
        }
    }
}

impl<M: StreamMap> Poisson<f64> for MatrixFlow<M> {
    type State = SkewHermitian;
    type Jacobian = FlowJacobian;

    fn dimension(&self) -> usize {
        self.names.len()
    }
    fn name(&self) -> &str {
        self.map.name()
    }
    fn coordinate(&self, index: usize) -> &str {
        &self.names[index]
    }
    fn casimir_count(&self) -> usize {
        CASIMIRS.len()
    }
    fn casimir_name(&self, index: usize) -> &str {
        CASIMIRS[index]
    }
    fn casimir_degree(&self, index: usize) -> Option<u32> {
        Some(index as u32 + 2)
    }
    fn poisson_degree(&self) -> Option<u32> {
        Some(1)
    }
    fn zero_state(&self) -> SkewHermitian {
        SkewHermitian::zeros(self.map.size())
    }
    fn zero_jacobian(&self) -> FlowJacobian {
        FlowJacobian {
            rows: self.names.len(),
            entries: Vec::new(),
        }
    }

    fn hamiltonian(&self, mu: &SkewHermitian) -> f64 {
        self.check(mu);
        let work = &mut *self.work();
        self.map.stream(mu, &mut work.stream);
        self.map.hamiltonian(mu, &work.stream)
    }

    fn gradient(&self, mu: &SkewHermitian, out: &mut SkewHermitian) {
        self.check(mu);
        self.map.stream(mu, out);
        out.weigh(-1.0);
    }

    fn hessian(&self, mu: &SkewHermitian, out: &mut FlowJacobian) {
        self.check(mu);
        let mut slope = self.zero_state();
        for index in 0..self.dimension() {
            self.map.derivative(mu, &self.unit(index), &mut slope);
            slope.weigh(-1.0);
            out.set_column(index, slope.as_slice());
        }
    }

    fn poisson_matrix(&self, mu: &SkewHermitian, out: &mut FlowJacobian) {
        self.check(mu);
        let mut field = self.zero_state();
        for index in 0..self.dimension() {
            // the element of u(N) that is paired with a coordinate has the inverse weights
            let mut element = self.unit(index);
            element.weigh(1.0);
            for value in element.as_mut_slice() {
                *value = if *value == 0.0 { 0.0 } else { -1.0 / *value };
            }
            self.work().commutator(&element, mu, &mut field);
            out.set_column(index, field.as_slice());
        }
    }

    fn vector_field(&self, mu: &SkewHermitian, out: &mut SkewHermitian) {
        self.check(mu);
        let work = &mut *self.work();
        let mut stream = work.stream.take();
        self.map.stream(mu, &mut stream);
        work.commutator(&stream, mu, out);
        work.stream = stream;
    }

    fn jacobian(&self, mu: &SkewHermitian, out: &mut FlowJacobian) {
        self.check(mu);
        let zero = self.zero_state();
        let (mut stream, mut slope, mut column, mut other) =
            (zero.clone(), zero.clone(), zero.clone(), zero);
        self.map.stream(mu, &mut stream);
        for index in 0..self.dimension() {
            let unit = self.unit(index);
            self.map.derivative(mu, &unit, &mut slope);
            let work = &mut *self.work();
            work.commutator(&slope, mu, &mut column);
            work.commutator(&stream, &unit, &mut other);
            column.axpy(1.0, &other);
            out.set_column(index, column.as_slice());
        }
    }

    fn casimirs(&self, mu: &SkewHermitian, out: &mut [f64]) {
        self.check(mu);
        let work = &mut *self.work();
        work.vorticity.spread(mu, 1.0);
        work.square();
        // W = i F: tr F^2 = <W, W>, tr F^3 = Re tr((F^2)^H F), F^2 = -W^2, and tr F^4 = |W^2|^2
        work.product.times_i(&mut work.stream);
        out[0] = mu.inner(mu);
        out[1] = -work.stream.inner(mu);
        out[2] = work.product.inner(&work.product);
    }

    fn casimir_gradient(&self, index: usize, mu: &SkewHermitian, out: &mut SkewHermitian) {
        self.check(mu);
        let work = &mut *self.work();
        // grad tr F^k = i k F^(k-1): 2 W, -3 i W^2, -4 W^3
        if index == 0 {
            out.copy_from(mu);
            out.weigh(2.0);
            return;
        }
        work.vorticity.spread(mu, 1.0);
        work.square();
        if index == 1 {
            work.product.times_i(out);
            out.weigh(-3.0);
            return;
        }
        let square = work.product.clone();
        // twice the skew-Hermitian matrix W^3
        work.product.multiply(&square, &work.vorticity, out);
        out.weigh(-2.0);
    }
}
