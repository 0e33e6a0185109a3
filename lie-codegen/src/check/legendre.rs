//! The Legendre transform of a reduced Lagrangian: `mu = dl/dxi`, `H(mu) = <mu, xi> - l(xi)`.
//!
//! For `l = <A xi, xi>/2 + <b, xi> + c` with a symmetric matrix A it is
//! `H = <A^-1 (mu - b), mu - b>/2 - c`, by elimination in the order `A = L D L^T`: a sum of squares over
//! pivots. Where the diagonal is zero, as in `l = xi1 xi2`, a pivot is a block of two rows.
//!
//! A Lagrangian that is not quadratic, or not shown to be, has no such expression: the velocity of a momentum is
//! found by Newton's iteration, here ([`super::velocity`]) and in generated code. The iteration begins at rest,
//! where l must be finite and regular.

use super::configuration::Configuration;
use super::normal::{NormalForm, Verdict};
use crate::ast::Name;
use crate::diagnostic::{Diagnostic, Kind, Origin, Report};
use crate::exact::{Budget, Rational};
use crate::model::Parameter;
use crate::symbolic::{ExprId, Graph, Symbol};

/// Work allowed for one decision of the normal form.
const WORK: u64 = 2_000_000;
/// A pivot below that part of the largest entry at the default parameters is none.
const SINGULAR: f64 = 1e-13;
/// A pivot that is that much smaller than the largest may stand for it, if it causes less fill-in.
const THRESHOLD: f64 = 0.1;

/// A lowered Lagrangian; the components of the velocity are [`Symbol::Input`].
pub struct Lagrangian<'a> {
    /// The function.
    pub value: ExprId,
    /// Names of the components of the velocity.
    pub velocity: &'a [Name],
    /// Where the function stands.
    pub origin: Origin,
    /// The parameters with their defaults.
    pub parameters: &'a [Parameter],
    /// The group element and the time, where the Lagrangian depends on them.
    pub configuration: Option<&'a Configuration>,
    /// Whether the velocity is an element of an algebra and the bracket the Lie–Poisson one, so that a Newton
    /// iteration for it can be generated.
    pub on_algebra: bool,
}

impl Lagrangian<'_> {
    /// A coordinate at rest, where the coefficients are looked at: mu is 0, the group element 1.
    fn at_rest(&self, coordinate: usize) -> f64 {
        self.configuration
            .map_or(0.0, |configuration| configuration.at_rest(coordinate))
    }
}

/// The Hamiltonian of a Lagrangian.
pub enum Transform {
    /// In the coordinates of mu.
    Exact(ExprId),
    /// Of a Lagrangian that is not quadratic, in mu and its velocity: `<mu, xi> - l(xi)`.
    InVelocity(ExprId),
}

/// The Legendre transform.
///
/// # Errors
/// `legendre`, reported, for a Lagrangian that is singular or has no value at rest.
pub fn hamiltonian(
    graph: &mut Graph,
    lagrangian: &Lagrangian<'_>,
    report: &mut Report,
) -> Option<Transform> {
    let (mut form, quadratic) = match Quadratic::of(graph, lagrangian) {
        Ok(form) => form,
        Err(diagnostic) => {
            report.push(*diagnostic);
            return None;
        }
    };
    if !quadratic {
        if !lagrangian.on_algebra {
            report.push(not_quadratic(lagrangian));
            return None;
        }
        if let Some(rank) = form.rank_at_rest(graph) {
            report.push(singular_at_rest(lagrangian, rank));
            return None;
        }
        return Some(Transform::InVelocity(in_velocity(graph, lagrangian)));
    }
    let mut terms = Vec::new();
    while !form.rest.is_empty() {
        let Some(pivot) = form.pivot(graph) else {
            report.push(form.singular(lagrangian));
            return None;
        };
        terms.push(form.eliminate(graph, &pivot));
    }
    let constant = graph.neg(form.constant);
    terms.push(constant);
    Some(Transform::Exact(graph.sum(&terms)))
}

/// `<mu, xi> - l(xi)`
fn in_velocity(graph: &mut Graph, lagrangian: &Lagrangian<'_>) -> ExprId {
    let mut terms = vec![graph.neg(lagrangian.value)];
    for i in 0..lagrangian.velocity.len() {
        let mu = graph.symbol(Symbol::Coordinate(i));
        let xi = graph.symbol(Symbol::Input(i));
        terms.push(graph.mul(mu, xi));
    }
    graph.sum(&terms)
}

/// `<A xi, xi>/2 + <b, xi> + c`, partly eliminated.
struct Quadratic {
    matrix: Vec<Vec<ExprId>>,
    /// `mu - b`, later `L^-1` of it.
    momenta: Vec<ExprId>,
    constant: ExprId,
    /// Rows that are not eliminated.
    rest: Vec<usize>,
    defaults: Vec<f64>,
    /// The coordinates at rest, as far as any are beside mu.
    at_rest: Vec<f64>,
    /// The largest entry at the default parameters.
    size: f64,
}

/// One row, or two whose block is inverted.
enum Pivot {
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
    fn of(graph: &mut Graph, lagrangian: &Lagrangian<'_>) -> Result<(Self, bool), Box<Diagnostic>> {
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
            return Err(Box::new(not_at_rest(lagrangian)));
        }
        form.size = entries
            .map(|&entry| form.value(graph, entry).abs())
            .fold(0.0, f64::max);
        Ok((form, quadratic))
    }

    /// The rank of the Hessian at rest with the default parameters, if it is not full.
    fn rank_at_rest(&self, graph: &Graph) -> Option<usize> {
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
    fn pivot(&self, graph: &Graph) -> Option<Pivot> {
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
    fn eliminate(&mut self, graph: &mut Graph, pivot: &Pivot) -> ExprId {
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

    fn singular(&self, lagrangian: &Lagrangian<'_>) -> Diagnostic {
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

fn not_at_rest(lagrangian: &Lagrangian<'_>) -> Diagnostic {
    Diagnostic::new(
        Kind::Legendre,
        lagrangian.origin,
        "the Lagrangian or one of its first two derivatives is not finite at rest with the default parameters, \
         where its Legendre transform begins",
    )
    .help("write it so that it is smooth at rest, or give the Hamiltonian `H(mu) = <mu, xi> - l(xi)`")
}

fn singular_at_rest(lagrangian: &Lagrangian<'_>, rank: usize) -> Diagnostic {
    let all = lagrangian.velocity.len();
    Diagnostic::new(
        Kind::Legendre,
        lagrangian.origin,
        format!(
            "the Lagrangian is singular at rest with the default parameters: its Hessian has rank {rank} of {all} \
             there, where the iteration for the velocity of a momentum begins"
        ),
    )
    .help("every component of the velocity needs a quadratic kinetic term; else give the Hamiltonian `H(mu) = <mu, xi> - l(xi)`")
}

fn not_quadratic(lagrangian: &Lagrangian<'_>) -> Diagnostic {
    Diagnostic::new(
        Kind::Legendre,
        lagrangian.origin,
        "the Lagrangian is not quadratic in the velocity, or could not be shown to be, and it depends on the group \
         element or the time, or the bracket is not that of an algebra",
    )
    .help("the Legendre transform of such Lagrangians is not built yet; give the Hamiltonian `H(mu) = <mu, xi> - l(xi)`")
}
