//! Kernels as functions.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::Writer;
use super::names::index;
use super::prepared::{Owner, Prepared};
use crate::derive::{Argument, Kernel, Shape};
use crate::schedule::{Operation, Program, Value};

/// How many entries a result has.
#[derive(Clone, Copy, Debug)]
pub enum Extent {
    /// As many as the state.
    State,
    /// That many.
    Of(usize),
}

/// Longer formulas are left out of the doc comments.
const LONGEST_FORMULA: usize = 160;

impl Writer<'_> {
    /// The doc lines of a kernel: its formula and its count of operations. The count is recorded.
    pub fn kernel_docs(&mut self, label: &str, kernel: &Kernel, program: &Program) -> TokenStream {
        self.counts.push((label.to_string(), program.counts));
        let formula = format!(" {}", kernel.formula);
        let count = format!(" {}.", program.counts);
        let explicit = self.explicit(kernel);
        quote! { #[doc = #formula] #[doc = ""] #(#[doc = #explicit])* #[doc = #count] }
    }

    /// The energy and the equations of motion in the names of the user, where they are short.
    fn explicit(&self, kernel: &Kernel) -> Vec<String> {
        let left: Vec<String> = match kernel.name {
            "hamiltonian" => vec!["H".into()],
            "vector_field" => {
                let Shape::Vector(indices) = &kernel.shape else {
                    return Vec::new();
                };
                indices
                    .iter()
                    .map(|i| format!("{}'", self.blueprint.coordinates[*i]))
                    .collect()
            }
            _ => return Vec::new(),
        };
        let right = kernel
            .task
            .outputs
            .iter()
            .map(|output| self.constant_text(*output));
        let mut lines: Vec<String> = left
            .into_iter()
            .zip(right)
            .map(|(l, r)| format!(" {l} = {r}"))
            .collect();
        if lines.iter().any(|line| line.len() > LONGEST_FORMULA) {
            return Vec::new();
        }
        lines.insert(0, " ```text".into());
        lines.extend([" ```".into(), String::new()]);
        lines
    }

    /// Whether a program reads a vector argument.
    pub fn reads(argument: &Argument, program: &Program) -> bool {
        let is = |value: &Value| matches!(value, Value::Symbol(symbol) if argument.symbols.contains(symbol));
        program
            .operations
            .iter()
            .flat_map(Operation::operands)
            .any(is)
            || program.outputs.iter().any(is)
    }

    /// The statements that take the arguments apart; `_` stands for what the kernel ignores.
    pub fn unpack(
        &self,
        argument: &Argument,
        program: &Program,
        from: &TokenStream,
    ) -> TokenStream {
        let used = |symbol| {
            let is = |value: &Value| *value == Value::Symbol(symbol);
            program
                .operations
                .iter()
                .flat_map(Operation::operands)
                .any(is)
                || program.outputs.iter().any(is)
        };
        if !Self::reads(argument, program) {
            return TokenStream::new();
        }
        let entries = argument.symbols.iter().map(|symbol| {
            if used(*symbol) {
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

    /// The body of a kernel: arguments taken apart, locals, results written to `targets`.
    ///
    /// `argument` gives the place of each vector argument: a parameter of the function or a field.
    pub fn kernel_body(
        &mut self,
        kernel: &Kernel,
        program: &Program,
        owner: Owner,
        step: &mut Prepared,
        argument: &dyn Fn(&str) -> TokenStream,
        targets: &[&str],
    ) -> TokenStream {
        self.sized_body(
            kernel,
            program,
            owner,
            step,
            argument,
            targets,
            Extent::State,
        )
    }

    /// The same for results of another size than that of the state.
    #[expect(clippy::too_many_arguments, reason = "one more than `kernel_body`")]
    pub fn sized_body(
        &mut self,
        kernel: &Kernel,
        program: &Program,
        owner: Owner,
        step: &mut Prepared,
        argument: &dyn Fn(&str) -> TokenStream,
        targets: &[&str],
        extent: Extent,
    ) -> TokenStream {
        let unpacked: TokenStream = kernel
            .arguments
            .iter()
            .map(|a| self.unpack(a, program, &argument(a.name)))
            .collect();
        let (statements, outputs) =
            self.program(program, |writer, value| writer.value(value, owner, step));
        let n = match extent {
            Extent::State => self.source.dimension,
            Extent::Of(count) => count,
        };
        let writes = match &kernel.shape {
            Shape::Scalar => outputs.into_iter().collect(),
            Shape::Vector(indices) => {
                vector_writes(&self.argument(targets[0]), indices, &outputs, n)
            }
            Shape::Matrix(places) => matrix_writes(&self.argument(targets[0]), places, &outputs, n),
            Shape::VectorAndMatrix(indices, places) => {
                let (vector, matrix) = outputs.split_at(indices.len());
                let vector = vector_writes(&self.argument(targets[0]), indices, vector, n);
                let matrix = matrix_writes(&self.argument(targets[1]), places, matrix, n);
                quote! { #vector #matrix }
            }
        };
        quote! { #unpacked #statements #writes }
    }
}

/// Fills a vector or matrix with zero, as a slice: nalgebra's own `fill` goes through an iterator of columns, which
/// takes 13 instructions for each entry.
fn zeros(target: &Ident) -> TokenStream {
    quote! { #target.as_mut_slice().fill(S::zero()); }
}

/// Writes of a vector; entries that vanish identically are filled with zero first.
fn vector_writes(
    target: &Ident,
    indices: &[usize],
    outputs: &[TokenStream],
    n: usize,
) -> TokenStream {
    let fill = (indices.len() < n).then(|| zeros(target));
    let writes = indices.iter().zip(outputs).map(|(i, value)| {
        let i = index(*i);
        quote! { #target[#i] = #value; }
    });
    quote! { #fill #(#writes)* }
}

fn matrix_writes(
    target: &Ident,
    places: &[(usize, usize)],
    outputs: &[TokenStream],
    n: usize,
) -> TokenStream {
    let fill = (places.len() < n * n).then(|| zeros(target));
    let writes = places.iter().zip(outputs).map(|((i, j), value)| {
        let (i, j) = (index(*i), index(*j));
        quote! { #target[(#i, #j)] = #value; }
    });
    quote! { #fill #(#writes)* }
}
