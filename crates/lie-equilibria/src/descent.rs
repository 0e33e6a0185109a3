//! Steps that make the length of a vector function smaller (D. W. Marquardt, Journal of the Society for Industrial and Applied Mathematics 11
//! (1963) 431–441, doi:10.1137/0111030).

use crate::dense::{add, norm, solve};

/// A function at a point, with its slope by rows.
pub trait Linearised {
    fn value(&self) -> &[f64];
    fn slope(&self) -> &[f64];
}

/// Where steps end: solved, or else with what is left.
pub enum End {
    Solved(Vec<f64>),
    Stuck(Vec<f64>, f64),
    Spent(Vec<f64>),
}

/// So many steps from a point until one is solved. The matrix `J^T J` gains `(damping |F|)^2` on its diagonal, and `least` of it, whatever F. None
/// where the function has no value.
pub fn descend<L: Linearised>(
    start: &[f64],
    most: usize,
    linear_at: impl Fn(&[f64]) -> Option<L>,
    is_solved: impl Fn(&[f64], &L) -> bool,
    least: impl Fn(&[f64]) -> f64,
) -> Option<End> {
    let n = start.len();
    let (mut z, mut damping) = (start.to_vec(), 0.1);
    let mut linear = linear_at(&z)?;
    for _ in 0..most {
        let size = norm(linear.value());
        if is_solved(&z, &linear) {
            return Some(End::Solved(z));
        }
        let (mut matrix, mut right) = (vec![0.0; n * n], vec![0.0; n]);
        for (row, value) in linear.slope().chunks(n).zip(linear.value()) {
            for i in 0..n {
                right[i] -= row[i] * value;
                (0..n).for_each(|j| matrix[i * n + j] += row[i] * row[j]);
            }
        }
        loop {
            let mut damped = matrix.clone();
            let more = (damping * size).powi(2) + least(&matrix);
            (0..n).for_each(|i| damped[i * n + i] += more);
            let trial = solve(&damped, right.clone()).map(|step| {
                let mut trial = z.clone();
                add(&mut trial, 1.0, &step);
                trial
            });
            let there = trial.as_ref().and_then(|trial| linear_at(trial));
            if let (Some(trial), Some(there)) = (trial, there)
                && norm(there.value()) < (1.0 - 1e-4) * size
            {
                (z, linear) = (trial, there);
                damping = (0.2 * damping).max(1e-4);
                break;
            }
            damping *= 5.0;
            if damping > 1e9 {
                return Some(End::Stuck(z, size));
            }
        }
    }
    Some(End::Spent(z))
}
