//! Up to which size of a state polynomials are finite, so that many states need not be evaluated one by one.

use super::Domain;
use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Node, Symbol};

/// Sizes of entries that are tried, the largest first.
const SIZES: [f64; 4] = [1e50, 1e20, 1e6, 1e3];

/// A part of what must be finite.
#[derive(Clone, Copy)]
struct Part {
    /// Whether it depends on more than parameters.
    varies: bool,
    /// Its absolute value at most; infinite where that is not known.
    size: f64,
}

impl Domain {
    /// Whether all is finite at a state because its entries are no larger than those at which all is, whatever their signs are.
    pub(in crate::check) fn is_certain(&self, mu: &[f64], parameters: &[f64]) -> bool {
        let certain = || {
            let mut sizes = SIZES.into_iter();
            let size = sizes.find(|size| self.is_finite_up_to(*size, parameters));
            (parameters.to_vec(), size)
        };
        let (known, size) = self.certain.get_or_init(certain);
        let within = |size: f64| mu.iter().all(|entry| entry.abs() <= size);
        known == parameters && size.is_some_and(within)
    }

    fn is_finite_up_to(&self, size: f64, parameters: &[f64]) -> bool {
        let count = self.parts.last().map_or(0, |last| last.index() + 1);
        let unknown = Part {
            varies: true,
            size: f64::INFINITY,
        };
        let mut parts = vec![unknown; count];
        let mut values = vec![f64::NAN; count];
        let value = |symbol| match symbol {
            Symbol::Parameter(p) => parameters[p],
            _ => f64::NAN,
        };
        for &part in &self.parts {
            let known = |child: ExprId| values[child.index()];
            let here = self.graph.evaluate_node(part, &known, &value);
            values[part.index()] = here;
            parts[part.index()] = self.size_of(part, here, size, &parts);
        }
        // in another order of its terms a sum is larger by round-off
        let most = f64::MAX / 2.0;
        let mut functions = self.functions.iter();
        functions.all(|(root, _)| parts[root.index()].size <= most)
    }

    /// How large a part is whose value is this where it does not vary.
    fn size_of(&self, part: ExprId, value: f64, size: f64, parts: &[Part]) -> Part {
        let of = |child: &ExprId| parts[child.index()];
        let node = self.graph.node(part);
        let varies = match node {
            Node::Number(_) | Node::Pi | Node::Symbol(Symbol::Parameter(_)) => false,
            Node::Symbol(_) => true,
            Node::Sum { terms, .. } | Node::Written(terms) | Node::Product(terms) => {
                terms.iter().any(|(child, _)| of(child).varies)
            }
            Node::Call(_, arguments) => arguments.iter().any(|child| of(child).varies),
        };
        if !varies {
            let size = value.abs();
            return Part { varies, size };
        }
        let sum = |terms: &[(ExprId, Rational)]| -> f64 {
            let sizes = terms.iter();
            let sizes = sizes.map(|(child, c)| c.to_f64().abs() * of(child).size);
            sizes.sum()
        };
        let size = match node {
            Node::Symbol(Symbol::Coordinate(_)) => size,
            Node::Sum { constant, terms } => constant.to_f64().abs() + sum(terms),
            Node::Written(terms) => sum(terms),
            // a product of some of the factors may be larger than that of all
            Node::Product(factors) => factors.iter().fold(1.0, |product, (base, exponent)| {
                let Part { varies, size } = of(base);
                let natural = exponent.is_integer() && !exponent.is_negative();
                let power = match varies && !natural {
                    true => f64::INFINITY,
                    false => size.powf(exponent.to_f64()),
                };
                if power < 1.0 {
                    product
                } else {
                    product * power
                }
            }),
            _ => f64::INFINITY,
        };
        Part { varies, size }
    }
}
