//! Reuse: an operation that was done before is not done again. The passes before share what is equal as an
//! expression; when long products are written as pairs, more can become equal.

use std::collections::HashMap;

use super::program::{Counts, Operation, Program, Value};

/// The program without repeated operations.
pub fn reuse(program: Program) -> Program {
    let mut places: HashMap<String, usize> = HashMap::new();
    let mut kept: Vec<Operation> = Vec::with_capacity(program.operations.len());
    // where the result of each operation is now
    let mut moved: Vec<usize> = Vec::with_capacity(program.operations.len());
    let mut counts = Counts::default();
    for operation in program.operations {
        let operation = renamed(operation, &moved);
        let place = *places.entry(key(&operation)).or_insert_with(|| {
            counts.record(&operation);
            kept.push(operation);
            kept.len() - 1
        });
        moved.push(place);
    }
    let outputs = program.outputs.into_iter();
    Program {
        outputs: outputs.map(|value| place(value, &moved)).collect(),
        operations: kept,
        counts,
    }
}

fn place(value: Value, moved: &[usize]) -> Value {
    match value {
        Value::Temporary(index) => Value::Temporary(moved[index]),
        other => other,
    }
}

fn renamed(operation: Operation, moved: &[usize]) -> Operation {
    let at = |value| place(value, moved);
    match operation {
        Operation::Add(a, b) => Operation::Add(at(a), at(b)),
        Operation::Sub(a, b) => Operation::Sub(at(a), at(b)),
        Operation::Mul(a, b) => Operation::Mul(at(a), at(b)),
        Operation::Div(a, b) => Operation::Div(at(a), at(b)),
        Operation::Neg(a) => Operation::Neg(at(a)),
        Operation::Sqrt(a) => Operation::Sqrt(at(a)),
        Operation::Power(a, exponent) => Operation::Power(at(a), exponent),
        Operation::Call(function, arguments) => {
            Operation::Call(function, arguments.into_iter().map(at).collect())
        }
    }
}

/// Equal for operations with equal results: sums and products do not know the order of their operands.
fn key(operation: &Operation) -> String {
    match operation {
        Operation::Add(a, b) if b < a => format!("{:?}", Operation::Add(b.clone(), a.clone())),
        Operation::Mul(a, b) if b < a => format!("{:?}", Operation::Mul(b.clone(), a.clone())),
        other => format!("{other:?}"),
    }
}
