//! How slopes at the stages of a collocation method come about.

use crate::generic::{At, Open, Rule, StageSlopes};
use crate::poisson::{Poisson, Widen};
use crate::scalar::{Mask, Scalar};

/// The state of the system over eight numbers.
pub type WideState<S, P> = <<P as Widen<S>>::Widened as Poisson<<S as Scalar>::Wide>>::State;

/// How the slopes at the stages of a collocation method come about.
pub trait Slopes<'a, S: Scalar, P: Widen<S> + 'a>: Sized {
    /// For steps of size h.
    fn new(system: &'a P, wide: &P::Widened, h: S) -> Self;

    /// Which slopes they are, where a system may have programs of them.
    fn known(&self) -> Option<StageSlopes> {
        None
    }

    /// The next slopes, from the stages of a step.
    fn next(&mut self, wide: &P::Widened, at: At<'_, WideState<S, P>>, out: &mut WideState<S, P>);

    /// The next increments: `h b_i` times those slopes.
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn increments(
        &mut self,
        wide: &P::Widened,
        stages: Open<'_, S, WideState<S, P>>,
        out: &mut WideState<S, P>,
    ) {
        stages.at_points(|at, out| self.next(wide, at, out), out);
    }

    /// The directions in the algebra at the stages: the generator, or a mean of `grad H`.
    fn directions(
        &mut self,
        wide: &P::Widened,
        at: At<'_, WideState<S, P>>,
        out: &mut WideState<S, P>,
    );

    /// Makes the steps to come of size h; false where it cannot.
    fn set_step(&mut self, _h: S) -> bool {
        false
    }

    /// The lanes in which a step that was solved is good; `increments` gives those of its stages.
    fn resolved(
        &mut self,
        _mu: &P::State,
        _end: &P::State,
        _increments: impl FnOnce(&mut [P::State]),
    ) -> S::Mask {
        S::Mask::splat(true)
    }
}

/// `F_i = f(Y_i)`: Gauss collocation.
#[derive(Clone, Copy, Debug)]
pub struct Field;

impl<'a, S: Scalar, P: Widen<S> + 'a> Slopes<'a, S, P> for Field {
    fn new(_system: &'a P, _wide: &P::Widened, _h: S) -> Self {
        Self
    }

    fn known(&self) -> Option<StageSlopes> {
        Some(StageSlopes::Field)
    }

    fn set_step(&mut self, _h: S) -> bool {
        true
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn next(&mut self, wide: &P::Widened, at: At<'_, WideState<S, P>>, out: &mut WideState<S, P>) {
        wide.vector_field(at.points, out);
    }

    #[cfg_attr(not(debug_assertions), inline(always))]
    fn increments(
        &mut self,
        wide: &P::Widened,
        stages: Open<'_, S, WideState<S, P>>,
        out: &mut WideState<S, P>,
    ) {
        stages.by_parts(wide, out);
    }

    fn directions(
        &mut self,
        wide: &P::Widened,
        at: At<'_, WideState<S, P>>,
        out: &mut WideState<S, P>,
    ) {
        wide.generator(at.points, out);
    }
}

/// The slopes of a system.
pub(super) struct Ruled<'r, S: Scalar, P: Widen<S>, F> {
    pub(super) wide: &'r P::Widened,
    pub(super) rule: &'r mut F,
}

impl<'a, S, P, F> Rule<S, WideState<S, P>> for Ruled<'_, S, P, F>
where
    S: Scalar,
    P: Widen<S> + 'a,
    F: Slopes<'a, S, P>,
{
    #[cfg_attr(not(debug_assertions), inline(always))]
    fn increments(&mut self, stages: Open<'_, S, WideState<S, P>>, next: &mut WideState<S, P>) {
        self.rule.increments(self.wide, stages, next);
    }
}
