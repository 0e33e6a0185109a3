//! Kernels as functions.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::Printer;
use super::names::{ident, index};
use crate::derive::{Argument, Shape};
use crate::plan::{Constant, Constants, Function};

/// Which struct a kernel belongs to: where its constants live.
#[derive(Clone, Copy)]
pub(super) enum Owner<'a> {
    /// The system itself; `self` is the system.
    System,
    /// An equation of fixed step size, whose own constants these are; `self.system` is the system.
    Equation(&'a Constants),
    /// A function that is given the system as `_system`.
    Argument,
}

/// What the body of a kernel is written into.
pub(super) struct Body<'a> {
    /// Where its constants live.
    pub owner: Owner<'a>,
    /// The place of each vector argument: a parameter of the function or a field.
    pub place: &'a dyn Fn(&str) -> TokenStream,
    /// What the results are written to.
    pub targets: &'a [&'a str],
    /// How many entries these have, if not as many as the state.
    pub size: Option<usize>,
}

impl<'a> Body<'a> {
    /// Results of the size of the state.
    pub fn new(
        owner: Owner<'a>,
        place: &'a dyn Fn(&str) -> TokenStream,
        targets: &'a [&'a str],
    ) -> Self {
        Self {
            owner,
            place,
            targets,
            size: None,
        }
    }
}

impl Printer<'_> {
    /// The doc lines of a kernel: its formula and its count of operations.
    pub(super) fn docs(&self, function: &Function) -> TokenStream {
        let formula = format!(" {}", function.formula);
        let count = format!(" {}.", function.program.counts);
        let mut explicit = Vec::new();
        if !function.explicit.is_empty() {
            explicit.push(" ```text".to_owned());
            explicit.extend(function.explicit.iter().map(|line| format!(" {line}")));
            explicit.extend([" ```".to_owned(), String::new()]);
        }
        quote! { #[doc = #formula] #[doc = ""] #(#[doc = #explicit])* #[doc = #count] }
    }

    /// The tokens of a constant of a kernel.
    pub(super) fn constant(&self, constant: Constant, owner: Owner<'_>) -> TokenStream {
        match constant {
            Constant::Pi => {
                quote! { S::constant(::core::f64::consts::PI, 1.2246467991473532e-16) }
            }
            Constant::Step => quote! { self.h },
            Constant::OfStep(position) => {
                let Owner::Equation(constants) = owner else {
                    unreachable!("only an equation has a step size")
                };
                let name = ident(&constants.entries[position].name);
                quote! { self.#name }
            }
            Constant::System(position) => {
                let name = self.constant_name(position);
                match owner {
                    Owner::System => quote! { self.#name },
                    Owner::Equation(_) => quote! { self.system.#name },
                    Owner::Argument => quote! { _system.#name },
                }
            }
        }
    }

    /// The statement that takes an argument apart; `_` stands for what the kernel ignores.
    pub(super) fn unpack(
        &self,
        argument: &Argument,
        function: &Function,
        from: &TokenStream,
    ) -> TokenStream {
        if !function.reads(argument) {
            return TokenStream::new();
        }
        let entries = argument.symbols.iter().map(|symbol| {
            if function.program.reads(*symbol) {
                let name = self.local(*symbol);
                quote! { #name }
            } else {
                quote! { _ }
            }
        });
        if argument.is_array() {
            quote! { let [#(#entries),*] = #from; }
        } else {
            quote! { let [[#(#entries),*]] = #from.data.0; }
        }
    }

    /// Arguments taken apart, locals, and the tokens of the results.
    pub(super) fn statements(
        &self,
        function: &Function,
        body: &Body<'_>,
    ) -> (TokenStream, Vec<TokenStream>) {
        let arguments = function.arguments.iter();
        let unpacked: TokenStream = arguments
            .map(|a| self.unpack(a, function, &(body.place)(a.name)))
            .collect();
        let (statements, outputs) =
            self.program(&function.program, &|value| self.value(value, body.owner));
        (quote! { #unpacked #statements }, outputs)
    }

    /// The body of a kernel: arguments taken apart, locals, results written to their targets.
    pub(super) fn body(&self, function: &Function, body: &Body<'_>) -> TokenStream {
        let (statements, outputs) = self.statements(function, body);
        let n = body.size.unwrap_or_else(|| self.plan.dimension());
        let target = |position: usize| self.argument(body.targets[position]);
        let writes = match &function.shape {
            Shape::Scalar => outputs.into_iter().collect(),
            Shape::Vector(indices) => vector_writes(&target(0), indices, &outputs, n),
            Shape::Matrix(places) => matrix_writes(&target(0), places, &outputs, n),
            Shape::VectorAndMatrix(indices, places) => {
                let (vector, matrix) = outputs.split_at(indices.len());
                let vector = vector_writes(&target(0), indices, vector, n);
                let matrix = matrix_writes(&target(1), places, matrix, n);
                quote! { #vector #matrix }
            }
        };
        quote! { #statements #writes }
    }

    /// The body of a method of the system, whose arguments are those of the kernel.
    pub(super) fn system_body(
        &self,
        function: &Function,
        targets: &[&str],
        size: Option<usize>,
    ) -> TokenStream {
        let place = |name: &str| {
            let name = self.argument(name);
            quote! { #name }
        };
        let body = Body {
            size,
            ..Body::new(Owner::System, &place, targets)
        };
        self.body(function, &body)
    }
}

/// Fills a vector or matrix with zero, as a slice: nalgebra's own `fill` goes through an iterator of columns, which
/// takes 13 instructions for each entry.
fn zeros(target: &Ident) -> TokenStream {
    quote! { #target.as_mut_slice().fill(S::zero()); }
}

/// Writes of a vector; entries that vanish identically are filled with zero first.
pub(super) fn vector_writes(
    target: &Ident,
    indices: &[usize],
    outputs: &[TokenStream],
    n: usize,
) -> TokenStream {
    let fill = (indices.len() < n).then(|| zeros(target));
    let writes = entries(target, indices, outputs);
    quote! { #fill #writes }
}

fn matrix_writes(
    target: &Ident,
    places: &[(usize, usize)],
    outputs: &[TokenStream],
    n: usize,
) -> TokenStream {
    let fill = (places.len() < n * n).then(|| zeros(target));
    let writes = matrix_entries(target, places, outputs);
    quote! { #fill #writes }
}

/// Writes of the entries of a vector.
pub(super) fn entries(target: &Ident, indices: &[usize], outputs: &[TokenStream]) -> TokenStream {
    let entries = indices.iter().zip(outputs).map(|(i, value)| {
        let i = index(*i);
        quote! { #target[#i] = #value; }
    });
    entries.collect()
}

/// Writes of the entries of a matrix.
pub(super) fn matrix_entries(
    target: &Ident,
    places: &[(usize, usize)],
    outputs: &[TokenStream],
) -> TokenStream {
    let entries = places.iter().zip(outputs).map(|((i, j), value)| {
        let (i, j) = (index(*i), index(*j));
        quote! { #target[(#i, #j)] = #value; }
    });
    entries.collect()
}
