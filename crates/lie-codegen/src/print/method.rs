//! The hooks by which the runtime finds the equation of a method.

use proc_macro2::TokenStream;
use quote::quote;

use super::Printer;
use crate::plan::{Method, Solver};

impl Printer<'_> {
    /// The impl of `Implicit` for a method.
    pub(super) fn method(&self, method: &Method, solver: &Solver) -> TokenStream {
        let system = self.system_name();
        let method = match method {
            Method::Catalogue(choice) => choice.type_of(),
            Method::Own(path) => super::partner::path(path),
        };
        let (equation, value) = match solver {
            Solver::Fused(suffix) => {
                let name = self.type_name(suffix);
                (quote! { #name<'a, S> }, quote! { #name::new(self, h) })
            }
            Solver::Eliminated(partner, elimination) => {
                let (inner, elimination) =
                    (self.partner_type(partner), self.type_name(elimination));
                let value = self.partner_value(partner, &quote! { self }, &quote! { h });
                (
                    quote! { ::lie_runtime::__private::Eliminated<#inner, #elimination> },
                    quote! { ::lie_runtime::__private::Eliminated::new(#value) },
                )
            }
            Solver::Generic(partner) => (
                self.partner_type(partner),
                self.partner_value(partner, &quote! { self }, &quote! { h }),
            ),
        };
        quote! {
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::Implicit<S, #method> for #system<S> {
                type Equation<'a> = #equation where Self: 'a;
                fn equation<'a>(&'a self, _method: &#method, h: S) -> Self::Equation<'a> {
                    #value
                }
            }
        }
    }
}
