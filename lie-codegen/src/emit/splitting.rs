//! The flows of the coordinate pieces of a separable Hamiltonian.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::Writer;
use super::names::index;
use super::prepared::{Owner, Prepared};
use crate::derive::{Kernel, PieceKernel, Shape, Update};
use crate::methods::Choice;
use crate::schedule::Value;
use crate::symbolic::Symbol;

impl Writer<'_> {
    /// The hook of splittings, if H has coordinate pieces: fused where a splitting is asked for,
    /// generic elsewhere.
    pub fn splitting(&mut self) -> TokenStream {
        let Some(pieces) = self.source.splitting_kernels() else {
            return TokenStream::new();
        };
        let splits = |choice: &Choice| matches!(choice.solved(), Choice::Splitting(..));
        if self.blueprint.methods.iter().any(splits) {
            return self.fused_splitting(&pieces);
        }
        let system = self.system_name();
        quote! {
            ::lie_runtime::generic_equations!(
                [S: ::lie_runtime::Scalar] #system<S>, S: splitting
            );
        }
    }

    fn fused_splitting(&mut self, pieces: &[PieceKernel]) -> TokenStream {
        let (visibility, system) = (&self.blueprint.visibility, self.system_name());
        let name = format_ident!("{}Splitting", self.blueprint.name);
        let n = index(self.source.dimension);
        let state = quote! { ::lie_runtime::__private::SVector<S, #n> };
        let series = pieces.iter().any(|piece| piece.kernel.is_none());
        let generic = quote! { ::lie_runtime::generic::CoordinateFlows };
        let field = series.then(|| quote! { series: #generic<'a, S, #system<S>>, });
        let value = series.then(|| quote! { series: #generic::new(system), });
        let names: Vec<String> = pieces
            .iter()
            .map(|piece| format!("`{}`", self.blueprint.coordinates[piece.coordinate]))
            .collect();
        let doc = match names.as_slice() {
            [] => " The flows of the pieces of H: none moves the state.".to_owned(),
            names => format!(" The flows of the pieces of H in {}.", names.join(", ")),
        };
        let functions: Vec<Ident> = (0..pieces.len())
            .map(|position| format_ident!("_flow{position}"))
            .collect();
        let flows: TokenStream = pieces
            .iter()
            .zip(&functions)
            .map(|(piece, function)| self.flow(piece, function, &state))
            .collect();
        let sweeps = sweeps(&functions);
        let count = index(pieces.len());
        let message = format!("the splitting has {} pieces", pieces.len());
        let positions = (0..pieces.len()).map(index);
        let coordinates = pieces.iter().map(|piece| index(piece.coordinate));
        let direction = if pieces.is_empty() {
            quote! { panic!(#message); }
        } else {
            quote! {
                const COORDINATES: [usize; #count] = [#(#coordinates),*];
                let coordinate = COORDINATES[_piece];
                ::lie_runtime::generic::piece_direction(self.system, coordinate, _t, _mu, _xi);
            }
        };
        quote! {
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

            impl<S: ::lie_runtime::Scalar> ::lie_runtime::SeparablePoisson<S> for #system<S> {
                type Flows<'a> = #name<'a, S> where Self: 'a;
                fn flows(&self) -> Self::Flows<'_> {
                    #name::new(self)
                }
            }
        }
    }

    /// The flow of one piece as a function.
    fn flow(&mut self, piece: &PieceKernel, function: &Ident, state: &TokenStream) -> TokenStream {
        let coordinate = self.blueprint.coordinates[piece.coordinate].to_string();
        let mu = self.argument("mu");
        let Some(kernel) = &piece.kernel else {
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
        let mut program = kernel.program(&mut self.source.graph);
        for update in &piece.updates {
            match update {
                Update::Add | Update::Subtract => program.counts.add += 1,
                Update::Multiply => program.counts.mul += 1,
                Update::Divide => program.counts.div += 1,
            }
        }
        let docs = self.kernel_docs(&format!("splitting flow {coordinate}"), kernel, &program);
        let unpacked = self.unpack(&kernel.arguments[0], &program, &quote! { #mu });
        let (statements, outputs) = self.program(&program, |writer, value| match value {
            Value::Symbol(Symbol::Time) => quote! { t },
            value => writer.value(value, Owner::Equation, &mut Prepared::default()),
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

/// The statements that change mu.
fn updates(
    kernel: &Kernel,
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
