//! Lie algebras by name: families with a size, and what is made of them by sums, powers, semidirect products,
//! tangent algebras, central extensions and a change of basis.
//!
//! A [`NamedAlgebra`] has names, structure constants and, where there is one of moderate size, a faithful
//! representation. [`NamedAlgebra::declared`] writes it into the syntax tree, so that every check sees brackets and matrices as
//! if they had been written.

mod bianchi;
mod change;
mod combine;
mod declared;
mod euclidean;
mod family;
mod frame;
mod linear;
mod matrix;
mod names;
mod nilpotent;
mod orthogonal;
mod relativity;
mod symplectic;
mod toda;
mod unitary;

use std::collections::BTreeMap;

pub use change::{Central, changed, extended};
pub use combine::{Acted, direct_sum, semidirect, tangent};
pub use family::{Argument, Constructor, FAMILIES, Family, Wrong, family};
pub use matrix::Entries;

use frame::Frame;
use lie_symbolic::exact::Rational;

/// Entries of all matrices together up to which a representation is carried along; beyond, nothing could be
/// decided about it.
const MOST_ENTRIES: usize = 100_000;

/// Structure constants: the terms of `[e_i, e_j]`, `i < j`, by their indices.
pub type Constants = BTreeMap<(usize, usize), BTreeMap<usize, Rational>>;

/// A matrix of each basis element.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrices {
    /// Their size.
    pub size: usize,
    /// Their entries that are not zero.
    pub entries: Vec<Entries>,
}

/// A Lie algebra with names.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedAlgebra {
    /// Names of the basis.
    pub basis: Vec<String>,
    /// Names of the coordinates, for declarations that name none.
    pub state: Vec<String>,
    /// The brackets.
    pub constants: Constants,
    /// A faithful representation.
    pub representation: Option<Matrices>,
}

impl NamedAlgebra {
    /// The number of basis elements.
    pub fn dimension(&self) -> usize {
        self.basis.len()
    }

    /// The algebra that independent matrices span; its brackets are their commutators.
    fn from_matrices(elements: Vec<Element>, size: usize) -> Self {
        let (mut basis, mut state, mut entries) = (Vec::new(), Vec::new(), Vec::new());
        for element in elements {
            basis.push(element.basis);
            state.push(element.state);
            entries.push(element.matrix);
        }
        let constants = Frame::new(&entries).and_then(|frame| frame.constants(&entries));
        Self {
            basis,
            state,
            constants: constants.expect("the matrices of a family span an algebra"),
            representation: Matrices::moderate(size, entries),
        }
    }

    /// `[e_i, e_j]` for any i and j.
    fn bracket(&self, i: usize, j: usize) -> BTreeMap<usize, Rational> {
        let terms = |i, j| self.constants.get(&(i, j)).cloned().unwrap_or_default();
        if i < j {
            return terms(i, j);
        }
        let terms = terms(j, i).into_iter();
        terms.map(|(k, value)| (k, -value)).collect()
    }

    /// The matrices of `ad`: column j of the i-th is `[e_i, e_j]`.
    pub fn adjoint(&self) -> Matrices {
        let n = self.dimension();
        let mut entries = vec![Entries::new(); n];
        for (&(i, j), terms) in &self.constants {
            for (k, value) in terms {
                entries[i].insert((*k, j), value.clone());
                entries[j].insert((*k, i), -value);
            }
        }
        Matrices { size: n, entries }
    }
}

impl Matrices {
    /// The matrices, where they are not too many.
    fn moderate(size: usize, entries: Vec<Entries>) -> Option<Self> {
        (entries.len() * size * size <= MOST_ENTRIES).then_some(Self { size, entries })
    }

    /// The matrices of the dual representation, the negative transposes.
    #[must_use]
    pub fn dual(&self) -> Self {
        let entries = self.entries.iter();
        let dual = |matrix: &Entries| {
            let entries = matrix.iter();
            entries.map(|((r, c), v)| ((*c, *r), -v)).collect()
        };
        Self {
            size: self.size,
            entries: entries.map(dual).collect(),
        }
    }
}

/// A basis element of an algebra of matrices.
struct Element {
    basis: String,
    state: String,
    matrix: Entries,
}

impl Element {
    fn new(basis: impl Into<String>, state: impl Into<String>, matrix: Entries) -> Self {
        Self {
            basis: basis.into(),
            state: state.into(),
            matrix,
        }
    }
}
