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

use super::explicit::direction;
use super::facts::{Facts, Preserves};
use super::implicit::clear;
use super::projection::Projection;
use super::stepper::{FactorSink, Method, RungeKutta, Stage, StepFailure, StepReport, Stepper};
use crate::clock::holds;
use crate::newton::{FailureReason, NewtonOptions};
use crate::poisson::Poisson;
use crate::scalar::{Mask, Scalar};
use crate::state::{State, Unknown};

/// Attempts within one step of the grid after which it has failed.
const MAX_ATTEMPTS: u32 = 1_000_000;

/// Rows of the tableau below the first stage, and numerators over denominators.
static A: [&[(f64, f64)]; 6] = [
    &[(1.0, 5.0)],
    &[(3.0, 40.0), (9.0, 40.0)],
    &[(44.0, 45.0), (-56.0, 15.0), (32.0, 9.0)],
    &[
        (19372.0, 6561.0),
        (-25360.0, 2187.0),
        (64448.0, 6561.0),
        (-212.0, 729.0),
    ],
    &[
        (9017.0, 3168.0),
        (-355.0, 33.0),
        (46732.0, 5247.0),
        (49.0, 176.0),
        (-5103.0, 18656.0),
    ],
    &[
        (35.0, 384.0),
        (0.0, 1.0),
        (500.0, 1113.0),
        (125.0, 192.0),
        (-2187.0, 6784.0),
        (11.0, 84.0),
    ],
];

/// Weights of order 5 minus those of order 4.
const ERROR: [(f64, f64); 7] = [
    (71.0, 57600.0),
    (0.0, 1.0),
    (-71.0, 16695.0),
    (71.0, 1920.0),
    (-17253.0, 339200.0),
    (22.0, 525.0),
    (-1.0, 40.0),
];

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
            sign: S::select(h.less(S::zero()), -S::one(), S::one()),
            proposal: None,
            log_error_before: S::from_f64(-4.0 * core::f64::consts::LN_10),
            slopes: core::array::from_fn(|_| zero.clone()),
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
    /// The size of the next step, kept from one step of the grid to the next.
    proposal: Option<S>,
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

    /// A step from here, of which nothing is done.
    fn begin(&mut self, mu: &P::State) -> Progress<S> {
        let mut report = StepReport {
            evaluations: 1,
            ..StepReport::default()
        };
        self.current.copy_from(mu);
        self.system.vector_field(mu, &mut self.slopes[0]);
        report.evaluations += u32::from(self.proposal.is_none());
        let proposal = self.proposal.unwrap_or_else(|| self.first_step());
        Progress {
            proposal,
            covered: S::zero(),
            active: S::zero().less(self.length),
            after_rejection: S::Mask::splat(false),
            report,
            failure: None,
        }
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
        let kept = S::select(accepted & last, progress.proposal.max(next), next);
        progress.proposal = S::select(progress.active, kept, progress.proposal);
        let least = log_error.max(S::from_f64(-4.0 * core::f64::consts::LN_10));
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

/// How far a step of the grid has come.
struct Progress<S: Scalar> {
    /// The size of the next attempt.
    proposal: S,
    /// What is behind, of the length of the step.
    covered: S,
    /// Lanes that have neither arrived nor failed.
    active: S::Mask,
    after_rejection: S::Mask,
    report: StepReport,
    failure: Option<StepFailure>,
}

impl<S: Scalar> Progress<S> {
    /// The size of the next attempt, and where it is the last.
    fn attempt(&self, length: S) -> (S, S::Mask) {
        let remaining = length - self.covered;
        // stretch by at most 1 percent rather than leave a sliver
        let last = remaining.less_equal(self.proposal * S::from_f64(1.01));
        let size = S::select(last, remaining, self.proposal);
        (S::select(self.active, size, S::zero()), last)
    }

    /// Lanes go no further.
    fn fail(&mut self, reason: FailureReason, lanes: S::Mask) {
        let failed = StepFailure {
            reason,
            lanes: 0,
            report: self.report,
        };
        self.failure.get_or_insert(failed).lanes |= lanes.bits();
        self.active = self.active & !lanes;
    }
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
        let mut progress = self.begin(mu);
        for _ in 0..MAX_ATTEMPTS {
            if !progress.active.any() {
                break;
            }
            let (size, last) = progress.attempt(self.length);
            let too_small = progress.active & !last & size.less_equal(S::epsilon() * self.length);
            if too_small.any() {
                progress.fail(FailureReason::StepTooSmall, too_small);
            }
            let error = self.attempt(self.sign * size);
            progress.report.evaluations += 6;
            let accepted = progress.active & error.less_equal(S::one()) & self.point.finite();
            self.adapt(&mut progress, (size, last), error, accepted);
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
                if lost.any() {
                    progress.fail(projection.reason(lost), lost);
                }
            }
            progress.active = progress.active & !(accepted & last);
        }
        if progress.active.any() {
            progress.fail(FailureReason::TooManySteps, progress.active);
        }
        self.proposal = Some(progress.proposal);
        let (report, failure) = (progress.report, progress.failure);
        let good = !S::Mask::from_bits(failure.map_or(0, |failure| failure.lanes));
        mu.assign_where(good, &self.current);
        match failure {
            None => Ok(report),
            Some(failure) => Err(StepFailure { report, ..failure }),
        }
    }

    fn keep(&mut self, projection: Projection<S, P::State>) -> Option<Projection<S, P::State>> {
        self.projection = Some(projection);
        None
    }
}

#[cfg(test)]
mod tests;
