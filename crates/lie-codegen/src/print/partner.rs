//! Generic equations of the numeric core, as types and as values.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::Printer;
use super::names::{ident, index};
use crate::methods::{Choice, Gradient, Row, Tensor};
use crate::plan::Partner;

impl Printer<'_> {
    /// The type of a generic equation of the system, with a lifetime `'a` and a scalar S in scope.
    pub(super) fn partner_type(&self, partner: &Partner) -> TokenStream {
        let system = self.system_name();
        let (equation, along) = match partner {
            Partner::Catalogue {
                equation, along, ..
            } => (equation, along.map(|suffix| self.type_name(suffix))),
            Partner::Own(equation) => {
                let equation = path(equation);
                return quote! { #equation<'a, S, #system<S>> };
            }
        };
        let name = ident(equation.name);
        let stages = equation.stages.map(index);
        let stages = stages.map(|stages| quote! { , #stages });
        let gradient = equation.gradient.map(|gradient| match &along {
            Some(closed) => quote! { , #closed<S> },
            None => {
                let gradient = ident(gradient);
                quote! { , ::lie_runtime::generic::#gradient<S, #system<S>> }
            }
        });
        let function = equation.function.map(|function| match &along {
            Some(planned) => quote! { , #planned<'a, S> },
            None => {
                let function = ident(function);
                quote! { , ::lie_runtime::generic::#function<'a, S, #system<S>> }
            }
        });
        quote! { ::lie_runtime::generic::#name<'a, S, #system<S> #stages #gradient #function> }
    }

    /// The value of a generic equation, its system and step size being these.
    pub(super) fn partner_value(
        &self,
        partner: &Partner,
        system: &TokenStream,
        h: &TokenStream,
    ) -> TokenStream {
        let generic = |name: &str| {
            let name: Ident = ident(name);
            quote! { ::lie_runtime::generic::#name }
        };
        let (equation, along) = match partner {
            Partner::Catalogue {
                equation, along, ..
            } => (equation, along),
            Partner::Own(equation) => {
                let equation = path(equation);
                return quote! { #equation::new(#system, #h) };
            }
        };
        let name = generic(equation.name);
        if let Some(function) = equation.function {
            let function = match along {
                Some(suffix) => {
                    let planned = self.type_name(suffix);
                    quote! { #planned }
                }
                None => generic(function),
            };
            return quote! { #name::with_function(#system, #function::new(#system, #h), #h) };
        }
        let gradient = equation.gradient.filter(|_| along.is_none());
        let gradient = gradient.map(|gradient| {
            let gradient = generic(gradient);
            quote! { ::<S, _, #gradient<S, _>> }
        });
        quote! { #name #gradient::new(#system, #h) }
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
    let choice = Choice::DiscreteGradient(gradient, Tensor::Midpoint);
    let equation = Row::find(&choice).equation(&|_| true);
    equation
        .and_then(|(_, equation)| equation.gradient)
        .unwrap_or_default()
}
