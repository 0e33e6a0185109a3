//! The action of one basis element on momenta, `exp(s ad*_(e_i)) m`, in closed form.

use super::Source;
use super::splitting::{Definitions, sigma, weights};
use crate::structure::one_parameter::{Block, Form};
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Node};

/// A quantity of its own, unless it is one.
fn quantity(source: &mut Source, made: &mut Definitions, value: ExprId) -> ExprId {
    match source.graph.node(value) {
        Node::Symbol(_) | Node::Number(_) => value,
        _ => made.define(source, value),
    }
}

/// The action on a vector, whose new entries become one quantity each. Increments are quantities too,
/// so that their addition is the only rounding in units of the vector.
pub(crate) fn moved(
    source: &mut Source,
    blocks: &[Block],
    s: ExprId,
    vector: &[ExprId],
    made: &mut Definitions,
) -> Vec<ExprId> {
    let mut moved = vector.to_vec();
    if source.graph.is_zero(s) {
        return moved;
    }
    let mut increments: Vec<Vec<ExprId>> = vec![Vec::new(); vector.len()];
    for block in blocks {
        if let (Some(row), Form::Exponential(a)) = (block.only_row(), &block.form) {
            let exponent = sigma(source, block, s);
            let exponent = source.graph.scale(exponent, a);
            let (value, inverted) = made.exponential(source, exponent);
            let power = Rational::from(if inverted { -1 } else { 1 });
            let factor = source.graph.pow(value, &power);
            moved[row] = source.graph.mul(vector[row], factor);
            continue;
        }
        let weights = weights(source, block, s, made);
        for (weight, power) in weights.into_iter().zip(&block.powers) {
            for (row, column, value) in power {
                let term = source.graph.mul(weight, vector[*column]);
                increments[*row].push(source.graph.scale(term, value));
            }
        }
    }
    moved
        .into_iter()
        .zip(increments)
        .map(|(entry, terms)| {
            let increment = source.graph.sum(&terms);
            let increment = quantity(source, made, increment);
            let entry = source.graph.add(entry, increment);
            quantity(source, made, entry)
        })
        .collect()
}
