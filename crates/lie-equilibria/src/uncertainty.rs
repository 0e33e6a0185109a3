//! How far a solution may be from where numbers see it.
//!
//! The residual F has round-off of the size `rho = c eps |F'| s` in each equation, with the scales s of states and multipliers. Where `|F| <= rho` all along a piece of a line
//! through a solution, no number tells which point of the piece the solution is: of a simple root it is about rho/sigma long, with the
//! smallest singular value sigma of F', of a double one about `sqrt(rho)`, of a triple one `rho^(1/3)`.

use crate::dense::{Singular, add, norm};
use crate::homotopy::multiplier;
use crate::newton::{At, is_below};
use crate::stability::Linearisation;

/// The constant c.
const ROUNDING: f64 = 64.0 * f64::EPSILON;
/// A number below this part of its scale is zero but for round-off.
const ZERO: f64 = 1e-13;
/// A piece that is longer than this part of the scale is no uncertainty.
const LONG: f64 = 1e-2;

/// A piece of a line along which F is round-off.
pub struct Reach {
    /// Half its length.
    pub length: f64,
    /// Its ends.
    ends: [Vec<f64>; 2],
}

impl At<'_> {
    /// The scale of states: that of the initial one.
    pub fn size(self, y: &[f64]) -> f64 {
        let state = self.equations.leaf(self.parameters);
        let size = state.map_or(0.0, |(_, state)| norm(&state));
        let own = norm(&y[..self.equations.sizes.n]);
        match size.max(own) {
            0.0 => 1.0,
            size => size,
        }
    }

    /// Makes what round-off left of zeros zero: entries of a state, multipliers and H, in parts of their scales.
    pub(crate) fn round_zeros(self, y: &mut [f64], energy: &mut f64) {
        let (n, size) = (self.equations.sizes.n, self.size(y));
        let lambda = multiplier(self, &y[..n], size).max(norm(&y[n..]));
        for (k, entry) in y.iter_mut().enumerate() {
            let scale = if k < n { size } else { lambda };
            if entry.abs() <= ZERO * scale {
                *entry = 0.0;
            }
        }
        if energy.abs() <= ZERO * self.energy_scale().unwrap_or(0.0) {
            *energy = 0.0;
        }
    }

    /// The scale of H: how much it changes along the scale of states.
    fn energy_scale(self) -> Option<f64> {
        let (_, state) = self.equations.leaf(self.parameters)?;
        let size = self.size(&state);
        let beside = state.iter().map(|x| x + 0.1 * size);
        let y: Vec<f64> = beside.chain(vec![0.0; self.equations.sizes.m]).collect();
        let linear = self.equations.linear(&y, self.parameters)?;
        Some(norm(&linear.residual[..state.len()]) * size)
    }

    /// How far a member of a family of this dimension is uncertain, in the direction in which it is least certain.
    pub fn reach(self, y: &[f64], family: usize) -> Option<Reach> {
        let n = self.equations.unknowns();
        let linear = self.equations.linear(y, self.parameters)?;
        let singular = Singular::new(&linear.slope, n, n)?;
        let direction = singular.right.get(n.checked_sub(family + 1)?)?;
        let size = self.size(y);
        // what was accepted as a solution is round-off too
        let references = self.references().into_iter().zip(&linear.residual);
        let round_off: Vec<f64> = references
            .map(|(size, residual)| (ROUNDING * size).max(2.0 * residual.abs()))
            .collect();
        let at = |part: f64| {
            let mut other = y.to_vec();
            add(&mut other, part, direction);
            other
        };
        let is_flat = |part: f64| {
            let linear = self.equations.linear(&at(part), self.parameters);
            linear.is_some_and(|linear| is_below(&linear.residual, 1.0, &round_off))
        };
        let mut length = f64::EPSILON * size;
        while length < LONG * size && (is_flat(2.0 * length) || is_flat(-2.0 * length)) {
            length *= 2.0;
        }
        // the next power is beyond
        length *= 2.0;
        Some(Reach {
            length,
            ends: [at(length), at(-length)],
        })
    }

    /// Whether the Hessian has the same signs all over a piece.
    pub fn keeps_signs(self, linearisation: &Linearisation, reach: &Reach) -> bool {
        reach.ends.iter().all(|end| {
            let shape = self.equations.shape(end, self.parameters);
            let other = shape.and_then(|shape| Linearisation::new(self.equations.sizes, &shape));
            other.is_some_and(|other| other.inertia == linearisation.inertia)
        })
    }
}
