//! What a method is to the driver: it makes steppers, which advance one step.

use super::facts::Facts;
use super::projection::Projection;
use crate::newton::{Failure, FailureReason, NewtonOptions, NewtonReport};
use crate::poisson::Poisson;
use crate::scalar::Scalar;
use crate::state::State;
use thiserror::Error;

/// How a step went.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepReport {
    /// Evaluations of the vector field, or of the residual of an implicit step (one per iteration,
    /// whatever its number of stages).
    pub evaluations: u32,
    /// Iterations of the solver.
    pub iterations: u32,
    /// Those among them without a Jacobian.
    pub fixed_point: u32,
    /// Jacobians factored.
    pub factorizations: u32,
    /// Largest entry of the residual when it was last evaluated; 0 of an explicit method.
    pub residual: f64,
    /// Steps of an adaptive method that were accepted within this one; 1 of every other method.
    pub substeps: u32,
    /// Steps of an adaptive method that were rejected within this one.
    pub rejected: u32,
    /// Bit k is set if lane k had a small pivot and was solved with row exchanges.
    pub pivoted: u64,
}

impl StepReport {
    /// The report of an implicit step: a residual per iteration and one field for the start.
    pub(super) fn implicit(report: &NewtonReport) -> Self {
        Self {
            evaluations: report.iterations + 1,
            iterations: report.iterations,
            fixed_point: report.fixed_point,
            factorizations: report.factorizations,
            residual: report.residual,
            substeps: 1,
            rejected: 0,
            pivoted: report.pivoted,
        }
    }

    /// Adds the work of a part of the step.
    pub(super) fn add<S: Scalar>(&mut self, part: &Self) {
        self.evaluations += part.evaluations;
        self.iterations += part.iterations;
        self.fixed_point += part.fixed_point;
        self.factorizations += part.factorizations;
        self.residual = S::larger(self.residual, part.residual);
        self.rejected += part.rejected;
        self.pivoted |= part.pivoted;
    }
}

/// A step that was refused in some lanes: their state is the one before the step. The other lanes
/// have advanced.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error("{reason}")]
pub struct StepFailure {
    /// The reason in the first lane that failed.
    pub reason: FailureReason,
    /// Bit k is set if lane k has failed.
    pub lanes: u64,
    /// The work done.
    pub report: StepReport,
}

impl StepFailure {
    pub(super) fn of_solver(failure: &Failure) -> Self {
        Self {
            reason: failure.reason,
            lanes: failure.lanes,
            report: StepReport::implicit(&failure.report),
        }
    }
}

/// A map from the algebra to the group near the identity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Retraction {
    /// The exponential map.
    Exp,
    /// The Cayley map of the declared representation.
    Cayley,
    /// Coordinates of the second kind: `exp(xi_1 e_1) … exp(xi_n e_n)`.
    SecondKind,
    /// The retraction of [`RetractedPoisson`](crate::structure::RetractedPoisson).
    Declared,
}

/// Takes the group factors of a step, in order: a method of coadjoint form advances
/// `mu1 = Ad*_(tau(xi)) mu`, and `g1 = g tau(xi)` reconstructs the motion on the group.
pub trait FactorSink<V> {
    /// Whether anything is listening; steppers skip the work otherwise.
    fn is_active(&self) -> bool {
        true
    }
    /// Takes one factor `tau(xi)`. In lanes whose step failed, xi is 0.
    fn push(&mut self, retraction: Retraction, xi: &V);
    /// Takes `h xi` at one stage of a step that is not of coadjoint form: the stages come in order, and after
    /// the last of them g moves by that Runge–Kutta method applied to `g' = g xi(t)`.
    fn push_velocity(&mut self, _method: RungeKutta, _stage: Stage, _xi: &V) {}
}

/// Which Runge–Kutta method a step applies to the group element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RungeKutta {
    /// The Gauss method with the number of stages that come.
    Gauss,
    /// An explicit method.
    Explicit {
        /// The coefficients of each stage after the first, as numerators and denominators.
        stages: &'static [&'static [(f64, f64)]],
        /// The weights.
        weights: &'static [(f64, f64)],
    },
}

/// A stage of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stage {
    /// From 0.
    pub index: usize,
    /// How many there are.
    pub count: usize,
}

/// Nothing is listening.
impl<V> FactorSink<V> for () {
    fn is_active(&self) -> bool {
        false
    }

    fn push(&mut self, _retraction: Retraction, _xi: &V) {}
}

/// Advances one step of a fixed size.
pub trait Stepper<S: Scalar> {
    /// The state of the system.
    type State: State<S>;

    /// Advances `mu` by one step. Allocates nothing.
    ///
    /// # Errors
    /// A [`StepFailure`] naming the lanes in which the step was refused; `mu` is untouched there.
    fn step<K: FactorSink<Self::State>>(
        &mut self,
        mu: &mut Self::State,
        sink: &mut K,
    ) -> Result<StepReport, StepFailure>;

    /// The error of the step made last, relative to the size of the state, where its stages tell it: an estimate from above
    /// that costs much less than a second step.
    fn estimate(&mut self) -> Option<S> {
        None
    }

    /// Makes the steps to come of size h, with what it knows of those before, and without allocating. False where it cannot: then whoever
    /// asks makes another stepper.
    fn set_step(&mut self, _h: S) -> bool {
        false
    }

    /// Shows every number that a step takes from the steps before, in an order of its own, so that it can be read and replaced: what it
    /// leaves out, no step depends on. False where not all of it can be shown; then nothing may be replaced.
    fn carry(&mut self, _visit: &mut dyn FnMut(&mut S)) -> bool {
        false
    }

    /// Takes a projection for the ends of steps that it chooses itself. Gives it back where it chooses none: a step is one step
    /// then, and whoever asks projects behind it.
    fn keep(
        &mut self,
        projection: Projection<S, Self::State>,
    ) -> Option<Projection<S, Self::State>> {
        Some(projection)
    }

    /// Makes steps in each lane at its own pace: as soon as one has come to its end, the next begins there, of the same member or of
    /// another. Each has the bits of a stepper of its own. False where the steps of all lanes end together: then nothing is done.
    fn relay(&mut self, _mu: &mut Self::State, _members: &mut dyn Relay<S, Self::State>) -> bool {
        false
    }
}

/// Members that take turns in the lanes of a stepper which chooses its own steps.
pub trait Relay<S: Scalar, V> {
    /// Takes the states of `mu` in lanes that have come to the end of their step, and hears where one was refused; leaves in `mu` the
    /// states from which steps are made in those lanes, or in others where none was made.
    fn next(&mut self, mu: &mut V, arrived: S::Mask, refused: S::Mask) -> Legs<S>;
}

/// Steps that begin.
#[derive(Clone, Copy, Debug)]
pub struct Legs<S: Scalar> {
    /// In these lanes.
    pub begin: S::Mask,
    /// Those among them about which nothing is known from the step before: another member, or another size.
    pub anew: S::Mask,
    /// The size in each lane that begins.
    pub h: S,
}

/// A method of integration, as a value with its options.
#[diagnostic::on_unimplemented(
    message = "the method `{Self}` does not apply to the system `{P}` over the scalar `{S}`",
    note = "implicit methods need an equation (`Implicit<S, Method>`): for a system written by hand see `lie_runtime::generic_equations!`",
    note = "the Cayley map exists where the declared `matrices` are closed under (abc + cba)/2"
)]
pub trait Method<S: Scalar, P: Poisson<S>>: Facts {
    /// The stepper; it borrows the system.
    type Stepper<'a>: Stepper<S, State = P::State>
    where
        P: 'a;
    /// A stepper of step size h, which may be negative and may differ per lane.
    fn stepper<'a>(&self, system: &'a P, h: S, newton: &NewtonOptions) -> Self::Stepper<'a>;
    /// The stepper of [`Method::stepper`] in a box, its type forgotten: what a run takes, so that it is compiled once for each system. The box
    /// borrows the method too.
    #[cfg(feature = "std")]
    fn boxed<'a>(
        &'a self,
        system: &'a P,
        h: S,
        newton: &NewtonOptions,
    ) -> Box<dyn super::any::AnyStepper<S, P::State> + 'a> {
        Box::new(self.stepper(system, h, newton))
    }
}

/// The failure of an explicit method.
pub(super) fn not_finite(lanes: u64, report: StepReport) -> StepFailure {
    StepFailure {
        reason: FailureReason::NotFinite,
        lanes,
        report,
    }
}
