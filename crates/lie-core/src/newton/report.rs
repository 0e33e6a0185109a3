//! What an iteration reports.

use thiserror::Error;

/// How a converged iteration went.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NewtonReport {
    /// Iterations, of the lane that took most.
    pub iterations: u32,
    /// Those among them without a Jacobian.
    pub fixed_point: u32,
    /// Jacobians computed and factored.
    pub factorizations: u32,
    /// Largest entry of the residual when it was last evaluated (before the last update).
    pub residual: f64,
    /// Bit k is set if lane k had a small pivot and was solved with row exchanges.
    pub pivoted: u64,
}

/// Why a step has failed.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[non_exhaustive]
pub enum FailureReason {
    /// A number became infinite or NaN.
    #[error("a number is not finite")]
    NotFinite,
    /// The Hamiltonian is not finite at the end of a step.
    #[error("the Hamiltonian is not finite at the end of the step")]
    OutsideDomain,
    /// The Jacobian of the step's equation has no inverse.
    #[error("the Jacobian of the step is singular")]
    Singular,
    /// The updates of the iteration grew.
    #[error("the iteration diverges")]
    Diverged,
    /// The updates of the iteration neither grew nor reached round-off.
    #[error("the iteration does not converge")]
    NotConverged,
    /// The step lies beyond a pole of the Cayley map, or of the rational function of a Gauss method, or where canonical coordinates have no
    /// inverse.
    #[error(
        "the step leaves the chart of the retraction, or the side of its canonical coordinates"
    )]
    OutsideChart,
    /// No rotation near the identity carries the momentum of the step, see
    /// [`MoserVeselov`](crate::methods::MoserVeselov).
    #[error("no rotation near the identity solves the discrete rigid body")]
    RotationTooLarge,
    /// No point of the realization was found over the state, see [`Collective`](crate::methods::Collective).
    #[error("no point of the realization was found over the state")]
    NoLift,
    /// A quadrature does not resolve the gradient of H along the step: the energy would not be kept.
    #[error("the nodes of the method do not resolve the Hamiltonian along the step")]
    Unresolved,
    /// An adaptive method would need a step below round-off of the interval.
    #[error("the adaptive step size fell below round-off")]
    StepTooSmall,
    /// An adaptive method needs too many steps for one interval.
    #[error("too many adaptive steps in one interval")]
    TooManySteps,
    /// The motion comes back to a joint of the branches of H at once, from either side.
    #[error(
        "the motion does not leave a joint, where branches of the Hamiltonian or of a force meet"
    )]
    OnJoint,
    /// Energy and Casimirs cannot be brought back to their values at the start, see
    /// [`Projection`](crate::methods::Projection).
    #[error("the state cannot be brought back onto the levels of what is kept")]
    OffLevel,
    /// Nor can they where their gradients depend on each other or vanish.
    #[error(
        "the gradients of what is kept vanish or depend on each other where the state is to be brought back"
    )]
    DependentLevels,
    /// The density of steps is no positive number: the one before was too long for how fast the motion changes there.
    #[error("the density of steps is not positive")]
    NoDensity,
    /// Steps of a variable size fell below round-off of the time.
    #[error("the step fell below round-off of the time")]
    StepVanishes,
}

impl FailureReason {
    /// What to do about it, in one clause.
    pub fn remedy(self) -> &'static str {
        match self {
            Self::NotFinite => {
                "take a smaller step; where a small one stops as well, the solution grows without bound or leaves the domain of the Hamiltonian: end earlier"
            }
            Self::OutsideDomain => {
                "the step jumps over a singularity of the Hamiltonian or the solution reaches one: take a smaller step or end earlier"
            }
            Self::Singular | Self::Diverged => "take a smaller step",
            Self::NotConverged => {
                "take a smaller step; a simplified iteration can also be replaced by Newton's"
            }
            Self::OutsideChart => {
                "take a smaller step, or a method with the exponential map, whose chart is unbounded"
            }
            Self::RotationTooLarge => {
                "take a smaller step: h times the angular momentum must be below the moments of inertia"
            }
            Self::NoLift => {
                "give the realization a `start` near a point over the initial state; its map must have full rank there"
            }
            Self::Unresolved => {
                "take a smaller step, or `gonzalez`, which keeps the energy without a quadrature"
            }
            Self::StepTooSmall => {
                "the solution has a singularity or the tolerances are below round-off: loosen rtol and atol or end earlier"
            }
            Self::OnJoint => {
                "make the branches equal where they meet, or round the corner off: `sqrt(x^2 + a^2)` for `abs(x)`, `tanh(x/a)` for a sign, as of dry friction that sticks"
            }
            Self::OffLevel => "take a smaller step or tolerance",
            Self::DependentLevels => {
                "keep less: beside an equilibrium, where the gradients of energy and Casimirs depend on each other, no step is small enough"
            }
            Self::NoDensity => "take a smaller step at the start: all others follow from it",
            Self::StepVanishes => "the motion becomes singular there: end earlier",
            Self::TooManySteps => {
                "loosen rtol and atol, take a smaller grid step, or an implicit method"
            }
        }
    }
}

/// An iteration that has failed in some lanes; the others have converged.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error("{reason} after {} iterations, residual {:e}", report.iterations, report.residual)]
pub struct Failure {
    /// The reason in the first lane that failed.
    pub reason: FailureReason,
    /// Bit k is set if lane k has failed.
    pub lanes: u64,
    /// The iteration up to then.
    pub report: NewtonReport,
}
