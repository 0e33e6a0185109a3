//! The kernels of coordinates in which the bracket is constant.

use super::coadjoint::xi;
use super::field::mu;
use super::{Block, Kernel, Source};
use crate::structure::elementwise::Side;
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{Elementary, ExprId, Function, Graph, Node, Symbol};

/// `canonical`, `canonical_sides`, `canonical_pull`, `canonical_field` and `canonical_jacobian`.
///
/// Each coordinate w_i is a function of x_i and of coordinates that stay, so that `(dw/dmu)^-1` is
/// `v_i = (xi_i - sum_(k != i) dw_i/dx_k xi_k)/(dw_i/dx_i)`.
pub(super) fn kernels(source: &mut Source) -> Option<Vec<Kernel>> {
    let changes = source.structure.conjugate.clone()?.changes;
    let (field, moved) = (source.field(), source.block(Block::Xi));
    let one = source.graph.integer(1);
    let mut values = source.coordinates();
    let mut sides = vec![one; source.dimension];
    let mut pulled = moved.clone();
    let mut along = field.clone();
    for change in changes {
        let graph = &mut source.graph;
        let i = change.coordinate;
        values[i] = with_sizes(graph, change.value);
        sides[i] = side(graph, &change.sides, &moved);
        let mut terms = vec![graph.mul(change.slope, field[i])];
        let mut beside = vec![moved[i]];
        for &(k, slope) in &change.beside {
            terms.push(graph.mul(slope, field[k]));
            let term = graph.mul(slope, moved[k]);
            beside.push(graph.neg(term));
        }
        along[i] = graph.sum(&terms);
        let beside = graph.sum(&beside);
        pulled[i] = graph.div(beside, change.slope);
    }
    let jacobian = source.jacobian_of(&along);
    let graph = &source.graph;
    let at = || vec![mu(source)];
    let vector =
        |name, formula, entries: &[ExprId]| Kernel::vector(graph, name, formula, at(), entries);
    let kernels = vec![
        vector(
            "canonical",
            "`out = w(mu)`, in which the bracket is constant",
            &values,
        ),
        Kernel::vector(
            graph,
            "canonical_sides",
            "`out_i > 0` where w_i has an inverse between mu and xi",
            vec![mu(source), xi(source)],
            &sides,
        ),
        Kernel::vector(
            graph,
            "canonical_pull",
            "`out = (dw/dmu)^-1 xi`",
            vec![mu(source), xi(source)],
            &pulled,
        ),
        vector("canonical_field", "`out = (dw/dmu) f(mu)`", &along),
        Kernel::matrix(
            graph,
            "canonical_jacobian",
            "`out_ij = d((dw/dmu) f)_i/dmu_j`",
            at(),
            &jacobian,
        ),
    ];
    Some(kernels)
}

/// An expression with `2 log |g|` for `log g^2`, whose square may be too small or too large for a number.
fn with_sizes(graph: &mut Graph, id: ExprId) -> ExprId {
    match graph.node(id).clone() {
        Node::Sum { constant, terms } => {
            let terms = terms.iter();
            let mut terms: Vec<(ExprId, Rational)> = terms
                .map(|(term, scale)| (with_sizes(graph, *term), scale.clone()))
                .collect();
            let one = graph.integer(1);
            terms.push((one, constant));
            graph.linear(&terms)
        }
        Node::Product(factors) => {
            let factors = factors.iter();
            let factors: Vec<(ExprId, Rational)> = factors
                .map(|(base, exponent)| (with_sizes(graph, *base), exponent.clone()))
                .collect();
            graph.power_product(&factors)
        }
        Node::Call(Function::Elementary(Elementary::Log), arguments) => {
            let Node::Product(factors) = graph.node(arguments[0]).clone() else {
                return id;
            };
            let two = Rational::from(2);
            let [(base, exponent)] = &factors[..] else {
                return id;
            };
            if *exponent != two {
                return id;
            }
            let negative = graph.neg(*base);
            let size = graph.call(Function::Below, &[*base, negative, *base]);
            let logarithm = graph.call(Elementary::Log, &[size]);
            graph.scale(logarithm, &two)
        }
        _ => id,
    }
}

/// What is positive where two states, that of the coordinates and another one, are on the same side of all zeros and poles.
fn side(graph: &mut Graph, sides: &[Side], other: &[ExprId]) -> ExprId {
    let there = |graph: &mut Graph, value: ExprId| {
        let at = |symbol| match symbol {
            Symbol::Coordinate(i) => other.get(i).copied(),
            _ => None,
        };
        graph.substitute(&[value], &at)[0]
    };
    let each = sides.iter().map(|side| match side {
        Side::Sign(value) => {
            let end = there(graph, *value);
            graph.div(end, *value)
        }
        Side::Turn(angle) => {
            let end = there(graph, *angle);
            let turned = graph.sub(end, *angle);
            let [turned, half] = [turned, graph.pi()].map(|angle| graph.mul(angle, angle));
            graph.sub(half, turned)
        }
    });
    let each: Vec<ExprId> = each.collect();
    let least = each.into_iter().reduce(|one, other| {
        let difference = graph.sub(one, other);
        graph.call(Function::Below, &[difference, one, other])
    });
    least.unwrap_or_else(|| graph.integer(1))
}
