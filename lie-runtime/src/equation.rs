//! Implicit steps as nonlinear equations, and the hooks by which a system supplies fused ones.

use crate::matrix::SquareMatrix;
use crate::poisson::{CayleyPoisson, LiePoisson, Poisson};
use crate::scalar::Scalar;
use crate::state::{Stages, State, Unknown};

/// One implicit step of fixed size as an equation `r(u) = 0`.
///
/// Newton's iteration knows only this trait. The fixed-point form of the equation is
/// `u -> u - r(u)`. Functions take `&mut self` so that an equation may keep scratch space; they
/// allocate nothing.
pub trait Equation<S: Scalar> {
    /// The state of the system.
    type State: State<S>;
    /// What is solved for.
    type Unknown: Unknown<S>;
    /// The Jacobian `dr/du`, later its factors.
    type Matrix: SquareMatrix<S>;

    /// An unknown of the right size, all entries 0.
    fn zero_unknown(&self) -> Self::Unknown;
    /// A matrix of the right size, all entries 0.
    fn zero_matrix(&self) -> Self::Matrix;

    /// Sets the state from which the step starts. Everything below refers to it.
    fn set_base(&mut self, mu: &Self::State);
    /// The unknown with which the iteration starts.
    fn initial_guess(&mut self, unknown: &mut Self::Unknown);
    /// The residual r(u).
    fn residual(&mut self, unknown: &Self::Unknown, residual: &mut Self::Unknown);
    /// The residual and its Jacobian `dr/du`. Writes every entry that can be nonzero before or
    /// after [`Equation::factor`] (pattern and fill-in); the others keep the 0 of
    /// [`Equation::zero_matrix`].
    fn linearize(
        &mut self,
        unknown: &Self::Unknown,
        residual: &mut Self::Unknown,
        matrix: &mut Self::Matrix,
    );
    /// Replaces a Jacobian by its triangular factors, pivots in a fixed order; false in the lanes
    /// where a pivot is too small ([`crate::newton::inverse_pivots_are_safe`]).
    fn factor(&self, matrix: &mut Self::Matrix) -> S::Mask;
    /// Solves `(dr/du) x = r` by the factors, in place of r.
    fn solve(&self, factors: &Self::Matrix, residual: &mut Self::Unknown);
    /// The state at the end of the step for a solution u.
    fn result(&mut self, unknown: &Self::Unknown, mu: &mut Self::State);
}

/// The equation of the implicit (Poisson) midpoint rule for a system.
///
/// The generated implementation returns a fused equation; by hand, return
/// [`crate::generic::Midpoint`].
pub trait MidpointEquations<S: Scalar>: Poisson<S> {
    /// The equation; it may borrow the system.
    type Equation<'a>: Equation<S, State = Self::State, Unknown = Self::State>
    where
        Self: 'a;
    /// The equation of a step of size h.
    fn midpoint_equation(&self, h: S) -> Self::Equation<'_>;
}

/// The equation of Gauss collocation with a number of stages for a system.
///
/// The generated implementation returns a fused equation; by hand, return
/// [`crate::generic::Gauss`].
pub trait GaussEquations<S: Scalar, const STAGES: usize>: Poisson<S> {
    /// The equation; it may borrow the system.
    type Equation<'a>: Equation<S, State = Self::State, Unknown = Stages<Self::State, STAGES>>
    where
        Self: 'a;
    /// The equation of a step of size h.
    fn gauss_equation(&self, h: S) -> Self::Equation<'_>;
}

/// The equation of the Lie–Poisson midpoint method with the exponential map for a system.
///
/// The generated implementation returns a fused equation; by hand, return
/// [`crate::generic::ExpMidpoint`].
pub trait LieMidpointEquations<S: Scalar>: LiePoisson<S> {
    /// The equation; it may borrow the system. Its unknown is the momentum m at the midpoint.
    type Exp<'a>: Equation<S, State = Self::State, Unknown = Self::State>
    where
        Self: 'a;
    /// The equation of a step of size h.
    fn exp_equation(&self, h: S) -> Self::Exp<'_>;
}

/// The equation of the Lie–Poisson midpoint method with the Cayley map for a system.
///
/// The generated implementation returns a fused equation; by hand, return
/// [`crate::generic::CayleyMidpoint`].
pub trait CayleyEquations<S: Scalar>: CayleyPoisson<S> {
    /// The equation; it may borrow the system. Its unknown is the momentum m at the midpoint.
    type Cayley<'a>: Equation<S, State = Self::State, Unknown = Self::State>
    where
        Self: 'a;
    /// The equation of a step of size h.
    fn cayley_equation(&self, h: S) -> Self::Cayley<'_>;
}

/// Implements hook traits of a system written by hand with the generic equations.
///
/// ```text
/// lie_runtime::generic_equations!([S: Scalar] Body<S>, S: midpoint, gauss, exp);
/// ```
///
/// After the colon stand the families: `midpoint`, `gauss`, `exp`, `cayley`.
#[macro_export]
macro_rules! generic_equations {
    ($generics:tt $system:ty, $scalar:ty: $($family:ident),+ $(,)?) => {
        $($crate::generic_equations!(@$family $generics $system, $scalar);)+
    };
    (@midpoint [$($generics:tt)*] $system:ty, $scalar:ty) => {
        impl<$($generics)*> $crate::MidpointEquations<$scalar> for $system {
            type Equation<'a> = $crate::generic::Midpoint<'a, $scalar, Self> where Self: 'a;
            fn midpoint_equation(&self, h: $scalar) -> Self::Equation<'_> {
                $crate::generic::Midpoint::new(self, h)
            }
        }
    };
    (@gauss [$($generics:tt)*] $system:ty, $scalar:ty) => {
        impl<const STAGES: usize, $($generics)*> $crate::GaussEquations<$scalar, STAGES>
            for $system
        {
            type Equation<'a> = $crate::generic::Gauss<'a, $scalar, Self, STAGES> where Self: 'a;
            fn gauss_equation(&self, h: $scalar) -> Self::Equation<'_> {
                $crate::generic::Gauss::new(self, h)
            }
        }
    };
    (@exp [$($generics:tt)*] $system:ty, $scalar:ty) => {
        impl<$($generics)*> $crate::LieMidpointEquations<$scalar> for $system {
            type Exp<'a> = $crate::generic::ExpMidpoint<'a, $scalar, Self> where Self: 'a;
            fn exp_equation(&self, h: $scalar) -> Self::Exp<'_> {
                $crate::generic::ExpMidpoint::new(self, h)
            }
        }
    };
    (@cayley [$($generics:tt)*] $system:ty, $scalar:ty) => {
        impl<$($generics)*> $crate::CayleyEquations<$scalar> for $system {
            type Cayley<'a> = $crate::generic::CayleyMidpoint<'a, $scalar, Self> where Self: 'a;
            fn cayley_equation(&self, h: $scalar) -> Self::Cayley<'_> {
                $crate::generic::CayleyMidpoint::new(self, h)
            }
        }
    };
}
