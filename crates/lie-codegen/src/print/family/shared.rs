//! What all sites share, and what depends on the time.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::by_place;
use crate::plan::Family;
use crate::print::Printer;
use crate::print::names::index;

impl Printer<'_> {
    /// The summands.
    pub(super) fn summands_of_site(&self, family: &Family) -> TokenStream {
        let [_, p, t] = self.counts(family);
        let body = self.kernel(&family.summands, family.totals());
        match family.shared {
            0 => quote! { fn summands(&self, _at: &[S; #p]) -> [S; #t] { #body } },
            _ => quote! {
                fn shared_summands(&self, _at: &[S; #p], _weights: &[S; #t]) -> [S; #t] { #body }
            },
        }
    }

    /// `dH/dt`, where H depends on the time.
    pub(super) fn time_slope(&self, family: &Family) -> Option<TokenStream> {
        let function = family.time_slope.as_ref()?;
        let [.., t] = self.counts(family);
        let (docs, body) = (self.docs(function), self.kernel(function, 1));
        Some(quote! {
            fn is_autonomous(&self) -> bool {
                false
            }

            #docs
            fn time_slope(&self, _weights: &[S; #t]) -> S { #body }
        })
    }

    /// What a family says of the time and of inputs.
    pub(super) fn facts_of_shared(&self, family: &Family) -> Option<TokenStream> {
        let count = Some(family.shared).filter(|count| *count > 0)?;
        let count = index(count);
        let inputs = self.facts_of_inputs(family);
        Some(quote! {
            fn is_timed(&self) -> bool {
                true
            }

            fn shared_count(&self) -> usize {
                #count
            }

            #inputs
        })
    }

    fn facts_of_inputs(&self, family: &Family) -> Option<TokenStream> {
        let inputs = family.inputs.iter();
        let names = by_place(inputs.clone().map(|input| {
            let name = &input.name;
            quote! { #name }
        }));
        let number = |bits: u64| Literal::f64_unsuffixed(f64::from_bits(bits));
        let defaults = by_place(inputs.clone().map(|input| {
            let default = number(input.default);
            quote! { S::from_f64(#default) }
        }));
        let samplings = by_place(inputs.map(|input| match input.sampling {
            Some(bits) => {
                let time = number(bits);
                quote! { ::core::option::Option::Some(#time) }
            }
            None => quote! { ::core::option::Option::None },
        }));
        (!family.inputs.is_empty()).then(|| {
            quote! {
                fn input_name(&self, _index: usize) -> &str {
                    match _index {
                        #names
                        _ => "",
                    }
                }

                fn input_default(&self, _index: usize) -> S {
                    match _index {
                        #defaults
                        _ => S::zero(),
                    }
                }

                fn input_sampling(&self, _index: usize) -> ::core::option::Option<f64> {
                    match _index {
                        #samplings
                        _ => ::core::option::Option::None,
                    }
                }
            }
        })
    }
}
