//! The impl of a realization.

use proc_macro2::TokenStream;
use quote::quote;

use super::Printer;
use super::names::{ident, index};
use crate::derive::Shape;
use crate::model::CANONICAL;
use crate::plan::Function;
use lie_symbolic::symbolic::Symbol;

impl Printer<'_> {
    /// The impl of `RealizedPoisson`, where a realization is declared.
    pub(super) fn realization(&self) -> Option<TokenStream> {
        let realization = self.plan.structure.realization.as_ref()?;
        let system = self.system_name();
        let (names, given) = (&realization.names, realization.given);
        let count = index(names.len());
        let functions = realization.functions.iter();
        let methods: TokenStream = functions.map(|f| self.realized(f, names.len())).collect();
        let start = realization.start.iter().enumerate().map(|(i, value)| {
            let (i, value) = (index(i), self.value_of(value));
            quote! { out[#i] = { #value }; }
        });
        let start: TokenStream = start.collect();
        let closed = realization.descends.then(|| {
            quote! {
                impl<S: ::lie_runtime::Scalar> ::lie_runtime::ClosedRealization<S> for #system<S> {}
            }
        });
        Some(quote! {
            #closed

            #[allow(non_snake_case, clippy::many_single_char_names)]
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::RealizedPoisson<S> for #system<S> {
                type Point = ::lie_runtime::__private::SVector<S, #count>;
                type PointMatrix = ::lie_runtime::__private::SMatrix<S, #count, #count>;
                fn point_dimension(&self) -> usize {
                    #count
                }

                fn canonical_name(&self, index: usize) -> &str {
                    [#(#names),*][index]
                }

                fn start_is_given(&self) -> bool {
                    #given
                }

                fn zero_point(&self) -> Self::Point {
                    Self::Point::repeat(S::zero())
                }

                fn zero_point_matrix(&self) -> Self::PointMatrix {
                    Self::PointMatrix::repeat(S::zero())
                }

                #methods

                fn start(&self, out: &mut Self::Point) {
                    #start
                }
            }
        })
    }

    /// A kernel whose arguments and results are points or states.
    fn realized(&self, function: &Function, points: usize) -> TokenStream {
        let docs = self.docs(function);
        let name = ident(function.name);
        let is_point = |symbols: &[Symbol]| matches!(symbols.first(), Some(Symbol::Input(i)) if *i >= CANONICAL);
        let arguments = function.arguments.iter().map(|a| {
            let name = self.argument_if(a.name, function.reads(a));
            if is_point(&a.symbols) {
                quote! { #name: &Self::Point }
            } else {
                quote! { #name: &Self::State }
            }
        });
        let (result, size) = match function.shape {
            Shape::Matrix(_) => (quote! { Self::PointMatrix }, Some(points)),
            _ if function.name == "pullback" => (quote! { Self::Point }, Some(points)),
            _ => (quote! { Self::State }, None),
        };
        let body = self.system_body(function, &["out"], size);
        let out = self.argument("out");
        quote! {
            #docs
            #[inline]
            fn #name(&self #(, #arguments)*, #out: &mut #result) {
                #body
            }
        }
    }
}
