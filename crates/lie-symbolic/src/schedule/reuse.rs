//! Reuse: an operation that was done before is not done again. The passes before share what is equal as an
//! expression; when long products are written as pairs, more can become equal.

use rustc_hash::FxHashMap as HashMap;

use super::program::{Counts, Operation, Program};

/// The program without repeated operations.
pub fn reuse(program: Program) -> Program {
    let mut places: HashMap<Operation, usize> = HashMap::default();
    let mut kept: Vec<Operation> = Vec::with_capacity(program.operations.len());
    // where the result of each operation is now
    let mut moved: Vec<usize> = Vec::with_capacity(program.operations.len());
    let mut counts = Counts::default();
    for operation in program.operations {
        let operation = operation.renumbered(&|index| moved[index]);
        let place = *places.entry(ordered(&operation)).or_insert_with(|| {
            counts.record(&operation);
            kept.push(operation);
            kept.len() - 1
        });
        moved.push(place);
    }
    let outputs = program.outputs.into_iter();
    Program {
        outputs: outputs
            .map(|value| value.renumbered(&|index| moved[index]))
            .collect(),
        operations: kept,
        counts,
    }
}

/// Sums and products do not know the order of their operands.
fn ordered(operation: &Operation) -> Operation {
    match operation {
        Operation::Add(a, b) if b < a => Operation::Add(b.clone(), a.clone()),
        Operation::Mul(a, b) if b < a => Operation::Mul(b.clone(), a.clone()),
        other => other.clone(),
    }
}
