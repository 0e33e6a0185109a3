//! What methods by Taylor series share: their order, how far a series reaches, and its sum.
//!
//! Reference: À. Jorba, M. Zou, "A software package for the numerical integration of ODEs by means of high-order Taylor
//! methods", Experimental Mathematics 14 (2005) 99–117,
//! [doi:10.1080/10586458.2005.10128904](https://doi.org/10.1080/10586458.2005.10128904).

use super::radius::Radius;
use super::rough_log::{ONE, exp2, log2};
use crate::clock::Clock;
use crate::poisson::Poisson;
use crate::recurrence::{Ends, KeptSeries, MOST_ORDERS, Reach, sum_of_series};
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

/// A series: its rows, or what a recurrence keeps of it.
#[derive(Clone, Copy, Debug)]
pub(super) enum Terms<'a, S: Scalar, V> {
    Rows(&'a Rows<V>),
    Kept(KeptSeries<'a, S>),
}

impl<'a, S: Scalar, V: State<S>> Terms<'a, S, V> {
    /// The coefficients of an order.
    #[inline(always)]
    pub(super) fn row(&self, k: usize) -> &'a [S] {
        match self {
            Self::Rows(rows) => rows[k].as_slice(),
            Self::Kept(series) => series.row(k),
        }
    }

    /// How far it is used, where that is known beside it.
    #[inline(always)]
    pub(super) fn reach(&self) -> Option<Reach<S>> {
        match self {
            Self::Rows(_) => None,
            Self::Kept(series) => Some(series.reach),
        }
    }

    /// Its coefficients at both ends.
    #[inline(always)]
    pub(super) fn ends(&self, order: usize, clock: Option<Clock>) -> Ends<S> {
        match self {
            Self::Rows(rows) => {
                let rows = [0, order, order - 1].map(|k| rows[k].as_slice());
                Ends::of(rows, clock)
            }
            Self::Kept(series) => series.ends,
        }
    }
}

/// The order of the series and what decides how far it is used.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pace {
    pub(super) order: usize,
    /// The part of the radius of convergence that is used, as a logarithm; none where a series serves one step of the grid
    /// whole.
    pub(super) part: Option<i64>,
    /// The size of what is left out, relative to the state.
    pub(super) tolerance: f64,
    /// A coordinate that counts by itself, though it carries the time: its momentum, where that is what forces do.
    pub(super) beside: Option<usize>,
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

    /// Whether the radius follows from the coefficients at both ends where nothing is special.
    pub(super) fn is_usual(&self) -> bool {
        self.is_adaptive() && self.beside.is_none() && self.order >= 2
    }

    /// Whether the steps follow from the series.
    pub(super) fn is_adaptive(&self) -> bool {
        self.part.is_some()
    }

    /// How far a series with this radius is used, not a number if a coefficient is not finite.
    #[inline]
    pub(super) fn used(&self, radius: Radius) -> f64 {
        match (self.part, radius) {
            (None, _) | (_, Radius::Infinite) => f64::INFINITY,
            (Some(part), Radius::Log(log)) => exp2(log + part),
            (_, Radius::Broken { .. }) => f64::NAN,
        }
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

/// `out = sum_k rows_k t^k`
#[inline(always)]
pub(super) fn sum<S: Scalar, V: State<S>>(rows: &Rows<V>, order: usize, t: S, out: &mut V) {
    sum_of_series(|k| rows[k].as_slice(), order, t, out.as_mut_slice());
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
