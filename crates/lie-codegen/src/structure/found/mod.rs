//! Pieces of a Hamiltonian whose flows are exact, the fewest that are found.
//!
//! A function of linear forms whose elements of the algebra commute, and of Casimirs of subalgebras that commute with them
//! (`invariants`), has an explicit flow: these quantities are constant along it, and each generates a one-parameter group. H is taken
//! apart into its terms, and these are put together again into as few classes as possible
//! in which everything commutes (`colouring`). There are several ways to change the terms first, and those that lead to the fewest pieces are
//! kept; what is declared is taken where nothing is gained.
//!
//! * Casimirs that H contains become arguments (`recognition`).
//! * A combination of quadratic Casimirs, which generate no flow, is taken from H, and of Casimirs of subalgebras made a
//!   term of its own (`casimirs`).
//! * A quadratic part is brought to squares of linear forms (`congruence`).
//! * All linear terms are one form.
//!
//! All of this is exact over the rational functions of the parameters. A floating-point number decides only between
//! combinations of Casimirs that leave equally many pieces, and which divisors are not zero at the default parameters.

pub(super) mod additive;
mod assembly;
mod atoms;
mod casimirs;
mod colouring;
mod congruence;
mod entries;
mod field_flow;
mod invariants;
mod recognition;
mod report;
mod search;

use super::elementwise::Change;
use super::exponential::Exponential;
use super::one_parameter::Block;
use super::separable;
use crate::model::{Algebra, Bracket, Casimir, Model};
use atoms::{Atom, Commuting};
use lie_symbolic::exact::{Budget, Rational};
use lie_symbolic::symbolic::{ExprId, Graph};
use search::{Search, Work};

pub use report::{Terms, refusal, terms};

/// Work allowed for the forms of one Hamiltonian.
const WORK: u64 = 2_000_000;
/// Work allowed for classes of parts that commute, in all ways to take a Hamiltonian apart together.
const COLOURING: u64 = 20_000_000;
/// More ways with equally few pieces are not kept.
const MOST_WAYS: usize = 6;

/// The ways to split H into the fewest pieces.
#[derive(Clone, Debug, Default)]
pub struct Searched {
    /// The arena of their expressions.
    pub graph: Graph,
    /// The ways; none where H has no pieces.
    pub ways: Vec<Found>,
    /// On a bracket that is declared by its entries: the term whose flow has no closed form that is known.
    pub entangled: Option<ExprId>,
}

/// The pieces that were found.
#[derive(Clone, Debug)]
pub struct Found {
    /// H without a combination of Casimirs; `None` where none is taken away.
    pub rest: Option<ExprId>,
    /// The pieces.
    pub pieces: Vec<Piece>,
    /// Whether these are the functions of one coordinate each that H is declared as.
    pub declared: bool,
    /// Whether the pieces are all of H: no Casimir, and no term that generates no flow, is missing.
    pub whole: bool,
    /// The closed form of functions of `ad*_x`, where the flow of forms needs it and the algebra has one.
    pub exponential: Option<Exponential>,
}

/// A function of quantities that commute.
#[derive(Clone, Debug)]
pub struct Piece {
    /// Its terms.
    pub terms: Vec<ExprId>,
    /// Its flow over a time t: `exp(t s ad*_v)` for each factor, in any order,
    pub factors: Vec<Factor>,
    /// and `exp(t s ad*_(grad c(mu)))` for each Casimir c, which commute with all of these.
    pub conserved: Vec<Conserved>,
    /// On a bracket that is declared by its entries, in place of these: what its flow over the time `t` does with the
    /// coordinates that move, ascending.
    pub map: Option<Vec<(usize, Change)>>,
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

/// A Casimir of the algebra or of a subalgebra in a piece.
#[derive(Clone, Debug)]
pub struct Conserved {
    /// The gradient of the Casimir c by its entries that do not vanish.
    pub gradient: Vec<(usize, ExprId)>,
    /// The derivative s of the piece by c.
    pub slope: ExprId,
    /// The coordinates that the flow of c moves: none of a Casimir of the algebra.
    pub moved: Vec<usize>,
    /// The closed form of functions of `ad*_x`, x an element of the subalgebra, where it has one.
    pub exponential: Option<Exponential>,
}

/// The way that is taken.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chosen {
    /// Its place among the ways.
    pub way: usize,
    /// Its pieces in the order of a step, that with the longest flow last.
    pub order: Vec<usize>,
    /// The operations of a step of order 2 of each way, in units of one multiplication.
    pub costs: Vec<usize>,
}

impl Found {
    /// The same in another arena.
    pub fn moved(&self, from: &Graph, to: &mut Graph) -> Self {
        let mut all = self.clone();
        let mut ids: Vec<&mut ExprId> = all.rest.iter_mut().collect();
        for piece in &mut all.pieces {
            ids.extend(&mut piece.terms);
            for factor in &mut piece.factors {
                ids.extend(factor.direction.iter_mut().map(|(_, id)| id));
                ids.push(&mut factor.slope);
            }
            for conserved in &mut piece.conserved {
                ids.extend(conserved.gradient.iter_mut().map(|(_, id)| id));
                ids.push(&mut conserved.slope);
            }
            for (_, change) in piece.map.iter_mut().flatten() {
                let (Change::Add(id) | Change::Multiply(id)) = change;
                ids.push(id);
            }
        }
        let roots: Vec<ExprId> = ids.iter().map(|id| **id).collect();
        for (id, image) in ids.into_iter().zip(to.import(from, &roots)) {
            *id = image;
        }
        all
    }
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
        if let Some(map) = &self.map {
            return map.is_empty();
        }
        let mut factors = self.factors.iter();
        let mut conserved = self.conserved.iter();
        factors.all(|factor| factor.blocks.as_ref().is_some_and(Vec::is_empty))
            && conserved.all(|conserved| conserved.moved.is_empty())
    }
}

/// A way to take H apart.
struct Classified {
    /// The number of classes.
    count: usize,
    /// H without a combination of Casimirs.
    rest: Option<ExprId>,
    /// Whether the parts are all of H.
    whole: bool,
    /// Its parts.
    atoms: Vec<Atom>,
    /// Their classes.
    classes: Vec<usize>,
}

/// Looks for the ways to split H into the fewest pieces, given the Casimirs and the pieces of one coordinate each.
pub fn search(model: &Model, known: &[Casimir], declared: Option<&[separable::Piece]>) -> Searched {
    let mut graph = model.graph.clone();
    let mut entangled = None;
    // what a constraint leaves is no Poisson bracket
    let ways = if model.family.is_some() || model.constraint.is_some() {
        Vec::new()
    } else {
        match &model.bracket {
            Bracket::Lie(algebra) => {
                ways(model, algebra, known, declared, &mut graph).unwrap_or_default()
            }
            Bracket::General(matrix) => match entries::pieces(model, matrix, &mut graph) {
                Ok(found) => vec![found],
                Err(term) => {
                    entangled = term;
                    Vec::new()
                }
            },
        }
    };
    Searched {
        graph,
        ways,
        entangled,
    }
}

fn ways(
    model: &Model,
    algebra: &Algebra,
    known: &[Casimir],
    declared: Option<&[separable::Piece]>,
    graph: &mut Graph,
) -> Option<Vec<Found>> {
    let hamiltonian = model.energy.expression()?;
    let start = graph.normal(hamiltonian.value);
    let budget = Budget::new(WORK);
    let invariants = invariants::collect(known, algebra, graph, start);
    let least = declared.map_or(usize::MAX, <[_]>::len);
    // one piece cannot be less
    let mut best: Vec<Classified> = Vec::new();
    if least > 1 {
        let search = Search {
            model,
            commuting: Commuting::new(algebra, graph, &invariants),
            invariants: &invariants,
            work: Work {
                forms: &budget,
                colouring: &Budget::new(COLOURING),
            },
        };
        for way in search.ways(graph, start) {
            let count = best.first().map_or(least, |best| best.count + 1);
            if way.count >= count {
                continue;
            }
            if best.first().is_some_and(|best| way.count < best.count) {
                best.clear();
            }
            best.push(way);
        }
    }
    if best.is_empty() {
        return Some(vec![as_declared(graph, start, declared?)]);
    }
    let mut ways: Vec<Found> = Vec::new();
    for way in best {
        let found = assembly::put_together(algebra, graph, &invariants, &way, &budget);
        let same = |other: &Found| {
            let (one, other) = (found.pieces.iter(), other.pieces.iter());
            one.map(|piece| &piece.terms)
                .eq(other.map(|piece| &piece.terms))
        };
        if ways.len() < MOST_WAYS && !ways.iter().any(same) {
            ways.push(found);
        }
    }
    Some(ways)
}

/// The pieces that H is declared as.
fn as_declared(graph: &mut Graph, value: ExprId, declared: &[separable::Piece]) -> Found {
    let terms = additive::terms(graph, value).unwrap_or_default();
    let pieces = declared.iter().map(|piece| {
        let of = |term: &ExprId| graph.coordinates(*term) == [piece.coordinate];
        Piece {
            terms: terms.iter().copied().filter(of).collect(),
            factors: Vec::new(),
            conserved: Vec::new(),
            map: None,
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

#[cfg(test)]
mod tests;
