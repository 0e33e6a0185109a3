//! Matrices of rationals by their entries that are not zero.

use std::collections::BTreeMap;

use lie_symbolic::exact::Rational;

/// A matrix: its entries that are not zero, by row and column from 0 on.
pub type Entries = BTreeMap<(usize, usize), Rational>;

/// A matrix of whole entries.
pub fn integer_matrix(entries: &[(usize, usize, i64)]) -> Entries {
    let mut matrix = Entries::new();
    for &(row, column, value) in entries {
        add(&mut matrix, (row, column), &Rational::from(value));
    }
    matrix
}

/// The matrix with a one in row i and column j, `E_ij`.
pub fn unit(i: usize, j: usize) -> Entries {
    integer_matrix(&[(i, j, 1)])
}

/// Adds to an entry.
pub fn add<K: Ord>(entries: &mut BTreeMap<K, Rational>, key: K, value: &Rational) {
    let sum = match entries.get(&key) {
        Some(entry) => entry + value,
        None => value.clone(),
    };
    if sum.is_zero() {
        entries.remove(&key);
    } else {
        entries.insert(key, sum);
    }
}

/// Adds a multiple.
pub fn add_multiple<K: Ord + Clone>(
    entries: &mut BTreeMap<K, Rational>,
    others: &BTreeMap<K, Rational>,
    factor: &Rational,
) {
    for (key, value) in others {
        add(entries, key.clone(), &(value * factor));
    }
}

/// The matrix with its first row and column at another place.
pub fn moved(matrix: &Entries, row: usize, column: usize) -> Entries {
    let entries = matrix.iter();
    entries
        .map(|((r, c), v)| ((r + row, c + column), v.clone()))
        .collect()
}

/// `a b - b a`.
pub fn commutator(a: &Entries, b: &Entries) -> Entries {
    let mut sum = Entries::new();
    for (left, right, sign) in [(a, b, Rational::ONE), (b, a, Rational::MINUS_ONE)] {
        for ((row, middle), factor) in left {
            let factor = factor * &sign;
            for ((_, column), value) in right.range((*middle, 0)..(*middle + 1, 0)) {
                add(&mut sum, (*row, *column), &(&factor * value));
            }
        }
    }
    sum
}

/// The real matrix `[[re, -im], [im, re]]` of a complex one of size n.
pub fn real(re: &Entries, im: &Entries, n: usize) -> Entries {
    let mut matrix = re.clone();
    matrix.extend(moved(re, n, n));
    matrix.extend(moved(im, n, 0));
    for ((r, c), value) in im {
        matrix.insert((*r, c + n), -value);
    }
    matrix
}
