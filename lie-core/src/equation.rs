//! Implicit steps as nonlinear equations, and the hook by which a system supplies fused ones.

use crate::matrix::SquareMatrix;
use crate::methods::Retraction;
use crate::poisson::Poisson;
use crate::scalar::{Mask as _, Scalar};
use crate::state::{State, Unknown};

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
    /// The size that errors of the unknown are measured against, for the base mu; that of the unknown itself
    /// counts too.
    fn scale(&self, mu: &Self::State) -> S {
        mu.max_norm()
    }
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
    /// The lanes in which the step is what the method promises, for a solution u and the state at its
    /// end. Others are refused: a quadrature may not resolve the Hamiltonian along the step.
    fn resolved(&mut self, _unknown: &Self::Unknown, _end: &Self::State) -> S::Mask {
        S::Mask::splat(true)
    }
    /// The lanes in which the group element of a step, for a solution u, is joined to the identity by those of the
    /// same element of the algebra times s, 0 <= s <= 1. In others the step is refused: beyond a pole of
    /// the Cayley map, or of a method that is a rational function, it may leave the coadjoint orbit.
    fn within_chart(&mut self, _unknown: &Self::Unknown) -> S::Mask {
        S::Mask::splat(true)
    }
    /// For a solution u of a method of coadjoint form, `mu1 = Ad*_(tau(xi)) mu`: writes xi and
    /// returns the retraction tau. None of other methods.
    fn group_factor(
        &mut self,
        _unknown: &Self::Unknown,
        _xi: &mut Self::State,
    ) -> Option<Retraction> {
        None
    }
    /// For a solution u of any other method: `h xi` of a stage, where the step applied to `g' = g xi(t)` is
    /// that of the Gauss method with as many stages as are returned; 0 where it is not known.
    fn velocity(
        &mut self,
        _unknown: &Self::Unknown,
        _stage: usize,
        _xi: &mut Self::State,
    ) -> usize {
        0
    }
}

/// The equation of one step of the implicit method M for a system.
///
/// The generated code returns a fused equation for the methods that the declaration asks for, and
/// the generic one of [`crate::generic`] for all others; by hand, [`crate::generic_equations!`]
/// implements it with the generic ones.
#[diagnostic::on_unimplemented(
    message = "the system `{Self}` has no equation for a step of `{M}` over the scalar `{S}`",
    note = "either it lacks what the method needs (`lie check` says which methods apply, and why others do not), or it is written by hand: then see `lie_runtime::generic_equations!`"
)]
pub trait Implicit<S: Scalar, M>: Poisson<S> {
    /// The equation; it may borrow the system.
    type Equation<'a>: Equation<S, State = Self::State>
    where
        Self: 'a;
    /// The equation of a step of size h.
    fn equation<'a>(&'a self, method: &M, h: S) -> Self::Equation<'a>;
}

/// Implements [`Implicit`] with the generic equations, for a system written by hand.
///
/// ```text
/// lie_runtime::generic_equations!([S: Scalar] Body<S>, S: midpoint, gauss4, exp);
/// ```
///
/// After the colon stand the equations: `midpoint`, `gauss4`, `gauss6`, `exp`, `cayley`;
/// `generating` (all orders with exp, and coordinates of the second kind; needs `exp` and
/// [`crate::Lift`]) and `generating_cayley` (needs `cayley` and [`crate::Lift`]), or one of them alone:
/// `generating2`, `generating4`, `generating6`, `second_kind`, `generating2_cayley`,
/// `generating4_cayley`; `discrete_gradients` (`gonzalez`, `mean_value`, `itoh_abe`), `orbit_energy` (along each
/// of them: `orbit_gonzalez`, `orbit_mean_value`, `orbit_itoh_abe`), `cohen_hairer` (`cohen_hairer2`,
/// `cohen_hairer4`, `cohen_hairer6`); `isospectral2`, `isospectral4`, `isospectral6` (also for `Collective`;
/// need [`crate::MatrixPoisson`]), `isospectral2_cayley` (needs `cayley` instead), `hopf` and `spherical`
/// (need [`crate::SpinPoisson`]), `moser_veselov` (the same with a diagonal quadratic H on so(3)) and
/// `moser_veselov_n` (needs [`crate::InertiaPoisson`]); `variational` (`variational2`, `variational4`,
/// `variational6`; need [`crate::LagrangianPoisson`], the last two also over [`crate::Lift::Lifted`]) and
/// `variational_cayley` (needs [`crate::CayleyPoisson`] too); `discrete` and `discrete_cayley` (need
/// [`crate::DiscreteLagrangianPoisson`]). And `splitting` implements
/// [`crate::SeparablePoisson`], for a Hamiltonian that is a sum of functions of one coordinate each.
#[macro_export]
macro_rules! generic_equations {
    ($generics:tt $system:ty, $scalar:ty: $($equation:ident),* $(,)?) => {
        $($crate::generic_equations!(@$equation $generics $system, $scalar);)*
    };
    (@midpoint $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [ImplicitMidpoint],
            $crate::generic::Midpoint<'a, $scalar, Self>
        );
    };
    (@gauss4 $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [Gauss4],
            $crate::generic::Gauss<'a, $scalar, Self, 2>
        );
    };
    (@gauss6 $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [Gauss6],
            $crate::generic::Gauss<'a, $scalar, Self, 3>
        );
    };
    (@exp $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [LieMidpoint<$crate::methods::Exp>],
            $crate::generic::ExpMidpoint<'a, $scalar, Self>
        );
    };
    (@cayley $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [LieMidpoint<$crate::methods::Cayley>],
            $crate::generic::CayleyMidpoint<'a, $scalar, Self>
        );
    };
    (@isospectral2 $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(@stages $generics $system, $scalar, 1);
    };
    (@isospectral4 $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(@stages $generics $system, $scalar, 2);
    };
    (@isospectral6 $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(@stages $generics $system, $scalar, 3);
    };
    (@stages $generics:tt $system:ty, $scalar:ty, $stages:literal) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [Isospectral<$stages>],
            $crate::generic::StageMomenta<
                'a, $scalar, Self,
                $crate::generic::MatrixStages<
                    $scalar, <Self as $crate::MatrixPoisson<$scalar>>::Matrix, $stages,
                >,
                $stages,
            >
        );
        $crate::generic_equations!(@collective $generics $system, $scalar, $stages);
    };
    // the same equation, fused or not
    (@collective [$($generics:tt)*] $system:ty, $scalar:ty, $stages:literal) => {
        $crate::generic_equations!(
            @as [$($generics)*] $system, $scalar,
            [Collective<$crate::methods::Representation, $stages>], [Isospectral<$stages>],
            $crate::methods::Isospectral::<$stages>::new()
        );
    };
    // with one stage over a closed representation: the retraction method with the Cayley map
    (@isospectral2_cayley [$($generics:tt)*] $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @as [$($generics)*] $system, $scalar,
            [Isospectral<1>], [LieMidpoint<$crate::methods::Cayley>],
            $crate::methods::LieMidpoint::cayley()
        );
        $crate::generic_equations!(@collective [$($generics)*] $system, $scalar, 1);
    };
    (@hopf $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!($generics $system, $scalar: hopf2, hopf4, hopf6);
    };
    (@hopf2 $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(@quaternions $generics $system, $scalar, 1);
    };
    (@hopf4 $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(@quaternions $generics $system, $scalar, 2);
    };
    (@hopf6 $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(@quaternions $generics $system, $scalar, 3);
    };
    (@quaternions $generics:tt $system:ty, $scalar:ty, $stages:literal) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [Collective<$crate::methods::Hopf, $stages>],
            $crate::generic::StageMomenta<
                'a, $scalar, Self, $crate::generic::QuaternionStages<$scalar, $stages>, $stages,
            >
        );
    };
    (@spherical $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [SphericalMidpoint],
            $crate::generic::Spherical<'a, $scalar, Self>
        );
    };
    (@moser_veselov $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [MoserVeselov],
            $crate::generic::DiscreteTop<'a, $scalar, Self>
        );
    };
    (@moser_veselov_n $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [MoserVeselov],
            $crate::generic::DiscreteBody<'a, $scalar, Self>
        );
    };
    (@variational $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            $generics $system, $scalar: variational2, variational4, variational6
        );
    };
    (@variational2 $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [Variational<$crate::methods::Exp, 2>],
            $crate::generic::ExpVariational<'a, $scalar, Self>
        );
    };
    (@variational4 $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [Variational<$crate::methods::Exp, 4>],
            $crate::generic::GalerkinStep<'a, $scalar, Self, 2>
        );
    };
    (@variational6 $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [Variational<$crate::methods::Exp, 6>],
            $crate::generic::GalerkinStep<'a, $scalar, Self, 3>
        );
    };
    (@variational_cayley $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [Variational<$crate::methods::Cayley, 2>],
            $crate::generic::CayleyVariational<'a, $scalar, Self>
        );
    };
    (@discrete $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [DiscreteEulerPoincare<$crate::methods::Exp>],
            $crate::generic::ExpVariational<
                'a, $scalar, Self, $crate::lagrangian::DeclaredDiscreteLagrangian<'a, $scalar, Self>,
            >
        );
    };
    (@discrete_cayley $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [DiscreteEulerPoincare<$crate::methods::Cayley>],
            $crate::generic::CayleyVariational<
                'a, $scalar, Self, $crate::lagrangian::DeclaredDiscreteLagrangian<'a, $scalar, Self>,
            >
        );
    };
    // the equation of another method
    (@as [$($generics:tt)*] $system:ty, $scalar:ty, [$($method:tt)*], [$($other:tt)*], $value:expr) => {
        impl<$($generics)*> $crate::Implicit<$scalar, $crate::methods::$($method)*> for $system {
            type Equation<'a> = <Self as $crate::Implicit<
                $scalar,
                $crate::methods::$($other)*,
            >>::Equation<'a> where Self: 'a;
            fn equation<'a>(
                &'a self,
                _method: &$crate::methods::$($method)*,
                h: $scalar,
            ) -> Self::Equation<'a> {
                <Self as $crate::Implicit<$scalar, $crate::methods::$($other)*>>::equation(self, &$value, h)
            }
        }
    };
    (@splitting [$($generics:tt)*] $system:ty, $scalar:ty) => {
        impl<$($generics)*> $crate::SeparablePoisson<$scalar> for $system {
            type Flows<'a> = $crate::generic::CoordinateFlows<'a, $scalar, Self> where Self: 'a;
            fn flows(&self) -> Self::Flows<'_> {
                $crate::generic::CoordinateFlows::new(self)
            }
        }
    };
    (@generating $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            $generics $system, $scalar: generating2, generating4, generating6, second_kind
        );
    };
    (@generating_cayley $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            $generics $system, $scalar: generating2_cayley, generating4_cayley
        );
    };
    (@generating2 $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(@same $generics $system, $scalar, Exp, exp);
    };
    (@generating2_cayley $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(@same $generics $system, $scalar, Cayley, cayley);
    };
    (@generating4 $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @function $generics $system, $scalar, [Generating<$crate::methods::Exp, 4>],
            ExpRetraction, Generating4
        );
    };
    (@generating6 $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @function $generics $system, $scalar, [Generating<$crate::methods::Exp, 6>],
            ExpRetraction, Generating6
        );
    };
    (@generating4_cayley $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @function $generics $system, $scalar, [Generating<$crate::methods::Cayley, 4>],
            CayleyRetraction, CayleyGenerating4
        );
    };
    (@second_kind $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [GeneratingSecondKind2],
            $crate::generic::SecondKind<
                'a, $scalar, Self, $crate::generic::SecondKind2<'a, $scalar, Self>,
            >
        );
    };
    // order 2 is the Lie–Poisson midpoint method, fused or not
    (@same [$($generics:tt)*] $system:ty, $scalar:ty, $retraction:ident, $constructor:ident) => {
        impl<$($generics)*>
            $crate::Implicit<$scalar, $crate::methods::Generating<$crate::methods::$retraction, 2>>
            for $system
        {
            type Equation<'a> = <Self as $crate::Implicit<
                $scalar,
                $crate::methods::LieMidpoint<$crate::methods::$retraction>,
            >>::Equation<'a> where Self: 'a;
            fn equation<'a>(
                &'a self,
                _method: &$crate::methods::Generating<$crate::methods::$retraction, 2>,
                h: $scalar,
            ) -> Self::Equation<'a> {
                $crate::Implicit::equation(self, &$crate::methods::LieMidpoint::$constructor(), h)
            }
        }
    };
    (
        @function [$($generics:tt)*] $system:ty, $scalar:ty, [$($method:tt)*],
        $equation:ident, $function:ident
    ) => {
        impl<$($generics)*> $crate::Implicit<$scalar, $crate::methods::$($method)*> for $system {
            type Equation<'a> = $crate::generic::$equation<
                'a, $scalar, Self, $crate::generic::$function<'a, $scalar, Self>,
            > where Self: 'a;
            fn equation<'a>(
                &'a self,
                _method: &$crate::methods::$($method)*,
                h: $scalar,
            ) -> Self::Equation<'a> {
                let function = $crate::generic::$function::new(self, h);
                $crate::generic::$equation::with_function(self, function, h)
            }
        }
    };
    (@discrete_gradients $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!($generics $system, $scalar: gonzalez, mean_value, itoh_abe);
    };
    (@orbit_energy $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            $generics $system, $scalar: orbit_gonzalez, orbit_mean_value, orbit_itoh_abe
        );
    };
    (@cohen_hairer $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            $generics $system, $scalar: cohen_hairer2, cohen_hairer4, cohen_hairer6
        );
    };
    (@gonzalez $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [Gonzalez],
            $crate::generic::DiscreteGradientStep<
                'a, $scalar, Self, $crate::generic::GonzalezGradient<$scalar, Self>
            >
        );
    };
    (@mean_value $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [MeanValue],
            $crate::generic::DiscreteGradientStep<
                'a, $scalar, Self, $crate::generic::MeanValueGradient<$scalar, Self>
            >
        );
    };
    (@itoh_abe $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [ItohAbe],
            $crate::generic::DiscreteGradientStep<
                'a, $scalar, Self, $crate::generic::ItohAbeGradient<$scalar, Self>
            >
        );
    };
    (@orbit_gonzalez $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [OrbitEnergy<$crate::methods::Gonzalez>],
            $crate::generic::OrbitEnergyStep<
                'a, $scalar, Self, $crate::generic::GonzalezGradient<$scalar, Self>
            >
        );
    };
    (@orbit_mean_value $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [OrbitEnergy<$crate::methods::MeanValue>],
            $crate::generic::OrbitEnergyStep<
                'a, $scalar, Self, $crate::generic::MeanValueGradient<$scalar, Self>
            >
        );
    };
    (@orbit_itoh_abe $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [OrbitEnergy<$crate::methods::ItohAbe>],
            $crate::generic::OrbitEnergyStep<
                'a, $scalar, Self, $crate::generic::ItohAbeGradient<$scalar, Self>
            >
        );
    };
    (@cohen_hairer2 $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [CohenHairer<1>],
            $crate::generic::CohenHairerStep<'a, $scalar, Self, 1>
        );
    };
    (@cohen_hairer4 $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [CohenHairer<2>],
            $crate::generic::CohenHairerStep<'a, $scalar, Self, 2>
        );
    };
    (@cohen_hairer6 $generics:tt $system:ty, $scalar:ty) => {
        $crate::generic_equations!(
            @impl $generics $system, $scalar, [CohenHairer<3>],
            $crate::generic::CohenHairerStep<'a, $scalar, Self, 3>
        );
    };
    (@impl [$($generics:tt)*] $system:ty, $scalar:ty, [$($method:tt)*], $equation:ty) => {
        impl<$($generics)*> $crate::Implicit<$scalar, $crate::methods::$($method)*> for $system {
            type Equation<'a> = $equation where Self: 'a;
            fn equation<'a>(
                &'a self,
                _method: &$crate::methods::$($method)*,
                h: $scalar,
            ) -> Self::Equation<'a> {
                Self::Equation::<'a>::new(self, h)
            }
        }
    };
}
