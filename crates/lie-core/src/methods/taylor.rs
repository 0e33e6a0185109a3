//! Taylor series of the solution, with order and step from a tolerance.
//!
//! ```math
//! \mu(t + s) = \sum_{k=0}^p \mu_k s^k, \qquad (k + 1)\, \mu_{k+1} = f_k, \qquad f(\mu(t + s)) = \sum_k f_k s^k
//! ```
//!
//! The coefficients of the field follow from those of the state, order by order, by recurrences that the compiler writes for
//! the declared Hamiltonian ([`Series`]); p orders take of the order of `p^2` operations. With a tolerance per step,
//! relative to the state, the order is `p = 1 - 0.9 ln(tolerance)` and a series is used as far as its last terms
//! stay below the tolerance. (Jorba and Zou's 1/2 in the place of 0.9 is best where the work of an order grows with the
//! order; here its sums are side by side in registers, and much of the work is the same for every order.) Within each step of the driver's grid it makes as many series as that takes; a series
//! that reaches further serves the next steps of the grid too.
//!
//! A series holds on one branch of `abs`, `min`, `max`, `piecewise` and tables: where the motion comes to another one, the
//! step ends, and the next begins there.
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

use super::development::{Pace, Rows, Terms, by_series, copy_lanes, multiply, sum};
use super::explicit::direction;
use super::facts::{Facts, Preserves};
use super::implicit::clear;
use super::joints::Joints;
use super::projection::Projection;
use super::series_stepper::{Developed, Development, SeriesStepper};
use super::stepper::{FactorSink, Method, RungeKutta, Stage};
use super::time_unit::TimeUnit;
use crate::clock::{Clock, norm};
use crate::generic::gauss_tableau;
use crate::newton::NewtonOptions;
use crate::recurrence::{MOST_ORDERS, Recurrence, Series};
use crate::scalar::{Mask, Scalar};
use crate::state::copies;

/// Nodes at which velocities are given to whoever follows the group element.
const NODES: usize = 8;

by_series!(
    /// Taylor series; see the [module's text](self).
    Taylor,
    "Of an order up to 40, one series for each step of the grid."
);

impl Facts for Taylor {
    const ID: &'static str = "taylor";
    /// At the default tolerance.
    const ORDER: u32 = 33;
    const SYMMETRIC: bool = false;
    const EXPLICIT: bool = true;
    const OWN_STEPS: bool = true;
    const PRESERVES: Preserves = Preserves::LINEAR;
    const FORCES: bool = true;
    const DAMPING: bool = true;
}

impl<S: Scalar, P: Series<S>> Method<S, P> for Taylor {
    type Stepper<'a>
        = SeriesStepper<S, TaylorDevelopment<'a, S, P>>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, _newton: &NewtonOptions) -> Self::Stepper<'a> {
        let zero = system.zero_state();
        let development = TaylorDevelopment {
            system,
            pace: match self.order {
                Some(order) => Pace::of_order(order as usize),
                None => Pace::of_tolerance::<S>(self.tolerance, ORDER),
            }
            .of(system),
            recurrence: system.series(),
            inverses: core::array::from_fn(|k| S::ratio(1.0, k.max(1) as f64)),
            rows: copies(&zero),
            scratch: Some((zero.clone(), zero.clone())),
            unit: TimeUnit::new(),
            joints: Joints::new(),
        };
        SeriesStepper::new(development, h, zero)
    }
}

/// The order over `-ln(tolerance)`.
const ORDER: f64 = 0.9;

/// The Taylor series of a solution.
pub struct TaylorDevelopment<'a, S: Scalar, P: Series<S> + 'a> {
    system: &'a P,
    pace: Pace,
    recurrence: P::Recurrence<'a>,
    /// `1/k`
    inverses: [S; MOST_ORDERS + 1],
    rows: Rows<P::State>,
    /// A coefficient of the field, and one of the state.
    scratch: Option<(P::State, P::State)>,
    unit: TimeUnit<S>,
    joints: Joints,
}

impl<S: Scalar, P: Series<S>> Development<S> for TaylorDevelopment<'_, S, P> {
    type State = P::State;

    #[inline(always)]
    fn clock(&self) -> Option<Clock> {
        self.system.clock()
    }

    fn forget(&mut self, lanes: S::Mask) {
        self.unit.forget(lanes);
    }

    #[inline(always)]
    fn develop(&mut self, mu: &P::State, step: S, [lanes, landed]: [S::Mask; 2]) -> Developed<S> {
        // taken out, so that they are in registers
        let Some((mut field, mut coefficient)) = self.scratch.take() else {
            return Developed::broken();
        };
        let (last, clock) = (self.pace.order, self.clock());
        let slope = || {
            self.recurrence.begin(mu, &mut field);
            norm(clock, &field)
        };
        self.unit.begin(&self.pace, clock, (mu, slope), step, lanes);
        let mut open = lanes;
        loop {
            let (unit, all) = (self.unit.length, open.all());
            let recurrence = &mut self.recurrence;
            let part = S::from_f64(self.pace.part.unwrap_or(0) as f64);
            if !recurrence.develop(mu, unit, part, last, &self.rows, open) {
                copy_lanes(&mut self.rows[0], mu, open, all);
                let mut carry = recurrence.begin(mu, &mut field);
                for k in 1..last {
                    multiply(&field, self.inverses[k] * unit, &mut coefficient);
                    carry = recurrence.advance(k, carry, &coefficient, &mut field);
                    copy_lanes(&mut self.rows[k], &coefficient, open, all);
                }
                multiply(&field, self.inverses[last] * unit, &mut coefficient);
                copy_lanes(&mut self.rows[last], &coefficient, open, all);
            }
            let kept = self.recurrence.kept();
            let terms = kept.map_or(Terms::Rows(&self.rows), Terms::Kept);
            open = self.unit.settle(&self.pace, &[terms], clock, step, open);
            if !open.any() {
                break;
            }
        }
        self.scratch = Some((field, coefficient));
        self.joints.end(
            &self.recurrence,
            &self.pace,
            &self.unit,
            step,
            [lanes, landed],
        )
    }

    #[inline(always)]
    fn state(&mut self, time: S, out: &mut P::State) {
        let time = time * self.unit.inverse;
        if !self.recurrence.sum(time, out) {
            sum(&self.rows, self.pace.order, time, out);
        }
    }

    fn bring_back(
        &self,
        projection: &mut Projection<S, P::State>,
        lanes: S::Mask,
        mu: &mut P::State,
    ) -> S::Mask {
        projection.bring_back(self.system, lanes, mu)
    }

    /// By `h grad H` at the nodes of the Gauss method between the two times.
    fn push_factors<K: FactorSink<P::State>>(
        &mut self,
        from: S,
        to: S,
        lanes: S::Mask,
        sink: &mut K,
    ) {
        let tableau = gauss_tableau::<S, NODES>();
        let Some((mut point, mut xi)) = self.scratch.take() else {
            return;
        };
        let step = to - from;
        for (index, &node) in tableau.c.iter().enumerate() {
            self.state(from + node * step, &mut point);
            direction(self.system, step, &point, &mut xi);
            clear(&mut xi, !lanes);
            let count = NODES;
            sink.push_velocity(RungeKutta::Gauss, Stage { index, count }, &xi);
        }
        self.scratch = Some((point, xi));
    }
}
