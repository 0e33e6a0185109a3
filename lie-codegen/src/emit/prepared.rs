//! Constants that are computed before the kernels run.

use std::collections::HashMap;

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::Writer;
use super::names::ident;
use crate::schedule::{Known, Program, Task, Value, schedule};
use crate::symbolic::{ExprId, Node, Symbol};

/// The prepared constants of one struct, in the order of their first use.
#[derive(Clone, Debug, Default)]
pub struct Prepared {
    order: Vec<ExprId>,
    index: HashMap<ExprId, usize>,
}

impl Prepared {
    /// The position of a constant, which is entered if it is new.
    pub fn position(&mut self, id: ExprId) -> usize {
        *self.index.entry(id).or_insert_with(|| {
            self.order.push(id);
            self.order.len() - 1
        })
    }

    /// The constants.
    pub fn all(&self) -> &[ExprId] {
        &self.order
    }
}

/// Which struct a kernel belongs to: where its constants live.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Owner {
    /// The system itself; `self` is the system.
    System,
    /// An equation of fixed step size; `self.system` is the system.
    Equation,
    /// A function that is given the system as `_system`.
    Argument,
}

impl Writer<'_> {
    /// The tokens of a constant of a kernel; `step` collects those of the step size.
    pub fn constant(&mut self, id: ExprId, owner: Owner, step: &mut Prepared) -> TokenStream {
        if matches!(self.source.graph.node(id), Node::Pi) {
            return quote! { S::constant(::core::f64::consts::PI, 1.2246467991473532e-16) };
        }
        if self.source.graph.symbols(id).contains(&Symbol::Step) {
            if matches!(self.source.graph.node(id), Node::Symbol(Symbol::Step)) {
                return quote! { self.h };
            }
            let name = step_name(step.position(id));
            return quote! { self.#name };
        }
        let name = self.system_constant(id);
        match owner {
            Owner::System => quote! { self.#name },
            Owner::Equation => quote! { self.system.#name },
            Owner::Argument => quote! { _system.#name },
        }
    }

    /// The field of the system that holds a constant: a parameter keeps its name.
    fn system_constant(&mut self, id: ExprId) -> Ident {
        let position = self.prepared.position(id);
        self.prepared_name(id, position)
    }

    pub fn prepared_name(&self, id: ExprId, position: usize) -> Ident {
        match self.source.graph.node(id) {
            Node::Symbol(symbol @ Symbol::Parameter(_)) => self.local(*symbol),
            _ => format_ident!("_k{position}"),
        }
    }

    /// Statements that compute constants from the parameters (and `h`), and their values.
    pub fn preparation(
        &mut self,
        constants: &[ExprId],
        parameter: &dyn Fn(&Ident) -> TokenStream,
    ) -> (TokenStream, Vec<TokenStream>) {
        let task = Task {
            definitions: Vec::new(),
            outputs: constants.to_vec(),
            known: Known::Nothing,
        };
        let program: Program = schedule(&mut self.source.graph, &task);
        let mut none = Prepared::default();
        let tokens = |writer: &mut Self, value: &Value| match value {
            Value::Symbol(Symbol::Step) => quote! { h },
            Value::Symbol(symbol) => parameter(&writer.local(*symbol)),
            other => writer.value(other, Owner::System, &mut none),
        };
        self.program(&program, tokens)
    }

    /// The text of a constant in the names of the user.
    pub fn constant_text(&self, id: ExprId) -> String {
        self.source.graph.display(id, &|symbol| self.shown(symbol))
    }
}

/// The field of an equation that holds a constant of the step size.
pub fn step_name(position: usize) -> Ident {
    ident(&format!("_h{position}"))
}
