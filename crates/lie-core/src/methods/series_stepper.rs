//! The stepper of methods by series: as many series as a step of the grid takes, and no more than it needs.

use super::implicit::equal_lanes;
use super::projection::Projection;
use super::stepper::{FactorSink, Relay, StepFailure, StepReport, Stepper};
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
    /// Knows nothing of developments before in some lanes.
    fn forget(&mut self, lanes: S::Mask);
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

    /// The lanes in which a state is the one that was left. A motion may come back to the same state at another time, where another field
    /// acts: so the time, which a driver sets to the grid, is compared too, to a small part of a step or its round-off.
    fn follows(&self, mu: &D::State) -> S::Mask {
        let clock = self.development.clock();
        let same = equal_lanes(clock, &self.current, mu);
        clock.map_or(same, |clock| {
            let [left, now] = [&self.current, mu].map(|state| state.as_slice()[clock.time]);
            let near = self.length * S::from_f64(SLIVER);
            let near = near.max(left.abs() * S::epsilon() * S::from_f64(4.0));
            same & (now - left).abs().less_equal(near)
        })
    }

    /// Develops anew in some lanes; returns those where a coefficient is not finite, and those that do not leave a joint.
    #[cfg_attr(not(debug_assertions), inline(always))]
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

/// How far a step of the grid has come.
struct Way<S: Scalar> {
    /// What is behind, of the length of the step.
    covered: S,
    /// Lanes that have neither arrived nor failed.
    active: S::Mask,
    report: StepReport,
    /// Why the first lane failed, and all that did.
    failure: Option<StepFailure>,
    failed: S::Mask,
}

impl<S: Scalar> Way<S> {
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn in_lanes(active: S::Mask) -> Self {
        Self {
            covered: S::zero(),
            active,
            report: StepReport::default(),
            failure: None,
            failed: S::Mask::splat(false),
        }
    }

    /// Lanes go no further.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn fail(&mut self, reason: FailureReason, lanes: S::Mask) {
        if lanes.any() {
            let first = StepFailure {
                reason,
                lanes: 0,
                report: self.report,
            };
            self.failure.get_or_insert(first).lanes |= lanes.bits();
            self.failed = self.failed | lanes;
            self.active = self.active & !lanes;
        }
    }
}

impl<S: Scalar, D: Development<S>> SeriesStepper<S, D> {
    /// The lanes on their way whose development is used up.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn spent(&self, way: &Way<S>) -> S::Mask {
        let left = self.reach - self.place;
        let sliver = S::select(self.joint, S::zero(), self.reach * S::from_f64(SLIVER));
        way.active & left.less_equal(sliver)
    }

    /// Develops anew in lanes on their way.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn renew(&mut self, way: &mut Way<S>, spent: S::Mask) {
        let [broken, stuck] = self.develop(spent);
        way.report.evaluations += 1;
        way.report.substeps += 1;
        way.fail(FailureReason::NotFinite, broken);
        way.fail(FailureReason::OnJoint, stuck);
    }

    /// Goes along the developments in lanes on their way, as far as they reach; answers those that arrive.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn go<K: FactorSink<D::State>>(
        &mut self,
        way: &mut Way<S>,
        lanes: S::Mask,
        sink: &mut K,
    ) -> S::Mask {
        let (left, remaining) = (self.reach - self.place, self.length - way.covered);
        let beyond = S::select(self.joint, left, left * S::from_f64(1.0 + SLIVER));
        let last = remaining.less_equal(beyond);
        let size = S::select(lanes, S::select(last, remaining, left), S::zero());
        let small = size.less_equal(S::epsilon() * self.length);
        way.fail(
            FailureReason::StepTooSmall,
            lanes & !last & small & !self.joint,
        );
        let (from, place) = (self.place, self.place + size);
        self.development.state(self.sign * place, &mut self.point);
        let finite = self.point.finite();
        way.fail(FailureReason::NotFinite, lanes & way.active & !finite);
        let moving = lanes & way.active;
        if sink.is_active() && moving.any() {
            let (from, to) = (self.sign * from, self.sign * place);
            self.development.push_factors(from, to, moving, sink);
        }
        self.place = S::select(moving, place, from);
        self.current.assign_where(moving, &self.point);
        if let Some(projection) = &mut self.projection {
            let lost = self
                .development
                .bring_back(projection, moving, &mut self.current);
            way.fail(projection.reason(lost), lost);
        }
        let moved = lanes & way.active;
        way.covered = S::select(moved, way.covered + size, way.covered);
        way.active = way.active & !(moved & last);
        moved & last
    }
}

impl<S: Scalar, D: Development<S>> Stepper<S> for SeriesStepper<S, D> {
    type State = D::State;

    fn step<K: FactorSink<D::State>>(
        &mut self,
        mu: &mut D::State,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        let follows = self.follows(mu);
        self.reach = S::select(follows, self.reach, S::zero());
        self.joint = self.joint & follows;
        self.current.copy_from(mu);
        let mut way = Way::<S>::in_lanes(S::zero().less(self.length));
        while way.active.any() {
            let spent = self.spent(&way);
            if spent.any() {
                self.renew(&mut way, spent);
                if way.report.substeps > MAX_SERIES {
                    let lanes = way.active;
                    way.fail(FailureReason::TooManySteps, lanes);
                    break;
                }
            }
            let lanes = way.active;
            self.go(&mut way, lanes, sink);
        }
        self.reach = S::select(way.failed, S::zero(), self.reach);
        mu.assign_where(!way.failed, &self.current);
        match way.failure {
            None => Ok(way.report),
            Some(failure) => Err(StepFailure {
                report: way.report,
                ..failure
            }),
        }
    }

    /// Develops where no lane can go on without, so that one development serves as many as there are.
    fn relay(&mut self, mu: &mut D::State, members: &mut dyn Relay<S, D::State>) -> bool {
        let none = S::Mask::splat(false);
        let mut way = Way::<S>::in_lanes(none);
        // of the step in each lane
        let mut series = S::zero();
        let mut arrived = none;
        loop {
            mu.assign_where(arrived, &self.current);
            let legs = members.next(mu, arrived, way.failed);
            self.current.assign_where(legs.begin, mu);
            self.length = S::select(legs.begin, legs.h.abs(), self.length);
            let backwards = legs.h.less(S::zero());
            let sign = S::select(backwards, -S::one(), S::one());
            self.sign = S::select(legs.begin, sign, self.sign);
            self.reach = S::select(legs.anew, S::zero(), self.reach);
            self.joint = self.joint & !legs.anew;
            self.development.forget(legs.anew);
            series = S::select(legs.begin, S::zero(), series);
            way = Way {
                covered: S::select(legs.begin, S::zero(), way.covered),
                ..Way::in_lanes(way.active | legs.begin)
            };
            if !way.active.any() {
                return true;
            }
            arrived = none;
            while !(arrived | way.failed).any() {
                let mut ready = way.active & !self.spent(&way);
                if !ready.any() {
                    ready = way.active;
                    series = S::select(ready, series + S::one(), series);
                    self.renew(&mut way, ready);
                    let most = S::from_f64(f64::from(MAX_SERIES));
                    let endless = way.active & most.less(series);
                    way.fail(FailureReason::TooManySteps, endless);
                    ready = ready & way.active;
                }
                arrived = self.go(&mut way, ready, &mut ());
            }
        }
    }

    fn keep(&mut self, projection: Projection<S, D::State>) -> Option<Projection<S, D::State>> {
        self.projection = Some(projection);
        None
    }
}
