//! The canonical flows of `H o J` on linear spaces over g*.

use lie_core::generic::{flow_over_quaternions, flow_over_spins};

use super::{Argument, Kernel, Source};
use crate::algebra::Representation;
use crate::derive::trace::{Sym, values};
use crate::model::{CANONICAL, Energy, Hamiltonian};
use lie_symbolic::symbolic::{ExprId, Symbol};

/// The symbols of so many entries of a point, from a place on.
fn places(first: usize, count: usize) -> Vec<Symbol> {
    let first = CANONICAL + first;
    (first..first + count).map(Symbol::Input).collect()
}

fn argument(name: &'static str, symbols: &[Symbol]) -> Argument {
    Argument {
        name,
        symbols: symbols.to_vec(),
    }
}

fn syms(symbols: &[Symbol]) -> Vec<Sym> {
    symbols
        .iter()
        .map(|symbol| Sym::from_symbol(*symbol))
        .collect()
}

impl Source {
    /// What is derived with H in the gauge that makes it short.
    fn in_gauge<T>(&mut self, derive: impl FnOnce(&mut Self) -> T) -> T {
        let energy = self.energy.clone();
        if let (Some(value), Some(hamiltonian)) = (self.structure.gauged, energy.expression()) {
            self.energy = Energy::Expression(Hamiltonian {
                value,
                ..hamiltonian.clone()
            });
        }
        let derived = derive(self);
        self.energy = energy;
        derived
    }

    /// The flow on `T*R^2` for each spin.
    pub fn spinor_flow(&mut self) -> Option<Kernel> {
        let count = 4 * self.spins()?.len();
        let symbols = places(0, count);
        let flow = self.in_gauge(|source| {
            values(source, |system| {
                let mut out = syms(&symbols);
                flow_over_spins(system, &syms(&symbols), &mut out);
                out
            })
        })?;
        let formula = "`z'` of `(H - C) o J`, C a function of Casimirs";
        let point = vec![argument("point", &symbols)];
        Some(Kernel::vector(
            &self.graph,
            "spinor_flow",
            formula,
            point,
            &flow,
        ))
    }

    /// The flow on `T*H`, H the quaternions.
    pub fn quaternion_flow(&mut self) -> Option<Kernel> {
        let labels = match self.vectors()?.vectors.len() {
            1 => 1,
            count => 3 * count,
        };
        let (labels, symbols) = (places(8, labels), places(0, 8));
        let flow = self.in_gauge(|source| {
            values(source, |system| {
                let mut out = syms(&symbols);
                flow_over_quaternions(system, &syms(&labels), &syms(&symbols), &mut out);
                out
            })
        })?;
        let formula =
            "`q' = q w`, `P' = P w + c sum (a q) chi_a` of `(H - C) o J`, C a function of Casimirs";
        let arguments = vec![argument("labels", &labels), argument("point", &symbols)];
        Some(Kernel::vector(
            &self.graph,
            "quaternion_flow",
            formula,
            arguments,
            &flow,
        ))
    }

    /// The flow on `T*V^r`, columns `x_j` and rows `y_j` beside them.
    pub fn column_flow(&mut self) -> Option<Kernel> {
        let representation = self.matrices().cloned()?;
        let columns = representation.columns.as_ref()?.indices.len();
        let (size, half) = (representation.dimension, representation.dimension * columns);
        let symbols = places(0, 2 * half);
        let point: Vec<ExprId> = symbols.iter().map(|s| self.graph.symbol(*s)).collect();
        let (x, y) = point.split_at(half);
        let gradient = self.gradient_over(&representation, x, y);
        let mut terms: Vec<Vec<ExprId>> = vec![Vec::new(); 2 * half];
        for (xi, matrix) in gradient.into_iter().zip(&representation.matrices) {
            for (a, row) in matrix.iter().enumerate() {
                for (b, entry) in row.iter().enumerate().filter(|(_, entry)| !entry.is_zero()) {
                    let value = self.graph.scale(xi, entry);
                    for j in 0..columns {
                        let moved = self.graph.mul(value, x[size * j + b]);
                        terms[size * j + a].push(self.graph.neg(moved));
                        let moved = self.graph.mul(value, y[size * j + a]);
                        terms[half + size * j + b].push(moved);
                    }
                }
            }
        }
        let flow: Vec<ExprId> = terms.iter().map(|terms| self.graph.sum(terms)).collect();
        let formula = "`x_j' = -rho(xi) x_j`, `y_j' = y_j rho(xi)`, `xi = grad H(J)`";
        let point = vec![argument("point", &symbols)];
        Some(Kernel::vector(
            &self.graph,
            "column_flow",
            formula,
            point,
            &flow,
        ))
    }

    /// `grad H` at `J_k = sum_j y_j rho_k x_j`.
    fn gradient_over(
        &mut self,
        representation: &Representation,
        x: &[ExprId],
        y: &[ExprId],
    ) -> Vec<ExprId> {
        let size = representation.dimension;
        let mut momenta = Vec::new();
        for matrix in &representation.matrices {
            let mut terms = Vec::new();
            for (a, row) in matrix.iter().enumerate() {
                for (b, entry) in row.iter().enumerate().filter(|(_, entry)| !entry.is_zero()) {
                    for (x, y) in x.chunks(size).zip(y.chunks(size)) {
                        let product = self.graph.mul(y[a], x[b]);
                        terms.push(self.graph.scale(product, entry));
                    }
                }
            }
            momenta.push(self.graph.sum(&terms));
        }
        let gradient = self.gradient_of_h();
        self.at_point(&gradient, &momenta)
    }
}
