//! The stepper of methods by series: as many series as a step of the grid takes, and no more than it needs.

use super::implicit::equal_lanes;
use super::projection::Projection;
use super::stepper::{FactorSink, StepFailure, StepReport, Stepper};
use crate::clock::Clock;
use crate::newton::FailureReason;
use crate::scalar::{Mask, Scalar};
use crate::state::{State, Unknown};

/// Series within one step of the grid after which it has failed.
const MAX_SERIES: u32 = 1_000_000;
/// The part of a series that is left, rather than walked in a step of its own.
const SLIVER: f64 = 0.01;

/// How far a development is used.
#[derive(Clone, Copy, Debug)]
pub struct Developed<S: Scalar> {
    /// A time, not a number where a coefficient is not finite.
    pub reach: S,
    /// The lanes in which that is a joint, beyond which another branch of H is taken.
    pub joint: S::Mask,
    /// The lanes in which the motion does not leave a joint.
    pub stuck: S::Mask,
}

impl<S: Scalar> Developed<S> {
    /// Not at all.
    pub(super) fn broken() -> Self {
        let none = S::Mask::splat(false);
        Self {
            reach: S::zero() / S::zero(),
            joint: none,
            stuck: none,
        }
    }
}

/// What a method by series computes.
pub trait Development<S: Scalar> {
    /// The state of the system.
    type State: State<S>;

    /// The coordinates that carry the time.
    fn clock(&self) -> Option<Clock>;
    /// Develops the solution from a state in some lanes, for a step of the grid; the others keep theirs. Returns how far it
    /// is used in each lane. The second lanes are those of the first in which the state is at the joint that ended the
    /// development before.
    fn develop(&mut self, mu: &Self::State, step: S, lanes: [S::Mask; 2]) -> Developed<S>;
    /// The state at a time from where the development began, negative for steps backwards.
    fn state(&mut self, time: S, out: &mut Self::State);
    /// Brings a state back onto levels in some lanes; returns those in which that fails.
    fn bring_back(
        &self,
        projection: &mut Projection<S, Self::State>,
        lanes: S::Mask,
        mu: &mut Self::State,
    ) -> S::Mask;
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
    /// Where it ends at a joint.
    joint: S::Mask,
    current: D::State,
    point: D::State,
    projection: Option<Projection<S, D::State>>,
}

impl<S: Scalar, D: Development<S>> SeriesStepper<S, D> {
    pub(super) fn new(development: D, h: S, zero: D::State) -> Self {
        Self {
            development,
            length: h.abs(),
            sign: S::select(h.less(S::zero()), -S::one(), S::one()),
            place: S::zero(),
            reach: S::zero(),
            joint: S::Mask::splat(false),
            current: zero.clone(),
            point: zero,
            projection: None,
        }
    }

    /// Develops anew in some lanes; returns those where a coefficient is not finite, and those that do not leave a joint.
    #[inline(always)]
    fn develop(&mut self, lanes: S::Mask) -> [S::Mask; 2] {
        let step = self.sign * self.length;
        let Developed {
            reach,
            joint,
            stuck,
        } = self
            .development
            .develop(&self.current, step, [lanes, lanes & self.joint]);
        let known = reach.less_equal(reach);
        let taken = lanes & known;
        self.reach = S::select(taken, reach, self.reach);
        self.place = S::select(taken, S::zero(), self.place);
        self.joint = (self.joint & !taken) | (joint & taken);
        [lanes & !known, lanes & known & stuck]
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
        self.joint = self.joint & follows;
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
            let sliver = S::select(self.joint, S::zero(), self.reach * S::from_f64(SLIVER));
            let spent = active & left.less_equal(sliver);
            if spent.any() {
                let [broken, stuck] = self.develop(spent);
                report.evaluations += 1;
                report.substeps += 1;
                failures.add(FailureReason::NotFinite, broken, report);
                failures.add(FailureReason::OnJoint, stuck, report);
                active = active & !broken & !stuck;
                if report.substeps > MAX_SERIES {
                    failures.add(FailureReason::TooManySteps, active, report);
                    break;
                }
            }
            let (left, remaining) = (self.reach - self.place, self.length - covered);
            let beyond = S::select(self.joint, left, left * S::from_f64(1.0 + SLIVER));
            let last = remaining.less_equal(beyond);
            let size = S::select(active, S::select(last, remaining, left), S::zero());
            let small = size.less_equal(S::epsilon() * self.length);
            let too_small = active & !last & small & !self.joint;
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
            if let Some(projection) = &mut self.projection {
                let lost = self
                    .development
                    .bring_back(projection, active, &mut self.current);
                failures.add(projection.reason(lost), lost, report);
                active = active & !lost;
            }
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

    fn keep(&mut self, projection: Projection<S, D::State>) -> Option<Projection<S, D::State>> {
        self.projection = Some(projection);
        None
    }
}
