//! One step along a curve of equilibria, in the plane of unknowns and parameter.
//!
//! A point is `u = (y/|y|, k/|B - A|)`, scaled once for a branch. The curve is followed in its arclength: from u along the unit
//! tangent t, then back to the curve in the plane across t (pseudo-arclength; H. B. Keller 1977, in *Applications of Bifurcation
//! Theory*, Academic Press, pp. 359–384). Members of a family have a kernel of its dimension d beside t; the shortest correction does not move
//! along it.

use crate::dense::{Singular, add, dot, norm};
use crate::newton::At;
use crate::system::Equations;

/// A point of the curve has a residual below this part of its terms.
const SOLVED: f64 = 1e-11;
/// A singular value of a direction of the family is below this part of the largest.
const KERNEL: f64 = 1e-10;
/// Corrections of a step.
const MOST: usize = 8;

/// The curves of a family of dimension d.
pub struct Curve<'a> {
    pub(crate) equations: &'a Equations,
    pub(crate) base: &'a [f64],
    pub(crate) varying: usize,
    /// The scale of each unknown and of the parameter.
    pub(crate) scale: Vec<f64>,
    pub(crate) family: usize,
}

impl Curve<'_> {
    /// The parameters at a point.
    pub fn parameters(&self, u: &[f64]) -> Vec<f64> {
        let mut parameters = self.base.to_vec();
        parameters[self.varying] = self.parameter(u);
        parameters
    }

    /// The parameter that varies.
    pub fn parameter(&self, u: &[f64]) -> f64 {
        u[u.len() - 1] * self.scale[u.len() - 1]
    }

    /// State and multipliers.
    pub fn unknowns(&self, u: &[f64]) -> Vec<f64> {
        let pairs = u.iter().zip(&self.scale).take(u.len() - 1);
        pairs.map(|(u, scale)| u * scale).collect()
    }

    /// The point of unknowns and a parameter.
    pub fn point(&self, y: &[f64], parameter: f64) -> Vec<f64> {
        let all = y.iter().chain([&parameter]);
        all.zip(&self.scale).map(|(y, scale)| y / scale).collect()
    }

    /// F and its derivative by u, by rows.
    fn linear(&self, u: &[f64]) -> Option<(Vec<f64>, Vec<f64>)> {
        let parameters = self.parameters(u);
        let linear = self.equations.linear(&self.unknowns(u), &parameters)?;
        let n = u.len() - 1;
        let mut rows = Vec::with_capacity(n * (n + 1));
        for (row, by) in linear.slope.chunks(n).zip(&linear.by_parameter) {
            rows.extend(row.iter().zip(&self.scale).map(|(x, scale)| x * scale));
            rows.push(by * self.scale[n]);
        }
        Some((linear.residual, rows))
    }

    /// The unit tangent that goes on in a direction; the first of a branch is across its family.
    pub fn tangent(&self, u: &[f64], direction: Option<&[f64]>) -> Option<Vec<f64>> {
        let n = u.len() - 1;
        let (_, rows) = self.linear(u)?;
        let singular = Singular::new(&rows, n, n + 1)?;
        let kernel = singular.kernel(n - self.family);
        let project = |v: &[f64]| {
            let mut part = vec![0.0; v.len()];
            kernel.iter().for_each(|k| add(&mut part, dot(k, v), k));
            part
        };
        let tangent = match direction {
            Some(direction) => project(direction),
            None => {
                // of the kernel what is across the family, whose directions leave the parameter
                let at = At {
                    equations: self.equations,
                    parameters: &self.parameters(u),
                };
                let own = at.kernel(&self.unknowns(u))?;
                let mut basis: Vec<Vec<f64>> = Vec::new();
                for vector in &own {
                    let mut vector = self.point(vector, 0.0);
                    basis.iter().for_each(|b: &Vec<f64>| {
                        let part = dot(b, &vector);
                        add(&mut vector, -part, b);
                    });
                    let length = norm(&vector);
                    basis.push(vector.iter().map(|x| x / length).collect());
                }
                let across = kernel.iter().map(|k| {
                    let mut k = k.clone();
                    for b in &basis {
                        let part = dot(b, &k);
                        add(&mut k, -part, b);
                    }
                    k
                });
                across.max_by(|a, b| norm(a).total_cmp(&norm(b)))?
            }
        };
        let length = norm(&tangent);
        (length > 1e-6).then(|| tangent.iter().map(|x| x / length).collect())
    }

    /// The point of the curve in the plane across t through u; with it how far that was.
    pub fn correct(&self, u: &[f64], t: &[f64]) -> Option<(Vec<f64>, f64)> {
        let n = u.len() - 1;
        let (mut at, mut last) = (u.to_vec(), f64::INFINITY);
        for _ in 0..MOST {
            let (mut residual, mut rows) = self.linear(&at)?;
            residual.push(dot(t, &at) - dot(t, u));
            rows.extend_from_slice(t);
            let singular = Singular::new(&rows, n + 1, n + 1)?;
            let step = singular.shortest(&residual, n + 1 - self.family);
            let size = norm(&step);
            if !size.is_finite() || size > 0.5 * last && size > 1e-9 {
                return None;
            }
            // round-off is reached
            if size >= last {
                break;
            }
            add(&mut at, -1.0, &step);
            last = size;
            if size < 1e-16 {
                break;
            }
        }
        let moved = norm(&crate::dense::difference(&at, u));
        // the shortest step leaves a residual where the family goes on no more
        let (residual, mut rows) = self.linear(&at)?;
        let solved = norm(&residual) <= SOLVED * norm(&rows) * norm(&at);
        // nor is a member of the family what has no kernel of its dimension
        rows.extend_from_slice(t);
        let values = Singular::new(&rows, n + 1, n + 1)?.values;
        let own = values.get(n + 1 - self.family);
        let solved = solved && own.is_none_or(|value| *value <= KERNEL * values[0]);
        (solved && last < 1e-8).then_some((at, moved))
    }
}
