//! Algebras: direct and semidirect sums of known ones in a random rational basis.

use lie_symbolic::exact::Rational;
use proptest::prelude::*;

/// A square matrix.
pub type Matrix = Vec<Vec<Rational>>;

/// A Lie algebra by its structure constants `[e_i, e_j] = C[i][j][k] e_k`.
#[derive(Clone, Debug)]
pub struct Algebra {
    pub constants: Vec<Vec<Vec<Rational>>>,
    /// Casimirs in the coordinates `u0, u1, …` of the known basis.
    pub casimirs: Vec<String>,
    /// A faithful representation.
    pub matrices: Option<Vec<Matrix>>,
    /// `u_i = back[i][a] x_a`
    back: Matrix,
}

/// A known algebra: `(i, j, k, C_ij^k)` for `i < j`, nonzero entries `(element, row, column, value)`
/// of its matrices, and Casimirs.
struct Known {
    dimension: usize,
    brackets: &'static [(usize, usize, usize, i64)],
    size: usize,
    matrices: &'static [(usize, usize, usize, i64)],
    casimirs: &'static [&'static str],
}

const KNOWN: &[Known] = &[
    // so(3)
    Known {
        dimension: 3,
        brackets: &[(0, 1, 2, 1), (1, 2, 0, 1), (0, 2, 1, -1)],
        size: 3,
        matrices: &[
            (0, 1, 2, -1),
            (0, 2, 1, 1),
            (1, 0, 2, 1),
            (1, 2, 0, -1),
            (2, 0, 1, -1),
            (2, 1, 0, 1),
        ],
        casimirs: &["u0^2 + u1^2 + u2^2"],
    },
    // sl(2): H, E, F
    Known {
        dimension: 3,
        brackets: &[(0, 1, 1, 2), (0, 2, 2, -2), (1, 2, 0, 1)],
        size: 2,
        matrices: &[(0, 0, 0, 1), (0, 1, 1, -1), (1, 0, 1, 1), (2, 1, 0, 1)],
        casimirs: &["u0^2 + 4*u1*u2"],
    },
    // Heisenberg
    Known {
        dimension: 3,
        brackets: &[(0, 1, 2, 1)],
        size: 3,
        matrices: &[(0, 0, 1, 1), (1, 1, 2, 1), (2, 0, 2, 1)],
        casimirs: &["u2"],
    },
    // the affine group of the line
    Known {
        dimension: 2,
        brackets: &[(0, 1, 1, 1)],
        size: 2,
        matrices: &[(0, 0, 0, 1), (1, 0, 1, 1)],
        casimirs: &[],
    },
    // e(2)
    Known {
        dimension: 3,
        brackets: &[(0, 1, 2, 1), (0, 2, 1, -1)],
        size: 3,
        matrices: &[(0, 0, 1, -1), (0, 1, 0, 1), (1, 0, 2, 1), (2, 1, 2, 1)],
        casimirs: &["u1^2 + u2^2"],
    },
    // R
    Known {
        dimension: 1,
        brackets: &[],
        size: 1,
        matrices: &[(0, 0, 0, 1)],
        casimirs: &["u0"],
    },
];

fn zeros(size: usize) -> Matrix {
    vec![vec![Rational::ZERO; size]; size]
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let n = a.len();
    let mut c = zeros(n);
    for (i, k, j) in triples(n) {
        c[i][j] = &c[i][j] + &(&a[i][k] * &b[k][j]);
    }
    c
}

fn triples(n: usize) -> impl Iterator<Item = (usize, usize, usize)> {
    (0..n).flat_map(move |i| (0..n).flat_map(move |j| (0..n).map(move |k| (i, j, k))))
}

/// The inverse by elimination without pivoting: of products of unit triangular matrices.
fn inverse(matrix: &Matrix) -> Matrix {
    let n = matrix.len();
    let (mut left, mut right) = (matrix.clone(), zeros(n));
    for (i, row) in right.iter_mut().enumerate() {
        row[i] = Rational::ONE;
    }
    for p in 0..n {
        let pivot = left[p][p].recip().expect("a pivot");
        for j in 0..n {
            left[p][j] = &left[p][j] * &pivot;
            right[p][j] = &right[p][j] * &pivot;
        }
        for i in (0..n).filter(|i| *i != p) {
            let factor = left[i][p].clone();
            for j in 0..n {
                left[i][j] = &left[i][j] - &(&factor * &left[p][j]);
                right[i][j] = &right[i][j] - &(&factor * &right[p][j]);
            }
        }
    }
    right
}

impl Known {
    fn constants(&self) -> Vec<Vec<Vec<Rational>>> {
        let n = self.dimension;
        let mut constants = vec![zeros(n); n];
        for &(i, j, k, value) in self.brackets {
            constants[i][j][k] = value.into();
            constants[j][i][k] = (-value).into();
        }
        constants
    }

    fn matrix(&self, element: usize) -> Matrix {
        let mut matrix = zeros(self.size);
        for &(_, row, column, value) in self.matrices.iter().filter(|entry| entry.0 == element) {
            matrix[row][column] = value.into();
        }
        matrix
    }
}

impl Algebra {
    pub fn dimension(&self) -> usize {
        self.constants.len()
    }

    fn trivial() -> Self {
        Self {
            constants: Vec::new(),
            casimirs: Vec::new(),
            matrices: Some(Vec::new()),
            back: Vec::new(),
        }
    }

    /// Enlarges everything for `more` new elements that commute with all others.
    fn enlarge(&mut self, more: usize) {
        let n = self.dimension() + more;
        for rows in &mut self.constants {
            rows.iter_mut()
                .for_each(|row| row.resize(n, Rational::ZERO));
            rows.resize(n, vec![Rational::ZERO; n]);
        }
        self.constants.resize(n, zeros(n));
        self.back = zeros(n);
        for (i, row) in self.back.iter_mut().enumerate() {
            row[i] = Rational::ONE;
        }
    }

    /// The direct sum with a known algebra, the matrices in blocks.
    fn plus(mut self, known: &Known) -> Self {
        let start = self.dimension();
        self.enlarge(known.dimension);
        let constants = known.constants();
        for (i, j, k) in triples(known.dimension) {
            self.constants[start + i][start + j][start + k] = constants[i][j][k].clone();
        }
        let shifted = |casimir: &&str| {
            let mut text = (*casimir).to_owned();
            for i in (0..known.dimension).rev() {
                text = text.replace(&format!("u{i}"), &format!("U{}", start + i));
            }
            text.replace('U', "u")
        };
        self.casimirs.extend(known.casimirs.iter().map(shifted));
        if let Some(matrices) = &mut self.matrices {
            let size = matrices.first().map_or(0, Vec::len);
            for matrix in matrices.iter_mut() {
                matrix
                    .iter_mut()
                    .for_each(|row| row.resize(size + known.size, Rational::ZERO));
                matrix.resize(size + known.size, vec![Rational::ZERO; size + known.size]);
            }
            for element in 0..known.dimension {
                let (block, mut matrix) = (known.matrix(element), zeros(size + known.size));
                for (i, row) in block.into_iter().enumerate() {
                    for (j, value) in row.into_iter().enumerate() {
                        matrix[size + i][size + j] = value;
                    }
                }
                matrices.push(matrix);
            }
        }
        self
    }

    /// The semidirect sum of a known algebra with the space that its matrices act on:
    /// `[e_i, v_a] = (rho_i)_ba v_b`.
    fn semidirect(known: &Known) -> Self {
        let mut algebra = Self::trivial().plus(known);
        let start = algebra.dimension();
        algebra.enlarge(known.size);
        algebra.casimirs.clear();
        algebra.matrices = None;
        for element in 0..known.dimension {
            for (b, row) in known.matrix(element).into_iter().enumerate() {
                for (a, value) in row.into_iter().enumerate() {
                    algebra.constants[start + a][element][start + b] = -&value;
                    algebra.constants[element][start + a][start + b] = value;
                }
            }
        }
        algebra
    }

    /// The same algebra in the basis `f_a = change[a][i] e_i`.
    fn in_basis(mut self, change: &Matrix) -> Self {
        let n = self.dimension();
        let back = inverse(change);
        let mut constants = vec![zeros(n); n];
        for (a, b) in (0..n).flat_map(|a| (0..n).map(move |b| (a, b))) {
            // [f_a, f_b] in the old basis, then in the new one.
            let mut old = vec![Rational::ZERO; n];
            for (i, j, k) in triples(n) {
                let factor = &change[a][i] * &change[b][j];
                if !factor.is_zero() {
                    old[k] = &old[k] + &(&factor * &self.constants[i][j][k]);
                }
            }
            for c in 0..n {
                constants[a][b][c] =
                    (0..n).fold(Rational::ZERO, |sum, k| &sum + &(&old[k] * &back[k][c]));
            }
        }
        if let Some(matrices) = &mut self.matrices {
            let size = matrices[0].len();
            *matrices = change
                .iter()
                .map(|row| {
                    let mut matrix = zeros(size);
                    for (factor, old) in row.iter().zip(matrices.iter()) {
                        for (i, j) in (0..size).flat_map(|i| (0..size).map(move |j| (i, j))) {
                            matrix[i][j] = &matrix[i][j] + &(factor * &old[i][j]);
                        }
                    }
                    matrix
                })
                .collect();
        }
        Self {
            constants,
            back,
            ..self
        }
    }

    /// Abbreviations for the coordinates of the known basis, which the Casimirs are written in.
    pub fn old_coordinates(&self) -> Vec<String> {
        let line = |(i, row): (usize, &Vec<Rational>)| {
            let terms = row.iter().enumerate().filter(|(_, value)| !value.is_zero());
            let terms: Vec<String> = terms.map(|(a, value)| format!("({value})*x{a}")).collect();
            format!("u{i} = {}", terms.join(" + "))
        };
        self.back.iter().enumerate().map(line).collect()
    }
}

/// Unit triangular matrices with few entries, lower times upper: always invertible.
fn change(n: usize) -> impl Strategy<Value = Matrix> {
    let entry = prop_oneof![3 => Just(Rational::ZERO), 1 => super::rational()];
    prop::collection::vec(entry, n * n).prop_map(move |entries| {
        let (mut lower, mut upper) = (zeros(n), zeros(n));
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let side = if i > j { &mut lower } else { &mut upper };
            side[i][j] = if i == j {
                Rational::ONE
            } else {
                entries[i * n + j].clone()
            };
            if i == j {
                lower[i][j] = Rational::ONE;
            }
        }
        product(&lower, &upper)
    })
}

/// Algebras of dimension 2 to 8.
pub fn algebra() -> impl Strategy<Value = Algebra> {
    let direct = prop::collection::vec(0..KNOWN.len(), 1..4).prop_map(|parts| {
        let mut algebra = Algebra::trivial();
        for known in parts.into_iter().map(|part| &KNOWN[part]) {
            if algebra.dimension() + known.dimension <= 8 {
                algebra = algebra.plus(known);
            }
        }
        if algebra.dimension() < 2 {
            algebra.plus(&KNOWN[3])
        } else {
            algebra
        }
    });
    let semidirect = (0..KNOWN.len()).prop_map(|part| Algebra::semidirect(&KNOWN[part]));
    let own_basis = prop_oneof![3 => direct, 1 => semidirect];
    own_basis.prop_flat_map(|algebra| {
        let n = algebra.dimension();
        prop_oneof![
            1 => Just(algebra.clone()),
            2 => change(n).prop_map(move |change| algebra.clone().in_basis(&change)),
        ]
    })
}
