//! The search for all relative equilibria on a leaf.
//!
//! Newton's iteration starts from states of the leaf that are drawn by chance, the same in every run, and from those near the axes of
//! the coordinates. What is found twice counts once. A solution whose linearisation has a kernel is tested: where solutions go on
//! along the kernel it belongs to a family, of which one member is kept; two members belong to the same family where one
//! is reached from the other along it.

use crate::dense::{difference, norm};
use crate::family::{SAME, STRIDE, Solutions};
use crate::homotopy::{self, Paths};
use crate::newton::At;
use crate::random::Random;
use crate::scaling::Scaled;
use crate::stability::Linearisation;

/// A level below this part of the terms of its Casimir is round-off.
const RESOLVED: f64 = 1e-10;
/// So many members of a family are told apart by walks; further ones with the same energy and multipliers count as members.
const WALKS: usize = 12;

/// A solution.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// State and multipliers.
    pub y: Vec<f64>,
    /// H.
    pub energy: f64,
    /// The dimension of the family that it belongs to, 0 where it is isolated.
    pub dimension: usize,
    /// Whether the linearisation has a kernel along which no solutions go on, as far as the numbers tell.
    pub degenerate: bool,
    /// How far it may be from where the numbers see it.
    pub reach: f64,
    /// How often it was found.
    pub hits: usize,
}

/// What a search found.
#[derive(Clone, Debug)]
pub struct Found {
    /// The solutions, by ascending energy.
    pub candidates: Vec<Candidate>,
    /// Starts.
    pub starts: usize,
    /// How many of them led to a solution on the leaf.
    pub converged: usize,
    /// What was followed in the complex plane.
    pub paths: Option<Paths>,
}

impl At<'_> {
    /// Looks for all solutions from so many starts, and by paths in the complex plane where they are few enough. `None` where the leaf
    /// is not one: its values are not finite.
    pub fn search(self, starts: usize, seed: u64, with_paths: bool) -> Option<Found> {
        let Some(scaled) = Scaled::new(self) else {
            return self.search_as_given(starts, seed, with_paths);
        };
        let at = At {
            equations: &scaled.equations,
            parameters: self.parameters,
        };
        let mut found = at.search_as_given(starts, seed, with_paths)?;
        found
            .candidates
            .iter_mut()
            .for_each(|candidate| scaled.back(candidate));
        Some(found)
    }

    fn search_as_given(self, starts: usize, seed: u64, with_paths: bool) -> Option<Found> {
        let (_, state) = self.equations.leaf(self.parameters)?;
        let n = state.len();
        let size = match norm(&state) {
            0.0 => 1.0,
            size => size,
        };
        // paths need the scale of the leaf, which a state far from it does not tell
        let near = self.on_leaf(&state).is_some_and(|y| {
            let part = norm(&y[..n]) / size;
            part == 0.0 || (1e-2..1e2).contains(&part)
        });
        let with_paths = with_paths && near && self.levels_are_resolved();
        let mut found = Found {
            candidates: Vec::new(),
            starts: 0,
            converged: 0,
            paths: None,
        };
        let mut random = Random::new(seed);
        let axes = (0..2 * n).map(|k| {
            let mut x = vec![1e-3 * size; n];
            x[k / 2] = if k % 2 == 0 { size } else { -size };
            x
        });
        let axes: Vec<Vec<f64>> = axes.collect();
        let drawn = (0..starts).map(|_| {
            let far = size * (2.0 * random.unit()).exp2();
            let direction = random.direction(n);
            direction.iter().map(|x| far * x).collect::<Vec<f64>>()
        });
        let all = std::iter::once(state)
            .chain(axes)
            .chain(drawn.collect::<Vec<_>>());
        for x in all {
            found.starts += 1;
            let y = self.on_leaf(&x).and_then(|y| self.solve(&y));
            if let Some(y) = y {
                found.converged += usize::from(self.take(y, &mut found.candidates));
            }
        }
        if with_paths && let Some((paths, ends)) = homotopy::ends(self, seed) {
            found.paths = Some(paths);
            for y in ends.iter().filter_map(|y| self.solve(y)) {
                self.take(y, &mut found.candidates);
            }
        }
        found
            .candidates
            .sort_by(|a, b| a.energy.total_cmp(&b.energy));
        Some(found)
    }

    /// Whether each value of a Casimir that is not zero is more than round-off of the Casimir's terms at the scale of the state.
    fn levels_are_resolved(self) -> bool {
        let n = self.equations.sizes.n;
        let levels = self.equations.leaf(self.parameters);
        let levels = levels.map(|(levels, _)| levels).unwrap_or_default();
        let terms = self.references();
        let mut pairs = levels.iter().zip(&terms[n..]);
        pairs.all(|(level, terms)| *level == 0.0 || level.abs() > RESOLVED * terms)
    }

    /// Adds a solution to those that are known, if it is a new one; whether it is one on the leaf.
    pub fn take(self, y: Vec<f64>, known: &mut Vec<Candidate>) -> bool {
        let n = self.equations.sizes.n;
        if !self.is_regular(&y) {
            return false;
        }
        let scale = self.size(&y);
        let near = |other: &&mut Candidate| {
            let apart = norm(&difference(&y[..n], &other.y[..n]));
            let uncertain = if other.degenerate {
                4.0 * other.reach
            } else {
                0.0
            };
            apart < uncertain || apart < SAME * scale
        };
        if let Some(other) = known.iter_mut().find(near) {
            other.hits += 1;
            return true;
        }
        let Some(candidate) = self.candidate(y) else {
            return false;
        };
        if candidate.dimension > 0 {
            let alike = |other: &&mut Candidate| {
                other.dimension == candidate.dimension
                    && close(other.energy, candidate.energy)
                    && (other.hits > WALKS && distance(&other.y[n..], &candidate.y[n..]) < SAME
                        || self.leads(&other.y, &candidate.y))
            };
            if let Some(other) = known.iter_mut().find(alike) {
                other.hits += 1;
                return true;
            }
        }
        known.push(candidate);
        true
    }

    /// What a solution is.
    pub fn candidate(self, y: Vec<f64>) -> Option<Candidate> {
        let shape = self.equations.shape(&y, self.parameters)?;
        let kernel = self.kernel(&y)?;
        // not within the uncertainty of a point that is small itself
        let stride = 0.1 * STRIDE * norm(&y).max(self.size(&y));
        let goes_on = |direction: &Vec<f64>| self.goes_on(&y, direction, kernel.len(), stride);
        let dimension = kernel.iter().filter(|direction| goes_on(direction)).count();
        let linearisation = Linearisation::new(self.equations.sizes, &shape)?;
        let reach = self.reach(&y, dimension);
        let is_sure = reach
            .as_ref()
            .is_none_or(|reach| self.keeps_signs(&linearisation, reach));
        Some(Candidate {
            energy: shape.energy,
            dimension,
            degenerate: dimension < kernel.len() || !is_sure,
            reach: reach.map_or(0.0, |reach| reach.length),
            hits: 1,
            y,
        })
    }
}

impl Solutions for At<'_> {
    fn kernel(&self, y: &[f64]) -> Option<Vec<Vec<f64>>> {
        At::kernel(*self, y)
    }

    fn polish(&self, y: Vec<f64>) -> Option<Vec<f64>> {
        At::polish(*self, y)
    }
}

/// The distance of two vectors in parts of their size.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    norm(&difference(a, b)) / norm(a).max(norm(b)).max(f64::MIN_POSITIVE)
}

/// Whether two numbers agree but for round-off.
pub fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-8 * a.abs().max(b.abs()).max(1e-4)
}
