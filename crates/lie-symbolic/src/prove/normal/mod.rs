//! A normal form that proves expressions to be zero: rational functions over atoms.
//!
//! An identity is one that holds wherever everything in it is real and defined (but for sets without inner
//! points), so that `exp(log(-x)) = -x` is one and `exp(log(x^2)/2) = x` is none: that is |x|.
//!
//! Atoms are symbols, pi, the imaginary unit, exponentials, roots, logarithms, signs and the functions
//! that have no simpler form. Exponentials are written in a basis of exponents that is linearly
//! independent over the rationals, so that `exp(a) exp(b) = exp(a + b)` holds by itself, and with
//! `sin a = (exp(i a) - exp(-i a))/(2 i)` the identities of the trigonometric and hyperbolic
//! functions hold too. Roots and logarithms are those of the absolute values of factors (see `factors`), which
//! are the factors times their signs (see `signs`).
//!
//! What is found to be zero is zero: every such verdict is confirmed at points of both signs in many digits
//! (see `confirmation`), and where no point is found in the domain, nothing is decided. What is not found to be
//! zero may be zero still where atoms other than symbols are left: then nothing is decided either.

mod angles;
mod atoms;
mod exponentials;
mod factors;
mod primes;
mod reduce;
mod signs;

use std::collections::{BTreeSet, HashMap};

use super::confirmation::{Confirmation, Finding};
use crate::exact::{Budget, Exhausted, Fraction, Polynomial, Rational};
use crate::symbolic::{Elementary, ExprId, Function, Graph, Node, Symbol};
use atoms::Atom;
use signs::{Fact, Relations, facts};

/// What the normal form says of an expression.
#[derive(Clone, Debug)]
pub enum Verdict {
    /// It is identically zero.
    Zero,
    /// It is not: a rational function of symbols that is not zero.
    Nonzero(Fraction),
    /// Neither could be shown.
    Undecided,
    /// The prover says that it is zero, and it is not: a mistake of the compiler, which is kept for the report.
    Contradicted,
}

/// Why a conversion ends early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stop {
    /// The budget is spent.
    Exhausted,
    /// An atom needs a finer root; its scale is set, and the conversion starts again.
    Refine,
    /// Something is divided by zero, or not real.
    Undefined,
}

impl From<Exhausted> for Stop {
    fn from(_: Exhausted) -> Self {
        Stop::Exhausted
    }
}

/// How often the conversion may start again with finer roots.
const REFINEMENTS: usize = 32;

/// Conversion of the expressions of one arena.
pub struct NormalForm<'a> {
    graph: &'a Graph,
    budget: &'a Budget,
    atoms: Vec<Atom>,
    /// Denominators of the exponents of exponentials and roots, in the order of their creation.
    scales: Vec<i64>,
    values: HashMap<ExprId, Fraction>,
    /// Functions of which the domain is looked at, and nothing beyond it.
    domain: Vec<ExprId>,
    /// What is known on the domain.
    facts: BTreeSet<(ExprId, Fact)>,
    /// Whether the relations say what follows from the facts.
    established: bool,
    relations: Relations,
    confirmation: Confirmation<'a>,
}

impl<'a> NormalForm<'a> {
    /// A conversion that knows nothing yet.
    pub fn new(graph: &'a Graph, budget: &'a Budget) -> Self {
        Self::with_domain(graph, budget, &[])
    }

    /// A conversion of functions on the domain where these are real and defined too: of derivatives on that of
    /// the function.
    pub fn with_domain(graph: &'a Graph, budget: &'a Budget, domain: &[ExprId]) -> Self {
        Self {
            graph,
            budget,
            atoms: Vec::new(),
            scales: Vec::new(),
            values: HashMap::new(),
            domain: domain.to_vec(),
            facts: facts(graph, domain),
            established: false,
            relations: Relations::default(),
            confirmation: Confirmation::new(graph, domain),
        }
    }

    /// Whether an expression is identically zero.
    pub fn verdict(&mut self, id: ExprId) -> Verdict {
        match self.unconfirmed(id) {
            Verdict::Zero => match self.confirmation.check_zero(id) {
                Finding::Zero => Verdict::Zero,
                Finding::Unknown => Verdict::Undecided,
                Finding::Nonzero => {
                    super::contradiction::keep(self.graph, id);
                    Verdict::Contradicted
                }
            },
            other => other,
        }
    }

    /// Whether an expression is not zero at some point of the domain, by rigorous bounds.
    pub fn finding(&mut self, id: ExprId) -> Finding {
        self.confirmation.check_zero(id)
    }

    /// The verdict of the normal form alone.
    fn unconfirmed(&mut self, id: ExprId) -> Verdict {
        self.enter(id);
        self.refined(|form| form.decide(id))
            .unwrap_or(Verdict::Undecided)
    }

    /// Takes up the facts of the domain of an expression, in place of those of the one before.
    fn enter(&mut self, id: ExprId) {
        let mut roots = self.domain.clone();
        roots.push(id);
        let facts = facts(self.graph, &roots);
        if facts != self.facts {
            self.forget();
            self.facts = facts;
        }
    }

    fn forget(&mut self) {
        self.atoms.clear();
        self.values.clear();
        self.relations.clear();
        self.established = false;
    }

    /// Does something, again with finer roots as long as it asks for them.
    fn refined<T>(&mut self, work: impl Fn(&mut Self) -> Result<T, Stop>) -> Option<T> {
        for _ in 0..REFINEMENTS {
            match work(self) {
                Ok(value) => return Some(value),
                Err(Stop::Refine) => self.forget(),
                Err(Stop::Exhausted | Stop::Undefined) => return None,
            }
        }
        None
    }

    /// Whether an expression is shown to be nowhere negative: all terms of its normal form have that sign.
    pub fn is_nonnegative(&mut self, id: ExprId) -> bool {
        self.enter(id);
        let negative = self.refined(|form| {
            form.establish()?;
            let value = form.convert(id)?;
            let value = form.reduce(&value)?;
            Ok(form.known_sign(&value))
        });
        matches!(negative, Some(Some(false))) || matches!(self.verdict(id), Verdict::Zero)
    }

    /// The total degree in the coordinates, if the expression is a polynomial in them.
    pub fn degree(&mut self, id: ExprId) -> Option<u32> {
        let degree = self.unconfirmed_degree(id)?;
        match self.confirmation.check_degree(id, degree) {
            Finding::Zero => Some(degree),
            Finding::Unknown => None,
            Finding::Nonzero => {
                super::contradiction::keep(self.graph, id);
                None
            }
        }
    }

    fn unconfirmed_degree(&mut self, id: ExprId) -> Option<u32> {
        self.enter(id);
        let value = self.refined(|form| {
            form.establish()?;
            let value = form.convert(id)?;
            form.reduce(&value)
        })?;
        if !value
            .denominator()
            .all(|(factor, _)| self.is_constant(factor))
        {
            return None;
        }
        let coordinate = |v: usize| matches!(self.atoms[v], Atom::Symbol(Symbol::Coordinate(_)));
        let mut degree = 0;
        for (monomial, _) in value.numerator().terms() {
            if !monomial
                .powers()
                .all(|(v, _)| coordinate(v) || self.is_constant(&Polynomial::variable(v)))
            {
                return None;
            }
            degree = degree.max(
                monomial
                    .powers()
                    .filter(|(v, _)| coordinate(*v))
                    .map(|(_, e)| e)
                    .sum(),
            );
        }
        Some(degree)
    }

    /// The rational function as text.
    pub fn display(&self, value: &Fraction, name: &dyn Fn(Symbol) -> String) -> String {
        value.display(&|v| match &self.atoms[v] {
            Atom::Symbol(symbol) => name(*symbol),
            Atom::Pi => "pi".into(),
            _ => "…".into(),
        })
    }

    fn decide(&mut self, id: ExprId) -> Result<Verdict, Stop> {
        self.establish()?;
        let value = self.convert(id)?;
        if value.is_zero() {
            return Ok(Verdict::Zero);
        }
        let value = self.reduce(&value)?;
        if value.is_zero() {
            return Ok(Verdict::Zero);
        }
        Ok(if self.is_plain(&value) {
            Verdict::Nonzero(value)
        } else {
            Verdict::Undecided
        })
    }

    fn convert(&mut self, id: ExprId) -> Result<Fraction, Stop> {
        if let Some(value) = self.values.get(&id) {
            return Ok(value.clone());
        }
        let graph = self.graph;
        for node in graph.dependencies(&[id]) {
            if !self.values.contains_key(&node) {
                let value = self.convert_node(node)?;
                self.values.insert(node, value);
            }
        }
        Ok(self.values[&id].clone())
    }

    fn convert_node(&mut self, id: ExprId) -> Result<Fraction, Stop> {
        let graph = self.graph;
        match graph.node(id) {
            Node::Number(value) => Ok(value.clone().into()),
            Node::Pi => Ok(Fraction::variable(self.atom(Atom::Pi))),
            Node::Symbol(symbol) => Ok(Fraction::variable(self.atom(Atom::Symbol(*symbol)))),
            Node::Sum { constant, terms } => {
                // Polynomial terms are collected in place, which matters for long sums.
                let mut polynomial = Polynomial::constant(constant.clone());
                let mut sum = Fraction::default();
                for (term, coefficient) in terms {
                    let value = &self.values[term];
                    if value.denominator().next().is_some() {
                        sum = sum.add(&value.scale(coefficient), self.budget)?;
                        continue;
                    }
                    self.budget.spend(value.numerator().terms().len() as u64)?;
                    for (monomial, factor) in value.numerator().terms() {
                        polynomial.accumulate(monomial.clone(), &(factor * coefficient));
                    }
                }
                Ok(sum.add(&polynomial.into(), self.budget)?)
            }
            Node::Written(terms) => {
                let mut sum = Fraction::default();
                for (term, coefficient) in terms {
                    sum = sum.add(&self.values[term].scale(coefficient), self.budget)?;
                }
                Ok(sum)
            }
            Node::Product(factors) => {
                let mut product = Fraction::from(Rational::ONE);
                for (base, exponent) in factors {
                    let power = match exponent.to_integer() {
                        Some(integer) => {
                            let base = self.values[base].clone();
                            self.integer_power(&base, integer)?
                        }
                        None => self.fractional_power(*base, exponent)?,
                    };
                    product = product.mul(&power, self.budget)?;
                }
                Ok(product)
            }
            Node::Call(Function::Elementary(Elementary::Log), arguments) => {
                self.logarithm(arguments[0])
            }
            Node::Call(Function::Below, arguments) => self.choice(arguments),
            Node::Call(
                Function::Elementary(
                    function @ (Elementary::Sin | Elementary::Cos | Elementary::Tan),
                ),
                arguments,
            ) => {
                let power = self.rotation_of(arguments[0])?;
                self.circular(*function, &power)
            }
            Node::Call(function, arguments) => {
                let arguments: Vec<Fraction> =
                    arguments.iter().map(|a| self.values[a].clone()).collect();
                self.call(*function, &arguments)
            }
        }
    }

    /// `below(g, a, b) = (a + b)/2 + s (b - a)/2` with the sign s of g; what is on the joint has no inner points.
    fn choice(&mut self, arguments: &[ExprId]) -> Result<Fraction, Stop> {
        let [condition, a, b] = [0, 1, 2].map(|place| self.values[&arguments[place]].clone());
        let values = [condition, a, b];
        if values.iter().any(|value| self.is_complex(value)) {
            return self.opaque(Function::Below, &values);
        }
        let [condition, a, b] = values;
        if self.vanishes(&condition)? {
            return Ok(b);
        }
        let half = &Rational::ONE / &Rational::from(2);
        let sign = self.sign(&condition)?.value();
        let (sum, difference) = (a.add(&b, self.budget)?, b.sub(&a, self.budget)?);
        let turned = difference.mul(&sign, self.budget)?;
        Ok(sum.add(&turned, self.budget)?.scale(&half))
    }

    fn call(&mut self, function: Function, arguments: &[Fraction]) -> Result<Fraction, Stop> {
        let half = &Rational::ONE / &Rational::from(2);
        let argument = &arguments[0];
        let Function::Elementary(elementary) = function else {
            return self.opaque(function, arguments);
        };
        match elementary {
            Elementary::Exp => self.exponential(argument),
            Elementary::Expm1 => {
                let power = self.exponential(argument)?;
                Ok(power.sub(&Rational::ONE.into(), self.budget)?)
            }
            Elementary::Sinh | Elementary::Cosh | Elementary::Tanh => {
                let power = self.exponential(argument)?;
                let inverse = self.reciprocal(&power)?;
                let difference = power.sub(&inverse, self.budget)?;
                let sum = power.add(&inverse, self.budget)?;
                match elementary {
                    Elementary::Sinh => Ok(difference.scale(&half)),
                    Elementary::Cosh => Ok(sum.scale(&half)),
                    _ => Ok(difference.mul(&self.reciprocal(&sum)?, self.budget)?),
                }
            }
            odd if odd.is_odd() && argument.numerator().content().is_negative() => {
                Ok(self.call(function, &[argument.neg()])?.neg())
            }
            other => {
                let value = argument.as_constant();
                match value.and_then(|value| self.known_angle(other, &value)) {
                    Some(angle) => Ok(angle),
                    None => self.opaque(function, arguments),
                }
            }
        }
    }

    /// Sine, cosine or tangent of an angle a from `exp(i a)`.
    fn circular(&mut self, function: Elementary, power: &Fraction) -> Result<Fraction, Stop> {
        let half = &Rational::ONE / &Rational::from(2);
        let unit = self.unit();
        let inverse = self.reciprocal(power)?;
        let sum = power.add(&inverse, self.budget)?;
        // 1/i = -i
        let difference = power
            .sub(&inverse, self.budget)?
            .mul(&unit.neg(), self.budget)?;
        match function {
            Elementary::Sin => Ok(difference.scale(&half)),
            Elementary::Cos => Ok(sum.scale(&half)),
            _ => Ok(difference.mul(&self.reciprocal(&sum)?, self.budget)?),
        }
    }
}

#[cfg(test)]
mod tests;
