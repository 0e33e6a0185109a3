//! Brackets that are constant after a change of each coordinate alone: `{x_i, x_j} = c_ij a_i(x_i) a_j(x_j)`.
//!
//! With `y_i = int dx_i/a_i(x_i)` the bracket is `{y_i, y_j} = c_ij`, where that integral is closed ([`Closed`]). A function of y whose gradient is
//! constant along its flow has the flow `y -> y + t c grad_y`: by each coordinate that of `x' = s a(x)` over the time 1. Where every `a_i` is
//! constant or linear, that is an elementary map without poles; others have solutions that are infinite after a time, which their closed
//! forms pass over in silence.
//! Those of degree 0 are constant brackets, and all `a_i = x_i` the log-canonical ones of the equations of Lotka and Volterra (M. Plank, Journal
//! of Mathematical Physics 36 (1995) 3520–3534, doi:10.1063/1.530978).

mod closed;
mod partial_fractions;

pub use closed::{Closed, Side};
pub(super) use partial_fractions::{half, logarithm};

use super::found::additive;
use crate::model::{Model, PoissonMatrix};
use lie_symbolic::exact::{Budget, Fraction, Polynomial, Rational};
use lie_symbolic::prove::proof::Prover;
use lie_symbolic::symbolic::{Elementary, ExprId, Graph, Node, Symbol};

/// Work allowed for the proof that a bracket is such a one.
const WORK: u64 = 2_000_000;

/// A bracket `{x_i, x_j} = c_ij a_i(x_i) a_j(x_j)`.
#[derive(Clone, Debug)]
pub struct Elementwise {
    /// The `a_i`, one for each coordinate.
    pub speeds: Vec<Speed>,
    /// The rows of c.
    pub constants: Vec<Vec<Fraction>>,
}

/// A function `a(x)` of one coordinate, without the factors that are free of it.
#[derive(Clone, Debug, PartialEq)]
pub enum Speed {
    /// A polynomial `a_0 + a_1 x` whose leading coefficient is 1.
    Affine([Fraction; 2]),
    /// Another function, in the arena in which it was found.
    Other(Closed),
}

/// What the flow of a piece does with a coordinate.
#[derive(Clone, Copy, Debug)]
pub enum Change {
    /// This is added to it.
    Add(ExprId),
    /// It is multiplied by this.
    Multiply(ExprId),
}

impl Elementwise {
    /// Whether a coordinate is in a bracket; of others there is no speed.
    pub fn moves(&self, i: usize) -> bool {
        self.constants[i].iter().any(|c| !c.is_zero())
    }

    /// Whether the bracket is constant as it is.
    pub fn is_constant(&self) -> bool {
        self.all(Speed::is_constant)
    }

    /// Whether every speed is constant or linear.
    pub fn is_affine(&self) -> bool {
        self.all(|speed| matches!(speed, Speed::Affine(_)))
    }

    /// The speeds in brackets that are neither constant nor linear.
    pub fn closed(&self) -> impl Iterator<Item = &Closed> {
        let speeds = self.speeds.iter().enumerate();
        speeds.filter_map(|(i, speed)| match speed {
            Speed::Other(closed) if self.moves(i) => Some(closed),
            _ => None,
        })
    }

    /// Whether something holds of all speeds.
    pub fn all(&self, of: fn(&Speed) -> bool) -> bool {
        let mut speeds = self.speeds.iter().enumerate();
        speeds.all(|(i, speed)| of(speed) || !self.moves(i))
    }
}

fn number(value: i64) -> Fraction {
    Fraction::from(Rational::from(value))
}

impl Speed {
    fn constant() -> Self {
        Self::Affine([number(1), number(0)])
    }

    /// Whether it is 1.
    pub fn is_constant(&self) -> bool {
        matches!(self, Self::Affine([_, slope]) if slope.is_zero())
    }

    /// `a_0` of degree 1.
    pub fn linear(&self) -> Option<&Fraction> {
        match self {
            Self::Affine([at_zero, slope]) if !slope.is_zero() => Some(at_zero),
            _ => None,
        }
    }

    /// Whether it is x.
    pub fn is_coordinate(&self) -> bool {
        self.linear().is_some_and(Fraction::is_zero)
    }

    /// `a(x_i)` of degree 1 as a polynomial, parameter p the variable n + p.
    pub fn polynomial(&self, i: usize, n: usize) -> Option<Polynomial> {
        let constant = self.linear()?.numerator().renamed(&|p| n + p);
        let sum = constant.sum(&Polynomial::variable(i), &Budget::new(WORK));
        sum.ok()
    }

    /// `a(x_i)`
    pub fn at(&self, i: usize, graph: &mut Graph) -> ExprId {
        let x = graph.symbol(Symbol::Coordinate(i));
        match self {
            Self::Affine(coefficients) => affine(coefficients, x, graph),
            Self::Other(closed) => closed.speed,
        }
    }

    /// The flow of `x_i' = s a(x_i)` over the time 1, of degree 1 at most: of degree 1 it adds `a(x) (exp s - 1)`.
    pub fn flow(&self, i: usize, s: ExprId, graph: &mut Graph) -> Option<Change> {
        if self.is_constant() {
            return Some(Change::Add(s));
        }
        self.linear()?;
        let grown = graph.call(Elementary::Exp, &[s]);
        if self.is_coordinate() {
            return Some(Change::Multiply(grown));
        }
        let one = graph.integer(1);
        let grown = graph.sub(grown, one);
        let speed = self.at(i, graph);
        Some(Change::Add(graph.mul(speed, grown)))
    }
}

/// `a_0 + a_1 x`
pub(super) fn affine(coefficients: &[Fraction; 2], x: ExprId, graph: &mut Graph) -> ExprId {
    let [at_zero, slope] = coefficients
        .each_ref()
        .map(|coefficient| graph.rational_function(coefficient));
    let moved = graph.mul(slope, x);
    graph.add(at_zero, moved)
}

/// An expression at the declared initial state and parameters; none without one.
pub(super) fn at_start(model: &Model, graph: &Graph, value: ExprId) -> Option<f64> {
    let parameters = model.defaults();
    let initial = model.initial_values(&parameters)?;
    Some(graph.evaluate(value, &|symbol| match symbol {
        Symbol::Coordinate(i) => initial[i],
        Symbol::Parameter(p) => parameters[p],
        _ => f64::NAN,
    }))
}

/// A coordinate away from others, and from zeros of speeds that anybody declares.
pub(super) fn sample(coordinate: usize) -> Rational {
    let place = coordinate as i64;
    Rational::new(10 * place + 17, 6 * place + 13).unwrap_or(Rational::ONE)
}

/// An expression where all coordinates have their samples.
pub(super) fn sampled(graph: &mut Graph, value: ExprId) -> Option<Fraction> {
    let value = sampled_value(graph, value);
    graph.fraction(value, None)
}

fn sampled_value(graph: &mut Graph, value: ExprId) -> ExprId {
    with_samples(graph, value, None)
}

/// The same, one coordinate left as it is.
fn with_samples(graph: &mut Graph, value: ExprId, but: Option<usize>) -> ExprId {
    let coordinates = graph.coordinates(value).into_iter();
    let numbers: Vec<(usize, ExprId)> = coordinates
        .filter(|i| Some(*i) != but)
        .map(|i| (i, graph.number(sample(i))))
        .collect();
    graph.substitute(&[value], &|symbol| {
        let place = numbers
            .iter()
            .find(|(i, _)| symbol == Symbol::Coordinate(*i));
        place.map(|(_, number)| *number)
    })[0]
}

/// Whether expressions vanish identically, where those of a domain are defined.
pub(super) fn vanish(
    model: &Model,
    graph: &Graph,
    domain: &[ExprId],
    values: &[ExprId],
    budget: &Budget,
) -> bool {
    let name = |symbol| model.symbol_name(symbol);
    let mut prover = Prover::new(graph, budget, domain, &name);
    values
        .iter()
        .all(|value| graph.is_zero(*value) || prover.vanishes(*value))
}

/// The form of a bracket, where it is such a one; `graph` may be littered.
pub fn elementwise(
    model: &Model,
    matrix: &PoissonMatrix,
    graph: &mut Graph,
) -> Option<Elementwise> {
    let n = matrix.dimension;
    let budget = Budget::new(WORK);
    let mut speeds = vec![Speed::constant(); n];
    for (i, speed) in speeds.iter_mut().enumerate() {
        let entry = matrix.entries.iter().find(|(a, b, _)| i == *a || i == *b);
        if let Some((.., entry)) = entry {
            *speed = speed_in(graph, *entry, i, &budget)?;
        }
    }
    let zero = number(0);
    let mut constants = vec![vec![zero; n]; n];
    let mut differences = Vec::new();
    for (i, j, entry) in &matrix.entries {
        let [first, second] = [*i, *j].map(|k| speeds[k].at(k, graph));
        let product = graph.mul(first, second);
        let there = sampled_value(graph, product);
        if graph.is_zero(there) {
            return None;
        }
        let ratio = graph.div(*entry, product);
        let constant = sampled(graph, ratio)?;
        let divides = graph.symbols(there).is_empty() || divides_by_numbers(&constant);
        if !divides {
            return None;
        }
        let factor = graph.rational_function(&constant);
        let product = graph.mul(factor, product);
        differences.push(graph.sub(*entry, product));
        constants[*j][*i] = constant.neg();
        constants[*i][*j] = constant;
    }
    let entries: Vec<ExprId> = matrix.entries.iter().map(|(.., entry)| *entry).collect();
    vanish(model, graph, &entries, &differences, &budget)
        .then_some(Elementwise { speeds, constants })
}

/// The function of a coordinate that an entry is a multiple of, where the others have their samples, if it is one with a closed integral: what it
/// is otherwise is found out when it is compared. None is divided by a parameter, which may be 0.
fn speed_in(graph: &mut Graph, entry: ExprId, i: usize, budget: &Budget) -> Option<Speed> {
    let alone = with_samples(graph, entry, Some(i));
    let value = without_constants(graph, alone)?;
    let slope = graph.derivative(value, Symbol::Coordinate(i));
    let slope = graph.normal(slope);
    if !graph.coordinates(slope).is_empty() {
        return closed::closed(graph, value, i).map(Speed::Other);
    }
    let [value, slope] = [value, slope].map(|value| sampled(graph, value));
    let (value, slope) = (value?, slope?);
    // value + slope (x - s)
    let low = value.sub(&slope.scale(&sample(i)), budget).ok()?;
    if slope.is_zero() {
        return Some(Speed::constant());
    }
    let ratio = low.div(&slope, budget).ok()??;
    divides_by_numbers(&ratio).then(|| Speed::Affine([ratio, number(1)]))
}

/// An expression without the factors of its first term that are free of coordinates, as are functions of samples.
fn without_constants(graph: &mut Graph, value: ExprId) -> Option<ExprId> {
    let (constant, mut terms) = additive::collected(graph, value)?;
    if !constant.is_zero() {
        terms.push(graph.number(constant));
    }
    let (number, product) = graph.coefficient(*terms.first()?);
    let mut fixed = factors(graph, product);
    fixed.retain(|(base, _)| graph.coordinates(*base).is_empty());
    for (_, exponent) in &mut fixed {
        *exponent = &*exponent * &Rational::from(-1);
    }
    let inverse = graph.power_product(&fixed);
    let inverse = graph.scale(inverse, &number.recip()?);
    let divided: Vec<ExprId> = terms.iter().map(|term| graph.mul(*term, inverse)).collect();
    Some(graph.sum(&divided))
}

/// The factors of a product, with their exponents.
pub(super) fn factors(graph: &Graph, product: ExprId) -> Vec<(ExprId, Rational)> {
    match graph.node(product) {
        Node::Product(factors) => factors.to_vec(),
        Node::Number(_) => Vec::new(),
        _ => vec![(product, Rational::ONE)],
    }
}

/// Whether a fraction is defined whatever the parameters are.
pub(super) fn divides_by_numbers(value: &Fraction) -> bool {
    value.denominator().next().is_none()
}

#[cfg(test)]
mod tests;
