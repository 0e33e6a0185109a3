//! The Cayley map of a matrix algebra as expressions: `g = (1 - X/2)^-1 (1 + X/2)` with `X = sum_a x_a rho_a`.
//!
//! What differs from the identity, `D = g - 1`, solves `(1 - X/2) D = X` and is small with x, so that no digits are
//! lost near the identity. Derivatives need no other functions:
//!
//! ```math
//! A = (1 - X/2)^{-1} = 1 + D/2, \qquad \partial_a g = A \rho_a A, \qquad
//! \partial_a \partial_b g = \tfrac12 (A \rho_a A \rho_b A + A \rho_b A \rho_a A)
//! ```
//!
//! The matrices are written by rows. An elimination of `1 - X/2` in the order of the rows takes about n^3 products.
//! Its pivots are quotients of leading minors: those of `1 - B/2` with an antisymmetric block B are never below 1.
//! Where the matrices do not ensure that, the normal equations `(1 - X/2)^T (1 - X/2) D = (1 - X/2)^T X` are eliminated. Their matrix
//! is positive definite wherever the Cayley map is defined, and so are all pivots.

use lie_symbolic::exact::Rational;
use lie_symbolic::symbolic::{ExprId, Graph};

/// A matrix of an algebra.
type Fixed = Vec<Vec<Rational>>;
/// A square matrix of expressions by rows.
type Square = Vec<ExprId>;

/// The largest matrix whose minors are written out.
pub const MOST_BY_MINORS: usize = 4;

/// The combination `X = sum_a x_a rho_a`.
pub fn combination(graph: &mut Graph, basis: &[Fixed], x: &[ExprId], size: usize) -> Square {
    let entry = |k: usize| {
        let terms = basis.iter().zip(x);
        let terms = terms.map(|(matrix, x)| (*x, matrix[k / size][k % size].clone()));
        let terms: Vec<(ExprId, Rational)> = terms.filter(|(_, c)| !c.is_zero()).collect();
        graph.linear(&terms)
    };
    (0..size * size).map(entry).collect()
}

/// The Cayley map of a combination X.
#[derive(Clone, Debug)]
pub struct CayleyMap {
    /// The matrix `D = g - 1`.
    pub off: Square,
    /// The matrix `A = (1 - X/2)^-1`.
    pub inverse: Square,
}

impl CayleyMap {
    /// The form for the size of the matrices.
    pub fn new(graph: &mut Graph, basis: &[Fixed], x: &Square, size: usize) -> Self {
        match size <= MOST_BY_MINORS {
            true => Self::by_minors(graph, x, size),
            false => Self::by_elimination(graph, basis, x, size),
        }
    }

    /// By elimination.
    pub fn by_elimination(graph: &mut Graph, basis: &[Fixed], x: &Square, size: usize) -> Self {
        let matrix = inverted(graph, x, size);
        let off = if eliminates_in_order(basis, size) {
            solve(graph, matrix, x.clone(), size)
        } else {
            let transposed = |k: usize| matrix[(k % size) * size + k / size];
            let transposed: Square = (0..size * size).map(transposed).collect();
            let normal = product(graph, &transposed, &matrix, size);
            let right = product(graph, &transposed, x, size);
            solve(graph, normal, right, size)
        };
        let inverse = plus_unit(graph, &off, &half(), size);
        Self { off, inverse }
    }

    /// By minors, over one determinant: `A = adj(1 - X/2)/det(1 - X/2)`.
    pub fn by_minors(graph: &mut Graph, x: &Square, size: usize) -> Self {
        let matrix = inverted(graph, x, size);
        let all: Vec<usize> = (0..size).collect();
        let determinant = minor(graph, &matrix, size, &all, &all);
        let without = |left_out: usize| -> Vec<usize> {
            all.iter().copied().filter(|k| *k != left_out).collect()
        };
        let entry = |k: usize| {
            let (row, column) = (k / size, k % size);
            let cofactor = minor(graph, &matrix, size, &without(column), &without(row));
            let quotient = graph.div(cofactor, determinant);
            match (row + column) % 2 {
                0 => quotient,
                _ => graph.neg(quotient),
            }
        };
        let inverse: Square = (0..size * size).map(entry).collect();
        // 2 A - 2 would lose the digits of what is near the identity
        let off = product(graph, &inverse, x, size);
        Self { off, inverse }
    }
}

/// `1/2`
fn half() -> Rational {
    Rational::new(1, 2).unwrap_or(Rational::ONE)
}

/// `1 - X/2`
fn inverted(graph: &mut Graph, x: &Square, size: usize) -> Square {
    plus_unit(graph, x, &-&half(), size)
}

/// `1 + factor X`
fn plus_unit(graph: &mut Graph, x: &Square, factor: &Rational, size: usize) -> Square {
    let entry = |k: usize| {
        let unit = graph.integer(i64::from(k / size == k % size));
        graph.linear(&[(unit, Rational::ONE), (x[k], factor.clone())])
    };
    (0..size * size).map(entry).collect()
}

/// The determinant of some rows and columns, expanded along the first row.
fn minor(
    graph: &mut Graph,
    matrix: &Square,
    size: usize,
    rows: &[usize],
    columns: &[usize],
) -> ExprId {
    let Some((&first, rest)) = rows.split_first() else {
        return graph.integer(1);
    };
    let terms = columns.iter().enumerate().map(|(place, &column)| {
        let others: Vec<usize> = columns.iter().copied().filter(|&c| c != column).collect();
        let minor = minor(graph, matrix, size, rest, &others);
        let term = graph.mul(matrix[first * size + column], minor);
        let sign = if place % 2 == 0 { 1 } else { -1 };
        (term, Rational::from(sign))
    });
    let terms: Vec<(ExprId, Rational)> = terms.collect();
    graph.linear(&terms)
}

/// Whether no leading minor of `1 - X/2` vanishes, whatever x is: the matrices are triangular by blocks along the
/// diagonal, and these are antisymmetric.
fn eliminates_in_order(basis: &[Fixed], size: usize) -> bool {
    let along = |upper: bool| {
        let at = |matrix: &Fixed, i: usize, j: usize| match upper {
            true => matrix[i][j].clone(),
            false => matrix[j][i].clone(),
        };
        let vanishes = |i: usize, j: usize| basis.iter().all(|m| at(m, i, j).is_zero());
        let mut first = 0;
        while first < size {
            // the block goes on as long as something stands below its diagonal
            let mut last = first;
            let mut row = first;
            while row <= last {
                let below = (last + 1..size).rev().find(|i| !vanishes(*i, row));
                last = below.unwrap_or(last);
                row += 1;
            }
            let mut pairs = (first..=last).flat_map(|i| (first..=i).map(move |j| (i, j)));
            let turned = |m: &Fixed, i, j| (&at(m, i, j) + &at(m, j, i)).is_zero();
            if !pairs.all(|(i, j)| basis.iter().all(|m| turned(m, i, j))) {
                return false;
            }
            first = last + 1;
        }
        true
    };
    along(true) || along(false)
}

/// The solution of `matrix D = right` by elimination in the order of the rows.
fn solve(graph: &mut Graph, mut matrix: Square, mut right: Square, size: usize) -> Square {
    let mut inverses = Vec::with_capacity(size);
    for k in 0..size {
        let inverse = graph.pow(matrix[k * size + k], &Rational::MINUS_ONE);
        inverses.push(inverse);
        for i in k + 1..size {
            let factor = quantity(graph, &[matrix[i * size + k], inverse]);
            for j in 0..size {
                if j > k {
                    let moved = graph.mul(factor, matrix[k * size + j]);
                    matrix[i * size + j] = graph.sub(matrix[i * size + j], moved);
                }
                let moved = graph.mul(factor, right[k * size + j]);
                right[i * size + j] = graph.sub(right[i * size + j], moved);
            }
        }
    }
    for i in (0..size).rev() {
        for j in 0..size {
            let mut terms = vec![(right[i * size + j], Rational::ONE)];
            for k in i + 1..size {
                let known = graph.mul(matrix[i * size + k], right[k * size + j]);
                terms.push((known, Rational::MINUS_ONE));
            }
            let sum = graph.linear(&terms);
            right[i * size + j] = quantity(graph, &[sum, inverses[i]]);
        }
    }
    right
}

/// A product that stays one factor in products with others, and so is computed once.
fn quantity(graph: &mut Graph, factors: &[ExprId]) -> ExprId {
    let product = graph.product(factors);
    graph.written_product(product)
}

/// A product of matrices.
fn product(graph: &mut Graph, a: &[ExprId], b: &[ExprId], size: usize) -> Square {
    super::moving::product(graph, a, b, size)
}

#[cfg(test)]
mod tests {
    use super::*;
    use lie_symbolic::symbolic::Symbol;

    fn unit(size: usize, entries: &[(usize, usize, i64)]) -> Fixed {
        let mut matrix = vec![vec![Rational::ZERO; size]; size];
        for &(i, j, value) in entries {
            matrix[i][j] = Rational::from(value);
        }
        matrix
    }

    /// `(1 - X/2) (1 + D) - (1 + X/2)`, the largest entry.
    fn defect(basis: &[Fixed], x: &[f64], minors: bool) -> f64 {
        let size = basis[0].len();
        let mut graph = Graph::new();
        let symbols = (0..x.len()).map(|a| graph.symbol(Symbol::Input(a)));
        let symbols: Vec<ExprId> = symbols.collect();
        let matrix = combination(&mut graph, basis, &symbols, size);
        let off = match minors {
            true => CayleyMap::by_minors(&mut graph, &matrix, size),
            false => CayleyMap::by_elimination(&mut graph, basis, &matrix, size),
        };
        let off = off.off;
        let at = |symbol| match symbol {
            Symbol::Input(a) => x[a],
            _ => f64::NAN,
        };
        let (matrix, off) = (
            graph.evaluate_all(&matrix, &at),
            graph.evaluate_all(&off, &at),
        );
        let one = |i: usize, j: usize| f64::from(u8::from(i == j));
        let entry = |i: usize, j: usize| -> f64 {
            let terms = (0..size).map(|k| {
                (one(i, k) - matrix[i * size + k] / 2.0) * (one(k, j) + off[k * size + j])
            });
            terms.sum::<f64>() - one(i, j) - matrix[i * size + j] / 2.0
        };
        let pairs = (0..size).flat_map(|i| (0..size).map(move |j| (i, j)));
        pairs.map(|(i, j)| entry(i, j)).fold(
            0.0,
            |most: f64, e| {
                if e.is_nan() { e } else { most.max(e.abs()) }
            },
        )
    }

    #[test]
    fn which_matrices_are_eliminated_in_order() {
        let turn = |size, i, j| unit(size, &[(i, j, -1), (j, i, 1)]);
        let rotations = vec![turn(5, 0, 1), turn(5, 2, 4), turn(5, 1, 3)];
        let euclidean = vec![turn(3, 0, 1), unit(3, &[(0, 2, 1)]), unit(3, &[(1, 2, 1)])];
        let transposed = vec![turn(3, 0, 1), unit(3, &[(2, 0, 1)]), unit(3, &[(2, 1, 1)])];
        let heisenberg = vec![
            unit(3, &[(0, 1, 1)]),
            unit(3, &[(1, 2, 1)]),
            unit(3, &[(0, 2, 1)]),
        ];
        for basis in [rotations, euclidean, transposed, heisenberg] {
            assert!(eliminates_in_order(&basis, basis[0].len()));
        }
        let sl2 = vec![
            unit(2, &[(0, 0, 1), (1, 1, -1)]),
            unit(2, &[(0, 1, 1)]),
            unit(2, &[(1, 0, 1)]),
        ];
        let squeezes = vec![unit(2, &[(0, 1, 1), (1, 0, 1)])];
        // the block of the last two rows is not antisymmetric
        let mixed = vec![
            turn(4, 0, 1),
            unit(4, &[(2, 3, 1), (3, 2, 1)]),
            unit(4, &[(0, 3, 1)]),
        ];
        for basis in [sl2, squeezes, mixed] {
            assert!(!eliminates_in_order(&basis, basis[0].len()));
        }
    }

    /// Also where a leading minor of `1 - X/2` vanishes.
    #[test]
    fn the_matrix_solves_its_equation() {
        let turn = |size, i, j| unit(size, &[(i, j, -1), (j, i, 1)]);
        let rotations: Vec<Fixed> = (0..5)
            .flat_map(|i| (i + 1..5).map(move |j| turn(5, i, j)))
            .collect();
        let x: Vec<f64> = (0..10).map(|a| 0.3 * f64::from(a) - 1.1).collect();
        assert!(defect(&rotations, &x, false) < 1e-14);
        assert!(defect(&rotations, &x, true) < 1e-14);
        let sl2 = vec![
            unit(2, &[(0, 0, 1), (1, 1, -1)]),
            unit(2, &[(0, 1, 1)]),
            unit(2, &[(1, 0, 1)]),
        ];
        for x in [[0.3, -0.2, 0.5], [2.0, 1.0, -1.5], [-2.0, 0.7, 0.9]] {
            for minors in [false, true] {
                assert!(defect(&sl2, &x, minors) < 1e-14, "{x:?} {minors}");
            }
        }
        // the control: at a pole there is no such matrix
        let pole = defect(&sl2, &[2.0, 0.0, 0.0], false);
        assert!(pole.is_nan() || pole > 1e-3);
    }
}
