//! Branches of equilibria in a parameter, with folds and changes of stability.
//!
//! Equilibria are searched at some values of the parameter. From each one that lies on no branch yet, the branch is followed both ways
//! through the range. A change of stability is where a function of the branch is zero: the last coefficient of
//! `q`, `det(s - L) = q(s^2)`, where an eigenvalue passes zero; its discriminant, where two meet; the component of the tangent along the
//! parameter, in a fold. Each is found to round-off, since it is smooth there.

use crate::curve::Curve;
use crate::dense::{add, norm};
use crate::family::Solutions as _;
use crate::follower::Follower;
use crate::newton::At;
use crate::scaling::Scaled;
use crate::search::{close, distance};
use crate::stability::Stability;
use crate::system::Equations;

/// Values of the parameter at which equilibria are searched.
const NODES: usize = 5;

/// An equilibrium of a branch.
#[derive(Clone, Debug)]
pub struct Point {
    /// The parameter.
    pub parameter: f64,
    /// State and multipliers.
    pub y: Vec<f64>,
    /// H.
    pub energy: f64,
    /// The largest real part of an eigenvalue.
    pub growth: f64,
    /// Its stability, by numbers.
    pub stability: Stability,
    /// What changes there, if it is a threshold; then nothing is decided.
    pub threshold: Option<ChangeKind>,
    /// Which of the values of the grid the parameter is, if it is one.
    pub grid: Option<usize>,
}

/// What happens at a change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChangeKind {
    /// The branch turns back.
    Fold,
    /// It turns back where it meets another one.
    Meeting,
    /// An eigenvalue passes zero.
    Zero,
    /// Two pairs of eigenvalues meet.
    Collision,
    /// The stability is another, by bisection alone.
    Other,
}

/// A point of a branch where something changes.
#[derive(Clone, Debug)]
pub struct Change {
    /// The parameter.
    pub parameter: f64,
    /// By how much it is known.
    pub error: f64,
    /// The state and the multipliers.
    pub y: Vec<f64>,
    /// H.
    pub energy: f64,
    /// What happens.
    pub kind: ChangeKind,
    /// The stability on both sides, in the order of the points.
    pub stability: [Stability; 2],
}

/// A branch.
#[derive(Clone, Debug)]
pub struct Branch {
    /// The dimension of the family of each of its members.
    pub family: usize,
    /// Its points in order.
    pub points: Vec<Point>,
    /// What changes along it, in order.
    pub changes: Vec<Change>,
}

/// What was followed.
#[derive(Clone, Debug)]
pub struct Traced {
    /// The branches.
    pub branches: Vec<Branch>,
    /// The values at which equilibria were searched.
    pub nodes: Vec<f64>,
    /// Starts of each search.
    pub starts: usize,
}
/// Follows all branches over a grid of values of a parameter; `base` has the values of the others. Where states, H or Casimirs are far from 1
/// at the first value, it is done in units in which they are about 1.
pub fn trace(
    equations: &Equations,
    base: &[f64],
    varying: usize,
    grid: &[f64],
    starts: usize,
    seed: u64,
) -> Traced {
    let mut parameters = base.to_vec();
    parameters[varying] = grid[0];
    let first = At {
        equations,
        parameters: &parameters,
    };
    let Some(scaled) = Scaled::new(first) else {
        return trace_as_given(equations, base, varying, grid, starts, seed);
    };
    let mut traced = trace_as_given(&scaled.equations, base, varying, grid, starts, seed);
    let branches = traced.branches.iter_mut();
    branches.for_each(|branch| scaled.back_branch(branch));
    traced
}

fn trace_as_given(
    equations: &Equations,
    base: &[f64],
    varying: usize,
    grid: &[f64],
    starts: usize,
    seed: u64,
) -> Traced {
    let mut nodes: Vec<usize> = (0..NODES)
        .map(|k| k * (grid.len() - 1) / (NODES - 1))
        .collect();
    nodes.dedup();
    let mut traced = Traced {
        branches: Vec::new(),
        nodes: nodes.iter().map(|node| grid[*node]).collect(),
        starts,
    };
    for node in nodes {
        let mut parameters = base.to_vec();
        parameters[varying] = grid[node];
        let at = At {
            equations,
            parameters: &parameters,
        };
        // what is complete at the ends begins, or ends, most branches
        let ends = node == 0 || node + 1 == grid.len();
        let Some(found) = at.search(starts, seed, ends) else {
            continue;
        };
        traced.starts = found.starts;
        for candidate in found
            .candidates
            .iter()
            .filter(|candidate| !candidate.degenerate)
        {
            let is_known = traced.branches.iter().any(|branch| {
                branch.family == candidate.dimension
                    && branch.points.iter().any(|point| {
                        point.grid == Some(node)
                            && is_same(
                                at,
                                point,
                                candidate.dimension,
                                &candidate.y,
                                candidate.energy,
                            )
                    })
            });
            if is_known {
                continue;
            }
            let range = (grid[grid.len() - 1] - grid[0]).abs();
            let size = norm(&candidate.y[..equations.sizes.n]);
            let multipliers = norm(&candidate.y[equations.sizes.n..]).max(1e-3);
            let mut scale = vec![size; equations.sizes.n];
            scale.resize(equations.unknowns(), multipliers);
            scale.push(range);
            let curve = Curve {
                equations,
                base,
                varying,
                scale,
                family: candidate.dimension,
            };
            let branch = Follower {
                curve,
                grid,
                known: &traced.branches,
            }
            .branch(&candidate.y, node);
            traced.branches.extend(branch);
        }
    }
    meetings(&mut traced.branches, equations.sizes.n);
    traced
}

/// Whether a point is a solution, or one of its family.
pub(crate) fn is_same(at: At<'_>, point: &Point, family: usize, y: &[f64], energy: f64) -> bool {
    let n = at.equations.sizes.n;
    match family {
        0 => distance(&point.y[..n], &y[..n]) < 1e-5,
        _ => close(point.energy, energy) && at.leads(&point.y, y),
    }
}

/// Folds at points of other branches are where branches meet.
fn meetings(branches: &mut [Branch], n: usize) {
    let whole: Vec<Branch> = branches.to_vec();
    for (place, branch) in branches.iter_mut().enumerate() {
        let folds = branch.changes.iter_mut();
        for change in folds.filter(|change| change.kind == ChangeKind::Fold) {
            let others = whole
                .iter()
                .enumerate()
                .filter(|(other, _)| *other != place);
            let meets = others.into_iter().any(|(_, other)| {
                other.points.windows(2).any(|pair| {
                    let [a, b] = pair else { return false };
                    let (from, to) = (a.parameter, b.parameter);
                    if (change.parameter - from) * (change.parameter - to) > 0.0 || from == to {
                        return false;
                    }
                    let over = (change.parameter - from) / (to - from);
                    let mut between = a.y.clone();
                    add(&mut between, over, &crate::dense::difference(&b.y, &a.y));
                    distance(&between[..n], &change.y[..n]) < 1e-3
                })
            });
            if meets {
                change.kind = ChangeKind::Meeting;
            }
        }
    }
}
