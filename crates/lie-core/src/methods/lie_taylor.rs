//! Taylor series in the algebra: the increment of a step to any order, the step itself an exact coadjoint action.
//!
//! ```math
//! \mu(t + s) = \mathrm{Ad}^*_{\exp \xi(s)}\, \mu(t), \qquad
//! \xi' = \mathrm{d}\exp^{-1}_{-\xi}(\omega) = \sum_{j \ge 0} \frac{(-1)^j B_j}{j!}\, \mathrm{ad}_\xi^j\, \omega, \qquad
//! \omega(s) = \nabla H(\mu(t + s)), \quad \xi(0) = 0
//! ```
//!
//! The coefficients of mu and omega follow from the recurrences of [`GradientSeries`], those of xi from theirs: since xi
//! begins with `s omega_0`, the term j begins with `s^j`, and the coefficient of order k needs the first k of them. That
//! takes of the order of `p^3` brackets, eight of them side by side. The state at any place of the series is on the orbit, so
//! that a series that reaches further than a step of the grid serves the next ones too.
//!
//! Explicit. It keeps the coadjoint orbit and with it every Casimir, at any tolerance; the energy, and the Poisson structure, to
//! the tolerance. Order and step as those of [`Taylor`](super::Taylor), the order `1 - 0.4 ln(tolerance)`.
//!
//! Damping along the orbit has the generator in place of the gradient.
//!
//! Needs: an expression of H and a Lie algebra.
//!
//! References: H. Munthe-Kaas, "High order Runge–Kutta methods on manifolds", Applied Numerical Mathematics 29 (1999)
//! 115–127, [doi:10.1016/S0168-9274(98)00030-0](https://doi.org/10.1016/S0168-9274(98)00030-0), for the equation of
//! xi; À. Jorba, M. Zou, "A software package for the numerical integration of ODEs by means of high-order Taylor methods",
//! Experimental Mathematics 14 (2005) 99–117,
//! [doi:10.1080/10586458.2005.10128904](https://doi.org/10.1080/10586458.2005.10128904), for order and step.
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::development::{Pace, Rows, Terms, by_series, copy_lanes, multiply, sum};
use super::facts::{Facts, Preserves};
use super::implicit::clear;
use super::joints::Joints;
use super::projection::Projection;
use super::series_stepper::{Developed, Development, SeriesStepper};
use super::stepper::{FactorSink, Method, Retraction};
use super::time_unit::TimeUnit;
use crate::clock::{Clock, norm};
use crate::generic::{Scratch, coadjoint_action_in};
use crate::newton::NewtonOptions;
use crate::poisson::{LiePoisson, Poisson, Widen};
use crate::recurrence::{GradientRecurrence, GradientSeries, Recurrence};
use crate::scalar::{Mask, Scalar};
use crate::state::{State, copies};

/// The largest order.
pub const MOST: usize = 16;
/// Nested brackets side by side.
const LANES: usize = 8;
const GROUPS: usize = MOST / LANES;
/// The order over `-ln(tolerance)`: the work grows faster with it than that of [`Taylor`](super::Taylor).
const ORDER: f64 = 0.4;

by_series!(
    /// Taylor series in the algebra; see the [module's text](self).
    LieTaylor,
    "Of an order up to 16, one series for each step of the grid."
);

impl Facts for LieTaylor {
    const ID: &'static str = "lie-taylor";
    /// At the default tolerance.
    const ORDER: u32 = 15;
    const SYMMETRIC: bool = false;
    const EXPLICIT: bool = true;
    const OWN_STEPS: bool = true;
    const PRESERVES: Preserves = Preserves::ORBIT;
    const DAMPING: bool = true;
}

/// `(-1)^j B_j/j!`, of even j from 2 on `-2 (-1)^(j/2) zeta(j)/(2 pi)^j`.
static INVERSE: [f64; MOST + 1] = {
    let mut table = [0.0; MOST + 1];
    (table[0], table[1], table[2]) = (1.0, 0.5, 1.0 / 12.0);
    (table[4], table[6], table[8]) = (-1.0 / 720.0, 1.0 / 30240.0, -1.0 / 1_209_600.0);
    let square = 4.0 * core::f64::consts::PI * core::f64::consts::PI;
    let mut j = 10;
    while j <= MOST {
        // zeta(j) to round-off: the first term that is left out is 41^-10 = 7e-17
        let (mut zeta, mut n) = (1.0, 40);
        let mut tail = 0.0;
        while n >= 2 {
            let (mut power, mut i) = (1.0, 0);
            while i < j {
                power /= n as f64;
                i += 1;
            }
            tail += power;
            n -= 1;
        }
        zeta += tail;
        let (mut value, mut i) = (if j % 4 == 0 { -2.0 * zeta } else { 2.0 * zeta }, 0);
        while i < j / 2 {
            value /= square;
            i += 1;
        }
        table[j] = value;
        j += 2;
    }
    table
};

impl<S: Scalar, P> Method<S, P> for LieTaylor
where
    P: GradientSeries<S> + LiePoisson<S> + Widen<S>,
    P::Widened: LiePoisson<S::Wide>,
{
    type Stepper<'a>
        = SeriesStepper<S, LieTaylorDevelopment<'a, S, P>>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, _newton: &NewtonOptions) -> Self::Stepper<'a> {
        let zero = system.zero_state();
        let mut pace = match self.order {
            Some(order) => Pace::of_order(order as usize),
            None => Pace::of_tolerance::<S>(self.tolerance, ORDER),
        };
        pace.order = pace.order.min(MOST);
        let wide = system.widen();
        let wide_zero = wide.zero_state();
        let development = LieTaylorDevelopment {
            system,
            pace,
            recurrence: system.gradient_series(),
            inverses: core::array::from_fn(|k| S::ratio(1.0, k.max(1) as f64)),
            rows: copies(&zero),
            increments: copies(&zero),
            nested: copies(&copies(&wide_zero)),
            widened: copies(&wide_zero),
            bracket: wide_zero.clone(),
            sums: copies(&wide_zero),
            wide,
            field: zero.clone(),
            coefficient: zero.clone(),
            scratch: Scratch::new(&zero),
            unit: TimeUnit::new(),
            joints: Joints::new(),
        };
        SeriesStepper::new(development, h, zero)
    }
}

type WideState<S, P> = <<P as Widen<S>>::Widened as Poisson<<S as Scalar>::Wide>>::State;

/// The Taylor series of an increment.
pub struct LieTaylorDevelopment<'a, S: Scalar, P: GradientSeries<S> + Widen<S> + 'a> {
    system: &'a P,
    wide: P::Widened,
    pace: Pace,
    recurrence: P::Recurrence<'a>,
    /// `1/k`
    inverses: [S; MOST + 1],
    /// The coefficients of mu, and of xi.
    rows: Rows<P::State>,
    increments: Rows<P::State>,
    /// At each order, `ad_xi^j omega` for j = 0 … 7 in the lanes of the first, 8 … 15 in those of the second, and so on.
    nested: [[WideState<S, P>; GROUPS]; MOST],
    /// The coefficients of xi in every lane.
    widened: [WideState<S, P>; MOST + 1],
    bracket: WideState<S, P>,
    sums: [WideState<S, P>; GROUPS],
    field: P::State,
    coefficient: P::State,
    scratch: Scratch<P::State>,
    unit: TimeUnit<S>,
    joints: Joints,
}

impl<S: Scalar, P> LieTaylorDevelopment<'_, S, P>
where
    P: GradientSeries<S> + LiePoisson<S> + Widen<S>,
    P::Widened: LiePoisson<S::Wide>,
{
    /// The brackets of order k: `sums` has in lane r of group g the coefficient k of `ad_xi^j omega` with `j = 8 g + r + 1`.
    fn nest(&mut self, k: usize) {
        for group in 0..k.div_ceil(LANES) {
            let sum = &mut self.sums[group];
            sum.fill(S::Wide::zero());
            // ad_xi^j omega begins with order j
            for i in 1..=k - LANES * group {
                let (xi, inner) = (&self.widened[i], &self.nested[k - i][group]);
                self.wide.ad(xi, inner, &mut self.bracket);
                sum.axpy(S::Wide::one(), &self.bracket);
            }
        }
        let groups = k.div_ceil(LANES);
        let omega = self.recurrence.gradient();
        for entry in 0..omega.as_slice().len() {
            let mut before = omega.as_slice()[entry];
            for group in 0..GROUPS {
                let zero = S::zero();
                let next = match group < groups {
                    true => S::scatter(self.sums[group].as_slice()[entry]),
                    false => [zero; LANES],
                };
                let moved = core::array::from_fn(|r| if r == 0 { before } else { next[r - 1] });
                before = next[LANES - 1];
                self.nested[k][group].as_mut_slice()[entry] = S::gather(moved);
            }
        }
    }

    /// The increment at a time, in `coefficient`.
    fn increment(&mut self, time: S) {
        let time = time * self.unit.inverse;
        sum(
            &self.increments,
            self.pace.order,
            time,
            &mut self.coefficient,
        );
    }

    /// The coefficient k of `xi'`, in `coefficient`.
    fn velocity(&mut self, k: usize) {
        let omega = self.recurrence.gradient();
        for (entry, out) in self.coefficient.as_mut_slice().iter_mut().enumerate() {
            let mut sum = S::zero();
            for group in (0..k.div_ceil(LANES)).rev() {
                let terms = S::scatter(self.sums[group].as_slice()[entry]);
                for (r, &term) in terms.iter().enumerate().rev() {
                    let j = LANES * group + r + 1;
                    if j <= k && INVERSE[j] != 0.0 {
                        sum += S::from_f64(INVERSE[j]) * term;
                    }
                }
            }
            *out = omega.as_slice()[entry] + sum;
        }
    }
}

impl<S: Scalar, P> Development<S> for LieTaylorDevelopment<'_, S, P>
where
    P: GradientSeries<S> + LiePoisson<S> + Widen<S>,
    P::Widened: LiePoisson<S::Wide>,
{
    type State = P::State;

    fn clock(&self) -> Option<Clock> {
        self.system.clock()
    }

    fn forget(&mut self, lanes: S::Mask) {
        self.unit.forget(lanes);
    }

    fn develop(&mut self, mu: &P::State, step: S, [lanes, landed]: [S::Mask; 2]) -> Developed<S> {
        copy_lanes(&mut self.rows[0], mu, lanes, lanes.all());
        let mut carry = self.recurrence.begin(mu, &mut self.field);
        let clock = self.clock();
        let slope = || norm(clock, &self.field);
        self.unit.begin(&self.pace, clock, (mu, slope), step, lanes);
        let mut open = lanes;
        loop {
            let all = open.all();
            for k in 0..self.pace.order {
                self.nest(k);
                self.velocity(k);
                let factor = self.inverses[k + 1] * self.unit.length;
                for entry in self.coefficient.as_mut_slice() {
                    *entry *= factor;
                }
                copy_lanes(&mut self.increments[k + 1], &self.coefficient, open, all);
                let wide = self.widened[k + 1].as_mut_slice().iter_mut();
                for (wide, entry) in wide.zip(self.coefficient.as_slice()) {
                    *wide = entry.widen();
                }
                multiply(&self.field, factor, &mut self.coefficient);
                copy_lanes(&mut self.rows[k + 1], &self.coefficient, open, all);
                if k + 1 < self.pace.order {
                    carry =
                        self.recurrence
                            .advance(k + 1, carry, &self.coefficient, &mut self.field);
                }
            }
            let series = [&self.rows, &self.increments].map(Terms::Rows);
            open = self.unit.settle(&self.pace, &series, clock, step, open);
            if !open.any() {
                break;
            }
            carry = self.recurrence.begin(mu, &mut self.field);
        }
        self.joints.end(
            &self.recurrence,
            &self.pace,
            &self.unit,
            step,
            [lanes, landed],
        )
    }

    fn state(&mut self, time: S, out: &mut P::State) {
        self.increment(time);
        let (xi, mu) = (&self.coefficient, &self.rows[0]);
        coadjoint_action_in(self.system, xi, mu, out, &mut self.scratch);
        if let Some(Clock { momentum, .. }) = self.system.clock()
            && self.system.is_forced()
        {
            // the power of the damping moves it beside the orbit
            let (rows, time) = (&self.rows, time * self.unit.inverse);
            sum(rows, self.pace.order, time, &mut self.field);
            out.as_mut_slice()[momentum] = self.field.as_slice()[momentum];
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

    /// By `exp(-xi(from))`, then `exp(xi(to))`.
    fn push_factors<K: FactorSink<P::State>>(
        &mut self,
        from: S,
        to: S,
        lanes: S::Mask,
        sink: &mut K,
    ) {
        let begins = from.less_equal(S::zero()) & S::zero().less_equal(from);
        if !begins.all() {
            self.increment(from);
            for entry in self.coefficient.as_mut_slice() {
                *entry = -*entry;
            }
            clear(&mut self.coefficient, !lanes);
            sink.push(Retraction::Exp, &self.coefficient);
        }
        self.increment(to);
        clear(&mut self.coefficient, !lanes);
        sink.push(Retraction::Exp, &self.coefficient);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `z/(1 - exp(-z))` is what the coefficients sum to.
    #[test]
    fn the_inverse_of_dexp() {
        for z in [0.1_f64, -0.7, 1.3, -2.0] {
            let sum = INVERSE.iter().rev().fold(0.0, |sum, c| sum * z + c);
            let exact = z / (1.0 - libm::exp(-z));
            let rest = (z.abs() / core::f64::consts::TAU).powi(18) * 2.0;
            assert!((sum - exact).abs() < 1e-15 + rest, "{z}: {:e}", sum - exact);
        }
        assert_eq!(INVERSE[3], 0.0);
        let tenth = 5.0 / 66.0 / 3_628_800.0;
        assert!((INVERSE[10] / tenth - 1.0).abs() < 1e-15);
    }
}
