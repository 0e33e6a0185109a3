//! Well-known algebras for tests.

use lie_symbolic::exact::{Fraction, Rational};

use super::StructureConstants;

pub(crate) type Entry = (usize, usize, usize, i64);
pub(crate) type Integers = Vec<Vec<i64>>;

pub(crate) const SO3: (usize, &[Entry]) = (3, &[(0, 1, 2, 1), (0, 2, 1, -1), (1, 2, 0, 1)]);
pub(crate) const SE3: (usize, &[Entry]) = (
    6,
    &[
        (0, 1, 2, 1),
        (0, 2, 1, -1),
        (0, 4, 5, 1),
        (0, 5, 4, -1),
        (1, 2, 0, 1),
        (1, 3, 5, -1),
        (1, 5, 3, 1),
        (2, 3, 4, 1),
        (2, 4, 3, -1),
    ],
);
pub(crate) const SL2: (usize, &[Entry]) = (3, &[(0, 1, 1, 2), (0, 2, 2, -2), (1, 2, 0, 1)]);
pub(crate) const H3: (usize, &[Entry]) = (3, &[(0, 1, 2, 1)]);
pub(crate) const AFF1: (usize, &[Entry]) = (2, &[(0, 1, 1, 1)]);
pub(crate) const E2: (usize, &[Entry]) = (3, &[(0, 1, 2, 1), (0, 2, 1, -1)]);

pub(crate) fn constants((n, entries): (usize, &[Entry])) -> StructureConstants<Fraction> {
    let entries = entries
        .iter()
        .map(|&(i, j, k, v)| (i, j, k, Fraction::from(Rational::from(v))));
    StructureConstants::new(n, entries.collect())
}

fn zero(m: usize) -> Integers {
    vec![vec![0; m]; m]
}

fn product(a: &Integers, b: &Integers) -> Integers {
    let m = a.len();
    let mut c = zero(m);
    for i in 0..m {
        for j in 0..m {
            c[i][j] = (0..m).map(|k| a[i][k] * b[k][j]).sum();
        }
    }
    c
}

/// `E_ij`.
pub(crate) fn unit(m: usize, i: usize, j: usize) -> Integers {
    let mut e = zero(m);
    e[i][j] = 1;
    e
}

/// so(m): `E_ji - E_ij` for `i < j`.
pub(crate) fn so(m: usize) -> Vec<Integers> {
    let mut basis = Vec::new();
    for i in 0..m {
        for j in i + 1..m {
            let mut e = unit(m, j, i);
            e[i][j] = -1;
            basis.push(e);
        }
    }
    basis
}

/// gl(m): all `E_ij`.
pub(crate) fn gl(m: usize) -> Vec<Integers> {
    (0..m * m).map(|p| unit(m, p / m, p % m)).collect()
}

/// se(3) in 4 x 4 matrices.
pub(crate) fn se3() -> Vec<Integers> {
    let rotation = |i: usize, j: usize| {
        let mut e = unit(4, j, i);
        e[i][j] = -1;
        e
    };
    vec![
        rotation(1, 2),
        rotation(2, 0),
        rotation(0, 1),
        unit(4, 0, 3),
        unit(4, 1, 3),
        unit(4, 2, 3),
    ]
}

/// e(2) in 3 x 3 matrices.
pub(crate) fn e2() -> Vec<Integers> {
    let mut rotation = unit(3, 1, 0);
    rotation[0][1] = -1;
    vec![rotation, unit(3, 0, 2), unit(3, 1, 2)]
}

/// sl(2): h, e, f.
pub(crate) fn sl2() -> Vec<Integers> {
    vec![vec![vec![1, 0], vec![0, -1]], unit(2, 0, 1), unit(2, 1, 0)]
}

/// sp(2m): `[[A, B], [C, -A^T]]` with symmetric `B`, `C`.
pub(crate) fn sp(m: usize) -> Vec<Integers> {
    let mut basis = Vec::new();
    for i in 0..m {
        for j in 0..m {
            let mut e = unit(2 * m, i, j);
            e[m + j][m + i] = -1;
            basis.push(e);
        }
    }
    for (r, c) in [(0, m), (m, 0)] {
        for i in 0..m {
            for j in i..m {
                let mut e = unit(2 * m, r + i, c + j);
                e[r + j][c + i] = 1;
                basis.push(e);
            }
        }
    }
    basis
}

/// su(m) as real 2m x 2m blocks `[[Re, -Im], [Im, Re]]`.
pub(crate) fn su(m: usize) -> Vec<Integers> {
    let block = |re: &Integers, im: &Integers| {
        let mut e = zero(2 * m);
        for i in 0..m {
            for j in 0..m {
                e[i][j] = re[i][j];
                e[m + i][m + j] = re[i][j];
                e[m + i][j] = im[i][j];
                e[i][m + j] = -im[i][j];
            }
        }
        e
    };
    let mut basis = Vec::new();
    for i in 0..m {
        for j in i + 1..m {
            let mut re = unit(m, i, j);
            re[j][i] = -1;
            basis.push(block(&re, &zero(m)));
            let mut im = unit(m, i, j);
            im[j][i] = 1;
            basis.push(block(&zero(m), &im));
        }
    }
    for i in 0..m - 1 {
        let mut im = unit(m, i, i);
        im[i + 1][i + 1] = -1;
        basis.push(block(&zero(m), &im));
    }
    basis
}

/// The same span in another basis: each matrix plus small multiples of the later and earlier ones.
pub(crate) fn mixed(matrices: &[Integers], seed: u64) -> Vec<Integers> {
    let mut state = seed;
    let mut draw = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as i64 % 3 - 1
    };
    let add = |target: &mut Integers, factor: i64, source: &Integers| {
        for (row, other) in target.iter_mut().zip(source) {
            for (entry, value) in row.iter_mut().zip(other) {
                *entry += factor * value;
            }
        }
    };
    // Two triangular matrices with ones on the diagonal: the determinant is one.
    let mut result = matrices.to_vec();
    for i in 0..result.len() {
        for j in i + 1..result.len() {
            let source = result[j].clone();
            add(&mut result[i], draw(), &source);
        }
    }
    for i in (0..result.len()).rev() {
        for j in 0..i {
            let source = result[j].clone();
            add(&mut result[i], draw(), &source);
        }
    }
    result
}

/// The adjoint representation: `ad(e_i)_kj = C_ij^k`.
pub(crate) fn adjoint(
    n: usize,
    constants: &StructureConstants<Fraction>,
) -> Vec<Vec<Vec<Rational>>> {
    let mut matrices = vec![vec![vec![Rational::ZERO; n]; n]; n];
    for (i, j, k, value) in constants.entries() {
        let value = value.as_constant().unwrap();
        matrices[*j][*k][*i] = -&value;
        matrices[*i][*k][*j] = value;
    }
    matrices
}

pub(crate) fn rationals(matrices: &[Integers]) -> Vec<Vec<Vec<Rational>>> {
    let row = |row: &Vec<i64>| row.iter().map(|&v| Rational::from(v)).collect();
    matrices
        .iter()
        .map(|m| m.iter().map(row).collect())
        .collect()
}

/// Structure constants of integer matrices.
pub(crate) fn from_matrices(matrices: &[Integers]) -> StructureConstants<Fraction> {
    let flat: Vec<Vec<Rational>> = rationals(matrices)
        .into_iter()
        .map(|m| m.concat())
        .collect();
    let budget = lie_symbolic::exact::Budget::new(1 << 40);
    let span = lie_symbolic::exact::span::Span::new(&flat, &budget).unwrap();
    let mut entries = Vec::new();
    for i in 0..matrices.len() {
        for j in i + 1..matrices.len() {
            let (ab, ba) = (
                product(&matrices[i], &matrices[j]),
                product(&matrices[j], &matrices[i]),
            );
            let difference: Vec<Rational> = ab
                .concat()
                .iter()
                .zip(ba.concat())
                .map(|(a, b)| Rational::from(a - b))
                .collect();
            let coordinates = span
                .coordinates(&difference, &budget)
                .unwrap()
                .expect("closed");
            for (k, c) in coordinates
                .into_iter()
                .enumerate()
                .filter(|(_, c)| !c.is_zero())
            {
                entries.push((i, j, k, Fraction::from(c)));
            }
        }
    }
    StructureConstants::new(matrices.len(), entries)
}
