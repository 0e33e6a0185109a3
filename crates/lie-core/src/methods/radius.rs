//! The radius of convergence of a Taylor series, by its last terms.

use super::development::{Pace, Terms};
use super::rough_log::binary_log;
use super::time_unit::{MOST_LANES, each};
use crate::clock::{Clock, holds};
use crate::recurrence::Ends;
use crate::scalar::{Mask, Scalar};
use crate::state::State;

/// The radius of convergence of a series, in its unit of time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Radius {
    /// There are no terms to estimate it by.
    Infinite,
    /// Its [`binary_log`].
    Log(i64),
    /// Not all coefficients are finite: how many orders are, and the logarithm that these give.
    Broken { finite: usize, log: i64 },
}

impl Radius {
    /// The smaller one, and one that is not known before all others.
    #[inline(always)]
    pub(super) fn smaller(self, other: Self) -> Self {
        match (self, other) {
            (Self::Infinite, _) => other,
            (_, Self::Infinite) | (Self::Broken { .. }, _) => self,
            (_, Self::Broken { .. }) => other,
            (Self::Log(one), Self::Log(two)) => Self::Log(one.min(two)),
        }
    }
}

impl Pace {
    /// What the radius follows from in lanes where nothing is special, all lanes at once.
    #[inline(always)]
    pub(super) fn usual<S: Scalar, V: State<S>>(
        &self,
        terms: &Terms<'_, S, V>,
        clock: Option<Clock>,
    ) -> Usual {
        if !self.is_usual() {
            return Usual::default();
        }
        let Ends { sizes, lanes } = terms.ends(self.order, clock);
        Usual {
            sizes: sizes.map(each),
            order: self.order,
            lanes: lanes.bits(),
        }
    }

    /// The radius of convergence in one lane, estimated by `(|mu_0|/|mu_k|)^(1/k)` for the last two orders, in the maximum
    /// norm over the coordinates that still have coefficients there. The step of the grid is the measure where nothing
    /// else is.
    ///
    /// Logarithms are integers, so that another unit of time adds to them and changes nothing else.
    pub(super) fn radius<S: Scalar, V: State<S>>(
        &self,
        terms: &Terms<'_, S, V>,
        lane: usize,
        step: f64,
        clock: Option<Clock>,
    ) -> Radius {
        if self.part.is_none() {
            return Radius::Infinite;
        }
        let sizes = |k: usize| {
            let entries = terms.row(k).iter().enumerate();
            let counted = entries.filter(move |(i, _)| !holds(clock, *i));
            counted.map(move |(_, entry)| entry.lane(lane).to_f64().abs())
        };
        let is_finite = |k: usize| sizes(k).all(f64::is_finite);
        let finite = match is_finite(self.order) && is_finite(self.order - 1) {
            true => self.order + 1,
            false => (0..self.order)
                .find(|k| !is_finite(*k))
                .unwrap_or(self.order),
        };
        // series in powers of a power of t have no coefficients at some orders
        let mut orders = (1..finite).rev();
        let mut found = orders
            .by_ref()
            .map(|order| radius_by(order, &sizes, step))
            .find(|found| *found != Radius::Infinite)
            .unwrap_or(Radius::Infinite);
        if let Some(beside) = self.beside {
            // work begins at 0 and may pass it: it is relative to the state too
            let state = sizes(0).fold(0.0, f64::max);
            let sizes = |k: usize| {
                let entry = terms.row(k)[beside].lane(lane).to_f64().abs();
                core::iter::once(if k == 0 { entry + state } else { entry })
            };
            found = found.smaller(radius_by(self.order.min(finite - 1).max(1), &sizes, step));
        }
        // what does not move now may do so later where H depends on the time
        if let (Radius::Infinite, Some(_), Some(step)) = (found, clock, binary_log(step)) {
            found = Radius::Log(step);
        }
        match found {
            found if finite > self.order => found,
            Radius::Log(log) => Radius::Broken { finite, log },
            _ => Radius::Broken { finite, log: 0 },
        }
    }
}

/// The coefficients of the state and of the last two orders in the maximum norm, in lanes where these are finite and every coordinate
/// that does not carry the time has one of one of both orders.
#[derive(Default)]
pub(super) struct Usual {
    sizes: [[f64; MOST_LANES]; 3],
    order: usize,
    lanes: u64,
}

impl Usual {
    /// The same as [`Pace::radius`] in a lane; none where something is special.
    #[inline(always)]
    pub(super) fn radius(&self, lane: usize) -> Option<Radius> {
        if self.lanes >> lane & 1 == 0 {
            return None;
        }
        let log = |size: usize| binary_log(self.sizes[size][lane]);
        Some(by_logs(log(0)?, [log(1), log(2)], self.order))
    }
}

/// The radius by the logarithms of what begins, and of the terms of an order and of the one before.
#[inline]
fn by_logs(scale: i64, [last, before]: [Option<i64>; 2], order: usize) -> Radius {
    let by = |size: Option<i64>, order: usize| {
        size.map_or(Radius::Infinite, |size| {
            Radius::Log((scale - size).div_euclid(order as i64))
        })
    };
    by(last, order).smaller(by(before, order.max(2) - 1))
}

/// The radius by the coefficients of an order and of the one before, infinite if there are none.
fn radius_by<I: Iterator<Item = f64>>(
    order: usize,
    sizes: &impl Fn(usize) -> I,
    step: f64,
) -> Radius {
    let largest_of = |k: usize| binary_log(sizes(k).fold(0.0, f64::max));
    let (last, before) = (
        largest_of(order),
        largest_of(order - 1).filter(|_| order > 1),
    );
    let moving = sizes(order)
        .zip(sizes(order - 1))
        .map(|(a, b)| a > 0.0 || (b > 0.0 && order > 1));
    let sizes_of_moving = sizes(0)
        .zip(moving)
        .filter_map(|(size, moves)| moves.then_some(size));
    let scale = binary_log(sizes_of_moving.fold(0.0, f64::max)).or_else(|| {
        // what moves begins at 0: the first term that it has, as far as the ratio of terms reaches
        let (begin, first) = (1..=order).find_map(|k| Some((k, largest_of(k)?)))?;
        let (end, size) = match (last, before) {
            (Some(last), _) => (order, last),
            (None, before) => (order - 1, before?),
        };
        let ratio = match (last, before) {
            (Some(last), Some(before)) => before - last,
            _ if end > begin => (first - size).div_euclid((end - begin) as i64),
            _ => binary_log(step)?,
        };
        Some(first + begin as i64 * ratio)
    });
    scale.map_or(Radius::Infinite, |scale| {
        by_logs(scale, [last, before], order)
    })
}

#[cfg(test)]
mod tests {
    use super::super::development::{Rows, sum};
    use super::*;

    fn rows(coefficient: impl Fn(usize) -> [f64; 2], order: usize) -> Rows<[f64; 2]> {
        core::array::from_fn(|k| if k <= order { coefficient(k) } else { [0.0; 2] })
    }

    fn reach(pace: &Pace, rows: &Rows<[f64; 2]>) -> f64 {
        pace.used(pace.radius::<f64, _>(&Terms::Rows(rows), 0, 8.0, None))
    }

    #[test]
    fn the_reach_is_the_part_of_the_radius_that_the_tolerance_allows() {
        let pace = Pace::of_tolerance::<f64>(1e-12, 0.5);
        // 1/(1 - t/3), beside a coordinate that is large and a polynomial
        let geometric = rows(
            |k| [3_f64.powi(-(k as i32)), if k < 2 { 1e9 } else { 0.0 }],
            pace.order,
        );
        let length = reach(&pace, &geometric);
        let last = (length / 3.0).powi(pace.order as i32);
        assert!((0.3e-12..0.5e-12).contains(&last), "{last:e}");
        let mut out = [0.0; 2];
        sum(&geometric, pace.order, length, &mut out);
        assert!((out[0] * (1.0 - length / 3.0) - 1.0).abs() < 1e-12);
        // in powers of t^3 alone
        let lacunary = rows(
            |k| [if k % 3 == 0 { 1.0 } else { 0.0 }, 0.0],
            pace.order + 1,
        );
        assert!((reach(&pace, &lacunary) - length / 3.0).abs() < 1e-2);
        let resting = rows(|k| [if k == 0 { 1.0 } else { 0.0 }; 2], pace.order);
        assert_eq!(reach(&pace, &resting), f64::INFINITY);
        let broken = rows(
            |k| [if k == pace.order { f64::NAN } else { 1.0 }, 0.0],
            pace.order,
        );
        assert!(reach(&pace, &broken).is_nan());
    }

    /// What moves may begin at 0, with any of its terms.
    #[test]
    fn another_unit_of_time_is_a_factor_of_the_reach() {
        let pace = Pace::of_tolerance::<f64>(1e-12, 0.5);
        for (first, last, lacuna) in [
            (0, 40, 1),
            (1, 40, 1),
            (2, 40, 1),
            (1, 7, 1),
            (2, 2, 1),
            (1, 40, 2),
        ] {
            let coefficient = |k: usize, unit: f64| match (first..=last).contains(&k)
                && (k - first).is_multiple_of(lacuna)
            {
                true => 0.3_f64.powi(k as i32) * unit.powi(k as i32),
                false => 0.0,
            };
            let in_unit = |unit: f64| {
                let rows = rows(|k| [coefficient(k, unit), 0.0], pace.order);
                pace.used(pace.radius::<f64, _>(&Terms::Rows(&rows), 0, 8.0 / unit, None)) * unit
            };
            let expected = in_unit(1.0);
            assert!(
                expected > 1e-3 && expected < 10.0,
                "{first} {last}: {expected}"
            );
            for unit in [2.0, 0.125, 1024.0] {
                assert_eq!(
                    in_unit(unit).to_bits(),
                    expected.to_bits(),
                    "{first} {last} {unit}"
                );
            }
        }
    }

    /// How far a series is used, by whole numbers for all lanes and by integers for each: sizes of all normal numbers, most near each other.
    #[test]
    fn the_reach_of_lanes_is_that_of_each() {
        use crate::recurrence::Reach;
        let mut bits = 2018_u64;
        let mut drawn = || {
            bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            bits >> 11
        };
        let [mut known, mut beyond] = [0; 2];
        for draw in 0..300_000 {
            let mut size = || {
                let near = 1023 + drawn() % 60 - 30;
                let exponent = if draw % 3 == 0 {
                    1 + drawn() % 2046
                } else {
                    near
                };
                f64::from_bits(exponent << 52 | drawn() & ((1 << 52) - 1))
            };
            let sizes = [size(), size(), size()];
            let tolerance = 10_f64.powi(-((drawn() % 17) as i32));
            let pace = Pace::of_tolerance::<f64>(tolerance, 0.02 + 0.3 * (draw % 4) as f64);
            let lanes = true;
            let part = pace.part.expect("of a tolerance") as f64;
            let found = Reach::of(&Ends { sizes, lanes }, pace.order, part);
            let usual = Usual {
                sizes: sizes.map(|size| [size; MOST_LANES]),
                order: pace.order,
                lanes: 1,
            };
            let radius = usual.radius(0).expect("usual");
            let Radius::Log(log) = radius else {
                unreachable!("all sizes are above 0");
            };
            let used = pace.used(radius);
            assert_eq!(found.lanes, used.is_normal(), "{sizes:?} {}", pace.order);
            if found.lanes {
                assert_eq!(found.length.to_bits(), used.to_bits(), "{sizes:?}");
                assert_eq!(found.shift, ((log + (1 << 39)) >> 40) as f64, "{sizes:?}");
            }
            *(if found.lanes { &mut known } else { &mut beyond }) += 1;
        }
        assert!(known > 250_000 && beyond > 100, "{known} {beyond}");
        for special in [0.0, f64::MIN_POSITIVE / 2.0, f64::INFINITY, f64::NAN] {
            for place in 0..3 {
                let mut sizes = [1.0; 3];
                sizes[place] = special;
                let lanes = true;
                let found = Reach::of(&Ends { sizes, lanes }, 7, -3e12);
                assert!(!found.lanes, "{sizes:?}");
            }
        }
    }

    /// Where nothing is special, all lanes at once tell what each does by itself; elsewhere they tell nothing.
    #[cfg(feature = "lanes")]
    #[test]
    fn all_lanes_at_once_tell_what_each_does() {
        use crate::scalar::F64x8;
        let pace = Pace::of_tolerance::<f64>(1e-12, 0.5);
        let (p, clock) = (pace.order, None);
        let lanes: [&dyn Fn(usize) -> [f64; 2]; 8] = [
            &|k| [0.3_f64.powi(k as i32), 7.0 * 0.9_f64.powi(k as i32)],
            &|k| [1e200 * 1e-3_f64.powi(k as i32), 1e-200],
            &|k| {
                [
                    if k == p { 0.0 } else { 2.0 },
                    if k == p { -1.0 } else { 0.0 },
                ]
            },
            // a coordinate that is a polynomial, nothing at 0, what is not finite, nothing at all, one term alone
            &|k| [0.3_f64.powi(k as i32), if k < 2 { 1e9 } else { 0.0 }],
            &|k| [if k == 0 { 0.0 } else { 1.0 }; 2],
            &|k| [if k + 1 == p { f64::NAN } else { 1.0 }, 1.0],
            &|k| [if k == 0 { 1.0 } else { 0.0 }; 2],
            &|k| [if k == p { f64::INFINITY } else { 1.0 }, 1.0],
        ];
        let all: Rows<[F64x8; 2]> = core::array::from_fn(|k| {
            let within = |lane: usize| if k <= p { lanes[lane](k) } else { [0.0; 2] };
            core::array::from_fn(|i| F64x8::new(core::array::from_fn(|lane| within(lane)[i])))
        });
        let usual = pace.usual::<F64x8, _>(&Terms::Rows(&all), clock);
        for (lane, coefficient) in lanes.iter().enumerate() {
            let alone = rows(coefficient, p);
            let alone = Terms::Rows(&alone);
            let expected = pace.radius::<f64, _>(&alone, 0, 8.0, clock);
            let found = usual.radius(lane);
            assert_eq!(found.is_some(), lane < 3, "{lane}: {found:?}");
            assert!(
                found.is_none_or(|found| found == expected),
                "{lane}: {found:?}"
            );
            let once = pace.usual::<f64, _>(&alone, clock).radius(0);
            assert_eq!(once, found, "{lane}");
        }
        let fixed = Pace::of_order(p).usual::<F64x8, _>(&Terms::Rows(&all), clock);
        assert_eq!(
            fixed.radius(0),
            None,
            "a series for each step has no radius"
        );
    }
}
