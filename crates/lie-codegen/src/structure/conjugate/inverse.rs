//! The inverse of an integral over a coordinate, where that has a closed form: y of `Y(x, y)`.

use super::integral::slope_of;
use crate::structure::found::additive;
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{Elementary, ExprId, Function, Graph, Node, Symbol};

/// A function of the coordinate: a power of what is affine in it, or an elementary one.
#[derive(Clone, PartialEq)]
struct Factor {
    base: ExprId,
    exponent: Rational,
}

/// `value = w` solved for `x_i`: where value is `b + a f(x_i)` with f a power of what is affine in it, exp or sinh of that, or of degree 2. On the
/// side of a state at which `at` evaluates; without one where powers and slopes are positive.
pub(in crate::structure) fn inverse(
    graph: &mut Graph,
    value: ExprId,
    i: usize,
    w: ExprId,
    at: &dyn Fn(&Graph, ExprId) -> Option<f64>,
) -> Option<ExprId> {
    // a power of a sum is not taken apart
    let whole = apart(graph, value, i).is_some_and(|(factor, _)| {
        factor.is_some_and(|Factor { base, .. }| {
            matches!(graph.node(base), Node::Call(..)) || slope_of(graph, base, i).is_some()
        })
    });
    let (constant, terms) = match whole {
        true => (Rational::ZERO, vec![value]),
        false => additive::collected(graph, value)?,
    };
    let mut free = vec![graph.number(constant)];
    let mut varying: Vec<(Factor, Vec<ExprId>)> = Vec::new();
    for term in terms {
        match apart(graph, term, i)? {
            (None, _) => free.push(term),
            (Some(factor), rest) => match varying.iter_mut().find(|(f, _)| *f == factor) {
                Some((_, all)) => all.push(rest),
                None => varying.push((factor, vec![rest])),
            },
        }
    }
    let free = graph.sum(&free);
    let left = graph.sub(w, free);
    let mut summed = |(factor, rest): (Factor, Vec<ExprId>)| (factor, graph.sum(&rest));
    let varying: Vec<(Factor, ExprId)> = varying.into_iter().map(&mut summed).collect();
    let negative = |graph: &Graph, value: ExprId| at(graph, value).is_some_and(|v| v < 0.0);
    let x = graph.symbol(Symbol::Coordinate(i));
    match &varying[..] {
        [(factor, scale)] => {
            let ratio = graph.div(left, *scale);
            let negative = negative(graph, factor.base);
            of_factor(graph, factor, ratio, i, negative)
        }
        [one, other] => {
            let power = |of: &(Factor, ExprId), n: i64| {
                of.0.base == x && of.0.exponent == Rational::from(n)
            };
            let (linear, square) = match (power(one, 1), power(other, 1)) {
                (true, _) if power(other, 2) => (one.1, other.1),
                (_, true) if power(one, 2) => (other.1, one.1),
                _ => return None,
            };
            let slope = graph.derivative(value, Symbol::Coordinate(i));
            let negative = negative(graph, slope);
            let sides = [linear, square].map(|part| at(graph, part));
            let cancels = matches!(sides, [Some(b), Some(a)] if a != 0.0 && (b < 0.0) != negative && b != 0.0);
            Some(of_square(graph, [left, linear, square], negative, cancels))
        }
        _ => None,
    }
}

/// The factor of a term that depends on the coordinate, and the rest of it; none where there are several.
fn apart(graph: &mut Graph, term: ExprId, i: usize) -> Option<(Option<Factor>, ExprId)> {
    let (number, product) = graph.coefficient(term);
    let factors = match graph.node(product).clone() {
        Node::Product(factors) => factors.to_vec(),
        _ => vec![(product, Rational::ONE)],
    };
    let varies = |(base, _): &(ExprId, Rational)| graph.coordinates(*base).contains(&i);
    let (varying, rest): (Vec<_>, Vec<_>) = factors.into_iter().partition(varies);
    let rest = graph.power_product(&rest);
    let rest = graph.scale(rest, &number);
    match varying.as_slice() {
        [] => Some((None, rest)),
        [(base, exponent)] => {
            let factor = Factor {
                base: *base,
                exponent: exponent.clone(),
            };
            Some((Some(factor), rest))
        }
        _ => None,
    }
}

/// `x_i` of `f(x_i) = ratio`.
fn of_factor(
    graph: &mut Graph,
    factor: &Factor,
    ratio: ExprId,
    i: usize,
    negative: bool,
) -> Option<ExprId> {
    let (argument, inside) = match graph.node(factor.base).clone() {
        Node::Call(Function::Elementary(function), arguments) if arguments.len() == 1 => {
            let inside = match function {
                Elementary::Exp => {
                    let logarithm = graph.call(Elementary::Log, &[ratio]);
                    graph.scale(logarithm, &factor.exponent.recip()?)
                }
                Elementary::Sinh if factor.exponent == Rational::ONE => {
                    graph.call(Elementary::Asinh, &[ratio])
                }
                _ => return None,
            };
            (arguments[0], inside)
        }
        _ => {
            let root = root(graph, &factor.exponent, ratio, negative)?;
            (factor.base, root)
        }
    };
    // the argument is a x_i + b
    let slope = slope_of(graph, argument, i)?;
    let x = graph.symbol(Symbol::Coordinate(i));
    let moved = graph.scale(x, &slope);
    let rest = graph.sub(argument, moved);
    let moved = graph.sub(inside, rest);
    Some(graph.scale(moved, &slope.recip()?))
}

/// b of `b^p = ratio` on its side.
fn root(graph: &mut Graph, p: &Rational, ratio: ExprId, negative: bool) -> Option<ExprId> {
    if *p == Rational::ONE {
        return Some(ratio);
    }
    let inverse = p.recip()?;
    if !negative {
        return Some(graph.pow(ratio, &inverse));
    }
    let odd = p.to_integer()? % 2 != 0;
    let size = if odd { graph.neg(ratio) } else { ratio };
    let size = graph.pow(size, &inverse);
    Some(graph.neg(size))
}

/// x of `a x^2 + b x = c` on the side where `2 a x + b` has a sign; a may vanish where it is no number. Where b has the other sign, the sum of
/// it and the root cancels, and is 0 on the way.
fn of_square(graph: &mut Graph, [c, b, a]: [ExprId; 3], negative: bool, cancels: bool) -> ExprId {
    let square = graph.mul(b, b);
    let product = graph.mul(a, c);
    let product = graph.scale(product, &Rational::from(4));
    let inside = graph.add(square, product);
    let half = Rational::new(1, 2).unwrap_or(Rational::ONE);
    let mut root = graph.pow(inside, &half);
    if negative {
        root = graph.neg(root);
    }
    if cancels || graph.as_number(a).is_some() {
        let difference = graph.sub(root, b);
        let quotient = graph.div(difference, a);
        return graph.scale(quotient, &half);
    }
    let sum = graph.add(root, b);
    let quotient = graph.div(c, sum);
    graph.scale(quotient, &Rational::from(2))
}
