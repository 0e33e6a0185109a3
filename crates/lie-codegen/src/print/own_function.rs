//! Calls of functions of the user.

use proc_macro2::TokenStream;
use quote::quote;

use super::Printer;
use super::names::index;
use lie_symbolic::symbolic::Opaque;

impl Printer<'_> {
    /// A function of the user at arguments, or a derivative of it: the declared one where there is one, differentiated
    /// further by dual numbers.
    pub(super) fn own_function(&self, own: Opaque, arguments: &[TokenStream]) -> TokenStream {
        let declared = own.declared();
        let function = self.path(&declared.path);
        let at = quote! { [#(#arguments),*] };
        let by = own.differentiated();
        let Some((first, further)) = by.split_first() else {
            return quote! { #function(#(#arguments),*) };
        };
        let count = arguments.len();
        let Some(slope) = declared.derivatives.get(*first) else {
            return differentiated(&function, count, &by, &at);
        };
        let slope = self.path(slope);
        if !further.is_empty() {
            return differentiated(&slope, count, further, &at);
        }
        let (name, place) = (&declared.name, index(*first));
        let (value, compared) = (of_array(&function, count), of_array(&slope, count));
        quote! { ::lie_runtime::__private::declared_derivative(#name, #compared, #value, #at, #place) }
    }

    /// A path with the place at which it was written.
    fn path(&self, text: &str) -> TokenStream {
        let known = self.surface.functions.iter().find(|(path, _)| path == text);
        match known {
            Some((_, tokens)) => tokens.clone(),
            None => text.parse().unwrap_or_default(),
        }
    }
}

/// A derivative by these arguments, one after the other.
fn differentiated(
    function: &TokenStream,
    count: usize,
    by: &[usize],
    at: &TokenStream,
) -> TokenStream {
    let inner = of_array(function, count);
    let (last, others) = by
        .split_last()
        .map_or((0, by), |(last, others)| (*last, others));
    let nested = others.iter().fold(inner, |inner, place| {
        let place = index(*place);
        quote! { |x| ::lie_runtime::__private::partial(#inner, x, #place) }
    });
    let last = index(last);
    quote! { ::lie_runtime::__private::partial(#nested, #at, #last) }
}

/// A function of its arguments side by side.
fn of_array(function: &TokenStream, count: usize) -> TokenStream {
    let parts = (0..count).map(|place| {
        let place = index(place);
        quote! { x[#place] }
    });
    quote! { |x| #function(#(#parts),*) }
}
