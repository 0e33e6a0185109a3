//! Rational functions modulo a prime: one that is zero is zero there at every point, and one that is not hardly
//! ever.

use std::collections::HashMap;

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::ToPrimitive;

use crate::exact::Rational;
use crate::prove::sample::{Sample, Samples};
use crate::symbolic::{ExprId, Graph, Node};

/// A Mersenne prime.
const PRIME: u64 = (1 << 61) - 1;
/// Points that are looked at, and points that are tried where something is divided by zero.
const POINTS: usize = 2;
const TRIES: usize = 8;

/// What an expression is at a point.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Residue {
    Value(u64),
    /// Something is divided by zero.
    Undefined,
    /// It is no rational function.
    Other,
}

/// Values of the expressions of one arena at points of a prime field.
pub(super) struct Residues<'a> {
    graph: &'a Graph,
    known: Vec<HashMap<ExprId, Residue>>,
}

impl<'a> Residues<'a> {
    pub fn new(graph: &'a Graph) -> Self {
        let known = Vec::new();
        Self { graph, known }
    }

    /// Whether a rational function is zero at all points; `None` for other functions, and where it is not defined.
    pub fn vanishes(&mut self, id: ExprId) -> Option<bool> {
        let mut seen = 0;
        for (point, sample) in Samples::new().enumerate().take(TRIES) {
            if self.known.len() == point {
                self.known.push(HashMap::new());
            }
            match self.evaluate(id, point, sample) {
                Residue::Value(0) => seen += 1,
                Residue::Value(_) => return Some(false),
                Residue::Undefined => {}
                Residue::Other => return None,
            }
            if seen == POINTS {
                return Some(true);
            }
        }
        None
    }

    fn evaluate(&mut self, id: ExprId, point: usize, sample: Sample) -> Residue {
        let graph = self.graph;
        let known = &mut self.known[point];
        if let Some(value) = known.get(&id) {
            return *value;
        }
        for part in graph.dependencies(&[id]) {
            if !known.contains_key(&part) {
                let value = node(graph, part, known, sample);
                if value == Residue::Other {
                    known.insert(id, value);
                    return value;
                }
                known.insert(part, value);
            }
        }
        known[&id]
    }
}

fn node(graph: &Graph, id: ExprId, known: &HashMap<ExprId, Residue>, sample: Sample) -> Residue {
    let of_number = |value: &Rational| number(value).map_or(Residue::Undefined, Residue::Value);
    match graph.node(id) {
        // proofs are about normal forms
        Node::Written(_) => Residue::Other,
        Node::Number(value) => of_number(value),
        Node::Symbol(symbol) => Residue::Value(sample.bits(*symbol) % PRIME),
        Node::Sum { constant, terms } => {
            let mut sum = of_number(constant);
            for (term, coefficient) in terms {
                let (Residue::Value(a), Residue::Value(c), Residue::Value(b)) =
                    (sum, of_number(coefficient), known[term])
                else {
                    return Residue::Undefined;
                };
                sum = Residue::Value((a + product(b, c)) % PRIME);
            }
            sum
        }
        Node::Product(factors) => {
            let mut value = 1;
            for (base, exponent) in factors {
                let Some(exponent) = exponent.to_integer() else {
                    return Residue::Other;
                };
                let Residue::Value(base) = known[base] else {
                    return Residue::Undefined;
                };
                if exponent < 0 && base == 0 {
                    return Residue::Undefined;
                }
                let power = power(base, exponent.unsigned_abs());
                value = product(value, if exponent < 0 { inverse(power) } else { power });
            }
            Residue::Value(value)
        }
        Node::Pi | Node::Call(..) => Residue::Other,
    }
}

fn product(a: u64, b: u64) -> u64 {
    (u128::from(a) * u128::from(b) % u128::from(PRIME)) as u64
}

fn power(base: u64, mut exponent: u64) -> u64 {
    let (mut result, mut square) = (1, base);
    while exponent > 0 {
        if exponent & 1 == 1 {
            result = product(result, square);
        }
        square = product(square, square);
        exponent >>= 1;
    }
    result
}

fn inverse(value: u64) -> u64 {
    power(value, PRIME - 2)
}

/// The residue of a number; `None` where the prime divides the denominator.
fn number(value: &Rational) -> Option<u64> {
    let residue = |n: &BigInt| n.mod_floor(&BigInt::from(PRIME)).to_u64();
    if let Some(integer) = value.to_integer() {
        return Some(integer.rem_euclid(PRIME as i64) as u64);
    }
    let value = value.to_big();
    let (n, d) = (residue(value.numer())?, residue(value.denom())?);
    (d != 0).then(|| product(n, inverse(d)))
}
