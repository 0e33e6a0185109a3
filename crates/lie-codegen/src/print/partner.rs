//! Generic equations of the numeric core, as types and as values.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::Printer;
use super::names::{ident, index};
use crate::methods::{Gradient, Lift};
use crate::plan::Partner;

impl Printer<'_> {
    /// The type of a generic equation of the system, with a lifetime `'a` and a scalar S in scope.
    pub(super) fn partner_type(&self, partner: &Partner) -> TokenStream {
        let system = self.system_name();
        let generic = |name: &str, rest: TokenStream| {
            let name = ident(name);
            quote! { ::lie_runtime::generic::#name<'a, S, #system<S> #rest> }
        };
        match partner {
            Partner::Midpoint => generic("Midpoint", quote! {}),
            Partner::Gauss(stages) => {
                let stages = index(*stages);
                generic("Gauss", quote! { , #stages })
            }
            Partner::ExpMidpoint => generic("ExpMidpoint", quote! {}),
            Partner::CayleyMidpoint => generic("CayleyMidpoint", quote! {}),
            Partner::DiscreteGradient(gradient) => {
                let gradient = self.gradient_type(*gradient, false);
                generic("DiscreteGradientStep", quote! { , #gradient })
            }
            Partner::OrbitEnergy(gradient, closed) => {
                let gradient = self.gradient_type(*gradient, *closed);
                generic("OrbitEnergyStep", quote! { , #gradient })
            }
            Partner::CohenHairer(stages) => {
                let stages = index(*stages);
                generic("CohenHairerStep", quote! { , #stages })
            }
            Partner::ExpRetraction(function) => {
                let function = self.type_name(function);
                generic("ExpRetraction", quote! { , #function<'a, S> })
            }
            Partner::SecondKind(Some(function)) => {
                let function = self.type_name(function);
                generic("SecondKind", quote! { , #function<'a, S> })
            }
            Partner::SecondKind(None) => generic("SecondKind", quote! {}),
            Partner::CayleyGenerating4 => generic(
                "CayleyRetraction",
                quote! { , ::lie_runtime::generic::CayleyGenerating4<'a, S, #system<S>> },
            ),
            Partner::Spherical(_) => generic("Spherical", quote! {}),
            Partner::DiscreteTop => generic("DiscreteTop", quote! {}),
            Partner::DiscreteBody => generic("DiscreteBody", quote! {}),
            Partner::Stages(lift, stages) => {
                let stages = index(*stages);
                let map = match lift {
                    Lift::Hopf => quote! { ::lie_runtime::generic::QuaternionStages<S, #stages> },
                    _ => quote! {
                        ::lie_runtime::generic::MatrixStages<S, <#system<S> as ::lie_runtime::MatrixPoisson<S>>::Matrix, #stages>
                    },
                };
                generic("StageMomenta", quote! { , #map, #stages })
            }
            Partner::Own(equation) => {
                let equation = path(equation);
                quote! { #equation<'a, S, #system<S>> }
            }
        }
    }

    /// The value of a generic equation, its system and step size being these.
    pub(super) fn partner_value(
        &self,
        partner: &Partner,
        system: &TokenStream,
        h: &TokenStream,
    ) -> TokenStream {
        let name = |name: &str| {
            let name = ident(name);
            quote! { ::lie_runtime::generic::#name }
        };
        let along = |generic: Ident, function: &Ident, last: Option<TokenStream>| {
            quote! {
                ::lie_runtime::generic::#generic::with_function(#system, #function::new(#system, #h) #last)
            }
        };
        let generic = match partner {
            Partner::Midpoint => name("Midpoint"),
            Partner::Gauss(_) => name("Gauss"),
            Partner::ExpMidpoint => name("ExpMidpoint"),
            Partner::CayleyMidpoint => name("CayleyMidpoint"),
            Partner::DiscreteGradient(gradient) => {
                let gradient = ident(gradient_name(*gradient));
                quote! {
                    ::lie_runtime::generic::DiscreteGradientStep::<
                        S, _, ::lie_runtime::generic::#gradient<S, _>,
                    >
                }
            }
            Partner::OrbitEnergy(..) => name("OrbitEnergyStep"),
            Partner::CohenHairer(_) => name("CohenHairerStep"),
            Partner::ExpRetraction(function) => {
                let function = self.type_name(function);
                return along(ident("ExpRetraction"), &function, Some(quote! { , #h }));
            }
            Partner::SecondKind(Some(function)) => {
                return along(ident("SecondKind"), &self.type_name(function), None);
            }
            Partner::SecondKind(None) => name("SecondKind"),
            Partner::CayleyGenerating4 => {
                return quote! {
                    ::lie_runtime::generic::CayleyRetraction::with_function(
                        #system,
                        ::lie_runtime::generic::CayleyGenerating4::new(#system, #h),
                        #h,
                    )
                };
            }
            Partner::Spherical(_) => name("Spherical"),
            Partner::DiscreteTop => name("DiscreteTop"),
            Partner::DiscreteBody => name("DiscreteBody"),
            Partner::Stages(..) => name("StageMomenta"),
            Partner::Own(equation) => path(equation),
        };
        quote! { #generic::new(#system, #h) }
    }

    fn gradient_type(&self, gradient: Gradient, closed: bool) -> TokenStream {
        let name = gradient_name(gradient);
        if closed {
            let name = self.type_name(name);
            return quote! { #name<S> };
        }
        let (name, system) = (ident(name), self.system_name());
        quote! { ::lie_runtime::generic::#name<S, #system<S>> }
    }
}

/// A path as it was written.
pub(super) fn path(text: &str) -> TokenStream {
    text.parse().unwrap_or_else(|_| {
        let message = format!("`{text}` is not the path of a type");
        quote! { ::core::compile_error!(#message) }
    })
}

/// A discrete gradient in the runtime, and the end of the name of one in closed form.
pub(super) fn gradient_name(gradient: Gradient) -> &'static str {
    match gradient {
        Gradient::Gonzalez => "GonzalezGradient",
        Gradient::MeanValue => "MeanValueGradient",
        Gradient::ItohAbe => "ItohAbeGradient",
    }
}
