//! What methods by Taylor series share: their order, how far a series reaches, and its sum.
//!
//! Reference: À. Jorba, M. Zou, "A software package for the numerical integration of ODEs by means of high-order Taylor
//! methods", Experimental Mathematics 14 (2005) 99–117,
//! [doi:10.1080/10586458.2005.10128904](https://doi.org/10.1080/10586458.2005.10128904).

use crate::clock::{Clock, holds};
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
    /// The part of the radius of convergence that is used; none where a series serves one step of the grid whole.
    part: Option<f64>,
}

impl Pace {
    /// By a tolerance per step relative to the state, at least round-off: the order p is `1 - ratio ln(tolerance)`, and a
    /// series is used as far as its term of order p stays below the tolerance.
    pub(super) fn of_tolerance<S: Scalar>(tolerance: f64, ratio: f64) -> Self {
        let tolerance = tolerance.clamp(largest(S::epsilon()), 0.1);
        let order = 1.0 - ratio * core::f64::consts::LN_2 * log2(tolerance);
        let order = (order as usize + 1).clamp(2, MOST_ORDERS);
        let part = exp2((log2(tolerance) - 1.0 / core::f64::consts::LN_2) / order as f64);
        Self {
            order,
            part: Some(part),
        }
    }

    /// Of an order, one series for each step of the grid.
    pub(super) fn of_order(order: usize) -> Self {
        let order = order.clamp(1, MOST_ORDERS);
        Self { order, part: None }
    }

    /// [`Pace::reach`] in every lane.
    #[inline(always)]
    pub(super) fn reach_of_lanes<S: Scalar, V: State<S>>(
        &self,
        rows: &Rows<V>,
        clock: Option<Clock>,
    ) -> S {
        let mut reach = S::zero();
        for lane in 0..S::LANES {
            let length = self.reach(rows, lane, clock);
            reach = reach.with_lane(lane, S::Lane::from_f64(length));
        }
        reach
    }

    /// How far the series is used in one lane; not a number where a coefficient is not finite.
    ///
    /// The radius of convergence is estimated by `(|mu_0|/|mu_k|)^(1/k)` for the last two orders, in the maximum norm
    /// over the coordinates that still have coefficients there.
    pub(super) fn reach<S: Scalar, V: State<S>>(
        &self,
        rows: &Rows<V>,
        lane: usize,
        clock: Option<Clock>,
    ) -> f64 {
        let Some(part) = self.part else {
            return f64::INFINITY;
        };
        let entry = |k: usize, i: usize| rows[k].as_slice()[i].lane(lane).to_f64().abs();
        let count = rows[0].as_slice().len();
        let mut order = self.order;
        // series in powers of a power of t have no coefficients at some orders
        while order >= 1 {
            let (mut last, mut before, mut scale) = (0.0, 0.0, 0.0);
            for i in (0..count).filter(|i| !holds(clock, *i)) {
                let (a, b) = (entry(order, i), entry(order - 1, i));
                if !(a + b).is_finite() {
                    return f64::NAN;
                }
                if a > 0.0 || (b > 0.0 && order > 1) {
                    scale = f64::max(scale, entry(0, i));
                }
                (last, before) = (f64::max(last, a), f64::max(before, b));
            }
            if scale <= 0.0 {
                let counted = (0..count).filter(|i| !holds(clock, *i));
                let first = counted.fold(0.0, |first: f64, i| first.max(entry(1, i)));
                let ratio = if last > 0.0 && order > 1 {
                    match before > 0.0 {
                        true => before / last,
                        // the last one alone is not zero where all of them are round-off
                        false => exp2(log2(first / last) / (order - 1) as f64),
                    }
                } else {
                    1.0
                };
                scale = first * ratio;
            }
            let radius = |size: f64, order: usize| match size > 0.0 {
                true => exp2(log2(scale / size) / order as f64),
                false => f64::INFINITY,
            };
            let mut reach = radius(last, order);
            if order > 1 {
                reach = f64::min(reach, radius(before, order - 1));
            }
            if reach < f64::INFINITY {
                return part * reach;
            }
            order -= 1;
        }
        f64::INFINITY
    }
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

/// The logarithm to base 2 of a positive number to about three digits, the same on every machine.
fn log2(x: f64) -> f64 {
    let bits = x.to_bits();
    let exponent = (bits >> 52) as f64 - 1023.0;
    let mantissa = f64::from_bits((bits & ((1 << 52) - 1)) | (1023 << 52));
    // through 1, sqrt(2) and 2, and a symmetric correction
    let m = mantissa - 1.0;
    exponent + m * (1.418_15 + m * (-0.578_51 + m * 0.160_36))
}

/// The power of 2 to about four digits, the same on every machine; 0 or infinite beyond the range of normal numbers.
fn exp2(x: f64) -> f64 {
    if x.is_nan() {
        return x;
    }
    if x >= 1023.0 {
        return f64::INFINITY;
    }
    if x <= -1022.0 {
        return 0.0;
    }
    let below = x as i64 - i64::from(x < 0.0);
    let f = x - below as f64;
    let mantissa = 1.0 + f * (0.695_56 + f * (0.226_17 + f * 0.078_27));
    mantissa * f64::from_bits(((below + 1023) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rough_logarithms_and_powers() {
        for k in -2000..2000 {
            let x = f64::from(k) * 0.37;
            let y = libm::exp2(x);
            if y.is_normal() {
                assert!((exp2(x) / y - 1.0).abs() < 1e-3, "{x}");
                assert!((log2(y) - x).abs() < 5e-3, "{x}: {}", log2(y) - x);
            }
        }
        assert_eq!(exp2(2000.0), f64::INFINITY);
        assert_eq!(exp2(-2000.0), 0.0);
        assert!(exp2(f64::NAN).is_nan());
    }

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

    #[test]
    fn the_reach_is_the_part_of_the_radius_that_the_tolerance_allows() {
        let pace = Pace::of_tolerance::<f64>(1e-12, 0.5);
        // 1/(1 - t/3), beside a coordinate that is large and a polynomial
        let geometric = rows(
            |k| [3_f64.powi(-(k as i32)), if k < 2 { 1e9 } else { 0.0 }],
            pace.order,
        );
        let reach = pace.reach::<f64, _>(&geometric, 0, None);
        let last = (reach / 3.0).powi(pace.order as i32);
        assert!((0.3e-12..0.5e-12).contains(&last), "{last:e}");
        let mut out = [0.0; 2];
        sum(&geometric, pace.order, reach, &mut out);
        assert!((out[0] * (1.0 - reach / 3.0) - 1.0).abs() < 1e-12);
        // in powers of t^3 alone
        let lacunary = rows(
            |k| [if k % 3 == 0 { 1.0 } else { 0.0 }, 0.0],
            pace.order + 1,
        );
        assert!((pace.reach::<f64, _>(&lacunary, 0, None) - reach / 3.0).abs() < 1e-2);
        let resting = rows(|k| [if k == 0 { 1.0 } else { 0.0 }; 2], pace.order);
        assert_eq!(pace.reach::<f64, _>(&resting, 0, None), f64::INFINITY);
        let broken = rows(
            |k| [if k == pace.order { f64::NAN } else { 1.0 }, 0.0],
            pace.order,
        );
        assert!(pace.reach::<f64, _>(&broken, 0, None).is_nan());
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
