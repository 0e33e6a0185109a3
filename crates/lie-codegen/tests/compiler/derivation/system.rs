// A system with the values of its kernels, by expressions; steps, the flow, differences.

use std::collections::HashMap;

use lie_codegen::compile::compile_spec;
use lie_codegen::derive::{Kernel, Shape, Source};
use lie_symbolic::symbolic::Symbol;

pub struct System {
    pub name: String,
    pub source: Source,
    pub parameters: Vec<f64>,
    pub field: Kernel,
    pub matrix: Kernel,
}

/// The values of vector arguments by their names.
pub type Arguments<'a> = &'a [(&'a str, &'a [f64])];

impl System {
    pub fn of(name: &str, text: &str) -> Self {
        let model = compile_spec(text).expect("a sound declaration");
        let mut source = Source::new(&model);
        let basic = source.basic_kernels();
        let find = |name| basic.iter().find(|k| k.name == name).expect(name).clone();
        Self {
            name: name.into(),
            field: find("vector_field"),
            matrix: find("poisson_matrix"),
            parameters: model.defaults(),
            source,
        }
    }

    pub fn spec(name: &str) -> Self {
        let path = format!("{}/../../specs/{name}.json", env!("CARGO_MANIFEST_DIR"));
        Self::of(name, &std::fs::read_to_string(path).expect("a spec"))
    }

    /// The outputs of a kernel, without zeros that it leaves out.
    pub fn outputs(&self, kernel: &Kernel, h: f64, arguments: Arguments<'_>) -> Vec<f64> {
        let mut known: HashMap<Symbol, f64> = HashMap::new();
        for argument in &kernel.arguments {
            let values = arguments.iter().find(|(name, _)| *name == argument.name);
            let values = values.unwrap_or_else(|| panic!("{}: {}", kernel.name, argument.name));
            known.extend(
                argument
                    .symbols
                    .iter()
                    .copied()
                    .zip(values.1.iter().copied()),
            );
        }
        known.extend([(Symbol::Step, h), (Symbol::Time, h)]);
        for (p, value) in self.parameters.iter().enumerate() {
            known.insert(Symbol::Parameter(p), *value);
        }
        let graph = &self.source.graph;
        for (symbol, definition) in &kernel.task.definitions {
            let value =
                graph.evaluate(*definition, &|s| known.get(&s).copied().unwrap_or(f64::NAN));
            known.insert(*symbol, value);
        }
        let at = |symbol| known.get(&symbol).copied().unwrap_or(f64::NAN);
        graph.evaluate_all(&kernel.task.outputs, &at)
    }

    /// The vector and the matrix that a kernel writes, of n rows, and of n columns or those of the matrix.
    pub fn call(
        &self,
        kernel: &Kernel,
        h: f64,
        arguments: Arguments<'_>,
    ) -> (Vec<f64>, Vec<Vec<f64>>) {
        let outputs = self.outputs(kernel, h, arguments);
        let none = Vec::new();
        let (indices, places) = match &kernel.shape {
            Shape::Scalar => return (outputs, Vec::new()),
            Shape::Vector(indices) => (indices, &none),
            Shape::Matrix(places) => (&Vec::new(), places),
            Shape::VectorAndMatrix(indices, places) => (indices, places),
        };
        let n = arguments
            .iter()
            .map(|(_, values)| values.len())
            .max()
            .expect("arguments");
        let mut vector = vec![0.0; n];
        for (index, value) in indices.iter().zip(&outputs) {
            vector[*index] = *value;
        }
        let mut matrix = vec![vec![0.0; n]; n];
        for ((row, column), value) in places.iter().zip(&outputs[indices.len()..]) {
            matrix[*row][*column] = *value;
        }
        (vector, matrix)
    }

    pub fn energy(&self, mu: &[f64]) -> f64 {
        let hamiltonian = self.source.energy.expression().expect("an expression");
        self.source
            .graph
            .evaluate(hamiltonian.energy, &|symbol| match symbol {
                Symbol::Coordinate(i) => mu[i],
                Symbol::Parameter(p) => self.parameters[p],
                _ => f64::NAN,
            })
    }

    /// The arguments of an equation besides the state: the unknown, the inverse of the length of the step, ratios of
    /// spins.
    pub fn equation(
        &self,
        kernel: &Kernel,
        h: f64,
        mu: &[f64],
        u: &[f64],
    ) -> (Vec<f64>, Vec<Vec<f64>>) {
        let square = |a: f64| a * a;
        let inverse = 1.0
            / u.iter()
                .zip(mu)
                .map(|(u, m)| square(u - m))
                .sum::<f64>()
                .sqrt();
        let mut ratios = Vec::new();
        for spin in self.source.spins().into_iter().flatten() {
            let size = |value: &dyn Fn(usize) -> f64| {
                spin.coordinates
                    .iter()
                    .map(|&k| square(value(k)))
                    .sum::<f64>()
            };
            let sum = size(&|k| 2.0 * mu[k] + u[k]);
            ratios.extend([(size(&|k| mu[k]) / sum).sqrt(), 1.0 / sum]);
        }
        let arguments: Arguments<'_> = &[
            ("mu", mu),
            ("unknown", u),
            ("inverse", &[inverse]),
            ("ratios", &ratios),
        ];
        self.call(kernel, h, arguments)
    }

    /// Asserts that `linearize` writes what `residual` (or `value`) writes, and the derivative of it.
    pub fn check_slopes(&self, label: &str, first: &Kernel, both: &Kernel) {
        let n = self.source.dimension;
        let (h, mu, u) = (0.3, point(n, 1), point(n, 2));
        let (value, slopes) = self.equation(both, h, &mu, &u);
        assert!(
            value
                .iter()
                .chain(slopes.iter().flatten())
                .all(|x| x.is_finite())
        );
        let (alone, _) = self.equation(first, h, &mu, &u);
        for (a, b) in value.iter().zip(&alone) {
            assert!((a - b).abs() < 1e-13, "{} {label}: {a} {b}", self.name);
        }
        for j in 0..n {
            let side = |shift: f64| {
                let mut u = u.clone();
                u[j] += shift;
                self.equation(first, h, &mu, &u).0
            };
            let (up, down) = (side(1e-4), side(-1e-4));
            for i in 0..n {
                let slope = (up[i] - down[i]) / 2e-4;
                let error = (slope - slopes[i][j]).abs();
                assert!(error < 1e-6, "{} {label} ({i}, {j}): {error:e}", self.name);
            }
        }
    }

    /// The state after t, by many steps of the classical method.
    pub fn flow(&self, t: f64, mu: &[f64], field: &dyn Fn(&[f64]) -> Vec<f64>) -> Vec<f64> {
        const STEPS: u32 = 400;
        let h = t / f64::from(STEPS);
        let mut mu = mu.to_vec();
        let plus = |mu: &[f64], h: f64, k: &[f64]| -> Vec<f64> {
            mu.iter().zip(k).map(|(m, k)| m + h * k).collect()
        };
        for _ in 0..STEPS {
            let k1 = field(&mu);
            let k2 = field(&plus(&mu, h / 2.0, &k1));
            let k3 = field(&plus(&mu, h / 2.0, &k2));
            let k4 = field(&plus(&mu, h, &k3));
            for i in 0..mu.len() {
                mu[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
            }
        }
        mu
    }

    pub fn exact(&self, t: f64, mu: &[f64]) -> Vec<f64> {
        self.flow(t, mu, &|mu| self.call(&self.field, 0.0, &[("mu", mu)]).0)
    }

    /// Asserts the order of a step, and that a step of h is that close to the flow at all.
    pub fn check_order(&self, label: &str, order: i32, step: &dyn Fn(f64, &[f64]) -> Vec<f64>) {
        let mu = point(self.source.dimension, 3);
        let errors = [0.02, 0.01].map(|h| distance(&step(h, &mu), &self.exact(h, &mu)));
        let slope = (errors[0] / errors[1]).log2();
        let expected = f64::from(order + 1);
        assert!(
            (slope - expected).abs() < 0.2,
            "{} {label}: {errors:?}",
            self.name
        );
    }
}

pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs())
        .fold(
            0.0,
            |largest, x| if x.is_nan() { x } else { f64::max(largest, x) },
        )
}

/// A generic point, entries between 0.2 and 1 in absolute value.
pub fn point(n: usize, seed: usize) -> Vec<f64> {
    let entry = |k: usize| {
        let angle = 1.7 * (k + 1) as f64 + 2.3 * seed as f64;
        angle.sin().signum() * (0.2 + 0.8 * (3.1 * angle).sin().abs())
    };
    (0..n).map(entry).collect()
}

/// `A^-1 b`
pub fn solve(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for k in 0..n {
        let size = |row: &usize| a[*row][k].abs();
        let pivot = (k..n)
            .max_by(|i, j| size(i).total_cmp(&size(j)))
            .expect("rows");
        a.swap(k, pivot);
        b.swap(k, pivot);
        let above = a[k].clone();
        for row in (0..n).filter(|row| *row != k) {
            let factor = a[row][k] / above[k];
            for (entry, above) in a[row].iter_mut().zip(&above).skip(k) {
                *entry -= factor * above;
            }
            b[row] -= factor * b[k];
        }
    }
    (0..n).map(|k| b[k] / a[k][k]).collect()
}

/// The unknown that solves an equation, by Newton's iteration from a point.
pub fn solution(system: &System, both: &Kernel, h: f64, mu: &[f64], start: Vec<f64>) -> Vec<f64> {
    let mut u = start;
    for _ in 0..20 {
        let (residual, mut slopes) = system.equation(both, h, mu, &u);
        // an unknown that the iteration leaves out has an empty row, and stays
        for (i, row) in slopes.iter_mut().enumerate() {
            if row.iter().all(|slope| *slope == 0.0) {
                row[i] = 1.0;
            }
        }
        let step = solve(slopes, residual);
        u.iter_mut().zip(step).for_each(|(u, step)| *u -= step);
    }
    let (residual, _) = system.equation(both, h, mu, &u);
    assert!(
        distance(&residual, &vec![0.0; u.len()]) < 1e-13,
        "{}",
        system.name
    );
    u
}

pub fn named<'a>(kernels: &'a [Kernel], name: &str) -> &'a Kernel {
    kernels
        .iter()
        .find(|kernel| kernel.name == name)
        .expect("a kernel")
}
