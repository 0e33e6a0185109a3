//! The methods of the catalogue over systems made at run time.

use crate::straight::Straight;
use crate::system::Dynamic;
use lie_codegen::methods::{Choice, Gradient, Lift, Pieces, Retraction, Scheme, Tensor};
use lie_codegen::structure::lifts::Smallest;
use lie_runtime::diagnostics::{AnyMethod, AnyStepper, Claims, Forgotten, ForgottenStepper};
use lie_runtime::methods::{self as m, Facts, Preserves};
use lie_runtime::newton::NewtonOptions;
use lie_runtime::{Dual, Scalar};

/// Tolerances of adaptive methods.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Relative tolerance.
    pub rtol: f64,
    /// Absolute tolerance.
    pub atol: f64,
}

impl Default for Tolerances {
    fn default() -> Self {
        Self {
            rtol: 1e-6,
            atol: 1e-9,
        }
    }
}

/// A method whose type is forgotten.
pub type Method<S = f64> = Box<dyn AnyMethod<S, Dynamic<S>>>;

/// A symmetric method of order 2 as the base of compositions.
struct Base<S: Scalar>(Method<S>);

impl<S: Scalar> Facts for Base<S> {
    const ID: &'static str = "";
    const ORDER: u32 = 2;
    const SYMMETRIC: bool = true;
    const EXPLICIT: bool = false;
    const PRESERVES: Preserves = Preserves::NOTHING;
}

impl<S: Scalar> m::Method<S, Dynamic<S>> for Base<S> {
    type Stepper<'a> = ForgottenStepper<'a, Vec<S>, S>;

    fn stepper<'a>(
        &self,
        system: &'a Dynamic<S>,
        h: S,
        newton: &NewtonOptions,
    ) -> Self::Stepper<'a> {
        Forgotten(self.0.as_ref()).stepper(system, h, newton)
    }
}

/// Which method steps of a system are made by.
type Choose<S> = dyn Fn(&Dynamic<S>) -> Method<S>;

/// A method that claims what another does: a composition of its base, or one of several by the system.
struct Claiming<S: Scalar> {
    claims: Claims,
    choose: Box<Choose<S>>,
}

impl<S: Scalar> AnyMethod<S, Dynamic<S>> for Claiming<S> {
    fn claims(&self) -> Claims {
        self.claims
    }

    fn any_stepper<'a>(
        &self,
        system: &'a Dynamic<S>,
        h: S,
        newton: &NewtonOptions,
    ) -> Box<dyn AnyStepper<S, Vec<S>> + 'a> {
        (self.choose)(system).any_stepper(system, h, newton)
    }
}

pub(crate) fn boxed<S: Scalar, M: m::Method<S, Dynamic<S>> + 'static>(
    method: M,
) -> Option<Method<S>> {
    Some(Box::new(method))
}

fn scheme_of(scheme: Scheme) -> m::Scheme {
    match scheme {
        Scheme::Suzuki => m::Scheme::Suzuki,
        Scheme::TripleJump => m::Scheme::TripleJump,
        Scheme::Yoshida => m::Scheme::Yoshida,
        Scheme::KahanLi => m::Scheme::KahanLi,
        Scheme::SuzukiUmeno => m::Scheme::SuzukiUmeno,
        Scheme::BlanesMoan => m::Scheme::BlanesMoan,
        Scheme::Strang => m::Scheme::Strang,
        Scheme::Saba2 => m::Scheme::Saba2,
        Scheme::Saba4 => m::Scheme::Saba4,
        Scheme::Sbab2 => m::Scheme::Sbab2,
        Scheme::Sbab4 => m::Scheme::Sbab4,
        Scheme::McLachlan84 => m::Scheme::McLachlan84,
    }
}

/// The method of a choice with its own defaults: series at the tolerance at which they are exact on every grid.
pub fn at_defaults(choice: &Choice) -> Option<Method> {
    match choice {
        Choice::Taylor | Choice::LieTaylor => at_defaults_over(choice),
        other => method(other, Tolerances::default()),
    }
}

/// The same over dual numbers.
pub fn at_defaults_dual(choice: &Choice) -> Option<Method<Dual<f64>>> {
    at_defaults_over(choice)
}

/// The same over any scalar.
fn at_defaults_over<S: Scalar>(choice: &Choice) -> Option<Method<S>> {
    match choice {
        Choice::Taylor => boxed(m::Taylor::default()),
        Choice::LieTaylor => boxed(m::LieTaylor::default()),
        other => method_over(other, Tolerances::default()),
    }
}

/// The method of a choice; none where it needs what systems made at run time do not have yet. Whether it applies to a system is
/// for the catalogue to say.
///
/// Of double precision, so that all methods are compiled once, here, and not with every crate that asks for one.
pub fn method(choice: &Choice, tolerances: Tolerances) -> Option<Method> {
    match explicit(choice) {
        Some(apart) => Some(Box::new(Straight::patient(choice, apart))),
        None => method_over(choice, tolerances),
    }
}

/// The same over dual numbers, for tangents of steps.
pub fn method_dual(choice: &Choice, tolerances: Tolerances) -> Option<Method<Dual<f64>>> {
    method_over(choice, tolerances)
}

/// The same over any scalar.
pub(crate) fn method_over<S: Scalar>(choice: &Choice, tolerances: Tolerances) -> Option<Method<S>> {
    match choice {
        Choice::Midpoint => boxed(m::ImplicitMidpoint),
        Choice::Gauss(stages) => gauss(*stages),
        Choice::LieMidpoint(Retraction::Exp) => boxed(m::LieMidpoint::exp()),
        Choice::LieMidpoint(Retraction::Cayley) => boxed(m::LieMidpoint::cayley()),
        Choice::MoserVeselov => boxed(m::MoserVeselov),
        Choice::Compose(order, scheme, base) => compose(*order, *scheme, base, move |base| {
            method_over(base, tolerances)
        }),
        Choice::Generating(2, Retraction::Exp) => boxed(m::Generating2::exp()),
        Choice::Generating(4, Retraction::Exp) => boxed(m::Generating4::exp()),
        Choice::Generating(6, Retraction::Exp) => boxed(m::Generating6::exp()),
        Choice::Generating(2, Retraction::Cayley) => boxed(m::Generating2::cayley()),
        Choice::Generating(4, Retraction::Cayley) => boxed(m::Generating4::cayley()),
        Choice::GeneratingSecondKind2 => boxed(m::GeneratingSecondKind2),
        Choice::Collective(order, lift) => collective(*order, *lift),
        Choice::Isospectral(order) => isospectral(*order),
        Choice::SphericalMidpoint => boxed(m::SphericalMidpoint),
        Choice::DiscreteGradient(gradient, Tensor::Midpoint) => match gradient {
            Gradient::Gonzalez => boxed(m::Gonzalez),
            Gradient::MeanValue => boxed(m::MeanValue),
            Gradient::ItohAbe => boxed(m::ItohAbe),
        },
        Choice::OrbitEnergy(gradient) => match gradient {
            Gradient::Gonzalez => boxed(m::OrbitEnergy::gonzalez()),
            Gradient::MeanValue => boxed(m::OrbitEnergy::mean_value()),
            Gradient::ItohAbe => boxed(m::OrbitEnergy::itoh_abe()),
        },
        Choice::CohenHairer(order) => cohen_hairer(*order),
        Choice::DiscreteGradient(gradient, Tensor::Mean) => match gradient {
            Gradient::Gonzalez => boxed(m::WithTensor::new(m::Gonzalez, m::MeanTensor)),
            Gradient::MeanValue => boxed(m::WithTensor::new(m::MeanValue, m::MeanTensor)),
            Gradient::ItohAbe => boxed(m::WithTensor::new(m::ItohAbe, m::MeanTensor)),
        },
        Choice::EulerArnold2 => boxed(m::EulerArnold2),
        Choice::Taylor => boxed(m::Taylor::with_tolerance(tolerances.rtol)),
        Choice::LieTaylor => boxed(m::LieTaylor::with_tolerance(tolerances.rtol)),
        Choice::Exact => boxed(m::Exact),
        Choice::Dopri5 => boxed(m::Dopri5 {
            rtol: tolerances.rtol,
            atol: tolerances.atol,
        }),
        other => explicit(other).or_else(|| crate::lagrangian::method(other)),
    }
}

/// The methods without a solver whose steps depend on mu alone.
pub(crate) fn explicit<S: Scalar>(choice: &Choice) -> Option<Method<S>> {
    match choice {
        Choice::LieEuler => boxed(m::LieEuler),
        Choice::Rkmk(2) => boxed(m::Rkmk2),
        Choice::Rkmk(3) => boxed(m::Rkmk3),
        Choice::Rkmk(4) => boxed(m::Rkmk4),
        Choice::Rkmk(6) => boxed(m::Rkmk6),
        Choice::CrouchGrossman3 => boxed(m::CrouchGrossman3),
        Choice::CommutatorFree4 => boxed(m::CommutatorFree4),
        Choice::Splitting(order, scheme, pieces) => splitting(*order, *scheme, *pieces),
        Choice::Compose(order, scheme, base) => compose(*order, *scheme, base, explicit),
        Choice::Rk4 => boxed(m::Rk4),
        _ => None,
    }
}

/// The method of a choice over lanes, for systems side by side ([`Dynamic::in_lanes`]) that take it ([`Dynamic::takes_lanes`]).
///
/// Explicit methods: the step is one program, which is compiled for lanes as for numbers. Others: the few that are compiled for
/// lanes. Each costs the compiler of this crate's users as much as a method over numbers, those with all stages in registers many
/// times that.
pub fn method_in_lanes(
    choice: &Choice,
    tolerances: Tolerances,
) -> Option<Method<<f64 as Scalar>::Wide>> {
    if let Some(method) = compiled_for_lanes(choice, tolerances) {
        return Some(method);
    }
    let claims = explicit::<f64>(choice)?.claims();
    Some(Box::new(Straight::at_once(choice, claims)))
}

/// The methods that are compiled for lanes.
fn compiled_for_lanes(
    choice: &Choice,
    tolerances: Tolerances,
) -> Option<Method<<f64 as Scalar>::Wide>> {
    match choice {
        Choice::Midpoint => boxed(m::ImplicitMidpoint),
        Choice::Gauss(2) => boxed(m::Gauss4),
        Choice::LieMidpoint(Retraction::Exp) => boxed(m::LieMidpoint::exp()),
        Choice::Taylor => boxed(m::Taylor::with_tolerance(tolerances.rtol)),
        // kernel by kernel for families, whose steps are loops over their sites
        Choice::Rk4 => Some(Box::new(Straight::patient(choice, boxed(m::Rk4)?))),
        _ => None,
    }
}

/// Whether a method is compiled for lanes; the others of [`method_in_lanes`] run there as programs of the whole.
pub fn is_compiled_for_lanes(choice: &Choice) -> bool {
    compiled_for_lanes(choice, Tolerances::default()).is_some()
}

fn gauss<S: Scalar>(stages: usize) -> Option<Method<S>> {
    match stages {
        2 => boxed(m::Gauss4),
        3 => boxed(m::Gauss6),
        4 => boxed(m::Gauss8),
        5 => boxed(m::Gauss10),
        6 => boxed(m::Gauss12),
        7 => boxed(m::Gauss14),
        8 => boxed(m::Gauss16),
        _ => None,
    }
}

fn cohen_hairer<S: Scalar>(order: u32) -> Option<Method<S>> {
    match order {
        2 => boxed(m::CohenHairer2::new()),
        4 => boxed(m::CohenHairer4::new()),
        6 => boxed(m::CohenHairer6::new()),
        8 => boxed(m::CohenHairer8::new()),
        10 => boxed(m::CohenHairer10::new()),
        12 => boxed(m::CohenHairer12::new()),
        14 => boxed(m::CohenHairer14::new()),
        16 => boxed(m::CohenHairer16::new()),
        _ => None,
    }
}

fn collective<S: Scalar>(order: u32, lift: Lift) -> Option<Method<S>> {
    macro_rules! by_order {
        ($($order:literal $name:ident)+) => {
            match (order, lift) {
                $(
                    ($order, Lift::Hopf) => boxed(m::$name::hopf()),
                    ($order, Lift::Quaternion) => boxed(m::$name::quaternion()),
                    ($order, Lift::Representation) => boxed(m::$name::representation()),
                )+
                (2, Lift::Spec) => boxed(m::Collective2::given()),
                (4, Lift::Spec) => boxed(m::Collective4::given()),
                (6, Lift::Spec) => boxed(m::Collective6::given()),
                (2, Lift::Hopf) => boxed(m::Collective2::hopf()),
                (4, Lift::Hopf) => boxed(m::Collective4::hopf()),
                (6, Lift::Hopf) => boxed(m::Collective6::hopf()),
                (4, Lift::Representation) => boxed(m::Collective4::representation()),
                (6, Lift::Representation) => boxed(m::Collective6::representation()),
                _ => None,
            }
        };
    }
    match (order, lift) {
        (2, Lift::Representation) => {
            isospectral2(Claims::from_facts::<m::Collective2<m::Representation>>())
        }
        (8.., Lift::Smallest) => smallest(order),
        _ => {
            by_order!(8 Collective8 10 Collective10 12 Collective12 14 Collective14 16 Collective16)
        }
    }
}

/// Over the smallest space that the system has.
fn smallest<S: Scalar>(order: u32) -> Option<Method<S>> {
    let claims = collective::<S>(order, Lift::Hopf)?.claims();
    let choose = move |system: &Dynamic<S>| {
        let lift = match system.plan().structure.smallest {
            Some(Smallest::Hopf) => Lift::Hopf,
            Some(Smallest::Quaternion) => Lift::Quaternion,
            Some(Smallest::Representation) | None => Lift::Representation,
        };
        collective(order, lift).unwrap_or_else(|| unreachable!("there is a method of this order"))
    };
    Some(Box::new(Claiming {
        claims,
        choose: Box::new(choose),
    }))
}

/// With one stage over a closed representation it is the retraction method with the Cayley map.
fn isospectral2<S: Scalar>(claims: Claims) -> Option<Method<S>> {
    let choose = |system: &Dynamic<S>| -> Method<S> {
        match system.plan().system.triple {
            Some(_) => Box::new(m::LieMidpoint::cayley()),
            None => Box::new(m::Isospectral2::new()),
        }
    };
    Some(Box::new(Claiming {
        claims,
        choose: Box::new(choose),
    }))
}

fn isospectral<S: Scalar>(order: u32) -> Option<Method<S>> {
    match order {
        2 => isospectral2(Claims::from_facts::<m::Isospectral2>()),
        4 => boxed(m::Isospectral4::new()),
        6 => boxed(m::Isospectral6::new()),
        8 => boxed(m::Isospectral8::new()),
        10 => boxed(m::Isospectral10::new()),
        12 => boxed(m::Isospectral12::new()),
        14 => boxed(m::Isospectral14::new()),
        16 => boxed(m::Isospectral16::new()),
        _ => None,
    }
}

/// A composition of steps of its base, which `make` makes.
fn compose<S: Scalar>(
    order: u32,
    scheme: Scheme,
    base: &Choice,
    make: impl Fn(&Choice) -> Option<Method<S>> + 'static,
) -> Option<Method<S>> {
    let claims = Claims {
        order,
        ..make(base)?.claims()
    };
    let (base, scheme) = (base.clone(), scheme_of(scheme));
    let choose = move |_: &Dynamic<S>| -> Method<S> {
        let base = Base(make(&base).unwrap_or_else(|| unreachable!("the base was there before")));
        match order {
            4 => Box::new(m::Compose4::new(base).scheme(scheme)),
            6 => Box::new(m::Compose6::new(base).scheme(scheme)),
            _ => Box::new(m::Compose8::new(base).scheme(scheme)),
        }
    };
    Some(Box::new(Claiming {
        claims,
        choose: Box::new(choose),
    }))
}

fn splitting<S: Scalar>(order: u32, scheme: Scheme, pieces: Pieces) -> Option<Method<S>> {
    macro_rules! of {
        ($splitting:expr) => {{
            let splitting = $splitting;
            // of order 1 the scheme means nothing
            let splitting = match order {
                1 => splitting,
                _ => splitting.scheme(scheme_of(scheme)),
            };
            match pieces {
                Pieces::Coordinate => boxed(splitting.coordinate()),
                Pieces::Found => boxed(splitting),
            }
        }};
    }
    match order {
        1 => of!(m::Splitting1::new()),
        2 => of!(m::Splitting2::new()),
        4 => of!(m::Splitting4::new()),
        6 => of!(m::Splitting6::new()),
        8 => of!(m::Splitting8::new()),
        _ => None,
    }
}
