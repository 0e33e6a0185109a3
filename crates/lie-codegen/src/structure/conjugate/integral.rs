//! Integrals over one coordinate in closed form: of sums of powers, exponentials and sines.

use crate::structure::elementwise::factors;
use crate::structure::found::additive;
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{Elementary, ExprId, Function, Graph, Node, Symbol};

/// `int value dx_i` where every term is a function of the other coordinates times 1, a power above -1 or one of exp, sin, cos, sinh and cosh
/// of `a x_i + b` with a number a; none of others. It is continuous wherever the value is defined.
pub(in crate::structure) fn integral(graph: &mut Graph, value: ExprId, i: usize) -> Option<ExprId> {
    // a power of a sum is not taken apart
    if let Some(integral) = of_term(graph, value, i) {
        return Some(integral);
    }
    let (constant, terms) = additive::collected(graph, value)?;
    let x = graph.symbol(Symbol::Coordinate(i));
    let mut sum = vec![graph.scale(x, &constant)];
    for term in terms {
        sum.push(of_term(graph, term, i)?);
    }
    Some(graph.sum(&sum))
}

fn of_term(graph: &mut Graph, term: ExprId, i: usize) -> Option<ExprId> {
    let (number, product) = graph.coefficient(term);
    let factors = factors(graph, product);
    let varies = |graph: &Graph, base: ExprId| graph.coordinates(base).contains(&i);
    let (varying, rest): (Vec<_>, Vec<_>) = factors
        .into_iter()
        .partition(|(base, _)| varies(graph, *base));
    let integral = match &varying[..] {
        [] => graph.symbol(Symbol::Coordinate(i)),
        [(base, exponent)] => of_factor(graph, *base, exponent, i)?,
        _ => return None,
    };
    let rest = graph.power_product(&rest);
    let product = graph.mul(rest, integral);
    Some(graph.scale(product, &number))
}

/// That of a factor that depends on the coordinate.
fn of_factor(graph: &mut Graph, base: ExprId, exponent: &Rational, i: usize) -> Option<ExprId> {
    if let Some(slope) = slope_of(graph, base, i) {
        let above = exponent + &Rational::ONE;
        if above.is_zero() || above.is_negative() {
            return None;
        }
        let power = graph.pow(base, &above);
        return Some(graph.scale(power, &(&above * &slope).recip()?));
    }
    let Node::Call(Function::Elementary(function), arguments) = graph.node(base).clone() else {
        return None;
    };
    let [argument] = arguments[..] else {
        return None;
    };
    let slope = slope_of(graph, argument, i)?;
    if function == Elementary::Exp {
        let power = graph.pow(base, exponent);
        return Some(graph.scale(power, &(exponent * &slope).recip()?));
    }
    let (sign, integral) = match function {
        Elementary::Sin => (-1, Elementary::Cos),
        Elementary::Cos => (1, Elementary::Sin),
        Elementary::Sinh => (1, Elementary::Cosh),
        Elementary::Cosh => (1, Elementary::Sinh),
        _ => return None,
    };
    if *exponent != Rational::ONE {
        return None;
    }
    let integral = graph.call(integral, &[argument]);
    Some(graph.scale(integral, &(&Rational::from(sign) * &slope.recip()?)))
}

/// The number a of what is `a x_i + b` and no constant.
pub(in crate::structure) fn slope_of(
    graph: &mut Graph,
    value: ExprId,
    i: usize,
) -> Option<Rational> {
    let slope = graph.derivative(value, Symbol::Coordinate(i));
    let slope = graph.normal(slope);
    graph.as_number(slope).filter(|a| !a.is_zero()).cloned()
}
