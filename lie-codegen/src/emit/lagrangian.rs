//! Systems by a Lagrangian: its trait, and the energy where it comes from Newton's iteration.

use proc_macro2::TokenStream;
use quote::quote;

use super::Writer;

impl Writer<'_> {
    /// The impl of `LagrangianPoisson`, if there is a Lagrangian.
    pub fn lagrangian(&mut self) -> Option<TokenStream> {
        let kernels = self.source.lagrangian_kernels()?;
        let methods: Vec<TokenStream> = kernels.iter().map(|kernel| self.method(kernel)).collect();
        let system = self.system_name();
        Some(quote! {
            #[allow(non_snake_case, clippy::many_single_char_names)]
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::LagrangianPoisson<S> for #system<S> {
                #(#methods)*
            }
        })
    }
}

/// The methods of `Poisson` for a Hamiltonian that has no expression.
pub(super) fn energy() -> TokenStream {
    quote! {
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
