//! Random systems: the scheduled programs of all kernels equal exact evaluation, and the field is
//! that of the structure constants. Algebras are direct sums, semidirect products and rational
//! changes of basis of known ones, n from 2 to 8.

use std::collections::HashMap;

use lie_codegen::compile::compile_spec;
use lie_codegen::derive::{Kernel, Source};
use lie_symbolic::schedule::{Operation, Program, Value};
use lie_symbolic::symbolic::{Graph, Symbol};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

/// Runs a program; an interpreter that shares nothing with the scheduler.
fn run(program: &Program, graph: &Graph, value: &dyn Fn(Symbol) -> f64) -> Vec<f64> {
    let mut done: Vec<f64> = Vec::new();
    let get = |operand: &Value, done: &[f64]| match operand {
        Value::Symbol(symbol) => value(*symbol),
        Value::Prepared(id) => graph.evaluate(*id, value),
        Value::Number(number) => number.to_f64(),
        Value::Temporary(index) => done[*index],
    };
    for operation in &program.operations {
        let at = |operand: &Value| get(operand, &done);
        let result = match operation {
            Operation::Add(a, b) => at(a) + at(b),
            Operation::Sub(a, b) => at(a) - at(b),
            Operation::Mul(a, b) => at(a) * at(b),
            Operation::Div(a, b) => at(a) / at(b),
            Operation::Neg(a) => -at(a),
            Operation::Sqrt(a) => at(a).sqrt(),
            Operation::Power(a, exponent) => at(a).powf(exponent.to_f64()),
            Operation::Call(function, arguments) => {
                function.evaluate(&arguments.iter().map(at).collect::<Vec<_>>())
            }
        };
        done.push(result);
    }
    program
        .outputs
        .iter()
        .map(|output| get(output, &done))
        .collect()
}

/// A value for every symbol: defined ones by their definitions, the others from the point.
fn values(kernel: &Kernel, graph: &Graph, point: &dyn Fn(Symbol) -> f64) -> HashMap<Symbol, f64> {
    let mut known = HashMap::new();
    for (symbol, definition) in &kernel.task.definitions {
        let at = |s: Symbol| known.get(&s).copied().unwrap_or_else(|| point(s));
        let value = graph.evaluate(*definition, &at);
        known.insert(*symbol, value);
    }
    known
}

fn kernels(source: &mut Source) -> Vec<Kernel> {
    let mut kernels = source.basic_kernels();
    kernels.extend(source.midpoint_kernels());
    kernels.extend(source.cayley_kernels().unwrap_or_default());
    kernels
}

/// Equal up to round-off of sums whose terms may be larger than the result.
fn near(a: f64, b: f64, scale: f64) -> bool {
    !b.is_finite() || (a - b).abs() <= 1e-10 * scale.max(b.abs()).max(1.0)
}

fn check(system: &crate::random::System, offset: f64) -> Result<(), TestCaseError> {
    let Ok(model) = compile_spec(&system.spec("Random")) else {
        return Err(TestCaseError::reject(
            "outside the domain or beyond a limit",
        ));
    };
    let parameters = model.defaults();
    let point = |symbol: Symbol| match symbol {
        Symbol::Parameter(p) => parameters[p],
        Symbol::Coordinate(i) => 0.31 + offset * (i as f64 + 0.5) / 7.0,
        Symbol::Input(i) => 0.17 - offset * (i as f64 - 3.0) / 9.0,
        Symbol::Step => 0.1,
        Symbol::Time => 0.0,
    };
    let mut source = Source::new(&model);
    for kernel in kernels(&mut source) {
        let program = kernel.program(&mut source.graph);
        let defined = values(&kernel, &source.graph, &point);
        let value = |s: Symbol| defined.get(&s).copied().unwrap_or_else(|| point(s));
        let exact = source.graph.evaluate_all(&kernel.task.outputs, &value);
        let scale = exact
            .iter()
            .filter(|x| x.is_finite())
            .fold(0.0_f64, |m, x| m.max(x.abs()));
        let found = run(&program, &source.graph, &point);
        for (found, exact) in found.iter().zip(&exact) {
            prop_assert!(
                near(*found, *exact, scale),
                "{}: {found} {exact}",
                kernel.name
            );
        }
    }
    // The field straight from the structure constants: f_j = C_ij^k dH_i mu_k.
    let n = system.dimension();
    let constants = system.constants();
    let graph = &mut source.graph;
    let slopes: Vec<f64> = (0..n)
        .map(|i| {
            let slope = graph.derivative(model.hamiltonian(), Symbol::Coordinate(i));
            graph.evaluate(slope, &point)
        })
        .collect();
    let field = kernels(&mut source)
        .into_iter()
        .find(|k| k.name == "vector_field")
        .expect("a field");
    let found = run(&field.program(&mut source.graph), &source.graph, &point);
    let lie_codegen::derive::Shape::Vector(places) = &field.shape else {
        panic!("a vector")
    };
    let component = |j: usize| -> f64 {
        let terms = (0..n).flat_map(|i| (0..n).map(move |k| (i, k)));
        terms
            .map(|(i, k)| constants[i][j][k] * slopes[i] * point(Symbol::Coordinate(k)))
            .sum()
    };
    for j in 0..n {
        let exact = component(j);
        let entry = places
            .iter()
            .position(|p| *p == j)
            .map_or(0.0, |place| found[place]);
        let scale = slopes.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
        prop_assert!(near(entry, exact, scale), "f_{j}: {entry} {exact}");
    }
    Ok(())
}

#[test]
fn programs_equal_exact_evaluation_on_random_systems() {
    random_systems(6);
}

#[test]
#[ignore = "minutes: .ci/nightly runs it"]
fn programs_equal_exact_evaluation_on_many_random_systems() {
    random_systems(120);
}

/// So many of them.
fn random_systems(cases: u32) {
    let config = Config {
        cases,
        max_global_rejects: 4000,
        failure_persistence: None,
        ..Config::default()
    };
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[18; 32]);
    let mut runner = TestRunner::new_with_rng(config, rng);
    let result = runner.run(
        &(crate::random::system(), 0.05..0.9_f64),
        |(system, offset)| check(&system, offset),
    );
    result.unwrap_or_else(|failure| panic!("{failure}"));
}
