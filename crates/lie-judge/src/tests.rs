use super::*;
use crate::derivatives::{derivatives, directions, gradient};
use lie_codegen::compile::compile_spec;
use lie_codegen::derive::{Kernel, Shape, Source};
use lie_symbolic::symbolic::{Graph, Symbol};

fn spec_text(name: &str) -> String {
    let path = format!("{}/../../specs/{name}.json", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).expect("the spec")
}

/// What a kernel gives for its arguments, its expressions evaluated before they are scheduled.
fn evaluated(
    graph: &Graph,
    kernel: &Kernel,
    arguments: &[Vec<f64>],
    parameters: &[f64],
) -> Vec<f64> {
    let value = |symbol: Symbol| {
        for (argument, values) in kernel.arguments.iter().zip(arguments) {
            if let Some(place) = argument.symbols.iter().position(|s| *s == symbol) {
                return values[place];
            }
        }
        match symbol {
            Symbol::Parameter(p) => parameters[p],
            _ => f64::NAN,
        }
    };
    let outputs = graph.evaluate_all(&kernel.task.outputs, &value);
    let n = arguments[0].len();
    let at = |places: &mut dyn Iterator<Item = usize>, length: usize, outputs: &[f64]| {
        let mut all = vec![0.0; length];
        for (place, value) in places.zip(outputs) {
            all[place] = *value;
        }
        all
    };
    match &kernel.shape {
        Shape::Scalar => outputs,
        Shape::Vector(places) => at(&mut places.iter().copied(), n, &outputs),
        Shape::Matrix(places) => at(&mut places.iter().map(|(i, j)| i * n + j), n * n, &outputs),
        Shape::VectorAndMatrix(vector, matrix) => {
            let first = at(&mut vector.iter().copied(), n, &outputs[..vector.len()]);
            let rest = &outputs[vector.len()..];
            let second = at(&mut matrix.iter().map(|(i, j)| i * n + j), n * n, rest);
            [first, second].concat()
        }
    }
}

/// Every basic kernel of a spec at two states; returns how many were compared.
fn check(name: &str) -> usize {
    check_text(name, &spec_text(name))
}

fn check_text(name: &str, text: &str) -> usize {
    let model = compile_spec(text).expect("a spec without mistakes");
    let parameters = model.defaults();
    let judge = Judge::of_spec(text, &model, &parameters).expect("a declaration");
    let mut source = Source::new(&model);
    let kernels = source.basic_kernels();
    let initial = model.initial_values(&parameters).expect("an initial state");
    let n = initial.len();
    let (mut compared, mut casimirs) = (0, 0);
    for turn in 0..2 {
        let noise = |k: usize, phase: f64| 0.2 * (7.3 * (k + 1) as f64 + phase).sin();
        let vector = |phase: f64| (0..n).map(|k| 3.0 * noise(k, phase)).collect::<Vec<f64>>();
        let moved = |(k, x): (usize, &f64)| x + f64::from(turn) * noise(k, 0.4);
        let mu: Vec<f64> = initial.iter().enumerate().map(moved).collect();
        for kernel in &kernels {
            let argument = |(place, argument): (usize, &lie_codegen::derive::Argument)| {
                if argument.name == "mu" {
                    mu.clone()
                } else {
                    vector(place as f64)
                }
            };
            let arguments: Vec<Vec<f64>> =
                kernel.arguments.iter().enumerate().map(argument).collect();
            let label = if kernel.name == "casimir_gradient" {
                casimirs += 1;
                format!("casimir_gradient {}", (casimirs - 1) % model.casimirs.len())
            } else {
                kernel.name.to_owned()
            };
            let mut values = evaluated(&source.graph, kernel, &arguments, &parameters);
            if kernel.name == "casimirs" {
                values.truncate(model.casimirs.len());
            }
            let mut sample = Sample {
                kernel: label,
                arguments,
                values,
                velocity: Vec::new(),
            };
            // the matrices of a larger algebra are the compiler's own
            if kernel.name == "triple" && model.configuration.is_some() {
                assert!(judge.judge(&sample).is_none());
                continue;
            }
            let verdict = judge.judge(&sample);
            let verdict = verdict.unwrap_or_else(|| panic!("{name}: {}", sample.kernel));
            assert!(verdict.excess <= 1.0, "{name}: {sample:?} {verdict:?}");
            compared += 1;
            // a sign, and the eighth digit, of the largest entry
            let sizes = sample.values.iter().map(|value| value.abs());
            let largest = sizes.clone().fold(0.0, f64::max);
            let Some(place) = sizes
                .clone()
                .position(|size| size == largest && size > 1e-3)
            else {
                continue;
            };
            for wrong in [-sample.values[place], sample.values[place] + 1e-8] {
                let right = sample.values[place];
                sample.values[place] = wrong;
                let verdict = judge.judge(&sample).expect("as before");
                assert!(verdict.excess > 1.0, "{name}: {} passes", sample.kernel);
                sample.values[place] = right;
            }
        }
    }
    compared
}

#[test]
fn the_kernels_of_the_specs_are_those_of_their_declarations() {
    for name in [
        "so3_free_rigid_body",
        "so3_nonpolynomial",
        "se3_heavy_top",
        "se3_kirchhoff",
        "se3_kirchhoff_full",
        "heisenberg_h3",
        "e2_pendulum",
        "sl2_quadratic",
        "so4_manakov",
        "toda3_solvable",
        "so3_cotangent_euler_arnold",
        "so3_cotangent_group",
        "so3_gravity_gradient",
        "canonical_pendulum",
        "lotka_volterra",
        "se2_circulation",
        "so3_gyrostat_lagrangian",
    ] {
        assert!(check(name) >= 14, "{name}");
    }
}

#[test]
fn kernels_with_every_inverse_and_root_are_those_of_the_declaration() {
    let text = r#"{
        "format": 1, "name": "Functions", "algebra": "so(3)", "state": ["x", "y", "z"],
        "parameters": {"a": 1.3},
        "hamiltonian":
            "cbrt(x)*z + cbrt(-2 - y^2) + log1p(x*y)/a + expm1(z/3)*x + asinh(a*y) + acosh(2 + x^2)*z + atanh(x/3) + hypot(x - y, 2*z)",
        "casimirs": ["c = log1p(x^2 + y^2 + z^2)"],
        "initial": ["1/2", "-2/3", "3/4"]
    }"#;
    assert!(check_text("functions", text) >= 14);
}

#[test]
fn kernels_with_branches_are_those_of_the_declaration() {
    let text = r#"{
        "format": 1, "name": "Branches", "algebra": "so(3)", "state": ["x", "y", "z"],
        "parameters": {"a": 1.3},
        "hamiltonian":
            "abs(x - 2*y)*z + max(x*y, z)^2 + min(a*x, y)*x + piecewise(x < -1: y^2, x*y <= 1/9: exp(x), y >= z: z^3, log(3 + x))",
        "casimirs": ["c = abs(x^2 + y^2 + z^2 - a)"],
        "initial": ["1/2", "-2/3", "3/4"]
    }"#;
    assert!(check_text("branches", text) >= 14);
}

#[test]
fn jets_have_the_derivatives_of_all_functions() {
    use lie_core::functions::{Domain, Elementary};
    let h = 1e-5;
    let elementary = Elementary::ALL.iter().map(|&function| {
        let x = match function.domain() {
            Domain::Positive | Domain::FromOne => 1.6,
            _ => 0.6,
        };
        let of =
            Box::new(move |x: Number| x.call(function).power(1.5)) as Box<dyn Fn(Number) -> Number>;
        (function.name(), x, of)
    });
    let angle =
        Box::new(|x: Number| x.atan2(&Number::rounded(0.7, 0.0))) as Box<dyn Fn(Number) -> Number>;
    for (function, x, of) in elementary.chain([("atan2", 0.6, angle)]) {
        let at = |x: f64| {
            let value = of(Number::input(x).variable(1).variable(2));
            let (at, slope) = (value.at(2), value.slope(2));
            [at.at(1), at.slope(1), slope.slope(1)].map(|number| number.value())
        };
        let (here, before, after) = (at(x), at(x - h), at(x + h));
        for order in 0..2 {
            let difference = (after[order] - before[order]) / (2.0 * h);
            let error = (difference - here[order + 1]).abs() / here[order + 1].abs();
            assert!(error < 1e-7, "{function}, derivative {order}: {error:e}");
        }
    }
}

/// `d/dx (x d/dy (x y)) = 2 x`: with one direction for both, the inner derivative would be x + y.
#[test]
fn derivatives_within_derivatives_have_directions_of_their_own() {
    let y = [Number::input(0.3)];
    let of = |x: &[Number]| {
        let inner = derivatives(&y, directions(x), |y| x[0].mul(&y[0]));
        x[0].mul(&inner.0[0])
    };
    let slope = gradient(&[Number::input(0.7)], of);
    assert_eq!(slope[0].value(), 1.4);
}

/// What is not known has no derivative that is.
#[test]
fn derivatives_of_what_is_unknown_are_unknown() {
    let unknown = Number::rounded(f64::NAN, 0.0);
    let slope = gradient(&[Number::input(0.7)], |x| x[0].add(&unknown));
    assert!(slope[0].value().is_nan());
}
