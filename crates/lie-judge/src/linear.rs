//! Small dense matrices over the numbers of an interpretation.

use crate::number::Number;

pub(super) type Rows<T> = Vec<Vec<T>>;

/// Solves `A X = B` by elimination with row exchanges, decided by values alone.
pub(super) fn solve<T: Number>(mut a: Rows<T>, mut b: Rows<T>) -> Rows<T> {
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

pub(super) fn product<T: Number>(a: &Rows<T>, b: &Rows<T>) -> Rows<T> {
    let size = a.len();
    let entry = |r: usize, c: usize| T::sum((0..size).map(|k| a[r][k].mul(&b[k][c])));
    (0..size)
        .map(|r| (0..size).map(|c| entry(r, c)).collect())
        .collect()
}

pub(super) fn difference<T: Number>(a: &Rows<T>, b: &Rows<T>) -> Rows<T> {
    let rows = a.iter().zip(b);
    rows.map(|(a, b)| a.iter().zip(b).map(|(a, b)| a.sub(b)).collect())
        .collect()
}

/// The coefficients by which matrices sum to another, by the normal equations.
pub(super) fn coordinates<T: Number>(matrices: &[Rows<T>], target: &Rows<T>) -> Vec<T> {
    let pair = |a: &Rows<T>, b: &Rows<T>| {
        let entries = a.iter().flatten().zip(b.iter().flatten());
        T::sum(entries.map(|(a, b)| a.mul(b)))
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
