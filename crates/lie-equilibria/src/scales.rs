//! Equilibria far from the scale of the initial state.
//!
//! Without Casimirs nothing but the initial state tells a scale, and a unit that is a million times smaller would hide an equilibrium from starts
//! near that state. A few starts at each of several scales tell at which of them there are isolated equilibria, and these are searched. A
//! function that is no polynomial may have equilibria at every scale, as a cosine has: of such ones other scales are searched only where the
//! own one has none but the origin, and the nearest of them.

use crate::dense::{difference, norm};
use crate::homotopy::Paths;
use crate::newton::At;
use crate::search::Candidate;
use crate::system::{Equations, shortest};

/// Powers of ten by which scales are apart, and how many there are on either side.
const DECADES: i32 = 2;
const SCALES: i32 = 9;
/// Starts that tell whether there is anything at a scale.
const PROBES: usize = 10;
/// A state belongs to a scale within this factor of it.
const OWN: f64 = 30.0;
/// States closer than this part of their size are one.
const SAME: f64 = 1e-6;

/// What was found at a scale.
pub struct Scale {
    /// The equations with a state of that scale.
    pub equations: Equations,
    /// The isolated solutions of that scale that are none of those that are known.
    pub candidates: Vec<Candidate>,
    /// What was followed in the complex plane.
    pub paths: Option<Paths>,
    /// Starts, and how many of them led to a solution.
    pub starts: [usize; 2],
}

impl Equations {
    /// The same equations with another state that tells the scale.
    pub(crate) fn at_state(&self, state: &[f64]) -> Option<Self> {
        let mut system = self.system.clone();
        for (place, value) in system.state.iter_mut().zip(state) {
            *place = system.graph.number(shortest(*value)?);
        }
        Self::new(system, self.varying).ok()
    }

    /// Isolated equilibria of a system without Casimirs that are far from the scale of its state, beside those that are known.
    pub fn beyond(
        &self,
        parameters: &[f64],
        known: &[Candidate],
        starts: usize,
        seed: u64,
    ) -> Vec<Scale> {
        let Some((_, state)) = self.leaf(parameters).filter(|_| self.sizes.m == 0) else {
            return Vec::new();
        };
        let state = match norm(&state) {
            0.0 => vec![1.0; state.len()],
            _ => state,
        };
        let size = norm(&state);
        let mut known: Vec<Vec<f64>> = known.iter().map(|one| one.y.clone()).collect();
        let is_polynomial = self.polynomial().is_some();
        if !is_polynomial && known.iter().any(|y| norm(y) > size / OWN) {
            return Vec::new();
        }
        let mut powers: Vec<i32> = (-SCALES..=SCALES).filter(|power| *power != 0).collect();
        powers.sort_by_key(|power| power.abs());
        let mut scales = Vec::new();
        for power in powers {
            let factor = 10.0_f64.powi(DECADES * power);
            let state: Vec<f64> = state.iter().map(|x| factor * x).collect();
            let Some(equations) = self.at_state(&state) else {
                continue;
            };
            let at = At {
                equations: &equations,
                parameters,
            };
            // a few starts beside those of the axes
            if at.of_scale(PROBES, seed, false, &known).is_none() {
                continue;
            }
            let Some(([starts, converged], candidates, paths)) =
                at.of_scale(starts, seed, true, &known)
            else {
                continue;
            };
            known.extend(candidates.iter().map(|one| one.y.clone()));
            scales.push(Scale {
                equations,
                candidates,
                paths,
                starts: [starts, converged],
            });
            if !is_polynomial {
                break;
            }
        }
        scales
    }
}

impl Scale {
    /// Whether a solution that was found at a larger scale is none at this one, or one of those that were found at it: what is small beside its
    /// scale is known to a part of that scale alone.
    pub fn replaces(&self, parameters: &[f64], other: &Candidate) -> bool {
        let at = At {
            equations: &self.equations,
            parameters,
        };
        let Some((_, state)) = self.equations.leaf(parameters) else {
            return false;
        };
        let part = norm(&other.y) / norm(&state);
        if other.dimension > 0 || !(1.0 / OWN..OWN).contains(&part) {
            return false;
        }
        at.solve(&other.y).is_none_or(|y| {
            self.candidates.iter().any(|one| {
                let apart = norm(&difference(&y, &one.y));
                apart <= SAME * norm(&one.y)
            })
        })
    }
}

/// Starts and how many converged, what is new, and the paths.
type Found = ([usize; 2], Vec<Candidate>, Option<Paths>);

impl At<'_> {
    /// Isolated solutions of the scale of the state that are not known; `None` where there are none.
    fn of_scale(
        self,
        starts: usize,
        seed: u64,
        with_paths: bool,
        known: &[Vec<f64>],
    ) -> Option<Found> {
        let (_, state) = self.equations.leaf(self.parameters)?;
        let size = norm(&state);
        let mut found = self.search(starts, seed, with_paths)?;
        found.candidates.retain(|one| {
            let part = norm(&one.y) / size;
            let is_known = known.iter().any(|y| {
                let apart = norm(&difference(y, &one.y));
                apart <= SAME * norm(y).max(norm(&one.y))
            });
            let isolated = one.dimension == 0 && !one.degenerate;
            isolated && (1.0 / OWN..OWN).contains(&part) && !is_known
        });
        let any = !found.candidates.is_empty();
        any.then_some((
            [found.starts, found.converged],
            found.candidates,
            found.paths,
        ))
    }
}
