//! The value of a method in the runtime, as Rust.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::rows::Row;
use super::{Choice, Pieces};

impl Choice {
    /// The type of a method in the runtime whose equation a plan may have code for.
    pub(crate) fn type_of(&self) -> TokenStream {
        (Row::find(self).path)()
    }

    /// The value of a method that is a type with a default.
    pub(crate) fn at_defaults(&self) -> TokenStream {
        match self {
            Self::Taylor | Self::LieTaylor | Self::Dopri5 => {
                let name = self.type_of();
                quote! { <#name as ::core::default::Default>::default() }
            }
            other => other.constructor(),
        }
    }

    /// The value of the method in the runtime, as Rust; `tolerances` is in scope.
    pub fn constructor(&self) -> TokenStream {
        let row = Row::find(self);
        let value = (row.value)();
        match (self, &row.choice) {
            (Self::Splitting(order, scheme, pieces), Self::Splitting(_, default, _)) => {
                // of order 1 the scheme means nothing
                let scheme = (*order > 1 && scheme != default).then(|| with_scheme(scheme));
                let coordinate = *pieces == Pieces::Coordinate;
                let coordinate = coordinate.then(|| quote! { .coordinate() });
                quote! { #value #scheme #coordinate }
            }
            (Self::Compose(_, scheme, base), Self::Compose(_, default, _)) => {
                let scheme = (scheme != default).then(|| with_scheme(scheme));
                let base = base.constructor();
                quote! { #value::new(#base) #scheme }
            }
            _ => value,
        }
    }
}

fn with_scheme(scheme: &super::Scheme) -> TokenStream {
    let scheme = format_ident!("{scheme:?}");
    quote! { .scheme(::lie_runtime::methods::Scheme::#scheme) }
}
