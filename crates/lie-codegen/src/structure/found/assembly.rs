//! Pieces from their parts.

use super::atoms::{self, Atom, Form};
use super::invariants::Invariant;
use super::{Classified, Conserved, Factor, Found, Piece};
use crate::model::Algebra;
use crate::structure::exponential;
use crate::structure::one_parameter::{self, Entry};
use crate::structure::separable;
use lie_symbolic::exact::{Budget, Fraction};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

/// The pieces of a classification; `start` is H.
pub(super) fn put_together(
    algebra: &Algebra,
    graph: &mut Graph,
    invariants: &[Invariant],
    way: &Classified,
    budget: &Budget,
) -> Found {
    let assembly = Assembly {
        algebra,
        invariants,
        budget,
    };
    let mut pieces = Vec::new();
    for class in 0..way.count {
        let members = way.atoms.iter().zip(&way.classes);
        let members: Vec<&Atom> = members
            .filter(|(_, of)| **of == class)
            .map(|(a, _)| a)
            .collect();
        pieces.push(assembly.piece(graph, &members));
    }
    let all = pieces.len();
    pieces.retain(|piece| !piece.is_idle());
    let mut factors = pieces.iter().flat_map(|piece| &piece.factors);
    let open = factors.any(|factor| factor.blocks.is_none());
    Found {
        exponential: open
            .then(|| exponential::closed_form(&algebra.exact))
            .flatten(),
        whole: way.whole && pieces.len() == all,
        rest: way.rest,
        pieces,
        declared: false,
    }
}

struct Assembly<'a> {
    algebra: &'a Algebra,
    invariants: &'a [Invariant],
    budget: &'a Budget,
}

impl Assembly<'_> {
    /// A piece from its parts.
    fn piece(&self, graph: &mut Graph, atoms: &[&Atom]) -> Piece {
        let (mut terms, mut written, mut arguments) = (Vec::new(), Vec::new(), Vec::new());
        let mut factors = Vec::new();
        for atom in atoms {
            let of_atom = atom.terms(graph);
            terms.extend(self.expanded(graph, &of_atom));
            match atom {
                Atom::Function(set, _) => {
                    arguments.extend(set.iter().copied());
                    written.extend(of_atom);
                }
                Atom::Form {
                    form,
                    square,
                    slope,
                } => {
                    let l = atoms::linear(graph, form);
                    let factor = graph.rational_function(square);
                    let first = graph.mul(factor, l);
                    let second = graph.rational_function(slope);
                    let slope = graph.add(first, second);
                    factors.push(self.factor(graph, form, slope));
                }
            }
        }
        let value = graph.sum(&written);
        arguments.sort_unstable();
        arguments.dedup();
        let n = self.algebra.basis.len();
        let mut conserved = Vec::new();
        for i in arguments {
            let symbol = match i.checked_sub(n) {
                None => Symbol::Coordinate(i),
                Some(k) => self.invariants[k].symbol,
            };
            let slope = graph.derivative(value, symbol);
            let slope = self.expanded(graph, &[slope])[0];
            let slope = graph.tidy(slope);
            if graph.is_zero(slope) {
                continue;
            }
            match i.checked_sub(n) {
                None => factors.push(self.factor(graph, &atoms::unit(i), slope)),
                Some(k) => conserved.push(self.conserved(graph, k, slope)),
            }
        }
        Piece {
            terms,
            factors,
            conserved,
            map: None,
        }
    }

    /// Expressions with what the symbols of Casimirs stand for.
    fn expanded(&self, graph: &mut Graph, values: &[ExprId]) -> Vec<ExprId> {
        if self.invariants.is_empty() {
            return values.to_vec();
        }
        graph.substitute(values, &|symbol| {
            let of = |known: &&Invariant| known.symbol == symbol;
            self.invariants.iter().find(of).map(|known| known.value)
        })
    }

    fn conserved(&self, graph: &mut Graph, k: usize, slope: ExprId) -> Conserved {
        let invariant = &self.invariants[k];
        let mut gradient = Vec::new();
        for &i in &invariant.support {
            let entry = graph.derivative(invariant.value, Symbol::Coordinate(i));
            gradient.push((i, entry));
        }
        Conserved {
            exponential: (!invariant.moved.is_empty())
                .then(|| exponential::closed_form_on(&self.algebra.exact, &invariant.support))
                .flatten(),
            gradient,
            slope,
            moved: invariant.moved.clone(),
        }
    }

    fn factor(&self, graph: &mut Graph, form: &Form, slope: ExprId) -> Factor {
        let action = action(self.algebra, form, self.budget);
        Factor {
            direction: form
                .iter()
                .map(|(i, value)| (*i, graph.rational_function(value)))
                .collect(),
            slope,
            blocks: action.and_then(|entries| one_parameter::closed_form(&entries)),
        }
    }
}

/// The matrix of `ad*_v`; `None` where it is too much work.
fn action(algebra: &Algebra, form: &Form, budget: &Budget) -> Option<Vec<Entry>> {
    let mut entries: Vec<Entry> = Vec::new();
    for (i, v) in form {
        for (row, column, value) in separable::action(algebra, *i) {
            let value = value.mul(v, budget).ok()?;
            match entries
                .iter_mut()
                .find(|(j, k, _)| (*j, *k) == (row, column))
            {
                Some((.., known)) => *known = known.add(&value, budget).ok()?,
                None => entries.push((row, column, value)),
            }
        }
    }
    entries.retain(|(.., value): &(usize, usize, Fraction)| !value.is_zero());
    Some(entries)
}
