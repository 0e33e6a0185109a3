//! Values of many digits, with rigorous bounds, at points on all sides of the branches.
//!
//! A verdict of the prover is confirmed by them: an expression that is zero has balls that contain zero at
//! every point of its domain. Rational functions are looked at in a prime field instead, which costs next to
//! nothing.

mod points;
mod residues;

use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::sync::OnceLock;

use super::sample::{Sample, Samples};
use crate::exact::{Ball, Precision, Rational};
use crate::symbolic::{Elementary, ExprId, Function, Graph, Node, Opaque, Symbol, chosen};
use points::Points;
use residues::Residues;

/// Bits of a ball: about 67 digits.
const BITS: u64 = 224;

/// Lines along which a degree is looked at, and degrees that are.
const LINES: usize = 16;
const HIGHEST: u32 = 12;

/// What the values say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finding {
    /// The function is zero at all points, as far as the digits reach.
    Zero,
    /// It is not zero at one of them, which is certain.
    Nonzero,
    /// No point was found in the domain.
    Unknown,
}

/// The values of the expressions of one arena at sample points.
pub struct Confirmation<'a> {
    graph: &'a Graph,
    domain: Vec<ExprId>,
    points: Points<'a>,
    residues: Residues<'a>,
    balls: HashMap<usize, HashMap<ExprId, Option<Ball>>>,
}

/// The precision of all balls here.
pub fn precision() -> &'static Precision {
    static PRECISION: OnceLock<Precision> = OnceLock::new();
    PRECISION.get_or_init(|| Precision::new(BITS))
}

impl<'a> Confirmation<'a> {
    /// Values of functions where those of `domain` are defined too.
    pub fn new(graph: &'a Graph, domain: &[ExprId]) -> Self {
        Self {
            graph,
            domain: domain.to_vec(),
            points: Points::new(graph),
            residues: Residues::new(graph),
            balls: HashMap::new(),
        }
    }

    /// What the values of an expression say.
    pub fn check_zero(&mut self, id: ExprId) -> Finding {
        if let Some(zero) = self.residues.vanishes(id) {
            return if zero {
                Finding::Zero
            } else {
                Finding::Nonzero
            };
        }
        let roots: Vec<ExprId> = self.domain.iter().copied().chain([id]).collect();
        let parts = self.graph.dependencies(&roots);
        let mut finding = Finding::Unknown;
        for point in self.points.select(&roots, &parts) {
            if !self.evaluate(&roots, &parts, point) {
                continue;
            }
            if let Some(Some(value)) = self.balls[&point].get(&id) {
                if value.excludes_zero() {
                    return Finding::Nonzero;
                }
                finding = Finding::Zero;
            }
        }
        finding
    }

    /// Whether an expression is a polynomial of a degree d in the coordinates along a line, as far as values
    /// tell: the difference of order d + 1 of its values at equal distances is zero.
    pub fn check_degree(&mut self, id: ExprId, degree: u32) -> Finding {
        if self.residues.vanishes(id).is_some() || degree > HIGHEST {
            return Finding::Zero;
        }
        let mut finding = Finding::Unknown;
        for sample in Samples::new().take(LINES) {
            match self.difference(id, sample, degree) {
                Some(value) if value.excludes_zero() => return Finding::Nonzero,
                Some(_) => finding = Finding::Zero,
                None => {}
            }
        }
        finding
    }

    /// Whether an expression that is no rational function is certainly no polynomial of any degree that is looked
    /// at: its difference on the first line where it is defined is not zero.
    pub fn is_no_polynomial(&mut self, id: ExprId) -> bool {
        if self.residues.vanishes(id).is_some() {
            return false;
        }
        let mut lines = Samples::new().take(LINES);
        let difference = lines.find_map(|sample| self.difference(id, sample, HIGHEST));
        difference.is_some_and(|value| value.excludes_zero())
    }

    /// The difference of order d + 1 on a line, where the expression is defined there.
    fn difference(&self, id: ExprId, sample: Sample, degree: u32) -> Option<Ball> {
        let graph = self.graph;
        let precision = precision();
        let (mut sum, mut weight) = (Ball::integer(0), Rational::ONE);
        let order = i64::from(degree) + 1;
        for step in 0..=order {
            let value = values(graph, &[id], &|symbol| {
                let (numerator, exponent) = sample.dyadic(graph, symbol);
                // short steps stay in the domain
                let shift = match symbol {
                    Symbol::Coordinate(_) => step * (1 + (sample.bits(symbol) >> 50) as i64 % 64),
                    _ => 0,
                };
                Some(Ball::dyadic(numerator + shift, exponent))
            })?
            .pop()?;
            sum = sum.add(
                &value.mul(&precision.rational(&weight), precision),
                precision,
            );
            let ratio = Rational::new(step - order, step + 1).unwrap_or(Rational::ZERO);
            weight = &weight * &ratio;
        }
        Some(sum)
    }

    /// Computes the balls at a point; whether all of them are defined.
    fn evaluate(&mut self, roots: &[ExprId], parts: &[ExprId], point: usize) -> bool {
        let graph = self.graph;
        let sample = self.points.sample(point);
        let known = self.balls.entry(point).or_default();
        for &part in parts {
            if !known.contains_key(&part) {
                let value = value(graph, part, known, &|symbol| {
                    let (numerator, exponent) = sample.dyadic(graph, symbol);
                    Some(Ball::dyadic(numerator, exponent))
                });
                known.insert(part, value);
            }
        }
        let negative = |id: ExprId| Some(known.get(&id)?.as_ref()?.sign()? < 0);
        let taken = match graph.has_choices() {
            true => Cow::from(graph.taken_dependencies(roots, &negative)),
            false => Cow::from(parts),
        };
        taken.iter().all(|part| known[part].is_some())
    }
}

/// The value of an expression without symbols; `None` where it has none, or too few digits to tell.
pub fn constant(graph: &Graph, id: ExprId) -> Option<Ball> {
    values(graph, &[id], &|_| None)?.pop()
}

/// The values of expressions; `None` where one of them has none, or too few digits to tell.
pub fn values(
    graph: &Graph,
    roots: &[ExprId],
    symbol: &dyn Fn(Symbol) -> Option<Ball>,
) -> Option<Vec<Ball>> {
    let mut known = HashMap::new();
    for part in graph.dependencies(roots) {
        let value = value(graph, part, &known, symbol)?;
        known.insert(part, Some(value));
    }
    roots.iter().map(|root| known[root].clone()).collect()
}

/// The ball of one node, those of its parts being known.
fn value(
    graph: &Graph,
    id: ExprId,
    known: &HashMap<ExprId, Option<Ball>>,
    symbol: &dyn Fn(Symbol) -> Option<Ball>,
) -> Option<Ball> {
    let precision = precision();
    let of = |id: &ExprId| known.get(id)?.as_ref();
    match graph.node(id) {
        Node::Number(value) => Some(precision.rational(value)),
        Node::Pi => Some(precision.pi()),
        Node::Symbol(name) => symbol(*name),
        Node::Sum { constant, terms } => {
            let mut sum = precision.rational(constant);
            for (term, coefficient) in terms {
                let part = of(term)?.mul(&precision.rational(coefficient), precision);
                sum = sum.add(&part, precision);
            }
            Some(sum)
        }
        // proofs are about normal forms
        Node::Written(_) => None,
        Node::Product(factors) => {
            let mut product = Ball::integer(1);
            for (base, exponent) in factors {
                let power = of(base)?.power(exponent, precision)?;
                product = product.mul(&power, precision);
            }
            product.bounded()
        }
        Node::Call(Function::Below, arguments) => {
            let negative = of(&arguments[0])?.sign()? < 0;
            of(&arguments[chosen(negative)]).cloned()
        }
        Node::Call(Function::Own(own), arguments) => {
            let arguments: Option<Vec<&Ball>> = arguments.iter().map(of).collect();
            stand_in(*own, &arguments?)
        }
        Node::Call(function, arguments) => {
            let x = of(&arguments[0])?;
            call(*function, x, arguments.get(1).and_then(of))
        }
    }
}

/// What holds for every function of a user holds for the one that stands in.
fn stand_in(own: Opaque, arguments: &[&Ball]) -> Option<Ball> {
    let precision = precision();
    let (phase, turns) = own.phase();
    let mut angle = precision.rational(&phase);
    for (place, argument) in arguments.iter().enumerate() {
        let part = argument.mul(&precision.rational(&Opaque::weight(place)), precision);
        angle = angle.add(&part, precision);
    }
    let (sine, cosine) = angle.sin_cos(precision)?;
    let turned = [sine.clone(), cosine.clone(), sine.neg(), cosine.neg()];
    let amplitude = precision.rational(&own.amplitude());
    Some(turned[usize::from(turns)].mul(&amplitude, precision))
}

fn call(function: Function, x: &Ball, second: Option<&Ball>) -> Option<Ball> {
    let precision = precision();
    match function {
        Function::Elementary(function) => x.function(function, precision),
        Function::Atan2 => x.atan2(second?, precision),
        Function::Stumpff(_) | Function::Phi(_) | Function::Below | Function::Own(_) => None,
    }
}

/// The nodes with branches among these, each by what changes its sign there.
fn branches(graph: &Graph, parts: &[ExprId]) -> Vec<ExprId> {
    let mut found = Vec::new();
    let mut seen = HashSet::new();
    let mut add = |id: ExprId| {
        let factors: Vec<ExprId> = match graph.node(id) {
            Node::Product(factors) => factors.iter().map(|(base, _)| *base).collect(),
            _ => vec![id],
        };
        found.extend(factors.into_iter().filter(|id| seen.insert(*id)));
    };
    for &id in parts {
        match graph.node(id) {
            Node::Symbol(_) => add(id),
            Node::Product(factors) => {
                let fractional = factors.iter().filter(|(_, e)| !e.is_integer());
                fractional.for_each(|(base, _)| add(graph.coefficient(*base).1));
            }
            Node::Call(
                Function::Elementary(Elementary::Log | Elementary::Cbrt) | Function::Atan2,
                arguments,
            ) => {
                let parts = arguments.iter();
                parts.for_each(|argument| add(graph.coefficient(*argument).1));
            }
            Node::Call(Function::Below, arguments) => add(graph.coefficient(arguments[0]).1),
            _ => {}
        }
    }
    found
}

#[cfg(test)]
mod tests;
