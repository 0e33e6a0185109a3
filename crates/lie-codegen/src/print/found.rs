//! The flows of the pieces that were found.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::Printer;
use super::function::{Body, Owner};
use super::names::index;
use super::splitting::{message, methods_of_flows};
use crate::plan::{Constants, Found, FoundPart, FoundPiece, Function};

impl Printer<'_> {
    /// The flows of the pieces that were found and their hook.
    pub(super) fn found_splitting(&self) -> Option<TokenStream> {
        let (name, items) = match self.plan.found.as_ref()? {
            Found::Same if self.plan.splitting.is_none() => return None,
            Found::Same => (self.type_name("Splitting"), TokenStream::new()),
            Found::Pieces {
                pieces,
                whole,
                fused,
                text,
            } => {
                if !fused {
                    return Some(self.found_parts(pieces, *whole, text.as_deref()));
                }
                let items = self.found_flows(pieces, *whole, text.as_deref());
                (self.type_name("Found"), items)
            }
        };
        let hook = self.found_hook(&quote! { #name<'a, S> }, &quote! { #name::new(self) });
        Some(quote! {
            #items
            #hook
        })
    }

    /// The flows of the pieces, with those of what acts behind them.
    fn found_hook(&self, flows: &TokenStream, value: &TokenStream) -> TokenStream {
        let system = self.system_name();
        let plan = &self.plan.system;
        let (flows, value) = match plan.forced || plan.noises > 0 {
            true => {
                let driven = quote! { ::lie_runtime::generic::DrivenFlows };
                (
                    quote! { #driven<'a, Self, #flows, <Self as ::lie_runtime::Poisson<S>>::State> },
                    quote! { #driven::new(self, #value) },
                )
            }
            false => (flows.clone(), value.clone()),
        };
        quote! {
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::FoundPoisson<S> for #system<S> {
                type Found<'a> = #flows where Self: 'a;
                fn found(&self) -> Self::Found<'_> {
                    #value
                }
            }
        }
    }

    /// The type of the flows.
    fn found_flows(&self, pieces: &[FoundPiece], whole: bool, text: Option<&str>) -> TokenStream {
        let (visibility, system) = (&self.surface.visibility, self.system_name());
        let name = self.type_name("Found");
        let n = index(self.plan.dimension());
        let state = quote! { ::lie_runtime::__private::SVector<S, #n> };
        let docs = docs_of(pieces, text);
        let numbers = 0..pieces.len();
        let functions: Vec<Ident> = numbers.clone().map(|k| format_ident!("_flow{k}")).collect();
        let directions: Vec<Ident> = numbers
            .clone()
            .map(|k| format_ident!("_direction{k}"))
            .collect();
        let flows: TokenStream = pieces
            .iter()
            .enumerate()
            .map(|(place, piece)| self.found_flow(place, piece, &state))
            .collect();
        let places = numbers.map(index);
        let none = message(pieces.len());
        let direction = quote! {
            match _piece {
                #(#places => self.#directions(_mu, _xi),)*
                _ => panic!(#none),
            }
            #[allow(unreachable_code)]
            for entry in _xi.iter_mut() {
                *entry = _t * *entry;
            }
        };
        let methods = methods_of_flows(pieces.len(), &functions, &direction);
        let follow = follow(pieces);
        let rest = (!whole).then(|| rest_of_gradient(&directions));
        quote! {
            #(#[doc = #docs])*
            #[derive(Debug)]
            #visibility struct #name<'a, S: ::lie_runtime::Scalar> {
                // not read where no flow contains a parameter
                #[allow(dead_code)]
                system: &'a #system<S>,
            }

            #[allow(non_snake_case, clippy::many_single_char_names)]
            impl<'a, S: ::lie_runtime::Scalar> #name<'a, S> {
                #[doc = " The flows of a system."]
                #[must_use]
                pub fn new(system: &'a #system<S>) -> Self {
                    Self { system }
                }

                #flows
            }

            impl<S: ::lie_runtime::Scalar> ::lie_runtime::PieceFlows<S> for #name<'_, S> {
                type State = #state;

                #methods
                #follow
                #rest
            }
        }
    }

    /// The directions of the parts of the pieces: their flows are exponentials.
    fn found_parts(&self, pieces: &[FoundPiece], whole: bool, text: Option<&str>) -> TokenStream {
        let system = self.system_name();
        let docs = docs_of(pieces, text);
        let moving = pieces.iter().map(|piece| {
            let parts = piece.parts.iter().map(moves);
            quote! { &[#(#parts),*] }
        });
        let kernels = pieces.iter().enumerate().flat_map(|(place, piece)| {
            let parts = piece.parts.iter().enumerate();
            parts.map(move |(part, known)| {
                let kernel = known.direction.as_ref().unwrap_or(&piece.direction);
                (place, part, kernel)
            })
        });
        let kernels: Vec<_> = kernels.collect();
        let reads = |kernel: &Function| kernel.reads(&kernel.arguments[0]);
        let mu = self.argument_if("mu", kernels.iter().any(|(.., kernel)| reads(kernel)));
        let arms = kernels.iter().map(|(place, part, kernel)| {
            let (place, part) = (index(*place), index(*part));
            let argument = |_: &str| quote! { #mu };
            let body = Body::new(Owner::System, &argument, &["_xi"]);
            let body = self.body(kernel, &body);
            quote! { (#place, #part) => { #body } }
        });
        let counts = kernels.iter().map(|(place, part, kernel)| {
            let counts = kernel.program.counts;
            format!(" Part {part} of piece {place}: {counts}.")
        });
        let message = message(pieces.len());
        let flows = quote! { ::lie_runtime::generic::PartFlows };
        let hook = self.found_hook(
            &quote! { #flows<'a, S, Self> },
            &quote! { #flows::new(self) },
        );
        quote! {
            #(#[doc = #docs])*
            #[allow(non_snake_case, clippy::many_single_char_names)]
            impl<S: ::lie_runtime::Scalar> ::lie_runtime::generic::Parts<S> for #system<S> {
                fn parts(&self) -> &[&[bool]] {
                    &[#(#moving),*]
                }

                fn are_whole(&self) -> bool {
                    #whole
                }

                #(#[doc = #counts])*
                fn part_direction(
                    &self, _piece: usize, _part: usize, #mu: &Self::State, _xi: &mut Self::State,
                ) {
                    match (_piece, _part) {
                        #(#arms)*
                        _ => panic!(#message),
                    }
                }
            }

            #hook
        }
    }

    /// The flow of one piece, and its direction.
    fn found_flow(&self, place: usize, piece: &FoundPiece, state: &TokenStream) -> TokenStream {
        let flow = format_ident!("_flow{place}");
        let direction = format_ident!("_direction{place}");
        let of_piece = self.direction(&piece.direction, &direction, state);
        let flows = match piece.parts.as_slice() {
            [only] => self.part(only, &flow, &direction, state),
            parts => {
                let names = parts.iter().enumerate().map(|(part, known)| {
                    let direction = format_ident!("_direction{place}_{part}");
                    let kernel = known.direction.as_ref();
                    let own = kernel.map(|kernel| self.direction(kernel, &direction, state));
                    let name = part_name(place, part);
                    let flow = moves(known).then(|| self.part(known, &name, &direction, state));
                    (quote! { #own #flow }, moves(known).then_some(name))
                });
                let (items, names): (Vec<TokenStream>, Vec<Option<Ident>>) = names.unzip();
                let names = names.into_iter().flatten();
                quote! {
                    #(#items)*
                    #[inline]
                    fn #flow(&self, t: S, mu: &mut #state) {
                        #(self.#names(t, mu);)*
                    }
                }
            }
        };
        quote! {
            #flows
            #of_piece
        }
    }

    /// A gradient, of a piece or of a part of it.
    fn direction(&self, kernel: &Function, name: &Ident, state: &TokenStream) -> TokenStream {
        let mu = self.argument_if("mu", kernel.reads(&kernel.arguments[0]));
        let none = Constants::default();
        let body = self.body(
            kernel,
            &Body::new(Owner::Equation(&none), &|_| quote! { #mu }, &["_xi"]),
        );
        let docs = self.docs(kernel);
        quote! {
            #docs
            fn #name(&self, #mu: &#state, _xi: &mut #state) {
                #body
            }
        }
    }

    /// The flow of a part of a piece.
    fn part(
        &self,
        part: &FoundPart,
        name: &Ident,
        direction: &Ident,
        state: &TokenStream,
    ) -> TokenStream {
        match part.flows.as_deref() {
            Some([only]) => self.flow(only, name, state),
            Some(several) => {
                let numbers = 0..several.len();
                let names: Vec<Ident> = numbers.map(|k| format_ident!("{name}_{k}")).collect();
                let parts = several.iter().zip(&names);
                let parts: TokenStream = parts
                    .map(|(part, name)| self.flow(part, name, state))
                    .collect();
                quote! {
                    #parts
                    #[inline]
                    fn #name(&self, t: S, mu: &mut #state) {
                        #(self.#names(t, mu);)*
                    }
                }
            }
            None => quote! {
                fn #name(&self, t: S, mu: &mut #state) {
                    let (start, mut xi) = (*mu, *mu);
                    self.#direction(mu, &mut xi);
                    for entry in xi.iter_mut() {
                        *entry = t * *entry;
                    }
                    ::lie_runtime::LiePoisson::coadjoint_action(self.system, &xi, &start, mu);
                }
            },
        }
    }
}

/// What is said of the pieces.
fn docs_of(pieces: &[FoundPiece], text: Option<&str>) -> Vec<String> {
    let rest =
        text.map(|text| format!(" of `{text}`, which is H without a combination of Casimirs"));
    let title = format!(" The flows of the pieces{}:", rest.unwrap_or_default());
    let list = pieces.iter();
    let list = list.map(|piece| format!(" - `{}`", piece.terms.join("`, `")));
    [title, String::new()].into_iter().chain(list).collect()
}

/// The name of the flow of a part.
fn part_name(place: usize, part: usize) -> Ident {
    format_ident!("_part{place}_{part}")
}

/// Whether a part moves anything: a Casimir of the algebra does not.
fn moves(part: &FoundPart) -> bool {
    part.flows.as_ref().is_none_or(|flows| !flows.is_empty())
}

/// The flows part by part, where a piece has several.
fn follow(pieces: &[FoundPiece]) -> Option<TokenStream> {
    if pieces.iter().all(|piece| piece.parts.len() == 1) {
        return None;
    }
    let cases = pieces.iter().enumerate().map(|(place, piece)| {
        let number = index(place);
        let alone = piece.parts.len() == 1;
        let parts = piece.parts.iter().enumerate().map(|(part, known)| {
            let (direction, flow) = if alone {
                (
                    format_ident!("_direction{place}"),
                    format_ident!("_flow{place}"),
                )
            } else {
                let direction = format_ident!("_direction{place}_{part}");
                (direction, part_name(place, part))
            };
            let flow = moves(known).then(|| quote! { self.#flow(t, mu); });
            quote! {
                self.#direction(mu, factor);
                for entry in factor.iter_mut() {
                    *entry = t * *entry;
                }
                give(factor);
                #flow
            }
        });
        quote! { #number => { #(#parts)* } }
    });
    let none = message(pieces.len());
    Some(quote! {
        fn follow(
            &mut self,
            piece: usize,
            t: S,
            mu: &mut Self::State,
            factor: &mut Self::State,
            give: &mut dyn FnMut(&mut Self::State),
        ) {
            match piece {
                #(#cases)*
                _ => panic!(#none),
            }
        }
    })
}

/// What H is beside the pieces.
fn rest_of_gradient(directions: &[Ident]) -> TokenStream {
    quote! {
        fn rest(&self, t: S, mu: &Self::State, xi: &mut Self::State) -> bool {
            let mut part = *mu;
            ::lie_runtime::Poisson::gradient(self.system, mu, xi);
            #(
                self.#directions(mu, &mut part);
                for (entry, part) in xi.iter_mut().zip(part.iter()) {
                    *entry -= *part;
                }
            )*
            for entry in xi.iter_mut() {
                *entry = t * *entry;
            }
            let _ = &mut part;
            true
        }
    }
}
