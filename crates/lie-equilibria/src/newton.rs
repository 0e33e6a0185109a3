//! Newton's iteration for equations whose solutions need not be isolated.
//!
//! The unknown is `y = (x, lambda)`. Far from a solution each step is one of Levenberg and Marquardt,
//! `(J^T J + mu^2) d = -J^T F` with `mu` proportional to `|F|`, which converges quadratically to manifolds of solutions too;
//! near it the shortest step `d = -J^+ F`, which leaves where the solution lies on such a manifold alone.
//!
//! N. Yamashita and M. Fukushima (2001), On the rate of convergence of the Levenberg–Marquardt method,
//! doi:10.1007/978-3-7091-6217-0_18.

use crate::dense::{Singular, add, dot, norm, solve};
use crate::descent::{End, Linearised, descend};
use crate::homotopy::multiplier;
use crate::system::{Equations, Linear};

/// A singular value below this part of the largest counts as zero at a solution.
pub const RANK: f64 = 1e-7;
/// Steps far from a solution.
const MOST: usize = 80;
/// Steps near it.
const LAST: usize = 8;

/// Equations at values of the parameters.
#[derive(Clone, Copy)]
pub struct At<'a> {
    /// The equations.
    pub equations: &'a Equations,
    /// Values of the parameters.
    pub parameters: &'a [f64],
}

/// Whether each entry is at most a part of a size of its own.
pub fn is_below(values: &[f64], part: f64, sizes: &[f64]) -> bool {
    let mut pairs = values.iter().zip(sizes);
    pairs.all(|(value, size)| value.abs() <= part * size)
}

impl Linearised for Linear<f64> {
    fn value(&self) -> &[f64] {
        &self.residual
    }
    fn slope(&self) -> &[f64] {
        &self.slope
    }
}

impl At<'_> {
    /// A solution near y; `None` where the iteration ends at none.
    pub fn solve(self, y: &[f64]) -> Option<Vec<f64>> {
        let near = self.approach(y)?;
        self.polish(near)
    }

    /// Steps that make `|F|` smaller.
    fn approach(self, y: &[f64]) -> Option<Vec<f64>> {
        let references = self.references();
        let is_solved = |y: &[f64], linear: &Linear<f64>| {
            norm(&linear.residual) <= 1e-10 * self.scale(&linear.slope, y)
                || is_below(&linear.residual, 1e-14, &references)
        };
        let linear_at = |y: &[f64]| self.equations.linear(y, self.parameters);
        let least = |matrix: &[f64]| 1e-15 * matrix[0].abs();
        match descend(y, MOST, linear_at, is_solved, least)? {
            End::Solved(y) => Some(y),
            End::Stuck(..) | End::Spent(_) => None,
        }
    }

    /// The shortest steps to round-off.
    pub fn polish(self, mut y: Vec<f64>) -> Option<Vec<f64>> {
        let n = self.equations.unknowns();
        let mut best: Option<(f64, Vec<f64>)> = None;
        for _ in 0..LAST {
            let linear = self.equations.linear(&y, self.parameters)?;
            let size = norm(&linear.residual);
            if best.as_ref().is_some_and(|(least, _)| size >= *least) {
                break;
            }
            let scale = self.scale(&linear.slope, &y);
            best = Some((size, y.clone()));
            if size == 0.0 {
                break;
            }
            let singular = Singular::new(&linear.slope, n, n)?;
            let step = singular.shortest(&linear.residual, singular.rank(RANK));
            if norm(&step) > 1e-2 * norm(&y).max(self.size(&y)) && size > 1e-6 * scale {
                return None;
            }
            add(&mut y, -1.0, &step);
        }
        let (size, y) = best?;
        let linear = self.equations.linear(&y, self.parameters)?;
        let is_root = size <= 1e-12 * self.scale(&linear.slope, &y)
            || is_below(&linear.residual, 1e-13, &self.references()) && self.contracts(&y);
        is_root.then_some(y)
    }

    /// The sizes of the terms of each equation beside the initial state, for states and multipliers of their own scales.
    pub fn references(self) -> Vec<f64> {
        let n = self.equations.unknowns();
        let sizes = self.equations.sizes;
        let terms = self.equations.leaf(self.parameters).and_then(|(_, state)| {
            let size = self.size(&state);
            let lambda = multiplier(self, &state, size);
            let beside = state.iter().map(|x| x + 0.1 * size);
            let y: Vec<f64> = beside.chain(vec![lambda; sizes.m]).collect();
            let slope = self.equations.linear(&y, self.parameters)?.slope;
            let term = |row: &[f64]| {
                let of = |(k, a): (usize, &f64)| a.abs() * if k < sizes.n { size } else { lambda };
                row.iter().enumerate().map(of).sum()
            };
            Some(slope.chunks(n).map(term).collect())
        });
        terms.unwrap_or_else(|| vec![0.0; n])
    }

    /// Whether Newton's steps become shorter, as they do near a multiple root: by a half near a double one. Far away, where F dies out
    /// like `exp(-x)`, they stay as long as they are.
    fn contracts(self, y: &[f64]) -> bool {
        let step = |y: &[f64]| {
            let linear = self.equations.linear(y, self.parameters)?;
            solve(&linear.slope, linear.residual)
        };
        let Some(first) = step(y) else {
            return true;
        };
        let mut next = y.to_vec();
        add(&mut next, -1.0, &first);
        let small = norm(&first) <= 0.1 * self.size(y);
        small && step(&next).is_none_or(|second| norm(&second) <= 0.9 * norm(&first))
    }

    /// The size of the terms of F.
    fn scale(self, slope: &[f64], y: &[f64]) -> f64 {
        let n = self.equations.unknowns();
        let rows = slope.chunks(n);
        let sums = rows.map(|row| row.iter().zip(y).map(|(a, b)| (a * b).abs()).sum::<f64>());
        sums.fold(f64::MIN_POSITIVE, f64::max)
    }

    /// An orthonormal basis of the directions in which solutions may go on.
    pub fn kernel(self, y: &[f64]) -> Option<Vec<Vec<f64>>> {
        let n = self.equations.unknowns();
        let linear = self.equations.linear(y, self.parameters)?;
        let singular = Singular::new(&linear.slope, n, n)?;
        Some(singular.kernel(singular.rank(RANK)).to_vec())
    }

    /// The state on the leaf near x, with the multipliers that fit H best there.
    pub fn on_leaf(self, x: &[f64]) -> Option<Vec<f64>> {
        let (n, m) = (self.equations.sizes.n, self.equations.sizes.m);
        let mut y = [x, &vec![0.0; m]].concat();
        if m == 0 {
            return Some(y);
        }
        for _ in 0..30 {
            let linear = self.equations.linear(&y, self.parameters)?;
            // each equation in the scale of its own gradient
            let rows = linear.slope[n * (n + m)..].chunks(n + m);
            let sizes = rows.clone().map(|row| match norm(&row[..n]) {
                0.0 => 1.0,
                size => size,
            });
            let sizes: Vec<f64> = sizes.collect();
            let gradients: Vec<f64> = rows
                .zip(&sizes)
                .flat_map(|(row, size)| row[..n].iter().map(move |x| x / size))
                .collect();
            let off = linear.residual[n..].iter().zip(&sizes);
            let off: Vec<f64> = off.map(|(off, size)| off / size).collect();
            let singular = Singular::new(&gradients, m, n)?;
            let rank = singular.rank(1e-10);
            let step = singular.shortest(&off, rank);
            let done = norm(&step) <= 1e-9 * norm(&y[..n]);
            add(&mut y[..n], -1.0, &step);
            if done {
                // grad H = sum lambda grad C by least squares: the transposed problem
                let transposed: Vec<f64> = (0..n)
                    .flat_map(|i| (0..m).map(move |k| (k, i)))
                    .map(|(k, i)| gradients[k * n + i])
                    .collect();
                let fit = Singular::new(&transposed, n, m)?;
                let lambda = fit.shortest(&linear.residual[..n], fit.rank(1e-10));
                let lambda = lambda.iter().zip(&sizes).map(|(x, size)| x / size);
                y[n..].copy_from_slice(&lambda.collect::<Vec<f64>>());
                return Some(y);
            }
        }
        None
    }

    /// Whether the leaf has full dimension at a state: the gradients of the Casimirs are independent, and Pi has no lower rank. Small is
    /// what is small beside Pi at the state that tells the scale.
    pub fn is_regular(self, y: &[f64]) -> bool {
        self.has_rank(y) && self.has_gradients(y)
    }

    fn has_rank(self, y: &[f64]) -> bool {
        let (n, m) = (self.equations.sizes.n, self.equations.sizes.m);
        let values = |y: &[f64]| {
            let shape = self.equations.shape(y, self.parameters)?;
            Some(Singular::new(&shape.bracket, n, n)?.values)
        };
        let scale = self.equations.leaf(self.parameters).and_then(|(_, state)| {
            let found = values(&[state, vec![0.0; m]].concat())?;
            found.first().copied()
        });
        match (values(y), scale) {
            _ if n == m => true,
            (Some(found), Some(scale)) => found[n - m - 1] > 1e-9 * scale,
            _ => false,
        }
    }

    fn has_gradients(self, y: &[f64]) -> bool {
        let (n, m) = (self.equations.sizes.n, self.equations.sizes.m);
        if m == 0 {
            return true;
        }
        let Some(linear) = self.equations.linear(y, self.parameters) else {
            return false;
        };
        let gradients = linear.slope[n * (n + m)..].chunks(n + m);
        // each in its own scale
        let gradients: Vec<f64> = gradients
            .flat_map(|row| {
                let size = dot(&row[..n], &row[..n]).sqrt().max(f64::MIN_POSITIVE);
                row[..n].iter().map(move |x| x / size).collect::<Vec<_>>()
            })
            .collect();
        Singular::new(&gradients, m, n).is_some_and(|found| found.values[m - 1] > 1e-6)
    }
}
