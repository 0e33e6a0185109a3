//! Sums and products of scalars, without what zeros and ones contribute.

use crate::ast::{Expr, ExprKind, Name};
use crate::diagnostic::Origin;
use lie_symbolic::exact::Rational;

/// Whether it is this number.
pub fn is_number(expression: &Expr, value: i64) -> bool {
    matches!(&expression.kind, ExprKind::Number(number) if *number == Rational::from(value))
}

/// A whole number.
pub fn number(value: i64, origin: Origin) -> Expr {
    let kind = ExprKind::Number(Rational::from(value));
    Expr { kind, origin }
}

/// The negative; 0 stays 0.
pub fn minus(operand: Expr, origin: Origin) -> Expr {
    if is_number(&operand, 0) {
        return operand;
    }
    let kind = ExprKind::Negative(Box::new(operand));
    Expr { kind, origin }
}

/// The square.
pub fn square(base: &Expr, origin: Origin) -> Expr {
    if is_number(base, 0) {
        return base.clone();
    }
    let kind = ExprKind::Power(Box::new(base.clone()), Box::new(number(2, origin)));
    Expr { kind, origin }
}

/// The square root.
pub fn root(operand: Expr, origin: Origin) -> Expr {
    let function = Name {
        text: "sqrt".into(),
        origin,
    };
    let arguments = vec![operand];
    let kind = ExprKind::Call {
        function: Box::new(function),
        arguments,
    };
    Expr { kind, origin }
}

/// The product of two.
pub fn times(a: &Expr, b: &Expr, origin: Origin) -> Expr {
    multiply(vec![(false, a.clone()), (false, b.clone())], origin)
}

/// The product without factors 1, products in it opened; 0 where a factor is 0. The first factor does not divide.
pub fn multiply(factors: Vec<(bool, Expr)>, origin: Origin) -> Expr {
    let zero = |(divides, factor): &(bool, Expr)| !divides && is_number(factor, 0);
    if factors.iter().any(zero) {
        return number(0, origin);
    }
    let mut all: Vec<(bool, Expr)> = Vec::new();
    for (divides, factor) in factors {
        match factor.kind {
            ExprKind::Product(inner) if !divides => all.extend(inner),
            _ if is_number(&factor, 1) => {}
            _ => all.push((divides, factor)),
        }
    }
    if all.first().is_none_or(|(divides, _)| *divides) {
        all.insert(0, (false, number(1, origin)));
    }
    match all.len() {
        1 => all.remove(0).1,
        _ => Expr {
            kind: ExprKind::Product(all),
            origin,
        },
    }
}

/// The sum without terms 0.
pub fn plus(mut terms: Vec<(bool, Expr)>, origin: Origin) -> Expr {
    terms.retain(|(_, term)| !is_number(term, 0));
    if let Some((sign @ true, first)) = terms.first_mut() {
        *sign = false;
        *first = minus(first.clone(), origin);
    }
    match terms.len() {
        0 => number(0, origin),
        1 => terms.remove(0).1,
        _ => Expr {
            kind: ExprKind::Sum(terms),
            origin,
        },
    }
}
