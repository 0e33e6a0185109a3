//! The inverse of an integral over a coordinate, where that has a closed form: y of `Y(x, y)`.

use super::integral::slope_of;
use crate::structure::elementwise::{factors, half};
use crate::structure::found::additive;
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{Elementary, ExprId, Function, Graph, Node, Symbol};
use std::f64::consts::PI;

/// A function of the coordinate: a power of what is affine in it, or an elementary one.
#[derive(Clone, PartialEq)]
struct Factor {
    base: ExprId,
    exponent: Rational,
}

/// `value = w` solved for `x_i`: where value is `b + a f(g(x_i))` with f a power or an elementary function, g of this form again or affine, or
/// where value is of degree 2 or the logarithm of the quotient of two affine functions. On the side of a state at which `at` evaluates; without one
/// where powers and slopes are positive.
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
            of_factor(graph, factor, ratio, i, at)
        }
        [one, other] if of_logarithm(graph, &one.0).is_some() => {
            of_quotient(graph, [one, other], left, i, at)
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
    let factors = factors(graph, product);
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

/// What an elementary function is undone by.
fn undone_by(function: Elementary) -> Option<Elementary> {
    use Elementary::{Asin, Asinh, Atan, Atanh, Exp, Log, Sin, Sinh, Tan, Tanh};
    Some(match function {
        Exp => Log,
        Log => Exp,
        Sinh => Asinh,
        Asinh => Sinh,
        Tan => Atan,
        Atan => Tan,
        Tanh => Atanh,
        Asin => Sin,
        _ => return None,
    })
}

/// `x_i` of `f(x_i) = ratio`.
fn of_factor(
    graph: &mut Graph,
    factor: &Factor,
    ratio: ExprId,
    i: usize,
    at: &dyn Fn(&Graph, ExprId) -> Option<f64>,
) -> Option<ExprId> {
    let is_negative = |graph: &Graph, value| at(graph, value).is_some_and(|value| value < 0.0);
    if let Some(base) = of_logarithm(graph, factor) {
        let exponent = graph.scale(ratio, &half());
        let mut size = graph.call(Elementary::Exp, &[exponent]);
        if is_negative(graph, base) {
            size = graph.neg(size);
        }
        return inverse(graph, base, i, size, at);
    }
    let negative = is_negative(graph, factor.base);
    let (argument, inside) = match graph.node(factor.base).clone() {
        Node::Call(Function::Elementary(function), arguments) if arguments.len() == 1 => {
            let argument = arguments[0];
            let inverse = undone_by(function)?;
            let inside = match function {
                Elementary::Exp => {
                    let logarithm = graph.call(inverse, &[ratio]);
                    graph.scale(logarithm, &factor.exponent.recip()?)
                }
                Elementary::Tan => {
                    let start = at(graph, argument).unwrap_or(0.0);
                    of_tangent(graph, &factor.exponent, ratio, start)?
                }
                _ => {
                    let root = root(graph, &factor.exponent, ratio, negative)?;
                    graph.call(inverse, &[root])
                }
            };
            (argument, inside)
        }
        _ => {
            let root = root(graph, &factor.exponent, ratio, negative)?;
            (factor.base, root)
        }
    };
    let Some(slope) = slope_of(graph, argument, i) else {
        let nested = argument != factor.base || factor.exponent != Rational::ONE;
        return nested.then(|| inverse(graph, argument, i, inside, at))?;
    };
    // the argument is a x_i + b
    let x = graph.symbol(Symbol::Coordinate(i));
    let moved = graph.scale(x, &slope);
    let rest = graph.sub(argument, moved);
    let moved = graph.sub(inside, rest);
    Some(graph.scale(moved, &slope.recip()?))
}

/// u of `tan u = ratio`, or of `1/tan u = ratio`, on the branch of a start.
fn of_tangent(graph: &mut Graph, exponent: &Rational, ratio: ExprId, start: f64) -> Option<ExprId> {
    let angle = graph.call(Elementary::Atan, &[ratio]);
    let (angle, halves) = match exponent.to_integer()? {
        1 => (angle, 2.0 * (start / PI).round()),
        -1 => (graph.neg(angle), 2.0 * (start / PI).floor() + 1.0),
        _ => return None,
    };
    let pi = graph.pi();
    let turned = graph.scale(pi, &(&Rational::from_f64(halves)? * &half()));
    Some(graph.add(angle, turned))
}

/// g of a factor `log g^2`.
fn of_logarithm(graph: &Graph, factor: &Factor) -> Option<ExprId> {
    let Node::Call(Function::Elementary(Elementary::Log), arguments) = graph.node(factor.base)
    else {
        return None;
    };
    match graph.node(arguments[0]) {
        Node::Product(factors) if factor.exponent == Rational::ONE => match &factors[..] {
            [(base, exponent)] if *exponent == Rational::from(2) => Some(*base),
            _ => None,
        },
        _ => None,
    }
}

/// `x_i` of `s log g^2 - s log h^2 = left` with affine g and h: of `g = m h` with `m^2 = exp(left/s)`.
fn of_quotient(
    graph: &mut Graph,
    [one, other]: [&(Factor, ExprId); 2],
    left: ExprId,
    i: usize,
    at: &dyn Fn(&Graph, ExprId) -> Option<f64>,
) -> Option<ExprId> {
    let [above, below] = [of_logarithm(graph, &one.0)?, of_logarithm(graph, &other.0)?];
    let slopes = [slope_of(graph, above, i)?, slope_of(graph, below, i)?];
    let sum = graph.add(one.1, other.1);
    let sum = graph.normal(sum);
    if !graph.is_zero(sum) {
        return None;
    }
    let exponent = graph.div(left, one.1);
    let exponent = graph.scale(exponent, &half());
    let mut m = graph.call(Elementary::Exp, &[exponent]);
    let ratio = graph.div(above, below);
    if at(graph, ratio).is_some_and(|value| value < 0.0) {
        m = graph.neg(m);
    }
    let x = graph.symbol(Symbol::Coordinate(i));
    let mut rest = |value: ExprId, slope: &Rational| {
        let moved = graph.scale(x, slope);
        graph.sub(value, moved)
    };
    // a x + b = m (c x + d)
    let [b, d] = [rest(above, &slopes[0]), rest(below, &slopes[1])];
    let [a, c] = slopes.map(|slope| graph.number(slope));
    let [moved, along] = [d, c].map(|value| graph.mul(m, value));
    let [moved, along] = [graph.sub(moved, b), graph.sub(a, along)];
    Some(graph.div(moved, along))
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
    let half = half();
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
