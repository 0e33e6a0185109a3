//! The canonical flows of `H o J` on linear spaces over g*.

use lie_core::Clock;
use lie_core::clock::holds;
use lie_core::generic::{flow_over_quaternions, flow_over_spins};

use super::{Argument, Kernel, Source};
use crate::algebra::{Columns, Representation};
use crate::derive::trace::{Sym, values};
use crate::model::configuration::TIME_BLOCK;
use crate::model::{CANONICAL, Energy, Hamiltonian};
use lie_symbolic::exact::Rational;
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

    /// The columns from which methods on points start, without those of the time.
    pub fn columns(&self) -> Option<Points> {
        let representation = self.matrices()?;
        let mut columns = representation.columns.clone()?;
        let clock = self.clock();
        let size = representation.dimension - if clock.is_some() { TIME_BLOCK } else { 0 };
        let kept: Vec<bool> = columns.indices.iter().map(|index| *index < size).collect();
        columns.indices.retain(|index| *index < size);
        for (k, covector) in columns.covectors.iter_mut().enumerate() {
            let mut kept = kept.iter();
            covector.retain(|_| kept.next() == Some(&true));
            for row in covector {
                row.truncate(size);
                if holds(clock, k) {
                    row.fill(Rational::ZERO);
                }
            }
        }
        Some(Points {
            columns,
            size,
            clock,
        })
    }

    /// The flow on `T*V^r`, columns `x_j` and rows `y_j` beside them, and behind them the momentum of the time and the time.
    pub fn column_flow(&mut self) -> Option<Kernel> {
        let representation = self.matrices().cloned()?;
        let points = self.columns()?;
        let (size, columns) = (points.size, points.columns.indices.len());
        let half = size * columns;
        let symbols = places(0, points.count());
        let point: Vec<ExprId> = symbols.iter().map(|s| self.graph.symbol(*s)).collect();
        let (x, rest) = point.split_at(half);
        let (y, pair) = rest.split_at(half);
        let mut momenta = self.momenta_of(&representation, (x, y), size);
        if let (Some(clock), &[momentum, time]) = (points.clock, pair) {
            momenta[clock.momentum] = momentum;
            momenta[clock.time] = time;
            momenta[clock.time + 1] = self.graph.integer(1);
        }
        let gradient = self.generator();
        let gradient = self.at_point(&gradient, &momenta);
        let mut terms: Vec<Vec<ExprId>> = vec![Vec::new(); 2 * half];
        let moving = gradient.iter().zip(&representation.matrices).enumerate();
        for (_, (xi, matrix)) in moving.filter(|(k, _)| !holds(points.clock, *k)) {
            for (a, row) in matrix.iter().enumerate() {
                for (b, entry) in row.iter().enumerate().filter(|(_, entry)| !entry.is_zero()) {
                    let value = self.graph.scale(*xi, entry);
                    for j in 0..columns {
                        let moved = self.graph.mul(value, x[size * j + b]);
                        terms[size * j + a].push(self.graph.neg(moved));
                        let moved = self.graph.mul(value, y[size * j + a]);
                        terms[half + size * j + b].push(moved);
                    }
                }
            }
        }
        let mut flow: Vec<ExprId> = terms.iter().map(|terms| self.graph.sum(terms)).collect();
        if let Some(clock) = points.clock {
            flow.push(self.graph.neg(gradient[clock.time]));
            flow.push(gradient[clock.momentum]);
        }
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

    /// The flow on `C^(N x (N-1))` over a unitary representation: the real parts of the columns, then the imaginary ones.
    pub fn unitary_flow(&mut self) -> Option<Kernel> {
        let unitary = self.unitary()?;
        let representation = self.matrices().cloned()?;
        let (size, count) = (2 * unitary.degree, unitary.point());
        let (labels, symbols) = (places(count, 1), places(0, count));
        let point: Vec<ExprId> = symbols.iter().map(|s| self.graph.symbol(*s)).collect();
        let (real, imaginary) = point.split_at(count / 2);
        // columns of both parts, and the rows i X^H/2 beside them
        let (mut x, mut y) = (Vec::new(), Vec::new());
        let columns = real.chunks(unitary.degree);
        for (re, im) in columns.zip(imaginary.chunks(unitary.degree)) {
            x.extend(re.iter().chain(im).copied());
            let half = Rational::ONE / Rational::from(2);
            y.extend(im.iter().map(|value| self.graph.scale(*value, &half)));
            y.extend(re.iter().map(|value| self.graph.scale(*value, &-&half)));
        }
        let mut momenta = self.momenta_of(&representation, (&x, &y), size);
        let shift = self.graph.symbol(labels[0]);
        for (momentum, trace) in momenta.iter_mut().zip(traces(&representation)) {
            let constant = self.graph.scale(shift, &trace);
            *momentum = self.graph.add(*momentum, constant);
        }
        let gradient = self.in_gauge(Self::generator);
        let gradient = self.at_point(&gradient, &momenta);
        let mut terms: Vec<Vec<ExprId>> = vec![Vec::new(); x.len()];
        for (xi, matrix) in gradient.iter().zip(&representation.matrices) {
            for (a, row) in matrix.iter().enumerate() {
                for (b, entry) in row.iter().enumerate().filter(|(_, entry)| !entry.is_zero()) {
                    let value = self.graph.scale(*xi, &-entry);
                    for j in (0..x.len()).step_by(size) {
                        terms[j + a].push(self.graph.mul(value, x[j + b]));
                    }
                }
            }
        }
        let moved: Vec<ExprId> = terms.iter().map(|terms| self.graph.sum(terms)).collect();
        let part = |of: usize| {
            let columns = moved.chunks(size);
            columns.flat_map(move |column| &column[of * unitary.degree..][..unitary.degree])
        };
        let flow: Vec<ExprId> = part(0).chain(part(1)).copied().collect();
        let formula = "`X' = -rho(grad (H - C)) X` at `(i/2) tr rho(e_k) (shift + X X^H)`, C a function of Casimirs";
        let arguments = vec![argument("shift", &labels), argument("point", &symbols)];
        Some(Kernel::vector(
            &self.graph,
            "unitary_flow",
            formula,
            arguments,
            &flow,
        ))
    }

    /// `J_k = sum_j y_j rho_k x_j`, of columns of a size.
    fn momenta_of(
        &mut self,
        representation: &Representation,
        (x, y): (&[ExprId], &[ExprId]),
        size: usize,
    ) -> Vec<ExprId> {
        let clock = self.clock();
        let mut momenta = Vec::new();
        for (k, matrix) in representation.matrices.iter().enumerate() {
            let mut terms = Vec::new();
            for (a, row) in matrix.iter().enumerate() {
                let entries = row.iter().enumerate();
                for (b, entry) in entries.filter(|(_, e)| !e.is_zero() && !holds(clock, k)) {
                    for (x, y) in x.chunks(size).zip(y.chunks(size)) {
                        let product = self.graph.mul(y[a], x[b]);
                        terms.push(self.graph.scale(product, entry));
                    }
                }
            }
            momenta.push(self.graph.sum(&terms));
        }
        momenta
    }
}

/// `(i/2) tr rho(e_k)` of anti-Hermitian matrices, written as real ones.
fn traces(representation: &Representation) -> impl Iterator<Item = Rational> {
    let degree = representation.dimension / 2;
    let half = Rational::ONE / Rational::from(2);
    representation.matrices.iter().map(move |matrix| {
        let sum = (0..degree).fold(Rational::ZERO, |sum, a| &sum + &matrix[a][degree + a]);
        &sum * &half
    })
}

/// Points of `T*V^r`.
pub struct Points {
    /// The columns from which they start.
    pub columns: Columns,
    /// The size of a column.
    pub size: usize,
    clock: Option<Clock>,
}

impl Points {
    /// The number of coordinates of a point.
    pub fn count(&self) -> usize {
        2 * self.size * self.columns.indices.len() + if self.clock.is_some() { 2 } else { 0 }
    }
}
