//! The pieces of a family as an impl of `Pieces`.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

use super::super::Printer;
use super::super::names::{ident, index};
use crate::plan::{Family, FamilyForm, FamilyPiece, FamilyPieces, Function, Push};
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

/// The flow of a piece that is no turn about a coordinate.
fn own_flow(place: usize) -> Ident {
    ident(&format!("_flow_{place}"))
}

/// Whether a piece has a speed along its flow.
fn has_rate(form: FamilyForm) -> bool {
    !matches!(form, FamilyForm::Still | FamilyForm::Flow(_))
}

impl Printer<'_> {
    /// The impl of `Pieces`, and the actions that it needs.
    pub(super) fn pieces_of_family(&self, family: &Family, pieces: &FamilyPieces) -> TokenStream {
        let sites = self.system_name();
        let [c, p, t] = self.counts(family);
        let differ = family.has_coefficients();
        let around = differ.then(|| quote! { , _at: &[S; #p] });
        let kinds = pieces.kinds.iter().map(|kind| {
            let offset = kind.offset.map(Literal::i64_unsuffixed);
            let spans = kind.spans.iter().map(span);
            let collective = kind.share.is_some();
            quote! { ::lie_runtime::family::Kind { offset: [#(#offset),*], spans: [#(#spans),*], collective: #collective } }
        });
        let of_rates = pieces.kinds.iter().enumerate();
        let of_rates = of_rates.filter(|(_, kind)| has_rate(kind.form));
        let rates = of_rates.flat_map(|(place, kind)| {
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
        let own_flows = self.own_flows(family, pieces);
        let turns = self.turns(family, pieces);
        let [exchanges, flows] = self.flows_of_pieces(family, pieces);
        let sums = self.exchanges_and_shares(family, pieces, &exchanges);
        let acting = self.effects_of_pieces(family, pieces);
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
                #(#own_flows)*
                #(#turns)*
            }

            #[allow(non_snake_case, clippy::possible_missing_comma)]
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::family::Pieces<S> for #sites<S> {
                fn kinds(&self) -> &[::lie_runtime::family::Kind] {
                    &[#(#kinds),*]
                }

                #sums

                #acting

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

    /// The rates of exchanges, by their arms, and what sites add to sums.
    fn exchanges_and_shares(
        &self,
        family: &Family,
        pieces: &FamilyPieces,
        exchanges: &[TokenStream],
    ) -> TokenStream {
        let [c, p, t] = self.counts(family);
        let option = quote! { ::core::option::Option<S> };
        let none = quote! {
            fn exchange(&self, _kind: usize) -> #option {
                ::core::option::Option::None
            }

            #[inline]
        };
        let exchange = match (family.shared, family.has_coefficients()) {
            (0, false) => quote! { fn exchange(&self, _kind: usize) -> #option },
            (0, true) => {
                quote! { #none fn exchange_of(&self, _kind: usize, _at: &[S; #p]) -> #option }
            }
            _ => quote! {
                fn shared_exchange(&self, _kind: usize, _at: &[S; #p], _sums: &[S; #t]) -> #option
            },
        };
        let share = match family.shared {
            0 => quote! { fn share(&self, _kind: usize, _one: &[S; #c]) -> [S; #t] },
            _ => quote! {
                fn shared_share(&self, _kind: usize, _one: &[S; #c], _weights: &[S; #t]) -> [S; #t]
            },
        };
        let shares = pieces.kinds.iter().enumerate().filter_map(|(place, kind)| {
            let body = self.kernel(kind.share.as_ref()?, family.totals());
            let place = index(place);
            Some(quote! { #place => { #body } })
        });
        quote! {
            #[inline]
            #exchange {
                match _kind {
                    #(#exchanges)*
                    _ => ::core::option::Option::None,
                }
            }

            #[inline]
            #share {
                match _kind {
                    #(#shares)*
                    _ => [S::zero(); #t],
                }
            }
        }
    }

    /// The flows that are no turns about a coordinate.
    fn own_flows(&self, family: &Family, pieces: &FamilyPieces) -> Vec<TokenStream> {
        let [c, p, t] = self.counts(family);
        let around = family
            .has_coefficients()
            .then(|| quote! { , _at: &[S; #p] });
        let flows = pieces.kinds.iter().enumerate();
        let flows = flows.filter(|(_, kind)| matches!(kind.form, FamilyForm::Flow(_)));
        let flows = flows.map(|(place, kind)| {
            let (name, docs) = (own_flow(place), self.docs(&kind.rate));
            let body = self.kernel(&kind.rate, family.coordinates.len());
            quote! {
                #docs
                #[inline]
                fn #name(&self, _t: S, _one: &[S; #c], _weights: &[S; #t] #around) -> [S; #c] { #body }
            }
        });
        flows.collect()
    }

    /// What pieces do beside moving sites along their orbits, where some do.
    fn effects_of_pieces(&self, family: &Family, pieces: &FamilyPieces) -> TokenStream {
        let [c, p, t] = self.counts(family);
        let kinds = || pieces.kinds.iter().enumerate();
        let effects: Vec<TokenStream> = kinds()
            .filter(|(_, kind)| kind.timed.is_some() || kind.push().is_some())
            .map(|(place, kind)| {
                let (place, timed) = (index(place), kind.timed.is_some());
                let (pushes, works) = (kind.push().is_some(), kind.push() == Some(Push::Friction));
                quote! {
                    #place => ::lie_runtime::family::Effects { timed: #timed, pushes: #pushes, works: #works },
                }
            })
            .collect();
        let effects = (!effects.is_empty()).then(|| {
            quote! {
                fn effects(&self, _kind: usize) -> ::lie_runtime::family::Effects {
                    match _kind {
                        #(#effects)*
                        _ => ::core::default::Default::default(),
                    }
                }
            }
        });
        let arms = |slope: fn(&FamilyPiece) -> Option<&Function>| {
            let arms = kinds().filter_map(move |(place, kind)| {
                let body = self.kernel(slope(kind)?, 1);
                let place = index(place);
                Some(quote! { #place => { #body } })
            });
            arms.collect::<Vec<_>>()
        };
        let each = arms(|kind| kind.timed.as_ref());
        let each = (!each.is_empty()).then(|| {
            quote! {
                #[inline]
                fn time_slope_of(
                    &self, _kind: usize, (_weights, _at): (&[S; #t], &[S; #p]), _one: &[S; #c], _other: &[S; #c],
                ) -> S {
                    match _kind {
                        #(#each)*
                        _ => S::zero(),
                    }
                }
            }
        });
        let of_sums = arms(|kind| kind.timed_by_sums.as_ref());
        let of_sums = (!of_sums.is_empty()).then(|| {
            quote! {
                fn time_slope_of_sums(&self, _kind: usize, _weights: &[S; #t]) -> S {
                    match _kind {
                        #(#of_sums)*
                        _ => S::zero(),
                    }
                }
            }
        });
        let rest = pieces.rest.as_ref().map(|rest| {
            let body = self.kernel(rest, 1);
            quote! { fn rest(&self, _weights: &[S; #t]) -> S { #body } }
        });
        quote! { #effects #each #of_sums #rest }
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
            let (statements, outputs) = self.program(&function.program, &|value| self.leaf(value));
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
        let at = family.has_coefficients().then(|| quote! { , _at });
        let sums = match family.shared {
            0 => quote! { &[S::zero(); #t] },
            _ => quote! { _sums },
        };
        let (mut exchanges, mut flows) = (Vec::new(), Vec::new());
        for (place, kind) in pieces.kinds.iter().enumerate() {
            let (kind_place, rate, place) = (place, rate(place), index(place));
            match kind.form {
                FamilyForm::Exchange => exchanges.push(quote! {
                    #place => ::core::option::Option::Some(self.#rate(&[S::zero(); #c], #sums #at)),
                }),
                FamilyForm::Still => {}
                FamilyForm::Flow(_) => {
                    let flow = own_flow(kind_place);
                    flows.push(quote! { #place => *_one = self.#flow(_t, _one, _sums #at), });
                }
                FamilyForm::Site(a) | FamilyForm::Collective(a) => {
                    let turn = turn(a);
                    flows.push(
                        quote! { #place => self.#turn(self.#rate(_one, _sums #at) * _t, _one), },
                    );
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

/// Over which sites a sum or a piece goes.
pub(super) fn span(span: &Option<(usize, usize)>) -> TokenStream {
    let Some((first, left)) = span else {
        return quote! { ::lie_runtime::family::Span::All };
    };
    let (first, left) = (index(*first), index(*left));
    quote! { ::lie_runtime::family::Span::Within { first: #first, left: #left } }
}
