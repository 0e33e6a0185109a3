//! The impls of traits for structure that not every system has: a representation, spins, inertia.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

use super::Printer;
use super::function::Owner;
use super::names::{ident, index};
use crate::plan::{Code, Function, Spectrum};
use crate::structure::integrable::Motion;
use lie_symbolic::exact::Rational;

impl Printer<'_> {
    /// The impls that the system has a structure for.
    pub(super) fn structure(&self) -> TokenStream {
        let matrices = self.matrix_poisson();
        let spins = self.spin_poisson();
        let inertia = self.inertia_poisson();
        let integrable = self.integrable_poisson();
        let cotangent = self.cotangent_poisson();
        let group = self.matrix_group();
        let (vectors, collective) = (self.vector_poisson(), self.collective_poisson());
        let unitary = self.unitary_poisson();
        let retracted = self.retracted_poisson();
        let canonical = self.trait_of("CanonicalPoisson", &self.plan.structure.canonical, None);
        quote! { #group #retracted #canonical #matrices #spins #integrable #vectors #unitary #collective #inertia #cotangent }
    }

    fn matrix_poisson(&self) -> Option<TokenStream> {
        let representation = self.plan.structure.representation.as_ref()?;
        let system = self.system_name();
        let (size, skew) = (index(representation.size), representation.skew);
        let matrices = representation.matrices.iter().map(|matrix| entries(matrix));
        let dual = representation.dual.iter().map(|matrix| entries(matrix));
        let spectrum = self.spectrum();
        let columns = self.column_poisson();
        let entries = use_entries();
        Some(quote! {
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::MatrixPoisson<S> for #system<S> {
                type Matrix = ::lie_runtime::__private::SMatrix<S, #size, #size>;

                fn representation(&self) -> ::lie_runtime::__private::Representation<'_> {
                    #entries
                    ::lie_runtime::__private::Representation {
                        matrices: &[#(#matrices),*],
                        dual: &[#(#dual),*],
                        skew: #skew,
                    }
                }

                #spectrum

                fn zero_matrix(&self) -> Self::Matrix {
                    Self::Matrix::repeat(S::zero())
                }
            }
            #columns
        })
    }

    /// The method of the traits that says what is known of the eigenvalues of the representation.
    pub(super) fn spectrum(&self) -> Option<TokenStream> {
        let value = match self.plan.structure.spectrum()? {
            Spectrum::Imaginary => quote! { ::lie_runtime::__private::Spectrum::Imaginary },
            Spectrum::Bounded(weights) => {
                let weights = weights.iter().map(Rational::to_f64);
                let weights = weights.map(Literal::f64_unsuffixed);
                quote! { ::lie_runtime::__private::Spectrum::Bounded(&[#(#weights),*]) }
            }
        };
        Some(quote! {
            fn spectrum(&self) -> ::lie_runtime::__private::Spectrum<'_> {
                #value
            }
        })
    }

    /// The kernel of the matrix of the declared retraction, and the others.
    fn retraction(&self) -> (Option<&Function>, &[Function]) {
        match self.plan.structure.retraction.split_last() {
            Some((element, others)) => (Some(element), others),
            None => (None, &[]),
        }
    }

    /// The impl of a declared retraction.
    fn retracted_poisson(&self) -> Option<TokenStream> {
        self.trait_of("RetractedPoisson", self.retraction().1, None)
    }

    fn matrix_group(&self) -> Option<TokenStream> {
        let group = self.plan.structure.group.as_ref()?;
        let system = self.system_name();
        let size = index(group.size);
        let (closed, orthogonal, right) = (group.closed, group.orthogonal, group.right);
        let known = self.plan.structure.representation.as_ref();
        let matrices = match known.is_some_and(|known| known.matrices == group.matrices) {
            true => quote! { ::lie_runtime::MatrixPoisson::<S>::representation(self).matrices },
            false => {
                let matrices = group.matrices.iter().map(|matrix| entries(matrix));
                quote! { &[#(#matrices),*] }
            }
        };
        let entries = known.is_none_or(|known| known.matrices != group.matrices);
        let entries = entries.then(use_entries);
        let (element, _) = self.retraction();
        let retract = element.map(|element| self.vector_function(element, group.size * group.size));
        Some(quote! {
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::MatrixGroup<S> for #system<S> {
                fn group(&self) -> ::lie_runtime::__private::Group<'_> {
                    #entries
                    ::lie_runtime::__private::Group {
                        size: #size,
                        matrices: #matrices,
                        closed: #closed,
                        orthogonal: #orthogonal,
                        right: #right,
                    }
                }

                #retract
            }
        })
    }

    fn cotangent_poisson(&self) -> Option<TokenStream> {
        let momenta = index(self.plan.structure.momenta?);
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

    fn spin_poisson(&self) -> Option<TokenStream> {
        let spins = self.plan.structure.spins.as_ref()?;
        let system = self.system_name();
        let triples = spins.coordinates.iter().map(|coordinates| {
            let triple = coordinates.map(index);
            quote! { [#(#triple),*] }
        });
        let (argument, value) = self.chosen("spin", &spins.scales);
        let size = 4 * spins.scales.len();
        let flow = spins.flow.as_ref();
        let flow = flow.map(|f| self.flow_on(f, &quote! { Self::Spinors }, size));
        let coordinates = index(size);
        Some(quote! {
            #[allow(non_snake_case, clippy::many_single_char_names)]
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::SpinPoisson<S> for #system<S> {
                fn spins(&self) -> &[[usize; 3]] {
                    &[#(#triples),*]
                }

                #[inline]
                fn scale(&self, #argument: usize) -> S {
                    #value
                }

                type Spinors = ::lie_runtime::__private::SVector<S, #coordinates>;

                fn zero_spinors(&self) -> Self::Spinors {
                    ::lie_runtime::__private::SVector::from_element(S::zero())
                }

                #flow
            }
        })
    }

    fn integrable_poisson(&self) -> Option<TokenStream> {
        let motion = self.plan.structure.motion?;
        let system = self.system_name();
        let name = ident(&format!("{motion:?}"));
        let bodies = (motion == Motion::Bodies).then(|| {
            quote! {
                fn bodies(&self) -> &[[usize; 3]] {
                    ::lie_runtime::SpinPoisson::<S>::spins(self)
                }

                fn body_scale(&self, body: usize) -> S {
                    ::lie_runtime::SpinPoisson::<S>::scale(self, body)
                }
            }
        });
        Some(quote! {
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::IntegrablePoisson<S> for #system<S> {
                fn motion(&self) -> ::lie_runtime::__private::Motion {
                    ::lie_runtime::__private::Motion::#name
                }

                #bodies
            }
        })
    }

    fn inertia_poisson(&self) -> Option<TokenStream> {
        let inertia = self.plan.structure.inertia.as_ref()?;
        let system = self.system_name();
        let size = index(inertia.moments.len());
        let planes = inertia.planes.iter().map(|&(from, to)| {
            let (from, to) = (index(from), index(to));
            quote! { ::lie_runtime::__private::Plane::new(#from, #to) }
        });
        let (argument, value) = self.chosen("axis", &inertia.moments);
        let products = inertia.products.iter().map(|((i, j), product)| {
            let ([i, j], value) = ([*i, *j].map(index), self.value_of(product));
            quote! { (#i, #j) | (#j, #i) => { #value } }
        });
        let products = (!inertia.products.is_empty()).then(|| {
            quote! {
                fn is_tilted(&self) -> bool {
                    true
                }
                fn product(&self, row: usize, column: usize) -> S {
                    match (row, column) {
                        #(#products)*
                        _ => S::zero(),
                    }
                }
            }
        });
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

                #products
            }
        })
    }

    /// The value of a program that depends on the constants of the system alone.
    pub(super) fn value_of(&self, code: &Code) -> TokenStream {
        let (statements, outputs) = self.program(code, &|value| self.value(value, Owner::System));
        quote! { #statements #(#outputs)* }
    }

    /// One of several constants, by an argument.
    fn chosen(&self, argument: &str, values: &[Code]) -> (Ident, TokenStream) {
        let texts: Vec<_> = values.iter().map(|value| self.value_of(value)).collect();
        let same = values.iter().all(|value| *value == values[0]);
        let name = ident(&if same {
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

/// An entry of a matrix.
pub(super) fn entry(row: usize, column: usize, value: &Rational) -> TokenStream {
    let (i, j) = (index(row), index(column));
    let high = value.to_f64();
    let low = Rational::from_f64(high).map_or(0.0, |high| (value - &high).to_f64());
    let plain = || Literal::f64_unsuffixed(low);
    let low = (low != 0.0).then(|| format!("{low:e}").parse().unwrap_or_else(|_| plain()));
    let low = low.into_iter();
    let high = Literal::f64_unsuffixed(high);
    quote! { (#i, #j, #high #(, #low)*) }
}

/// The name by which the entries of matrices are written.
pub(super) fn use_entries() -> TokenStream {
    quote! { use ::lie_runtime::__private::entries; }
}

/// The nonzero entries of a matrix.
pub(super) fn entries(matrix: &[Vec<Rational>]) -> TokenStream {
    let rows = matrix.iter().enumerate();
    let tokens = rows.flat_map(|(i, row)| {
        let values = row.iter().enumerate().filter(|(_, value)| !value.is_zero());
        values.map(move |(j, value)| entry(i, j, value))
    });
    quote! { entries!(#(#tokens),*) }
}
