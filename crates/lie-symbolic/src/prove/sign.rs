//! The signs of constants.

use super::confirmation;
use super::normal::{NormalForm, Verdict};
use crate::exact::Budget;
use crate::symbolic::{ExprId, Graph};

/// Work allowed for the proof that a constant is zero.
const WORK: u64 = 500_000;

/// The sign of a constant; `None` where it has no value, or where 67 digits do not tell it from zero and it
/// cannot be shown to be zero.
pub fn constant(graph: &Graph, id: ExprId) -> Option<i32> {
    let value = confirmation::constant(graph, id)?;
    if let Some(sign) = value.sign() {
        return Some(sign);
    }
    let budget = Budget::new(WORK);
    let verdict = NormalForm::new(graph, &budget).verdict(id);
    matches!(verdict, Verdict::Zero).then_some(0)
}
