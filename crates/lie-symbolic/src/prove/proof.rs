//! Identities that must hold: sums that are shown to be zero, or not.

use super::confirmation::Finding;
use super::normal::{NormalForm, Verdict};
use crate::symbolic::{ExprId, Graph, Symbol};

/// Longer expressions are not printed in full.
const LONGEST: usize = 300;

/// What is known of a sum that should be zero.
pub enum Proof {
    /// It is zero.
    Zero,
    /// It is not, and this is its text.
    Nonzero(String),
    /// It is zero at sample points, or no point of its domain was found, but that proves nothing.
    Unproven {
        /// Its text, where it is short.
        text: Option<String>,
        /// What is known of its values, as a clause.
        values: &'static str,
    },
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
        Verdict::Undecided | Verdict::Contradicted => {
            let values = match normal.finding(sum) {
                Finding::Zero => "although it is at sample points",
                Finding::Unknown => "and no point was found at which it is defined",
                Finding::Nonzero => {
                    let shown = text(graph.display(sum, name));
                    return Proof::Nonzero(shown.unwrap_or_else(long));
                }
            };
            let text = text(graph.display(sum, name));
            return Proof::Unproven { text, values };
        }
    };
    Proof::Nonzero(text(shown).unwrap_or_else(long))
}

fn long() -> String {
    "a long expression, not zero".into()
}
