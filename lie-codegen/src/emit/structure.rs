//! The impls of traits for structure that not every system has: a representation, spins, inertia.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::Writer;
use super::names::index;
use super::prepared::{Owner, Prepared};
use crate::derive::Kernel;
use crate::exact::Rational;
use crate::structure::inertia::Body;
use crate::structure::spectrum::{Spectrum, spectrum};
use crate::symbolic::ExprId;

impl Writer<'_> {
    /// The impls that the system has a structure for.
    pub fn structure(&mut self) -> TokenStream {
        let matrices = self.matrix_poisson();
        let spins = self.spin_poisson();
        let inertia = self.inertia_poisson();
        let cotangent = self.cotangent_poisson();
        let group = self.matrix_group();
        quote! { #group #matrices #spins #inertia #cotangent }
    }

    fn matrix_poisson(&self) -> Option<TokenStream> {
        let representation = self.source.matrices.as_ref()?;
        let dual = representation.dual.as_ref()?;
        let system = self.system_name();
        let size = index(representation.dimension);
        let skew = representation
            .matrices
            .iter()
            .chain(dual)
            .all(|matrix| is_skew(matrix));
        let matrices = representation.matrices.iter().map(|matrix| entries(matrix));
        let dual = dual.iter().map(|matrix| entries(matrix));
        let spectrum = self.spectrum();
        Some(quote! {
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::MatrixPoisson<S> for #system<S> {
                type Matrix = ::lie_runtime::__private::SMatrix<S, #size, #size>;

                fn representation(&self) -> ::lie_runtime::__private::Representation<'_> {
                    const REPRESENTATION: ::lie_runtime::__private::Representation = ::lie_runtime::__private::Representation {
                        matrices: &[#(#matrices),*],
                        dual: &[#(#dual),*],
                        skew: #skew,
                    };
                    REPRESENTATION
                }

                #spectrum

                fn zero_matrix(&self) -> Self::Matrix {
                    Self::Matrix::repeat(S::zero())
                }
            }
        })
    }

    /// What is known of the eigenvalues of the representation, where one carries the methods that need it.
    pub(super) fn known_spectrum(&self) -> Option<Spectrum> {
        let representation = self.source.matrices.as_ref()?;
        Some(spectrum(&representation.matrices))
    }

    /// The method of the traits that says it.
    pub(super) fn spectrum(&self) -> Option<TokenStream> {
        let value = match self.known_spectrum()? {
            Spectrum::Imaginary => quote! { ::lie_runtime::__private::Spectrum::Imaginary },
            Spectrum::Bounded(weights) => {
                let weights = weights.into_iter().map(Literal::f64_unsuffixed);
                quote! { ::lie_runtime::__private::Spectrum::Bounded(&[#(#weights),*]) }
            }
        };
        Some(quote! {
            fn spectrum(&self) -> ::lie_runtime::__private::Spectrum<'_> {
                #value
            }
        })
    }

    fn matrix_group(&self) -> Option<TokenStream> {
        let group = self.source.group.as_ref()?;
        let system = self.system_name();
        let size = index(group.size);
        let (closed, right) = (group.closed, group.right);
        let orthogonal = group.matrices.iter().all(|matrix| is_skew(matrix));
        let matrices = group.matrices.iter().map(|matrix| entries(matrix));
        Some(quote! {
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::MatrixGroup<S> for #system<S> {
                fn group(&self) -> ::lie_runtime::__private::Group<'_> {
                    const GROUP: ::lie_runtime::__private::Group = ::lie_runtime::__private::Group {
                        size: #size,
                        matrices: &[#(#matrices),*],
                        closed: #closed,
                        orthogonal: #orthogonal,
                        right: #right,
                    };
                    GROUP
                }
            }
        })
    }

    fn cotangent_poisson(&self) -> Option<TokenStream> {
        let momenta = index(self.source.momenta?);
        let system = self.system_name();
        Some(quote! {
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::CotangentPoisson<S> for #system<S> {
                type Momentum = ::lie_runtime::__private::SVector<S, #momenta>;
                type MomentumMatrix = ::lie_runtime::__private::SMatrix<S, #momenta, #momenta>;

                fn momenta(&self) -> usize {
                    #momenta
                }

                fn zero_momentum(&self) -> Self::Momentum {
                    Self::Momentum::repeat(S::zero())
                }

                fn zero_momentum_matrix(&self) -> Self::MomentumMatrix {
                    Self::MomentumMatrix::repeat(S::zero())
                }
            }
        })
    }

    fn spin_poisson(&mut self) -> Option<TokenStream> {
        let spins = self.source.spins.clone()?;
        let system = self.system_name();
        let triples = spins.iter().map(|spin| {
            let triple = spin.coordinates.map(index);
            quote! { [#(#triple),*] }
        });
        let scales: Vec<ExprId> = spins.iter().map(|spin| spin.scale).collect();
        let (argument, value) = self.chosen("spin", &scales);
        Some(quote! {
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::SpinPoisson<S> for #system<S> {
                fn spins(&self) -> &[[usize; 3]] {
                    &[#(#triples),*]
                }

                #[inline]
                fn scale(&self, #argument: usize) -> S {
                    #value
                }
            }
        })
    }

    fn inertia_poisson(&mut self) -> Option<TokenStream> {
        let Body::Many { planes, moments } = self.source.body.clone()? else {
            return None;
        };
        let system = self.system_name();
        let size = index(moments.len());
        let planes = planes.iter().map(|&(from, to)| {
            let (from, to) = (index(from), index(to));
            quote! { ::lie_runtime::__private::Plane::new(#from, #to) }
        });
        let (argument, value) = self.chosen("axis", &moments);
        Some(quote! {
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::InertiaPoisson<S> for #system<S> {
                type Matrix = ::lie_runtime::__private::SMatrix<S, #size, #size>;

                fn planes(&self) -> &[::lie_runtime::__private::Plane] {
                    const PLANES: &[::lie_runtime::__private::Plane] = &[#(#planes),*];
                    PLANES
                }

                fn zero_matrix(&self) -> Self::Matrix {
                    Self::Matrix::repeat(S::zero())
                }

                #[inline]
                fn moment(&self, #argument: usize) -> S {
                    #value
                }
            }
        })
    }

    /// One of several constants, by an argument.
    fn chosen(&mut self, argument: &str, values: &[ExprId]) -> (proc_macro2::Ident, TokenStream) {
        let mut texts = Vec::new();
        for value in values {
            let kernel = Kernel::scalar("", "", Vec::new(), *value);
            let program = kernel.program(&mut self.source.graph);
            let mut none = Prepared::default();
            let (statements, outputs) = self.program(&program, |writer, value| {
                writer.value(value, Owner::System, &mut none)
            });
            texts.push(quote! { #statements #(#outputs)* });
        }
        let same = values.iter().all(|value| *value == values[0]);
        let name = super::names::ident(&if same {
            format!("_{argument}")
        } else {
            argument.to_owned()
        });
        let Some((last, others)) = texts.split_last() else {
            return (name, quote! { S::zero() });
        };
        if same {
            return (name, last.clone());
        }
        let arms = others.iter().enumerate().map(|(k, text)| {
            let k = index(k);
            quote! { #k => { #text } }
        });
        let value = quote! { match #name { #(#arms)* _ => { #last } } };
        (name, value)
    }
}

fn is_skew(matrix: &[Vec<Rational>]) -> bool {
    matrix.iter().enumerate().all(|(i, row)| {
        row.iter()
            .enumerate()
            .all(|(j, entry)| (entry + &matrix[j][i]).is_zero())
    })
}

/// The nonzero entries of a matrix.
fn entries(matrix: &[Vec<Rational>]) -> TokenStream {
    let mut tokens = Vec::new();
    for (i, row) in matrix.iter().enumerate() {
        for (j, entry) in row.iter().enumerate().filter(|(_, v)| !v.is_zero()) {
            let (i, j) = (index(i), index(j));
            let high = entry.to_f64();
            let low = Rational::from_f64(high).map_or(0.0, |high| (entry - &high).to_f64());
            let exact = low == 0.0;
            let (high, low) = (Literal::f64_unsuffixed(high), Literal::f64_unsuffixed(low));
            tokens.push(if exact {
                quote! { ::lie_runtime::__private::Entry::new(#i, #j, #high) }
            } else {
                quote! { ::lie_runtime::__private::Entry::parts(#i, #j, #high, #low) }
            });
        }
    }
    quote! { &[#(#tokens),*] }
}
