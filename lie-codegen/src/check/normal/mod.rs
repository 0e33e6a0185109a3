//! A normal form that proves expressions to be zero: rational functions over atoms.
//!
//! Atoms are symbols, pi, the imaginary unit, exponentials, roots, logarithms and the functions
//! that have no simpler form. Exponentials are written in a basis of exponents that is linearly
//! independent over the rationals, so that `exp(a) exp(b) = exp(a + b)` holds by itself, and with
//! `sin a = (exp(i a) - exp(-i a))/(2 i)` the identities of the trigonometric and hyperbolic
//! functions hold too. Roots obey `r^q = base`, logarithms are taken apart by factors.
//!
//! What is found to be zero is zero. What is not may be zero still where atoms other than symbols
//! are left: then nothing is decided.

mod atoms;
mod exponentials;
mod logarithms;
mod primes;
mod reduce;
mod roots;

use std::collections::HashMap;

use crate::exact::{Budget, Exhausted, Fraction, Polynomial, Rational};
use crate::symbolic::{ExprId, Function, Graph, Node, Symbol};
use atoms::Atom;

/// What the normal form says of an expression.
#[derive(Clone, Debug)]
pub enum Verdict {
    /// It is identically zero.
    Zero,
    /// It is not: a rational function of symbols that is not zero.
    Nonzero(Fraction),
    /// Neither could be shown.
    Undecided,
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
}

impl<'a> NormalForm<'a> {
    /// A conversion that knows nothing yet.
    pub fn new(graph: &'a Graph, budget: &'a Budget) -> Self {
        Self {
            graph,
            budget,
            atoms: Vec::new(),
            scales: Vec::new(),
            values: HashMap::new(),
        }
    }

    /// Whether an expression is identically zero.
    pub fn verdict(&mut self, id: ExprId) -> Verdict {
        self.refined(|form| form.decide(id))
            .unwrap_or(Verdict::Undecided)
    }

    /// Does something, again with finer roots as long as it asks for them.
    fn refined<T>(&mut self, work: impl Fn(&mut Self) -> Result<T, Stop>) -> Option<T> {
        for _ in 0..REFINEMENTS {
            match work(self) {
                Ok(value) => return Some(value),
                Err(Stop::Refine) => {
                    self.atoms.clear();
                    self.values.clear();
                }
                Err(Stop::Exhausted | Stop::Undefined) => return None,
            }
        }
        None
    }

    /// The total degree in the coordinates, if the expression is a polynomial in them.
    pub fn degree(&mut self, id: ExprId) -> Option<u32> {
        let value = self.refined(|form| {
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
        let value = self.convert(id)?;
        if self.vanishes(&value)? {
            return Ok(Verdict::Zero);
        }
        let proven = self
            .variables(&value)
            .all(|v| matches!(self.atoms[v], Atom::Symbol(_) | Atom::Pi));
        Ok(if proven {
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
            Node::Pi => Ok(self.atom(Atom::Pi)),
            Node::Symbol(symbol) => Ok(self.atom(Atom::Symbol(*symbol))),
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
                    let base = self.values[base].clone();
                    let power = match exponent.to_integer() {
                        Some(integer) => self.integer_power(&base, integer)?,
                        None => self.power(&base, exponent)?,
                    };
                    product = product.mul(&power, self.budget)?;
                }
                Ok(product)
            }
            Node::Call(function, arguments) => {
                let arguments: Vec<Fraction> =
                    arguments.iter().map(|a| self.values[a].clone()).collect();
                self.call(*function, &arguments)
            }
        }
    }

    fn call(&mut self, function: Function, arguments: &[Fraction]) -> Result<Fraction, Stop> {
        let half = &Rational::ONE / &Rational::from(2);
        let argument = &arguments[0];
        match function {
            Function::Exp => self.exponential(argument),
            Function::Log => self.logarithm(argument),
            Function::Sinh | Function::Cosh | Function::Tanh => {
                let power = self.exponential(argument)?;
                let inverse = self.reciprocal(&power)?;
                let difference = power.sub(&inverse, self.budget)?;
                let sum = power.add(&inverse, self.budget)?;
                match function {
                    Function::Sinh => Ok(difference.scale(&half)),
                    Function::Cosh => Ok(sum.scale(&half)),
                    _ => Ok(difference.mul(&self.reciprocal(&sum)?, self.budget)?),
                }
            }
            Function::Sin | Function::Cos | Function::Tan => {
                let unit = self.atom(Atom::Imaginary);
                let exponent = unit.mul(argument, self.budget)?;
                let exponent = self.reduce(&exponent)?;
                let power = self.exponential(&exponent)?;
                let inverse = self.reciprocal(&power)?;
                let sum = power.add(&inverse, self.budget)?;
                // 1/i = -i
                let difference = power
                    .sub(&inverse, self.budget)?
                    .mul(&unit.neg(), self.budget)?;
                match function {
                    Function::Sin => Ok(difference.scale(&half)),
                    Function::Cos => Ok(sum.scale(&half)),
                    _ => Ok(difference.mul(&self.reciprocal(&sum)?, self.budget)?),
                }
            }
            Function::Asin | Function::Acos | Function::Atan | Function::Atan2 => {
                self.opaque(function, arguments)
            }
        }
    }
}

#[cfg(test)]
mod tests;
