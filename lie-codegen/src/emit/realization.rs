//! The impl of a realization.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::Writer;
use super::function::Extent;
use super::names::{ident, index};
use super::prepared::{Owner, Prepared};
use crate::derive::{Kernel, Shape};
use crate::model::CANONICAL;
use crate::symbolic::Symbol;

impl Writer<'_> {
    /// The impl of `RealizedPoisson`, where a realization is declared.
    pub fn realization(&mut self) -> Option<TokenStream> {
        let realization = self.source.realization.clone()?;
        let system = self.system_name();
        let count = index(realization.names.len());
        let names = &realization.names;
        let given = realization.given;
        let kernels = self.source.realization_kernels()?;
        let mut methods = TokenStream::new();
        for kernel in &kernels {
            methods.extend(self.realized(kernel, realization.names.len()));
        }
        let start = realization.start.iter().enumerate().map(|(i, value)| {
            let kernel = Kernel::scalar("", "", Vec::new(), *value);
            let program = kernel.program(&mut self.source.graph);
            let mut none = Prepared::default();
            let (statements, outputs) = self.program(&program, |writer, value| {
                writer.value(value, Owner::System, &mut none)
            });
            let i = index(i);
            quote! { out[#i] = { #statements #(#outputs)* }; }
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
    fn realized(&mut self, kernel: &Kernel, points: usize) -> TokenStream {
        let program = kernel.program(&mut self.source.graph);
        let docs = self.kernel_docs(kernel.name, kernel, &program);
        let name = ident(kernel.name);
        let is_point = |symbols: &[Symbol]| matches!(symbols.first(), Some(Symbol::Input(i)) if *i >= CANONICAL);
        let arguments = kernel.arguments.iter().map(|a| {
            let name = if Self::reads(a, &program) {
                self.argument(a.name)
            } else {
                ident(&format!("_{}", a.name))
            };
            if is_point(&a.symbols) {
                quote! { #name: &Self::Point }
            } else {
                quote! { #name: &Self::State }
            }
        });
        let arguments: Vec<TokenStream> = arguments.collect();
        let to_point = kernel.name == "pullback";
        let (result, extent) = match kernel.shape {
            Shape::Matrix(_) => (quote! { Self::PointMatrix }, Extent::Of(points)),
            _ if to_point => (quote! { Self::Point }, Extent::Of(points)),
            _ => (quote! { Self::State }, Extent::State),
        };
        let names: Vec<(String, Ident)> = kernel
            .arguments
            .iter()
            .map(|a| (a.name.to_string(), self.argument(a.name)))
            .collect();
        let place = move |name: &str| {
            let ident = names
                .iter()
                .find(|(n, _)| n == name)
                .map(|(_, ident)| ident);
            quote! { #ident }
        };
        let (owner, mut none) = (Owner::System, Prepared::default());
        let body = self.sized_body(kernel, &program, owner, &mut none, &place, &["out"], extent);
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
