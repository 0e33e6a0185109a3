//! The methods of the catalogue over systems made at run time and any scalar, and which of them run in lanes.

mod lanes;

use crate::recording::Recorded;
use crate::system::Dynamic;
use lie_codegen::methods::{Choice, Gradient, Lift, Pieces, Retraction, Scheme, Tensor};
use lie_codegen::structure::lifts::Smallest;
use lie_runtime::Scalar;
use lie_runtime::diagnostics::{AnyMethod, AnyStepper, Claims, Forgotten, ForgottenStepper};
use lie_runtime::methods::{self as m, Facts, Preserves, Tolerances};
use lie_runtime::newton::NewtonOptions;

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
struct WithClaims<S: Scalar> {
    claims: Claims,
    choose: Box<Choose<S>>,
}

impl<S: Scalar> AnyMethod<S, Dynamic<S>> for WithClaims<S> {
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

/// The method of a choice over any scalar with its own defaults, see [`method_over`]: series at the tolerance at which they are exact on every
/// grid.
pub fn at_defaults_over<S: Scalar>(choice: &Choice) -> Method<S> {
    match choice {
        Choice::Taylor => Box::new(m::Taylor::default()),
        Choice::LieTaylor => Box::new(m::LieTaylor::default()),
        other => method_over(other, Tolerances::default()),
    }
}

/// The method of a choice over any scalar, without programs of whole steps. Whether it applies to a system is for the catalogue to say.
///
/// All methods are compiled anew where it is called: over numbers that is in `lie-methods`, over dual numbers in `lie-tangents`.
pub fn method_over<S: Scalar>(choice: &Choice, tolerances: Tolerances) -> Method<S> {
    if let Some(method) = explicit(choice).or_else(|| by_system(choice)) {
        return method;
    }
    /// Returns the method of a row if it is the one that is asked for.
    macro_rules! rows {
        (
            {} choices $choices:tt
            $({ $title:literal $needs:tt $reference:tt
                $($choice:tt $type:tt $value:tt { $($particular:ident)? $([$($equation:tt)+])* })+
            })+
        ) => {
            $($(rows!($choice $value $($particular)?);)+)+
        };
        ([$($choice:tt)+] [$name:ident] tolerances) => {
            if matches!(choice, Choice::$($choice)+) {
                return Box::new(m::$name::from(tolerances));
            }
        };
        ([$($choice:tt)+] [$name:ident $(::$maker:ident($($given:ident),*))?]) => {
            if matches!(choice, Choice::$($choice)+) {
                return Box::new(m::$name $(::$maker($(m::$given),*))?);
            }
        };
        ($choice:tt $value:tt explicit) => {};
        ($choice:tt $value:tt smallest) => {};
        ($choice:tt $value:tt splitting) => {};
        ($choice:tt $value:tt compose) => {};
    }
    lie_core::for_each_method!(rows! {});
    composition(choice, move |base| Some(method_over(base, tolerances)))
        .unwrap_or_else(|| unreachable!("{choice:?} is not made of the list of methods"))
}

/// The methods without a solver whose steps depend on mu alone.
pub fn explicit<S: Scalar>(choice: &Choice) -> Option<Method<S>> {
    macro_rules! rows {
        (
            {} choices $choices:tt
            $({ $title:literal $needs:tt $reference:tt
                $($choice:tt $type:tt $value:tt { $($particular:ident)? $([$($equation:tt)+])* })+
            })+
        ) => {
            $($(rows!($choice $value $($particular)?);)+)+
        };
        ([$($choice:tt)+] [$name:ident] explicit) => {
            if matches!(choice, Choice::$($choice)+) {
                return Some(Box::new(m::$name));
            }
        };
        ($choice:tt [$name:ident::new()] splitting) => {
            if let Choice::Splitting(<m::$name as Facts>::ORDER, scheme, pieces) = choice {
                return Some(splitting(m::$name::new(), *scheme, *pieces));
            }
        };
        ($choice:tt $value:tt $($particular:ident)?) => {};
    }
    lie_core::for_each_method!(rows! {});
    composition(choice, explicit)
}

/// The methods whose steps are equations; none of others.
pub(crate) fn implicit<S: Scalar>(choice: &Choice) -> Option<Method<S>> {
    /// Returns the method of a row that has an equation, if it is the one that is asked for.
    macro_rules! rows {
        (
            {} choices $choices:tt
            $({ $title:literal $needs:tt $reference:tt
                $($choice:tt $type:tt $value:tt { $($particular:ident)? $([$($equation:tt)+])* })+
            })+
        ) => {
            $($(rows!($choice $value $([$($equation)+])*);)+)+
        };
        ($choice:tt $value:tt) => {};
        ([$($choice:tt)+] [$name:ident $(::$maker:ident($($given:ident),*))?] $($equation:tt)+) => {
            if matches!(choice, Choice::$($choice)+) {
                return Some(Box::new(m::$name $(::$maker($(m::$given),*))?));
            }
        };
    }
    if let Some(method) = by_equation_of_system(choice) {
        return Some(method);
    }
    lie_core::for_each_method!(rows! {});
    None
}

/// Whether the step of a method, or of the base of a composition, is an equation: then the method over a scalar that records is there.
pub fn has_equation(choice: &Choice) -> bool {
    implicit::<Recorded<8>>(choice.solved()).is_some()
}

/// The methods whose equation depends on what the system has.
fn by_equation_of_system<S: Scalar>(choice: &Choice) -> Option<Method<S>> {
    match choice {
        Choice::Isospectral(2) => Some(isospectral2(Claims::from_facts::<m::Isospectral2>())),
        Choice::Collective(2, Lift::Representation) => {
            let claims = Claims::from_facts::<m::Collective2<m::Representation>>();
            Some(isospectral2(claims))
        }
        Choice::Variational(order, Retraction::Exp) => Some(variational(*order)),
        Choice::Variational(2, Retraction::Cayley) => Some(variational_cayley()),
        _ => None,
    }
}

/// The methods that depend on what the system has.
fn by_system<S: Scalar>(choice: &Choice) -> Option<Method<S>> {
    match choice {
        Choice::Collective(order, Lift::Smallest) => Some(smallest(*order)),
        _ => by_equation_of_system(choice),
    }
}

/// Whether a method is compiled for lanes; others run there as programs of the whole.
pub fn is_compiled_for_lanes(choice: &Choice) -> bool {
    matches!(choice, Choice::Taylor | Choice::Dopri5 | Choice::Rk4)
}

/// Over the smallest space that the system has.
fn smallest<S: Scalar>(order: u32) -> Method<S> {
    let over = move |lift| method_over(&Choice::Collective(order, lift), Tolerances::default());
    let choose = move |system: &Dynamic<S>| {
        over(match system.plan().structure.smallest {
            Some(Smallest::Hopf) => Lift::Hopf,
            Some(Smallest::Quaternion) => Lift::Quaternion,
            Some(Smallest::Unitary) => Lift::Unitary,
            Some(Smallest::Representation) | None => Lift::Representation,
        })
    };
    Box::new(WithClaims {
        claims: over(Lift::Hopf).claims(),
        choose: Box::new(choose),
    })
}

/// With one stage over a closed representation it is the retraction method with the Cayley map.
fn isospectral2<S: Scalar>(claims: Claims) -> Method<S> {
    let choose = |system: &Dynamic<S>| -> Method<S> {
        match system.plan().system.triple {
            Some(_) => Box::new(m::LieMidpoint::cayley()),
            None => Box::new(m::Isospectral2::new()),
        }
    };
    Box::new(WithClaims {
        claims,
        choose: Box::new(choose),
    })
}

/// In phase space where the system carries the group element or the time.
fn variational<S: Scalar>(order: u32) -> Method<S> {
    fn make<S: Scalar>(order: u32, on_group: bool) -> Method<S> {
        match (order, on_group) {
            (2, false) => Box::new(m::Variational2::exp()),
            (2, true) => Box::new(m::Variational2::on_group()),
            (4, false) => Box::new(m::Variational4::exp()),
            (4, true) => Box::new(m::Variational4::on_group()),
            (_, false) => Box::new(m::Variational6::exp()),
            (_, true) => Box::new(m::Variational6::on_group()),
        }
    }
    Box::new(WithClaims {
        claims: make::<S>(order, false).claims(),
        choose: Box::new(move |system: &Dynamic<S>| {
            make(order, system.plan().structure.momenta.is_some())
        }),
    })
}

/// The same along the Cayley map, whose other orders are in phase space always.
fn variational_cayley<S: Scalar>() -> Method<S> {
    let choose = |system: &Dynamic<S>| -> Method<S> {
        match system.plan().structure.momenta {
            Some(_) => Box::new(m::Variational2::cayley_on_group()),
            None => Box::new(m::Variational2::cayley()),
        }
    };
    Box::new(WithClaims {
        claims: Claims::from_facts::<m::Variational2<m::Cayley>>(),
        choose: Box::new(choose),
    })
}

/// The composition of a choice, of steps of its base, which `make` makes; none of another method, nor where that makes none.
pub fn composition<S: Scalar>(
    choice: &Choice,
    make: impl Fn(&Choice) -> Option<Method<S>> + 'static,
) -> Option<Method<S>> {
    let Choice::Compose(order, scheme, base) = choice.clone() else {
        return None;
    };
    let claims = Claims {
        order,
        ..make(&base)?.claims()
    };
    let choose = move |_: &Dynamic<S>| -> Method<S> {
        let base = make(&base).unwrap_or_else(|| unreachable!("the base was there before"));
        let base = Base(base);
        match order {
            4 => Box::new(m::Compose4::new(base).scheme(scheme)),
            6 => Box::new(m::Compose6::new(base).scheme(scheme)),
            _ => Box::new(m::Compose8::new(base).scheme(scheme)),
        }
    };
    Some(Box::new(WithClaims {
        claims,
        choose: Box::new(choose),
    }))
}

fn splitting<S: Scalar, const ORDER: u32>(
    splitting: m::Splitting<ORDER>,
    scheme: Scheme,
    pieces: Pieces,
) -> Method<S> {
    // of order 1 the scheme means nothing
    let splitting = match ORDER {
        1 => splitting,
        _ => splitting.scheme(scheme),
    };
    match pieces {
        Pieces::Coordinate => Box::new(splitting.coordinate()),
        Pieces::Found => Box::new(splitting),
    }
}
