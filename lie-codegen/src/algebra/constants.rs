//! Structure constants.

use super::ring::Ring;

/// Structure constants `[e_i, e_j] = sum_k C_ij^k e_k`, sparse: entries `(i, j, k, C_ij^k)` with
/// `i < j`, ascending, none zero. The other half follows from antisymmetry.
#[derive(Clone, Debug, PartialEq)]
pub struct StructureConstants<T> {
    dimension: usize,
    entries: Vec<(usize, usize, usize, T)>,
}

impl<T> StructureConstants<T> {
    /// Constants from entries with `i < j`, each `(i, j, k)` at most once, none zero.
    pub fn new(dimension: usize, mut entries: Vec<(usize, usize, usize, T)>) -> Self {
        entries.sort_by_key(|&(i, j, k, _)| (i, j, k));
        debug_assert!(
            entries
                .iter()
                .all(|e| e.0 < e.1 && e.1 < dimension && e.2 < dimension)
        );
        Self { dimension, entries }
    }

    /// Dimension of the algebra.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// The entries `(i, j, k, C_ij^k)`, `i < j`, in ascending order.
    pub fn entries(&self) -> &[(usize, usize, usize, T)] {
        &self.entries
    }

    /// The entries of `[e_i, e_j]` for `i < j`; nothing for `i >= j`.
    pub fn upper(&self, i: usize, j: usize) -> &[(usize, usize, usize, T)] {
        let start = self.entries.partition_point(|e| (e.0, e.1) < (i, j));
        let end = self.entries.partition_point(|e| (e.0, e.1) <= (i, j));
        &self.entries[start..end]
    }

    /// The same constants in another number type.
    pub fn map<U>(&self, mut convert: impl FnMut(&T) -> U) -> StructureConstants<U> {
        let entries = self
            .entries
            .iter()
            .map(|(i, j, k, v)| (*i, *j, *k, convert(v)))
            .collect();
        StructureConstants {
            dimension: self.dimension,
            entries,
        }
    }

    /// The same constants in a smaller number type, where all of them fit it.
    pub fn try_map<U>(
        &self,
        mut convert: impl FnMut(&T) -> Option<U>,
    ) -> Option<StructureConstants<U>> {
        let entries: Option<Vec<_>> = self
            .entries
            .iter()
            .map(|(i, j, k, v)| Some((*i, *j, *k, convert(v)?)))
            .collect();
        Some(StructureConstants {
            dimension: self.dimension,
            entries: entries?,
        })
    }
}

impl<T: Ring> StructureConstants<T> {
    /// The brackets as a table: `table[i][j]` lists the `(k, C_ij^k)`, both halves.
    pub(super) fn table(&self) -> Vec<Vec<Vec<(usize, T)>>> {
        let n = self.dimension;
        let mut table = vec![vec![Vec::new(); n]; n];
        for (i, j, k, value) in &self.entries {
            table[*i][*j].push((*k, value.clone()));
            table[*j][*i].push((*k, value.negative()));
        }
        table
    }
}
