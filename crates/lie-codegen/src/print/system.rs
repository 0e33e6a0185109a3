//! The trait impls of a system.

use proc_macro2::TokenStream;
use quote::quote;

use super::Printer;
use super::names::{ident, index};
use crate::derive::Shape;
use crate::plan::{Energy, Function};

impl Printer<'_> {
    /// The impls of `Poisson` and, where they apply, `LiePoisson` and `CayleyPoisson`.
    pub(super) fn traits(&self) -> TokenStream {
        let plan = &self.plan.system;
        let poisson: TokenStream = plan
            .poisson
            .iter()
            .map(|function| match function.name {
                "casimirs" => self.vector_function(function, plan.casimirs.len()),
                "joints" => self.vector_function(function, plan.joints),
                "quantities" => self.vector_function(function, plan.quantities.len()),
                "events" => self.vector_function(function, plan.events.len()),
                _ => self.system_method(function, None),
            })
            .collect();
        let gradients = self.casimir_gradients();
        let derived = match (plan.energy, plan.derivatives) {
            (Energy::Legendre, _) => Some(self.by_legendre()),
            (Energy::Expression, false) => Some(by_duals()),
            (Energy::Expression, true) => None,
        };
        let system = self.system_name();
        let n = index(self.plan.dimension());
        let facts = self.facts();
        let closed = (!plan.exponential.is_empty()).then(|| {
            let methods = plan.exponential.iter().map(|f| self.system_method(f, None));
            let slope = plan.exponential.iter().any(|f| f.name == "dexp_dual_slope");
            quote! {
                fn has_closed_exponential(&self) -> bool {
                    true
                }

                fn has_closed_slope(&self) -> bool {
                    #slope
                }

                #(#methods)*
            }
        });
        let algebra = self.trait_of("LiePoisson", &plan.algebra, closed);
        let spectrum = self.spectrum();
        let cayley = self.trait_of("CayleyPoisson", plan.triple.as_slice(), spectrum);
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
                #gradients
                #derived
            }

            #algebra

            #cayley
        }
    }

    /// The impls of `LagrangianPoisson` and `DiscreteLagrangianPoisson`, if there are such Lagrangians.
    pub(super) fn lagrangian(&self) -> Option<TokenStream> {
        let plan = &self.plan.system;
        let velocities = plan.velocities.map(index).map(|count| {
            quote! {
                fn velocities(&self) -> usize {
                    #count
                }
            }
        });
        let branch = self.has_branches().then(|| {
            quote! {
                fn branch(&self) -> ::core::option::Option<Self::State> {
                    self._branch.map(<Self::State>::from)
                }

                #velocities
            }
        });
        let lagrangian = self.trait_of("LagrangianPoisson", &plan.lagrangian, branch);
        let discrete = self.trait_of("DiscreteLagrangianPoisson", &plan.discrete, None);
        Some(quote! { #lagrangian #discrete })
    }

    /// The methods of `Poisson` for a Hamiltonian that has no expression.
    fn by_legendre(&self) -> TokenStream {
        let system = &self.plan.system;
        let [of_value, of_gradient, of_hessian] = match system.velocities {
            None => [
                " `H(mu) = <mu, xi> - l(xi)`, `l'(xi) = mu` by Newton's iteration.",
                " `out = xi`, `l'(xi) = mu`.",
                " `out = l''(xi)^-1`, `l'(xi) = mu`.",
            ],
            Some(_) => [
                " `H(mu, q) = <mu, xi> - L(xi, q)`, `dL/dxi = mu` by Newton's iteration.",
                " `out = (xi, -dL/dq)`, `dL/dxi = mu`.",
                " `out = H''(mu, q)`, of the blocks of `L''(xi, q)` at `dL/dxi = mu`.",
            ],
        };
        let gradient = match system.velocities {
            None => quote!(velocity),
            Some(_) => quote!(gradient),
        };
        let energy = system.clock.map(|clock| {
            let momentum = index(clock.momentum);
            quote! {
                #[doc = " `H(t, mu)`, without the momentum of the time."]
                fn energy(&self, mu: &Self::State) -> S {
                    let mut mu = ::core::clone::Clone::clone(mu);
                    mu[#momentum] = S::zero();
                    self.hamiltonian(&mu)
                }
            }
        });
        quote! {
            #[doc = " The system with the velocity of mu as a point of its branch."]
            fn following(&self, mu: &Self::State) -> ::core::option::Option<Self> {
                self.on_branch(&::lie_runtime::lagrangian::legendre::follow(self, mu)?)
            }

            #[doc = " The system with a velocity as a point of its branch."]
            fn on_branch(&self, velocity: &Self::State) -> ::core::option::Option<Self> {
                let _branch = ::core::option::Option::Some(velocity.data.0[0]);
                ::core::option::Option::Some(Self { _branch, ..::core::clone::Clone::clone(self) })
            }

            #[doc = #of_value]
            fn hamiltonian(&self, mu: &Self::State) -> S {
                ::lie_runtime::lagrangian::legendre::hamiltonian(self, mu)
            }

            #energy

            #[doc = #of_gradient]
            fn gradient(&self, mu: &Self::State, out: &mut Self::State) {
                ::lie_runtime::lagrangian::legendre::#gradient(self, mu, out);
            }

            #[doc = #of_hessian]
            fn hessian(&self, mu: &Self::State, out: &mut Self::Jacobian) {
                ::lie_runtime::lagrangian::legendre::hessian(self, mu, out);
            }

            #[doc = " `out_ij = df_i/dmu_j`"]
            fn jacobian(&self, mu: &Self::State, out: &mut Self::Jacobian) {
                ::lie_runtime::generic::jacobian(self, mu, out);
            }
        }
    }

    /// Whether the velocity of a momentum is found along a path, of which the system remembers a point.
    pub(super) fn has_branches(&self) -> bool {
        self.plan.system.energy == Energy::Legendre
    }

    /// The impl of a trait by these kernels, if there are any; those of a discrete Lagrangian are given the step size.
    pub(super) fn trait_of(
        &self,
        name: &str,
        functions: &[Function],
        rest: Option<TokenStream>,
    ) -> Option<TokenStream> {
        let step = (name == "DiscreteLagrangianPoisson").then(|| quote! { , _h: S });
        let methods = functions
            .iter()
            .map(|f| self.system_method(f, step.as_ref()));
        let methods: Vec<_> = methods.collect();
        // bodies that are not written are provided
        let is_there = !methods.is_empty() || name == "LiePoisson" && self.plan.system.lie;
        let (name, system) = (ident(name), self.system_name());
        is_there.then(|| {
            quote! {
                #[allow(non_snake_case, clippy::many_single_char_names)]
                impl<S: ::lie_runtime::Scalar> ::lie_runtime::#name<S> for #system<S> {
                    #(#methods)*
                    #rest
                }
            }
        })
    }

    /// A kernel as a method of a trait.
    fn system_method(&self, function: &Function, step: Option<&TokenStream>) -> TokenStream {
        let targets: &[&str] = match function.shape {
            Shape::VectorAndMatrix(..) => &["field", "jacobian"],
            _ => &["out"],
        };
        let docs = self.docs(function);
        let name = ident(function.name);
        let body = self.system_body(function, targets, None);
        let arguments = function.arguments.iter().map(|a| {
            let name = self.argument_if(a.name, function.reads(a));
            quote! { , #name: &Self::State }
        });
        let vector = |position: usize| {
            let target = self.argument(targets[position]);
            quote! { , #target: &mut Self::State }
        };
        let matrix = |position: usize| {
            let target = self.argument(targets[position]);
            quote! { , #target: &mut Self::Jacobian }
        };
        let (results, output) = match function.shape {
            Shape::Scalar => (TokenStream::new(), Some(quote! { -> S })),
            Shape::Vector(_) => (vector(0), None),
            Shape::Matrix(_) => (matrix(0), None),
            Shape::VectorAndMatrix(..) => {
                let (vector, matrix) = (vector(0), matrix(1));
                (quote! { #vector #matrix }, None)
            }
        };
        quote! {
            #docs
            #[inline]
            fn #name(&self #step #(#arguments)* #results) #output {
                #body
            }
        }
    }

    /// So many values into a slice.
    pub(super) fn vector_function(&self, function: &Function, count: usize) -> TokenStream {
        let docs = self.docs(function);
        let body = self.system_body(function, &["out"], None);
        let argument = &function.arguments[0];
        let mu = self.argument_if(argument.name, function.reads(argument));
        let out = self.argument_if("out", count > 0);
        let name = ident(function.name);
        quote! {
            #docs
            #[inline]
            fn #name(&self, #mu: &Self::State, #out: &mut [S]) {
                #body
            }
        }
    }

    fn casimir_gradients(&self) -> TokenStream {
        let casimirs = &self.plan.system.casimirs;
        let count = casimirs.len();
        if count == 0 {
            return quote! {
                #[doc = " The system has no Casimir to differentiate."]
                fn casimir_gradient(&self, _index: usize, _mu: &Self::State, _out: &mut Self::State) {
                    panic!("the system has no Casimir");
                }
            };
        }
        let gradients = casimirs.iter().map(|casimir| casimir.gradient.as_ref());
        let Some(gradients) = gradients.collect::<Option<Vec<&Function>>>() else {
            return casimir_gradient_by_duals(count);
        };
        let docs = casimirs.iter().zip(&gradients).map(|(casimir, gradient)| {
            let counts = gradient.program.counts;
            format!(" Gradient of `{}`: {counts}.", casimir.name)
        });
        let arms = gradients.iter().enumerate().map(|(position, gradient)| {
            let body = self.system_body(gradient, &["out"], None);
            let position = index(position);
            quote! { #position => { #body } }
        });
        let read = gradients.iter().any(|g| g.reads(&g.arguments[0]));
        let (mu, out) = (self.argument_if("mu", read), self.argument("out"));
        let message = format!(
            "the system has {count} Casimir{}",
            if count == 1 { "" } else { "s" }
        );
        quote! {
            #[doc = " `out_i = dC/dmu_i` of one Casimir."]
            #(#[doc = #docs])*
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

/// The gradients of so many Casimirs, which no method asked for needs either.
fn casimir_gradient_by_duals(count: usize) -> TokenStream {
    let count = index(count);
    quote! {
        #[doc = " `out_i = dC/dmu_i` of one Casimir, by dual numbers: no method that was asked for needs it."]
        fn casimir_gradient(&self, index: usize, mu: &Self::State, out: &mut Self::State) {
            let values = &mut [::lie_runtime::Dual::constant_of(S::zero()); #count];
            ::lie_runtime::generic::casimir_gradient_by_duals(self, index, mu, out, values);
        }
    }
}
