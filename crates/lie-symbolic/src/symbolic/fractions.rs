//! Rational functions of the parameters, from the arena and to it.

use std::collections::HashMap;

use super::{ExprId, Graph, Node, Symbol};
use crate::exact::{Budget, Fraction, Polynomial, Rational};

/// Work allowed for one rational function of the parameters.
const WORK: u64 = 10_000;

impl Graph {
    /// A rational function of the parameters in the arena.
    pub fn rational_function(&mut self, value: &Fraction) -> ExprId {
        let polynomial = |graph: &mut Graph, p: &Polynomial| {
            let mut terms = Vec::new();
            for (monomial, coefficient) in p.terms() {
                let mut powers = Vec::new();
                for (v, e) in monomial.powers() {
                    powers.push((
                        graph.symbol(Symbol::Parameter(v)),
                        Rational::from(i64::from(e)),
                    ));
                }
                terms.push((graph.power_product(&powers), coefficient.clone()));
            }
            graph.linear(&terms)
        };
        let mut factors = vec![(polynomial(self, value.numerator()), Rational::ONE)];
        for (factor, exponent) in value.denominator() {
            factors.push((
                polynomial(self, factor),
                Rational::from(-i64::from(exponent)),
            ));
        }
        self.power_product(&factors)
    }

    /// An expression as a rational function of the parameters, where it is one, or is where all coordinates have a value.
    pub fn fraction(&self, id: ExprId, coordinates: Option<Rational>) -> Option<Fraction> {
        let budget = &Budget::new(WORK);
        let mut values: HashMap<ExprId, Fraction> = HashMap::new();
        for id in self.dependencies(&[id]) {
            let value = match self.node(id) {
                Node::Number(value) => Fraction::from(value.clone()),
                Node::Symbol(Symbol::Parameter(p)) => Fraction::variable(*p),
                Node::Symbol(Symbol::Coordinate(_)) => Fraction::from(coordinates.clone()?),
                Node::Sum { constant, terms } => {
                    let mut sum = Fraction::from(constant.clone());
                    for (term, coefficient) in terms {
                        sum = sum.add(&values[term].scale(coefficient), budget).ok()?;
                    }
                    sum
                }
                Node::Product(factors) => {
                    let mut product = Fraction::from(Rational::ONE);
                    for (base, exponent) in factors {
                        let exponent = i32::try_from(exponent.to_integer()?).ok()?;
                        let power = values[base].pow(exponent, budget).ok()??;
                        product = product.mul(&power, budget).ok()?;
                    }
                    product
                }
                _ => return None,
            };
            values.insert(id, value);
        }
        values.remove(&id)
    }
}
