//! Following one branch, and refining what changes along it.

use crate::branch::{Branch, Change, ChangeKind, Point, is_same};
use crate::crossing::{self, LAST_DIGITS, Node, places};
use crate::curve::Curve;
use crate::dense::{add, difference, dot, norm};
use crate::discriminant::discriminant;
use crate::newton::At;
use crate::search::distance;
use crate::stability::{Linearisation, Stability};

/// Steps of a branch in one direction.
const STEPS: usize = 4000;
/// The largest and the smallest step.
const STRIDES: [f64; 2] = [0.05, 1e-7];
/// A discriminant that is so small on both sides of a step tells nothing.
const NOTHING: f64 = 1e-12;

/// A point on the way, with the functions whose zeros are changes.
struct Stop {
    u: Vec<f64>,
    tangent: Vec<f64>,
    point: Point,
    tests: [f64; 3],
}

impl Stop {
    /// The stability, which is not decided on a change itself.
    fn sure_beside(&self, other: &Self) -> Stability {
        let is_on = |k: usize| {
            let size = other.tests[k].abs();
            size > NOTHING && self.tests[k].abs() < ZERO * size
        };
        match self.point.stability {
            Stability::Spectral if is_on(1) || is_on(2) => Stability::Undecided,
            stability => stability,
        }
    }
}

/// A function of the branch below this part of its value beside is zero.
const ZERO: f64 = 1e-9;
/// A product of eigenvalues below this part of the one before is on a change.
const ON: f64 = 1e-3;
/// A point is at a change within this part of the range, with a state that is so near.
const AT: f64 = 1e-12;
const NEAR: f64 = 1e-3;
/// What bisection alone finds is known to this part of the range.
const THRESHOLD: f64 = 1e-6;

/// What follows a branch.
pub struct Follower<'a> {
    /// Along this curve,
    pub curve: Curve<'a>,
    /// with points at these values of the parameter,
    pub grid: &'a [f64],
    /// until it comes to one of these.
    pub known: &'a [Branch],
}

impl Follower<'_> {
    /// The branch through a point at a value of the grid.
    pub fn branch(&self, y: &[f64], node: usize) -> Option<Branch> {
        let u = self.curve.point(y, self.grid[node]);
        let mut tangent = self.curve.tangent(&u, None)?;
        if tangent[tangent.len() - 1] < 0.0 {
            tangent.iter_mut().for_each(|x| *x = -*x);
        }
        let back: Vec<f64> = tangent.iter().map(|x| -x).collect();
        let mut start = self.stop(u.clone(), tangent)?;
        start.point.grid = Some(node);
        let mut branch = Branch {
            family: self.curve.family,
            points: Vec::new(),
            changes: Vec::new(),
        };
        let backwards = self.stop(u, back)?;
        self.follow(backwards, &mut branch);
        branch.points.reverse();
        branch.changes.reverse();
        branch
            .changes
            .iter_mut()
            .for_each(|change| change.stability.reverse());
        branch.points.push(start.point.clone());
        self.follow(start, &mut branch);
        self.thresholds(&mut branch);
        Some(branch)
    }

    /// Marks the points that are where something changes, up to what is known of it: their spectra are those of neither side.
    fn thresholds(&self, branch: &mut Branch) {
        let range = self.curve.scale[self.curve.scale.len() - 1];
        for point in &mut branch.points {
            let here = |change: &&Change| {
                let off = (change.parameter - point.parameter).abs();
                off <= change.error.max(AT * range)
                    && distance(&change.y, &point.y) < NEAR
                    && change.stability[0] != change.stability[1]
            };
            if let Some(change) = branch.changes.iter().find(here) {
                point.threshold = Some(change.kind);
                point.stability = Stability::Undecided;
            }
        }
    }

    /// Everything at a point of the curve.
    fn stop(&self, u: Vec<f64>, tangent: Vec<f64>) -> Option<Stop> {
        let (mut y, parameters) = (self.curve.unknowns(&u), self.curve.parameters(&u));
        let shape = self.curve.equations.shape(&y, &parameters)?;
        let linearisation = Linearisation::new(self.curve.equations.sizes, &shape)?;
        let family = self.curve.family;
        let judgement = linearisation.judge(self.curve.equations, &shape, family);
        let q = linearisation.even.get(family..).unwrap_or_default();
        // the product of the squares of all eigenvalues is smooth, and not in parts of the largest
        let degree = 2 * q.len().saturating_sub(1) as i32;
        let product = q.first().map(|q| q * linearisation.scale.powi(degree));
        let tests = [
            tangent[tangent.len() - 1],
            product.unwrap_or(1.0),
            discriminant(q),
        ];
        let mut energy = shape.energy;
        let at = At {
            equations: self.curve.equations,
            parameters: &parameters,
        };
        at.round_zeros(&mut y, &mut energy);
        Some(Stop {
            point: Point {
                parameter: self.curve.parameter(&u),
                energy,
                growth: linearisation.growth(),
                stability: judgement.stability,
                threshold: None,
                grid: None,
                y,
            },
            u,
            tangent,
            tests,
        })
    }

    /// The point at a distance along the tangent.
    fn ahead(&self, from: &Stop, stride: f64) -> Option<Stop> {
        let mut u = from.u.clone();
        add(&mut u, stride, &from.tangent);
        let (next, moved) = self.curve.correct(&u, &from.tangent)?;
        if moved > 0.3 * stride.abs() + 1e-12 {
            return None;
        }
        let tangent = self.curve.tangent(&next, Some(&from.tangent))?;
        self.stop(next, tangent)
    }

    fn follow(&self, mut from: Stop, branch: &mut Branch) {
        let (low, high) = (self.grid[0], self.grid[self.grid.len() - 1]);
        let (low, high) = (low.min(high), low.max(high));
        let most = STRIDES[0].min((1.0 / (self.grid.len() - 1).max(1) as f64).max(0.005));
        let (start, mut stride) = (from.u.clone(), 0.2 * most);
        for step in 0..STEPS {
            let next = self.ahead(&from, stride);
            let next = next.filter(|next| dot(&next.tangent, &from.tangent) > 0.9);
            let Some(next) = next else {
                stride *= 0.5;
                if stride < STRIDES[1] {
                    return;
                }
                continue;
            };
            // not onto a change itself, where nothing has a sign
            let next = match next.tests[1].abs() < ON * from.tests[1].abs() {
                true => self.ahead(&from, 1.1 * stride).unwrap_or(next),
                false => next,
            };
            let at = next.point.parameter;
            if !(low..=high).contains(&at) {
                let edge = if at < low { low } else { high };
                if edge != from.point.parameter {
                    let over = (edge - from.point.parameter) / (at - from.point.parameter);
                    self.changes(&from, &next, branch, [low, high]);
                    self.at_value(&from, &next, over, edge, branch);
                }
                return;
            }
            self.changes(&from, &next, branch, [low, high]);
            if !self.grid_values(&from, &next, branch) {
                return;
            }
            let back = difference(&next.u, &start);
            branch.points.push(next.point.clone());
            from = next;
            if step > 10 && norm(&back) < 0.5 * stride {
                return;
            }
            stride = (1.5 * stride).min(most);
        }
    }

    /// Puts the points at values of the grid between two stops in; whether none of them is one of a known branch.
    fn grid_values(&self, from: &Stop, to: &Stop, branch: &mut Branch) -> bool {
        let (a, b) = (from.point.parameter, to.point.parameter);
        let inside = |k: &usize| (self.grid[*k] - a) * (self.grid[*k] - b) < 0.0;
        let mut between: Vec<usize> = (0..self.grid.len()).filter(inside).collect();
        between.sort_by(|i, j| {
            let far = |k: usize| (self.grid[k] - a).abs();
            far(*i).total_cmp(&far(*j))
        });
        for k in between {
            let over = (self.grid[k] - a) / (b - a);
            if !self.at_value(from, to, over, self.grid[k], branch) {
                return false;
            }
        }
        true
    }

    /// Puts the point at a value of the parameter between two stops in; whether it is none of a known branch.
    fn at_value(&self, from: &Stop, to: &Stop, over: f64, value: f64, branch: &mut Branch) -> bool {
        let mut u = from.u.clone();
        add(&mut u, over, &difference(&to.u, &from.u));
        let mut parameters = self.curve.base.to_vec();
        parameters[self.curve.varying] = value;
        let at = At {
            equations: self.curve.equations,
            parameters: &parameters,
        };
        let Some(y) = at.polish(self.curve.unknowns(&u)) else {
            return true;
        };
        let Some(mut stop) = self.stop(self.curve.point(&y, value), from.tangent.clone()) else {
            return true;
        };
        stop.point.parameter = value;
        stop.point.grid = self.grid.iter().position(|x| *x == value);
        let node = stop.point.grid;
        let family = self.curve.family;
        let own = std::iter::once(&*branch);
        let others = self.known.iter().filter(|other| other.family == family);
        let mut points = own.chain(others).flat_map(|other| &other.points);
        let known = points
            .any(|point| point.grid == node && is_same(at, point, family, &y, stop.point.energy));
        if !known {
            branch.points.push(stop.point);
        }
        !known
    }

    /// What changes between two stops, within a range of the parameter.
    fn changes(&self, from: &Stop, to: &Stop, branch: &mut Branch, range: [f64; 2]) {
        let stability = [from.sure_beside(to), to.sure_beside(from)];
        let signs = |k: usize| from.tests[k] * to.tests[k] < 0.0;
        let differs = stability[0] != stability[1];
        let mut kinds: Vec<(usize, ChangeKind)> = Vec::new();
        if signs(0) {
            kinds.push((0, ChangeKind::Fold));
        } else if differs {
            let tells = from.tests[2].abs().max(to.tests[2].abs()) > NOTHING;
            if signs(1) {
                kinds.push((1, ChangeKind::Zero));
            }
            if signs(2) && tells {
                kinds.push((2, ChangeKind::Collision));
            }
        }
        let mut located = false;
        let length = {
            let way = difference(&to.u, &from.u);
            dot(&way, &from.tangent)
        };
        for (test, kind) in kinds {
            let sign = |stop: &Stop| Some(stop.tests[test]);
            let crossing = (kind == ChangeKind::Zero).then(|| self.crossing(from, length));
            let found = crossing
                .flatten()
                .or_else(|| self.zero(from, length, from.tests[test], to.tests[test], &sign));
            located |= found.is_some();
            self.add(found, kind, stability, branch, range);
        }
        if differs && !located {
            let side = |stop: &Stop| {
                Some(if stop.point.stability == stability[0] {
                    -1.0
                } else {
                    1.0
                })
            };
            let found = self.zero(from, length, -1.0, 1.0, &side);
            // what is bisected has a threshold, and moves with it
            let least = THRESHOLD * self.curve.scale[self.curve.scale.len() - 1];
            let found = found.map(|(stop, error)| (stop, error.max(least)));
            self.add(found, ChangeKind::Other, stability, branch, range);
        }
    }

    fn add(
        &self,
        found: Option<(Stop, f64)>,
        kind: ChangeKind,
        stability: [Stability; 2],
        branch: &mut Branch,
        [low, high]: [f64; 2],
    ) {
        let Some((mut stop, error)) = found else {
            return;
        };
        // an end of the range but for the error
        let inside = stop.point.parameter.clamp(low, high);
        if (inside - stop.point.parameter).abs() <= error {
            stop.point.parameter = inside;
        }
        if (low..=high).contains(&stop.point.parameter) {
            branch.changes.push(Change {
                parameter: stop.point.parameter,
                error,
                y: stop.point.y,
                energy: stop.point.energy,
                kind,
                stability,
            });
        }
    }

    /// Where an eigenvalue passes zero along a step.
    fn crossing(&self, from: &Stop, length: f64) -> Option<(Stop, f64)> {
        let node = |place: f64| {
            let stop = self.ahead(from, place)?;
            Some(Node {
                place,
                value: stop.tests[1],
                u: stop.u,
            })
        };
        let nodes: Vec<Node> = places(length).filter_map(node).collect();
        let (u, error) = crossing::zero(&nodes, length)?;
        let stop = self.stop(u, from.tangent.clone())?;
        Some((stop, error * self.curve.scale[self.curve.scale.len() - 1]))
    }

    /// The zero of a function along a step: regula falsi that halves an end which stays (Illinois), and bisection.
    fn zero(
        &self,
        from: &Stop,
        length: f64,
        first: f64,
        last: f64,
        of: &dyn Fn(&Stop) -> Option<f64>,
    ) -> Option<(Stop, f64)> {
        let (mut a, mut b, mut fa, mut fb) = (0.0, length, first, last);
        let (mut low, mut high): (Option<Stop>, Option<Stop>) = (None, None);
        for k in 0..120 {
            let middle = match k % 3 {
                2 => 0.5 * (a + b),
                _ => (a * fb - b * fa) / (fb - fa),
            };
            if middle <= a.min(b) || middle >= a.max(b) || (b - a).abs() < 1e-16 {
                break;
            }
            let stop = self.ahead(from, middle)?;
            let value = of(&stop)?;
            if value == 0.0 {
                let error = LAST_DIGITS * stop.point.parameter.abs();
                return Some((stop, error));
            }
            if value * fa > 0.0 {
                (a, fa, fb) = (middle, value, 0.5 * fb);
                low = Some(stop);
            } else {
                (b, fb, fa) = (middle, value, 0.5 * fa);
                high = Some(stop);
            }
        }
        let error = match (&low, &high) {
            (Some(low), Some(high)) => (low.point.parameter - high.point.parameter).abs(),
            _ => length.abs() * self.curve.scale[self.curve.scale.len() - 1],
        };
        let stop = low.or(high)?;
        let error = error.max(LAST_DIGITS * stop.point.parameter.abs());
        Some((stop, error))
    }
}
