//! How a map from the algebra to the group moves: its tangents and what its elements do to momenta, as expressions.
//!
//! A map `tau = S^-1 M` is given by its matrices, functions of the coordinates x of an element. With
//! `B_a = (dM/dx_a) M^-1 - (dS/dx_a) S^-1`, an element of the algebra, its trivialised tangents are
//!
//! ```math
//! \partial_a\tau\, \tau^{-1} = S^{-1} B_a S, \qquad \tau^{-1}\, \partial_a\tau = M^{-1} B_a M
//! ```

use super::rotating::{are_orthogonal, are_zero};
use lie_symbolic::exact::{Budget, Rational, matrix};
use lie_symbolic::symbolic::{ExprId, Graph, Symbol};

/// A square matrix of expressions by rows.
type Square = Vec<ExprId>;
/// A matrix of an algebra.
type Fixed = Vec<Vec<Rational>>;

/// Work allowed for the coordinates of matrices in a basis.
const WORK: u64 = 10_000_000;

/// A map from the algebra to the group.
#[derive(Debug)]
pub struct Moving<'a> {
    /// The number of rows of the matrices.
    pub size: usize,
    /// The matrices of the basis.
    pub basis: &'a [Fixed],
    /// M and S; where there is none it is the identity.
    pub ends: [Option<&'a [ExprId]>; 2],
}

/// The inverses of both matrices, and `B_a`.
pub struct Tangents {
    /// Those of M and S.
    pub inverses: [Option<Square>; 2],
    /// For each coordinate.
    pub directions: Vec<Square>,
}

impl Moving<'_> {
    /// The inverses, and the tangents in the algebra.
    pub fn tangents(&self, graph: &mut Graph) -> Tangents {
        let inverses = self
            .ends
            .map(|end| end.map(|end| inverse(graph, end, self.size, self.basis)));
        let directions = (0..self.basis.len()).map(|a| {
            let mut parts = self.ends.iter().zip(&inverses).map(|(end, inverse)| {
                let slope = end.as_ref()?.iter();
                let slope: Square = slope
                    .map(|entry| graph.derivative(*entry, Symbol::Input(a)))
                    .collect();
                Some(product(graph, &slope, inverse.as_ref()?, self.size))
            });
            let (of_map, of_second) = (parts.next().flatten(), parts.next().flatten());
            drop(parts);
            match (of_map, of_second) {
                (Some(map), Some(second)) => {
                    let pairs = map.iter().zip(&second);
                    pairs.map(|(m, s)| graph.sub(*m, *s)).collect()
                }
                (Some(map), None) => map,
                (None, second) => {
                    let entries = second.iter().flatten();
                    entries.map(|entry| graph.neg(*entry)).collect()
                }
            }
        });
        Tangents {
            directions: directions.collect(),
            inverses,
        }
    }

    /// Each matrix as a map of its own.
    pub fn each_end(&self) -> impl Iterator<Item = Self> {
        let ends = self.ends.into_iter().flatten();
        ends.map(|end| Self {
            size: self.size,
            basis: self.basis,
            ends: [Some(end), None],
        })
    }

    /// The matrix of tau, and that of its inverse.
    pub fn elements(&self, graph: &mut Graph, tangents: &Tangents) -> [Square; 2] {
        let ([map, second], [map_inverse, second_inverse]) = (&self.ends, &tangents.inverses);
        let times = |graph: &mut Graph, a: Option<&[ExprId]>, b: Option<&[ExprId]>| match (a, b) {
            (Some(a), Some(b)) => product(graph, a, b, self.size),
            (one, other) => one.or(other).unwrap_or_default().to_vec(),
        };
        [
            times(graph, second_inverse.as_deref(), *map),
            times(graph, map_inverse.as_deref(), *second),
        ]
    }
}

/// `A X A^-1` of matrices by rows, where one of them may be the identity.
pub fn conjugated(
    graph: &mut Graph,
    a: Option<&[ExprId]>,
    x: &[ExprId],
    inverse: Option<&[ExprId]>,
    size: usize,
) -> Square {
    let left = a.map_or_else(|| x.to_vec(), |a| product(graph, a, x, size));
    inverse.map_or_else(|| left.clone(), |b| product(graph, &left, b, size))
}

/// A product of matrices by rows.
pub fn product(graph: &mut Graph, a: &[ExprId], b: &[ExprId], size: usize) -> Square {
    let place = |k: usize| {
        let (i, j) = (k / size, k % size);
        let terms = (0..size).map(|l| graph.mul(a[i * size + l], b[l * size + j]));
        let terms: Vec<ExprId> = terms.collect();
        graph.sum(&terms)
    };
    (0..size * size).map(place).collect()
}

/// Numbers as expressions, by rows.
pub fn constant(graph: &mut Graph, matrix: &Fixed) -> Square {
    let entries = matrix.iter().flatten();
    entries.map(|entry| graph.number(entry.clone())).collect()
}

/// The inverse of a matrix of the group of an algebra: the transpose of a rotation, by blocks where the last row is that of the identity, else
/// by the coefficients of its characteristic polynomial (Faddeev and Le Verrier), without a pivot that could vanish.
fn inverse(graph: &mut Graph, matrix: &[ExprId], size: usize, basis: &[Fixed]) -> Square {
    if are_orthogonal(size, basis) {
        return (0..size * size)
            .map(|k| matrix[(k % size) * size + k / size])
            .collect();
    }
    let last = size - 1;
    if !are_zero(basis, last..size, 0..size) {
        return by_coefficients(graph, matrix, size);
    }
    // [A t; 0 1]
    let entries = (0..last).flat_map(|i| (0..last).map(move |j| i * size + j));
    let block: Square = entries.map(|k| matrix[k]).collect();
    let block = inverse(graph, &block, last, basis);
    let mut all = Vec::with_capacity(size * size);
    for i in 0..last {
        let row = &block[i * last..][..last];
        let terms = row.iter().enumerate();
        let terms: Vec<ExprId> = terms
            .map(|(j, entry)| graph.mul(*entry, matrix[j * size + last]))
            .collect();
        let moved = graph.sum(&terms);
        all.extend_from_slice(row);
        all.push(graph.neg(moved));
    }
    all.extend((0..last).map(|_| graph.integer(0)));
    all.push(graph.integer(1));
    all
}

fn by_coefficients(graph: &mut Graph, matrix: &[ExprId], size: usize) -> Square {
    let diagonal = |graph: &mut Graph, value: ExprId| -> Square {
        let zero = graph.integer(0);
        let on = |k: usize| k / size == k % size;
        (0..size * size)
            .map(|k| if on(k) { value } else { zero })
            .collect()
    };
    let one = graph.integer(1);
    let mut adjugate = diagonal(graph, one);
    for k in 1.. {
        let image = product(graph, matrix, &adjugate, size);
        let trace: Vec<ExprId> = (0..size).map(|i| image[i * size + i]).collect();
        let trace = graph.sum(&trace);
        let share = &Rational::MINUS_ONE / &Rational::from(k as i64);
        let coefficient = graph.scale(trace, &share);
        if k == size {
            let divisor = graph.neg(coefficient);
            let entries = adjugate.iter();
            return entries.map(|entry| graph.div(*entry, divisor)).collect();
        }
        let shift = diagonal(graph, coefficient);
        let pairs = image.iter().zip(&shift);
        adjugate = pairs.map(|(a, b)| graph.sum(&[*a, *b])).collect();
    }
    unreachable!("the loop ends at the size")
}

/// Coordinates of matrices in a basis, by as many of their entries.
#[derive(Debug)]
pub struct Coordinates {
    /// The places of these entries.
    places: Vec<usize>,
    /// Coordinate a is the sum of these, times entry k.
    weights: Vec<Vec<Rational>>,
}

impl Coordinates {
    /// In a basis of independent matrices.
    pub fn new(basis: &[Fixed]) -> Option<Self> {
        let count = basis.len();
        let rows = basis.iter().enumerate().map(|(a, matrix)| {
            let unit = (0..count).map(|b| Rational::from(i64::from(a == b)));
            matrix.iter().flatten().cloned().chain(unit).collect()
        });
        let mut rows: Vec<Vec<Rational>> = rows.collect();
        let entries = rows.first()?.len() - count;
        let places = matrix::reduce(&mut rows, &Budget::new(WORK)).ok()?;
        let independent = places.iter().all(|place| *place < entries);
        independent.then(|| Self {
            places,
            weights: rows.iter().map(|row| row[entries..].to_vec()).collect(),
        })
    }

    /// The coordinates of a combination of the basis.
    pub fn of(&self, graph: &mut Graph, matrix: &[ExprId]) -> Vec<ExprId> {
        let coordinate = |a: usize| {
            let pairs = self.places.iter().zip(&self.weights);
            let terms: Vec<(ExprId, Rational)> = pairs
                .map(|(place, weights)| (matrix[*place], weights[a].clone()))
                .collect();
            graph.linear(&terms)
        };
        (0..self.places.len()).map(coordinate).collect()
    }
}
