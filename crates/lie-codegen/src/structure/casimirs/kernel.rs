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
    let mut work: Vec<F::Value> = vec![field.zero(); columns];
    let mut new = Vec::new();
    for (number, row) in rows.enumerate() {
        if new.len() == columns {
            break;
        }
        field.budget().spend(1 + columns as u64 / 8)?;
        for (column, value) in row {
            work[column] = value;
        }
        let mut lead = None;
        for column in 0..columns {
            if field.is_zero(&work[column]) {
                continue;
            }
            match &pivots[column] {
                Some(pivot) => clear(field, &mut work, column, pivot)?,
                None => lead = lead.or(Some(column)),
            }
        }
        let entries = work
            .iter_mut()
            .enumerate()
            .filter(|(_, v)| !field.is_zero(v));
        let entries = entries.map(|(c, v)| (c, std::mem::replace(v, field.zero())));
        let mut entries: Sparse<F::Value> = entries.collect();
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

/// `work -= work[column] * pivot`, whose first entry is a one in this column.
fn clear<F: Field>(
    field: &F,
    work: &mut [F::Value],
    column: usize,
    pivot: &Sparse<F::Value>,
) -> Result<(), Exhausted> {
    field.budget().spend(pivot.len() as u64)?;
    let factor = field.negative(&work[column]);
    for (c, value) in &pivot[1..] {
        work[*c] = field.sum(&work[*c], &field.product(&factor, value)?)?;
    }
    work[column] = field.zero();
    Ok(())
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
