//! Expressions as n-ary sums and products of atoms, signs and divisions made explicit.

use std::collections::BTreeSet;

use rustc_hash::FxHashMap as HashMap;

use super::collect::Answers;
use super::program::Value;
use super::{KnownSymbols, builder};
use crate::exact::Rational;
use crate::symbolic::{ExprId, Function, Graph, Symbol};

/// Position of an [`Atom`] in its formula.
pub type AtomId = usize;

/// A term or factor: the flag is a minus sign.
pub type Signed = (bool, AtomId);

/// A quantity of a formula.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Atom {
    Leaf(Value),
    Sum(Vec<Signed>),
    /// Factors sorted, powers repeated.
    Product(Vec<AtomId>),
    Quotient(AtomId, AtomId),
    Root(AtomId),
    Power(AtomId, Rational),
    Call(Function, Vec<AtomId>),
}

impl Atom {
    /// What it is made of.
    pub fn operands(&self) -> Vec<AtomId> {
        match self {
            Atom::Leaf(_) => Vec::new(),
            Atom::Sum(terms) => terms.iter().map(|(_, id)| *id).collect(),
            Atom::Product(factors) => factors.clone(),
            Atom::Quotient(a, b) => vec![*a, *b],
            Atom::Root(a) | Atom::Power(a, _) => vec![*a],
            Atom::Call(_, arguments) => arguments.clone(),
        }
    }
}

/// All quantities of a kernel.
pub struct Formula {
    pub atoms: Vec<Atom>,
    pub(super) index: HashMap<Atom, AtomId>,
    pub definitions: Vec<(Symbol, Signed)>,
    pub outputs: Vec<Signed>,
    /// Whether terms of a sum have a coefficient in common.
    pub can_group: bool,
}

impl Formula {
    /// The formula of the roots: first the definitions of `symbols`, then the outputs; `group`
    /// collects terms behind common coefficients.
    pub fn new(
        graph: &mut Graph,
        symbols: &[Symbol],
        roots: &[ExprId],
        known: KnownSymbols,
        group: bool,
        answers: &mut Answers,
    ) -> Self {
        let mut build =
            |flipped| builder::build(graph, symbols, roots, (known, answers), group, flipped);
        let first = build(BTreeSet::new());
        // A coefficient that results need with a minus sign is prepared with it everywhere.
        if first.1.is_empty() {
            first.0
        } else {
            build(first.1).0
        }
    }

    /// Empties the atoms that no result needs, so that they are not shared with.
    pub fn forget_unused(&mut self) {
        let mut used = vec![false; self.atoms.len()];
        let mut stack: Vec<AtomId> = self
            .outputs
            .iter()
            .chain(self.definitions.iter().map(|(_, signed)| signed))
            .map(|(_, id)| *id)
            .collect();
        while let Some(id) = stack.pop() {
            if !std::mem::replace(&mut used[id], true) {
                stack.extend(self.atoms[id].operands());
            }
        }
        for (atom, used) in self.atoms.iter_mut().zip(used) {
            if !used {
                *atom = Atom::Sum(Vec::new());
            }
        }
        self.index.retain(|atom, id| self.atoms[*id] == *atom);
    }

    pub fn intern(&mut self, atom: Atom) -> AtomId {
        if let Some(&id) = self.index.get(&atom) {
            return id;
        }
        self.atoms.push(atom.clone());
        self.index.insert(atom, self.atoms.len() - 1);
        self.atoms.len() - 1
    }
}
