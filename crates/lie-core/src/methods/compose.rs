//! Compositions of a symmetric method of order 2: the same method with steps that sum to one.
//!
//! ```math
//! \Psi_h = \Phi_{\gamma_s h} \circ \dots \circ \Phi_{\gamma_2 h} \circ \Phi_{\gamma_1 h}, \qquad
//! \gamma_i = \gamma_{s+1-i}, \quad \sum_i \gamma_i = 1
//! ```
//!
//! | order | schemes, the default first |
//! |---|---|
//! | 4 | [`Scheme::Suzuki`] (5 stages), [`Scheme::TripleJump`] (3) |
//! | 6 | [`Scheme::KahanLi`] (9), [`Scheme::Yoshida`] (7), [`Scheme::Suzuki`] (25), [`Scheme::TripleJump`] (9) |
//! | 8 | [`Scheme::KahanLi`] (17), [`Scheme::SuzukiUmeno`] (15) |
//!
//! Symmetric, and keeps what the base keeps: Poisson structure, coadjoint orbit, Casimirs, energy.
//! Some of the `$\gamma_i$` are negative, of necessity from order 3 on, so a composition does not suit a base
//! that needs a positive step.
//!
//! Needs: a base that is symmetric and of order 2; others do not compile. Stages of equal size share a
//! stepper.
//!
//! Reference: E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration", 2nd edition, Springer
//! 2006, section V.3.2, [doi:10.1007/3-540-30666-8](https://doi.org/10.1007/3-540-30666-8); for the
//! coefficients see [`Scheme`].
#![cfg_attr(doc, doc = include_str!("../../docs/katex.html"))]

use super::coefficients::{Parts, Scheme};
use super::facts::{Facts, Preserves};
use super::implicit::clear;
use super::stepper::{
    FactorSink, Method, Retraction, RungeKutta, Stage, StepFailure, StepReport, Stepper,
};
use crate::newton::NewtonOptions;
use crate::poisson::Poisson;
use crate::scalar::{Mask, Scalar};
use crate::state::{State, Unknown};

/// The most stages of a scheme, and the most sizes among them.
const STAGES: usize = 25;
const SIZES: usize = 9;

/// A composition of order 4, 6 or 8; see the [module's text](self).
///
/// ```
/// use lie_core::methods::{Compose6, LieMidpoint, Scheme};
/// let method = Compose6::new(LieMidpoint::exp()).scheme(Scheme::Yoshida);
/// ```
///
/// The base must be symmetric and of order 2:
///
/// ```compile_fail
/// use lie_core::methods::{Compose4, Rk4};
/// let method = Compose4::new(Rk4::new());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Compose<M, const ORDER: u32> {
    base: M,
    scheme: Scheme,
}

/// A composition of order 4, by default Suzuki's of 5 stages.
pub type Compose4<M> = Compose<M, 4>;
/// A composition of order 6, by default that of Kahan and Li of 9 stages.
pub type Compose6<M> = Compose<M, 6>;
/// A composition of order 8, by default that of Kahan and Li of 17 stages.
pub type Compose8<M> = Compose<M, 8>;

impl<M: Facts, const ORDER: u32> Compose<M, ORDER> {
    /// A composition of a base, with the default scheme of the order.
    pub const fn new(base: M) -> Self {
        const {
            assert!(
                matches!(ORDER, 4 | 6 | 8),
                "compositions have order 4, 6 or 8"
            );
            assert!(
                M::SYMMETRIC && M::ORDER == 2,
                "the base of a composition is a symmetric method of order 2"
            );
        }
        Self {
            base,
            scheme: Scheme::default_of_composition(ORDER),
        }
    }

    /// The same with other coefficients.
    ///
    /// # Panics
    /// If there is no such scheme of this order (the table is in the [module's text](self)).
    #[must_use]
    pub const fn scheme(mut self, scheme: Scheme) -> Self {
        assert!(
            scheme.composition(ORDER).is_some(),
            "there is no such composition of this order"
        );
        self.scheme = scheme;
        self
    }
}

impl<M: Facts, const ORDER: u32> Facts for Compose<M, ORDER> {
    const ID: &'static str = match ORDER {
        4 => "compose4",
        6 => "compose6",
        _ => "compose8",
    };
    const ORDER: u32 = ORDER;
    const SYMMETRIC: bool = true;
    const EXPLICIT: bool = M::EXPLICIT;
    const PRESERVES: Preserves = M::PRESERVES;
    const FORCES: bool = M::FORCES;
    const DAMPING: bool = M::DAMPING;
}

impl<S, P, M, const ORDER: u32> Method<S, P> for Compose<M, ORDER>
where
    S: Scalar,
    P: Poisson<S>,
    M: Method<S, P>,
{
    type Stepper<'a>
        = ComposeStepper<S, M::Stepper<'a>>
    where
        P: 'a;

    fn stepper<'a>(&self, system: &'a P, h: S, newton: &NewtonOptions) -> Self::Stepper<'a> {
        // `scheme` has seen to it that there is one
        let half = self.scheme.composition(ORDER).unwrap_or(&[Parts::ONE]);
        let count = 2 * half.len() - 1;
        let size = |stage: usize| half[stage.min(count - 1 - stage)];
        let first = |stage: usize| (0..stage).find(|&other| size(other) == size(stage));
        let mut sizes = [0; SIZES];
        let mut different = 0;
        let mut stages = [0; STAGES];
        for stage in 0..count {
            stages[stage] = match first(stage) {
                Some(same) => stages[same],
                None => {
                    sizes[different] = stage;
                    different += 1;
                    different - 1
                }
            };
        }
        let steppers = core::array::from_fn(|index| {
            let gamma = || size(sizes[index]).number::<S>();
            (index < different).then(|| self.base.stepper(system, gamma() * h, newton))
        });
        let stages = Stages {
            steppers,
            order: stages,
            count,
            before: system.zero_state(),
            state: system.zero_state(),
        };
        ComposeStepper {
            stages,
            factor: system.zero_state(),
        }
    }
}

/// The stepper of a composition: one stepper of the base for each size of a stage.
pub struct ComposeStepper<S: Scalar, T: Stepper<S>> {
    stages: Stages<S, T>,
    factor: T::State,
}

struct Stages<S: Scalar, T: Stepper<S>> {
    steppers: [Option<T>; SIZES],
    /// The stepper of each stage.
    order: [usize; STAGES],
    count: usize,
    before: T::State,
    state: T::State,
}

/// Passes factors on, in failed lanes those of no motion.
pub(super) struct Masked<'a, S: Scalar, V, K> {
    pub(super) sink: &'a mut K,
    pub(super) failed: S::Mask,
    pub(super) factor: &'a mut V,
}

impl<S: Scalar, V: State<S>, K: FactorSink<V>> FactorSink<V> for Masked<'_, S, V, K> {
    fn is_active(&self) -> bool {
        self.sink.is_active()
    }

    fn push(&mut self, retraction: Retraction, xi: &V) {
        self.factor.copy_from(xi);
        clear(self.factor, self.failed);
        self.sink.push(retraction, self.factor);
    }

    fn push_velocity(&mut self, method: RungeKutta, stage: Stage, xi: &V) {
        self.factor.copy_from(xi);
        clear(self.factor, self.failed);
        self.sink.push_velocity(method, stage, self.factor);
    }
}

impl<S: Scalar, T: Stepper<S>> Stages<S, T> {
    /// All stages. A lane in which one fails goes back to where it was before the first.
    fn run<K: FactorSink<T::State>>(&mut self, sink: &mut K) -> Result<StepReport, StepFailure> {
        self.state.copy_from(&self.before);
        let mut total = StepReport {
            substeps: 1,
            ..StepReport::default()
        };
        let mut failure: Option<StepFailure> = None;
        for &stage in &self.order[..self.count] {
            let Some(stepper) = &mut self.steppers[stage] else {
                continue;
            };
            let report = match stepper.step(&mut self.state, sink) {
                Ok(report) => report,
                Err(new) => {
                    let known = failure.get_or_insert(StepFailure { lanes: 0, ..new });
                    if new.lanes.trailing_zeros() < known.lanes.trailing_zeros() {
                        known.reason = new.reason;
                    }
                    known.lanes |= new.lanes;
                    let failed = S::Mask::from_bits(known.lanes);
                    self.state.assign_where(failed, &self.before);
                    new.report
                }
            };
            total.add::<S>(&report);
            if failed_lanes::<S>(failure.as_ref()).all() {
                break;
            }
        }
        match failure {
            None => Ok(total),
            Some(failure) => Err(StepFailure {
                report: total,
                ..failure
            }),
        }
    }
}

fn failed_lanes<S: Scalar>(failure: Option<&StepFailure>) -> S::Mask {
    S::Mask::from_bits(failure.map_or(0, |failure| failure.lanes))
}

impl<S: Scalar, T: Stepper<S>> Stepper<S> for ComposeStepper<S, T> {
    type State = T::State;

    fn carry(&mut self, visit: &mut dyn FnMut(&mut S)) -> bool {
        let mut steppers = self.stages.steppers.iter_mut().flatten();
        steppers.all(|stepper| stepper.carry(visit))
    }

    fn step<K: FactorSink<T::State>>(
        &mut self,
        mu: &mut T::State,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure> {
        let Self { stages, factor } = self;
        stages.before.copy_from(mu);
        let outcome = stages.run(&mut ());
        let failed = failed_lanes::<S>(outcome.as_ref().err());
        mu.assign_where(!failed, &stages.state);
        if sink.is_active() && !failed.all() {
            // Only after the last stage it is known which lanes have no factors to give away; the
            // second run is the same as the first.
            let _same = stages.run(&mut Masked::<S, _, _> {
                sink,
                failed,
                factor,
            });
        }
        outcome
    }
}
