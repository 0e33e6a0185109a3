//! Equations of methods that need a structure: a representation, spins, inertia.

use proc_macro2::{Ident, TokenStream};

use super::Writer;
use super::names::ident;
use crate::structure::inertia::Body;

impl Writer<'_> {
    /// The fused equations that are asked for; the others go to the list of generic ones.
    pub fn collective(&mut self, generic: &mut Vec<Ident>) -> TokenStream {
        let tokens = TokenStream::new();
        if self.source.matrices.is_some() {
            // with one stage over a closed representation it is the retraction method
            let closed = self.source.triple.is_some();
            generic.push(ident(if closed {
                "isospectral2_cayley"
            } else {
                "isospectral2"
            }));
            generic.push(ident("isospectral4"));
            generic.push(ident("isospectral6"));
        }
        if self.source.spins.is_some() {
            generic.push(ident("hopf"));
            generic.push(ident("spherical"));
        }
        match &self.source.body {
            Some(Body::Three) => generic.push(ident("moser_veselov")),
            Some(Body::Many { .. }) => generic.push(ident("moser_veselov_n")),
            None => {}
        }
        tokens
    }
}
