//! The generic equations for systems written by hand.

/// Makes [`generic_equations!`](crate::generic_equations) of the list of methods: an arm for each key.
macro_rules! by_key {
    (
        {$d:tt} choices $choices:tt
        $({ $title:literal $needs:tt $reference:tt
            $($choice:tt $type:tt $value:tt { $($particular:ident)? $([$key:ident $carrier:ident $($equation:tt)+])* })+
        })+
    ) => {
        /// Implements `Implicit` with the generic equations, for a system written by hand.
        ///
        /// ```text
        /// lie_runtime::generic_equations!([S: Scalar] Body<S>, S: midpoint, gauss4, exp);
        /// ```
        ///
        /// After the colon stand the equations: `midpoint`, `gauss4`, `gauss6`, `exp`, `cayley`;
        /// `generating` (all orders with exp, and coordinates of the second kind; needs `exp` and
        /// [`crate::Lift`]) and `generating_cayley` (needs `cayley` and [`crate::Lift`]), or one of them alone:
        /// `generating2`, `generating4`, `generating6`, `second_kind`, `generating2_cayley`,
        /// `generating4_cayley`; `discrete_gradients` (`gonzalez`, `mean_value`, `itoh_abe`), `orbit_energy` (along
        /// each of them: `orbit_gonzalez`, `orbit_mean_value`, `orbit_itoh_abe`; of other brackets `frozen_flow`: `frozen_gonzalez`,
        /// `frozen_mean_value`, `frozen_itoh_abe`), `k_hj` (`k_hj2`, and `k_hj4` and `k_hj6`, which need [`crate::Lift`];
        /// of an algebra `k_hj_along_exp`, which needs `exp` and `generating`), `canonical` (`canonical2`, `canonical4`, `canonical6`; need
        /// [`crate::CanonicalPoisson`]), `cohen_hairer` (`cohen_hairer2`,
        /// `cohen_hairer4`, `cohen_hairer6`); `isospectral2`, `isospectral4`, `isospectral6` (also for `Collective`;
        /// need [`crate::MatrixPoisson`]), `isospectral2_cayley` (needs `cayley` instead), `hopf` and `spherical`
        /// (need [`crate::SpinPoisson`]), `moser_veselov` (the same with a quadratic H on so(3)) and
        /// `moser_veselov_n` (needs [`crate::InertiaPoisson`]); `variational` (`variational2`, `variational4`,
        /// `variational6`; need [`crate::LagrangianPoisson`], the last two also over [`crate::Lift::Lifted`]) and
        /// `variational_cayley` (needs [`crate::CayleyPoisson`] too) and `variational2_declared` (needs `retraction`); in phase space, with forces, the time and the group element,
        /// `variational2_on_group`, `variational4_on_group`, `variational6_on_group` (need [`crate::CotangentPoisson`]) and
        /// `variational2_cayley`, `variational4_cayley`, `variational6_cayley` (need [`crate::CayleyPoisson`] too); `discrete` and `discrete_cayley` (need
        /// [`crate::DiscreteLagrangianPoisson`]). `splitting` implements
        /// [`crate::SeparablePoisson`] and [`crate::FoundPoisson`], for a Hamiltonian that is a sum of functions of one
        /// coordinate each, `coordinate_splitting` the first alone; `taylor` and
        /// `lie_taylor` implement [`crate::Series`] and [`crate::GradientSeries`] (need [`crate::Expand`]).
        #[macro_export]
        macro_rules! generic_equations {
            ($d generics:tt $d system:ty, $d scalar:ty: $d($d equation:ident),* $d(,)?) => {
                $d($crate::generic_equations!(@$d equation $d generics $d system, $d scalar);)*
            };
            $($($(
                (@$key $d generics:tt $d system:ty, $d scalar:ty) => {
                    $crate::generic_equation!($d generics $d system, $d scalar, $type, $($equation)+);
                };
            )*)+)+
            (@generating $d($d rest:tt)*) => {
                $crate::generic_equations!(@@generating2 generating4 generating6 second_kind; $d($d rest)*);
            };
            (@generating_cayley $d($d rest:tt)*) => {
                $crate::generic_equations!(@@generating2_cayley generating4_cayley; $d($d rest)*);
            };
            (@discrete_gradients $d($d rest:tt)*) => {
                $crate::generic_equations!(@@gonzalez mean_value itoh_abe; $d($d rest)*);
            };
            (@orbit_energy $d($d rest:tt)*) => {
                $crate::generic_equations!(@@orbit_gonzalez orbit_mean_value orbit_itoh_abe; $d($d rest)*);
            };
            (@frozen_flow $d($d rest:tt)*) => {
                $crate::generic_equations!(@@frozen_gonzalez frozen_mean_value frozen_itoh_abe; $d($d rest)*);
            };
            (@k_hj $d($d rest:tt)*) => {
                $crate::generic_equations!(@@k_hj2 k_hj4 k_hj6; $d($d rest)*);
            };
            (@k_hj_along_exp $d($d rest:tt)*) => {
                $crate::generic_equations!(@@k_hj2_along_exp k_hj4_along_exp k_hj6_along_exp; $d($d rest)*);
            };
            (@canonical $d($d rest:tt)*) => {
                $crate::generic_equations!(@@canonical2 canonical4 canonical6; $d($d rest)*);
            };
            (@cohen_hairer $d($d rest:tt)*) => {
                $crate::generic_equations!(@@cohen_hairer2 cohen_hairer4 cohen_hairer6; $d($d rest)*);
            };
            (@isospectral2 $d($d rest:tt)*) => {
                $crate::generic_equations!(@@momenta2 collective2; $d($d rest)*);
            };
            (@isospectral4 $d($d rest:tt)*) => {
                $crate::generic_equations!(@@momenta4 collective4; $d($d rest)*);
            };
            (@isospectral6 $d($d rest:tt)*) => {
                $crate::generic_equations!(@@momenta6 collective6; $d($d rest)*);
            };
            (@isospectral2_cayley $d($d rest:tt)*) => {
                $crate::generic_equations!(@@momenta2_cayley collective2; $d($d rest)*);
            };
            (@hopf $d($d rest:tt)*) => {
                $crate::generic_equations!(@@hopf2 hopf4 hopf6; $d($d rest)*);
            };
            (@variational $d($d rest:tt)*) => {
                $crate::generic_equations!(@@variational2 variational4 variational6; $d($d rest)*);
            };
            (@@$d($d equation:ident)+; $d generics:tt $d system:ty, $d scalar:ty) => {
                $d($crate::generic_equations!(@$d equation $d generics $d system, $d scalar);)+
            };
            (@splitting $d generics:tt $d system:ty, $d scalar:ty) => {
                $crate::generic_equations!(@coordinate_splitting $d generics $d system, $d scalar);
                $crate::generic_equation!(@found $d generics $d system, $d scalar);
            };
            (@coordinate_splitting $d generics:tt $d system:ty, $d scalar:ty) => {
                $crate::generic_equation!(
                    @of_system $d generics $d system, $d scalar, SeparablePoisson, Flows, flows,
                    $crate::generic::CoordinateFlows<'a, $d scalar, Self>
                );
            };
            (@taylor $d generics:tt $d system:ty, $d scalar:ty) => {
                $crate::generic_equation!(
                    @of_system $d generics $d system, $d scalar, Series, Recurrence, series,
                    $crate::generic::PowerSeries<$d scalar, Self>
                );
            };
            (@lie_taylor $d generics:tt $d system:ty, $d scalar:ty) => {
                $crate::generic_equation!(
                    @of_system $d generics $d system, $d scalar, GradientSeries, Recurrence, gradient_series,
                    $crate::generic::PowerSeries<$d scalar, Self>
                );
            };
        }
    };
}
crate::for_each_method!(by_key! { $ });

/// One generic equation, as the list of methods has it.
#[doc(hidden)]
#[macro_export]
macro_rules! generic_equation {
    // that of the method of another type
    (
        [$($generics:tt)*] $system:ty, $scalar:ty, [$($method:tt)+],
        same $other:ident $(<$($argument:ident),+>)?
    ) => {
        $crate::generic_equation!(
            @impl [$($generics)*] $system, $scalar, [$($method)+], self, h,
            <Self as $crate::Implicit<
                $scalar, $crate::methods::$other $(<$($crate::methods::$argument),+>)?,
            >>::Equation<'a>,
            $crate::Implicit::equation(
                self,
                &<$crate::methods::$other $(<$($crate::methods::$argument),+>)? as ::core::default::Default>::default(),
                h,
            )
        );
    };
    (
        [$($generics:tt)*] $system:ty, $scalar:ty, [$($method:tt)+],
        $equation:ident along $function:ident
    ) => {
        $crate::generic_equation!(
            @impl [$($generics)*] $system, $scalar, [$($method)+], self, h,
            $crate::generic::$equation<
                'a, $scalar, Self, $crate::generic::$function<'a, $scalar, Self>,
            >,
            $crate::generic::$equation::with_function(
                self, $crate::generic::$function::new(self, h), h,
            )
        );
    };
    (
        [$($generics:tt)*] $system:ty, $scalar:ty, [$($method:tt)+],
        $equation:ident $($stages:literal)? $(of $gradient:ident)?
    ) => {
        $crate::generic_equation!(
            @impl [$($generics)*] $system, $scalar, [$($method)+], self, h,
            $crate::generic::$equation<
                'a, $scalar, Self $(, $stages)? $(, $crate::generic::$gradient<$scalar, Self>)?
            >,
            Self::Equation::<'a>::new(self, h)
        );
    };
    (
        @impl [$($generics:tt)*] $system:ty, $scalar:ty, [$method:ident $(<$($argument:ident),+>)?],
        $self:ident, $h:ident, $equation:ty, $value:expr
    ) => {
        impl<$($generics)*>
            $crate::Implicit<$scalar, $crate::methods::$method $(<$($crate::methods::$argument),+>)?>
            for $system
        {
            type Equation<'a> = $equation where Self: 'a;
            fn equation<'a>(
                &'a $self,
                _method: &$crate::methods::$method $(<$($crate::methods::$argument),+>)?,
                $h: $scalar,
            ) -> Self::Equation<'a> {
                $value
            }
        }
    };
    // the pieces of one coordinate each, and what acts beside them
    (@found [$($generics:tt)*] $system:ty, $scalar:ty) => {
        impl<$($generics)*> $crate::FoundPoisson<$scalar> for $system {
            type Found<'a>
                = $crate::generic::DrivenFlows<
                    'a, Self, $crate::generic::CoordinateFlows<'a, $scalar, Self>,
                    <Self as $crate::Poisson<$scalar>>::State,
                >
            where
                Self: 'a;
            fn found(&self) -> Self::Found<'_> {
                let flows = $crate::generic::CoordinateFlows::new(self);
                $crate::generic::DrivenFlows::new(self, flows)
            }
        }
    };
    // what a system has for methods of every order
    (
        @of_system [$($generics:tt)*] $system:ty, $scalar:ty, $trait:ident, $type:ident, $function:ident,
        $value:ty
    ) => {
        impl<$($generics)*> $crate::$trait<$scalar> for $system {
            type $type<'a> = $value where Self: 'a;
            fn $function(&self) -> Self::$type<'_> {
                <<Self as $crate::$trait<$scalar>>::$type<'_>>::new(self)
            }
        }
    };
}
