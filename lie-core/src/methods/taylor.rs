//! Taylor series of the solution, with order and step from a tolerance.
//!
//! ```math
//! \mu(t + s) = \sum_{k=0}^p \mu_k s^k, \qquad (k + 1)\, \mu_{k+1} = f_k, \qquad f(\mu(t + s)) = \sum_k f_k s^k
//! ```
//!
//! The coefficients of the field follow from those of the state, order by order, by recurrences that the compiler writes for
//! the declared Hamiltonian ([`Series`]); p orders take of the order of `p^2` operations. With a tolerance per step,
//! relative to the state, the order is `p = 1 - ln(tolerance)/2` and a series is used as far as its last terms
//! stay below the tolerance. Within each step of the driver's grid it makes as many series as that takes; a series
//! that reaches further serves the next steps of the grid too.
//!
//! Explicit. With the default tolerance a step is exact to round-off; nothing is kept but linear invariants, and at a
//! loose tolerance energy and Casimirs drift. Lanes choose their steps independently of each other.
//!
//! Needs: an expression of H.
//!
//! Reference: À. Jorba, M. Zou, "A software package for the numerical integration of ODEs by means of high-order Taylor
//! methods", Experimental Mathematics 14 (2005) 99–117,
//! [doi:10.1080/10586458.2005.10128904](https://doi.org/10.1080/10586458.2005.10128904).
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::development::{Pace, Rows, sum};
use super::explicit::direction;
use super::facts::{Facts, Preserves};
use super::implicit::clear;
use super::stage_parallel::same;
use super::stepper::{FactorSink, Method, RungeKutta, Stage, StepFailure, StepReport, Stepper};
use crate::generic::gauss_tableau;
use crate::newton::{FailureReason, NewtonOptions};
use crate::recurrence::{MOST_ORDERS, Recurrence, Series};
use crate::scalar::{Mask, Scalar};
use crate::state::{State, Unknown};

/// Series within one step of the grid after which it has failed.
const MAX_SERIES: u32 = 1_000_000;
/// Nodes at which velocities are given to whoever follows the group element.
const NODES: usize = 8;

/// Taylor series; see the [module's text](self).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taylor {
    /// The error per step relative to the state, of a step that the method chooses.
    pub tolerance: f64,
    /// An order at which each step of the grid is one series, whatever its error. By default the tolerance decides.
    pub order: Option<u32>,
}

impl Taylor {
    /// With a tolerance, from which order and steps follow; below round-off it means round-off.
    pub fn with_tolerance(tolerance: f64) -> Self {
        Self {
            tolerance,
            order: None,
        }
    }

    /// Of an order up to 40, one series for each step of the grid.
    pub fn of_order(order: u32) -> Self {
        Self {
            order: Some(order),
            ..Self::default()
        }
    }
}

impl Default for Taylor {
    fn default() -> Self {
        Self::with_tolerance(1e-15)
    }
}

impl Facts for Taylor {
    const ID: &'static str = "taylor";
    /// At the default tolerance.
    const ORDER: u32 = 19;
    const SYMMETRIC: bool = false;
    const EXPLICIT: bool = true;
    const PRESERVES: Preserves = Preserves::LINEAR;
}

impl<S: Scalar, P: Series<S>> Method<S, P> for Taylor {
    type Stepper<'a>
        = TaylorStepper<'a, S, P>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, _newton: &NewtonOptions) -> Self::Stepper<'a> {
        let zero = system.zero_state();
        TaylorStepper {
            system,
            pace: match self.order {
                Some(order) => Pace::of_order(order),
                None => Pace::of_tolerance::<S>(self.tolerance),
            },
            length: h.abs(),
            sign: S::select(h.less(S::zero()), -S::one(), S::one()),
            recurrence: system.series(),
            inverses: core::array::from_fn(|k| S::ratio(1.0, k.max(1) as f64)),
            rows: core::array::from_fn(|_| zero.clone()),
            place: S::zero(),
            reach: S::zero(),
            scratch: Some((zero.clone(), zero.clone())),
            current: zero.clone(),
            point: zero,
        }
    }
}

/// `out = factor * state`
#[inline(always)]
fn multiply<S: Scalar, V: State<S>>(state: &V, factor: S, out: &mut V) {
    for (out, &entry) in out.as_mut_slice().iter_mut().zip(state.as_slice()) {
        *out = entry * factor;
    }
}

/// The stepper of [`Taylor`].
pub struct TaylorStepper<'a, S: Scalar, P: Series<S> + 'a> {
    system: &'a P,
    pace: Pace,
    /// Length of a step of the grid, and its direction.
    length: S,
    sign: S,
    recurrence: P::Recurrence<'a>,
    /// `1/k`
    inverses: [S; MOST_ORDERS + 1],
    rows: Rows<P::State>,
    /// Where on its series the current state lies, and how far the series is used.
    place: S,
    reach: S,
    /// A coefficient of the field, and one of the state.
    scratch: Option<(P::State, P::State)>,
    current: P::State,
    point: P::State,
}

impl<'a, S: Scalar, P: Series<S>> TaylorStepper<'a, S, P> {
    /// Computes the coefficients of the series at the current state, and takes them in some lanes.
    #[inline(always)]
    fn expand(&mut self, lanes: S::Mask) {
        let all = lanes.all();
        let take = |row: &mut P::State, from: &P::State| match all {
            true => row.copy_from(from),
            false => row.assign_where(lanes, from),
        };
        // taken out, so that they are in registers
        let Some((mut field, mut coefficient)) = self.scratch.take() else {
            return;
        };
        take(&mut self.rows[0], &self.current);
        let mut carry = self.recurrence.begin(&self.current, &mut field);
        for k in 1..self.pace.order {
            multiply(&field, self.inverses[k], &mut coefficient);
            carry = self.recurrence.advance(k, carry, &coefficient, &mut field);
            take(&mut self.rows[k], &coefficient);
        }
        let last = self.pace.order;
        multiply(&field, self.inverses[last], &mut coefficient);
        take(&mut self.rows[last], &coefficient);
        self.scratch = Some((field, coefficient));
    }

    /// Develops the series at the current state in some lanes. False in those where it is not finite.
    fn develop(&mut self, lanes: S::Mask) -> S::Mask {
        self.expand(lanes);
        let mut reach = S::zero();
        for lane in 0..S::LANES {
            let length = self.pace.reach::<S, _>(&self.rows, lane);
            reach = reach.with_lane(lane, S::Lane::from_f64(length));
        }
        let known = !(lanes & !reach.less_equal(reach));
        self.reach = S::select(lanes & known, reach, self.reach);
        self.place = S::select(lanes & known, S::zero(), self.place);
        known
    }

    /// Gives away `h grad H` at the nodes of the Gauss method between two places on the series.
    fn give_velocities<K: FactorSink<P::State>>(
        &mut self,
        (from, size): (S, S),
        accepted: S::Mask,
        sink: &mut K,
    ) {
        let tableau = gauss_tableau::<S, NODES>();
        let Some((point, xi)) = &mut self.scratch else {
            return;
        };
        let step = self.sign * size;
        for (index, &node) in tableau.c.iter().enumerate() {
            let time = self.sign * from + node * step;
            sum(&self.rows, self.pace.order, time, point);
            direction(self.system, step, point, xi);
            clear(xi, !accepted);
            let count = NODES;
            sink.push_velocity(RungeKutta::Gauss, Stage { index, count }, xi);
        }
    }
}

impl<S: Scalar, P: Series<S>> Stepper<S> for TaylorStepper<'_, S, P> {
    type State = P::State;

    fn step<K: FactorSink<P::State>>(
        &mut self,
        mu: &mut P::State,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        let follows = same(&self.current, mu);
        self.reach = S::select(follows, self.reach, S::zero());
        self.current.copy_from(mu);
        let mut report = StepReport::default();
        let mut failure: Option<StepFailure> = None;
        let mut failed = S::Mask::splat(false);
        let mut fail = |reason, lanes: S::Mask, report| {
            let first = StepFailure {
                reason,
                lanes: 0,
                report,
            };
            failure.get_or_insert(first).lanes |= lanes.bits();
        };
        let mut covered = S::zero();
        let mut active = S::zero().less(self.length);
        while active.any() {
            // the last hundredth of a series is left, rather than walked in a step of its own
            let left = self.reach - self.place;
            let spent = active & left.less_equal(self.reach * S::from_f64(0.01));
            if spent.any() {
                let broken = spent & !self.develop(spent);
                report.evaluations += 1;
                report.substeps += 1;
                if broken.any() {
                    fail(FailureReason::NotFinite, broken, report);
                }
                if report.substeps > MAX_SERIES {
                    fail(FailureReason::TooManySteps, active, report);
                    failed = failed | active;
                    break;
                }
                failed = failed | broken;
                active = active & !broken;
            }
            let (left, remaining) = (self.reach - self.place, self.length - covered);
            let last = remaining.less_equal(left * S::from_f64(1.01));
            let size = S::select(active, S::select(last, remaining, left), S::zero());
            let too_small = active & !last & size.less_equal(S::epsilon() * self.length);
            if too_small.any() {
                fail(FailureReason::StepTooSmall, too_small, report);
            }
            let from = self.place;
            let place = from + size;
            sum(
                &self.rows,
                self.pace.order,
                self.sign * place,
                &mut self.point,
            );
            let infinite = active & !too_small & !self.point.finite();
            if infinite.any() {
                fail(FailureReason::NotFinite, infinite, report);
            }
            failed = failed | too_small | infinite;
            active = active & !(too_small | infinite);
            if K::ACTIVE && active.any() {
                self.give_velocities((from, size), active, sink);
            }
            self.place = S::select(active, place, from);
            self.current.assign_where(active, &self.point);
            covered = S::select(active, covered + size, covered);
            active = active & !last;
        }
        self.reach = S::select(failed, S::zero(), self.reach);
        mu.assign_where(!failed, &self.current);
        match failure {
            None => Ok(report),
            Some(failure) => Err(StepFailure { report, ..failure }),
        }
    }
}
