//! Scheduled programs in any precision.

use std::collections::HashMap;

use lie_codegen::derive::{Kernel, Shape, Source};
use lie_symbolic::schedule::{KnownSymbols, Operation, Program, Task, Value, schedule};
use lie_symbolic::symbolic::{Elementary, ExprId, Function, Symbol};

use super::scalar::Number;

/// An interpreter of programs in any precision.
pub fn run<T: Number>(
    program: &Program,
    symbol: &dyn Fn(Symbol) -> T,
    prepared: &HashMap<ExprId, T>,
) -> Vec<T> {
    let mut done: Vec<T> = Vec::new();
    let get = |operand: &Value, done: &[T]| match operand {
        Value::Symbol(s) => symbol(*s),
        Value::Prepared(id) => prepared[id],
        Value::Number(number) => T::of(number.to_f64()),
        Value::Temporary(index) => done[*index],
    };
    for operation in &program.operations {
        let at = |operand: &Value| get(operand, &done);
        let result = match operation {
            Operation::Add(a, b) => at(a).add(at(b)),
            Operation::Sub(a, b) => at(a).sub(at(b)),
            Operation::Mul(a, b) => at(a).mul(at(b)),
            Operation::Div(a, b) => at(a).div(at(b)),
            Operation::Neg(a) => T::of(0.0).sub(at(a)),
            Operation::Sqrt(a) => at(a).sqrt(),
            Operation::Call(Function::Elementary(Elementary::Exp), arguments) => {
                at(&arguments[0]).exp()
            }
            other => panic!("{other:?} in a system without it"),
        };
        done.push(result);
    }
    let outputs = program.outputs.iter();
    outputs.map(|output| get(output, &done)).collect()
}

/// The prepared constants of a program, computed as generated code computes them.
pub fn constants<T: Number>(
    program: &Program,
    source: &mut Source,
    parameters: &[f64],
) -> HashMap<ExprId, T> {
    let operands = program.operations.iter().flat_map(Operation::operands);
    let ids: Vec<ExprId> = operands
        .chain(&program.outputs)
        .filter_map(|value| match value {
            Value::Prepared(id) => Some(*id),
            _ => None,
        })
        .collect();
    let task = Task {
        definitions: Vec::new(),
        outputs: ids.clone(),
        known: KnownSymbols::Nothing,
    };
    let preparation = schedule(&mut source.graph, &task);
    let symbol = |s| match s {
        Symbol::Parameter(i) => T::of(parameters[i]),
        other => panic!("{other:?} in a prepared constant"),
    };
    let values = run(&preparation, &symbol, &HashMap::new());
    ids.into_iter().zip(values).collect()
}

/// The entries of a kernel in the order of the full vector or matrix.
pub fn full<T: Number>(kernel: &Kernel, n: usize, values: Vec<T>) -> Vec<T> {
    let (length, places): (usize, Vec<usize>) = match &kernel.shape {
        Shape::Scalar => return values,
        Shape::Vector(places) => (n, places.clone()),
        Shape::Matrix(places) => (n * n, places.iter().map(|(i, j)| i * n + j).collect()),
        Shape::VectorAndMatrix(..) => panic!("not compared here"),
    };
    let mut all = vec![T::of(0.0); length];
    for (place, value) in places.into_iter().zip(values) {
        all[place] = value;
    }
    all
}
