//! Rotations of a plane as three shears.
//!
//! By the angle a they are x by `T y`, y by `-x sin a` and x by `T y`, with `T = tan(a/2)` and
//! `sin a = 2 T/(1 + T^2)`, one function call. Their determinant is 1 whatever the rounding of both, so that the same
//! angle in every step changes the length by chance alone; sine and cosine, rounded apart, change it by the same factor in
//! every step. Beyond a quarter turn the shears follow half a turn, which is exact: then T is at most 1.

use super::Source;
use super::splitting::{Definitions, sigma};
use crate::structure::one_parameter::{Block, Form};
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{Elementary, ExprId, Function, Symbol};

/// The entries of a plane that a block turns, by three shears; `None` of other blocks.
pub(super) fn turned(
    source: &mut Source,
    block: &Block,
    s: ExprId,
    definitions: &mut Definitions,
) -> Option<[(usize, ExprId); 2]> {
    let (Form::Quadratic(kappa), [first, ..]) = (&block.form, block.powers.as_slice()) else {
        return None;
    };
    let [(x, y, p), (row, column, q)] = first.as_slice() else {
        return None;
    };
    if !kappa.is_negative() || (row, column) != (y, x) {
        return None;
    }
    let sigma = sigma(source, block, s);
    let (half, two) = (Rational::new(1, 2)?, Rational::from(2));
    let graph = &mut source.graph;
    let [one, minus] = [1, -1].map(|value| graph.integer(value));
    let size = graph.number(kappa.abs());
    let frequency = graph.pow(size, &half);
    let angle = graph.mul(frequency, sigma);
    let angle = graph.scale(angle, &half);
    let tangent = graph.call(Elementary::Tan, &[angle]);
    let tangent = definitions.define(source, tangent);
    let graph = &mut source.graph;
    let square = graph.mul(tangent, tangent);
    let (within, denominator) = (graph.sub(one, square), graph.add(one, square));
    let sign = graph.call(Function::Below, &[within, minus, one]);
    let sign = definitions.define(source, sign);
    let rest = source.graph.div(minus, tangent);
    let rest = source.graph.call(Function::Below, &[within, rest, tangent]);
    let rest = definitions.define(source, rest);
    // half a turn changes the sign of the sine
    let sine = source.graph.mul(sign, tangent);
    let sine = source.graph.scale(sine, &two);
    let sine = source.graph.div(sine, denominator);
    let sine = definitions.define(source, sine);
    let [p, q] = [(p, rest), (q, sine)].map(|(entry, by)| {
        let by = source.graph.scale(by, entry);
        source.graph.div(by, frequency)
    });
    let [a, b] = [x, y].map(|k| {
        let entry = source.graph.symbol(Symbol::Coordinate(*k));
        let entry = source.graph.mul(sign, entry);
        definitions.define(source, entry)
    });
    let mut shear = |entry: ExprId, by: ExprId, other: ExprId| {
        let term = source.graph.mul(by, other);
        let sum = source.graph.add(entry, term);
        definitions.define(source, sum)
    };
    let a = shear(a, p, b);
    let b = shear(b, q, a);
    Some([(*x, shear(a, p, b)), (*y, b)])
}
