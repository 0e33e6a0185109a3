//! Brackets that are constant after a change of each coordinate alone: `{x_i, x_j} = c_ij a_i(x_i) a_j(x_j)`.
//!
//! With `y_i = int dx_i/a_i(x_i)` the bracket is `{y_i, y_j} = c_ij`, and a function of y whose gradient is constant along its flow has the
//! flow `y -> y + t c grad_y`: by each coordinate that of `x' = s a(x)` over the time 1. Where every `a_i` is constant or linear, that is an
//! elementary map without poles; a quadratic `a_i` has solutions that are infinite after a time, which its closed form passes over in silence.
//! Those of degree 0 are constant brackets, and all `a_i = x_i` the log-canonical ones of the equations of Lotka and Volterra (M. Plank, Journal
//! of Mathematical Physics 36 (1995) 3520–3534, doi:10.1063/1.530978).

use crate::model::{Model, PoissonMatrix};
use lie_symbolic::exact::{Budget, Fraction, Polynomial, Rational};
use lie_symbolic::prove::proof::Prover;
use lie_symbolic::symbolic::{Elementary, ExprId, Graph, Symbol};

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

/// A polynomial `a(x) = a_0 + a_1 x` whose leading coefficient is 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Speed([Fraction; 2]);

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
        self.all(|speed| speed.degree() == 0)
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
        Self([number(1), number(0)])
    }

    /// Its degree.
    pub fn degree(&self) -> usize {
        usize::from(!self.0[1].is_zero())
    }

    /// Whether it is x.
    pub fn is_coordinate(&self) -> bool {
        self.degree() == 1 && self.0[0].is_zero()
    }

    /// `a_0`
    pub fn at_zero(&self) -> &Fraction {
        &self.0[0]
    }

    /// `a(x_i)` of degree 1 as a polynomial, parameter p the variable n + p.
    pub fn polynomial(&self, i: usize, n: usize) -> Option<Polynomial> {
        let constant = self.0[0].numerator().renamed(&|p| n + p);
        let sum = constant.sum(&Polynomial::variable(i), &Budget::new(WORK));
        sum.ok().filter(|_| self.degree() == 1)
    }

    /// `a(x)`
    pub fn at(&self, x: ExprId, graph: &mut Graph) -> ExprId {
        let terms = self.0.iter().zip(0..);
        let terms: Vec<ExprId> = terms
            .map(|(coefficient, k)| {
                let factor = graph.rational_function(coefficient);
                let power = graph.pow(x, &Rational::from(k));
                graph.mul(factor, power)
            })
            .collect();
        graph.sum(&terms)
    }

    /// The flow of `x' = s a(x)` over the time 1: of degree 1 it adds `a(x) (exp s - 1)`.
    pub fn flow(&self, x: ExprId, s: ExprId, graph: &mut Graph) -> Change {
        if self.degree() == 0 {
            return Change::Add(s);
        }
        let grown = graph.call(Elementary::Exp, &[s]);
        if self.is_coordinate() {
            return Change::Multiply(grown);
        }
        let one = graph.integer(1);
        let grown = graph.sub(grown, one);
        let speed = self.at(x, graph);
        Change::Add(graph.mul(speed, grown))
    }
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
    let coordinates = graph.coordinates(value);
    let numbers: Vec<(usize, ExprId)> = coordinates
        .into_iter()
        .map(|i| (i, graph.number(sample(i))))
        .collect();
    let value = graph.substitute(&[value], &|symbol| {
        let place = numbers
            .iter()
            .find(|(i, _)| symbol == Symbol::Coordinate(*i));
        place.map(|(_, number)| *number)
    })[0];
    graph.fraction(value, None)
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
        let x = [*i, *j].map(|k| graph.symbol(Symbol::Coordinate(k)));
        let [first, second] = [(*i, x[0]), (*j, x[1])].map(|(k, x)| speeds[k].at(x, graph));
        let product = graph.mul(first, second);
        let there = sampled(graph, product)?;
        let constant = sampled(graph, *entry)?.div(&there, &budget).ok()??;
        if there.as_constant().is_none() && !divides_by_numbers(&constant) {
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

/// The polynomial in a coordinate that an entry is a multiple of, where the others have their samples, if it is one of degree 1 at most: what
/// it is otherwise is found out when it is compared. None is divided by a parameter, which may be 0.
fn speed_in(graph: &mut Graph, entry: ExprId, i: usize, budget: &Budget) -> Option<Speed> {
    let slope = graph.derivative(entry, Symbol::Coordinate(i));
    let [value, slope] = [entry, slope].map(|value| sampled(graph, value));
    let (value, slope) = (value?, slope?);
    // value + slope (x - s)
    let low = value.sub(&slope.scale(&sample(i)), budget).ok()?;
    if slope.is_zero() {
        return Some(Speed::constant());
    }
    let ratio = low.div(&slope, budget).ok()??;
    divides_by_numbers(&ratio).then(|| Speed([ratio, number(1)]))
}

/// Whether a fraction is defined whatever the parameters are.
pub(super) fn divides_by_numbers(value: &Fraction) -> bool {
    value.denominator().next().is_none()
}

#[cfg(test)]
mod tests;
