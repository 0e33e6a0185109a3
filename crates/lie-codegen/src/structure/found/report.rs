//! What is said of the pieces, or of why there are none.

use super::atoms::{Atom, Commuting};
use super::{Found, Searched, additive};
use crate::model::{Bracket, Model};
use crate::structure::{Structure, separable};
use lie_symbolic::symbolic::ExprId;

/// H as the sum of its pieces.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Terms {
    /// The terms of each piece.
    pub pieces: Vec<Vec<String>>,
    /// Whether a combination of Casimirs was taken from H.
    pub shifted: bool,
}

/// The pieces of one way to split H, as text.
pub fn terms(model: &Model, searched: &Searched, found: &Found) -> Terms {
    let name = |symbol| model.symbol_name(symbol);
    let text = |term: &ExprId| searched.graph.display(*term, &name);
    let pieces = found.pieces.iter();
    Terms {
        pieces: pieces
            .map(|piece| piece.terms.iter().map(text).collect())
            .collect(),
        shifted: found.rest.is_some(),
    }
}

impl Searched {
    /// How many pieces there are.
    pub fn count(&self) -> usize {
        self.ways.first().map_or(0, |way| way.pieces.len())
    }
}

/// Why there are no pieces, with the nearest method for each order.
pub fn refusal(structure: &Structure, order: u32) -> Option<(String, String)> {
    let searched = &structure.splitting;
    if !searched.ways.is_empty() {
        return None;
    }
    let nearest = separable::nearest(order);
    let Some(hamiltonian) = structure.energy.expression() else {
        return separable::refusal(structure, order);
    };
    let name = |symbol| structure.symbol_name(symbol);
    let algebra = match &structure.bracket {
        Bracket::Lie(algebra) => algebra,
        Bracket::General(_) => {
            let reason = match searched.entangled {
                Some(term) => format!(
                    "no pieces with exact flows were found: no flow in closed form is known of `{}` on this bracket",
                    searched.graph.display(term, &name),
                ),
                None => "no pieces with exact flows were found".to_owned(),
            };
            return Some((reason, nearest_on_entries(order)));
        }
    };
    let mut graph = searched.graph.clone();
    let Some(terms) = additive::terms(&mut graph, hamiltonian.value) else {
        return Some((
            "the Hamiltonian has too many terms to be split".to_owned(),
            nearest,
        ));
    };
    let commuting = Commuting::new(algebra, &mut graph, &[]);
    let atoms = commuting.by_arguments(&graph, &terms);
    let mut entangled = atoms.iter().filter_map(|atom| match atom {
        Atom::Function(set, terms) => Some((commuting.mixed(set).first().copied()?, terms)),
        Atom::Form { .. } => None,
    });
    let reason = match entangled.next() {
        Some(((i, j), terms)) => format!(
            "no pieces with exact flows were found: `{}` contains `{}` and `{}`, which do not commute, and no \
             combination of quadratic Casimirs, of the algebra or of a subalgebra, and no squares of linear forms change that",
            graph.display(terms[0], &name),
            structure.coordinates[i].text,
            structure.coordinates[j].text,
        ),
        None => "no pieces with exact flows were found".to_owned(),
    };
    Some((reason, nearest))
}

/// The remedy on a bracket that is declared by its entries: the nearest method of an order.
fn nearest_on_entries(order: u32) -> String {
    let nearest = match order {
        1 | 2 => "k-hj2",
        3 | 4 => "k-hj4",
        _ => "k-hj6",
    };
    format!("use `{nearest}`, which is a Poisson map for every Hamiltonian")
}
