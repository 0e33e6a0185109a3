//! The value of a method in the runtime, as Rust.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::Choice;
use super::options::{Gradient, Lift, Retraction, Scheme, Tensor};

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

    /// The value of the method in the runtime, as Rust; `tolerances` is in scope.
    pub fn constructor(&self) -> TokenStream {
        let method = |name: Ident| quote! { ::lie_runtime::methods::#name };
        let named = |name: &str| method(format_ident!("{name}"));
        match self {
            Self::Midpoint => named("ImplicitMidpoint"),
            Self::Gauss(stages) => method(format_ident!("Gauss{}", 2 * stages)),
            Self::LieMidpoint(retraction) => {
                let tau = function_of(*retraction);
                quote! { ::lie_runtime::methods::LieMidpoint::#tau() }
            }
            Self::LieEuler => named("LieEuler"),
            Self::Rkmk(order) => method(format_ident!("Rkmk{order}")),
            Self::CrouchGrossman3 => named("CrouchGrossman3"),
            Self::CommutatorFree4 => named("CommutatorFree4"),
            Self::Variational(order, retraction) => {
                let variational = method(format_ident!("Variational{order}"));
                let tau = function_of(*retraction);
                quote! { #variational::#tau() }
            }
            Self::DiscreteEulerPoincare(retraction) => {
                let tau = function_of(*retraction);
                quote! { ::lie_runtime::methods::DiscreteEulerPoincare::#tau() }
            }
            Self::MoserVeselov => named("MoserVeselov"),
            Self::Compose(order, scheme, base) => {
                let compose = method(format_ident!("Compose{order}"));
                let base = base.constructor();
                let scheme = (*scheme != Scheme::of_composition(*order)[0]).then(|| with(*scheme));
                quote! { #compose::new(#base) #scheme }
            }
            Self::Generating(order, retraction) => {
                let generating = method(format_ident!("Generating{order}"));
                let tau = function_of(*retraction);
                quote! { #generating::#tau() }
            }
            Self::GeneratingSecondKind2 => named("GeneratingSecondKind2"),
            Self::Collective(order, lift) => {
                let collective = method(format_ident!("Collective{order}"));
                let lift = match lift {
                    Lift::Representation => format_ident!("representation"),
                    Lift::Hopf => format_ident!("hopf"),
                    Lift::Spec => format_ident!("given"),
                };
                quote! { #collective::#lift() }
            }
            Self::Isospectral(order) => {
                let isospectral = method(format_ident!("Isospectral{order}"));
                quote! { #isospectral::new() }
            }
            Self::EulerArnold2 => named("EulerArnold2"),
            Self::SphericalMidpoint => named("SphericalMidpoint"),
            Self::Splitting(order, scheme) => {
                let splitting = method(format_ident!("Splitting{order}"));
                let default = Scheme::of_splitting(*order).first().copied();
                let scheme = default
                    .is_some_and(|default| default != *scheme)
                    .then(|| with(*scheme));
                quote! { #splitting::new() #scheme }
            }
            Self::DiscreteGradient(gradient, Tensor::Midpoint) => method(type_of(*gradient)),
            Self::DiscreteGradient(gradient, Tensor::Mean) => {
                let gradient = method(type_of(*gradient));
                quote! {
                    ::lie_runtime::methods::WithTensor::new(#gradient, ::lie_runtime::methods::MeanTensor)
                }
            }
            Self::OrbitEnergy(gradient) => {
                let gradient = match gradient {
                    Gradient::Gonzalez => format_ident!("gonzalez"),
                    Gradient::MeanValue => format_ident!("mean_value"),
                    Gradient::ItohAbe => format_ident!("itoh_abe"),
                };
                quote! { ::lie_runtime::methods::OrbitEnergy::#gradient() }
            }
            Self::CohenHairer(order) => {
                let method = method(format_ident!("CohenHairer{order}"));
                quote! { #method::new() }
            }
            Self::Rk4 => named("Rk4"),
            Self::Dopri5 => quote! {
                ::lie_runtime::methods::Dopri5 { rtol: tolerances.rtol, atol: tolerances.atol }
            },
        }
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
    };
    quote! { .scheme(::lie_runtime::methods::Scheme::#scheme) }
}
