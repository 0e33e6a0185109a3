//! Hamiltonians that are sums of functions of one coordinate each: what splittings by coordinate
//! pieces need.
//!
//! H is such a sum exactly if its mixed second derivatives vanish. Each is proven to be zero by the
//! normal form that verifies Casimirs; one that cannot be is taken for one that is not.

use super::Structure;
use super::one_parameter::{self, Block, Entry};
use crate::model::Algebra;
use lie_symbolic::exact::Budget;
use lie_symbolic::prove::confirmation::{Confirmation, Finding};
use lie_symbolic::prove::normal::{NormalForm, Verdict};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

/// Work allowed for the derivatives of one Hamiltonian.
const WORK: u64 = 500_000;

/// The flow of `f_i(mu_i)`: `exp(t f_i'(mu_i) ad*_(e_i)) mu`.
#[derive(Clone, Debug)]
pub struct Piece {
    /// The coordinate i.
    pub coordinate: usize,
    /// The closed form of `exp(s ad*_(e_i))`, block by block; `None` where the series is summed.
    pub blocks: Option<Vec<Block>>,
}

/// The coordinates on which H depends, in ascending order, if H is a sum of functions of one of them
/// each.
///
/// `graph` is an arena that may be littered.
///
/// # Errors
/// Two coordinates that H mixes.
pub fn coordinates(
    graph: &mut Graph,
    hamiltonian: ExprId,
    dimension: usize,
) -> Result<Vec<usize>, (usize, usize)> {
    let slopes: Vec<ExprId> = (0..dimension)
        .map(|i| graph.derivative(hamiltonian, Symbol::Coordinate(i)))
        .collect();
    let mut mixed = Vec::new();
    for (i, slope) in slopes.iter().enumerate() {
        for j in i + 1..dimension {
            let second = graph.derivative(*slope, Symbol::Coordinate(j));
            if !graph.is_zero(second) {
                mixed.push((i, j, second));
            }
        }
    }
    let graph = &*graph;
    let budget = Budget::new(WORK);
    let mut normal = NormalForm::with_domain(graph, &budget, &[hamiltonian]);
    let mut values = Confirmation::new(graph, &[hamiltonian]);
    // Values refute what the normal form may not decide within its budget.
    let mut vanishes = |id: ExprId| {
        graph.is_zero(id)
            || values.check_zero(id) != Finding::Nonzero
                && matches!(normal.verdict(id), Verdict::Zero)
    };
    for (i, j, second) in mixed {
        if !vanishes(second) {
            return Err((i, j));
        }
    }
    let moves = |i: &usize| !vanishes(slopes[*i]);
    Ok((0..dimension).filter(moves).collect())
}

/// The pieces in some coordinates, without those whose elements act as zero.
pub fn pieces(algebra: &Algebra, coordinates: &[usize]) -> Vec<Piece> {
    let mut pieces = Vec::new();
    for &coordinate in coordinates {
        let entries = action(algebra, coordinate);
        if !entries.is_empty() {
            let blocks = one_parameter::closed_form(&entries);
            pieces.push(Piece { coordinate, blocks });
        }
    }
    pieces
}

/// The matrix of `ad*_(e_i)`.
pub(super) fn action(algebra: &Algebra, coordinate: usize) -> Vec<Entry> {
    // (ad*_(e_i))_jk = C_ij^k, and C_ji^k = -C_ij^k
    let constants = algebra.exact.entries().iter();
    constants
        .filter_map(|(i, j, k, value)| match coordinate {
            _ if coordinate == *i => Some((*j, *k, value.clone())),
            _ if coordinate == *j => Some((*i, *k, value.neg())),
            _ => None,
        })
        .collect()
}

/// The closed form of `exp(s ad*_(e_i))`, where it has one.
pub fn action_of(algebra: &Algebra, coordinate: usize) -> Option<Vec<Block>> {
    one_parameter::closed_form(&action(algebra, coordinate))
}

/// The same for each basis element.
pub fn actions(algebra: &Algebra) -> Vec<Option<Vec<Block>>> {
    let elements = 0..algebra.basis.len();
    elements.map(|i| action_of(algebra, i)).collect()
}

/// Why H cannot be split by coordinates, with the nearest method for each order.
pub fn refusal(structure: &Structure, order: u32) -> Option<(String, String)> {
    let Some(coordinates) = &structure.separable else {
        let reason = "the Hamiltonian is not a sum of functions of one coordinate each: it is the Legendre transform \
                      of a Lagrangian that is not quadratic";
        return Some((reason.to_owned(), nearest(order)));
    };
    let (i, j) = *coordinates.as_ref().err()?;
    let name = |i: usize| &structure.coordinates[i].text;
    let reason = format!(
        "the Hamiltonian is not a sum of functions of one coordinate each: it mixes `{}` and `{}`",
        name(i),
        name(j)
    );
    Some((reason, nearest(order)))
}

/// The remedy: the nearest method of an order.
pub(super) fn nearest(order: u32) -> String {
    let nearest = match order {
        1 | 2 => "`lie-midpoint`".to_owned(),
        order => format!("`compose{order}(lie-midpoint)`"),
    };
    format!("use {nearest}, which is a Poisson map for every Hamiltonian")
}
