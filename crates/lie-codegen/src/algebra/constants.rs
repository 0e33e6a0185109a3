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

impl<T: Clone> StructureConstants<T> {
    /// The finest direct sum of ideals that are spanned by basis elements: the elements of each, ascending, and its constants.
    ///
    /// A `unit`, which is central and the last basis element, belongs to each of them as its last one.
    pub fn blocks(&self, unit: Option<usize>) -> Vec<(Vec<usize>, Self)> {
        let is_unit = |i: usize| Some(i) == unit;
        // of each element one of its block that comes before it, or itself
        let mut before: Vec<usize> = (0..self.dimension).collect();
        fn first(before: &[usize], mut i: usize) -> usize {
            while before[i] != i {
                i = before[i];
            }
            i
        }
        for (i, j, k, _) in &self.entries {
            for other in [j, k].into_iter().filter(|other| !is_unit(**other)) {
                let (a, b) = (first(&before, *i), first(&before, *other));
                before[a.max(b)] = a.min(b);
            }
        }
        let mut blocks: Vec<(Vec<usize>, Vec<_>)> = Vec::new();
        let mut block_of = vec![usize::MAX; self.dimension];
        let mut place_in = vec![0; self.dimension];
        for i in (0..self.dimension).filter(|i| !is_unit(*i)) {
            let head = first(&before, i);
            if head == i {
                block_of[i] = blocks.len();
                blocks.push((Vec::new(), Vec::new()));
            }
            block_of[i] = block_of[head];
            let elements = &mut blocks[block_of[i]].0;
            place_in[i] = elements.len();
            elements.push(i);
        }
        for (elements, _) in &mut blocks {
            elements.extend(unit);
        }
        for (i, j, k, value) in &self.entries {
            let (elements, entries) = &mut blocks[block_of[*i]];
            let last = elements.len() - 1;
            let to = if is_unit(*k) { last } else { place_in[*k] };
            entries.push((place_in[*i], place_in[*j], to, value.clone()));
        }
        let constants = |(elements, entries): (Vec<usize>, Vec<_>)| {
            let constants = Self::new(elements.len(), entries);
            (elements, constants)
        };
        blocks.into_iter().map(constants).collect()
    }
}

impl<T: Ring> StructureConstants<T> {
    /// The brackets as a table: `table[i][j]` lists the `(k, C_ij^k)`, both halves.
    pub(crate) fn table(&self) -> Vec<Vec<Vec<(usize, T)>>> {
        let n = self.dimension;
        let mut table = vec![vec![Vec::new(); n]; n];
        for (i, j, k, value) in &self.entries {
            table[*i][*j].push((*k, value.clone()));
            table[*j][*i].push((*k, value.negative()));
        }
        table
    }
}
