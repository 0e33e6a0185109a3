//! Brackets: Lie algebras and Poisson matrices.

use super::Model;
use crate::algebra::{Parametric, Representation, StructureConstants, TripleEntry};
use lie_symbolic::exact::Fraction;
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};
use lie_syntax::ast::Name;

/// What the bracket of a system is.
#[derive(Clone, Debug)]
pub enum Bracket {
    /// The Lie–Poisson bracket of an algebra: `{mu_i, mu_j} = -C_ij^k mu_k`.
    Lie(Algebra),
    /// A Poisson matrix that was given entry by entry.
    General(PoissonMatrix),
}

impl Bracket {
    /// The algebra.
    pub fn algebra(&self) -> Option<&Algebra> {
        match self {
            Bracket::Lie(algebra) => Some(algebra),
            Bracket::General(_) => None,
        }
    }

    /// The matrices of the algebra, where they are numbers.
    pub fn representation(&self) -> Option<&Representation> {
        self.algebra()?.representation.as_ref()
    }

    /// The matrices of the algebra, where they have parameters.
    pub fn parametric(&self) -> Option<&Parametric> {
        self.algebra()?.parametric.as_deref()
    }

    /// The triple product of the matrices, whose entries may have parameters.
    pub fn triple(&self) -> Option<&[TripleEntry]> {
        let of_functions = || self.parametric()?.triple.as_deref();
        match self.representation() {
            Some(representation) => representation.triple.as_deref(),
            None => of_functions(),
        }
    }

    /// The Poisson matrix, where structure constants do not say it all.
    pub fn matrix(&self) -> Option<&PoissonMatrix> {
        match self {
            Bracket::Lie(_) => None,
            Bracket::General(matrix) => Some(matrix),
        }
    }

    /// The entries `(i, j, {x_i, x_j})` above the diagonal, `i < j`, ascending, those that are not zero; of a central extension where
    /// its coordinate is 1.
    pub fn entries(&self, graph: &mut Graph) -> Vec<(usize, usize, ExprId)> {
        let algebra = match self {
            Bracket::Lie(algebra) => algebra,
            Bracket::General(matrix) => return matrix.entries.clone(),
        };
        let unit = algebra.extension.as_ref().map(|extension| extension.unit);
        let constants = algebra.constants.entries();
        let pairs = constants.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1));
        let entry = |pair: &[(usize, usize, usize, ExprId)]| {
            let mut sum = Vec::new();
            for (.., k, value) in pair {
                let mu = match Some(*k) == unit {
                    true => graph.integer(1),
                    false => graph.symbol(Symbol::Coordinate(*k)),
                };
                let term = graph.mul(*value, mu);
                sum.push(graph.neg(term));
            }
            (pair[0].0, pair[0].1, graph.sum(&sum))
        };
        pairs.map(entry).collect()
    }
}

/// A Lie algebra. Of a right-invariant declaration it is the opposite one, so that every model is left-invariant.
#[derive(Clone, Debug)]
pub struct Algebra {
    /// Names of the basis.
    pub basis: Vec<Name>,
    /// Structure constants as rational functions of the parameters (variable `p` is parameter `p`).
    pub exact: StructureConstants<Fraction>,
    /// The same in the arena.
    pub constants: StructureConstants<ExprId>,
    /// The matrix representation, where its entries are numbers.
    pub representation: Option<Representation>,
    /// The matrix representation, where its entries have parameters: those of the declared algebra, and their triple product in this one.
    pub parametric: Option<Box<Parametric>>,
    /// The cocycle by which this is a central extension of the declared algebra.
    pub extension: Option<Box<Extension>>,
}

/// What makes an algebra a central extension.
#[derive(Clone, Debug)]
pub struct Extension {
    /// The cocycle.
    pub cocycle: Cocycle,
    /// The central element, whose coordinate is 1.
    pub unit: usize,
    /// The matrices without the cocycle, those of the group.
    pub declared: Option<Representation>,
}

impl Algebra {
    /// The matrices in which a group element is one: those of the algebra, without a cocycle.
    pub fn group_representation(&self) -> Option<&Representation> {
        match &self.extension {
            Some(extension) => extension.declared.as_ref(),
            None => self.representation.as_ref(),
        }
    }
}

/// A cocycle S of an algebra, which is part of the structure constants of the extension.
#[derive(Clone, Debug)]
pub enum Cocycle {
    /// `S_ij = C_ij^k s_k` with s for each declared element: `mu - s` moves as without the cocycle.
    Coboundary(Vec<Fraction>),
    /// There are no such s.
    Proper,
    /// The structure constants have parameters, or there are too many of them.
    Undecided,
}

/// The Poisson matrix `Pi_ij = {x_i, x_j}`.
#[derive(Clone, Debug)]
pub struct PoissonMatrix {
    /// Number of coordinates n.
    pub dimension: usize,
    /// The entries `(i, j, Pi_ij)` above the diagonal, `i < j`, ascending, those that are not zero.
    pub entries: Vec<(usize, usize, ExprId)>,
    /// The largest total degree of an entry in the coordinates, where all are polynomials in them.
    pub degree: Option<u32>,
}

impl PoissonMatrix {
    /// All rows.
    pub fn rows(&self, graph: &mut Graph) -> Vec<Vec<ExprId>> {
        let zero = graph.integer(0);
        let mut rows = vec![vec![zero; self.dimension]; self.dimension];
        for (i, j, value) in &self.entries {
            rows[*i][*j] = *value;
            rows[*j][*i] = graph.neg(*value);
        }
        rows
    }
}

/// The bracket `{f, g} = sum_ij df/dx_i Pi_ij dg/dx_j`, by the entries of the Poisson matrix above the diagonal.
pub fn bracket_of(
    graph: &mut Graph,
    entries: &[(usize, usize, ExprId)],
    f: ExprId,
    g: ExprId,
) -> ExprId {
    let mut terms = Vec::new();
    for (i, j, value) in entries {
        let [a, b] = [*i, *j].map(Symbol::Coordinate);
        for (a, b, negative) in [(a, b, false), (b, a, true)] {
            let slope = graph.derivative(f, a);
            if graph.is_zero(slope) {
                continue;
            }
            let other = graph.derivative(g, b);
            let term = graph.product(&[slope, *value, other]);
            terms.push(if negative { graph.neg(term) } else { term });
        }
    }
    graph.sum(&terms)
}

impl Model {
    /// Why something that needs matrices of numbers is not to be had, with the remedy; none where the declared ones have no parameters.
    pub fn parametric_matrices(&self, what: &str) -> Option<(String, String)> {
        let parametric = self.bracket.parametric()?;
        Some(parametric.refusal(what, |index| &self.parameters[index].name))
    }

    /// What the cocycle that is added to the bracket is.
    pub fn cocycle_in_words(&self) -> Option<String> {
        let extension = self.bracket.algebra()?.extension.as_ref()?;
        Some(match &extension.cocycle {
            Cocycle::Coboundary(shift) => {
                let name = |p: usize| self.parameters[p].name.clone();
                let moved = self.coordinates.iter().zip(shift);
                let moved = moved.filter(|(_, s)| !s.is_zero());
                let moved = moved.map(|(x, s)| {
                    let (x, shown) = (&x.text, s.display(&name));
                    match s.as_constant() {
                        Some(c) if c.is_negative() => format!("{x} + {}", c.abs()),
                        _ if shown.contains([' ', '-', '+']) => format!("{x} - ({shown})"),
                        _ => format!("{x} - {shown}"),
                    }
                });
                let moved: Vec<String> = moved.collect();
                format!(
                    "a coboundary: {} have the bracket without it",
                    moved.join(", ")
                )
            }
            Cocycle::Proper => "no coboundary: no shift of the coordinates takes it away".into(),
            Cocycle::Undecided => {
                "whether a shift of the coordinates takes it away was not decided".into()
            }
        })
    }

    /// The dimension with the generic rank and that at the initial state. Coordinates that are there for a cocycle alone do not count:
    /// the time and its momentum add two to the ranks.
    pub fn counts(&self) -> (usize, usize, Option<usize>) {
        let idle = self.configuration.as_ref().is_some_and(|c| c.idle);
        let [hidden, ranks] = if idle { [3, 2] } else { [0, 0] };
        let initial = self.initial_rank.map(|rank| rank - ranks);
        (
            self.dimension() - hidden,
            self.generic_rank - ranks,
            initial,
        )
    }
}
