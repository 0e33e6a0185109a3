//! Functions with several branches, of which the compiled value is one: an angle jumps where it passes from pi
//! to -pi, and so does what is made of it, although its derivatives do not.
//!
//! A Casimir like that (`log(r) - a*atan(z/y)` of a spiral) is constant between jumps only: it is warned of, and no
//! method is held to it. What counts is `atan2`, and `atan` of what has a pole, of the coordinates. The other
//! functions are continuous where they are real.

use super::joints;
use crate::exact::Rational;
use crate::symbolic::{Elementary, ExprId, Function, Graph, Node, Symbol};

/// Whether a function may jump between points at which it is defined.
pub fn jumps(graph: &Graph, function: ExprId) -> bool {
    graph
        .dependencies(&[function])
        .into_iter()
        .any(|id| match graph.node(id) {
            Node::Call(Function::Atan2, _) => varies(graph, id),
            Node::Call(Function::Elementary(Elementary::Atan), arguments) => {
                has_pole(graph, arguments[0])
            }
            _ => false,
        })
        || has_gap(graph, function)
}

/// Whether branches are not known to meet at their joints.
fn has_gap(graph: &Graph, function: ExprId) -> bool {
    let joints = joints::find_joints(graph, function, &|_| String::new(), &|_| false);
    joints
        .iter()
        .any(|joint| joint.jump.is_none_or(|jump| jump == 0))
}

fn varies(graph: &Graph, id: ExprId) -> bool {
    let symbols = graph.symbols(id);
    symbols.iter().any(|s| matches!(s, Symbol::Coordinate(_)))
}

/// Whether something that varies is divided by, and may change its sign.
fn has_pole(graph: &Graph, id: ExprId) -> bool {
    graph
        .dependencies(&[id])
        .into_iter()
        .any(|id| match graph.node(id) {
            Node::Product(factors) => factors.iter().any(|(base, exponent)| {
                let odd = exponent.to_integer().is_some_and(|e| e < 0 && e % 2 != 0);
                odd && varies(graph, *base) && !is_positive(graph, *base)
            }),
            Node::Call(Function::Elementary(Elementary::Tan), _) => varies(graph, id),
            _ => false,
        })
}

/// Whether a function is not negative by its form: exp, cosh, even powers, roots, and sums of such.
fn is_positive(graph: &Graph, id: ExprId) -> bool {
    let even = |exponent: &Rational| exponent.to_integer().is_none_or(|e| e % 2 == 0);
    match graph.node(id) {
        Node::Number(value) => !value.is_negative(),
        Node::Pi | Node::Call(Function::Elementary(Elementary::Exp | Elementary::Cosh), _) => true,
        Node::Symbol(symbol) => graph.is_positive(*symbol),
        Node::Product(factors) => {
            let mut factors = factors.iter();
            factors.all(|(base, exponent)| even(exponent) || is_positive(graph, *base))
        }
        Node::Sum { constant, terms } => {
            let positive =
                |(term, c): &(ExprId, Rational)| !c.is_negative() && is_positive(graph, *term);
            !constant.is_negative() && terms.iter().all(positive)
        }
        // proofs are about normal forms
        Node::Call(..) | Node::Written(_) => false,
    }
}
