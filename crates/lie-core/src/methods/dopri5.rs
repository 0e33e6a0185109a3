//! The adaptive explicit method of Dormand and Prince, as a control that keeps no structure.
//!
//! Seven stages, order 5 with an embedded order 4. Within each step of the driver's grid it chooses
//! its own steps and lands on the end. A step is accepted if the error estimate, measured in
//! `atol + rtol max(|mu_i|, |mu1_i|)` and averaged in the square over the components, is at most 1;
//! the next step follows from Gustafsson's proportional-integral control, and the first from the
//! sizes of f and of its change.
//!
//! Lanes choose their steps independently of each other.
//!
//! Needs: the vector field.
//!
//! References: J. R. Dormand, P. J. Prince, "A family of embedded Runge–Kutta formulae", Journal of
//! Computational and Applied Mathematics 6 (1980) 19–26,
//! [doi:10.1016/0771-050X(80)90013-3](https://doi.org/10.1016/0771-050X(80)90013-3); step control
//! as in E. Hairer, S. P. Nørsett, G. Wanner, "Solving Ordinary Differential Equations I", 2nd
//! edition, Springer 1993, sections II.4 and IV.2,
//! [doi:10.1007/978-3-540-78862-1](https://doi.org/10.1007/978-3-540-78862-1).

mod progress;
mod tableau;

use super::explicit::direction;
use super::facts::{Facts, Preserves};
use super::implicit::clear;
use super::projection::Projection;
use super::stepper::{
    FactorSink, Method, Relay, RungeKutta, Stage, StepFailure, StepReport, Stepper,
};
use crate::clock::holds;
use crate::newton::{FailureReason, NewtonOptions};
use crate::poisson::Poisson;
use crate::scalar::{Mask, Scalar};
use crate::state::{State, Unknown, copies};
use progress::Progress;
use tableau::{A, ERROR};

/// Attempts within one step of the grid after which it has failed.
const MAX_ATTEMPTS: u32 = 1_000_000;
/// Of an error of 1e-4, below which the next step does not follow the one before.
const LEAST_LOG_ERROR: f64 = -4.0 * core::f64::consts::LN_10;

/// The adaptive method of Dormand and Prince, order 5; see the [module's text](self).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dopri5 {
    /// Relative tolerance per step.
    pub rtol: f64,
    /// Absolute tolerance per step, in the units of the state.
    pub atol: f64,
}

impl Default for Dopri5 {
    fn default() -> Self {
        Self {
            rtol: 1e-6,
            atol: 1e-9,
        }
    }
}

impl Facts for Dopri5 {
    const ID: &'static str = "dopri5";
    const ORDER: u32 = 5;
    const SYMMETRIC: bool = false;
    const EXPLICIT: bool = true;
    const OWN_STEPS: bool = true;
    const PRESERVES: Preserves = Preserves::LINEAR;
    const FORCES: bool = true;
    const DAMPING: bool = true;
}

impl<S: Scalar, P: Poisson<S>> Method<S, P> for Dopri5 {
    type Stepper<'a>
        = Dopri5Stepper<'a, S, P>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, _newton: &NewtonOptions) -> Self::Stepper<'a> {
        let zero = system.zero_state();
        Dopri5Stepper {
            system,
            rtol: S::from_f64(self.rtol),
            atol: S::from_f64(self.atol),
            length: h.abs(),
            sign: sign(h),
            proposal: S::zero(),
            known: S::Mask::splat(false),
            log_error_before: S::from_f64(LEAST_LOG_ERROR),
            slopes: copies(&zero),
            current: zero.clone(),
            point: zero,
            projection: None,
        }
    }
}

/// The stepper of [`Dopri5`].
pub struct Dopri5Stepper<'a, S: Scalar, P: Poisson<S>> {
    system: &'a P,
    rtol: S,
    atol: S,
    /// Length of a step of the grid, and its direction.
    length: S,
    sign: S,
    /// The size of the next step, kept from one step of the grid to the next, in the lanes where it is known.
    proposal: S,
    known: S::Mask,
    log_error_before: S,
    slopes: [P::State; 7],
    current: P::State,
    point: P::State,
    projection: Option<Projection<S, P::State>>,
}

impl<S: Scalar, P: Poisson<S>> Dopri5Stepper<'_, S, P> {
    /// Size of a vector in units of the tolerances: the root of the mean square.
    fn measure(&self, vector: impl Fn(usize) -> S, other: Option<&P::State>) -> S {
        let mut sum = S::zero();
        let clock = self.system.clock();
        let entries = self.current.as_slice().iter().enumerate();
        for (index, &entry) in entries.filter(|(i, _)| !holds(clock, *i)) {
            let size = other.map_or(entry.abs(), |other| {
                entry.abs().max(other.as_slice()[index].abs())
            });
            let ratio = vector(index) / (self.atol + self.rtol * size);
            sum += ratio * ratio;
        }
        let count = self.system.dimension() - if clock.is_some() { 3 } else { 0 };
        (sum / S::from_f64(count as f64)).sqrt()
    }

    /// The size of the first step, from the sizes of mu, f and the change of f along a trial step.
    /// The slope at the current state must have been computed.
    fn first_step(&mut self) -> S {
        let tiny = self.length * S::from_f64(1e-6);
        let state = self.measure(|index| self.current.as_slice()[index], None);
        let slope = self.measure(|index| self.slopes[0].as_slice()[index], None);
        let small = S::from_f64(1e-5);
        let flat = state.less_equal(small) | (slope * self.length).less_equal(small);
        let trial = S::select(flat, tiny, S::from_f64(0.01) * state / slope);
        let trial = minimum(trial, self.length);
        self.point.copy_from(&self.current);
        self.point.axpy(self.sign * trial, &self.slopes[0]);
        self.system.vector_field(&self.point, &mut self.slopes[1]);
        let change = |index| self.slopes[1].as_slice()[index] - self.slopes[0].as_slice()[index];
        let curvature = self.measure(change, None) / trial;
        // in units of the grid's step, so that the unit of time does not matter
        let change = slope.max(curvature * self.length) * self.length;
        let step = (S::from_f64(0.01) / change).powf(S::ratio(1.0, 5.0)) * self.length;
        let step = S::select(step.finite(), step, self.length);
        minimum(minimum(trial * S::from_f64(100.0), step), self.length)
    }

    /// Computes the stages of a step of signed size h from the current state; leaves the new state
    /// in `point` and its slope in the last stage. Returns the error in units of the tolerances.
    fn attempt(&mut self, h: S) -> S {
        for (stage, row) in A.iter().enumerate() {
            self.point.copy_from(&self.current);
            for (slope, &(numerator, denominator)) in self.slopes.iter().zip(*row) {
                self.point.axpy(h * S::ratio(numerator, denominator), slope);
            }
            self.system
                .vector_field(&self.point, &mut self.slopes[stage + 1]);
        }
        let error = |index: usize| {
            let mut sum = S::zero();
            for (slope, &(numerator, denominator)) in self.slopes.iter().zip(&ERROR) {
                sum += S::ratio(numerator, denominator) * slope.as_slice()[index];
            }
            h * sum
        };
        self.measure(error, Some(&self.point))
    }

    /// Gives away `h grad H` at the stages of an accepted step, which are formed again from their slopes.
    fn give_velocities<K: FactorSink<P::State>>(&mut self, h: S, accepted: S::Mask, sink: &mut K) {
        let (stages, weights) = (&A[..5], A[5]);
        let method = RungeKutta::Explicit { stages, weights };
        let count = weights.len();
        let mut place = self.current.clone();
        let mut xi = self.current.clone();
        for index in 0..count {
            place.copy_from(&self.current);
            let row = index.checked_sub(1).map_or(&[][..], |row| stages[row]);
            for (slope, &(numerator, denominator)) in self.slopes.iter().zip(row) {
                place.axpy(h * S::ratio(numerator, denominator), slope);
            }
            direction(self.system, h, &place, &mut xi);
            clear(&mut xi, !accepted);
            sink.push_velocity(method, Stage { index, count }, &xi);
        }
    }

    /// Begins steps in lanes, from the states that are there.
    fn begin(&mut self, progress: &mut Progress<S>, lanes: S::Mask) {
        self.system.vector_field(&self.current, &mut self.point);
        progress.report.evaluations += 1;
        self.slopes[0].assign_where(lanes, &self.point);
        let unknown = lanes & !self.known;
        if unknown.any() {
            progress.report.evaluations += 1;
            self.proposal = S::select(unknown, self.first_step(), self.proposal);
            let least = S::from_f64(LEAST_LOG_ERROR);
            self.log_error_before = S::select(unknown, least, self.log_error_before);
            self.known = self.known | unknown;
        }
        progress.covered = S::select(lanes, S::zero(), progress.covered);
        progress.active = progress.active | (lanes & S::zero().less(self.length));
        progress.after_rejection = progress.after_rejection & !lanes;
    }

    /// One attempt in all lanes on their way; answers those that arrive.
    fn attempt_in<K: FactorSink<P::State>>(
        &mut self,
        progress: &mut Progress<S>,
        sink: &mut K,
    ) -> S::Mask {
        let remaining = self.length - progress.covered;
        // stretch by at most 1 percent rather than leave a sliver
        let last = remaining.less_equal(self.proposal * S::from_f64(1.01));
        let size = S::select(last, remaining, self.proposal);
        let size = S::select(progress.active, size, S::zero());
        let too_small = progress.active & !last & size.less_equal(S::epsilon() * self.length);
        progress.fail(FailureReason::StepTooSmall, too_small);
        let error = self.attempt(self.sign * size);
        progress.report.evaluations += 6;
        let accepted = progress.active & error.less_equal(S::one()) & self.point.finite();
        self.adapt(progress, (size, last), error, accepted);
        progress.covered = S::select(accepted, progress.covered + size, progress.covered);
        if sink.is_active() && accepted.any() {
            self.give_velocities(self.sign * size, accepted, sink);
        }
        self.current.assign_where(accepted, &self.point);
        let [first, .., end] = &mut self.slopes;
        // of the state before its projection, from which it differs by the error of the step
        first.assign_where(accepted, end);
        if let Some(projection) = &mut self.projection {
            let lost = projection.bring_back(self.system, accepted, &mut self.current);
            progress.fail(projection.reason(lost), lost);
        }
        let arrived = progress.active & accepted & last;
        progress.active = progress.active & !arrived;
        arrived
    }

    /// The size of the next attempt after one with this error.
    fn adapt(
        &mut self,
        progress: &mut Progress<S>,
        (size, last): (S, S::Mask),
        error: S,
        accepted: S::Mask,
    ) {
        let rejected = progress.active & !accepted;
        progress.report.substeps += u32::from(accepted.any());
        progress.report.rejected += u32::from(rejected.any());
        let log_error = error.log();
        let next = size / self.divisor(log_error, accepted);
        let after_rejection = accepted & progress.after_rejection;
        let next = S::select(after_rejection, minimum(next, size), next);
        // a step cut short by the end of the interval says nothing against a longer one
        let kept = S::select(accepted & last, self.proposal.max(next), next);
        self.proposal = S::select(progress.active, kept, self.proposal);
        let least = log_error.max(S::from_f64(LEAST_LOG_ERROR));
        self.log_error_before = S::select(accepted, least, self.log_error_before);
        progress.after_rejection = rejected;
    }

    /// The factor by which the next step is divided after an error, given by its logarithm.
    fn divisor(&self, log_error: S, accepted: S::Mask) -> S {
        // error^0.17/error_before^0.04, the second factor after an accepted step alone
        let plain = log_error * S::from_f64(0.17);
        let controlled = plain - self.log_error_before * S::from_f64(0.04);
        let divisor = S::select(accepted, controlled, plain).exp() / S::from_f64(0.9);
        let divisor = divisor.max(S::select(accepted, S::ratio(1.0, 10.0), S::one()));
        S::select(
            divisor.finite(),
            minimum(divisor, S::from_f64(5.0)),
            S::from_f64(10.0),
        )
    }
}

/// The direction of a step.
fn sign<S: Scalar>(h: S) -> S {
    S::select(h.less(S::zero()), -S::one(), S::one())
}

/// The smaller of two numbers.
fn minimum<S: Scalar>(first: S, second: S) -> S {
    S::select(second.less(first), second, first)
}

impl<S: Scalar, P: Poisson<S>> Stepper<S> for Dopri5Stepper<'_, S, P> {
    type State = P::State;

    fn step<K: FactorSink<P::State>>(
        &mut self,
        mu: &mut P::State,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        let mut progress = Progress::none();
        self.current.copy_from(mu);
        self.begin(&mut progress, S::Mask::splat(true));
        for _ in 0..MAX_ATTEMPTS {
            if !progress.active.any() {
                break;
            }
            self.attempt_in(&mut progress, sink);
        }
        let endless = progress.active;
        progress.fail(FailureReason::TooManySteps, endless);
        mu.assign_where(!progress.failed(), &self.current);
        let report = progress.report;
        match progress.failure {
            None => Ok(report),
            Some(failure) => Err(StepFailure { report, ..failure }),
        }
    }

    fn relay(&mut self, mu: &mut P::State, members: &mut dyn Relay<S, P::State>) -> bool {
        let none = S::Mask::splat(false);
        let mut progress = Progress::none();
        // in the step of each lane
        let mut attempts = S::zero();
        let mut arrived = none;
        loop {
            mu.assign_where(arrived, &self.current);
            let legs = members.next(mu, arrived, progress.failed());
            self.current.assign_where(legs.begin, mu);
            self.length = S::select(legs.begin, legs.h.abs(), self.length);
            self.sign = S::select(legs.begin, sign(legs.h), self.sign);
            self.known = self.known & !legs.anew;
            attempts = S::select(legs.begin, S::zero(), attempts);
            progress.failure = None;
            progress.report = StepReport::default();
            if legs.begin.any() {
                self.begin(&mut progress, legs.begin);
            }
            if !progress.active.any() {
                return true;
            }
            arrived = none;
            while !(arrived | progress.failed()).any() {
                arrived = self.attempt_in(&mut progress, &mut ());
                attempts += S::one();
                let most = S::from_f64(f64::from(MAX_ATTEMPTS));
                let endless = progress.active & most.less_equal(attempts);
                progress.fail(FailureReason::TooManySteps, endless);
            }
        }
    }

    fn keep(&mut self, projection: Projection<S, P::State>) -> Option<Projection<S, P::State>> {
        self.projection = Some(projection);
        None
    }
}

#[cfg(test)]
mod tests;
