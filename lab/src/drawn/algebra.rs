//! Lie algebras by their matrices: sums, semidirect products and changes of basis of well-known ones.

use super::Chance;
use lie_runtime::structure::Entry;

/// A dense matrix by its rows.
pub type Rows = Vec<Vec<f64>>;

/// What linear symplectic space there is over the dual of an algebra.
#[derive(Clone, Debug, PartialEq)]
pub enum Space {
    /// Two canonical pairs for each spin.
    Spins(Vec<[usize; 3]>),
    /// `T*H` over rotations, and the coordinates of each vector.
    Vectors([usize; 3], Vec<[Entry; 3]>),
    /// `T*V^r` over the matrices.
    Columns,
    /// None that is known here.
    None,
}

/// A Lie algebra with a basis.
#[derive(Clone, Debug)]
pub struct Algebra {
    /// What it is.
    pub name: String,
    /// The basis in a faithful representation.
    pub matrices: Vec<Rows>,
    /// `(i, j, k, C_ij^k)`, all that are not 0.
    pub constants: Vec<(usize, usize, usize, f64)>,
    /// The space over its dual.
    pub space: Space,
}

/// The matrix with entries at some places.
fn matrix(size: usize, entries: &[(usize, usize, f64)]) -> Rows {
    let mut rows = vec![vec![0.0; size]; size];
    for &(i, j, value) in entries {
        rows[i][j] = value;
    }
    rows
}

fn commutator(a: &Rows, b: &Rows) -> Rows {
    let size = a.len();
    let product = |a: &Rows, b: &Rows, i: usize, j: usize| -> f64 {
        (0..size).map(|k| a[i][k] * b[k][j]).sum()
    };
    let row = |i| {
        (0..size)
            .map(|j| product(a, b, i, j) - product(b, a, i, j))
            .collect()
    };
    (0..size).map(row).collect()
}

fn pair(a: &Rows, b: &Rows) -> f64 {
    let entries = a.iter().flatten().zip(b.iter().flatten());
    entries.map(|(x, y)| x * y).sum()
}

/// The inverse of a matrix, by elimination with exchanged rows.
pub fn inverse(of: &Rows) -> Rows {
    let size = of.len();
    let mut left = of.clone();
    let mut right = matrix(size, &(0..size).map(|i| (i, i, 1.0)).collect::<Vec<_>>());
    for column in 0..size {
        let largest =
            |a: &usize, b: &usize| left[*a][column].abs().total_cmp(&left[*b][column].abs());
        let pivot = (column..size).max_by(largest).expect("there are rows");
        left.swap(column, pivot);
        right.swap(column, pivot);
        let factor = 1.0 / left[column][column];
        for entry in left[column].iter_mut().chain(right[column].iter_mut()) {
            *entry *= factor;
        }
        let (first, second) = (left[column].clone(), right[column].clone());
        for row in (0..size).filter(|&row| row != column) {
            let factor = left[row][column];
            for j in 0..size {
                left[row][j] -= factor * first[j];
                right[row][j] -= factor * second[j];
            }
        }
    }
    right
}

impl Algebra {
    /// By a basis of matrices that is closed under brackets.
    fn new(name: &str, matrices: Vec<Rows>, space: Space) -> Self {
        let count = matrices.len();
        let gram: Rows = matrices
            .iter()
            .map(|a| matrices.iter().map(|b| pair(a, b)).collect())
            .collect();
        let gram = inverse(&gram);
        let mut constants = Vec::new();
        for i in 0..count {
            for j in 0..count {
                let bracket = commutator(&matrices[i], &matrices[j]);
                let against: Vec<f64> = matrices.iter().map(|m| pair(m, &bracket)).collect();
                let mut rest = bracket.clone();
                for k in 0..count {
                    let value: f64 = gram[k].iter().zip(&against).map(|(g, a)| g * a).sum();
                    if value.abs() > 1e-12 {
                        constants.push((i, j, k, value));
                    }
                    for (rest, entry) in rest.iter_mut().flatten().zip(matrices[k].iter().flatten())
                    {
                        *rest -= value * entry;
                    }
                }
                let off = rest
                    .iter()
                    .flatten()
                    .fold(0.0, |most: f64, x| most.max(x.abs()));
                assert!(off < 1e-9, "{name}: [{i}, {j}] leaves the span by {off:e}");
            }
        }
        Self {
            name: name.into(),
            matrices,
            constants,
            space,
        }
    }

    /// The dimension.
    pub fn dimension(&self) -> usize {
        self.matrices.len()
    }

    /// The direct sum.
    fn with(&self, other: &Self) -> Self {
        let (one, two) = (self.matrices[0].len(), other.matrices[0].len());
        let place = |m: &Rows, at: usize| {
            let mut rows = vec![vec![0.0; one + two]; one + two];
            for (i, row) in m.iter().enumerate() {
                rows[at + i][at..at + row.len()].copy_from_slice(row);
            }
            rows
        };
        let first = self.matrices.iter().map(|m| place(m, 0));
        let matrices = first.chain(other.matrices.iter().map(|m| place(m, one)));
        let space = match (&self.space, &other.space) {
            (Space::Spins(a), Space::Spins(b)) => {
                let moved = b.iter().map(|spin| spin.map(|k| k + self.dimension()));
                Space::Spins(a.iter().copied().chain(moved).collect())
            }
            _ => Space::None,
        };
        Self::new(
            &format!("{} + {}", self.name, other.name),
            matrices.collect(),
            space,
        )
    }

    /// The same algebra in another basis, in which only its matrices carry a lift.
    pub fn in_another_basis(&self, chance: &mut Chance) -> Self {
        let count = self.dimension();
        let mut change = vec![vec![0.0; count]; count];
        for (i, row) in change.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                let diagonal = if i == j {
                    chance.size_between(0.6, 1.6)
                } else {
                    0.0
                };
                *entry = diagonal + 0.6 * chance.number() / (count as f64).sqrt();
            }
        }
        let sum = |row: &Vec<f64>| {
            let size = self.matrices[0].len();
            let mut sum = vec![vec![0.0; size]; size];
            for (factor, m) in row.iter().zip(&self.matrices) {
                for (sum, entry) in sum.iter_mut().flatten().zip(m.iter().flatten()) {
                    *sum += factor * entry;
                }
            }
            sum
        };
        let space = if self.space == Space::Columns {
            Space::Columns
        } else {
            Space::None
        };
        Self::new(
            &format!("{}, another basis", self.name),
            change.iter().map(sum).collect(),
            space,
        )
    }
}

/// Rotations of three coordinates of a space.
fn rotations(size: usize) -> Vec<Rows> {
    (0..3)
        .map(|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            matrix(size, &[(i, j, -1.0), (j, i, 1.0)])
        })
        .collect()
}

fn so3() -> Algebra {
    Algebra::new("so(3)", rotations(3), Space::Spins(vec![[0, 1, 2]]))
}

/// so(3) with vectors.
fn with_vectors(name: &str, count: usize) -> Algebra {
    let size = 3 + count;
    let mut matrices = rotations(size);
    let mut vectors = Vec::new();
    for vector in 0..count {
        let first = 3 + 3 * vector as u16;
        vectors.push([0, 1, 2].map(|j| Entry::new(first + j, 0, 1.0)));
        matrices.extend((0..3).map(|k| matrix(size, &[(k, 3 + vector, 1.0)])));
    }
    Algebra::new(name, matrices, Space::Vectors([0, 1, 2], vectors))
}

fn so4() -> Algebra {
    let planes = (0..4).flat_map(|i| (i + 1..4).map(move |j| (i, j)));
    let matrices = planes.map(|(i, j)| matrix(4, &[(i, j, -1.0), (j, i, 1.0)]));
    Algebra::new("so(4)", matrices.collect(), Space::Columns)
}

fn sl2() -> Algebra {
    let basis = [
        &[(0, 0, 1.0), (1, 1, -1.0)][..],
        &[(0, 1, 1.0)],
        &[(1, 0, 1.0)],
    ];
    let matrices = basis.map(|entries| matrix(2, entries)).to_vec();
    Algebra::new("sl(2)", matrices, Space::Columns)
}

/// su(3): half of the Gell-Mann matrices times -i, as real matrices of six rows.
fn su3() -> Algebra {
    let root = 1.0 / 3_f64.sqrt();
    // (row, column, real, imaginary) of -i lambda/2
    let half = 0.5;
    let mut complex: Vec<Vec<(usize, usize, f64, f64)>> = Vec::new();
    for (i, j) in [(0, 1), (0, 2), (1, 2)] {
        complex.push(vec![(i, j, 0.0, -half), (j, i, 0.0, -half)]);
        complex.push(vec![(i, j, -half, 0.0), (j, i, half, 0.0)]);
    }
    complex.push(vec![(0, 0, 0.0, -half), (1, 1, 0.0, half)]);
    complex.push(vec![
        (0, 0, 0.0, -half * root),
        (1, 1, 0.0, -half * root),
        (2, 2, 0.0, root),
    ]);
    let real = |entries: &Vec<(usize, usize, f64, f64)>| {
        let mut places = Vec::new();
        for &(i, j, x, y) in entries {
            places.extend([(i, j, x), (3 + i, 3 + j, x), (i, 3 + j, -y), (3 + i, j, y)]);
        }
        places.retain(|place| place.2 != 0.0);
        matrix(6, &places)
    };
    Algebra::new("su(3)", complex.iter().map(real).collect(), Space::Columns)
}

fn other(name: &str, size: usize, basis: &[&[(usize, usize, f64)]]) -> Algebra {
    let matrices = basis.iter().map(|entries| matrix(size, entries)).collect();
    Algebra::new(name, matrices, Space::None)
}

/// The algebras that members go through in turn.
pub fn all() -> Vec<Algebra> {
    let e2 = other(
        "e(2)",
        3,
        &[&[(0, 1, -1.0), (1, 0, 1.0)], &[(0, 2, 1.0)], &[(1, 2, 1.0)]],
    );
    let heisenberg = other(
        "heisenberg",
        3,
        &[&[(0, 1, 1.0)], &[(1, 2, 1.0)], &[(0, 2, 1.0)]],
    );
    let plane = |name: &str, extra: &[&[(usize, usize, f64)]]| {
        let mut basis: Vec<&[(usize, usize, f64)]> =
            vec![&[(0, 0, 1.0), (1, 1, -1.0)], &[(0, 1, 1.0)], &[(1, 0, 1.0)]];
        basis.extend(extra);
        basis.extend([&[(0, 2, 1.0)][..], &[(1, 2, 1.0)]]);
        other(name, 3, &basis)
    };
    let solvable = other(
        "solvable",
        3,
        &[
            &[(0, 0, 1.0), (1, 1, -0.5), (0, 1, 0.3)],
            &[(0, 2, 1.0)],
            &[(1, 2, 1.0)],
        ],
    );
    let aff1 = other("aff(1)", 2, &[&[(0, 0, 1.0)], &[(0, 1, 1.0)]]);
    let oscillator = other(
        "oscillator",
        4,
        &[
            &[(1, 2, -1.0), (2, 1, 1.0)],
            &[(0, 1, 1.0), (2, 3, 1.0)],
            &[(0, 2, 1.0), (1, 3, -1.0)],
            &[(0, 3, 1.0)],
        ],
    );
    vec![
        so3(),
        with_vectors("se(3)", 1),
        so4(),
        sl2(),
        e2.clone(),
        heisenberg.clone(),
        solvable.clone(),
        su3(),
        so3().with(&so3()),
        with_vectors("so(3) with two vectors", 2),
        plane("sl(2) with a plane", &[]),
        plane("gl(2) with a plane", &[&[(0, 0, 1.0), (1, 1, 1.0)]]),
        oscillator,
        so3().with(&sl2()),
        e2.with(&aff1),
        so3().with(&so3()).with(&so3()),
        with_vectors("se(3)", 1).with(&heisenberg),
        sl2().with(&solvable),
    ]
}
