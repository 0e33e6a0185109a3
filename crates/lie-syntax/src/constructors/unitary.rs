//! su(n) and u(n): anti-Hermitian matrices, of trace zero for su(n), as real matrices `[[Re, -Im], [Im, Re]]`.
//!
//! The basis is `A_jk = e_jk - e_kj` and `S_jk = i (e_jk + e_kj)` for `j < k`, pair by pair, then the diagonal:
//! `D_k,k+1 = i (e_kk - e_k+1,k+1)` of su(n), `D_k = i e_kk` of u(n). No entry is irrational.

use super::family::{Argument, Constructor, Family, Wrong, size};
use super::matrix::{Entries, integer_matrix, real, unit};
use super::names::{indexed, numbered};
use super::orthogonal::pairs;
use super::{Element, NamedAlgebra};

pub const SPECIAL: Family = Family {
    names: &["su"],
    form: "su(n)",
    arguments: (1, 1),
    read: |arguments| Ok(Box::new(Unitary::read(arguments, 2, true)?)),
};

pub const ALL: Family = Family {
    names: &["u"],
    form: "u(n)",
    arguments: (1, 1),
    read: |arguments| Ok(Box::new(Unitary::read(arguments, 1, false)?)),
};

struct Unitary {
    n: usize,
    traceless: bool,
}

impl Unitary {
    fn read(arguments: &[Argument], least: i64, traceless: bool) -> Result<Self, Wrong> {
        let what = if traceless { "`su(n)`" } else { "`u(n)`" };
        let n = size(arguments, 0, least, what)?;
        Ok(Self { n, traceless })
    }

    /// The names and imaginary parts of the diagonal matrices.
    fn diagonal(&self) -> Vec<(String, Entries)> {
        let n = self.n;
        if !self.traceless {
            return (0..n).map(|k| (numbered("D", k, n), unit(k, k))).collect();
        }
        let difference = |k| {
            let matrix = integer_matrix(&[(k, k, 1), (k + 1, k + 1, -1)]);
            (indexed("D", &[k, k + 1], n), matrix)
        };
        (0..n - 1).map(difference).collect()
    }
}

impl Constructor for Unitary {
    fn dimension(&self) -> usize {
        self.n.saturating_mul(self.n) - usize::from(self.traceless)
    }

    fn build(&self) -> NamedAlgebra {
        let n = self.n;
        let none = Entries::new();
        let mut matrices = Vec::new();
        for (j, k) in pairs(n) {
            let skew = integer_matrix(&[(j, k, 1), (k, j, -1)]);
            let symmetric = integer_matrix(&[(j, k, 1), (k, j, 1)]);
            matrices.push((indexed("A", &[j, k], n), real(&skew, &none, n)));
            matrices.push((indexed("S", &[j, k], n), real(&none, &symmetric, n)));
        }
        let diagonal = self.diagonal().into_iter();
        matrices.extend(diagonal.map(|(name, im)| (name, real(&none, &im, n))));
        let count = matrices.len();
        let element = |(k, (name, matrix))| Element::new(name, numbered("x", k, count), matrix);
        let elements = matrices.into_iter().enumerate().map(element);
        NamedAlgebra::from_matrices(elements.collect(), 2 * n)
    }
}
