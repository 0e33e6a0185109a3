//! Pieces of a Hamiltonian whose flows are exact, the fewest that are found.
//!
//! A function of linear forms whose elements of the algebra commute has an explicit flow: these forms and its
//! gradient are constant along it. H is taken apart into its terms, and these are put together again into as few classes as possible
//! in which everything commutes (`colouring`). There are three ways to change the terms first, and the one that leads to the fewest pieces is
//! taken; what is declared is kept where nothing is gained.
//!
//! * A combination of quadratic Casimirs, which generate no flow, is taken from H (`casimirs`).
//! * A quadratic part is brought to squares of linear forms (`congruence`).
//! * All linear terms are one form.
//!
//! All of this is exact over the rational functions of the parameters. A floating-point number decides only between
//! combinations of Casimirs that leave equally many pieces, and which divisors are not zero at the default parameters.

mod additive;
mod atoms;
mod casimirs;
mod colouring;
mod congruence;

use super::exponential::{self, Exponential};
use super::one_parameter::{self, Block, Entry};
use super::separable;
use crate::check::expression;
use crate::exact::{Budget, Fraction, Rational};
use crate::model::{Algebra, Bracket, Model};
use crate::symbolic::{ExprId, Graph, Symbol};
use atoms::{Atom, Commuting, Form};
use congruence::{Order, Quadratic};

/// Work allowed for the forms of one Hamiltonian.
const WORK: u64 = 2_000_000;

/// The pieces that were found.
#[derive(Clone, Debug)]
pub struct Found {
    /// H without a combination of Casimirs, in the arena that was given; `None` where none is taken away.
    pub rest: Option<ExprId>,
    /// The pieces.
    pub pieces: Vec<Piece>,
    /// Whether these are the functions of one coordinate each that H is declared as.
    pub declared: bool,
    /// Whether the pieces are all of H: no Casimir, and no term that generates no flow, is missing.
    pub whole: bool,
    /// The closed form of functions of `ad*_x`, where a flow needs it and the algebra has one.
    pub exponential: Option<Exponential>,
}

/// A function of forms that commute.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Its terms.
    pub terms: Vec<ExprId>,
    /// Its flow over a time t: `exp(t s ad*_v)` for each factor, in any order.
    pub factors: Vec<Factor>,
}

/// A one-parameter group in the flow of a piece.
#[derive(Clone, Debug)]
pub struct Factor {
    /// The element v by its entries that do not vanish.
    pub direction: Vec<(usize, ExprId)>,
    /// The derivative s of the piece by the form of v.
    pub slope: ExprId,
    /// The closed form of `exp(s ad*_v)`, where it has one in blocks.
    pub blocks: Option<Vec<Block>>,
}

impl Factor {
    /// The coordinate that is the form.
    pub fn coordinate(&self, graph: &Graph) -> Option<usize> {
        match self.direction.as_slice() {
            [(i, one)] if graph.as_number(*one).is_some_and(Rational::is_one) => Some(*i),
            _ => None,
        }
    }
}

impl Piece {
    /// Whether it moves no state.
    fn is_idle(&self) -> bool {
        let mut factors = self.factors.iter();
        factors.all(|factor| factor.blocks.as_ref().is_some_and(Vec::is_empty))
    }
}

/// A way to take H apart.
struct Classified {
    /// The number of classes.
    count: usize,
    /// H without a combination of Casimirs.
    rest: Option<ExprId>,
    /// Its parts.
    atoms: Vec<Atom>,
    /// Their classes.
    classes: Vec<usize>,
}

/// The pieces of H, if there are any; `graph` is a copy of the arena of the model.
pub fn found(model: &Model, graph: &mut Graph) -> Option<Found> {
    let Bracket::Lie(algebra) = &model.bracket else {
        return None;
    };
    let hamiltonian = model.energy.expression()?;
    let commuting = Commuting::of(algebra);
    let budget = Budget::new(WORK);
    let start = graph.normal(hamiltonian.value);
    let rest = casimirs::without(model, &commuting, graph, start, &budget);
    let mut best: Option<Classified> = None;
    for rest in std::iter::once(None).chain(rest.map(Some)) {
        for atoms in variants(model, &commuting, graph, rest.unwrap_or(start), &budget) {
            let classes = classes(&commuting, &atoms, &budget);
            let count = colouring::count(&classes);
            if best.as_ref().is_none_or(|best| count < best.count) {
                best = Some(Classified {
                    count,
                    rest,
                    atoms,
                    classes,
                });
            }
        }
    }
    let declared = separable::pieces(model);
    let fewer = |count: usize| declared.as_ref().is_none_or(|all| count < all.len());
    match best.filter(|best| fewer(best.count)) {
        Some(best) => Some(put_together(algebra, graph, &best, &budget)),
        None => Some(as_declared(graph, start, &declared?)),
    }
}

/// The pieces that H is declared as.
fn as_declared(graph: &mut Graph, value: ExprId, declared: &[separable::Piece]) -> Found {
    let terms = additive::terms(graph, value).unwrap_or_default();
    let pieces = declared.iter().map(|piece| {
        let of = |term: &ExprId| graph.coordinates(*term) == [piece.coordinate];
        Piece {
            terms: terms.iter().copied().filter(of).collect(),
            factors: Vec::new(),
        }
    });
    Found {
        rest: None,
        pieces: pieces.collect(),
        declared: true,
        whole: true,
        exponential: None,
    }
}

/// The ways to take a function apart into functions of commuting forms.
fn variants(
    model: &Model,
    commuting: &Commuting<'_>,
    graph: &mut Graph,
    value: ExprId,
    budget: &Budget,
) -> Vec<Vec<Atom>> {
    let Some(terms) = additive::terms(graph, value) else {
        return Vec::new();
    };
    let mut all = Vec::new();
    let plain = atoms::by_coordinates(graph, &terms);
    let fits = |atoms: &[Atom]| {
        atoms.iter().all(|atom| match atom {
            Atom::Coordinates(set, _) => commuting.mixed(set).is_empty(),
            Atom::Form { .. } => true,
        })
    };
    if fits(&plain) {
        all.push(plain);
    }
    let Some(quadratic) = Quadratic::of(graph, &terms, model.dimension(), budget) else {
        return all;
    };
    if let Some((form, others)) = quadratic.linear_part(graph) {
        let mut atoms = atoms::by_coordinates(graph, &others);
        atoms.push(form);
        if fits(&atoms) {
            all.push(atoms);
        }
    }
    let default = |p: &crate::model::Parameter| Rational::from_f64(p.default_value);
    let defaults: Vec<Option<Rational>> = model.parameters.iter().map(default).collect();
    for order in [Order::Entangled, Order::Last] {
        let squares = quadratic
            .clone()
            .squares(graph, commuting, &defaults, order, budget);
        let Ok(Some((mut squares, others))) = squares else {
            continue;
        };
        if squares.is_empty() {
            break;
        }
        // what was put together again may cancel
        let rest = graph.sum(&others);
        let Some(others) = additive::terms(graph, rest) else {
            continue;
        };
        squares.extend(atoms::by_coordinates(graph, &others));
        if fits(&squares) {
            all.push(squares);
        }
    }
    all
}

/// The fewest classes of parts that commute.
fn classes(commuting: &Commuting<'_>, atoms: &[Atom], budget: &Budget) -> Vec<usize> {
    let conflict = |one: &Atom, other: &Atom| !commuting.commute(one, other, budget);
    let mut conflicts = vec![vec![false; atoms.len()]; atoms.len()];
    for (i, one) in atoms.iter().enumerate() {
        for (j, other) in atoms.iter().enumerate().skip(i + 1) {
            conflicts[i][j] = conflict(one, other);
            conflicts[j][i] = conflicts[i][j];
        }
    }
    colouring::fewest(&conflicts)
}

/// The pieces of a classification.
fn put_together(algebra: &Algebra, graph: &mut Graph, best: &Classified, budget: &Budget) -> Found {
    let rest = best.rest;
    let mut pieces = Vec::new();
    for class in 0..best.count {
        let members = best.atoms.iter().zip(&best.classes);
        let members: Vec<&Atom> = members
            .filter(|(_, of)| **of == class)
            .map(|(a, _)| a)
            .collect();
        pieces.push(piece(algebra, graph, &members, budget));
    }
    let all = pieces.len();
    pieces.retain(|piece| !piece.is_idle());
    let mut factors = pieces.iter().flat_map(|piece| &piece.factors);
    let open = factors.any(|factor| factor.blocks.is_none());
    Found {
        exponential: open
            .then(|| exponential::closed_form(&algebra.exact))
            .flatten(),
        whole: rest.is_none() && pieces.len() == all,
        rest,
        pieces,
        declared: false,
    }
}

/// A piece from its parts.
fn piece(algebra: &Algebra, graph: &mut Graph, atoms: &[&Atom], budget: &Budget) -> Piece {
    let (mut terms, mut written, mut coordinates) = (Vec::new(), Vec::new(), Vec::new());
    let mut factors = Vec::new();
    for atom in atoms {
        let of_atom = atom.terms(graph);
        terms.extend(&of_atom);
        match atom {
            Atom::Coordinates(set, _) => {
                coordinates.extend(set.iter().copied());
                written.extend(of_atom);
            }
            Atom::Form {
                form,
                square,
                slope,
            } => {
                let l = atoms::linear(graph, form);
                let factor = expression(graph, square);
                let first = graph.mul(factor, l);
                let second = expression(graph, slope);
                let slope = graph.add(first, second);
                factors.push(factor_of(algebra, graph, form, slope, budget));
            }
        }
    }
    let value = graph.sum(&written);
    coordinates.sort_unstable();
    coordinates.dedup();
    for i in coordinates {
        let slope = graph.derivative(value, Symbol::Coordinate(i));
        let slope = graph.tidy(slope);
        if !graph.is_zero(slope) {
            factors.push(factor_of(algebra, graph, &atoms::unit(i), slope, budget));
        }
    }
    Piece { terms, factors }
}

fn factor_of(
    algebra: &Algebra,
    graph: &mut Graph,
    form: &Form,
    slope: ExprId,
    budget: &Budget,
) -> Factor {
    let action = action(algebra, form, budget);
    Factor {
        direction: form
            .iter()
            .map(|(i, value)| (*i, expression(graph, value)))
            .collect(),
        slope,
        blocks: action.and_then(|entries| one_parameter::closed_form(&entries)),
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

/// H as the sum of its pieces.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Terms {
    /// The terms of each piece.
    pub pieces: Vec<Vec<String>>,
    /// Whether a combination of Casimirs was taken from H.
    pub shifted: bool,
}

/// H as the sum of its pieces, if there are any, as text.
pub fn terms(model: &Model) -> Option<Terms> {
    let mut graph = model.graph.clone();
    let found = found(model, &mut graph)?;
    let name = |symbol| model.symbol_name(symbol);
    let text = |term: &ExprId| graph.display(*term, &name);
    let pieces = found.pieces.iter();
    Some(Terms {
        pieces: pieces
            .map(|piece| piece.terms.iter().map(text).collect())
            .collect(),
        shifted: found.rest.is_some(),
    })
}

/// Why there are no pieces, with the nearest method for each order.
pub fn refusal(model: &Model, order: u32) -> Option<(String, String)> {
    let mut graph = model.graph.clone();
    if found(model, &mut graph).is_some() {
        return None;
    }
    let nearest = separable::nearest(order);
    let Some(hamiltonian) = model.energy.expression() else {
        return separable::refusal(model, order);
    };
    let algebra = model.bracket.algebra()?;
    let Some(terms) = additive::terms(&mut graph, hamiltonian.value) else {
        return Some((
            "the Hamiltonian has too many terms to be split".to_owned(),
            nearest,
        ));
    };
    let commuting = Commuting::of(algebra);
    let atoms = atoms::by_coordinates(&graph, &terms);
    let mut entangled = atoms.iter().filter_map(|atom| match atom {
        Atom::Coordinates(set, terms) => Some((commuting.mixed(set).first().copied()?, terms)),
        Atom::Form { .. } => None,
    });
    let name = |symbol| model.symbol_name(symbol);
    let reason = match entangled.next() {
        Some(((i, j), terms)) => format!(
            "no pieces with exact flows were found: `{}` contains `{}` and `{}`, which do not commute, and no \
             combination of quadratic Casimirs and no squares of linear forms change that",
            graph.display(terms[0], &name),
            model.coordinates[i].text,
            model.coordinates[j].text,
        ),
        None => "no pieces with exact flows were found".to_owned(),
    };
    Some((reason, nearest))
}

#[cfg(test)]
mod tests;
