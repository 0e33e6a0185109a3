//! The stepper of methods by series: as many series as a step of the grid takes, and no more than it needs.

use super::implicit::equal_lanes;
use super::stepper::{FactorSink, StepFailure, StepReport, Stepper};
use crate::clock::Clock;
use crate::newton::FailureReason;
use crate::scalar::{Mask, Scalar};
use crate::state::{State, Unknown};

/// Series within one step of the grid after which it has failed.
const MAX_SERIES: u32 = 1_000_000;
/// The part of a series that is left, rather than walked in a step of its own.
const SLIVER: f64 = 0.01;

/// What a method by series computes.
pub trait Development<S: Scalar> {
    /// The state of the system.
    type State: State<S>;

    /// The coordinates that carry the time.
    fn clock(&self) -> Option<Clock>;
    /// Develops the solution from a state in some lanes, for a step of the grid; the others keep theirs. Returns how far it
    /// is used in each lane, not a number where a coefficient is not finite.
    fn develop(&mut self, mu: &Self::State, step: S, lanes: S::Mask) -> S;
    /// The state at a time from where the development began, negative for steps backwards.
    fn state(&mut self, time: S, out: &mut Self::State);
    /// How the group element moves between two such times, in some lanes.
    fn push_factors<K: FactorSink<Self::State>>(
        &mut self,
        from: S,
        to: S,
        lanes: S::Mask,
        sink: &mut K,
    );
}

/// A stepper that lands on every step of the grid with steps of its own; a development that reaches further serves the
/// next steps of the grid too.
pub struct SeriesStepper<S: Scalar, D: Development<S>> {
    development: D,
    /// Length of a step of the grid, and its direction.
    length: S,
    sign: S,
    /// Where on its development the current state lies, and how far that is used.
    place: S,
    reach: S,
    current: D::State,
    point: D::State,
}

impl<S: Scalar, D: Development<S>> SeriesStepper<S, D> {
    pub(super) fn new(development: D, h: S, zero: D::State) -> Self {
        Self {
            development,
            length: h.abs(),
            sign: S::select(h.less(S::zero()), -S::one(), S::one()),
            place: S::zero(),
            reach: S::zero(),
            current: zero.clone(),
            point: zero,
        }
    }

    /// Develops anew in some lanes; false in those where a coefficient is not finite.
    #[inline(always)]
    fn develop(&mut self, lanes: S::Mask) -> S::Mask {
        let step = self.sign * self.length;
        let reach = self.development.develop(&self.current, step, lanes);
        let known = reach.less_equal(reach);
        self.reach = S::select(lanes & known, reach, self.reach);
        self.place = S::select(lanes & known, S::zero(), self.place);
        known | !lanes
    }
}

/// Lanes that have failed, and why the first did.
struct Failures<S: Scalar> {
    failure: Option<StepFailure>,
    lanes: S::Mask,
}

impl<S: Scalar> Failures<S> {
    #[inline(always)]
    fn add(&mut self, reason: FailureReason, lanes: S::Mask, report: StepReport) {
        if lanes.any() {
            let first = StepFailure {
                reason,
                lanes: 0,
                report,
            };
            self.failure.get_or_insert(first).lanes |= lanes.bits();
            self.lanes = self.lanes | lanes;
        }
    }
}

impl<S: Scalar, D: Development<S>> Stepper<S> for SeriesStepper<S, D> {
    type State = D::State;

    fn step<K: FactorSink<D::State>>(
        &mut self,
        mu: &mut D::State,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        let follows = equal_lanes(self.development.clock(), &self.current, mu);
        self.reach = S::select(follows, self.reach, S::zero());
        self.current.copy_from(mu);
        let mut report = StepReport::default();
        let mut failures = Failures::<S> {
            failure: None,
            lanes: S::Mask::splat(false),
        };
        let mut covered = S::zero();
        let mut active = S::zero().less(self.length);
        while active.any() {
            let left = self.reach - self.place;
            let spent = active & left.less_equal(self.reach * S::from_f64(SLIVER));
            if spent.any() {
                let known = self.develop(spent);
                report.evaluations += 1;
                report.substeps += 1;
                failures.add(FailureReason::NotFinite, spent & !known, report);
                active = active & known;
                if report.substeps > MAX_SERIES {
                    failures.add(FailureReason::TooManySteps, active, report);
                    break;
                }
            }
            let (left, remaining) = (self.reach - self.place, self.length - covered);
            let last = remaining.less_equal(left * S::from_f64(1.0 + SLIVER));
            let size = S::select(active, S::select(last, remaining, left), S::zero());
            let too_small = active & !last & size.less_equal(S::epsilon() * self.length);
            failures.add(FailureReason::StepTooSmall, too_small, report);
            active = active & !too_small;
            let (from, place) = (self.place, self.place + size);
            self.development.state(self.sign * place, &mut self.point);
            let finite = self.point.finite();
            failures.add(FailureReason::NotFinite, active & !finite, report);
            active = active & finite;
            if sink.is_active() && active.any() {
                let (from, to) = (self.sign * from, self.sign * place);
                self.development.push_factors(from, to, active, sink);
            }
            self.place = S::select(active, place, from);
            self.current.assign_where(active, &self.point);
            covered = S::select(active, covered + size, covered);
            active = active & !last;
        }
        self.reach = S::select(failures.lanes, S::zero(), self.reach);
        mu.assign_where(!failures.lanes, &self.current);
        match failures.failure {
            None => Ok(report),
            Some(failure) => Err(StepFailure { report, ..failure }),
        }
    }
}
