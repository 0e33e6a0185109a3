//! A state of the size of a level set, where the given one is not.
//!
//! Values of Casimirs may be given that are many powers of ten from those of the initial state, which then does not tell the scale of what is
//! searched. Along the ray of that state the Casimirs are compared with their values, and from where they are nearest Newton's steps lead to the
//! level set.

use crate::dense::{difference, norm};
use crate::newton::At;
use crate::system::Equations;

/// States on the ray are tried up to this power of two, each so many times.
const POWERS: i32 = 400;
const EACH: f64 = 2.0;
/// So many of them are tried as starts.
const TRIED: usize = 16;
/// A level set whose size is within this factor of that of the state is near.
const NEAR: f64 = 10.0;

impl Equations {
    /// The same equations with a state on the level set; `None` where the given state is near it, or none is found.
    pub fn at_level(&self, parameters: &[f64]) -> Option<Self> {
        let at = At {
            equations: self,
            parameters,
        };
        let (_, state) = self.leaf(parameters)?;
        let (n, size) = (state.len(), norm(&state));
        if self.sizes.m == 0 || size == 0.0 {
            return None;
        }
        let is_near = |y: &[f64]| {
            let part = norm(&y[..n]) / size;
            (1.0 / NEAR..NEAR).contains(&part)
        };
        if at.on_leaf(&state).is_some_and(|y| is_near(&y)) {
            return None;
        }
        let mut places: Vec<(f64, Vec<f64>)> = (-POWERS..=POWERS)
            .filter_map(|power| {
                let factor = (f64::from(power) / EACH).exp2();
                let x: Vec<f64> = state.iter().map(|x| factor * x).collect();
                Some((at.mismatch(&x)?, x))
            })
            .collect();
        places.sort_by(|a, b| a.0.total_cmp(&b.0));
        let places = places.into_iter().take(TRIED);
        let found = places.filter_map(|(_, x)| {
            let y = at.on_leaf(&x)?;
            let moved = norm(&difference(&y[..n], &x)) / norm(&x);
            norm(&y[..n]).is_normal().then_some((moved, y))
        });
        // the one that the ray told best
        let (_, found) = found.min_by(|a, b| a.0.total_cmp(&b.0))?;
        self.at_state(&found[..n])
    }
}

impl At<'_> {
    /// How far the Casimirs are from their values in a state: a number between 0 and 1 for each.
    fn mismatch(self, x: &[f64]) -> Option<f64> {
        let m = self.equations.sizes.m;
        let y = [x, &vec![0.0; m]].concat();
        let linear = self.equations.linear(&y, self.parameters)?;
        let (levels, _) = self.equations.leaf(self.parameters)?;
        let pairs = linear.residual[x.len()..].iter().zip(&levels);
        let parts = pairs.map(|(off, level)| match (off + level).abs() + level.abs() {
            0.0 => 0.0,
            size => off.abs() / size,
        });
        Some(parts.sum())
    }
}
