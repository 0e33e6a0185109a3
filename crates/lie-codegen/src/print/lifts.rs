//! The impls of traits for the linear spaces of collective methods.

use proc_macro2::TokenStream;
use quote::quote;

use super::Printer;
use super::names::{ident, index};
use super::structure::{entries, entry, use_entries};
use crate::plan::Function;
use crate::structure::lifts::Smallest;

impl Printer<'_> {
    pub(super) fn column_poisson(&self) -> Option<TokenStream> {
        let representation = self.plan.structure.representation.as_ref()?;
        let columns = representation.columns.as_ref()?;
        let system = self.system_name();
        let (size, count) = (representation.column, representation.point);
        let flow = representation.flow.as_ref();
        let flow = flow.map(|f| self.flow_on(f, &quote! { Self::Columns }, count));
        let indices = columns.indices.iter().map(|k| index(*k));
        let covectors = columns.covectors.iter().map(|matrix| entries(matrix));
        let (count, size, entries) = (index(count), index(size), use_entries());
        Some(quote! {
            #[allow(non_snake_case, clippy::many_single_char_names)]
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::ColumnPoisson<S> for #system<S> {
                type Columns = ::lie_runtime::__private::SVector<S, #count>;

                fn zero_columns(&self) -> Self::Columns {
                    Self::Columns::repeat(S::zero())
                }

                fn column_size(&self) -> usize {
                    #size
                }

                fn columns(&self) -> ::lie_runtime::__private::Columns<'_> {
                    #entries
                    ::lie_runtime::__private::Columns {
                        indices: &[#(#indices),*],
                        covectors: &[#(#covectors),*],
                    }
                }

                #flow
            }
        })
    }

    pub(super) fn unitary_poisson(&self) -> Option<TokenStream> {
        let unitary = self.plan.structure.unitary.as_ref()?;
        let system = self.system_name();
        let flow = unitary.flow.as_ref();
        let flow = flow.map(|f| self.flow_on(f, &quote! { Self::Factor }, unitary.point));
        let [degree, count, entries] =
            [unitary.degree, unitary.point, 4 * unitary.degree.pow(2)].map(index);
        Some(quote! {
            #[allow(non_snake_case, clippy::many_single_char_names)]
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::UnitaryPoisson<S> for #system<S> {
                fn degree(&self) -> usize {
                    #degree
                }

                type Shift = ::lie_runtime::__private::SVector<S, 1>;

                fn zero_shift(&self) -> Self::Shift {
                    Self::Shift::repeat(S::zero())
                }

                type Factor = ::lie_runtime::__private::SVector<S, #count>;

                fn zero_factor(&self) -> Self::Factor {
                    Self::Factor::repeat(S::zero())
                }

                type Hermitian = ::lie_runtime::__private::SVector<S, #entries>;

                fn zero_hermitian(&self) -> Self::Hermitian {
                    Self::Hermitian::repeat(S::zero())
                }

                #flow
            }
        })
    }

    /// The flow of points on a linear space.
    pub(super) fn flow_on(
        &self,
        function: &Function,
        point: &TokenStream,
        size: usize,
    ) -> TokenStream {
        let docs = self.docs(function);
        let name = ident(function.name);
        let arguments = function.arguments.iter().map(|a| {
            let name = self.argument_if(a.name, function.reads(a));
            let of = match a.name {
                "point" => point.clone(),
                "shift" => quote! { Self::Shift },
                _ => quote! { Self::Labels },
            };
            quote! { #name: &#of }
        });
        let body = self.system_body(function, &["out"], Some(size));
        let out = self.argument("out");
        quote! {
            #docs
            #[inline]
            fn #name(&self #(, #arguments)*, #out: &mut #point) {
                #body
            }
        }
    }

    pub(super) fn vector_poisson(&self) -> Option<TokenStream> {
        let vectors = self.plan.structure.vectors.as_ref()?;
        let system = self.system_name();
        let rotation = vectors.rotation.map(index);
        let triples = vectors.vectors.iter().map(|components| {
            let components = components
                .each_ref()
                .map(|(k, factor)| entry(*k, 0, factor));
            quote! { *entries!(#(#components),*) }
        });
        let (scale, entries) = (self.value_of(&vectors.scale), use_entries());
        let labels = index(match vectors.vectors.len() {
            1 => 1,
            count => 3 * count,
        });
        let flow = vectors.flow.as_ref();
        let flow = flow.map(|f| self.flow_on(f, &quote! { Self::Quaternions }, 8));
        Some(quote! {
            #[allow(non_snake_case, clippy::many_single_char_names)]
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::VectorPoisson<S> for #system<S> {
                fn rotation(&self) -> [usize; 3] {
                    [#(#rotation),*]
                }

                fn vectors(&self) -> &[[::lie_runtime::__private::Entry; 3]] {
                    #entries
                    const VECTORS: &[[::lie_runtime::__private::Entry; 3]] = &[#(#triples),*];
                    VECTORS
                }

                #[inline]
                fn scale(&self) -> S {
                    #scale
                }

                type Labels = ::lie_runtime::__private::SVector<S, #labels>;

                fn zero_labels(&self) -> Self::Labels {
                    Self::Labels::repeat(S::zero())
                }

                type Quaternions = ::lie_runtime::__private::SVector<S, 8>;

                fn zero_quaternions(&self) -> Self::Quaternions {
                    Self::Quaternions::repeat(S::zero())
                }

                #flow
            }
        })
    }

    /// Which space collective methods go over where none is asked for.
    pub(super) fn collective_poisson(&self) -> Option<TokenStream> {
        let system = self.system_name();
        let lift = ident(match self.plan.structure.smallest? {
            Smallest::Hopf => "Hopf",
            Smallest::Quaternion => "Quaternion",
            Smallest::Unitary => "Unitary",
            Smallest::Representation => "Representation",
        });
        Some(quote! {
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::CollectivePoisson<S> for #system<S> {
                type Lift = ::lie_runtime::methods::#lift;
            }
        })
    }
}
