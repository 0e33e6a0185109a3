//! What a system says of the functions that are recorded beside its state, and of events.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::Printer;
use super::names::index;

impl Printer<'_> {
    /// Their number, their names, which are angles and which are kept; nothing where there are none.
    pub(super) fn facts_of_quantities(&self) -> Option<TokenStream> {
        let quantities = &self.plan.system.quantities;
        if quantities.is_empty() {
            return None;
        }
        let (count, names) = (index(quantities.len()), quantities.iter().map(|q| &q.name));
        let unwraps = quantities.iter().map(|q| q.unwrap);
        let unwraps = quantities.iter().any(|q| q.unwrap).then(|| {
            quote! {
                fn quantity_unwraps(&self, index: usize) -> bool {
                    [#(#unwraps),*][index]
                }
            }
        });
        let conserved = quantities.iter().map(|q| q.conserved);
        let conserved = quantities.iter().any(|q| q.conserved).then(|| {
            quote! {
                fn quantity_is_conserved(&self, index: usize) -> bool {
                    [#(#conserved),*][index]
                }
            }
        });
        Some(quote! {
            fn quantity_count(&self) -> usize {
                #count
            }

            fn quantity_name(&self, index: usize) -> &str {
                [#(#names),*][index]
            }

            #unwraps
            #conserved
        })
    }

    /// The number of events, their names, and what their zeros do; nothing where there are none.
    pub(super) fn facts_of_events(&self) -> Option<TokenStream> {
        let events = &self.plan.system.events;
        if events.is_empty() {
            return None;
        }
        let (count, names) = (index(events.len()), events.iter().map(|e| &e.name));
        let rules = events.iter().map(|event| {
            let (stops, size) = (
                event.rule.stops,
                Literal::i8_unsuffixed(event.rule.direction.abs()),
            );
            let direction = match event.rule.direction < 0 {
                true => quote! { -#size },
                false => quote! { #size },
            };
            quote! { ::lie_runtime::EventRule { direction: #direction, stops: #stops } }
        });
        Some(quote! {
            fn event_count(&self) -> usize {
                #count
            }

            fn event_name(&self, index: usize) -> &str {
                [#(#names),*][index]
            }

            fn event_rule(&self, index: usize) -> ::lie_runtime::EventRule {
                [#(#rules),*][index]
            }
        })
    }
}
