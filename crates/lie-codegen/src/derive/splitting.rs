//! The flows of the coordinate pieces of a separable Hamiltonian: `exp(s ad*_(e_i)) mu` with
//! `s = t f_i'(mu_i)`.
//!
//! An entry that is only scaled is multiplied by an exponential, or divided by it where another grows
//! as this one shrinks, so that their product keeps its digits. Of all others the increment is
//! derived, which is added to mu last: then the only rounding in units of mu is that of this addition,
//! and coefficients close to 1 lose nothing.
//!
//! A rotation of a plane is three [shears](super::shears). Where other entries follow it, for the angle
//! `a = w s`, with `T = tan(a/2)`: `sin a = 2 T/(1 + T^2)` and `1 - cos a = T sin a`, one function call;
//! whatever the error of T, the squares of sine and cosine then sum to 1 up to `a^2` times round-off.

use super::field::mu;
use super::shears::turned;
use super::{Kernel, Source};
use crate::structure::one_parameter::{Block, Form};
use crate::structure::separable::Piece;
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{Elementary, ExprId, Graph, Node, Symbol};

/// Symbols of intermediate quantities, beyond those of all vector arguments.
const AUXILIARY: usize = 1 << 24;

/// The flow of one piece.
#[derive(Clone, Debug)]
pub struct PieceKernel {
    /// The coordinate i.
    pub coordinate: usize,
    /// What changes mu over a time t, if there is a closed form.
    pub kernel: Option<Kernel>,
    /// What is done with each output of the kernel.
    pub updates: Vec<Update>,
}

/// What is done to an entry of mu with an output.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Update {
    /// It is added.
    Add,
    /// It is subtracted: every term of the increment is negative.
    Subtract,
    /// The entry is multiplied by it.
    Multiply,
    /// The entry is divided by it.
    Divide,
    /// The entry becomes it.
    Replace,
}

/// Definitions under construction, each made once.
#[derive(Debug, Default)]
pub(crate) struct Definitions {
    made: Vec<(Symbol, ExprId)>,
}

impl Definitions {
    /// The definitions in order.
    pub(crate) fn all(&self) -> &[(Symbol, ExprId)] {
        &self.made
    }

    /// The symbol of a quantity.
    pub(super) fn define(&mut self, source: &mut Source, value: ExprId) -> ExprId {
        let known = self.made.iter().find(|(_, made)| *made == value);
        let symbol = match known {
            Some((symbol, _)) => *symbol,
            None => {
                let symbol = Symbol::Input(AUXILIARY + self.made.len());
                self.made.push((symbol, value));
                symbol
            }
        };
        source.graph.symbol(symbol)
    }

    /// The exponential of an expression, or its inverse where that is at hand.
    pub(super) fn exponential(&mut self, source: &mut Source, exponent: ExprId) -> (ExprId, bool) {
        let opposite = source.graph.neg(exponent);
        let opposite = source.graph.call(Elementary::Exp, &[opposite]);
        if let Some((symbol, _)) = self.made.iter().find(|(_, made)| *made == opposite) {
            return (source.graph.symbol(*symbol), true);
        }
        let value = source.graph.call(Elementary::Exp, &[exponent]);
        (self.define(source, value), false)
    }
}

/// `sigma = c s`
pub(super) fn sigma(source: &mut Source, block: &Block, s: ExprId) -> ExprId {
    match &block.factor {
        None => s,
        Some(factor) => {
            let factor = source.graph.rational_function(factor);
            source.graph.mul(factor, s)
        }
    }
}

pub(super) fn kernels(
    source: &mut Source,
    pieces: &[Piece],
    slopes: &[ExprId],
) -> Vec<PieceKernel> {
    let flow = |piece: &Piece| match &piece.blocks {
        Some(blocks) => kernel(source, piece.coordinate, blocks, slopes[piece.coordinate]),
        None => PieceKernel {
            coordinate: piece.coordinate,
            kernel: None,
            updates: Vec::new(),
        },
    };
    pieces.iter().map(flow).collect()
}

/// `mu -> exp(t ad*_(e_i)) mu`.
pub(crate) fn action(source: &mut Source, coordinate: usize, blocks: &[Block]) -> PieceKernel {
    let one = source.graph.integer(1);
    kernel(source, coordinate, blocks, one)
}

pub(super) fn kernel(
    source: &mut Source,
    coordinate: usize,
    blocks: &[Block],
    slope: ExprId,
) -> PieceKernel {
    let mut definitions = Definitions::default();
    let time = source.graph.symbol(Symbol::Time);
    let s = source.graph.mul(time, slope);
    let mut increments: Vec<Vec<ExprId>> = vec![Vec::new(); source.dimension];
    let mut changes = vec![None; source.dimension];
    for block in blocks {
        if let (Some(row), Form::Exponential(a)) = (block.only_row(), &block.form) {
            let exponent = sigma(source, block, s);
            let exponent = source.graph.scale(exponent, a);
            let (value, inverted) = definitions.exponential(source, exponent);
            changes[row] = Some(if inverted {
                (Update::Divide, value)
            } else {
                (Update::Multiply, value)
            });
            continue;
        }
        if let Some(turned) = turned(source, block, s, &mut definitions) {
            for (row, value) in turned {
                changes[row] = Some((Update::Replace, value));
            }
            continue;
        }
        let weights = weights(source, block, s, &mut definitions);
        for (weight, power) in weights.into_iter().zip(&block.powers) {
            for (row, column, value) in power {
                let entry = source.graph.symbol(Symbol::Coordinate(*column));
                let term = source.graph.mul(weight, entry);
                increments[*row].push(source.graph.scale(term, value));
            }
        }
    }
    let (mut updates, mut values) = (Vec::new(), Vec::new());
    for (change, terms) in changes.into_iter().zip(increments) {
        let (update, value) = change.unwrap_or_else(|| {
            let sum = source.graph.sum(&terms);
            if all_negative(&source.graph, sum) {
                (Update::Subtract, source.graph.neg(sum))
            } else {
                (Update::Add, sum)
            }
        });
        if !source.graph.is_zero(value) {
            updates.push(update);
        }
        values.push(value);
    }
    let arguments = vec![mu(source)];
    let mut kernel = Kernel::vector(
        &source.graph,
        "flow",
        "`mu -> exp(s ad*_(e_i)) mu`, `s = t f_i'(mu_i)`",
        arguments,
        &values,
    );
    kernel.task.definitions = definitions.made;
    PieceKernel {
        coordinate,
        kernel: Some(kernel),
        updates,
    }
}

/// Whether every term of a sum is negative.
fn all_negative(graph: &Graph, sum: ExprId) -> bool {
    match graph.node(sum) {
        Node::Sum { constant, terms } => {
            constant.is_zero() && terms.iter().all(|(_, factor)| factor.is_negative())
        }
        _ => false,
    }
}

/// The functions of s that stand before R, R^2, … of a block.
pub(super) fn weights(
    source: &mut Source,
    block: &Block,
    s: ExprId,
    definitions: &mut Definitions,
) -> Vec<ExprId> {
    let sigma = sigma(source, block, s);
    match &block.form {
        Form::Polynomial => {
            let sigma = definitions.define(source, sigma);
            let mut weight = sigma;
            let mut weights = vec![weight];
            for power in 2..=block.powers.len() {
                let ratio = Rational::new(1, power as i64).unwrap_or(Rational::ONE);
                let next = source.graph.mul(weight, sigma);
                weight = source.graph.scale(next, &ratio);
                weights.push(weight);
            }
            weights
        }
        Form::Exponential(a) => {
            let exponent = source.graph.scale(sigma, a);
            let (value, inverted) = definitions.exponential(source, exponent);
            let power = Rational::from(if inverted { -1 } else { 1 });
            let value = source.graph.pow(value, &power);
            let one = source.graph.integer(1);
            let grown = source.graph.sub(value, one);
            let grown = definitions.define(source, grown);
            vec![source.graph.scale(grown, &(&Rational::ONE / a))]
        }
        Form::Quadratic(kappa) => {
            let size = source.graph.number(kappa.abs());
            let half = Rational::new(1, 2).unwrap_or(Rational::ONE);
            let frequency = source.graph.pow(size, &half);
            let angle = source.graph.mul(frequency, sigma);
            let angle = source.graph.scale(angle, &half);
            if kappa.is_negative() {
                periodic(source, frequency, angle, definitions)
            } else {
                hyperbolic(source, frequency, angle, definitions)
            }
        }
    }
}

/// `sin(2 a)/w` and `(1 - cos(2 a))/w^2`, by the tangent of a.
fn periodic(
    source: &mut Source,
    frequency: ExprId,
    angle: ExprId,
    definitions: &mut Definitions,
) -> Vec<ExprId> {
    let tangent = source.graph.call(Elementary::Tan, &[angle]);
    let tangent = definitions.define(source, tangent);
    let graph = &mut source.graph;
    let (one, two) = (graph.integer(1), Rational::from(2));
    let square = graph.mul(tangent, tangent);
    let denominator = graph.add(one, square);
    let numerator = graph.scale(tangent, &two);
    let sine = graph.div(numerator, denominator);
    let sine = graph.div(sine, frequency);
    let sine = definitions.define(source, sine);
    let versine = source.graph.mul(tangent, sine);
    let versine = source.graph.div(versine, frequency);
    vec![sine, definitions.define(source, versine)]
}

/// `sinh(2 a)/w` and `(cosh(2 a) - 1)/w^2`, by the functions of a.
fn hyperbolic(
    source: &mut Source,
    frequency: ExprId,
    angle: ExprId,
    definitions: &mut Definitions,
) -> Vec<ExprId> {
    let sine = source.graph.call(Elementary::Sinh, &[angle]);
    let cosine = source.graph.call(Elementary::Cosh, &[angle]);
    let sine = definitions.define(source, sine);
    let double = source.graph.scale(sine, &Rational::from(2));
    let double = source.graph.div(double, frequency);
    let double = definitions.define(source, double);
    let first = source.graph.mul(double, cosine);
    let second = source.graph.mul(double, sine);
    let second = source.graph.div(second, frequency);
    vec![
        definitions.define(source, first),
        definitions.define(source, second),
    ]
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use crate::compile::compile_spec;
    use crate::derive::Source;
    use lie_symbolic::symbolic::Symbol;

    /// On the filiform algebra `[e1, e2] = e3, [e1, e3] = e4, [e1, e4] = e5` the flow of `mu1^2/2` has terms of the
    /// third order.
    #[test]
    fn a_nilpotent_flow_has_all_its_terms() {
        let spec = r#"{"format": 1, "name": "Filiform",
            "algebra": {"basis": ["e1", "e2", "e3", "e4", "e5"],
                        "brackets": ["[e1, e2] = e3", "[e1, e3] = e4", "[e1, e4] = e5"]},
            "state": ["x", "y", "z", "u", "v"], "hamiltonian": "x^2/2 + y^2"}"#;
        let model = compile_spec(spec).expect("a spec without mistakes");
        let mut source = Source::new(&model);
        let pieces = source.splitting_kernels().expect("H is separable");
        let flow = pieces.iter().find(|piece| piece.coordinate == 0);
        let kernel = flow
            .and_then(|flow| flow.kernel.clone())
            .expect("a closed form");
        let (mu, time) = ([0.7, -0.3, 1.1, 0.4, -0.9], 1.3);
        let mut known = BTreeMap::new();
        for (symbol, value) in &kernel.task.definitions {
            let value = source
                .graph
                .evaluate(*value, &|symbol| at(symbol, &mu, time, &known));
            known.insert(*symbol, value);
        }
        let values = source.graph.evaluate_all(&kernel.task.outputs, &|symbol| {
            at(symbol, &mu, time, &known)
        });
        let s = time * mu[0];
        let [_, _, z, u, v] = mu;
        let expected = [
            s * z + s * s / 2.0 * u + s * s * s / 6.0 * v,
            s * u + s * s / 2.0 * v,
            s * v,
        ];
        assert_eq!(values.len(), 3);
        for (update, (value, expected)) in flow
            .expect("above")
            .updates
            .iter()
            .zip(values.iter().zip(expected))
        {
            let sign = if *update == super::Update::Subtract {
                -1.0
            } else {
                1.0
            };
            assert!(
                (sign * value - expected).abs() < 1e-14,
                "{value} {expected}"
            );
        }
    }

    fn at(symbol: Symbol, mu: &[f64], time: f64, known: &BTreeMap<Symbol, f64>) -> f64 {
        match symbol {
            Symbol::Coordinate(i) => mu[i],
            Symbol::Time => time,
            other => known.get(&other).copied().unwrap_or(f64::NAN),
        }
    }
}
