//! Contradictions of the compiler with itself: a verdict of the prover that numbers refute.
//!
//! There should be none. Verdicts are asked for in many places, few of which have a report at hand, hence
//! the first contradiction is kept here until the checks end, which refuse the declaration because of it.

use std::cell::RefCell;

use crate::symbolic::{ExprId, Graph, Symbol};

/// Longer expressions are not printed.
const LONGEST: usize = 200;

thread_local! {
    static FOUND: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// Keeps an expression that was taken for zero, or for a polynomial of a degree, and is not.
pub fn keep(graph: &Graph, id: ExprId) {
    let name = |symbol: Symbol| match symbol {
        Symbol::Parameter(i) => format!("parameter{i}"),
        Symbol::Step => "h".into(),
        Symbol::Time => "t".into(),
        Symbol::Coordinate(i) => format!("state{i}"),
        Symbol::Input(i) => format!("input{i}"),
    };
    let text = graph.display(id, &name);
    let short = text.chars().count() <= LONGEST;
    let text = if short {
        text
    } else {
        "a long expression".into()
    };
    FOUND.with_borrow_mut(|found| *found = found.take().or(Some(text)));
}

/// Forgets what an earlier check left.
pub fn clear() {
    FOUND.take();
}

/// The text of the expression, if there was one.
pub fn take() -> Option<String> {
    FOUND.take()
}
