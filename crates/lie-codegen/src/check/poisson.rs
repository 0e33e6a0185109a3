//! Brackets of coordinates: from `{x, y} = value` to the entries of the Poisson matrix.

use std::collections::BTreeMap;

use super::environment::{Allowed, Environment};
use super::lower::Lowering;
use crate::algebra::antisymmetry::{self, COORDINATES};
use lie_symbolic::exact::Budget;
use lie_symbolic::prove::normal::{NormalForm, Verdict};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::ast::{Bracket, Declaration, Name, Structure};
use lie_syntax::diagnostic::{Diagnostic, Kind, Origin};
use lie_syntax::suggest::{listed, misspelt};

/// Work allowed to compare two values.
const WORK: u64 = 5_000_000;

/// A bracket `{x_i, x_j} = value` with `i < j`.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The row i.
    pub row: usize,
    /// The column j.
    pub column: usize,
    /// The value, not the number zero.
    pub value: ExprId,
    /// Where it is declared.
    pub origin: Origin,
}

/// Lowers the brackets of coordinates: all of a general bracket, or those of a cocycle.
///
/// Antisymmetry is implied, so `{y, x}` may be left out; where it is given it must be `-{x, y}`,
/// because one of the two is a slip. The same pair twice is allowed if both say the same.
pub fn coordinate_brackets(
    declaration: &Declaration,
    graph: &mut Graph,
    environment: &Environment<'_>,
    name: &dyn Fn(Symbol) -> String,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<Vec<Entry>> {
    let (brackets, allowed) = match &declaration.structure {
        Structure::Lie { cocycle, .. } => (cocycle, Allowed::Parameters),
        Structure::General { brackets, .. } => (brackets, Allowed::State),
    };
    let mut known: BTreeMap<(usize, usize), (ExprId, &Bracket)> = BTreeMap::new();
    let mut complete = true;
    let position = |name: &Name| declaration.state.iter().position(|c| c.text == name.text);
    // The order in the arena, and with it the code, is that of the coordinates, not that of the text.
    let mut brackets: Vec<&Bracket> = brackets.iter().collect();
    brackets.sort_by_key(|bracket| {
        let (a, b) = (position(&bracket.left), position(&bracket.right));
        (a.min(b), a.max(b))
    });
    for bracket in brackets {
        let ends = [&bracket.left, &bracket.right].map(|name| {
            let index = position(name);
            if index.is_none() {
                mistakes.push(unknown(declaration, name));
            }
            index
        });
        let value = Lowering::new(graph, environment, mistakes, allowed).lower(&bracket.value);
        let ([Some(a), Some(b)], Some(value)) = (ends, value) else {
            complete = false;
            continue;
        };
        if a == b {
            if !is_zero(graph, value) {
                let value = graph.display(value, name);
                mistakes.push(antisymmetry::with_itself(bracket, COORDINATES, &value));
                complete = false;
            }
            continue;
        }
        let above = if a < b { value } else { graph.neg(value) };
        let pair = (a.min(b), a.max(b));
        let Some(&(first, earlier)) = known.get(&pair) else {
            known.insert(pair, (above, bracket));
            continue;
        };
        let difference = graph.sub(above, first);
        if !is_zero(graph, difference) {
            let negative = graph.neg(first);
            let shown = [first, negative].map(|value| graph.display(value, name));
            let [upper, lower] = shown.each_ref().map(String::as_str);
            let values = if a < b {
                [upper, lower]
            } else {
                [lower, upper]
            };
            let wrong = antisymmetry::contradiction(bracket, earlier, COORDINATES, values);
            mistakes.push(wrong);
            complete = false;
        }
    }
    complete.then(|| entries(graph, known))
}

/// What is not zero.
fn entries(graph: &Graph, known: BTreeMap<(usize, usize), (ExprId, &Bracket)>) -> Vec<Entry> {
    let known = known.into_iter();
    let entry = |((row, column), (value, bracket)): (_, (_, &Bracket))| Entry {
        row,
        column,
        value,
        origin: bracket.origin,
    };
    known
        .filter(|(_, (value, _))| !graph.is_zero(*value))
        .map(entry)
        .collect()
}

fn unknown(declaration: &Declaration, name: &Name) -> Diagnostic {
    let diagnostic = Diagnostic::new(
        Kind::UnknownSymbol,
        name.origin,
        format!("`{}` is not a coordinate of the state", name.text),
    );
    let state: Vec<&str> = declaration.state.iter().map(|c| c.text.as_str()).collect();
    diagnostic.help(match misspelt(&name.text, state.iter().copied()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("the state is {}", listed(&state)),
    })
}

fn is_zero(graph: &Graph, value: ExprId) -> bool {
    let budget = Budget::new(WORK);
    graph.is_zero(value)
        || matches!(
            NormalForm::new(graph, &budget).verdict(value),
            Verdict::Zero
        )
}
