//! Families of solutions: whether they go on in a direction, and whether they lead from one solution to another.

use crate::dense::{add, difference, dot, norm};
use crate::random::Random;

/// A step along a family, in parts of the state.
pub const STRIDE: f64 = 0.1;
/// Halvings of such a step.
const HALVINGS: i32 = 6;
/// Steps along a family before it is given up that it leads to another member.
const STEPS: usize = 300;
/// States closer than this part of their size are one.
pub const SAME: f64 = 1e-6;

/// Equations whose solutions need not be isolated.
pub trait Solutions {
    /// An orthonormal basis of the directions in which solutions may go on.
    fn kernel(&self, y: &[f64]) -> Option<Vec<Vec<f64>>>;

    /// The solution near y; `None` where there is none.
    fn polish(&self, y: Vec<f64>) -> Option<Vec<f64>>;

    /// Whether solutions with a kernel of this dimension go on along a direction of it, a stride away.
    fn goes_on(&self, y: &[f64], direction: &[f64], dimension: usize, stride: f64) -> bool {
        let mut other = y.to_vec();
        add(&mut other, stride, direction);
        let Some(other) = self.polish(other) else {
            return false;
        };
        let moved = norm(&difference(&other, y));
        let along = (0.5..2.0).contains(&(moved / stride));
        along
            && self
                .kernel(&other)
                .is_some_and(|kernel| kernel.len() == dimension)
    }

    /// Whether a family leads from one member to another.
    fn leads(&self, from: &[f64], to: &[f64]) -> bool {
        let mut y = from.to_vec();
        let mut random = Random::new(7);
        let mut way: Option<Vec<f64>> = None;
        for _ in 0..STEPS {
            let rest = difference(to, &y);
            if norm(&rest) < SAME * norm(to) {
                return true;
            }
            let Some(kernel) = self.kernel(&y) else {
                return false;
            };
            let project = |v: &[f64]| {
                let mut part = vec![0.0; v.len()];
                kernel.iter().for_each(|k| add(&mut part, dot(k, v), k));
                part
            };
            let mut step = project(&rest);
            // at the point that is nearest, or opposite: go on as before, or anywhere
            if norm(&step) < 0.2 * norm(&rest) {
                let before = way.clone().unwrap_or_else(|| random.direction(y.len()));
                step = project(&before);
            }
            let length = norm(&step);
            if length == 0.0 {
                return false;
            }
            let stride = length.min(STRIDE * norm(&y)).min(norm(&rest));
            let stride = if way.is_none() {
                stride.max(1e-8)
            } else {
                stride
            };
            let before = y.clone();
            // shorter where the family is more curved than it is large
            let strides = (0..HALVINGS).map(|k| 0.5_f64.powi(k) * stride / length);
            let next = strides.filter_map(|part| {
                let mut next = before.clone();
                add(&mut next, part, &step);
                self.polish(next)
            });
            y = match next.into_iter().next() {
                Some(next) => next,
                None => return false,
            };
            way = Some(difference(&y, &before));
        }
        false
    }
}
