//! Spaces over g* on which Gauss methods are solved point by point.

use core::ops::Range;

use super::StageSlopes;
use crate::clock::Clock;
use crate::methods::Smallest;
use crate::poisson::LiePoisson;
use crate::scalar::Scalar;
use crate::state::State;
use crate::structure::CollectivePoisson;

/// A linear symplectic space with a momentum map J that is quadratic, and a linear action of g over that on g*.
///
/// Gauss methods commute with linear symplectic maps, and keep quadratic invariants. So the end of a step over a state does
/// not depend on the point over it, and the step is a Poisson map. What distinguishes orbits, but is constant on the
/// space, are its labels.
pub trait LinearLift<S: Scalar, P: LiePoisson<S>> {
    /// A point.
    type Point: State<S>;
    /// What is constant on the space.
    type Labels: State<S>;
    /// Whether points become large on a bounded orbit, and are to be chosen anew.
    const GROWS: bool;
    /// Which flow it is, where a system may have programs of it.
    const SLOPES: Option<StageSlopes> = None;
    /// A point, all coordinates 0.
    fn zero_point(system: &P) -> Self::Point;
    /// Labels, all 0.
    fn zero_labels(system: &P) -> Self::Labels;
    /// Where the time and its momentum are among the coordinates of a point, which carry them as they are.
    fn clock(_system: &P) -> Option<Clock> {
        None
    }
    /// Which coordinates of a point have the units of mu where the others have none; without, all have the same.
    fn momenta(_system: &P) -> Option<Range<usize>> {
        None
    }
    /// A point over a state, with its labels.
    fn lift(system: &P, mu: &P::State, labels: &mut Self::Labels, point: &mut Self::Point);
    /// The state `J(z)` under a point.
    fn project(system: &P, labels: &Self::Labels, point: &Self::Point, mu: &mut P::State);
    /// The canonical flow of `H o J` at a point, up to directions in which J does not change.
    fn flow(system: &P, labels: &Self::Labels, point: &Self::Point, out: &mut Self::Point);
    /// Moves a point over its state to where it is small, and the slopes of the step that led there with it.
    fn settle(_system: &P, _point: &mut Self::Point, _slopes: &mut Self::Point) {}
}

/// The lift of a system that has one of its own.
impl<S: Scalar, P: CollectivePoisson<S>> LinearLift<S, P> for Smallest {
    type Point = <P::Lift as LinearLift<S, P>>::Point;
    type Labels = <P::Lift as LinearLift<S, P>>::Labels;
    const GROWS: bool = P::Lift::GROWS;
    const SLOPES: Option<StageSlopes> = P::Lift::SLOPES;

    fn zero_point(system: &P) -> Self::Point {
        P::Lift::zero_point(system)
    }

    fn zero_labels(system: &P) -> Self::Labels {
        P::Lift::zero_labels(system)
    }

    fn clock(system: &P) -> Option<Clock> {
        P::Lift::clock(system)
    }

    fn momenta(system: &P) -> Option<Range<usize>> {
        P::Lift::momenta(system)
    }

    #[inline]
    fn lift(system: &P, mu: &P::State, labels: &mut Self::Labels, point: &mut Self::Point) {
        P::Lift::lift(system, mu, labels, point);
    }

    #[inline(always)]
    fn project(system: &P, labels: &Self::Labels, point: &Self::Point, mu: &mut P::State) {
        P::Lift::project(system, labels, point, mu);
    }

    #[inline(always)]
    fn flow(system: &P, labels: &Self::Labels, point: &Self::Point, out: &mut Self::Point) {
        P::Lift::flow(system, labels, point, out);
    }

    #[inline(always)]
    fn settle(system: &P, point: &mut Self::Point, slopes: &mut Self::Point) {
        P::Lift::settle(system, point, slopes);
    }
}
