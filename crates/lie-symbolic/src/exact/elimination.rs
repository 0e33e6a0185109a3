//! Elimination row by row over a field whose numbers may be known in part: which rows are new.

use super::Residue;

/// A number of a field.
pub trait Field: Clone {
    /// Whether it is certainly not zero.
    fn is_nonzero(&self) -> bool;
    /// Whether it is exactly zero, so that it changes nothing.
    fn is_zero(&self) -> bool;
    /// What a good pivot has much of.
    fn size(&self) -> i64;
    /// The inverse; `None` where it may be zero.
    fn inverse(&self) -> Option<Self>;
    /// The product.
    fn times(&self, other: &Self) -> Self;
    /// The difference.
    fn minus(&self, other: &Self) -> Self;
    /// Zero.
    fn zero() -> Self;
}

/// What a row adds to those before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Row {
    /// It is linearly independent of them.
    New,
    /// It is a combination of them, as far as the numbers tell.
    Dependent,
    /// It is zero, as far as the numbers tell.
    Zero,
}

/// What each row adds to those before it. A pivot is a number that is certainly not zero, so that no row counts as new that is not.
pub fn rows<T: Field>(rows: impl IntoIterator<Item = Vec<T>>) -> Vec<Row> {
    let mut pivots: Vec<(usize, T, Vec<T>)> = Vec::new();
    let mut found = Vec::new();
    for mut row in rows {
        if !row.iter().any(T::is_nonzero) {
            found.push(Row::Zero);
            continue;
        }
        for (column, inverse, pivot) in &pivots {
            if row[*column].is_zero() {
                continue;
            }
            let factor = row[*column].times(inverse);
            for (entry, p) in row.iter_mut().zip(pivot).filter(|(_, p)| !p.is_zero()) {
                *entry = entry.minus(&factor.times(p));
            }
            row[*column] = T::zero();
        }
        let nonzero = (0..row.len()).filter(|&c| row[c].is_nonzero());
        let best = nonzero.max_by_key(|&c| row[c].size());
        match best.and_then(|column| Some((column, row[column].inverse()?))) {
            Some((column, inverse)) => {
                pivots.push((column, inverse, row));
                found.push(Row::New);
            }
            None => found.push(Row::Dependent),
        }
    }
    found
}

/// What the rows of one of several matrices add, of the first with the most new rows; none is looked at behind one with
/// as many as there can be. The entries stand row by row.
pub fn most_new<T: Field>(
    matrices: impl Iterator<Item = Vec<T>>,
    columns: usize,
    bound: usize,
) -> Option<Vec<Row>> {
    let mut best: Option<Vec<Row>> = None;
    for entries in matrices {
        let found = rows(entries.chunks(columns).map(<[T]>::to_vec));
        let count = new_rows(&found);
        if best.as_ref().is_none_or(|best| new_rows(best) < count) {
            best = Some(found);
        }
        if count >= bound {
            break;
        }
    }
    best
}

/// How many rows are new.
pub fn new_rows(rows: &[Row]) -> usize {
    rows.iter().filter(|row| **row == Row::New).count()
}

/// The number of rows that are new.
pub fn rank<T: Field>(all: impl IntoIterator<Item = Vec<T>>) -> usize {
    new_rows(&rows(all))
}

impl Field for Residue {
    fn is_nonzero(&self) -> bool {
        !Residue::is_zero(*self)
    }
    fn is_zero(&self) -> bool {
        Residue::is_zero(*self)
    }
    fn size(&self) -> i64 {
        0
    }
    fn inverse(&self) -> Option<Self> {
        Residue::inverse(*self)
    }
    fn times(&self, other: &Self) -> Self {
        Residue::times(*self, *other)
    }
    fn minus(&self, other: &Self) -> Self {
        Residue::minus(*self, *other)
    }
    fn zero() -> Self {
        Residue::ZERO
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_new_dependent_or_zero() {
        let row = |values: [u64; 3]| values.map(Residue::from_bits).to_vec();
        let all = [
            row([0, 0, 0]),
            row([0, 2, 4]),
            row([0, 1, 2]),
            row([1, 1, 1]),
            row([1, 2, 3]),
            row([5, 0, 0]),
            row([7, 8, 9]),
        ];
        let found = [
            Row::Zero,
            Row::New,
            Row::Dependent,
            Row::New,
            Row::Dependent,
            Row::New,
            Row::Dependent,
        ];
        assert_eq!(rows(all.clone()), found);
        assert_eq!(rank(all), 3);
    }
}
