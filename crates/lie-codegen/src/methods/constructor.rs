//! The value of a method in the runtime, as Rust.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::Choice;
use super::options::{Gradient, Lift, Pieces, Retraction, Scheme, Tensor};

impl Choice {
    /// The type of a method in the runtime whose equation a plan may have code for.
    pub(crate) fn type_of(&self) -> TokenStream {
        let of = |name: &str, parameters: TokenStream| {
            let name = format_ident!("{name}");
            quote! { ::lie_runtime::methods::#name #parameters }
        };
        let stages = |order: u32| Literal::u32_unsuffixed(order / 2);
        match self {
            Self::Gauss(stages) => of(&format!("Gauss{}", 2 * stages), quote! {}),
            Self::LieMidpoint(retraction) => {
                let tau = type_of_retraction(*retraction);
                of("LieMidpoint", quote! { <::lie_runtime::methods::#tau> })
            }
            Self::DiscreteGradient(gradient, _) => of(&type_of(*gradient).to_string(), quote! {}),
            Self::OrbitEnergy(gradient) => {
                let gradient = type_of(*gradient);
                of(
                    "OrbitEnergy",
                    quote! { <::lie_runtime::methods::#gradient> },
                )
            }
            Self::CohenHairer(order) => {
                let stages = stages(*order);
                of("CohenHairer", quote! { <#stages> })
            }
            Self::Generating(order, retraction) => {
                let (tau, order) = (
                    type_of_retraction(*retraction),
                    Literal::u32_unsuffixed(*order),
                );
                of(
                    "Generating",
                    quote! { <::lie_runtime::methods::#tau, #order> },
                )
            }
            Self::Isospectral(order) => {
                let stages = stages(*order);
                of("Isospectral", quote! { <#stages> })
            }
            Self::Collective(order, Lift::Hopf) => {
                let stages = stages(*order);
                of(
                    "Collective",
                    quote! { <::lie_runtime::methods::Hopf, #stages> },
                )
            }
            other => other.constructor(),
        }
    }

    /// The value of a method that is a type with a default.
    pub(crate) fn at_defaults(&self) -> TokenStream {
        let name = match self {
            Self::Taylor => named("Taylor"),
            Self::LieTaylor => named("LieTaylor"),
            other => return other.constructor(),
        };
        quote! { <#name as ::core::default::Default>::default() }
    }

    /// The value of the method in the runtime, as Rust; `tolerances` is in scope.
    pub fn constructor(&self) -> TokenStream {
        match self {
            Self::Midpoint => named("ImplicitMidpoint"),
            Self::Gauss(stages) => numbered("Gauss", 2 * stages),
            Self::LieMidpoint(retraction) => with_retraction(named("LieMidpoint"), *retraction),
            Self::LieEuler => named("LieEuler"),
            Self::Rkmk(order) => numbered("Rkmk", *order),
            Self::CrouchGrossman3 => named("CrouchGrossman3"),
            Self::CommutatorFree4 => named("CommutatorFree4"),
            Self::Variational(order, retraction) => {
                with_retraction(numbered("Variational", *order), *retraction)
            }
            Self::DiscreteEulerPoincare(retraction) => {
                with_retraction(named("DiscreteEulerPoincare"), *retraction)
            }
            Self::MoserVeselov => named("MoserVeselov"),
            Self::Compose(order, scheme, base) => {
                let (compose, base) = (numbered("Compose", *order), base.constructor());
                let scheme = with_scheme(*scheme, Scheme::of_composition(*order));
                quote! { #compose::new(#base) #scheme }
            }
            Self::Generating(order, retraction) => {
                with_retraction(numbered("Generating", *order), *retraction)
            }
            Self::GeneratingSecondKind2 => named("GeneratingSecondKind2"),
            Self::Collective(order, lift) => {
                let collective = numbered("Collective", *order);
                let lift = match lift {
                    Lift::Representation => format_ident!("representation"),
                    Lift::Hopf => format_ident!("hopf"),
                    Lift::Spec => format_ident!("given"),
                    Lift::Quaternion => format_ident!("quaternion"),
                    Lift::Smallest => format_ident!("smallest"),
                };
                quote! { #collective::#lift() }
            }
            Self::Isospectral(order) => new(numbered("Isospectral", *order)),
            Self::EulerArnold2 => named("EulerArnold2"),
            Self::SphericalMidpoint => named("SphericalMidpoint"),
            Self::Splitting(order, scheme, pieces) => {
                let splitting = new(numbered("Splitting", *order));
                let scheme = with_scheme(*scheme, Scheme::of_splitting(*order));
                let coordinate = *pieces == Pieces::Coordinate;
                let coordinate = coordinate.then(|| quote! { .coordinate() });
                quote! { #splitting #scheme #coordinate }
            }
            Self::DiscreteGradient(gradient, Tensor::Midpoint) => method(type_of(*gradient)),
            Self::DiscreteGradient(gradient, Tensor::Mean) => {
                let (with_tensor, mean) = (named("WithTensor"), named("MeanTensor"));
                let gradient = method(type_of(*gradient));
                quote! { #with_tensor::new(#gradient, #mean) }
            }
            Self::OrbitEnergy(gradient) => {
                let (orbit_energy, gradient) = (named("OrbitEnergy"), constructor_of(*gradient));
                quote! { #orbit_energy::#gradient() }
            }
            Self::CohenHairer(order) => new(numbered("CohenHairer", *order)),
            Self::Exact => named("Exact"),
            Self::Rk4 => named("Rk4"),
            Self::Dopri5 => {
                let dopri5 = named("Dopri5");
                quote! { #dopri5 { rtol: tolerances.rtol, atol: tolerances.atol } }
            }
            Self::Taylor | Self::LieTaylor => {
                let taylor = named(if *self == Self::Taylor {
                    "Taylor"
                } else {
                    "LieTaylor"
                });
                quote! { #taylor::with_tolerance(tolerances.rtol) }
            }
        }
    }
}

/// The path of a method.
fn method(name: Ident) -> TokenStream {
    quote! { ::lie_runtime::methods::#name }
}

fn named(name: &str) -> TokenStream {
    method(format_ident!("{name}"))
}

/// A method with its order or the like in its name.
fn numbered(family: &str, number: impl std::fmt::Display) -> TokenStream {
    method(format_ident!("{family}{number}"))
}

fn new(method: TokenStream) -> TokenStream {
    quote! { #method::new() }
}

fn with_retraction(method: TokenStream, retraction: Retraction) -> TokenStream {
    let tau = function_of(retraction);
    quote! { #method::#tau() }
}

/// What chooses a scheme, unless it is the first of those that there are.
fn with_scheme(scheme: Scheme, all: &[Scheme]) -> Option<TokenStream> {
    all.first()
        .is_some_and(|default| *default != scheme)
        .then(|| with(scheme))
}

fn constructor_of(gradient: Gradient) -> Ident {
    match gradient {
        Gradient::Gonzalez => format_ident!("gonzalez"),
        Gradient::MeanValue => format_ident!("mean_value"),
        Gradient::ItohAbe => format_ident!("itoh_abe"),
    }
}

fn function_of(retraction: Retraction) -> Ident {
    format_ident!("{}", retraction.name())
}

fn type_of_retraction(retraction: Retraction) -> Ident {
    match retraction {
        Retraction::Exp => format_ident!("Exp"),
        Retraction::Cayley => format_ident!("Cayley"),
    }
}

fn type_of(gradient: Gradient) -> Ident {
    match gradient {
        Gradient::Gonzalez => format_ident!("Gonzalez"),
        Gradient::MeanValue => format_ident!("MeanValue"),
        Gradient::ItohAbe => format_ident!("ItohAbe"),
    }
}

fn with(scheme: Scheme) -> TokenStream {
    let scheme = match scheme {
        Scheme::Suzuki => format_ident!("Suzuki"),
        Scheme::TripleJump => format_ident!("TripleJump"),
        Scheme::Yoshida => format_ident!("Yoshida"),
        Scheme::KahanLi => format_ident!("KahanLi"),
        Scheme::SuzukiUmeno => format_ident!("SuzukiUmeno"),
        Scheme::BlanesMoan => format_ident!("BlanesMoan"),
        Scheme::Strang => format_ident!("Strang"),
        Scheme::Saba2 => format_ident!("Saba2"),
        Scheme::Saba4 => format_ident!("Saba4"),
        Scheme::Sbab2 => format_ident!("Sbab2"),
        Scheme::Sbab4 => format_ident!("Sbab4"),
        Scheme::McLachlan84 => format_ident!("McLachlan84"),
    };
    quote! { .scheme(::lie_runtime::methods::Scheme::#scheme) }
}
