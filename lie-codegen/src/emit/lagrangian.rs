//! Systems by a Lagrangian: its traits, and the energy where it comes from Newton's iteration.

use proc_macro2::TokenStream;
use quote::quote;

use super::Writer;
use super::names::ident;
use crate::derive::{Kernel, Shape};

impl Writer<'_> {
    /// The impls of `LagrangianPoisson` and `DiscreteLagrangianPoisson`, if there are such Lagrangians.
    pub fn lagrangian(&mut self) -> Option<TokenStream> {
        let kernels = self.source.lagrangian_kernels()?;
        let methods: Vec<TokenStream> = kernels.iter().map(|kernel| self.method(kernel)).collect();
        let system = self.system_name();
        let discrete = self.discrete_lagrangian();
        let branch = self.has_branches().then(|| {
            quote! {
                fn branch(&self) -> ::core::option::Option<Self::State> {
                    self._branch.map(<Self::State>::from)
                }
            }
        });
        Some(quote! {
            #[allow(non_snake_case, clippy::many_single_char_names)]
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::LagrangianPoisson<S> for #system<S> {
                #(#methods)*
                #branch
            }

            #discrete
        })
    }

    /// Whether the velocity of a momentum is found along a path, of which the system remembers a point.
    pub(super) fn has_branches(&self) -> bool {
        self.source.hamiltonian.is_none() && self.source.lagrangian.is_some()
    }

    fn discrete_lagrangian(&mut self) -> Option<TokenStream> {
        let kernels = self.source.discrete_kernels()?;
        let methods: Vec<TokenStream> = kernels.iter().map(|k| self.of_step(k)).collect();
        let system = self.system_name();
        Some(quote! {
            #[allow(non_snake_case, clippy::many_single_char_names)]
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::DiscreteLagrangianPoisson<S> for #system<S> {
                #(#methods)*
            }
        })
    }

    /// A kernel of the step size and x as a method of a trait.
    fn of_step(&mut self, kernel: &Kernel) -> TokenStream {
        let program = kernel.program(&mut self.source.graph);
        let docs = self.kernel_docs(kernel.name, kernel, &program);
        let body = self.system_body(kernel, &program, &["out"]);
        let name = ident(kernel.name);
        let argument = &kernel.arguments[0];
        let x = if Self::reads(argument, &program) {
            self.argument(argument.name)
        } else {
            ident(&format!("_{}", argument.name))
        };
        let out = self.argument("out");
        let (target, result) = match kernel.shape {
            Shape::Scalar => (None, Some(quote! { -> S })),
            Shape::Matrix(_) => (Some(quote! { , #out: &mut Self::Jacobian }), None),
            _ => (Some(quote! { , #out: &mut Self::State }), None),
        };
        quote! {
            #docs
            #[inline]
            fn #name(&self, _h: S, #x: &Self::State #target) #result {
                #body
            }
        }
    }
}

/// The methods of `Poisson` for a Hamiltonian that has no expression.
pub(super) fn energy() -> TokenStream {
    quote! {
        #[doc = " The system with the velocity of mu as a point of its branch."]
        fn following(&self, mu: &Self::State) -> ::core::option::Option<Self> {
            let velocity = ::lie_runtime::lagrangian::legendre::follow(self, mu)?;
            let _branch = ::core::option::Option::Some(velocity.data.0[0]);
            ::core::option::Option::Some(Self { _branch, ..::core::clone::Clone::clone(self) })
        }

        #[doc = " `H(mu) = <mu, xi> - l(xi)`, `l'(xi) = mu` by Newton's iteration."]
        fn hamiltonian(&self, mu: &Self::State) -> S {
            ::lie_runtime::lagrangian::legendre::hamiltonian(self, mu)
        }

        #[doc = " `out = xi`, `l'(xi) = mu`."]
        fn gradient(&self, mu: &Self::State, out: &mut Self::State) {
            ::lie_runtime::lagrangian::legendre::velocity(self, mu, out);
        }

        #[doc = " `out = l''(xi)^-1`, `l'(xi) = mu`."]
        fn hessian(&self, mu: &Self::State, out: &mut Self::Jacobian) {
            ::lie_runtime::lagrangian::legendre::hessian(self, mu, out);
        }

        #[doc = " `out_ij = df_i/dmu_j`"]
        fn jacobian(&self, mu: &Self::State, out: &mut Self::Jacobian) {
            ::lie_runtime::generic::jacobian(self, mu, out);
        }
    }
}
