//! Small dense matrices over the numbers of an interpretation.

use crate::number::Number;

/// A matrix by its rows.
pub(super) type Rows = Vec<Vec<Number>>;

/// Solves `A X = B` by elimination with row exchanges, decided by values alone.
pub(super) fn solve(mut a: Rows, mut b: Rows) -> Rows {
    let size = a.len();
    for k in 0..size {
        let larger = |&i: &usize, &j: &usize| {
            let (i, j): (f64, f64) = (a[i][k].value().abs(), a[j][k].value().abs());
            i.total_cmp(&j)
        };
        let pivot = (k..size).max_by(larger).unwrap_or(k);
        a.swap(k, pivot);
        b.swap(k, pivot);
        let (row_a, row_b) = (a[k].clone(), b[k].clone());
        for row in (0..size).filter(|&row| row != k) {
            let factor = a[row][k].div(&row_a[k]);
            for column in k..size {
                a[row][column] = a[row][column].sub(&factor.mul(&row_a[column]));
            }
            for (entry, above) in b[row].iter_mut().zip(&row_b) {
                *entry = entry.sub(&factor.mul(above));
            }
        }
    }
    for (row, right) in b.iter_mut().enumerate() {
        for entry in right {
            *entry = entry.div(&a[row][row]);
        }
    }
    b
}

/// Adds to each number the one in its place.
pub(super) fn add_to(slots: &mut [Number], values: &[Number]) {
    for (slot, value) in slots.iter_mut().zip(values) {
        *slot = slot.add(value);
    }
}

/// `sum_k a_k b_k`
pub(super) fn dot(a: &[Number], b: &[Number]) -> Number {
    Number::sum(a.iter().zip(b).map(|(a, b)| a.mul(b)))
}

/// The product of a matrix and a vector.
pub(super) fn times(rows: &[Vec<Number>], vector: &[Number]) -> Vec<Number> {
    rows.iter().map(|row| dot(row, vector)).collect()
}

pub(super) fn product(a: &Rows, b: &Rows) -> Rows {
    let size = a.len();
    let entry = |r: usize, c: usize| Number::sum((0..size).map(|k| a[r][k].mul(&b[k][c])));
    (0..size)
        .map(|r| (0..size).map(|c| entry(r, c)).collect())
        .collect()
}

pub(super) fn difference(a: &Rows, b: &Rows) -> Rows {
    let rows = a.iter().zip(b);
    rows.map(|(a, b)| a.iter().zip(b).map(|(a, b)| a.sub(b)).collect())
        .collect()
}

/// The coefficients by which matrices sum to another, by the normal equations.
pub(super) fn coordinates(matrices: &[Rows], target: &Rows) -> Vec<Number> {
    let pair = |a: &Rows, b: &Rows| {
        let entries = a.iter().flatten().zip(b.iter().flatten());
        Number::sum(entries.map(|(a, b)| a.mul(b)))
    };
    let gram = matrices
        .iter()
        .map(|a| matrices.iter().map(|b| pair(a, b)).collect())
        .collect();
    let right = matrices.iter().map(|a| vec![pair(a, target)]).collect();
    solve(gram, right).into_iter().flatten().collect()
}

/// The determinant, by elimination with row exchanges.
pub(super) fn determinant(mut rows: Vec<Vec<f64>>) -> f64 {
    let mut determinant = 1.0;
    for k in 0..rows.len() {
        let largest =
            (k..rows.len()).max_by(|&a, &b| rows[a][k].abs().total_cmp(&rows[b][k].abs()));
        let pivot = largest.unwrap_or(k);
        if rows[pivot][k] == 0.0 {
            return 0.0;
        }
        if pivot != k {
            rows.swap(pivot, k);
            determinant = -determinant;
        }
        determinant *= rows[k][k];
        let (above, below) = rows.split_at_mut(k + 1);
        let across = &above[k];
        for row in below {
            let multiplier = row[k] / across[k];
            for (entry, a) in row.iter_mut().zip(across).skip(k) {
                *entry -= multiplier * a;
            }
        }
    }
    determinant
}
