//! Where a state lies among the leaves.
//!
//! A regular state is one where Pi has its generic rank n - m and the gradients of the m Casimirs are independent: its leaf is a component of
//! the set of their values, without the states that are not regular. Of those, none can be passed by a motion of any Hamiltonian. The Pfaffian
//! of `(Pi, G^T; -G, 0)`, with the gradients as rows of G, is zero exactly there, so that two regular states at which it has two signs are on
//! two leaves.

use crate::dense::{Singular, norm, pfaffian_sign};
use crate::newton::At;

/// A singular value of Pi below this part of what is usual is zero.
const RANK: f64 = 1e-9;
/// Gradients of length 1 are dependent where a singular value is below this.
const GRADIENTS: f64 = 1e-6;
/// States beside one that tell what is generic.
const BESIDE: usize = 3;

/// The ranks in a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ranks {
    /// That of Pi.
    pub bracket: usize,
    /// That of the gradients of the Casimirs.
    pub gradients: usize,
}

impl At<'_> {
    /// The ranks in the state that tells the scale, and the largest ones beside it.
    pub fn ranks(self) -> Option<[Ranks; 2]> {
        let (_, state) = self.equations.leaf(self.parameters)?;
        let size = self.size(&state);
        let beside = (1..=BESIDE).map(|k| {
            let part =
                |i: usize| 0.1 * k as f64 + 0.03 * (i % 5) as f64 + 0.017 * (k * i % 3) as f64;
            let moved = state.iter().enumerate();
            moved.map(|(i, x)| x + size * part(i)).collect::<Vec<f64>>()
        });
        let beside: Vec<Vec<f64>> = beside.collect();
        let largest = beside.iter().filter_map(|x| self.singular_values(x));
        let largest = largest.filter_map(|values| values.first().copied());
        let scale = largest.fold(0.0, f64::max);
        let own = self.ranks_at(&state, scale)?;
        let others = beside.iter().filter_map(|x| self.ranks_at(x, scale));
        let generic = others.fold(own, |most, next| Ranks {
            bracket: most.bracket.max(next.bracket),
            gradients: most.gradients.max(next.gradients),
        });
        Some([own, generic])
    }

    fn singular_values(self, x: &[f64]) -> Option<Vec<f64>> {
        let (n, m) = (self.equations.sizes.n, self.equations.sizes.m);
        let shape = self
            .equations
            .shape(&[x, &vec![0.0; m]].concat(), self.parameters)?;
        Some(Singular::new(&shape.bracket, n, n)?.values)
    }

    fn ranks_at(self, x: &[f64], scale: f64) -> Option<Ranks> {
        let (n, m) = (self.equations.sizes.n, self.equations.sizes.m);
        let shape = self
            .equations
            .shape(&[x, &vec![0.0; m]].concat(), self.parameters)?;
        let values = Singular::new(&shape.bracket, n, n)?.values;
        let rows = shape.gradients.chunks(n).flat_map(|row| {
            let size = norm(row).max(f64::MIN_POSITIVE);
            row.iter().map(move |x| x / size)
        });
        let rows: Vec<f64> = rows.collect();
        let independent = Singular::new(&rows, m, n)?.values;
        Some(Ranks {
            bracket: values.iter().filter(|x| **x > RANK * scale).count(),
            gradients: independent.iter().filter(|x| **x > GRADIENTS).count(),
        })
    }

    /// Whether the state that tells the scale has the values of the Casimirs.
    pub fn state_is_on_level(self) -> bool {
        let (n, m) = (self.equations.sizes.n, self.equations.sizes.m);
        let on_level = || {
            let (levels, state) = self.equations.leaf(self.parameters)?;
            let y = [state.as_slice(), &vec![0.0; m]].concat();
            let shape = self.equations.shape(&y, self.parameters)?;
            let linear = self.equations.linear(&y, self.parameters)?;
            let gradients = shape.gradients.chunks(n.max(1)).zip(&levels);
            let mut pairs = linear.residual[n..].iter().zip(gradients);
            Some(pairs.all(|(off, (gradient, level))| {
                off.abs() <= 1e-9 * (level.abs() + norm(gradient) * norm(&state))
            }))
        };
        on_level().unwrap_or(false)
    }

    /// Whether a regular state of the level set is certainly on another leaf than the state that tells the scale; `None` where that one is not
    /// regular or not on the level set, or there are no leaves.
    pub fn is_on_other_leaf(self, y: &[f64]) -> Option<bool> {
        let (n, m) = (self.equations.sizes.n, self.equations.sizes.m);
        let (_, state) = self.equations.leaf(self.parameters)?;
        let own = [state, vec![0.0; m]].concat();
        let tells = self.equations.system.has_leaves && self.state_is_on_level();
        if !tells || !self.is_regular(&own) {
            return None;
        }
        let sign = |y: &[f64]| {
            let shape = self.equations.shape(y, self.parameters)?;
            let all = n + m;
            let mut bordered = vec![0.0; all * all];
            for i in 0..n {
                bordered[i * all..i * all + n].copy_from_slice(&shape.bracket[i * n..(i + 1) * n]);
                for k in 0..m {
                    let slope = shape.gradients[k * n + i];
                    bordered[i * all + n + k] = slope;
                    bordered[(n + k) * all + i] = -slope;
                }
            }
            Some(pfaffian_sign(bordered, all))
        };
        Some(sign(y)? * sign(&own)? < 0.0)
    }
}
