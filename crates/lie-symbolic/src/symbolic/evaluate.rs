//! Evaluation: in double precision, the oracle that generated code is tested against, and exactly.

use rustc_hash::FxHashMap as HashMap;

use super::graph::{ExprId, Graph, Node, Symbol};
use crate::exact::Rational;

/// Longer numbers count as undefined.
const MAX_BITS: u64 = 1 << 16;

impl Graph {
    /// The value of an expression.
    pub fn evaluate(&self, id: ExprId, value: &dyn Fn(Symbol) -> f64) -> f64 {
        self.evaluate_all(&[id], value)[0]
    }

    /// The values of several expressions, shared subexpressions evaluated once.
    pub fn evaluate_all(&self, roots: &[ExprId], value: &dyn Fn(Symbol) -> f64) -> Vec<f64> {
        let mut values: HashMap<ExprId, f64> = HashMap::default();
        for id in self.dependencies(roots) {
            let result = self.evaluate_node(id, &|part| values[&part], value);
            values.insert(id, result);
        }
        roots.iter().map(|root| values[root]).collect()
    }

    /// The values of several expressions, `None` where they are not rational or too long.
    pub fn evaluate_exactly(
        &self,
        roots: &[ExprId],
        value: &dyn Fn(Symbol) -> Option<Rational>,
    ) -> Option<Vec<Rational>> {
        let mut values: HashMap<ExprId, Rational> = HashMap::default();
        for id in self.dependencies(roots) {
            let value = match self.node(id) {
                Node::Number(value) => value.clone(),
                Node::Symbol(symbol) => value(*symbol)?,
                Node::Sum { constant, terms } => {
                    terms.iter().fold(constant.clone(), |sum, (term, c)| {
                        &sum + &(c * &values[term])
                    })
                }
                Node::Written(terms) => terms
                    .iter()
                    .fold(Rational::ZERO, |sum, (term, c)| &sum + &(c * &values[term])),
                Node::Product(factors) => {
                    let mut product = Rational::ONE;
                    for (base, exponent) in factors {
                        let exponent = i32::try_from(exponent.to_integer()?).ok()?;
                        let base = &values[base];
                        if base.bits().saturating_mul(exponent.unsigned_abs().into()) > MAX_BITS {
                            return None;
                        }
                        product = &product * &base.pow(exponent)?;
                    }
                    product
                }
                Node::Pi | Node::Call(..) => return None,
            };
            if value.bits() > MAX_BITS {
                return None;
            }
            values.insert(id, value);
        }
        Some(roots.iter().map(|root| values[root].clone()).collect())
    }

    /// The value of one node, those of its children being known.
    pub fn evaluate_node(
        &self,
        id: ExprId,
        known: &dyn Fn(ExprId) -> f64,
        value: &dyn Fn(Symbol) -> f64,
    ) -> f64 {
        match self.node(id) {
            Node::Number(number) => number.to_f64(),
            Node::Pi => std::f64::consts::PI,
            Node::Symbol(symbol) => value(*symbol),
            Node::Sum { constant, terms } => terms.iter().fold(constant.to_f64(), |sum, (t, c)| {
                sum + c.to_f64() * known(*t)
            }),
            Node::Written(terms) => terms
                .iter()
                .fold(0.0, |sum, (t, c)| sum + c.to_f64() * known(*t)),
            Node::Product(factors) => factors.iter().fold(1.0, |product, (base, exponent)| {
                let base = known(*base);
                product
                    * match exponent.to_words() {
                        Some((1, 1)) => base,
                        Some((1, 2)) => base.sqrt(),
                        _ => libm::pow(base, exponent.to_f64()),
                    }
            }),
            Node::Call(function, arguments) => {
                let arguments: Vec<f64> = arguments.iter().map(|a| known(*a)).collect();
                function.evaluate(&arguments)
            }
        }
    }
}
