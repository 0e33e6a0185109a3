//! Expressions of the syntax tree, evaluated as they were written.

use std::collections::HashMap;

use crate::number::Number;
use lie_core::Elementary;
use lie_syntax::ast::{Expr, ExprKind};

/// What names stand for.
#[derive(Clone, Debug)]
pub(super) struct Scope {
    names: HashMap<String, Number>,
}

impl Scope {
    /// With `pi` alone.
    pub(super) fn new() -> Self {
        let pi = Number::rounded(std::f64::consts::PI, 1.0);
        Self {
            names: HashMap::from([("pi".to_owned(), pi)]),
        }
    }

    pub(super) fn bind(&mut self, name: &str, value: Number) {
        self.names.insert(name.to_owned(), value);
    }

    /// The value of an expression; not a number where a name is unknown here.
    pub(super) fn evaluate(&self, expr: &Expr) -> Number {
        match &expr.kind {
            ExprKind::Number(value) => Number::constant(value),
            ExprKind::Name { name, .. } => {
                let known = self.names.get(name).cloned();
                known.unwrap_or_else(|| Number::rounded(f64::NAN, 0.0))
            }
            ExprKind::Negative(inner) => self.evaluate(inner).neg(),
            ExprKind::Sum(terms) => {
                let signed = terms.iter().map(|(minus, term)| {
                    let value = self.evaluate(term);
                    if *minus { value.neg() } else { value }
                });
                sum(signed)
            }
            ExprKind::Product(factors) => self.product(factors),
            ExprKind::Power(base, exponent) => self.power(base, exponent),
            ExprKind::Call {
                function,
                arguments,
            } => {
                let values: Vec<Number> = arguments.iter().map(|a| self.evaluate(a)).collect();
                match (function.text.as_str(), values.as_slice()) {
                    ("sqrt", [x]) => x.power(0.5),
                    ("hypot", [x, y]) => x.mul(x).add(&y.mul(y)).power(0.5),
                    ("atan2", [y, x]) => y.atan2(x),
                    ("abs", [x]) if x.value() < 0.0 => x.neg(),
                    ("abs", [x]) => x.clone(),
                    ("min", [x, y]) if y.value() < x.value() => y.clone(),
                    ("max", [x, y]) if x.value() < y.value() => y.clone(),
                    ("min" | "max", [x, _]) => x.clone(),
                    ("piecewise", [x, y, a, b]) => {
                        if x.value() < y.value() {
                            a.clone()
                        } else {
                            b.clone()
                        }
                    }
                    (name, [x]) => match Elementary::from_name(name) {
                        Some(function) => x.call(function),
                        None => Number::rounded(f64::NAN, 0.0),
                    },
                    _ => Number::rounded(f64::NAN, 0.0),
                }
            }
            ExprKind::IndexedSum { .. } => Number::rounded(f64::NAN, 0.0),
        }
    }

    fn product(&self, factors: &[(bool, Expr)]) -> Number {
        let mut product: Option<Number> = None;
        for (divides, factor) in factors {
            let value = self.evaluate(factor);
            product = Some(match (product, divides) {
                (None, false) => value,
                (None, true) => Number::integer(1).div(&value),
                (Some(product), false) => product.mul(&value),
                (Some(product), true) => product.div(&value),
            });
        }
        product.unwrap_or_else(|| Number::integer(1))
    }

    fn power(&self, base: &Expr, exponent: &Expr) -> Number {
        let base = self.evaluate(base);
        // a name may stand for a number, and then the base may be negative
        if has_names(exponent) && base.value() > 0.0 {
            let logarithm = base.call(Elementary::Log);
            return self
                .evaluate(exponent)
                .mul(&logarithm)
                .call(Elementary::Exp);
        }
        let exponent = self.evaluate(exponent).value();
        if exponent.fract() != 0.0 || exponent.abs() > 64.0 {
            return base.power(exponent);
        }
        let mut product = Number::integer(1);
        for _ in 0..exponent.abs() as u32 {
            product = product.mul(&base);
        }
        if exponent < 0.0 {
            Number::integer(1).div(&product)
        } else {
            product
        }
    }
}

/// A sum without a zero in front.
fn sum(terms: impl Iterator<Item = Number>) -> Number {
    terms
        .reduce(|sum, term| sum.add(&term))
        .unwrap_or_else(|| Number::integer(0))
}

fn has_names(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Number(_) => false,
        ExprKind::Name { .. } | ExprKind::IndexedSum { .. } => true,
        ExprKind::Negative(inner) => has_names(inner),
        ExprKind::Sum(terms) | ExprKind::Product(terms) => {
            terms.iter().any(|(_, term)| has_names(term))
        }
        ExprKind::Power(base, exponent) => has_names(base) || has_names(exponent),
        ExprKind::Call { arguments, .. } => arguments.iter().any(has_names),
    }
}

/// The number of nodes of an expression.
pub(super) fn size(expr: &Expr) -> usize {
    1 + match &expr.kind {
        ExprKind::Number(_) | ExprKind::Name { .. } | ExprKind::IndexedSum { .. } => 0,
        ExprKind::Negative(inner) => size(inner),
        ExprKind::Sum(terms) | ExprKind::Product(terms) => {
            terms.iter().map(|(_, term)| size(term)).sum()
        }
        ExprKind::Power(base, exponent) => size(base) + size(exponent),
        ExprKind::Call { arguments, .. } => arguments.iter().map(size).sum(),
    }
}
