//! Random systems: algebras made from known ones, functions of random shape.

// Each test uses its own part of this.
#![allow(dead_code)]

pub mod algebra;
pub mod function;

use lie_symbolic::exact::Rational;
use proptest::prelude::*;

pub use algebra::Algebra;
pub use function::Function;

/// Number of parameters of every random system; the first one is exact.
pub const PARAMETERS: usize = 3;

/// A random Lie–Poisson system.
#[derive(Clone, Debug)]
pub struct System {
    pub algebra: Algebra,
    /// The Hamiltonian is `a + w*b` with the abbreviation `w`.
    pub a: Function,
    pub b: Function,
    pub w: Function,
    /// Defaults of the parameters.
    pub parameters: Vec<Rational>,
    /// Whether every bracket carries the exact parameter `k0` as a factor.
    pub scaled: bool,
}

/// A rational number of a few digits, never zero.
pub fn rational() -> impl Strategy<Value = Rational> {
    let numerator = prop_oneof![-4i64..0, 1i64..5];
    (numerator, 1i64..4).prop_map(|(n, d)| Rational::new(n, d).expect("a denominator"))
}

/// Random systems of dimension 2 to 8.
pub fn system() -> impl Strategy<Value = System> {
    algebra::algebra().prop_flat_map(|algebra| {
        let function = || function::function(algebra.dimension(), PARAMETERS);
        let parameters = prop::collection::vec(rational(), PARAMETERS);
        (
            Just(algebra.clone()),
            function(),
            function(),
            function(),
            parameters,
            any::<bool>(),
        )
            .prop_map(|(algebra, a, b, w, parameters, scaled)| System {
                algebra,
                a,
                b,
                w,
                parameters,
                scaled,
            })
    })
}

fn quoted(texts: impl IntoIterator<Item = String>) -> String {
    texts
        .into_iter()
        .map(|text| format!("{text:?}"))
        .collect::<Vec<_>>()
        .join(", ")
}

impl System {
    pub fn dimension(&self) -> usize {
        self.algebra.dimension()
    }

    /// The spec of the system; bracket `[e_i, e_j]` stands there once, for `i < j`.
    pub fn spec(&self, name: &str) -> String {
        let n = self.dimension();
        let algebra = &self.algebra;
        let mut brackets = Vec::new();
        for (i, j) in (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j))) {
            let terms: Vec<String> = (0..n)
                .filter(|k| !algebra.constants[i][j][*k].is_zero())
                .map(|k| format!("({})*e{k}", algebra.constants[i][j][k]))
                .collect();
            if !terms.is_empty() {
                let factor = if self.scaled { "k0*" } else { "" };
                brackets.push(format!("[e{i}, e{j}] = {factor}({})", terms.join(" + ")));
            }
        }
        let matrices = match &algebra.matrices {
            // A scaled bracket has other matrices.
            Some(matrices) if !self.scaled => {
                let row = |row: &Vec<Rational>| {
                    format!("[{}]", quoted(row.iter().map(Rational::to_string)))
                };
                let matrix = |matrix: &Vec<Vec<Rational>>| {
                    matrix.iter().map(row).collect::<Vec<_>>().join(", ")
                };
                let all = matrices
                    .iter()
                    .enumerate()
                    .map(|(i, m)| format!("\"e{i}\": [{}]", matrix(m)));
                format!(
                    ", \"matrices\": {{ {} }}",
                    all.collect::<Vec<_>>().join(", ")
                )
            }
            _ => String::new(),
        };
        let parameters = self.parameters.iter().enumerate().map(|(p, value)| {
            format!(
                "\"k{p}\": {{ \"default\": \"{value}\", \"exact\": {} }}",
                p == 0
            )
        });
        let lets = algebra
            .old_coordinates()
            .into_iter()
            .chain([format!("w = {}", self.w.text())]);
        let casimirs = algebra.casimirs.iter().map(|c| (*c).to_owned());
        format!(
            r#"{{ "format": 1, "name": "{name}",
  "algebra": {{ "basis": [{}], "brackets": [{}]{matrices} }},
  "state": [{}],
  "parameters": {{ {} }},
  "let": [{}],
  "hamiltonian": "{} + w*({})",
  "casimirs": [{}] }}"#,
            quoted((0..n).map(|i| format!("e{i}"))),
            quoted(brackets),
            quoted((0..n).map(|i| format!("x{i}"))),
            parameters.collect::<Vec<_>>().join(", "),
            quoted(lets),
            self.a.text(),
            self.b.text(),
            quoted(casimirs),
        )
    }

    /// The structure constants in double precision, with the factor of the brackets.
    pub fn constants(&self) -> Vec<Vec<Vec<f64>>> {
        let factor = if self.scaled {
            self.parameters[0].to_f64()
        } else {
            1.0
        };
        let row = |row: &Vec<Rational>| row.iter().map(|c| factor * c.to_f64()).collect();
        self.algebra
            .constants
            .iter()
            .map(|rows| rows.iter().map(row).collect())
            .collect()
    }
}
