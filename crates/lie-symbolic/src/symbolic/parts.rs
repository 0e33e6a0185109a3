//! What expressions are made of.

use std::collections::BTreeSet;

use rustc_hash::FxHashSet;

use super::graph::{ExprId, Graph, Node, Symbol};
use super::{Function, Opaque, chosen};

impl Graph {
    /// The children of a node.
    pub fn children(&self, id: ExprId) -> Vec<ExprId> {
        match self.node(id) {
            Node::Number(_) | Node::Pi | Node::Symbol(_) => Vec::new(),
            Node::Sum { terms, .. } | Node::Written(terms) => {
                terms.iter().map(|(t, _)| *t).collect()
            }
            Node::Product(factors) => factors.iter().map(|(b, _)| *b).collect(),
            Node::Call(_, arguments) => arguments.to_vec(),
        }
    }

    /// Everything that the roots are made of, themselves included, in ascending order.
    pub fn dependencies(&self, roots: &[ExprId]) -> Vec<ExprId> {
        self.reached(roots, |_| true)
    }

    /// What is evaluated whichever branches are taken, in ascending order.
    pub fn certain(&self, roots: &[ExprId]) -> Vec<ExprId> {
        let children = |id: ExprId| match self.node(id) {
            Node::Call(Function::Below, arguments) => vec![arguments[0]],
            _ => self.children(id),
        };
        closure(roots.to_vec(), children)
    }

    /// Whether some expression of the arena is a choice.
    pub fn has_choices(&self) -> bool {
        self.choices
    }

    /// Whether an expression contains a choice.
    pub fn chooses(&self, id: ExprId) -> bool {
        let mut parts = self.dependencies(&[id]).into_iter();
        let is_choice = |part| matches!(self.node(part), Node::Call(Function::Below, _));
        self.choices && parts.any(is_choice)
    }

    /// The functions of the user that an expression calls, in the order of the arena.
    pub fn own_functions(&self, id: ExprId) -> Vec<Opaque> {
        let parts = self.dependencies(&[id]).into_iter();
        let own = parts.filter_map(|part| match self.node(part) {
            Node::Call(Function::Own(own), _) => Some(*own),
            _ => None,
        });
        own.collect()
    }

    /// What the values of the roots depend on where the conditions have these signs, in ascending order: of a choice one
    /// branch, or both where the sign is not known.
    pub fn taken_dependencies(
        &self,
        roots: &[ExprId],
        negative: &dyn Fn(ExprId) -> Option<bool>,
    ) -> Vec<ExprId> {
        let children = |id: ExprId| match self.node(id) {
            Node::Call(Function::Below, arguments) => match negative(arguments[0]) {
                Some(negative) => vec![arguments[0], arguments[chosen(negative)]],
                None => arguments.to_vec(),
            },
            _ => self.children(id),
        };
        closure(roots.to_vec(), children)
    }

    /// Everything of the kind that the roots are made of, by way of nodes of the kind, in ascending order.
    pub(super) fn reached(&self, roots: &[ExprId], kind: impl Fn(ExprId) -> bool) -> Vec<ExprId> {
        let of_kind = |parts: Vec<ExprId>| parts.into_iter().filter(|id| kind(*id)).collect();
        closure(of_kind(roots.to_vec()), |id| of_kind(self.children(id)))
    }

    /// The coordinates in an expression, in ascending order.
    pub fn coordinates(&self, id: ExprId) -> Vec<usize> {
        let symbols = self.symbols(id).into_iter();
        let coordinates = symbols.filter_map(|symbol| match symbol {
            Symbol::Coordinate(i) => Some(i),
            _ => None,
        });
        coordinates.collect()
    }

    /// The symbols in an expression.
    pub fn symbols(&self, id: ExprId) -> BTreeSet<Symbol> {
        self.dependencies(&[id])
            .into_iter()
            .filter_map(|id| match self.node(id) {
                Node::Symbol(symbol) => Some(*symbol),
                _ => None,
            })
            .collect()
    }
}

/// What is reached from some nodes, themselves included, in ascending order.
fn closure(roots: Vec<ExprId>, children: impl Fn(ExprId) -> Vec<ExprId>) -> Vec<ExprId> {
    let mut stack = roots;
    let mut seen: FxHashSet<ExprId> = stack.iter().copied().collect();
    while let Some(id) = stack.pop() {
        stack.extend(children(id).into_iter().filter(|child| seen.insert(*child)));
    }
    let mut order: Vec<ExprId> = seen.into_iter().collect();
    order.sort_unstable();
    order
}
