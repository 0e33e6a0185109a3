//! A drawn system, over any scalar.

use super::algebra::{Algebra, Rows, Space, inverse};
use super::energy::Energy;
use lie_runtime::generic;
use lie_runtime::structure::{Columns, Entry, Representation};
use lie_runtime::{
    ColumnPoisson, Expand, LiePoisson, Lift, MatrixPoisson, Poisson, Scalar, SpinPoisson,
    SquareMatrix, VectorPoisson, Widen,
};
use std::sync::Arc;

/// A Lie–Poisson system of run time.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// The algebra.
    pub algebra: Arc<Algebra>,
    /// The Hamiltonian.
    pub energy: Arc<Energy>,
    tables: Arc<Tables>,
}

/// Lists in the form in which the traits want them, for as long as the program runs.
#[derive(Debug)]
struct Tables {
    representation: Representation<'static>,
    columns: Columns<'static>,
    size: usize,
}

impl Drawn {
    /// A system.
    pub fn new(algebra: Arc<Algebra>, energy: Energy) -> Self {
        let tables = Arc::new(Tables::of(&algebra));
        Self {
            algebra,
            energy: Arc::new(energy),
            tables,
        }
    }
}

fn kept<T>(list: Vec<T>) -> &'static [T] {
    Vec::leak(list)
}

fn entries(rows: &Rows) -> &'static [Entry] {
    let mut list = Vec::new();
    for (i, row) in rows.iter().enumerate() {
        for (j, &value) in row.iter().enumerate() {
            if value != 0.0 {
                list.push(Entry::new(i as u16, j as u16, value));
            }
        }
    }
    kept(list)
}

impl Tables {
    /// All columns, and the dual basis under the trace.
    fn of(algebra: &Algebra) -> Self {
        let matrices = &algebra.matrices;
        let size = matrices[0].len();
        let gram = |a: &Rows, b: &Rows| -> f64 {
            let all = a.iter().flatten().zip(b.iter().flatten());
            all.map(|(x, y)| x * y).sum()
        };
        let gram: Rows = matrices
            .iter()
            .map(|a| matrices.iter().map(|b| gram(a, b)).collect())
            .collect();
        let weights = inverse(&gram);
        let dual = |k: usize| -> Rows {
            let mut sum = vec![vec![0.0; size]; size];
            for (weight, m) in weights[k].iter().zip(matrices) {
                for (i, row) in m.iter().enumerate() {
                    for (j, entry) in row.iter().enumerate() {
                        sum[j][i] += weight * entry;
                    }
                }
            }
            sum
        };
        let dual: Vec<&'static [Entry]> = (0..matrices.len()).map(|k| entries(&dual(k))).collect();
        let dual = kept(dual);
        Self {
            representation: Representation {
                matrices: kept(matrices.iter().map(entries).collect()),
                dual,
                skew: false,
            },
            columns: Columns {
                indices: kept((0..size as u16).collect()),
                covectors: dual,
            },
            size,
        }
    }
}

/// A matrix of any size.
#[derive(Clone, Debug)]
pub struct Square<S>(usize, Vec<S>);

impl<S: Scalar> SquareMatrix<S> for Square<S> {
    fn dimension(&self) -> usize {
        self.0
    }
    fn get(&self, row: usize, column: usize) -> S {
        self.1[row * self.0 + column]
    }
    fn set(&mut self, row: usize, column: usize, value: S) {
        self.1[row * self.0 + column] = value;
    }
}

impl<S: Scalar> Poisson<S> for Drawn {
    type State = Vec<S>;
    type Jacobian = Square<S>;

    fn dimension(&self) -> usize {
        self.algebra.dimension()
    }
    fn name(&self) -> &str {
        &self.algebra.name
    }
    fn coordinate(&self, _index: usize) -> &str {
        "mu"
    }
    fn hamiltonian_degree(&self) -> Option<u32> {
        self.energy.degree()
    }
    fn poisson_degree(&self) -> Option<u32> {
        Some(1)
    }
    fn zero_state(&self) -> Vec<S> {
        vec![S::zero(); self.algebra.dimension()]
    }
    fn zero_jacobian(&self) -> Square<S> {
        let n = self.algebra.dimension();
        Square(n, vec![S::zero(); n * n])
    }
    fn hamiltonian(&self, mu: &Vec<S>) -> S {
        self.energy.value(mu)
    }
    fn gradient(&self, mu: &Vec<S>, out: &mut Vec<S>) {
        self.energy.gradient(mu, out);
    }
    fn hessian(&self, mu: &Vec<S>, out: &mut Square<S>) {
        self.energy.hessian(mu, |i, j, value| out.set(i, j, value));
    }
    fn poisson_matrix(&self, mu: &Vec<S>, out: &mut Square<S>) {
        out.1.fill(S::zero());
        for &(i, j, k, c) in &self.algebra.constants {
            let sum = out.get(i, j) - S::from_f64(c) * mu[k];
            out.set(i, j, sum);
        }
    }
    fn jacobian(&self, mu: &Vec<S>, out: &mut Square<S>) {
        generic::jacobian(self, mu, out);
    }
    fn vector_field(&self, mu: &Vec<S>, out: &mut Vec<S>) {
        let mut gradient: Vec<S> = self.zero_state();
        self.energy.gradient(mu, &mut gradient);
        self.ad_star(&gradient, mu, out);
    }
    fn casimirs(&self, _mu: &Vec<S>, _out: &mut [S]) {}
    fn casimir_gradient(&self, _index: usize, _mu: &Vec<S>, _out: &mut Vec<S>) {}
}

impl<S: Scalar> LiePoisson<S> for Drawn {
    fn ad(&self, xi: &Vec<S>, eta: &Vec<S>, out: &mut Vec<S>) {
        out.fill(S::zero());
        for &(i, j, k, c) in &self.algebra.constants {
            out[k] += S::from_f64(c) * (xi[i] * eta[j]);
        }
    }
    fn ad_star(&self, xi: &Vec<S>, mu: &Vec<S>, out: &mut Vec<S>) {
        out.fill(S::zero());
        for &(i, j, k, c) in &self.algebra.constants {
            out[j] += S::from_f64(c) * (xi[i] * mu[k]);
        }
    }
    fn ad_star_matrix(&self, xi: &Vec<S>, out: &mut Square<S>) {
        out.1.fill(S::zero());
        for &(i, j, k, c) in &self.algebra.constants {
            let sum = out.get(j, k) + S::from_f64(c) * xi[i];
            out.set(j, k, sum);
        }
    }
}

impl<S: Scalar> Lift<S> for Drawn {
    type Lifted = Self;
    fn lift(&self) -> Self {
        self.clone()
    }
}

impl<S: Scalar> Widen<S> for Drawn {
    type Widened = Self;
    fn widen(&self) -> Self {
        self.clone()
    }
}

impl<S: Scalar> Expand<S> for Drawn {
    type Expanded = Self;
    fn expand(&self) -> Self {
        self.clone()
    }
}

lie_runtime::generic_equations!([S: Scalar] Drawn, S: midpoint, exp, splitting);

impl<S: Scalar> SpinPoisson<S> for Drawn {
    fn spins(&self) -> &[[usize; 3]] {
        match &self.algebra.space {
            Space::Spins(spins) => spins,
            _ => &[],
        }
    }
    fn scale(&self, _spin: usize) -> S {
        S::one()
    }
    type Spinors = Vec<S>;
    fn zero_spinors(&self) -> Vec<S> {
        vec![S::zero(); 4 * SpinPoisson::<S>::spins(self).len()]
    }
}

impl<S: Scalar> VectorPoisson<S> for Drawn {
    fn rotation(&self) -> [usize; 3] {
        [0, 1, 2]
    }
    fn vectors(&self) -> &[[Entry; 3]] {
        match &self.algebra.space {
            Space::Vectors(_, vectors) => vectors,
            _ => &[],
        }
    }
    fn scale(&self) -> S {
        S::one()
    }
    type Labels = Vec<S>;
    fn zero_labels(&self) -> Vec<S> {
        let vectors = VectorPoisson::<S>::vectors(self).len();
        vec![S::zero(); if vectors == 1 { 1 } else { 3 * vectors }]
    }
    type Quaternions = Vec<S>;
    fn zero_quaternions(&self) -> Vec<S> {
        vec![S::zero(); 8]
    }
}

impl<S: Scalar> MatrixPoisson<S> for Drawn {
    type Matrix = Square<S>;
    fn representation(&self) -> Representation<'_> {
        self.tables.representation
    }
    fn zero_matrix(&self) -> Square<S> {
        let size = self.tables.size;
        Square(size, vec![S::zero(); size * size])
    }
}

impl<S: Scalar> ColumnPoisson<S> for Drawn {
    type Columns = Vec<S>;
    fn zero_columns(&self) -> Vec<S> {
        vec![S::zero(); 2 * self.tables.size * self.tables.size]
    }
    fn column_size(&self) -> usize {
        self.tables.size
    }
    fn columns(&self) -> Columns<'_> {
        self.tables.columns
    }
}
