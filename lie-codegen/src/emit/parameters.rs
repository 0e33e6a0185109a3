//! The parameter struct: what the user constructs.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::Writer;
use crate::symbolic::{ExprId, Symbol};

impl Writer<'_> {
    /// The parameter struct with its defaults.
    pub fn parameters(&mut self) -> TokenStream {
        let (visibility, name) = (&self.blueprint.visibility, &self.blueprint.name);
        let system = format_ident!("{}System", name);
        let docs = self.blueprint.docs.iter().map(|line| format!(" {line}"));
        let fields = self.blueprint.parameters.iter().map(|p| {
            let (name, doc) = (&p.name, format!(" {}", p.doc));
            quote! { #[doc = #doc] pub #name: S }
        });
        let names: Vec<_> = self
            .blueprint
            .parameters
            .iter()
            .map(|p| p.name.clone())
            .collect();
        let defaults: Vec<ExprId> = self
            .blueprint
            .parameters
            .iter()
            .map(|p| p.default)
            .collect();
        let (statements, values) = self.preparation(&defaults, &|_| quote! { S::zero() });
        let marker = names.is_empty().then(|| {
            quote! { #[doc(hidden)] pub _scalar: ::core::marker::PhantomData<S> }
        });
        let marker_value = names
            .is_empty()
            .then(|| quote! { _scalar: ::core::marker::PhantomData });
        let build = self.build();
        let signs = self.blueprint.parameters.iter().any(|p| p.positive);
        let errors = if signs {
            " If a parameter that must be positive is not, or a constant that the system needs is not finite."
        } else {
            " If a constant that the system needs is not finite, such as the inverse of a zero."
        };
        let initial = self.initial_state();
        quote! {
            #(#[doc = #docs])*
            #[derive(Clone, Debug, PartialEq)]
            #[allow(non_snake_case)]
            #visibility struct #name<S = f64> {
                #(#fields,)*
                #marker
            }

            #[allow(non_snake_case)]
            impl<S: ::lie_runtime::Scalar> ::core::default::Default for #name<S> {
                fn default() -> Self {
                    #statements
                    Self { #(#names: #values,)* #marker_value }
                }
            }

            impl #name<f64> {
                #[doc = " The default parameters in double precision."]
                #[must_use]
                pub fn new() -> Self {
                    ::core::default::Default::default()
                }
            }

            #[allow(non_snake_case)]
            impl<S: ::lie_runtime::Scalar> #name<S> {
                #[doc = " The system for these parameters; what depends on them alone is computed here, once."]
                #[doc = ""]
                #[doc = " # Errors"]
                #[doc = #errors]
                pub fn system(&self) -> ::core::result::Result<#system<S>, ::lie_runtime::ParameterError> {
                    #build
                }
                #initial
            }
        }
    }

    /// The declared initial state, for the parameters at hand.
    fn initial_state(&mut self) -> TokenStream {
        let Some(initial) = self.blueprint.initial.clone() else {
            return TokenStream::new();
        };
        let n = super::names::index(self.source.dimension);
        let (statements, values) = self.preparation(&initial, &|name| quote! { self.#name });
        quote! {
            #[doc = " The initial state of the declaration."]
            #[must_use]
            pub fn initial_state(&self) -> ::lie_runtime::__private::SVector<S, #n> {
                #statements
                ::lie_runtime::__private::SVector::from([#(#values),*])
            }
        }
    }

    /// The body of `system()`: every prepared constant, each tested.
    fn build(&mut self) -> TokenStream {
        let system = format_ident!("{}System", self.blueprint.name);
        let constants = self.prepared.all().to_vec();
        let (statements, values) = self.preparation(&constants, &|name| quote! { self.#name });
        let mut lets = TokenStream::new();
        let mut checks = TokenStream::new();
        let mut fields = Vec::new();
        for (position, (id, value)) in constants.iter().zip(&values).enumerate() {
            let name = self.prepared_name(*id, position);
            let text = self.constant_text(*id);
            let parameter = self
                .source
                .graph
                .symbols(*id)
                .into_iter()
                .find(|s| matches!(s, Symbol::Parameter(_)))
                .map_or_else(String::new, |s| self.shown(s));
            // A bare name of the user could be read as a constant of the user.
            let local = format_ident!("_c{position}");
            lets.extend(quote! { let #local = #value; });
            checks.extend(quote! { (#local, #parameter, #text), });
            fields.push(quote! { #name: #local });
        }
        let check = (!checks.is_empty())
            .then(|| quote! { ::lie_runtime::__private::all_finite(&[#checks])?; });
        let branch = self
            .has_branches()
            .then(|| quote! { _branch: ::core::option::Option::None, });
        let positive = self.blueprint.parameters.iter().filter(|p| p.positive);
        let positive: Vec<_> = positive
            .map(|p| {
                let (name, text) = (&p.name, p.name.to_string());
                quote! { (self.#name, #text) }
            })
            .collect();
        let signs = (!positive.is_empty())
            .then(|| quote! { ::lie_runtime::__private::all_positive(&[#(#positive),*])?; });
        quote! {
            #signs
            #statements
            #lets
            #check
            ::core::result::Result::Ok(#system {
                _parameters: ::core::clone::Clone::clone(self),
                #branch
                #(#fields),*
            })
        }
    }

    /// The struct that holds the prepared constants.
    pub fn system_struct(&mut self) -> TokenStream {
        let (visibility, name) = (&self.blueprint.visibility, &self.blueprint.name);
        let system = format_ident!("{}System", name);
        let constants = self.prepared.all().to_vec();
        let fields = constants.iter().enumerate().map(|(position, id)| {
            let (field, doc) = (
                self.prepared_name(*id, position),
                format!(" `{}`", self.constant_text(*id)),
            );
            quote! { #[doc = #doc] #field: S }
        });
        let doc = format!(" The system [`{name}`] with its derived constants.");
        let names: Vec<_> = self
            .blueprint
            .parameters
            .iter()
            .map(|p| p.name.clone())
            .collect();
        let count = super::names::index(names.len());
        let places: Vec<_> = (0..names.len()).map(super::names::index).collect();
        let marker = names
            .is_empty()
            .then(|| quote! { _scalar: ::core::marker::PhantomData });
        let branch = self.has_branches().then(|| {
            let size = super::names::index(self.source.dimension);
            quote! {
                #[doc = " A velocity of the branch of the Legendre transform; none for that which begins at rest."]
                _branch: ::core::option::Option<[S; #size]>,
            }
        });
        quote! {
            #[doc = #doc]
            #[derive(Clone, Debug, PartialEq)]
            #[allow(non_snake_case)]
            #visibility struct #system<S = f64> {
                _parameters: #name<S>,
                #branch
                #(#fields,)*
            }

            impl<S> #system<S> {
                #[doc = " The parameters from which the system was made."]
                #[must_use]
                pub fn parameters(&self) -> &#name<S> {
                    &self._parameters
                }
            }

            #[allow(non_snake_case)]
            impl<S: ::lie_runtime::Scalar> #name<S> {
                #[doc = " The parameters from their values, in the order of the declaration."]
                #[must_use]
                pub fn from_values(_values: &[S; #count]) -> Self {
                    Self { #(#names: _values[#places],)* #marker }
                }
            }
        }
    }

    /// The same system over dual numbers.
    pub fn lift(&self) -> TokenStream {
        let name = &self.blueprint.name;
        let system = format_ident!("{}System", name);
        let constants = self.prepared.all().iter().enumerate();
        let fields: Vec<_> = constants
            .map(|(position, id)| self.prepared_name(*id, position))
            .collect();
        let names: Vec<_> = self.blueprint.parameters.iter().map(|p| &p.name).collect();
        let marker = self
            .blueprint
            .parameters
            .is_empty()
            .then(|| quote! { _scalar: ::core::marker::PhantomData });
        let branch = self
            .has_branches()
            .then(|| quote! { _branch: self._branch.map(|branch| branch.map(_constant)), });
        quote! {
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::Lift<S> for #system<S> {
                type Lifted = #system<::lie_runtime::Dual<S>>;

                fn lift(&self) -> Self::Lifted {
                    let _constant = |value: S| ::lie_runtime::Dual::constant_of(value);
                    #system {
                        _parameters: #name {
                            #(#names: _constant(self._parameters.#names),)*
                            #marker
                        },
                        #branch
                        #(#fields: _constant(self.#fields),)*
                    }
                }
            }
        }
    }
}
