//! The flows of the coordinate pieces of a separable Hamiltonian.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::Printer;
use super::function::Owner;
use super::names::index;
use crate::derive::{Shape, Update};
use crate::plan::{Constants, Flow, Function};
use lie_symbolic::schedule::Value;
use lie_symbolic::symbolic::Symbol;

impl Printer<'_> {
    /// The flows of the pieces of H and their hook.
    pub(super) fn splitting(&self) -> Option<TokenStream> {
        let pieces = &self.plan.splitting.as_ref()?.flows;
        let (visibility, system) = (&self.surface.visibility, self.system_name());
        let name = self.type_name("Splitting");
        let n = index(self.plan.dimension());
        let state = quote! { ::lie_runtime::__private::SVector<S, #n> };
        let series = pieces.iter().any(|piece| piece.function.is_none());
        let generic = quote! { ::lie_runtime::generic::CoordinateFlows };
        let field = series.then(|| quote! { series: #generic<'a, S, #system<S>>, });
        let value = series.then(|| quote! { series: #generic::new(system), });
        let doc = self.doc_of_flows(pieces);
        let functions = names_of(pieces);
        let flows = self.flows(pieces, &functions, &state);
        let direction = direction(pieces);
        let methods = methods_of_flows(pieces.len(), &functions, &direction);
        Some(quote! {
            #[doc = #doc]
            #[derive(Debug)]
            #visibility struct #name<'a, S: ::lie_runtime::Scalar> {
                system: &'a #system<S>,
                #field
            }

            #[allow(non_snake_case, clippy::many_single_char_names)]
            impl<'a, S: ::lie_runtime::Scalar> #name<'a, S> {
                #[doc = " The flows of a system."]
                #[must_use]
                pub fn new(system: &'a #system<S>) -> Self {
                    Self { system, #value }
                }

                #flows
            }

            impl<S: ::lie_runtime::Scalar> ::lie_runtime::PieceFlows<S> for #name<'_, S> {
                type State = #state;

                #methods
            }

            impl<S: ::lie_runtime::Scalar> ::lie_runtime::SeparablePoisson<S> for #system<S> {
                type Flows<'a> = #name<'a, S> where Self: 'a;
                fn flows(&self) -> Self::Flows<'_> {
                    #name::new(self)
                }
            }
        })
    }

    /// The flows of all pieces as functions.
    fn flows(&self, pieces: &[Flow], functions: &[Ident], state: &TokenStream) -> TokenStream {
        let flows = pieces.iter().zip(functions);
        flows
            .map(|(piece, function)| self.flow(piece, function, state))
            .collect()
    }

    fn doc_of_flows(&self, pieces: &[Flow]) -> String {
        let names = pieces
            .iter()
            .map(|piece| format!("`{}`", self.plan.names.coordinates[piece.coordinate]));
        match names.collect::<Vec<_>>().as_slice() {
            [] => " The flows of the pieces of H: none moves the state.".to_owned(),
            names => format!(" The flows of the pieces of H in {}.", names.join(", ")),
        }
    }

    /// The flow of one piece as a function.
    pub(super) fn flow(&self, piece: &Flow, function: &Ident, state: &TokenStream) -> TokenStream {
        let coordinate = &self.plan.names.coordinates[piece.coordinate];
        let mu = self.argument("mu");
        let Some(kernel) = &piece.function else {
            let doc = format!(" The flow of the piece in `{coordinate}`, by its series.");
            let coordinate = index(piece.coordinate);
            return quote! {
                #[doc = #doc]
                fn #function(&mut self, t: S, mu: &mut #state) {
                    ::lie_runtime::PieceFlows::flow(&mut self.series, #coordinate, t, mu);
                }
            };
        };
        let title = format!(" The flow of the piece in `{coordinate}` over a time t.");
        let docs = self.docs(kernel);
        let unpacked = self.unpack(&kernel.arguments[0], kernel, &quote! { #mu });
        let none = Constants::default();
        let (statements, outputs) = self.program(&kernel.program, &|value| match value {
            Value::Symbol(Symbol::Time) => quote! { t },
            value => self.value(value, Owner::Equation(&none)),
        });
        let writes = updates(kernel, &piece.updates, &mu, &outputs);
        quote! {
            #[doc = #title]
            #[doc = ""]
            #docs
            #[inline]
            fn #function(&self, t: S, #mu: &mut #state) {
                #unpacked
                #statements
                #writes
            }
        }
    }
}

/// The functions of the flows.
fn names_of(pieces: &[Flow]) -> Vec<Ident> {
    let positions = 0..pieces.len();
    positions
        .map(|position| format_ident!("_flow{position}"))
        .collect()
}

/// What a piece that there is not is answered with.
pub(super) fn message(pieces: usize) -> String {
    format!("the splitting has {pieces} pieces")
}

/// The direction of a piece of H itself.
fn direction(pieces: &[Flow]) -> TokenStream {
    if pieces.is_empty() {
        let message = message(0);
        return quote! { panic!(#message); };
    }
    let count = index(pieces.len());
    let coordinates = pieces.iter().map(|piece| index(piece.coordinate));
    quote! {
        const COORDINATES: [usize; #count] = [#(#coordinates),*];
        let coordinate = COORDINATES[_piece];
        ::lie_runtime::generic::piece_direction(self.system, coordinate, _t, _mu, _xi);
    }
}

/// The methods of the trait, over a function for the flow of each piece.
pub(super) fn methods_of_flows(
    pieces: usize,
    functions: &[Ident],
    direction: &TokenStream,
) -> TokenStream {
    let sweeps = sweeps(functions);
    let count = index(pieces);
    let message = message(pieces);
    let positions = (0..pieces).map(index);
    quote! {
        #[inline]
        fn pieces(&self) -> usize {
            #count
        }

        fn direction(&self, _piece: usize, _t: S, _mu: &Self::State, _xi: &mut Self::State) {
            #direction
        }

        #[inline]
        fn flow(&mut self, piece: usize, _t: S, _mu: &mut Self::State) {
            match piece {
                #(#positions => self.#functions(_t, _mu),)*
                _ => panic!(#message),
            }
        }

        #sweeps
    }
}

/// The statements that change mu.
pub(super) fn updates(
    kernel: &Function,
    updates: &[Update],
    mu: &Ident,
    outputs: &[TokenStream],
) -> TokenStream {
    let Shape::Vector(rows) = &kernel.shape else {
        return TokenStream::new();
    };
    rows.iter()
        .zip(updates)
        .zip(outputs)
        .map(|((row, update), output)| {
            let row = index(*row);
            match update {
                Update::Add => quote! { #mu[#row] += #output; },
                Update::Subtract => quote! { #mu[#row] -= #output; },
                Update::Multiply => quote! { #mu[#row] *= #output; },
                Update::Divide => quote! { #mu[#row] /= #output; },
                Update::Replace => quote! { #mu[#row] = #output; },
            }
        })
        .collect()
}

/// The sweeps with every flow in its place, where there are at least two.
fn sweeps(functions: &[Ident]) -> TokenStream {
    let [first, inner @ .., last] = functions else {
        return TokenStream::new();
    };
    let backwards = inner.iter().rev();
    let (up, down) = if inner.is_empty() {
        (quote! { _t }, quote! { _t })
    } else {
        (quote! { t }, quote! { t })
    };
    quote! {
        #[inline]
        fn ascend(&mut self, first: S, #up: S, mu: &mut Self::State) {
            self.#first(first, mu);
            #(self.#inner(t, mu);)*
        }

        #[inline]
        fn descend(&mut self, last: S, #down: S, mu: &mut Self::State) {
            self.#last(last, mu);
            #(self.#backwards(t, mu);)*
        }
    }
}
