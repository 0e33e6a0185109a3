//! What acts on a site, and what is recorded of the sums.

use proc_macro2::TokenStream;
use quote::quote;

use super::by_place;
use crate::plan::{Family, Function};
use crate::print::Printer;
use crate::print::names::{ident, index};

impl Printer<'_> {
    /// What a family says of what acts on its sites.
    pub(super) fn facts_of_acting(&self, family: &Family) -> Option<TokenStream> {
        family.driven.as_ref().map(|driven| {
            let (forced, noises) = (driven.forced, index(driven.noises));
            let lost = (0..)
                .zip(&family.casimirs)
                .filter(|(_, casimir)| !casimir.kept);
            let lost: Vec<_> = lost.map(|(place, _)| index(place)).collect();
            let kept = (!lost.is_empty()).then(|| {
                quote! {
                    fn casimir_is_kept(&self, _index: usize) -> bool {
                        ![#(#lost),*].contains(&_index)
                    }
                }
            });
            // of those that are not forced it is said that they are damped
            let damped = (!forced && !driven.damped).then(|| {
                quote! {
                    fn is_damped(&self) -> bool {
                        false
                    }
                }
            });
            quote! {
                fn acts(&self) -> bool {
                    true
                }

                fn is_forced(&self) -> bool {
                    #forced
                }

                #damped

                fn noise_count(&self) -> usize {
                    #noises
                }

                #kept
            }
        })
    }

    /// The vector field of a site, and what acts on it.
    pub(super) fn field_of_site(&self, family: &Family) -> TokenStream {
        let [c, p, t] = self.counts(family);
        let size = family.coordinates.len();
        let (at, weights) = (quote! { _at: &[S; #p] }, quote! { _weights: &[S; #t] });
        let docs = self.docs(&family.field);
        let Some(driven) = &family.driven else {
            let field = self.kernel(&family.field, size);
            return quote! {
                #docs
                #[inline(always)]
                fn field(&self, #at, #weights) -> [S; #c] { #field }
            };
        };
        let names: Vec<_> = (0..size).map(|k| ident(&format!("_f{k}"))).collect();
        let both = |function: &Function| {
            let body = self.kernel(function, size + 1);
            quote! { let [#(#names,)* _power] = { #body }; ([#(#names),*], _power) }
        };
        let (field, act) = (both(&family.field), both(&driven.act));
        let of_act = self.docs(&driven.act);
        let act = match family.shared {
            0 => quote! { fn act(&self, _slope: &[S; #c], #at) -> ([S; #c], S) { #act } },
            _ => quote! {
                fn shared_act(&self, _slope: &[S; #c], #at, #weights) -> ([S; #c], S) { #act }
            },
        };
        quote! {
            #[inline(always)]
            fn field(&self, _at: &[S; #p], _weights: &[S; #t]) -> [S; #c] { self.driven(_at, _weights).0 }

            #docs
            #[inline(always)]
            fn driven(&self, #at, #weights) -> ([S; #c], S) { #field }

            #of_act
            #act
        }
    }

    /// What a bond adds to sums and slopes.
    pub(super) fn bonds_of_family(&self, family: &Family) -> Option<TokenStream> {
        let ([c, _, t], size) = (self.counts(family), family.coordinates.len());
        let bonds = family.bonds.as_ref()?;
        let field = self.data_fields().pop()?;
        let (one, other) = (quote! { _one: &[S; #c] }, quote! { _other: &[S; #c] });
        let summands = self.kernel(&bonds.summands, family.totals());
        let slopes = self.kernel(&bonds.slopes, 2 * size);
        let names: Vec<_> = (0..2 * size).map(|k| ident(&format!("_f{k}"))).collect();
        let (first, second) = names.split_at(size);
        // a kernel takes its arguments as arrays
        let value = quote! { let _value = &[_value]; };
        let summands = match family.shared {
            0 => quote! {
                fn bond_summands(&self, #one, #other, _value: S) -> [S; #t] { #value #summands }
            },
            _ => quote! {
                fn shared_bond_summands(&self, #one, #other, _value: S, _weights: &[S; #t]) -> [S; #t] {
                    #value
                    #summands
                }
            },
        };
        Some(quote! {
            fn bonds(&self) -> &[S] {
                &self.#field
            }

            #[inline]
            #summands

            #[inline]
            fn bond_slopes(&self, #one, #other, _value: S, _weights: &[S; #t]) -> [[S; #c]; 2] {
                #value
                let [#(#names),*] = { #slopes };
                [[#(#first),*], [#(#second),*]]
            }
        })
    }

    /// What is recorded of the sums.
    pub(super) fn observables_of_sums(&self, family: &Family) -> Option<TokenStream> {
        if family.observables.is_empty() {
            return None;
        }
        let [.., t] = self.counts(family);
        let observables = family.observables.iter();
        let count = index(observables.len());
        let names = by_place(observables.clone().map(|observed| {
            let name = &observed.name;
            quote! { #name }
        }));
        let values = observables
            .clone()
            .map(|observed| self.kernel(&observed.value, 1));
        let values = by_place(values.map(|body| quote! { { #body } }));
        let angles = (0..)
            .zip(observables)
            .filter(|(_, observed)| observed.unwrap);
        let angles: Vec<_> = angles.map(|(place, _)| index(place)).collect();
        let unwraps = (!angles.is_empty()).then(|| {
            quote! {
                fn observable_unwraps(&self, _index: usize) -> bool {
                    [#(#angles),*].contains(&_index)
                }
            }
        });
        Some(quote! {
            fn observable_count(&self) -> usize {
                #count
            }

            fn observable_name(&self, _index: usize) -> &str {
                match _index {
                    #names
                    _ => "",
                }
            }

            #unwraps

            fn observable(&self, _index: usize, _weights: &[S; #t]) -> S {
                match _index {
                    #values
                    _ => S::zero(),
                }
            }
        })
    }
}
