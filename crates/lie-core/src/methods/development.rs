//! What methods by Taylor series share: their order, how far a series reaches, and its sum.
//!
//! Reference: À. Jorba, M. Zou, "A software package for the numerical integration of ODEs by means of high-order Taylor
//! methods", Experimental Mathematics 14 (2005) 99–117,
//! [doi:10.1080/10586458.2005.10128904](https://doi.org/10.1080/10586458.2005.10128904).

use super::rough_log::{ONE, binary_log, exp2, log2};
use crate::clock::{Clock, holds};
use crate::poisson::Poisson;
use crate::recurrence::MOST_ORDERS;
use crate::scalar::{Scalar, largest};
use crate::state::State;

/// A method by series: of a tolerance, or of an order.
macro_rules! by_series {
    ($(#[$doc:meta])* $method:ident, $orders:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $method {
            /// The error per step relative to the state, of a step that the method chooses.
            pub tolerance: f64,
            /// An order at which each step of the grid is one series, whatever its error. By default the tolerance decides.
            pub order: Option<u32>,
        }

        impl $method {
            /// With a tolerance, from which order and steps follow; below round-off it means round-off.
            pub fn with_tolerance(tolerance: f64) -> Self {
                Self {
                    tolerance,
                    order: None,
                }
            }

            #[doc = $orders]
            pub fn of_order(order: u32) -> Self {
                Self {
                    order: Some(order),
                    ..Self::default()
                }
            }
        }

        impl Default for $method {
            fn default() -> Self {
                Self::with_tolerance(1e-15)
            }
        }
    };
}
pub(super) use by_series;

/// The coefficients of a series: rows beyond the order are 0, four of them at least.
pub(super) type Rows<V> = [V; MOST_ORDERS + 5];

/// The order of the series and what decides how far it is used.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pace {
    pub(super) order: usize,
    /// The part of the radius of convergence that is used, as a logarithm; none where a series serves one step of the grid
    /// whole.
    part: Option<i64>,
    /// The size of what is left out, relative to the state.
    pub(super) tolerance: f64,
    /// A coordinate that counts by itself, though it carries the time: its momentum, where that is what forces do.
    beside: Option<usize>,
}

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
    /// By a tolerance per step relative to the state, at least round-off: the order p is `1 - ratio ln(tolerance)`, and a
    /// series is used as far as its term of order p stays below the tolerance.
    pub(super) fn of_tolerance<S: Scalar>(tolerance: f64, ratio: f64) -> Self {
        let tolerance = tolerance.clamp(largest(S::epsilon()), 0.1);
        let log = log2(tolerance);
        let order = 1.0 - ratio * core::f64::consts::LN_2 * log;
        let order = (order as usize + 1).clamp(2, MOST_ORDERS);
        let part = (log - 1.0 / core::f64::consts::LN_2) / order as f64;
        Self {
            order,
            part: Some((part * ONE) as i64),
            tolerance,
            beside: None,
        }
    }

    /// Of an order, one series for each step of the grid.
    pub(super) fn of_order(order: usize) -> Self {
        let order = order.clamp(1, MOST_ORDERS);
        Self {
            order,
            part: None,
            tolerance: 0.0,
            beside: None,
        }
    }

    /// The same for a system, whose forces do work where there are some.
    pub(super) fn of<S: Scalar, P: Poisson<S>>(self, system: &P) -> Self {
        let works = system.is_forced() || system.is_damped();
        let beside = system.clock().filter(|_| works).map(|clock| clock.momentum);
        Self { beside, ..self }
    }

    /// Whether the steps follow from the series.
    pub(super) fn is_adaptive(&self) -> bool {
        self.part.is_some()
    }

    /// How far a series with this radius is used, not a number if a coefficient is not finite.
    pub(super) fn used(&self, radius: Radius) -> f64 {
        match (self.part, radius) {
            (None, _) | (_, Radius::Infinite) => f64::INFINITY,
            (Some(part), Radius::Log(log)) => exp2(log + part),
            (_, Radius::Broken { .. }) => f64::NAN,
        }
    }

    /// The radius of convergence in one lane, estimated by `(|mu_0|/|mu_k|)^(1/k)` for the last two orders, in the maximum
    /// norm over the coordinates that still have coefficients there. The step of the grid is the measure where nothing
    /// else is.
    ///
    /// Logarithms are integers, so that another unit of time adds to them and changes nothing else.
    pub(super) fn radius<S: Scalar, V: State<S>>(
        &self,
        rows: &Rows<V>,
        lane: usize,
        step: f64,
        clock: Option<Clock>,
    ) -> Radius {
        if self.part.is_none() {
            return Radius::Infinite;
        }
        let sizes = |k: usize| {
            let entries = rows[k].as_slice().iter().enumerate();
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
                let entry = rows[k].as_slice()[beside].lane(lane).to_f64().abs();
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
    let Some(scale) = scale else {
        return Radius::Infinite;
    };
    let by = |size: Option<i64>, order: usize| {
        size.map_or(Radius::Infinite, |size| {
            Radius::Log((scale - size).div_euclid(order as i64))
        })
    };
    by(last, order).smaller(by(before, order.max(2) - 1))
}

/// `out = factor * state`
#[inline(always)]
pub(super) fn multiply<S: Scalar, V: State<S>>(state: &V, factor: S, out: &mut V) {
    for (out, &entry) in out.as_mut_slice().iter_mut().zip(state.as_slice()) {
        *out = entry * factor;
    }
}

/// Takes a row over in some lanes; `all` says that these are all lanes.
#[inline(always)]
pub(super) fn copy_lanes<S: Scalar, V: State<S>>(row: &mut V, from: &V, lanes: S::Mask, all: bool) {
    if all {
        row.copy_from(from);
    } else {
        row.assign_where(lanes, from);
    }
}

/// `out = sum_k rows_k t^k`, the terms of every fourth order in a chain of their own.
#[inline(always)]
pub(super) fn sum<S: Scalar, V: State<S>>(rows: &Rows<V>, order: usize, t: S, out: &mut V) {
    let square = t * t;
    let fourth = square * square;
    let last = (order.max(1) - 1) / 4;
    for (i, out) in out.as_mut_slice().iter_mut().enumerate() {
        let mut sums = [S::zero(); 4];
        for block in (0..=last).rev() {
            for (r, sum) in sums.iter_mut().enumerate() {
                *sum = *sum * fourth + rows[4 * block + 1 + r].as_slice()[i];
            }
        }
        let [a, b, c, d] = sums;
        let terms = (a + t * b) + square * (c + t * d);
        *out = rows[0].as_slice()[i] + t * terms;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_follow_tolerances() {
        let order = |tolerance| Pace::of_tolerance::<f64>(tolerance, 0.5).order;
        assert_eq!([1e-3, 1e-6, 1e-9, 1e-12].map(order), [5, 8, 12, 15]);
        // below round-off there is nothing to gain
        assert_eq!(order(1e-300), order(f64::EPSILON));
        assert_eq!(Pace::of_tolerance::<f32>(1e-15, 0.5).order, 9);
        assert_eq!(Pace::of_order(7).order, 7);
    }

    fn rows(coefficient: impl Fn(usize) -> [f64; 2], order: usize) -> Rows<[f64; 2]> {
        core::array::from_fn(|k| if k <= order { coefficient(k) } else { [0.0; 2] })
    }

    fn reach(pace: &Pace, rows: &Rows<[f64; 2]>) -> f64 {
        pace.used(pace.radius::<f64, _>(rows, 0, 8.0, None))
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
                pace.used(pace.radius::<f64, _>(&rows, 0, 8.0 / unit, None)) * unit
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

    #[test]
    fn sums_are_those_of_all_orders() {
        for order in 1..=MOST_ORDERS {
            let rows = rows(|k| [1.0 + k as f64, -2.0], order);
            let mut out = [0.0; 2];
            sum(&rows, order, 0.5, &mut out);
            let exact = |entry: usize| {
                (0..=order)
                    .rev()
                    .fold(0.0, |sum: f64, k| sum * 0.5 + rows[k][entry])
            };
            for (i, out) in out.into_iter().enumerate() {
                assert!((out - exact(i)).abs() < 1e-14 * exact(i).abs(), "{order}");
            }
        }
    }
}
