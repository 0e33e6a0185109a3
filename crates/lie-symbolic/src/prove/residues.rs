//! Values of expressions modulo a prime, at points that are the same in every run.
//!
//! A rational function of coordinates and parameters whose value is not zero does not vanish
//! identically: that is proven, whatever it would take to write the function out.

use crate::exact::Residue;
use crate::symbolic::{ExprId, Graph, Node, Symbol};

/// Pi, which obeys no relation.
const PI: u64 = 6;
/// Roots and functions of parameters.
const CONSTANT: u64 = 7;
/// The direction of the line.
const DIRECTION: u64 = 8;

/// A value for something at a point.
fn drawn(point: usize, kind: u64, index: u64) -> Residue {
    // splitmix64
    let mut z = (point as u64 + 1)
        .wrapping_mul(0x9e37_79b9_7f4a_7c15)
        .wrapping_add(kind.wrapping_mul(0xd1b5_4a32_d192_ed03))
        .wrapping_add(index.wrapping_mul(0x8cb9_2ba7_2f3d_8dd7));
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    Residue::from_bits(z ^ (z >> 31))
}

/// The value of a symbol.
pub fn symbol_value(point: usize, symbol: Symbol) -> Residue {
    let (kind, index) = match symbol {
        Symbol::Parameter(i) => (1, i),
        Symbol::Step => (2, 0),
        Symbol::Time => (3, 0),
        Symbol::Coordinate(i) => (4, i),
        Symbol::Input(i) => (5, i),
    };
    drawn(point, kind, index as u64)
}

/// The value of pi, of which only algebra is asked.
pub fn pi_value(point: usize) -> Residue {
    drawn(point, PI, 0)
}

/// A value for a constant that is neither a number nor a symbol.
pub fn constant_value(point: usize, index: u64) -> Residue {
    drawn(point, CONSTANT, index)
}

/// Whether an expression is a rational function that does not vanish.
pub fn is_nonzero(graph: &Graph, id: ExprId) -> bool {
    let parts = graph.dependencies(&[id]);
    on_line(graph, &parts, Residue::ZERO).is_some_and(|value| !value.is_zero())
}

/// The value of the last of the parts at a point of a line through the coordinates; `None` at poles and
/// with roots or functions. The parts are in ascending order.
pub fn on_line(graph: &Graph, parts: &[ExprId], step: Residue) -> Option<Residue> {
    let symbol = |symbol| {
        let value = symbol_value(0, symbol);
        match symbol {
            Symbol::Coordinate(i) => value.plus(step.times(drawn(0, DIRECTION, i as u64))),
            _ => value,
        }
    };
    values(graph, parts, pi_value(0), &symbol)?.last().copied()
}

/// The values of expressions at a point; `None` as above.
pub fn at_point(graph: &Graph, roots: &[ExprId], point: usize) -> Option<Vec<Residue>> {
    let parts = graph.dependencies(roots);
    let symbol = |symbol| symbol_value(point, symbol);
    let values = values(graph, &parts, pi_value(point), &symbol)?;
    let of = |root: &ExprId| Some(values[parts.binary_search(root).ok()?]);
    roots.iter().map(of).collect()
}

/// The values of the parts, which are in ascending order.
fn values(
    graph: &Graph,
    parts: &[ExprId],
    pi: Residue,
    symbol: &dyn Fn(Symbol) -> Residue,
) -> Option<Vec<Residue>> {
    let mut values: Vec<Residue> = Vec::with_capacity(parts.len());
    for id in parts {
        let of = |child: &ExprId| Some(values[parts.binary_search(child).ok()?]);
        let value = match graph.node(*id) {
            Node::Number(value) => Residue::from_rational(value)?,
            Node::Pi => pi,
            Node::Symbol(name) => symbol(*name),
            Node::Sum { constant, terms } => {
                let mut sum = Residue::from_rational(constant)?;
                for (term, coefficient) in terms {
                    sum = sum.plus(of(term)?.times(Residue::from_rational(coefficient)?));
                }
                sum
            }
            // proofs are about normal forms
            Node::Written(_) => return None,
            Node::Product(factors) => {
                let mut product = Residue::ONE;
                for (base, exponent) in factors {
                    product = product.times(of(base)?.power(exponent.to_integer()?)?);
                }
                product
            }
            Node::Call(..) => return None,
        };
        values.push(value);
    }
    Some(values)
}
