//! The parameter struct, which the user constructs, and the struct of the system.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::Printer;
use super::function::Owner;
use super::names::{ident, index};
use crate::plan::{Code, Data};
use lie_symbolic::schedule::Value;
use lie_symbolic::symbolic::Symbol;

impl Printer<'_> {
    /// The field of the system that holds a constant.
    pub(super) fn constant_name(&self, position: usize) -> Ident {
        ident(&self.plan.constants.entries[position].name)
    }

    fn constant_names(&self) -> Vec<Ident> {
        let count = self.plan.constants.entries.len();
        (0..count)
            .map(|position| self.constant_name(position))
            .collect()
    }

    /// Statements and values of a program whose symbols are parameters.
    fn of_parameters(
        &self,
        code: &Code,
        parameter: &dyn Fn(&Ident) -> TokenStream,
    ) -> (TokenStream, Vec<TokenStream>) {
        self.program(code, &|value| match value {
            Value::Symbol(symbol @ Symbol::Parameter(_)) => parameter(&self.local(*symbol)),
            other => self.value(other, Owner::System),
        })
    }

    /// The field that bears the scalar where there is no parameter.
    fn marker(&self) -> Option<TokenStream> {
        let none = self.plan.parameters.is_empty();
        none.then(|| quote! { _scalar: ::core::marker::PhantomData })
    }

    /// What has a value for each site of a family.
    fn data(&self) -> &[Data] {
        let family = self.plan.family.as_ref();
        family.map_or(&[], |family| family.data.as_slice())
    }

    /// The fields of the parameter struct that hold these values.
    fn data_names(&self) -> Vec<Ident> {
        self.data().iter().map(|data| ident(&data.name)).collect()
    }

    /// The fields of the sites that hold as many of them as there are sites.
    pub(super) fn data_fields(&self) -> Vec<Ident> {
        let data = self.data().iter();
        data.map(|data| format_ident!("_at_{}", data.name))
            .collect()
    }

    /// The parameter struct with its defaults.
    pub(super) fn parameters(&self) -> TokenStream {
        let (visibility, name, system) =
            (&self.surface.visibility, self.name(), self.system_name());
        let docs = self.plan.docs.iter().map(|line| format!(" {line}"));
        let names = self.parameters_by_name();
        let fields = names.iter().zip(&self.plan.parameters).map(|(name, p)| {
            let doc = format!(" {}", p.doc);
            quote! { #[doc = #doc] pub #name: S }
        });
        let (statements, values) =
            self.of_parameters(&self.plan.defaults, &|_| quote! { S::zero() });
        let (data, listed) = (self.data_names(), self.data());
        let described = listed.iter().map(|data| {
            let what = match data.bonds {
                true => "Three numbers for each: i, j, value.",
                false => "A value for each site, of a lattice row after row, layer after layer.",
            };
            format!(" {} {what}", data.doc)
        });
        let listed = listed.iter().map(|data| {
            let values = data.values().map(Literal::f64_suffixed);
            quote! {{
                const _VALUES: &[f64] = &[#(#values),*];
                _VALUES.iter().copied().map(S::from_f64).collect()
            }}
        });
        let listed: Vec<TokenStream> = listed.collect();
        let defaults = (!data.is_empty())
            .then(|| quote! { let _default = <Self as ::core::default::Default>::default(); });
        let marker = names.is_empty().then(|| {
            quote! { #[doc(hidden)] pub _scalar: ::core::marker::PhantomData<S> }
        });
        let marker_value = self.marker();
        let (count, places) = (index(names.len()), (0..names.len()).map(index));
        let build = self.build();
        let errors = if self.plan.parameters.iter().any(|p| p.positive) {
            " If a parameter that must be positive is not, or a constant that the system needs is not finite."
        } else {
            " If a constant that the system needs is not finite, such as the inverse of a zero."
        };
        let initial = self.initial_state();
        let attitude = self.initial_attitude();
        let family = self.plan.family.is_some();
        let make = ident(if family { "sites" } else { "system" });
        let what = if family {
            " One site of the family for these parameters; what depends on them alone is computed here, once."
        } else {
            " The system for these parameters; what depends on them alone is computed here, once."
        };
        quote! {
            #(#[doc = #docs])*
            #[derive(Clone, Debug, PartialEq)]
            #[allow(non_snake_case)]
            #visibility struct #name<S = f64> {
                #(#fields,)*
                #(#[doc = #described] pub #data: ::std::vec::Vec<S>,)*
                #marker
            }

            #[allow(non_snake_case)]
            impl<S: ::lie_runtime::Scalar> ::core::default::Default for #name<S> {
                fn default() -> Self {
                    #statements
                    Self { #(#names: #values,)* #(#data: #listed,)* #marker_value }
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
                #[doc = " The parameters from their values, in the order of the declaration."]
                #[must_use]
                pub fn from_values(_values: &[S; #count]) -> Self {
                    #defaults
                    Self { #(#names: _values[#places],)* #(#data: _default.#data,)* #marker_value }
                }

                #[doc = #what]
                #[doc = ""]
                #[doc = " # Errors"]
                #[doc = #errors]
                pub fn #make(&self) -> ::core::result::Result<#system<S>, ::lie_runtime::ParameterError> {
                    #build
                }
                #initial
                #attitude
            }
        }
    }

    /// The declared initial state, for the parameters at hand.
    fn initial_state(&self) -> Option<TokenStream> {
        let initial = self.plan.initial.as_ref()?;
        let n = index(self.plan.dimension());
        let (statements, values) = self.of_parameters(initial, &|name| quote! { self.#name });
        Some(quote! {
            #[doc = " The initial state of the declaration."]
            #[must_use]
            pub fn initial_state(&self) -> ::lie_runtime::__private::SVector<S, #n> {
                #statements
                ::lie_runtime::__private::SVector::from([#(#values),*])
            }
        })
    }

    /// The declared group element at the start, for the parameters at hand.
    fn initial_attitude(&self) -> Option<TokenStream> {
        let attitude = self.plan.attitude.as_ref()?;
        let (statements, values) = self.of_parameters(attitude, &|name| quote! { self.#name });
        let n = index(values.len());
        Some(quote! {
            #[doc = " The group element at the start, as the declaration has it: its matrix by rows, for `Reconstruction::at_matrix`."]
            #[must_use]
            #[allow(clippy::possible_missing_comma)]
            pub fn initial_attitude(&self) -> [S; #n] {
                #statements
                [#(#values),*]
            }
        })
    }

    /// The body of `system()`: every prepared constant, each tested.
    fn build(&self) -> TokenStream {
        let system = self.system_name();
        let constants = &self.plan.constants;
        let (statements, values) =
            self.of_parameters(&constants.program, &|name| quote! { self.#name });
        let names = self.constant_names();
        // A bare name of the user could be read as a constant of the user.
        let locals: Vec<Ident> = (0..names.len()).map(|k| format_ident!("_c{k}")).collect();
        let checks = constants.entries.iter().zip(&locals).map(|(entry, local)| {
            let parameter = entry.parameter.map(Symbol::Parameter);
            let parameter = parameter.map(|symbol| self.plan.names.display_name(symbol));
            let (parameter, text) = (parameter.unwrap_or_default(), &entry.text);
            quote! { (#local, #parameter, #text), }
        });
        let check = (!names.is_empty())
            .then(|| quote! { ::lie_runtime::__private::all_finite(&[#(#checks)*])?; });
        let branch = self
            .has_branches()
            .then(|| quote! { _branch: ::core::option::Option::None, });
        let signs = self.signs();
        let (fields, given) = (self.data_fields(), self.data_names());
        let padded = self.data().iter().zip(&fields).zip(&given);
        let padded = padded.map(|((data, field), given)| {
            let (text, unused) = (&data.name, index(data.unused));
            if data.bonds {
                return quote! {
                    let #field = ::lie_runtime::family::bonds(&self.#given, #text, _sizes)?;
                };
            }
            quote! {
                let #field = ::lie_runtime::family::values(&self.#given, #text, _sizes, #unused)?;
            }
        });
        let padded: Vec<TokenStream> = padded.collect();
        let sizes = (!fields.is_empty()).then(|| quote! { let _sizes = self.sizes()?; });
        let fields = fields.iter();
        quote! {
            #signs
            #statements
            #(let #locals = #values;)*
            #check
            #sizes
            #(#padded)*
            ::core::result::Result::Ok(#system {
                _parameters: ::core::clone::Clone::clone(self),
                #branch
                #(#fields,)*
                #(#names: #locals),*
            })
        }
    }

    /// The test of the parameters that must be positive.
    fn signs(&self) -> Option<TokenStream> {
        let names = self.parameters_by_name();
        let parameters = names.iter().zip(&self.plan.parameters);
        let positive: Vec<_> = parameters
            .filter(|(_, p)| p.positive)
            .map(|(name, _)| {
                let text = name.to_string();
                quote! { (self.#name, #text) }
            })
            .collect();
        (!positive.is_empty())
            .then(|| quote! { ::lie_runtime::__private::all_positive(&[#(#positive),*])?; })
    }

    /// The struct that holds the prepared constants.
    pub(super) fn system_struct(&self) -> TokenStream {
        let (visibility, name, system) =
            (&self.surface.visibility, self.name(), self.system_name());
        let entries = self.plan.constants.entries.iter();
        let fields = entries.zip(self.constant_names()).map(|(entry, field)| {
            let doc = format!(" `{}`", entry.text);
            quote! { #[doc = #doc] #field: S }
        });
        let data = self.data_fields();
        let doc = format!(" The system [`{name}`] with its derived constants.");
        let branch = self.has_branches().then(|| {
            let size = index(self.plan.dimension());
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
                #(#data: ::std::vec::Vec<S>,)*
                #(#fields,)*
            }

            impl<S> #system<S> {
                #[doc = " The parameters from which the system was made."]
                #[must_use]
                pub fn parameters(&self) -> &#name<S> {
                    &self._parameters
                }
            }
        }
    }

    /// The same system over dual numbers, and over eight numbers at once.
    pub(super) fn other_scalars(&self) -> TokenStream {
        let (over, system) = (self.scalar_conversion(), self.system_name());
        quote! {
            #over

            ::lie_runtime::__private::over_scalars!(#system);
        }
    }

    /// The same with its constants as other scalars.
    pub(super) fn scalar_conversion(&self) -> TokenStream {
        let (name, system) = (self.name(), self.system_name());
        let fields = self.constant_names();
        let names = self.parameters_by_name();
        let marker = self.marker();
        let (data, given) = (self.data_fields(), self.data_names());
        let branch = self
            .has_branches()
            .then(|| quote! { _branch: self._branch.map(|branch| branch.map(&_constant)), });
        quote! {
            impl<S: ::lie_runtime::Scalar> #system<S> {
                fn _over<T: ::lie_runtime::Scalar>(&self, _constant: impl Fn(S) -> T) -> #system<T> {
                    #system {
                        _parameters: #name {
                            #(#names: _constant(self._parameters.#names),)*
                            #(#given: self._parameters.#given.iter().map(|value| _constant(*value)).collect(),)*
                            #marker
                        },
                        #branch
                        #(#data: self.#data.iter().map(|value| _constant(*value)).collect(),)*
                        #(#fields: _constant(self.#fields),)*
                    }
                }
            }
        }
    }
}
