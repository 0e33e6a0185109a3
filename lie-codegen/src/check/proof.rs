//! Identities that must hold: sums that are shown to be zero, or not.

use super::normal::{NormalForm, Verdict};
use super::sample::Samples;
use crate::symbolic::{ExprId, Graph, Symbol};

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

/// Examines a sum with its terms.
pub fn examine(
    normal: &mut NormalForm<'_>,
    graph: &Graph,
    (terms, sum): (&[ExprId], ExprId),
    name: &dyn Fn(Symbol) -> String,
) -> Proof {
    let text = |text: String| (text.chars().count() <= LONGEST).then_some(text);
    let shown = match normal.verdict(sum) {
        Verdict::Zero => return Proof::Zero,
        Verdict::Nonzero(value) => normal.display(&value, name),
        Verdict::Undecided if is_nonzero(graph, terms) => graph.display(sum, name),
        Verdict::Undecided => return Proof::Unproven(text(graph.display(sum, name))),
    };
    Proof::Nonzero(text(shown).unwrap_or_else(|| "a long expression, not zero".into()))
}

/// Whether the sum of the terms is not zero at some point, beyond round-off.
fn is_nonzero(graph: &Graph, terms: &[ExprId]) -> bool {
    Samples::new().take(40).any(|point| {
        let values = graph.evaluate_all(terms, &|symbol| point.value(symbol));
        let (sum, scale) = values
            .iter()
            .fold((0.0, 0.0), |(s, a), v| (s + v, a + v.abs()));
        f64::is_finite(scale) && f64::abs(sum) > 1e-7 * scale
    })
}
