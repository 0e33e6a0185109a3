//! The quadratic part of a Lagrangian, and its elimination row by row.

use super::{Lagrangian, not_at_rest};
use crate::model::configuration::Configuration;
use lie_symbolic::exact::{Budget, Rational};
use lie_symbolic::prove::normal::{NormalForm, Verdict};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::diagnostic::{Diagnostic, Kind};

/// Work allowed for one decision of the normal form.
const WORK: u64 = 2_000_000;
/// A pivot below that part of the largest entry at the default parameters is none.
const SINGULAR: f64 = 1e-13;
/// A pivot that is that much smaller than the largest may stand for it, if it causes less fill-in.
const THRESHOLD: f64 = 0.1;

/// `<A xi, xi>/2 + <b, xi> + c`, partly eliminated.
pub(super) struct Quadratic {
    matrix: Vec<Vec<ExprId>>,
    /// `mu - b`, later `L^-1` of it.
    momenta: Vec<ExprId>,
    pub(super) constant: ExprId,
    /// Rows that are not eliminated.
    pub(super) rest: Vec<usize>,
    defaults: Vec<f64>,
    /// The coordinates at rest, as far as any are beside mu.
    at_rest: Vec<f64>,
    /// The largest entry at the default parameters.
    size: f64,
}

/// One row, or two whose block is inverted.
pub(super) enum Pivot {
    One(usize),
    Two(usize, usize),
}

/// The second derivatives, from the first.
fn hessian(graph: &mut Graph, slopes: &[ExprId]) -> Vec<Vec<ExprId>> {
    let row = |&slope: &ExprId| {
        let entries = (0..slopes.len()).map(|j| graph.derivative(slope, Symbol::Input(j)));
        entries.collect()
    };
    slopes.iter().map(row).collect()
}

/// Whether the third derivatives vanish; by symmetry those of ordered indices are enough.
fn is_constant(graph: &mut Graph, hessian: &[Vec<ExprId>]) -> bool {
    let count = hessian.len();
    let upper = (0..count).flat_map(|i| (i..count).map(move |j| (i, j)));
    let mut all = upper.flat_map(|(i, j)| (j..count).map(move |k| (i, j, k)));
    all.all(|(i, j, k)| {
        let third = graph.derivative(hessian[i][j], Symbol::Input(k));
        graph.is_zero(third) || vanishes(graph, third)
    })
}

impl Quadratic {
    /// The terms up to second order at rest, and whether there are no others.
    pub(super) fn new(
        graph: &mut Graph,
        lagrangian: &Lagrangian<'_>,
    ) -> Result<(Self, bool), Diagnostic> {
        let count = lagrangian.velocity.len();
        let zero = graph.integer(0);
        let at_rest = |symbol| matches!(symbol, Symbol::Input(_)).then_some(zero);
        let slopes: Vec<ExprId> = (0..count)
            .map(|i| graph.derivative(lagrangian.value, Symbol::Input(i)))
            .collect();
        let hessian = hessian(graph, &slopes);
        let quadratic = is_constant(graph, &hessian);
        let rows = hessian.iter();
        let matrix = rows.map(|row| graph.substitute(row, &at_rest)).collect();
        let mut roots = slopes;
        roots.push(lagrangian.value);
        let mut values = graph.substitute(&roots, &at_rest);
        let constant = values.pop().unwrap_or(zero);
        let momenta = values.into_iter().enumerate().map(|(i, linear)| {
            let mu = graph.symbol(Symbol::Coordinate(i));
            graph.sub(mu, linear)
        });
        let momenta = momenta.collect();
        let mut form = Self {
            matrix,
            momenta,
            constant,
            rest: (0..count).collect(),
            defaults: lagrangian
                .parameters
                .iter()
                .map(|p| p.default_value)
                .collect(),
            at_rest: (0..lagrangian.configuration.map_or(0, Configuration::dimension))
                .map(|coordinate| lagrangian.at_rest(coordinate))
                .collect(),
            size: 0.0,
        };
        let entries = form.matrix.iter().flatten();
        let all = entries.clone().chain(&form.momenta).chain([&form.constant]);
        let finite = |&entry: &ExprId| {
            graph.evaluate(entry, &|symbol| match symbol {
                Symbol::Parameter(p) => form.defaults[p],
                Symbol::Coordinate(i) => form.at_rest.get(i).copied().unwrap_or(0.0),
                _ => 0.0,
            })
        };
        if !all.map(finite).all(f64::is_finite) {
            return Err(not_at_rest(lagrangian));
        }
        form.size = entries
            .map(|&entry| form.value(graph, entry).abs())
            .fold(0.0, f64::max);
        Ok((form, quadratic))
    }

    /// The rank of the Hessian at rest with the default parameters, if it is not full.
    pub(super) fn rank_at_rest(&self, graph: &Graph) -> Option<usize> {
        let rows = self.matrix.iter();
        let mut rows: Vec<Vec<f64>> = rows
            .map(|row| row.iter().map(|&entry| self.value(graph, entry)).collect())
            .collect();
        let count = rows.len();
        for k in 0..count {
            let candidates = (k..count).flat_map(|i| (k..count).map(move |j| (i, j)));
            let size = |&(i, j): &(usize, usize)| rows[i][j].abs();
            let (i, j) = candidates.max_by(|a, b| size(a).total_cmp(&size(b)))?;
            if !self.is_pivot(rows[i][j]) {
                return Some(k);
            }
            rows.swap(k, i);
            rows.iter_mut().for_each(|row| row.swap(k, j));
            let pivot = rows[k].clone();
            for row in &mut rows[k + 1..] {
                let factor = row[k] / pivot[k];
                let pairs = row.iter_mut().zip(&pivot);
                pairs.for_each(|(entry, pivot)| *entry -= factor * pivot);
            }
        }
        None
    }

    /// An entry at the default parameters.
    fn value(&self, graph: &Graph, entry: ExprId) -> f64 {
        graph.evaluate(entry, &|symbol| match symbol {
            Symbol::Parameter(p) => self.defaults[p],
            Symbol::Coordinate(i) => self.at_rest.get(i).copied().unwrap_or(f64::NAN),
            _ => f64::NAN,
        })
    }

    /// Whether a value at rest and with the default parameters will do as a pivot: no statement about zero, but about
    /// digits in double precision, in which the system runs. Entries that vanish identically are found by proof.
    fn is_pivot(&self, value: f64) -> bool {
        value.is_finite() && value.abs() > SINGULAR * self.size
    }

    /// Where to go on; `None` if the rest of the matrix is singular.
    pub(super) fn pivot(&self, graph: &Graph) -> Option<Pivot> {
        let diagonal = |i: usize| self.value(graph, self.matrix[i][i]);
        let largest = self.rest.iter().map(|&i| diagonal(i).abs());
        let largest = largest.fold(0.0, f64::max);
        let fill = |i: usize| {
            let others = self.rest.iter().filter(|&&j| j != i);
            others
                .filter(|&&j| !graph.is_zero(self.matrix[i][j]))
                .count()
        };
        let one = self
            .rest
            .iter()
            .copied()
            .filter(|&i| {
                let value = diagonal(i);
                self.is_pivot(value) && value.abs() >= THRESHOLD * largest
            })
            .min_by_key(|&i| fill(i));
        if let Some(i) = one {
            return Some(Pivot::One(i));
        }
        let pairs = self.rest.iter().enumerate().flat_map(|(place, &i)| {
            let later = self.rest[place + 1..].iter();
            later.map(move |&j| (i, j))
        });
        pairs
            .filter(|&(i, j)| self.is_pivot(self.value(graph, self.matrix[i][j])))
            .min_by_key(|&(i, j)| fill(i) + fill(j))
            .map(|(i, j)| Pivot::Two(i, j))
    }

    /// Takes a pivot out of the rest; returns its part of H.
    pub(super) fn eliminate(&mut self, graph: &mut Graph, pivot: &Pivot) -> ExprId {
        let rows = match *pivot {
            Pivot::One(i) => vec![i],
            Pivot::Two(i, j) => vec![i, j],
        };
        self.rest.retain(|i| !rows.contains(i));
        let inverse = self.inverse(graph, &rows);
        let momenta: Vec<ExprId> = rows.iter().map(|&i| self.momenta[i]).collect();
        for place in 0..self.rest.len() {
            let i = self.rest[place];
            let left: Vec<ExprId> = rows.iter().map(|&p| self.matrix[i][p]).collect();
            if left.iter().all(|&entry| graph.is_zero(entry)) {
                continue;
            }
            let change = form(graph, &left, &inverse, &momenta);
            self.momenta[i] = graph.sub(self.momenta[i], change);
            for &j in &self.rest[place..] {
                let right: Vec<ExprId> = rows.iter().map(|&p| self.matrix[p][j]).collect();
                let change = form(graph, &left, &inverse, &right);
                if graph.is_zero(change) {
                    continue;
                }
                let mut entry = graph.sub(self.matrix[i][j], change);
                if vanishes(graph, entry) {
                    entry = graph.integer(0);
                }
                self.matrix[i][j] = entry;
                self.matrix[j][i] = entry;
            }
        }
        let value = form(graph, &momenta, &inverse, &momenta);
        graph.scale(value, &(&Rational::ONE / &Rational::from(2)))
    }

    /// The inverse of the block of one or two rows.
    fn inverse(&self, graph: &mut Graph, rows: &[usize]) -> Vec<Vec<ExprId>> {
        let power = Rational::MINUS_ONE;
        match *rows {
            [i, j] => {
                let (a, b, d) = (self.matrix[i][i], self.matrix[i][j], self.matrix[j][j]);
                let (diagonal, square) = (graph.mul(a, d), graph.mul(b, b));
                let determinant = graph.sub(diagonal, square);
                let inverse = graph.pow(determinant, &power);
                let minus = graph.neg(b);
                [[d, minus], [minus, a]]
                    .map(|row| row.map(|entry| graph.mul(entry, inverse)).to_vec())
                    .to_vec()
            }
            _ => rows
                .iter()
                .map(|&i| vec![graph.pow(self.matrix[i][i], &power)])
                .collect(),
        }
    }

    pub(super) fn singular(&self, lagrangian: &Lagrangian<'_>) -> Diagnostic {
        let names: Vec<String> = self
            .rest
            .iter()
            .map(|&i| format!("`{}`", lagrangian.velocity[i].text))
            .collect();
        let all = lagrangian.velocity.len();
        Diagnostic::new(
            Kind::Legendre,
            lagrangian.origin,
            format!(
                "the Lagrangian is singular at the default parameters: its Hessian has rank {} of {all}, \
                 and the momenta do not determine {}",
                all - self.rest.len(),
                names.join(", ")
            ),
        )
        .help("every component of the velocity needs a kinetic term; a degenerate system can be given by its Hamiltonian")
    }
}

/// `sum_pq left_p inverse_pq right_q`
fn form(graph: &mut Graph, left: &[ExprId], inverse: &[Vec<ExprId>], right: &[ExprId]) -> ExprId {
    let mut terms = Vec::new();
    for (&left, row) in left.iter().zip(inverse) {
        for (&right, &entry) in right.iter().zip(row) {
            terms.push(graph.product(&[left, entry, right]));
        }
    }
    graph.sum(&terms)
}

/// Whether an expression is shown to be zero.
fn vanishes(graph: &Graph, expression: ExprId) -> bool {
    let budget = Budget::new(WORK);
    let verdict = NormalForm::new(graph, &budget).verdict(expression);
    matches!(verdict, Verdict::Zero)
}
