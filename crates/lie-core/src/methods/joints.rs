//! Where the motion changes the branch of a Hamiltonian: the first root of a condition along its Taylor polynomial.
//!
//! A series holds on the branch on which it begins. It is used as far as no condition changes its sign, the step ends a
//! little behind the first joint, by round-off, and the next series begins on the other side.

use super::development::Pace;
use super::rough_log::{binary_log, exp2};
use super::series_stepper::Developed;
use super::time_unit::{MOST_LANES, TimeUnit};
use crate::recurrence::{MOST_ORDERS, Recurrence};
use crate::scalar::{Mask, Scalar, largest};

/// Steps towards a root.
const STEPS: u32 = 64;
/// Intervals that are tried for one step, each a quarter of the one before.
const NARROWER: u32 = 8;
/// A joint that is nearer than this part of the reach is the one at which the series begins, if its sign is still that.
const SAME: f64 = 1e-3;
/// Joints that are nearer than this follow one another at once.
const AT_ONCE: f64 = 1e-6;
/// Lengths beyond a joint that are tried, each twice the one before, until the sign of the condition is the new one.
const HOPS: u32 = 40;
/// Joints that may follow one another at once.
const TURNS: u32 = 16;
/// What is no progress of a series, in units of round-off of the reach.
const NEAR: f64 = 256.0;

/// The coefficients of a condition, each divided by that power of the reach.
type Terms = [f64; MOST_ORDERS];

/// The joint at which a lane stands.
#[derive(Clone, Copy, Debug, Default)]
struct Standing {
    condition: usize,
    negative: bool,
    /// None where no step has ended there.
    hops: Option<u32>,
    turns: u32,
}

/// A change of sign.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Change {
    None,
    At(f64),
    /// None up to here, which is as far as it was followed.
    NoneUpTo(f64),
}

/// The joints of the branches of a system.
#[derive(Clone, Debug)]
pub(super) struct Joints {
    standing: [Standing; MOST_LANES],
}

impl Joints {
    pub(super) fn new() -> Self {
        Self {
            standing: [Standing::default(); MOST_LANES],
        }
    }

    /// How far a series is used that has just been found in some lanes, for a step of the grid. In those where it begins at
    /// the joint at which the one before has ended, the sign of the condition may still be the old one.
    pub(super) fn end<S: Scalar, R: Recurrence<S>>(
        &mut self,
        recurrence: &R,
        pace: &Pace,
        unit: &TimeUnit<S>,
        step: S,
        [lanes, landed]: [S::Mask; 2],
    ) -> Developed<S> {
        let (mut reach, mut joint, mut stuck) = (unit.reach, 0, 0);
        if !recurrence.conditions(0).is_empty() {
            for lane in lanes.lanes() {
                let step = (step * unit.inverse).lane(lane).to_f64();
                let limit = (unit.reach * unit.inverse).lane(lane).to_f64();
                if limit.is_nan() {
                    continue;
                }
                let ahead = Ahead {
                    recurrence,
                    pace,
                    lane,
                    backwards: step < 0.0,
                    scalar: core::marker::PhantomData,
                };
                let limit = match limit.is_finite() {
                    true => limit,
                    false => step.abs(),
                };
                let (limit, first) = ahead.first(limit);
                let place = match first {
                    Some((condition, place)) => {
                        joint |= 1 << lane;
                        let standing = &mut self.standing[lane];
                        if !landed.lane(lane) {
                            *standing = Standing::default();
                        }
                        let known = standing.pass::<S>(ahead.negative(condition), condition, place);
                        let Some(beyond) = known else {
                            stuck |= 1 << lane;
                            continue;
                        };
                        ahead.moved(condition, place * limit) + S::Lane::from_f64(beyond * limit)
                    }
                    None => {
                        self.standing[lane] = Standing::default();
                        S::Lane::from_f64(limit)
                    }
                };
                reach = reach.with_lane(lane, place * unit.length.lane(lane));
            }
        }
        Developed {
            reach,
            joint: S::Mask::from_bits(joint),
            stuck: S::Mask::from_bits(stuck),
        }
    }
}

impl Standing {
    /// How far beyond a joint a step ends, both as parts of the reach; `None` where the motion does not leave it.
    fn pass<S: Scalar>(&mut self, negative: bool, condition: usize, place: f64) -> Option<f64> {
        let same = (self.condition, self.negative) == (condition, negative);
        let (hops, turns) = match (self.hops, same, place < AT_ONCE) {
            (Some(hops), true, _) if place < SAME => (hops + 1, self.turns),
            (Some(_), false, true) => (0, self.turns + 1),
            _ => (0, 0),
        };
        (self.hops, self.turns) = (Some(hops), turns);
        (self.condition, self.negative) = (condition, negative);
        let leaves = hops <= HOPS && turns <= TURNS;
        leaves.then(|| largest(S::epsilon()) * (1_u64 << hops.min(HOPS)) as f64)
    }
}

/// The conditions along a series in one lane, in the direction of the step.
struct Ahead<'a, S: Scalar, R: Recurrence<S>> {
    recurrence: &'a R,
    pace: &'a Pace,
    lane: usize,
    backwards: bool,
    scalar: core::marker::PhantomData<S>,
}

impl<S: Scalar, R: Recurrence<S>> Ahead<'_, S, R> {
    fn coefficient(&self, condition: usize, k: usize) -> S::Lane {
        self.recurrence.conditions(k)[condition].lane(self.lane)
    }

    /// Whether a condition is negative where the series begins.
    fn negative(&self, condition: usize) -> bool {
        self.coefficient(condition, 0).to_f64() < 0.0
    }

    fn terms(&self, condition: usize, limit: f64) -> Terms {
        let step = if self.backwards { -limit } else { limit };
        let mut power = if self.negative(condition) { -1.0 } else { 1.0 };
        let mut terms = [0.0; MOST_ORDERS];
        for (k, term) in terms.iter_mut().enumerate().take(self.pace.order) {
            *term = self.coefficient(condition, k).to_f64() * power;
            power *= step;
        }
        terms
    }

    /// How far the conditions are known and followed, and the first joint up to there: the condition, and the place as a part.
    fn first(&self, mut limit: f64) -> (f64, Option<(usize, f64)>) {
        let near = NEAR * largest(S::epsilon());
        let mut first: Option<(usize, f64)> = None;
        let shorten = |factor: f64, limit: &mut f64, first: &mut Option<(usize, f64)>| {
            *limit *= factor;
            *first = first
                .map(|(condition, place)| (condition, place / factor))
                .filter(|(_, place)| *place <= 1.0);
        };
        for condition in 0..self.recurrence.conditions(0).len() {
            let mut terms = self.terms(condition, limit);
            let known = resolved(&terms, self.pace);
            if known < 1.0 {
                shorten(known, &mut limit, &mut first);
                terms = self.terms(condition, limit);
            }
            let place = match change(&terms) {
                Change::NoneUpTo(place) if place > near => {
                    shorten(place, &mut limit, &mut first);
                    continue;
                }
                Change::At(place) | Change::NoneUpTo(place) => place,
                Change::None => continue,
            };
            if first.is_none_or(|(_, known)| place < known) {
                first = Some((condition, place));
            }
        }
        (limit, first)
    }

    /// A place in the unit of the series, with its derivatives: the joint moves with the state.
    fn moved(&self, condition: usize, place: f64) -> S::Lane {
        let mut place = S::Lane::from_f64(place);
        for _ in 0..S::DERIVATIVES {
            let time = if self.backwards { -place } else { place };
            let (mut value, mut slope) = (S::Lane::zero(), S::Lane::zero());
            for k in (0..self.pace.order).rev() {
                slope = slope * time + value;
                value = value * time + self.coefficient(condition, k);
            }
            let change = value / slope;
            // where the motion touches the joint, the place has no derivative
            if change.finite() && change.to_f64().abs() < 1e-6 {
                place -= if self.backwards { -change } else { change };
            }
        }
        place
    }
}

/// The part of the reach on which a condition is known to the tolerance.
fn resolved(terms: &Terms, pace: &Pace) -> f64 {
    let size = |term: f64| binary_log(term.abs());
    let largest = terms.iter().filter_map(|term| size(*term)).max();
    let (Some(largest), Some(tolerance)) = (largest, binary_log(pace.tolerance)) else {
        return 1.0;
    };
    let of_order = |k: usize| {
        let allowed = largest + tolerance;
        let term = size(terms[k]).filter(|term| k > 1 && *term > allowed);
        term.map_or(1.0, |term| exp2((allowed - term).div_euclid(k as i64)))
    };
    let last = pace.order - 1;
    of_order(last).min(of_order(last.saturating_sub(1)))
}

/// A bound of the second derivative of a polynomial from 0 to a place.
fn bend(terms: &[f64], place: f64) -> f64 {
    let terms = terms.iter().enumerate().skip(2).rev();
    terms.fold(0.0, |sum, (k, term)| {
        sum * place + (k * (k - 1)) as f64 * term.abs()
    })
}

/// How far a function with this value, this slope and at most this second derivative is positive at least.
fn safe_step(value: f64, slope: f64, bend: f64) -> f64 {
    let root = (slope * slope + 2.0 * bend * value).sqrt();
    match slope > 0.0 {
        true => (slope + root) / bend,
        false => 2.0 * value / (root - slope),
    }
}

/// The first place up to 1 at which a polynomial that begins at 0 or above becomes negative.
fn change(terms: &Terms) -> Change {
    // what begins on the joint leaves it by its first term
    let Some(from) = terms.iter().position(|term| *term != 0.0) else {
        return Change::None;
    };
    let terms = &terms[from..];
    if terms[0] < 0.0 {
        return Change::At(0.0);
    }
    let rest: f64 = terms[1..].iter().map(|term| term.abs()).sum();
    if rest < terms[0] {
        return Change::None;
    }
    let (mut place, mut width) = (0.0, 1.0);
    for _ in 0..STEPS {
        let (mut value, mut slope, mut size) = (0.0, 0.0, 0.0);
        for term in terms.iter().rev() {
            slope = slope * place + value;
            value = value * place + term;
            size = size * place + term.abs();
        }
        if value <= f64::EPSILON * size && (slope <= 0.0 || value < 0.0) {
            return Change::At(place);
        }
        // with a bound of the second derivative as far as the step goes it is no longer than to the first root
        width = f64::min(4.0 * width, 1.0 - place);
        let mut step = 0.0;
        for _ in 0..NARROWER {
            step = safe_step(f64::max(value, 0.0), slope, bend(terms, place + width));
            if step >= width / 4.0 {
                break;
            }
            width /= 4.0;
        }
        // not a number where the value does not change
        place += if step < width { step } else { width };
        if place >= 1.0 {
            return Change::None;
        }
    }
    Change::NoneUpTo(place)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn terms(of: &[f64]) -> Terms {
        core::array::from_fn(|k| of.get(k).copied().unwrap_or(0.0))
    }

    #[test]
    fn the_first_root_is_found() {
        let at = |of: &[f64], expected: f64| match change(&terms(of)) {
            Change::At(place) => assert!((place - expected).abs() < 1e-14, "{of:?}: {place}"),
            other => panic!("{of:?}: {other:?}"),
        };
        at(&[1.0, -2.0], 0.5);
        at(&[0.0, -1.0], 0.0);
        // (1 - 4 x) (1 - 2 x), and with a root at the beginning
        at(&[1.0, -6.0, 8.0], 0.25);
        at(&[0.0, 1.0, -6.0, 8.0], 0.25);
        // cos(10 x)
        let cosine = |k: usize| match k % 4 {
            0 => 1.0,
            2 => -1.0,
            _ => 0.0,
        };
        let mut factor = 1.0;
        let series: Terms = core::array::from_fn(|k| {
            factor *= if k > 0 { 10.0 / k as f64 } else { 1.0 };
            factor * cosine(k)
        });
        at(&series, core::f64::consts::PI / 20.0);
    }

    #[test]
    fn what_does_not_change_its_sign_has_no_root() {
        for of in [
            &[1.0][..],
            &[0.0],
            &[1.0, -0.9],
            &[0.0, 1.0],
            &[1.0, -1.0, 1.0],
            &[0.0, 0.0, 1.0],
        ] {
            assert_eq!(change(&terms(of)), Change::None, "{of:?}");
        }
        // (x - 1/2)^2 + 1e-4: near
        assert_eq!(change(&terms(&[0.2501, -1.0, 1.0])), Change::None);
        // and a little below 0: two roots close by
        let place = 0.5 - 1e-4_f64.sqrt();
        match change(&terms(&[0.2499, -1.0, 1.0])) {
            Change::At(found) => assert!((found - place).abs() < 1e-12, "{found}"),
            other => panic!("{other:?}"),
        }
    }
}
