//! Polynomials of low degree with their terms collected: what substitution leaves has each coefficient in several places.

use lie_symbolic::exact::{Fraction, Rational};
use lie_symbolic::prove::degree::degree;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

/// The largest degree whose terms are collected.
const QUADRATIC: u32 = 2;

/// A polynomial of degree two at most whose coefficients are rational functions of parameters by its terms; anything else as it is.
pub fn collected(graph: &mut Graph, value: ExprId) -> ExprId {
    let coordinates = graph.coordinates(value);
    if coordinates.is_empty() {
        let constant = graph.fraction(value, None);
        return constant.map_or(value, |constant| graph.rational_function(&constant));
    }
    if degree(graph, value).is_none_or(|degree| degree > QUADRATIC) {
        return value;
    }
    taylor(graph, value, &coordinates).unwrap_or(value)
}

/// A function whose second derivatives by these coordinates are constants that are rational functions of parameters, by its terms in
/// them.
pub fn collected_in(graph: &mut Graph, value: ExprId, coordinates: &[usize]) -> ExprId {
    taylor(graph, value, coordinates).unwrap_or(value)
}

/// `f(0) + sum_i f_i(0) x_i + sum_ij f_ij x_i x_j/2` in some of the coordinates.
fn taylor(graph: &mut Graph, value: ExprId, coordinates: &[usize]) -> Option<ExprId> {
    let zero = graph.integer(0);
    let at_zero = |symbol| match symbol {
        Symbol::Coordinate(i) if coordinates.contains(&i) => Some(zero),
        _ => None,
    };
    let mut terms = graph.substitute(&[value], &at_zero);
    for (place, i) in coordinates.iter().enumerate() {
        let slope = graph.derivative(value, Symbol::Coordinate(*i));
        let x = graph.symbol(Symbol::Coordinate(*i));
        let first = graph.substitute(&[slope], &at_zero)[0];
        let first = simplest(graph, first);
        terms.push(graph.mul(first, x));
        for j in &coordinates[place..] {
            let second = graph.derivative(slope, Symbol::Coordinate(*j));
            let second = constant(graph, second)?;
            let half = if i == j {
                Rational::new(1, 2)?
            } else {
                Rational::ONE
            };
            let second = graph.rational_function(&second.scale(&half));
            let y = graph.symbol(Symbol::Coordinate(*j));
            terms.push(graph.product(&[second, x, y]));
        }
    }
    let constant = terms[0];
    terms[0] = simplest(graph, constant);
    Some(graph.sum(&terms))
}

/// A constant as a rational function, where it is one.
fn simplest(graph: &mut Graph, value: ExprId) -> ExprId {
    match graph.fraction(value, None) {
        Some(value) => graph.rational_function(&value),
        None => value,
    }
}

/// What is a rational function of the parameters alone.
pub fn constant(graph: &Graph, value: ExprId) -> Option<Fraction> {
    if graph.coordinates(value).is_empty() {
        return graph.fraction(value, None);
    }
    (degree(graph, value) == Some(0)).then(|| graph.fraction(value, Some(Rational::ZERO)))?
}
