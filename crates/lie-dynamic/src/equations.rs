//! Which equation each implicit method has over systems made at run time.

use crate::either::Either;
use crate::equation::Planned;
use crate::generating;
use crate::gradient;
use crate::straight::{Recorded, write};
use crate::system::Dynamic;
use lie_codegen::methods::{Choice, Gradient, Lift, Retraction, Tensor};
use lie_codegen::plan::{Partner, Solver};
use lie_core::family::LateMatrix;
use lie_core::generic;
use lie_runtime::methods as m;
use lie_runtime::{Implicit, Scalar};

/// How something of the equation of a method is written down.
macro_rules! written {
    ($method:ty) => {
        |system, h, what| {
            let equation =
                Implicit::<Recorded, $method>::equation(system, &<$method>::default(), h);
            write(equation, system, what)
        }
    };
}

/// The equation of a method: its type, its row in the catalogue, the generic equation.
macro_rules! planned {
    ($($method:ty, $choice:expr, $generic:ty;)+) => {
        $(
            impl<S: Scalar> Implicit<S, $method> for Dynamic<S> {
                type Equation<'a> = Planned<'a, S, $generic> where Self: 'a;
                fn equation<'a>(&'a self, _method: &$method, h: S) -> Self::Equation<'a> {
                    Planned::new(self, &$choice, h, <$generic>::new(self, h), written!($method))
                }
            }
        )+
    };
}

planned! {
    m::ImplicitMidpoint, Choice::Midpoint, generic::Midpoint<'a, S, Self>;
    m::Gauss4, Choice::Gauss(2), generic::Gauss<'a, S, Self, 2>;
    m::Gauss6, Choice::Gauss(3), generic::Gauss<'a, S, Self, 3>;
    m::LieMidpoint<m::Exp>, Choice::LieMidpoint(Retraction::Exp), generic::ExpMidpoint<'a, S, Self>;
    m::LieMidpoint<m::Cayley>, Choice::LieMidpoint(Retraction::Cayley), generic::CayleyMidpoint<'a, S, Self>;
    m::Gonzalez, Choice::DiscreteGradient(Gradient::Gonzalez, Tensor::Midpoint),
        generic::DiscreteGradientStep<'a, S, Self, generic::GonzalezGradient<S, Self>>;
    m::MeanValue, Choice::DiscreteGradient(Gradient::MeanValue, Tensor::Midpoint),
        generic::DiscreteGradientStep<'a, S, Self, generic::MeanValueGradient<S, Self>>;
    m::ItohAbe, Choice::DiscreteGradient(Gradient::ItohAbe, Tensor::Midpoint),
        generic::DiscreteGradientStep<'a, S, Self, generic::ItohAbeGradient<S, Self>>;
    m::SphericalMidpoint, Choice::SphericalMidpoint, generic::Spherical<'a, S, Self>;
}

/// Energy-preserving collocation, which is Gauss collocation where H is quadratic.
macro_rules! cohen_hairer {
    ($($stages:literal)+) => {
        $(
            impl<S: Scalar> Implicit<S, m::CohenHairer<$stages>> for Dynamic<S> {
                type Equation<'a> = Planned<'a, S, Either<
                    generic::CohenHairerStep<'a, S, Self, $stages>, generic::Gauss<'a, S, Self, $stages>,
                >> where Self: 'a;
                fn equation<'a>(&'a self, _method: &m::CohenHairer<$stages>, h: S) -> Self::Equation<'a> {
                    let choice = Choice::CohenHairer(2 * $stages);
                    let solver = self.values.compiled.solvers.get(&choice);
                    let equation = match solver {
                        Some(Solver::Generic(Partner::Gauss(_)) | Solver::Eliminated(Partner::Gauss(_), _)) => {
                            Either::Second(generic::Gauss::new(self, h))
                        }
                        _ => Either::First(generic::CohenHairerStep::new(self, h)),
                    };
                    Planned::new(self, &choice, h, equation, written!(m::CohenHairer<$stages>))
                }
            }
        )+
    };
}
cohen_hairer!(2 3);

/// With one stage it is the method of the mean value gradient.
impl<S: Scalar> Implicit<S, m::CohenHairer<1>> for Dynamic<S> {
    type Equation<'a>
        = <Self as Implicit<S, m::MeanValue>>::Equation<'a>
    where
        Self: 'a;
    fn equation<'a>(&'a self, _method: &m::CohenHairer<1>, h: S) -> Self::Equation<'a> {
        let equation = generic::DiscreteGradientStep::new(self, h);
        let choice = Choice::CohenHairer(2);
        Planned::new(self, &choice, h, equation, written!(m::CohenHairer<1>))
    }
}

/// Order 2 is the Lie–Poisson midpoint method.
macro_rules! same {
    ($($retraction:ident $constructor:ident)+) => {
        $(
            impl<S: Scalar> Implicit<S, m::Generating<m::$retraction, 2>> for Dynamic<S> {
                type Equation<'a> = <Self as Implicit<S, m::LieMidpoint<m::$retraction>>>::Equation<'a> where Self: 'a;
                fn equation<'a>(&'a self, _method: &m::Generating<m::$retraction, 2>, h: S) -> Self::Equation<'a> {
                    Implicit::equation(self, &m::LieMidpoint::$constructor(), h)
                }
            }
        )+
    };
}
same!(Exp exp Cayley cayley);

/// Along a generating function of the plan.
macro_rules! along {
    ($($retraction:ident $order:literal $equation:ident $function:ident $suffix:literal;)+) => {
        $(
            impl<S: Scalar> Implicit<S, m::Generating<m::$retraction, $order>> for Dynamic<S> {
                type Equation<'a> = Planned<'a, S, generic::$equation<
                    'a, S, Self, generating::Planned<'a, S, generic::$function<'a, S, Self>>,
                >> where Self: 'a;
                fn equation<'a>(&'a self, _method: &m::Generating<m::$retraction, $order>, h: S) -> Self::Equation<'a> {
                    let function = generic::$function::new(self, h);
                    let function = generating::Planned::new(self, $suffix, h, function);
                    let equation = generic::$equation::with_function(self, function, h);
                    let choice = Choice::Generating($order, Retraction::$retraction);
                    Planned::new(self, &choice, h, equation, written!(m::Generating<m::$retraction, $order>))
                }
            }
        )+
    };
}
along! {
    Exp 4 ExpRetraction Generating4 "Generating4";
    Exp 6 ExpRetraction Generating6 "Generating6";
    Cayley 4 CayleyRetraction CayleyGenerating4 "CayleyGenerating4";
}

/// Momenta at stages over a map.
macro_rules! stages {
    ($($stages:literal $order:literal)+) => {
        $(
            impl<S: Scalar> Implicit<S, m::Isospectral<$stages>> for Dynamic<S> {
                type Equation<'a> = Planned<'a, S, generic::StageMomenta<
                    'a, S, Self, generic::MatrixStages<S, LateMatrix<S>, $stages>, $stages,
                >> where Self: 'a;
                fn equation<'a>(&'a self, _method: &m::Isospectral<$stages>, h: S) -> Self::Equation<'a> {
                    let equation = generic::StageMomenta::new(self, h);
                    let choice = Choice::Isospectral($order);
                    Planned::new(self, &choice, h, equation, written!(m::Isospectral<$stages>))
                }
            }

            impl<S: Scalar> Implicit<S, m::Collective<m::Representation, $stages>> for Dynamic<S> {
                type Equation<'a> = <Self as Implicit<S, m::Isospectral<$stages>>>::Equation<'a> where Self: 'a;
                fn equation<'a>(&'a self, _method: &m::Collective<m::Representation, $stages>, h: S) -> Self::Equation<'a> {
                    Implicit::equation(self, &m::Isospectral::<$stages>::new(), h)
                }
            }

            impl<S: Scalar> Implicit<S, m::Collective<m::Hopf, $stages>> for Dynamic<S> {
                type Equation<'a> = Planned<'a, S, generic::StageMomenta<
                    'a, S, Self, generic::QuaternionStages<S, $stages>, $stages,
                >> where Self: 'a;
                fn equation<'a>(&'a self, _method: &m::Collective<m::Hopf, $stages>, h: S) -> Self::Equation<'a> {
                    let equation = generic::StageMomenta::new(self, h);
                    let choice = Choice::Collective($order, Lift::Hopf);
                    Planned::new(self, &choice, h, equation, written!(m::Collective<m::Hopf, $stages>))
                }
            }
        )+
    };
}
stages!(1 2 2 4 3 6);

/// Along a discrete gradient.
macro_rules! orbit_energy {
    ($($gradient:ident)+) => {
        $(
            impl<S: Scalar> Implicit<S, m::OrbitEnergy<m::$gradient>> for Dynamic<S> {
                type Equation<'a> = Planned<'a, S, generic::OrbitEnergyStep<
                    'a, S, Self, gradient::Planned<S, m::$gradient>,
                >> where Self: 'a;
                fn equation<'a>(&'a self, _method: &m::OrbitEnergy<m::$gradient>, h: S) -> Self::Equation<'a> {
                    let equation = generic::OrbitEnergyStep::new(self, h);
                    let choice = Choice::OrbitEnergy(Gradient::$gradient);
                    Planned::new(self, &choice, h, equation, written!(m::OrbitEnergy<m::$gradient>))
                }
            }
        )+
    };
}
orbit_energy!(Gonzalez MeanValue ItohAbe);

impl<S: Scalar> Implicit<S, m::MoserVeselov> for Dynamic<S> {
    type Equation<'a>
        = Planned<
        'a,
        S,
        Either<generic::DiscreteTop<'a, S, Self>, generic::DiscreteBody<'a, S, Self>>,
    >
    where
        Self: 'a;
    fn equation<'a>(&'a self, _method: &m::MoserVeselov, h: S) -> Self::Equation<'a> {
        let equation = match self.values.compiled.structure.is_body_of_many() {
            false => Either::First(generic::DiscreteTop::new(self, h)),
            true => Either::Second(generic::DiscreteBody::new(self, h)),
        };
        let choice = Choice::MoserVeselov;
        Planned::new(self, &choice, h, equation, written!(m::MoserVeselov))
    }
}

impl<S: Scalar> Implicit<S, m::GeneratingSecondKind2> for Dynamic<S> {
    type Equation<'a>
        = Planned<
        'a,
        S,
        generic::SecondKind<
            'a,
            S,
            Self,
            generating::Planned<'a, S, generic::SecondKind2<'a, S, Self>>,
        >,
    >
    where
        Self: 'a;
    fn equation<'a>(&'a self, _method: &m::GeneratingSecondKind2, h: S) -> Self::Equation<'a> {
        let function = generic::SecondKind2::new(self, h);
        let function = generating::Planned::new(self, "SecondKind2", h, function);
        let equation = generic::SecondKind::with_function(self, function);
        let choice = Choice::GeneratingSecondKind2;
        Planned::new(
            self,
            &choice,
            h,
            equation,
            written!(m::GeneratingSecondKind2),
        )
    }
}
