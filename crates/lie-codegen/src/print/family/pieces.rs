//! The pieces of a family as an impl of `Pieces`.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

use super::super::Printer;
use super::super::function::Owner;
use super::super::names::{ident, index};
use super::span;
use crate::plan::{Family, FamilyForm, FamilyPieces};
use lie_symbolic::schedule::Value;
use lie_symbolic::symbolic::Symbol;

/// The turn about a coordinate.
fn turn(a: usize) -> Ident {
    ident(&format!("_turn_{a}"))
}

/// The rate of the second sites of a piece.
fn second(place: usize) -> Ident {
    ident(&format!("_second_{place}"))
}

/// The rate of a piece.
fn rate(place: usize) -> Ident {
    ident(&format!("_rate_{place}"))
}

impl Printer<'_> {
    /// The impl of `Pieces`, and the actions that it needs.
    pub(super) fn pieces_of_family(&self, family: &Family, pieces: &FamilyPieces) -> TokenStream {
        let sites = self.system_name();
        let [c, p, t] = self.counts(family);
        let differ = !family.data.is_empty();
        let around = differ.then(|| quote! { , _at: &[S; #p] });
        let kinds = pieces.kinds.iter().map(|kind| {
            let [down, right] = kind.offset.map(Literal::i64_unsuffixed);
            let spans = kind.spans.iter().map(span);
            let collective = kind.share.is_some();
            quote! { ::lie_runtime::family::Kind { offset: [#down, #right], spans: [#(#spans),*], collective: #collective } }
        });
        let rates = pieces.kinds.iter().enumerate().flat_map(|(place, kind)| {
            let of_second = kind.second.iter();
            let of_second = of_second.map(move |function| (second(place), kind, function));
            [(rate(place), kind, &kind.rate)]
                .into_iter()
                .chain(of_second)
        });
        let rates = rates.map(|(name, kind, function)| {
            let other = kind.second.is_some().then(|| quote! { , _other: &[S; #c] });
            let body = self.kernel(function, 1);
            quote! {
                #[inline]
                fn #name(&self, _one: &[S; #c], _weights: &[S; #t] #around #other) -> S { #body }
            }
        });
        let shares = pieces.kinds.iter().enumerate().filter_map(|(place, kind)| {
            let body = self.kernel(kind.share.as_ref()?, family.sums.len());
            let place = index(place);
            Some(quote! { #place => { #body } })
        });
        let turns = self.turns(family, pieces);
        let [exchanges, flows] = self.flows_of_pieces(family, pieces);
        let exchange = match differ {
            false => quote! { fn exchange(&self, _kind: usize) -> ::core::option::Option<S> },
            true => quote! {
                fn exchange(&self, _kind: usize) -> ::core::option::Option<S> {
                    ::core::option::Option::None
                }

                #[inline]
                fn exchange_of(&self, _kind: usize, _at: &[S; #p]) -> ::core::option::Option<S>
            },
        };
        let flow = match differ {
            false => quote! {
                fn flow(&self, _kind: usize, _t: S, _sums: &[S; #t], _one: &mut [S; #c], _other: &mut [S; #c])
            },
            true => quote! {
                fn flow_of(&self, _kind: usize, _t: S, (_sums, _at): (&[S; #t], &[S; #p]), _one: &mut [S; #c], _other: &mut [S; #c])
            },
        };
        quote! {
            #[allow(non_snake_case, clippy::many_single_char_names, clippy::possible_missing_comma)]
            impl<S: ::lie_runtime::Scalar> #sites<S> {
                #(#rates)*
                #(#turns)*
            }

            #[allow(non_snake_case, clippy::possible_missing_comma)]
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::family::Pieces<S> for #sites<S> {
                fn kinds(&self) -> &[::lie_runtime::family::Kind] {
                    &[#(#kinds),*]
                }

                #[inline]
                #exchange {
                    match _kind {
                        #(#exchanges)*
                        _ => ::core::option::Option::None,
                    }
                }

                #[inline]
                fn share(&self, _kind: usize, _one: &[S; #c]) -> [S; #t] {
                    match _kind {
                        #(#shares)*
                        _ => [S::zero(); #t],
                    }
                }

                #[inline]
                #flow {
                    match _kind {
                        #(#flows)*
                        _ => {}
                    }
                }
            }
        }
    }

    /// The actions `exp(t ad*_(e_a))` that the pieces need.
    fn turns(&self, family: &Family, pieces: &FamilyPieces) -> Vec<TokenStream> {
        let [c, ..] = self.counts(family);
        let own: Vec<Symbol> = (0..family.coordinates.len())
            .map(Symbol::Coordinate)
            .collect();
        let turns = pieces.turns.iter().map(|(a, function, updates)| {
            let (name, docs) = (turn(*a), self.docs(function));
            let unpacked = self.taken(function, &own, &quote! { *_mu });
            let (statements, outputs) = self.program(&function.program, &|value| match value {
                Value::Symbol(Symbol::Time) => quote! { _t },
                value => self.value(value, Owner::System),
            });
            let writes =
                super::super::splitting::updates(function, updates, &ident("_mu"), &outputs);
            quote! {
                #docs
                #[inline]
                fn #name(&self, _t: S, _mu: &mut [S; #c]) { #unpacked #statements #writes }
            }
        });
        turns.collect()
    }

    /// The arms for exchanges, by their rate, and for other pieces, by their flow.
    fn flows_of_pieces(&self, family: &Family, pieces: &FamilyPieces) -> [Vec<TokenStream>; 2] {
        let [c, _, t] = self.counts(family);
        let at = (!family.data.is_empty()).then(|| quote! { , _at });
        let (mut exchanges, mut flows) = (Vec::new(), Vec::new());
        for (place, kind) in pieces.kinds.iter().enumerate() {
            let (kind_place, rate, place) = (place, rate(place), index(place));
            match kind.form {
                FamilyForm::Exchange => exchanges.push(quote! {
                    #place => ::core::option::Option::Some(self.#rate(&[S::zero(); #c], &[S::zero(); #t] #at)),
                }),
                FamilyForm::Site(a) | FamilyForm::Collective(a) => {
                    let turn = turn(a);
                    flows.push(quote! { #place => self.#turn(self.#rate(_one, _sums #at) * _t, _one), });
                }
                FamilyForm::Pair([a, b]) => {
                    let (first, last, of_second) = (turn(a), turn(b), second(kind_place));
                    flows.push(quote! {
                        #place => {
                            let _first = self.#rate(_one, _sums #at, _other) * _t;
                            let _second = self.#of_second(_one, _sums #at, _other) * _t;
                            self.#first(_first, _one);
                            self.#last(_second, _other);
                        }
                    });
                }
                FamilyForm::Product([a, b]) => {
                    let (first, second) = (turn(a), turn(b));
                    let (a, b) = (index(a), index(b));
                    flows.push(quote! {
                        #place => {
                            let _rate = self.#rate(_one, _sums #at) * _t;
                            let (_first, _second) = (_rate * _other[#b], _rate * _one[#a]);
                            self.#first(_first, _one);
                            self.#second(_second, _other);
                        }
                    });
                }
            }
        }
        [exchanges, flows]
    }
}
