//! Paths of velocities: `map(xi) = m_a + s d`, s from 0 to 1, by continuation.
//!
//! Written for one lane of the numbers: what is decided is decided by that lane, and the others are left alone.

use super::legendre::{From, newton, size};
use crate::matrix::SquareMatrix;
use crate::newton::exchanging;
use crate::scalar::{Mask, Scalar};
use crate::state::State;

/// Pieces of a path that are tried before it counts as endless.
const PIECES: usize = 1000;
/// The shortest piece of a path in s, before it counts as a fold.
const SHORTEST: f64 = 1.0 / (1_u64 << 32) as f64;
/// How far s may run on either side behind a fold.
const FAR: f64 = 8.0;
/// Newton steps of a corrector.
const CORRECTIONS: usize = 8;

/// A path in one lane.
struct Path<'a, V, M, F, G> {
    map: &'a F,
    slope: &'a G,
    matrix: &'a mut M,
    /// The momentum at the beginning.
    first: V,
    /// `mu - first`
    change: V,
    lane: usize,
    /// How many components are looked for.
    count: usize,
}

/// Goes along the path from the velocity in `xi` to one of the momentum mu; false where it ends before.
pub(super) fn follow<S, V, M>(
    count: usize,
    (map, slope): (&impl Fn(&V, &mut V), &impl Fn(&V, &mut M)),
    mu: &V,
    from: From,
    lane: usize,
    xi: &mut V,
    matrix: &mut M,
) -> bool
where
    S: Scalar,
    V: State<S>,
    M: SquareMatrix<S>,
{
    let mut first = mu.clone();
    map(xi, &mut first);
    let mut change = mu.clone();
    change.axpy(-S::one(), &first);
    let mut path = Path {
        map,
        slope,
        matrix,
        first,
        change,
        lane,
        count,
    };
    let mut s = 0.0;
    if path.length::<S>(&path.change).is_nan() {
        return false;
    }
    path.straight(&mut s, xi) || (from == From::Rest && path.through_folds(s, xi))
}

impl<V, M, F, G> Path<'_, V, M, F, G>
where
    F: Fn(&V, &mut V),
    G: Fn(&V, &mut M),
{
    fn length<S: Scalar>(&self, vector: &V) -> f64
    where
        V: State<S>,
    {
        size(vector, self.count).lane(self.lane).to_f64()
    }

    fn dot<S: Scalar>(&self, a: &V, b: &V) -> f64
    where
        V: State<S>,
    {
        let pairs = a.as_slice().iter().zip(b.as_slice());
        pairs.take(self.count).fold(0.0, |sum, (&a, &b)| {
            sum + a.lane(self.lane).to_f64() * b.lane(self.lane).to_f64()
        })
    }

    /// Moves to the velocity at s, near xi; false where Newton's iteration does not shrink its steps fast.
    fn newton<S: Scalar>(&mut self, s: f64, xi: &mut V) -> bool
    where
        V: State<S>,
        M: SquareMatrix<S>,
    {
        let mut target = self.first.clone();
        target.axpy(S::from_f64(s), &self.change);
        newton(self.count, self.map, self.slope, &target, xi, self.matrix).lane(self.lane)
    }

    /// Increases s to 1 in pieces; where they get too short, s and the velocity are those before a fold.
    fn straight<S: Scalar>(&mut self, s: &mut f64, xi: &mut V) -> bool
    where
        V: State<S>,
        M: SquareMatrix<S>,
    {
        let mut piece = 0.5_f64;
        for _ in 0..PIECES {
            let next = if *s + piece < 1.0 { *s + piece } else { 1.0 };
            let mut trial = xi.clone();
            if self.newton(next, &mut trial) {
                xi.copy_from(&trial);
                *s = next;
                if next >= 1.0 {
                    return true;
                }
                piece *= 2.0;
            } else {
                piece *= 0.5;
            }
            if piece < SHORTEST {
                return false;
            }
        }
        false
    }

    /// The tangent `(dxi, ds)` of the path, of length 1 with s in units of `unit`; not finite at a singular matrix.
    fn tangent<S: Scalar>(&mut self, unit: f64, xi: &V) -> (V, f64)
    where
        V: State<S>,
        M: SquareMatrix<S>,
    {
        let mut along = self.change.clone();
        (self.slope)(xi, self.matrix);
        exchanging::solve_block(0..self.count, self.matrix, &mut along);
        let length = libm::sqrt(self.dot(&along, &along) + unit * unit);
        for entry in along.as_mut_slice() {
            *entry *= S::from_f64(1.0 / length);
        }
        (along, 1.0 / length)
    }

    /// Goes on by the length of the path, where s may turn round, to the first velocity with `s = 1`.
    fn through_folds<S: Scalar>(&mut self, s: f64, xi: &mut V) -> bool
    where
        V: State<S>,
        M: SquareMatrix<S>,
    {
        let unit = self.length(xi);
        let (mut s, mut tangent) = (s, self.tangent(unit, xi));
        let shortest = SHORTEST * unit;
        let mut piece = 0.01 * unit;
        for _ in 0..PIECES {
            if piece <= shortest || s.abs() >= FAR || (piece * s).is_nan() {
                return false;
            }
            let mut end = xi.clone();
            end.axpy(S::from_f64(piece), &tangent.0);
            let mut s_end = s + piece * tangent.1;
            let turned = self.correct(unit, &tangent, &mut s_end, &mut end);
            let Some(next) = turned else {
                piece *= 0.5;
                continue;
            };
            if s < 1.0 && s_end >= 1.0 {
                let mut last = xi.clone();
                if self.newton(1.0, &mut last) {
                    xi.copy_from(&last);
                    return true;
                }
                piece *= 0.5;
                continue;
            }
            xi.copy_from(&end);
            (s, tangent) = (s_end, next);
            piece *= 1.5;
        }
        false
    }

    /// Moves a point near the path onto it, perpendicular to a tangent. Returns the tangent there, in the same
    /// direction; `None` where the steps do not shrink fast or the path bends much on the way.
    fn correct<S: Scalar>(
        &mut self,
        unit: f64,
        tangent: &(V, f64),
        s: &mut f64,
        xi: &mut V,
    ) -> Option<(V, f64)>
    where
        V: State<S>,
        M: SquareMatrix<S>,
    {
        let mut bound = f64::INFINITY;
        let mut near = false;
        for _ in 0..CORRECTIONS {
            let mut back = xi.clone();
            (self.map)(xi, &mut back);
            back.axpy(-S::one(), &self.first);
            back.axpy(S::from_f64(-*s), &self.change);
            (self.slope)(xi, self.matrix);
            let mut factors = self.matrix.clone();
            exchanging::solve_block(0..self.count, &mut factors, &mut back);
            let mut along = self.change.clone();
            exchanging::solve_block(0..self.count, self.matrix, &mut along);
            // (-back + ds along, ds) is perpendicular to the tangent
            let across = self.dot(&tangent.0, &along) + unit * unit * tangent.1;
            let ds = self.dot(&tangent.0, &back) / across;
            for entry in back.as_mut_slice() {
                *entry = -*entry;
            }
            back.axpy(S::from_f64(ds), &along);
            let length = f64::max(self.length(&back), unit * ds.abs());
            if length > bound || length.is_nan() {
                return None;
            }
            xi.axpy(S::one(), &back);
            *s += ds;
            bound = 0.25 * length;
            if length <= 1e-6 * unit {
                near = true;
                break;
            }
        }
        let mut next = self.tangent(unit, xi);
        let cosine = self.dot(&next.0, &tangent.0) + unit * unit * next.1 * tangent.1;
        if cosine < 0.0 {
            for entry in next.0.as_mut_slice() {
                *entry = -*entry;
            }
            next.1 = -next.1;
        }
        (near && cosine.abs() > 0.9).then_some(next)
    }
}
