//! The kernel of a sparse matrix, by elimination row after row.

use super::field::Field;
use lie_symbolic::exact::Exhausted;

/// A row or a vector by its nonzero entries, columns ascending.
pub type Sparse<T> = Vec<(usize, T)>;

/// Vectors of a kernel, and the numbers of the rows that were not combinations of those before.
pub type Kernel<T> = (Vec<Sparse<T>>, Vec<usize>);

/// The kernel in reduced echelon form from the last column: each vector has a one in its own last column, in which the
/// others are zero. Beside it the numbers of the rows that were not combinations of those before.
pub fn kernel<F: Field>(
    field: &F,
    columns: usize,
    rows: impl Iterator<Item = Sparse<F::Value>>,
) -> Result<Kernel<F::Value>, Exhausted> {
    let mut pivots: Vec<Option<Sparse<F::Value>>> = vec![None; columns];
    let mut work = Work::new(field, columns);
    let mut new = Vec::new();
    for (number, row) in rows.enumerate() {
        if new.len() == columns {
            break;
        }
        field.budget().spend(1 + columns as u64 / 64)?;
        for (column, value) in row {
            work.set(column, value);
        }
        let mut lead = None;
        let mut next = work.from(0);
        while let Some(column) = next {
            if !field.is_zero(&work.values[column]) {
                match &pivots[column] {
                    Some(pivot) => work.clear(field, column, pivot)?,
                    None => lead = lead.or(Some(column)),
                }
            }
            next = work.from(column + 1);
        }
        let mut entries = work.taken(field);
        if let Some(lead) = lead {
            let inverse = field.inverse(&entries[0].1)?;
            field.budget().spend(entries.len() as u64)?;
            for (_, value) in &mut entries {
                *value = field.product(value, &inverse)?;
            }
            pivots[lead] = Some(entries);
            new.push(number);
        }
    }
    Ok((vectors(field, &pivots)?, new))
}

/// A row that is reduced, with its places that are in use: rows are sparse, and looking at all places takes longer than the rest.
struct Work<T> {
    values: Vec<T>,
    used: Vec<u64>,
}

impl<T: Clone> Work<T> {
    fn new<F: Field<Value = T>>(field: &F, columns: usize) -> Self {
        Self {
            values: vec![field.zero(); columns],
            used: vec![0; columns.div_ceil(64)],
        }
    }

    fn set(&mut self, column: usize, value: T) {
        self.values[column] = value;
        self.used[column / 64] |= 1 << (column % 64);
    }

    /// The first place in use, from a column on.
    fn from(&self, column: usize) -> Option<usize> {
        let word = self.used.get(column / 64)? & (u64::MAX << (column % 64));
        if word != 0 {
            return Some(column / 64 * 64 + word.trailing_zeros() as usize);
        }
        let later = (column / 64 + 1..self.used.len()).find(|&i| self.used[i] != 0)?;
        Some(later * 64 + self.used[later].trailing_zeros() as usize)
    }

    /// Subtracts a pivot, whose first entry is a one in a column, so that this column becomes zero.
    fn clear<F: Field<Value = T>>(
        &mut self,
        field: &F,
        column: usize,
        pivot: &Sparse<T>,
    ) -> Result<(), Exhausted> {
        field.budget().spend(pivot.len() as u64)?;
        let factor = field.negative(&self.values[column]);
        for (c, value) in &pivot[1..] {
            self.set(
                *c,
                field.sum(&self.values[*c], &field.product(&factor, value)?)?,
            );
        }
        self.values[column] = field.zero();
        Ok(())
    }

    /// The entries that are not zero; nothing is in use afterwards.
    fn taken<F: Field<Value = T>>(&mut self, field: &F) -> Sparse<T> {
        let mut entries = Vec::new();
        let mut next = self.from(0);
        while let Some(column) = next {
            let value = std::mem::replace(&mut self.values[column], field.zero());
            if !field.is_zero(&value) {
                entries.push((column, value));
            }
            next = self.from(column + 1);
        }
        self.used.fill(0);
        entries
    }
}

/// A vector of the kernel for each column without a pivot, from below.
fn vectors<F: Field>(
    field: &F,
    pivots: &[Option<Sparse<F::Value>>],
) -> Result<Vec<Sparse<F::Value>>, Exhausted> {
    let free = (0..pivots.len()).filter(|&column| pivots[column].is_none());
    let mut kernel = Vec::new();
    for free in free {
        let mut vector: Vec<F::Value> = vec![field.zero(); free + 1];
        vector[free] = field.integer(1);
        for column in (0..free).rev() {
            let Some(pivot) = &pivots[column] else {
                continue;
            };
            field.budget().spend(1 + pivot.len() as u64)?;
            let mut sum = field.zero();
            let inside = pivot[1..].iter().take_while(|(c, _)| *c <= free);
            for (c, value) in inside.filter(|(c, _)| !field.is_zero(&vector[*c])) {
                sum = field.sum(&sum, &field.product(value, &vector[*c])?)?;
            }
            vector[column] = field.negative(&sum);
        }
        let entries = vector.into_iter().enumerate();
        kernel.push(entries.filter(|(_, v)| !field.is_zero(v)).collect());
    }
    Ok(kernel)
}

#[cfg(test)]
mod tests {
    use super::super::field::{PRIMES, Prime};
    use super::*;
    use lie_symbolic::exact::Budget;

    #[test]
    fn kernels() {
        let budget = Budget::new(10_000);
        let field = Prime {
            prime: PRIMES[0],
            budget: &budget,
        };
        let minus = |v: u64| field.negative(&v);
        // x + y - z = 0 twice, y + w = 0
        let rows = [
            vec![(0, 1), (1, 1), (2, minus(1))],
            vec![(0, 2), (1, 2), (2, minus(2))],
            vec![(1, 1), (3, 1)],
        ];
        let (found, new) = kernel(&field, 4, rows.into_iter()).unwrap();
        assert_eq!(new, [0, 2]);
        assert_eq!(
            found,
            [vec![(0, 1), (2, 1)], vec![(0, 1), (1, minus(1)), (3, 1)]]
        );
        let none = Budget::new(1);
        let field = Prime {
            prime: PRIMES[0],
            budget: &none,
        };
        let row = vec![vec![(0, 1), (3, 1)]];
        assert_eq!(kernel(&field, 40, row.into_iter()), Err(Exhausted));
    }
}
