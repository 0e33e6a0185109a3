//! No kernel of any system computes anything twice, adds a zero, multiplies by one, or raises to an
//! integer power by a function.

use std::collections::HashMap;

use lie_codegen::compile::{compile_spec, declared_choices, expand};
use lie_codegen::derive::{Kernel, Source};
use lie_symbolic::schedule::{Operation, Program, Value};

/// The operation with commuting operands in order.
fn normal(operation: &Operation) -> Operation {
    match operation.clone() {
        Operation::Add(a, b) if a > b => Operation::Add(b, a),
        Operation::Mul(a, b) if a > b => Operation::Mul(b, a),
        other => other,
    }
}

fn waste(program: &Program) -> Vec<String> {
    let mut seen: HashMap<String, usize> = HashMap::new();
    let mut found = Vec::new();
    let is =
        |value: &Value, n: &str| matches!(value, Value::Number(number) if number.to_string() == n);
    for (position, operation) in program.operations.iter().enumerate() {
        let text = format!("{:?}", normal(operation));
        if let Some(earlier) = seen.insert(text.clone(), position) {
            found.push(format!("{text} at {earlier} and {position}"));
        }
        let useless = match operation {
            Operation::Add(a, b) | Operation::Sub(a, b) => is(a, "0") || is(b, "0"),
            Operation::Mul(a, b) => [a, b].iter().any(|v| is(v, "0") || is(v, "1")),
            Operation::Div(a, b) => is(a, "0") || is(b, "1"),
            Operation::Power(_, exponent) => exponent.is_integer(),
            Operation::Call(..) | Operation::Sqrt(_) | Operation::Neg(_) => operation
                .operands()
                .iter()
                .all(|v| matches!(v, Value::Number(_))),
        };
        if useless {
            found.push(format!("{operation:?}"));
        }
    }
    found
}

#[test]
fn kernels_of_all_systems() {
    let folder = format!("{}/../../specs", env!("CARGO_MANIFEST_DIR"));
    let mut systems = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() || path.to_string_lossy().ends_with(".schema.json") {
            continue;
        }
        let model = compile_spec(&std::fs::read_to_string(&path).unwrap()).unwrap();
        let mut source = Source::new(&model);
        let mut kernels: Vec<Kernel> = source.basic_kernels();
        kernels.extend(source.midpoint_kernels());
        kernels.extend(source.cayley_kernels().unwrap_or_default());
        for kernel in kernels {
            let program = kernel.program(&mut source.graph);
            let found = waste(&program);
            assert!(
                found.is_empty(),
                "{} {}: {found:#?}",
                path.display(),
                kernel.name
            );
        }
        systems += 1;
    }
    assert!(systems >= 10);
}

/// The control: a program with a repeated product is caught.
#[test]
fn waste_is_found() {
    let x = Value::Symbol(lie_symbolic::symbolic::Symbol::Coordinate(0));
    let y = Value::Symbol(lie_symbolic::symbolic::Symbol::Coordinate(1));
    let program = Program {
        operations: vec![Operation::Mul(x.clone(), y.clone()), Operation::Mul(y, x)],
        ..Program::default()
    };
    assert_eq!(waste(&program).len(), 1);
}

/// nalgebra's own `fill` takes 13 instructions for each entry, a slice's a fraction of one.
#[test]
fn zeros_are_written_as_slices() {
    let folder = format!("{}/../../specs", env!("CARGO_MANIFEST_DIR"));
    let mut fills = 0;
    for name in ["su3_quadratic", "so3_free_rigid_body", "se3_kirchhoff"] {
        let text = std::fs::read_to_string(format!("{folder}/{name}.json")).unwrap();
        let model = compile_spec(&text).unwrap();
        let code = expand(&model, &declared_choices(&model));
        for line in code.lines().filter(|line| line.contains(".fill(")) {
            assert!(line.contains(".as_mut_slice().fill("), "{name}: {line}");
            fills += 1;
        }
    }
    assert!(fills > 5, "{fills}");
}
