//! The velocity of a momentum in floating point: where a Lagrangian that is not quadratic is looked at. The same
//! path as that of generated programs (`lagrangian/legendre.rs` and `path.rs` of lie-runtime).

use crate::model::Lagrangian;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

/// Iterations towards one momentum. One that shrinks the steps as fast as is asked for needs fewer.
const ITERATIONS: usize = 24;
/// The last step that needs another one, relative to the velocity.
const NEAR: f64 = 1024.0 * f64::EPSILON;
/// Pieces of a path that are tried before it counts as endless.
const PIECES: usize = 1000;
/// The shortest piece of a path in s, before it counts as a fold.
const SHORTEST: f64 = 1.0 / (1_u64 << 32) as f64;
/// How far s may run on either side behind a fold.
const FAR: f64 = 8.0;

/// The solution of `l'(xi) = mu` at the end of the path `l'(xi) = l'(0) + s (mu - l'(0))` from rest, through folds too,
/// where s turns round. `None` where it ends before `s = 1`. The momenta come first in a state; the Lagrangian may depend on the
/// other coordinates.
pub fn velocity(
    graph: &mut Graph,
    lagrangian: &Lagrangian,
    state: &[f64],
    parameters: &[f64],
) -> Option<Vec<f64>> {
    let count = lagrangian.velocity.len();
    let (mu, lagrangian) = (&state[..count], lagrangian.value);
    let mut functions: Vec<ExprId> = (0..count)
        .map(|i| graph.derivative(lagrangian, Symbol::Input(i)))
        .collect();
    for i in 0..count {
        for j in 0..count {
            functions.push(graph.derivative(functions[i], Symbol::Input(j)));
        }
    }
    let mut path = Path {
        graph,
        functions,
        parameters,
        state,
        first: Vec::new(),
        change: Vec::new(),
    };
    let rest = vec![0.0; count];
    path.first = path.momentum(&rest);
    path.change = combine(mu, -1.0, &path.first);
    let sign = path.solve(&rest, path.change.clone())?.1;
    let end = match path.newton(1.0, &rest) {
        Some(end) => end,
        None => match path.straight(rest) {
            (1.0, end) => end,
            (s, end) => path.through_folds(s, end)?,
        },
    };
    // beyond a fold the determinant has another sign
    let (step, at_end) = path.solve(&end, path.defect(&end, 1.0))?;
    (at_end == sign).then(|| combine(&end, -1.0, &step))
}

/// A Lagrangian and a segment of momenta `first + s change`.
struct Path<'a> {
    graph: &'a Graph,
    /// l', then l'' by rows.
    functions: Vec<ExprId>,
    parameters: &'a [f64],
    state: &'a [f64],
    first: Vec<f64>,
    change: Vec<f64>,
}

impl Path<'_> {
    fn at(&self, xi: &[f64], functions: &[ExprId]) -> Vec<f64> {
        self.graph.evaluate_all(functions, &|symbol| match symbol {
            Symbol::Input(i) => xi[i],
            Symbol::Coordinate(i) => self.state[i],
            Symbol::Parameter(p) => self.parameters[p],
            _ => f64::NAN,
        })
    }

    fn momentum(&self, xi: &[f64]) -> Vec<f64> {
        self.at(xi, &self.functions[..xi.len()])
    }

    fn defect(&self, xi: &[f64], s: f64) -> Vec<f64> {
        combine(
            &combine(&self.momentum(xi), -1.0, &self.first),
            -s,
            &self.change,
        )
    }

    /// `l''(xi)^-1 right`, and the sign of the determinant.
    fn solve(&self, xi: &[f64], right: Vec<f64>) -> Option<(Vec<f64>, f64)> {
        solve(self.at(xi, &self.functions[xi.len()..]), right)
    }

    /// The velocity at s by Newton's iteration, whose steps must shrink to a quarter each.
    fn newton(&self, s: f64, start: &[f64]) -> Option<Vec<f64>> {
        let mut xi = start.to_vec();
        let mut bound = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let defect = self.defect(&xi, s);
            let exact = size(&defect) == 0.0;
            let (step, _) = self.solve(&xi, defect)?;
            let length = size(&step);
            if exact || length <= NEAR * size(&xi) {
                return Some(xi);
            }
            if length > bound || length.is_nan() {
                return None;
            }
            xi = combine(&xi, -1.0, &step);
            bound = 0.25 * length;
        }
        None
    }

    /// As far as s goes without turning round: the last s, at most 1, and the velocity there.
    fn straight(&self, mut xi: Vec<f64>) -> (f64, Vec<f64>) {
        let (mut s, mut piece) = (0.0, 0.5_f64);
        for _ in 0..PIECES {
            let next = f64::min(s + piece, 1.0);
            match self.newton(next, &xi) {
                Some(end) => {
                    (s, xi) = (next, end);
                    piece *= 2.0;
                }
                None => piece *= 0.5,
            }
            if s == 1.0 || piece < SHORTEST {
                break;
            }
        }
        (s, xi)
    }

    /// The tangent of the path, of length 1 with s, its last entry, in units of `unit`.
    fn tangent(&self, unit: f64, xi: &[f64]) -> Option<Vec<f64>> {
        let (mut along, _) = self.solve(xi, self.change.clone())?;
        let length = (dot(&along, &along) + unit * unit).sqrt();
        along.push(1.0);
        Some(along.iter().map(|entry| entry / length).collect())
    }

    /// From the velocity at s along the path, where s may turn round, to the first velocity with `s = 1`.
    fn through_folds(&self, s: f64, xi: Vec<f64>) -> Option<Vec<f64>> {
        let unit = size(&xi);
        let mut tangent = self.tangent(unit, &xi)?;
        let mut point = xi;
        point.push(s);
        let shortest = SHORTEST * unit;
        let mut piece = 0.01 * unit;
        for _ in 0..PIECES {
            let s = *point.last()?;
            if piece <= shortest || s.abs() >= FAR || (piece * s).is_nan() {
                return None;
            }
            let (xi, trial) = (&point[..point.len() - 1], combine(&point, piece, &tangent));
            let Some((end, next)) = self.correct(unit, &tangent, trial) else {
                piece *= 0.5;
                continue;
            };
            if s < 1.0 && *end.last()? >= 1.0 {
                if let Some(end) = self.newton(1.0, xi) {
                    return Some(end);
                }
                piece *= 0.5;
                continue;
            }
            (point, tangent) = (end, next);
            piece *= 1.5;
        }
        None
    }

    /// A point near the path moved onto it, perpendicular to a tangent, and the tangent there.
    fn correct(
        &self,
        unit: f64,
        tangent: &[f64],
        mut point: Vec<f64>,
    ) -> Option<(Vec<f64>, Vec<f64>)> {
        let count = point.len() - 1;
        let weighted = |a: &[f64], b: &[f64]| {
            dot(&a[..count], &b[..count]) + unit * unit * a[count] * b[count]
        };
        let mut bound = f64::INFINITY;
        for _ in 0..8 {
            let (xi, s) = (&point[..count], point[count]);
            let (mut back, _) = self.solve(xi, self.defect(xi, s))?;
            let (mut along, _) = self.solve(xi, self.change.clone())?;
            back.push(0.0);
            along.push(1.0);
            let ds = weighted(tangent, &back) / weighted(tangent, &along);
            let step = combine(
                &along.iter().map(|a| ds * a).collect::<Vec<_>>(),
                -1.0,
                &back,
            );
            let length = f64::max(size(&step[..count]), unit * ds.abs());
            if length > bound || length.is_nan() {
                return None;
            }
            point = combine(&point, 1.0, &step);
            bound = 0.25 * length;
            if length <= 1e-6 * unit {
                let mut next = self.tangent(unit, &point[..count])?;
                let cosine = weighted(&next, tangent);
                next.iter_mut().for_each(|entry| *entry *= cosine.signum());
                return (cosine.abs() > 0.9).then_some((point, next));
            }
        }
        None
    }
}

/// `a + factor b`
fn combine(a: &[f64], factor: f64, b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + factor * b).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
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
