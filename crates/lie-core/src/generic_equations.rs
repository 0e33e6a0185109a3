//! The generic equations for systems written by hand.

/// Implements [`Implicit`](crate::Implicit) with the generic equations, for a system written by hand.
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
/// [`crate::DiscreteLagrangianPoisson`]). `splitting` implements
/// [`crate::SeparablePoisson`] and [`crate::FoundPoisson`], for a Hamiltonian that is a sum of functions of one coordinate
/// each, `coordinate_splitting` the first alone; `taylor` and
/// `lie_taylor` implement [`crate::Series`] and [`crate::GradientSeries`] (need [`crate::Expand`]).
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
    (@taylor [$($generics:tt)*] $system:ty, $scalar:ty) => {
        impl<$($generics)*> $crate::Series<$scalar> for $system {
            type Recurrence<'a> = $crate::generic::PowerSeries<$scalar, Self> where Self: 'a;
            fn series(&self) -> Self::Recurrence<'_> {
                $crate::generic::PowerSeries::new(self)
            }
        }
    };
    (@lie_taylor [$($generics:tt)*] $system:ty, $scalar:ty) => {
        impl<$($generics)*> $crate::GradientSeries<$scalar> for $system {
            type Recurrence<'a> = $crate::generic::PowerSeries<$scalar, Self> where Self: 'a;
            fn gradient_series(&self) -> Self::Recurrence<'_> {
                $crate::generic::PowerSeries::new(self)
            }
        }
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
        $crate::generic_equations!(@coordinate_splitting [$($generics)*] $system, $scalar);
        impl<$($generics)*> $crate::FoundPoisson<$scalar> for $system {
            type Found<'a> = $crate::generic::CoordinateFlows<'a, $scalar, Self> where Self: 'a;
            fn found(&self) -> Self::Found<'_> {
                $crate::generic::CoordinateFlows::new(self)
            }
        }
    };
    (@coordinate_splitting [$($generics:tt)*] $system:ty, $scalar:ty) => {
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
