//! Identities that must hold: sums that are shown to be zero, or not.

use std::collections::HashMap;

use super::normal::{NormalForm, Verdict};
use super::sample::Samples;
use crate::symbolic::{ExprId, Graph, Node, Symbol};

/// Longer expressions are not printed in full.
const LONGEST: usize = 300;

/// What is known of a sum that should be zero.
pub enum Proof {
    /// It is zero.
    Zero,
    /// It is not, and this is its text.
    Nonzero(String),
    /// It is zero at sample points, but that proves nothing; its text, where it is short.
    Unproven(Option<String>),
}

/// Examines a sum.
pub fn examine(
    normal: &mut NormalForm<'_>,
    graph: &Graph,
    sum: ExprId,
    name: &dyn Fn(Symbol) -> String,
) -> Proof {
    let text = |text: String| (text.chars().count() <= LONGEST).then_some(text);
    let shown = match normal.verdict(sum) {
        Verdict::Zero => return Proof::Zero,
        Verdict::Nonzero(value) => normal.display(&value, name),
        Verdict::Undecided if is_nonzero(graph, sum) => graph.display(sum, name),
        Verdict::Undecided => return Proof::Unproven(text(graph.display(sum, name))),
    };
    Proof::Nonzero(text(shown).unwrap_or_else(|| "a long expression, not zero".into()))
}

/// Whether an expression is not zero at some point, beyond the round-off of what cancels in it.
fn is_nonzero(graph: &Graph, sum: ExprId) -> bool {
    let parts = graph.dependencies(&[sum]);
    Samples::new().take(40).any(|point| {
        let values = graph.evaluate_all(&parts, &|symbol| point.value(symbol));
        let mut sizes: HashMap<ExprId, f64> = HashMap::new();
        for (id, value) in parts.iter().zip(&values) {
            let size = match graph.node(*id) {
                Node::Sum { constant, terms } => terms
                    .iter()
                    .fold(constant.to_f64().abs(), |sum, (term, c)| {
                        sum + c.to_f64().abs() * sizes[term]
                    }),
                Node::Product(factors) => factors.iter().fold(1.0, |product, (base, e)| {
                    let e = e.to_f64();
                    let position = parts.binary_search(base);
                    let base_value = position.map_or(f64::NAN, |p| values[p].abs());
                    product
                        * if e > 0.0 {
                            sizes[base].powf(e)
                        } else {
                            base_value.powf(e)
                        }
                }),
                _ => value.abs(),
            };
            sizes.insert(*id, size);
        }
        let value = values.last().copied().unwrap_or(0.0).abs();
        let size = sizes[&sum];
        size.is_finite() && value > 1e-7 * size
    })
}
