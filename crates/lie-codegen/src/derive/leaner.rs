//! Derivatives of a list of definitions in the form that takes fewer operations.

use super::Source;
use super::generating::too_large;
use super::tape::{Tangents, Tape};
use lie_symbolic::schedule::{KnownSymbols, Operation, Task, schedule};
use lie_symbolic::symbolic::{ExprId, Symbol};

/// Lists longer than this are not scheduled twice.
const MOST_COMPARED: usize = 400;

/// Values with their derivatives, and the definitions of both.
pub(crate) struct Derived {
    pub definitions: Vec<(Symbol, ExprId)>,
    pub values: Vec<ExprId>,
    pub rows: Vec<Vec<ExprId>>,
}

/// The derivatives of values in symbols, by tangents as they are `preferred` or by the others if that takes fewer
/// operations once they are finished as they will be written out; the list is that of the choice.
pub(crate) fn leaner_jacobian(
    source: &mut Source,
    tape: &mut Tape,
    values: &[ExprId],
    symbols: &[Symbol],
    preferred: Tangents,
    finish: &dyn Fn(&mut Source, Derived) -> Derived,
) -> Vec<Vec<ExprId>> {
    let mut other = tape.clone();
    let rows = tape.jacobian_in(source, values, symbols, preferred);
    if too_large(source, tape) || tape.definitions().len() > MOST_COMPARED {
        return rows;
    }
    let other_rows = other.jacobian_in(source, values, symbols, preferred.opposite());
    if too_large(source, &other) || other.definitions().len() > MOST_COMPARED {
        return rows;
    }
    let mut weight = |tape: &Tape, rows: &[Vec<ExprId>]| {
        let derived = Derived {
            definitions: tape.definitions().to_vec(),
            values: values.to_vec(),
            rows: rows.to_vec(),
        };
        let derived = finish(source, derived);
        let rows = derived.rows.into_iter().flatten();
        let task = Task {
            definitions: derived.definitions,
            outputs: derived.values.into_iter().chain(rows).collect(),
            known: KnownSymbols::Step,
        };
        let program = schedule(&mut source.graph, &task);
        // derivatives in place may cancel only once they are computed: what is left is no form to write out
        let cancels = |operation: &Operation| matches!(operation, Operation::Sub(a, b) if a == b);
        match program.operations.iter().any(cancels) {
            true => usize::MAX,
            false => program.counts.weight(),
        }
    };
    if weight(tape, &rows) <= weight(&other, &other_rows) {
        return rows;
    }
    *tape = other;
    other_rows
}
