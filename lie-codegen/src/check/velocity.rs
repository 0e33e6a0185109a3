//! The velocity of a momentum in floating point: where a Lagrangian that is not quadratic is looked at. The same
//! iteration as that of generated programs.

use crate::symbolic::{ExprId, Graph, Symbol};

/// More iterations than any start needs that leads to a solution.
const MAX_ITERATIONS: usize = 100;
/// The smallest step is 2^-MAX_HALVINGS of Newton's.
const MAX_HALVINGS: usize = 40;
/// The last step with damping, relative to the velocity.
const NEAR: f64 = 1024.0 * f64::EPSILON;

/// The solution of `l'(xi) = mu`, by Newton's iteration from rest with steps that are halved until the defect
/// shrinks. `None` where it finds none.
pub fn velocity(
    graph: &mut Graph,
    lagrangian: ExprId,
    mu: &[f64],
    parameters: &[f64],
) -> Option<Vec<f64>> {
    let count = mu.len();
    let mut functions: Vec<ExprId> = (0..count)
        .map(|i| graph.derivative(lagrangian, Symbol::Input(i)))
        .collect();
    for i in 0..count {
        for j in 0..count {
            functions.push(graph.derivative(functions[i], Symbol::Input(j)));
        }
    }
    let graph = &*graph;
    let at = |xi: &[f64], functions: &[ExprId]| {
        graph.evaluate_all(functions, &|symbol| match symbol {
            Symbol::Input(i) => xi[i],
            Symbol::Parameter(p) => parameters[p],
            _ => f64::NAN,
        })
    };
    let defect = |xi: &[f64]| -> Vec<f64> {
        let slopes = at(xi, &functions[..count]);
        slopes
            .iter()
            .zip(mu)
            .map(|(slope, mu)| slope - mu)
            .collect()
    };
    let mut xi = vec![0.0; count];
    let mut error = defect(&xi);
    let mut at_rest = None;
    for _ in 0..MAX_ITERATIONS {
        let inertia = at(&xi, &functions[count..]);
        let (step, sign) = solve(inertia, error.clone())?;
        // beyond a fold the determinant has another sign
        let folded = *at_rest.get_or_insert(sign) != sign;
        let moved = |factor: f64| -> Vec<f64> {
            let pairs = xi.iter().zip(&step);
            pairs.map(|(xi, step)| xi - factor * step).collect()
        };
        if size(&error) == 0.0 || size(&step) <= NEAR * size(&xi) {
            return (!folded).then(|| moved(1.0));
        }
        let factors = (0..MAX_HALVINGS).map(|k| 0.5_f64.powi(k as i32));
        let better = factors.into_iter().find_map(|factor| {
            let trial = moved(factor);
            let after = defect(&trial);
            (size(&after) <= (1.0 - factor / 4.0) * size(&error)).then_some((trial, after))
        });
        match better {
            Some((trial, after)) => (xi, error) = (trial, after),
            None if size(&step) <= f64::EPSILON.sqrt() * size(&xi) => {
                return (!folded).then_some(xi);
            }
            None => return None,
        }
    }
    None
}

/// The largest entry; not a number if one is not.
fn size(values: &[f64]) -> f64 {
    let larger = |a: f64, b: &f64| if b.is_nan() { f64::NAN } else { a.max(b.abs()) };
    values
        .iter()
        .fold(0.0, |a, b| if a.is_nan() { a } else { larger(a, b) })
}

/// Solves a linear system, the matrix by rows, with row exchanges; with the sign of the determinant.
fn solve(mut matrix: Vec<f64>, mut right: Vec<f64>) -> Option<(Vec<f64>, f64)> {
    let n = right.len();
    let mut sign = 1.0;
    for k in 0..n {
        let row = (k..n).max_by(|&a, &b| {
            let entry = |row: usize| matrix[row * n + k].abs();
            entry(a).total_cmp(&entry(b))
        })?;
        for column in 0..n {
            matrix.swap(k * n + column, row * n + column);
        }
        right.swap(k, row);
        let pivot = matrix[k * n + k];
        sign *= pivot.signum() * if row == k { 1.0 } else { -1.0 };
        if pivot == 0.0 || !pivot.is_finite() {
            return None;
        }
        for row in k + 1..n {
            let factor = matrix[row * n + k] / pivot;
            for column in k..n {
                matrix[row * n + column] -= factor * matrix[k * n + column];
            }
            right[row] -= factor * right[k];
        }
    }
    for row in (0..n).rev() {
        let known: f64 = (row + 1..n).map(|j| matrix[row * n + j] * right[j]).sum();
        right[row] = (right[row] - known) / matrix[row * n + row];
    }
    Some((right, sign))
}
