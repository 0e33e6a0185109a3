//! Small matrices by rows.

pub type Matrix = Vec<Vec<f64>>;

pub fn identity(size: usize) -> Matrix {
    let entry = |i: usize, j: usize| f64::from(u8::from(i == j));
    (0..size)
        .map(|i| (0..size).map(|j| entry(i, j)).collect())
        .collect()
}

pub fn times(a: &Matrix, b: &Matrix) -> Matrix {
    let size = b[0].len();
    let entry = |row: &[f64], j: usize| row.iter().zip(b).map(|(a, b)| a * b[j]).sum();
    a.iter()
        .map(|row| (0..size).map(|j| entry(row, j)).collect())
        .collect()
}

/// `sum_ab A_ab B_ab`
pub fn paired(a: &Matrix, b: &Matrix) -> f64 {
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    pairs.map(|(a, b)| a * b).sum()
}

/// `scale sum_a x_a rho_a`
pub fn combination(basis: &[Matrix], x: &[f64], scale: f64) -> Matrix {
    let size = basis[0].len();
    let entry =
        |i: usize, j: usize| scale * basis.iter().zip(x).map(|(m, x)| m[i][j] * x).sum::<f64>();
    (0..size)
        .map(|i| (0..size).map(|j| entry(i, j)).collect())
        .collect()
}

pub fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, value| {
        if value.is_nan() {
            f64::NAN
        } else {
            most.max(value.abs())
        }
    })
}

/// By elimination with row exchanges.
pub fn inverse(matrix: &Matrix) -> Matrix {
    let size = matrix.len();
    let rows = matrix.iter().zip(identity(size));
    let mut rows: Matrix = rows
        .map(|(row, unit)| [row.as_slice(), &unit].concat())
        .collect();
    for k in 0..size {
        let by_size = |a: &usize, b: &usize| rows[*a][k].abs().total_cmp(&rows[*b][k].abs());
        let pivot = (k..size).max_by(by_size).expect("a row");
        rows.swap(k, pivot);
        let pivot = rows[k].clone();
        for (i, row) in rows.iter_mut().enumerate() {
            let factor = if i == k {
                1.0 - 1.0 / pivot[k]
            } else {
                row[k] / pivot[k]
            };
            row.iter_mut()
                .zip(&pivot)
                .for_each(|(entry, p)| *entry -= factor * p);
        }
    }
    rows.into_iter().map(|row| row[size..].to_vec()).collect()
}
