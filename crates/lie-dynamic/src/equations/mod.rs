//! Which equation each implicit method of the list has over systems made at run time: the generic one, as the plan has it.
//! The parts that a plan may replace stand beside: fused equations, eliminations, generating functions and discrete gradients.

mod generating;
mod gradient;
mod planned;

use crate::system::Dynamic;
use lie_codegen::methods::{Choice, Gradient, Lift, Retraction, Tensor};
use lie_codegen::plan::Solver;
use lie_core::generic;
use lie_runtime::methods as m;
use lie_runtime::{Equation, Implicit, Scalar};
use planned::Planned;

macro_rules! equations {
    (
        {} choices $choices:tt
        $({ $title:literal $needs:tt $reference:tt
            $($choice:tt $type:tt $value:tt { $($particular:ident)? $([$($equation:tt)+])* })+
        })+
    ) => {
        $($(equations!(@row $choice $type $([$($equation)+])*);)+)+
    };
    (@row $choice:tt $type:tt) => {};
    (@row $choice:tt $type:tt [$key:ident $carrier:ident same $($other:tt)+]) => {
        lie_core::generic_equation!([S: Scalar] Dynamic<S>, S, $type, same $($other)+);
    };
    // in three dimensions or in more
    (@row $choice:tt $type:tt [$three:ident Body $first:ident] [$many:ident BodyOfMany $second:ident]) => {
        equations!(
            @impl $choice $type self h,
            generic::$first<'a, S, Self>,
            match self.values.compiled.structure.is_body_of_many() {
                false => Box::new(generic::$first::new(self, h)),
                true => Box::new(generic::$second::new(self, h)),
            }
        );
    };
    // beside the group element or the time the method is another one
    (
        @row $choice:tt [$name:ident<Exp>] $equation:tt
        [$key:ident LagrangianOnGroup $($other:tt)+]
    ) => {
        equations!(@row $choice [$name<Exp>] $equation);
        equations!(@row $choice [$name<OnGroup>] [$key LagrangianOnGroup $($other)+]);
    };
    (
        @row $choice:tt [$name:ident<Cayley>] $equation:tt
        [$key:ident ClosedLagrangianOnGroup $($other:tt)+]
    ) => {
        equations!(@row $choice [$name<Cayley>] $equation);
        equations!(@row $choice [$name<CayleyOnGroup>] [$key ClosedLagrangianOnGroup $($other)+]);
    };
    // over a closed representation the method is another one
    (@row $choice:tt $type:tt $equation:tt [$key:ident Closed same $($other:tt)+]) => {
        equations!(@row $choice $type $equation);
    };
    // collocation with mean gradients is Gauss collocation where H is quadratic
    (@row [$($choice:tt)+] $type:tt [$key:ident $carrier:ident CohenHairerStep $stages:literal]) => {
        equations!(
            @impl [$($choice)+] $type self h,
            generic::CohenHairerStep<'a, S, Self, $stages>,
            match self.values.compiled.solvers.get(&Choice::$($choice)+) {
                Some(Solver::Generic(partner) | Solver::Eliminated(partner, _))
                    if partner.choice() == Some(&Choice::Gauss($stages)) =>
                {
                    Box::new(<generic::Gauss<'_, S, Self, $stages>>::new(self, h))
                }
                _ => Box::new(<generic::CohenHairerStep<'_, S, Self, $stages>>::new(self, h)),
            }
        );
    };
    // the gradient may have a closed form in the plan; other brackets than those of algebras have another motion
    (
        @row $choice:tt $type:tt
        [$key:ident Algebra OrbitEnergyStep of $gradient:ident] [$other:ident Any FrozenStep of $same:ident]
    ) => {
        equations!(
            @impl $choice $type self h,
            generic::OrbitEnergyStep<'a, S, Self, gradient::Planned<S, generic::$gradient<S, Self>>>,
            match self.values.compiled.plan.system.lie {
                true => Box::new(generic::OrbitEnergyStep::<
                    '_, S, Self, gradient::Planned<S, generic::$gradient<S, Self>>,
                >::new(self, h)),
                false => Box::new(generic::FrozenStep::<
                    '_, S, Self, gradient::Planned<S, generic::$gradient<S, Self>>,
                >::new(self, h)),
            }
        );
    };
    // of an algebra the method is another one
    (
        @row [$($choice:tt)+] [$name:ident]
        [$key:ident Algebra same $other:ident<$argument:ident>] [$any:ident Any $equation:ident along $function:ident]
    ) => {
        impl<S: Scalar> Implicit<S, m::$name> for Dynamic<S> {
            type Equation<'a>
                = <Self as Implicit<S, m::$other<m::$argument>>>::Equation<'a>
            where
                Self: 'a;
            fn equation<'a>(&'a self, _method: &m::$name, h: S) -> Self::Equation<'a> {
                if self.values.compiled.plan.system.lie {
                    return self.equation(&m::$other::<m::$argument>::default(), h);
                }
                let function = generic::$function::new(self, h);
                let function = generating::Planned::new(self, stringify!($function), h, function);
                let equation = generic::$equation::with_function(self, function, h);
                Planned::new(self, &Choice::$($choice)+, h, Box::new(equation))
            }
        }
    };
    (@row $choice:tt $type:tt [$key:ident $carrier:ident $equation:ident along $function:ident]) => {
        equations!(
            @impl $choice $type self h,
            generic::$equation<
                'a, S, Self, generating::Planned<'a, S, generic::$function<'a, S, Self>>,
            >,
            {
                let function = generic::$function::new(self, h);
                let function = generating::Planned::new(self, stringify!($function), h, function);
                Box::new(generic::$equation::with_function(self, function, h))
            }
        );
    };
    (
        @row $choice:tt $type:tt
        [$key:ident $carrier:ident $equation:ident $($stages:literal)? $(of $gradient:ident)?]
    ) => {
        equations!(
            @impl $choice $type self h,
            generic::$equation<'a, S, Self $(, $stages)? $(, generic::$gradient<S, Self>)?>,
            Box::new(
                <generic::$equation<S, Self $(, $stages)? $(, generic::$gradient<S, Self>)?>>::new(self, h)
            )
        );
    };
    (
        @impl [$($choice:tt)+] [$name:ident $(<$($argument:ident),+>)?] $self:ident $h:ident,
        $equation:ty, $value:expr
    ) => {
        impl<S: Scalar> Implicit<S, m::$name $(<$(m::$argument),+>)?> for Dynamic<S> {
            type Equation<'a>
                = Planned<
                    'a, S, <$equation as Equation<S>>::Unknown, <$equation as Equation<S>>::Matrix,
                >
            where
                Self: 'a;
            fn equation<'a>(
                &'a $self,
                _method: &m::$name $(<$(m::$argument),+>)?,
                $h: S,
            ) -> Self::Equation<'a> {
                Planned::new($self, &Choice::$($choice)+, $h, $value)
            }
        }
    };
}
lie_core::for_each_method!(equations! {});
