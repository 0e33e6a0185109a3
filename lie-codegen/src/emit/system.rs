//! The trait impls of a system.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::Writer;
use super::names::{ident, index};
use super::prepared::{Owner, Prepared};
use crate::derive::{Kernel, Shape};
use crate::methods::Choice;

impl Writer<'_> {
    /// The impls of `Poisson` and, where they apply, `LiePoisson` and `CayleyPoisson`.
    pub fn system_impls(&mut self) -> TokenStream {
        let derivatives = self.needs_derivatives();
        let kernels = if derivatives {
            self.source.basic_kernels()
        } else {
            self.source.explicit_kernels()
        };
        let (mut poisson, mut coadjoint, mut cayley, mut gradients) =
            (TokenStream::new(), TokenStream::new(), None, Vec::new());
        for kernel in &kernels {
            match kernel.name {
                "casimir_gradient" => gradients.push(kernel),
                "casimirs" => poisson.extend(self.casimirs(kernel)),
                "ad" | "ad_star" | "ad_star_matrix" => coadjoint.extend(self.method(kernel)),
                "triple" => cayley = Some(self.method(kernel)),
                _ => poisson.extend(self.method(kernel)),
            }
        }
        poisson.extend(self.casimir_gradients(&gradients));
        if self.source.hamiltonian.is_none() {
            poisson.extend(super::lagrangian::energy());
        } else if !derivatives {
            poisson.extend(by_duals());
        }
        let system = format_ident!("{}System", self.blueprint.name);
        let n = index(self.source.dimension);
        let facts = self.facts();
        let coadjoint = self.source.is_lie().then(|| {
            quote! {
                #[allow(non_snake_case, clippy::many_single_char_names)]
                impl<S: ::lie_runtime::Scalar> ::lie_runtime::LiePoisson<S> for #system<S> {
                    #coadjoint
                }
            }
        });
        let spectrum = self.spectrum();
        let cayley = cayley.map(|triple| {
            quote! {
                #[allow(non_snake_case, clippy::many_single_char_names)]
                impl<S: ::lie_runtime::Scalar> ::lie_runtime::CayleyPoisson<S> for #system<S> {
                    #spectrum

                    #triple
                }
            }
        });
        quote! {
            #[allow(non_snake_case, clippy::many_single_char_names)]
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::Poisson<S> for #system<S> {
                type State = ::lie_runtime::__private::SVector<S, #n>;
                type Jacobian = ::lie_runtime::__private::SMatrix<S, #n, #n>;

                #facts

                fn zero_state(&self) -> Self::State {
                    Self::State::repeat(S::zero())
                }

                fn zero_jacobian(&self) -> Self::Jacobian {
                    Self::Jacobian::repeat(S::zero())
                }

                #poisson
            }

            #coadjoint

            #cayley
        }
    }

    /// Whether a method that is asked for solves an equation, or none is named, so that it may be any.
    fn needs_derivatives(&self) -> bool {
        let methods = &self.blueprint.methods;
        let explicit = |choice: &Choice| choice.entry().is_some_and(|row| row.explicit);
        methods.is_empty() || !methods.iter().all(explicit)
    }

    /// What the system says of itself: its size, its names and the degrees of its functions.
    fn facts(&self) -> TokenStream {
        let blueprint = self.blueprint;
        let n = index(self.source.dimension);
        let name = blueprint.name.to_string();
        let coordinates = blueprint.coordinates.iter().map(Ident::to_string);
        let option = |degree: &Option<u32>| match degree {
            Some(degree) => {
                let degree = index(*degree as usize);
                quote! { ::core::option::Option::Some(#degree) }
            }
            None => quote! { ::core::option::Option::None },
        };
        let of_h = blueprint.hamiltonian_degree.is_some().then(|| {
            let degree = option(&blueprint.hamiltonian_degree);
            quote! {
                fn hamiltonian_degree(&self) -> ::core::option::Option<u32> {
                    #degree
                }
            }
        });
        // of an algebra nothing is said: its Poisson matrix is linear
        let of_matrix = (!self.source.is_lie() && blueprint.poisson_degree.is_some()).then(|| {
            let degree = option(&blueprint.poisson_degree);
            quote! {
                fn poisson_degree(&self) -> ::core::option::Option<u32> {
                    #degree
                }
            }
        });
        let casimirs = (!blueprint.casimir_names.is_empty()).then(|| {
            let (count, names) = (
                index(blueprint.casimir_names.len()),
                &blueprint.casimir_names,
            );
            let degrees = blueprint.casimir_degrees.iter().map(option);
            quote! {
                fn casimir_count(&self) -> usize {
                    #count
                }

                fn casimir_name(&self, index: usize) -> &str {
                    [#(#names),*][index]
                }

                fn casimir_degree(&self, index: usize) -> ::core::option::Option<u32> {
                    [#(#degrees),*][index]
                }
            }
        });
        let multivalued = blueprint.multivalued.contains(&true).then(|| {
            let multivalued = &blueprint.multivalued;
            quote! {
                fn casimir_is_multivalued(&self, index: usize) -> bool {
                    [#(#multivalued),*][index]
                }
            }
        });
        quote! {
            fn dimension(&self) -> usize {
                #n
            }

            fn name(&self) -> &str {
                #name
            }

            fn coordinate(&self, index: usize) -> &str {
                [#(#coordinates),*][index]
            }

            #casimirs
            #of_h
            #of_matrix
            #multivalued
        }
    }

    /// A kernel as a method of a trait.
    pub(super) fn method(&mut self, kernel: &Kernel) -> TokenStream {
        let targets: &[&str] = match kernel.shape {
            Shape::VectorAndMatrix(..) => &["field", "jacobian"],
            _ => &["out"],
        };
        let program = kernel.program(&mut self.source.graph);
        let docs = self.kernel_docs(kernel.name, kernel, &program);
        let name = ident(kernel.name);
        let body = self.system_body(kernel, &program, targets);
        let arguments = kernel.arguments.iter().map(|a| {
            let name = if Self::reads(a, &program) {
                self.argument(a.name)
            } else {
                ident(&format!("_{}", a.name))
            };
            quote! { #name: &Self::State }
        });
        let vector = |target: &Ident| quote! { #target: &mut Self::State };
        let matrix = |target: &Ident| quote! { #target: &mut Self::Jacobian };
        let names: Vec<Ident> = targets.iter().map(|target| self.argument(target)).collect();
        let (results, output) = match kernel.shape {
            Shape::Scalar => (Vec::new(), Some(quote! { -> S })),
            Shape::Vector(_) => (vec![vector(&names[0])], None),
            Shape::Matrix(_) => (vec![matrix(&names[0])], None),
            Shape::VectorAndMatrix(..) => (vec![vector(&names[0]), matrix(&names[1])], None),
        };
        quote! {
            #docs
            #[inline]
            fn #name(&self #(, #arguments)* #(, #results)*) #output {
                #body
            }
        }
    }

    pub(super) fn system_body(
        &mut self,
        kernel: &Kernel,
        program: &crate::schedule::Program,
        targets: &[&str],
    ) -> TokenStream {
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
        self.kernel_body(
            kernel,
            program,
            Owner::System,
            &mut Prepared::default(),
            &place,
            targets,
        )
    }

    /// All Casimirs into a slice.
    fn casimirs(&mut self, kernel: &Kernel) -> TokenStream {
        let mut kernel = kernel.clone();
        let count = self.source.casimirs.len();
        // A slice has no entries that would have to be cleared.
        let all: Vec<usize> = (0..self.source.dimension.max(count)).collect();
        if let Shape::Vector(indices) = &kernel.shape
            && indices.len() == count
        {
            kernel.shape = Shape::Vector(all);
        }
        let program = kernel.program(&mut self.source.graph);
        let docs = self.kernel_docs("casimirs", &kernel, &program);
        let body = self.system_body(&kernel, &program, &["out"]);
        let unread = |writer: &Self, name: &str, read: bool| {
            if read {
                writer.argument(name)
            } else {
                ident(&format!("_{name}"))
            }
        };
        let mu = unread(self, "mu", Self::reads(&kernel.arguments[0], &program));
        let out = unread(self, "out", count > 0);
        quote! {
            #docs
            #[inline]
            fn casimirs(&self, #mu: &Self::State, #out: &mut [S]) {
                #body
            }
        }
    }

    fn casimir_gradients(&mut self, kernels: &[&Kernel]) -> TokenStream {
        let out = self.argument("out");
        let mut read = false;
        let mut arms = Vec::new();
        let mut docs = TokenStream::new();
        for (index, kernel) in kernels.iter().enumerate() {
            let program = kernel.program(&mut self.source.graph);
            read |= Self::reads(&kernel.arguments[0], &program);
            let name = &self.blueprint.casimir_names[index];
            self.counts
                .push((format!("casimir_gradient {name}"), program.counts));
            let line = format!(" Gradient of `{name}`: {}.", program.counts);
            docs.extend(quote! { #[doc = #line] });
            let body = self.system_body(kernel, &program, &["out"]);
            let index = super::names::index(index);
            arms.push(quote! { #index => { #body } });
        }
        let count = kernels.len();
        let message = format!(
            "the system has {count} Casimir{}",
            if count == 1 { "" } else { "s" }
        );
        if count == 0 {
            return quote! {
                #[doc = " The system has no Casimir to differentiate."]
                fn casimir_gradient(&self, _index: usize, _mu: &Self::State, _out: &mut Self::State) {
                    panic!("the system has no Casimir");
                }
            };
        }
        let mu = if read {
            self.argument("mu")
        } else {
            ident("_mu")
        };
        quote! {
            #[doc = " `out_i = dC/dmu_i` of one Casimir."]
            #docs
            fn casimir_gradient(&self, _index: usize, #mu: &Self::State, #out: &mut Self::State) {
                match _index {
                    #(#arms)*
                    _ => panic!(#message),
                }
            }
        }
    }
}

/// The derivatives that no method asked for needs: the other methods find them by dual numbers.
fn by_duals() -> TokenStream {
    quote! {
        #[doc = " `out_ij = d^2H/dmu_i dmu_j`, by dual numbers: no method that was asked for needs it."]
        fn hessian(&self, mu: &Self::State, out: &mut Self::Jacobian) {
            ::lie_runtime::generic::hessian_by_duals(self, mu, out);
        }

        #[doc = " `out_ij = df_i/dmu_j`, by dual numbers: no method that was asked for needs it."]
        fn jacobian(&self, mu: &Self::State, out: &mut Self::Jacobian) {
            ::lie_runtime::generic::jacobian_by_duals(self, mu, out);
        }
    }
}
