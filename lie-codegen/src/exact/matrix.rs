//! Exact linear algebra over the rationals.

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Signed, ToPrimitive, Zero};

use super::Rational;

/// A Mersenne prime, the modulus of the quick lower bound of a rank.
const PRIME: u64 = (1 << 61) - 1;

/// Brings rows to reduced echelon form and returns the pivot columns; zero rows go to the end.
pub fn reduce(rows: &mut [Vec<Rational>]) -> Vec<usize> {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let mut pivots = Vec::new();
    for column in 0..columns {
        let top = pivots.len();
        // The shortest pivot keeps the numbers short.
        let best = (top..rows.len())
            .filter(|&r| !rows[r][column].is_zero())
            .min_by_key(|&r| rows[r][column].bits());
        let Some(best) = best else { continue };
        rows.swap(top, best);
        let inverse = &Rational::ONE / &rows[top][column];
        for entry in &mut rows[top][column..] {
            if !entry.is_zero() {
                *entry = &*entry * &inverse;
            }
        }
        let pivot = rows[top].clone();
        for (r, row) in rows.iter_mut().enumerate() {
            if r == top || row[column].is_zero() {
                continue;
            }
            let factor = row[column].clone();
            for (entry, p) in row[column..].iter_mut().zip(&pivot[column..]) {
                if !p.is_zero() {
                    *entry = &*entry - &(&factor * p);
                }
            }
        }
        pivots.push(column);
    }
    pivots
}

/// A basis of the solutions of `A x = 0`, each with one free variable equal to one.
pub fn nullspace(mut rows: Vec<Vec<Rational>>, columns: usize) -> Vec<Vec<Rational>> {
    let pivots = reduce(&mut rows);
    let free = (0..columns).filter(|c| !pivots.contains(c));
    free.map(|f| {
        let mut vector = vec![Rational::ZERO; columns];
        vector[f] = Rational::ONE;
        for (row, &pivot) in rows.iter().zip(&pivots) {
            vector[pivot] = -&row[f];
        }
        vector
    })
    .collect()
}

/// One solution of `A x = b` (free variables zero), `None` where there is none.
pub fn solve(rows: &[Vec<Rational>], right: &[Rational]) -> Option<Vec<Rational>> {
    let columns = rows.first().map_or(0, Vec::len);
    let mut extended: Vec<Vec<Rational>> = rows
        .iter()
        .zip(right)
        .map(|(row, b)| row.iter().chain([b]).cloned().collect())
        .collect();
    let pivots = reduce(&mut extended);
    if pivots.last() == Some(&columns) {
        return None;
    }
    let mut solution = vec![Rational::ZERO; columns];
    for (row, &pivot) in extended.iter().zip(&pivots) {
        solution[pivot] = row[columns].clone();
    }
    Some(solution)
}

/// The rank. `bound` is a known upper bound (the smaller side if nothing is known): where the rank
/// modulo a prime, which is never above the rank, reaches it, nothing else needs to be computed.
pub fn rank(rows: &[Vec<Rational>], bound: usize) -> usize {
    let integers: Vec<Vec<BigInt>> = rows.iter().map(|row| to_integers(row)).collect();
    let modular = rank_modulo(&integers);
    if modular >= bound {
        modular
    } else {
        bareiss(integers)
    }
}

/// The row times the common denominator of its entries, without common divisor.
fn to_integers(row: &[Rational]) -> Vec<BigInt> {
    let values: Vec<_> = row.iter().map(Rational::to_big).collect();
    let denominator = values.iter().fold(BigInt::one(), |d, v| d.lcm(v.denom()));
    let scaled: Vec<BigInt> = values
        .iter()
        .map(|v| v.numer() * (&denominator / v.denom()))
        .collect();
    let divisor = scaled.iter().fold(BigInt::zero(), |g, v| g.gcd(v));
    if divisor.is_zero() {
        scaled
    } else {
        scaled.into_iter().map(|v| v / &divisor).collect()
    }
}

fn rank_modulo(rows: &[Vec<BigInt>]) -> usize {
    let modulus = BigInt::from(PRIME);
    let mut rows: Vec<Vec<u64>> = rows
        .iter()
        .map(|row| {
            row.iter()
                .map(|v| v.mod_floor(&modulus).to_u64().unwrap_or(0))
                .collect()
        })
        .collect();
    let times = |a: u64, b: u64| (u128::from(a) * u128::from(b) % u128::from(PRIME)) as u64;
    let columns = rows.first().map_or(0, Vec::len);
    let mut rank = 0;
    for column in 0..columns {
        let Some(best) = (rank..rows.len()).find(|&r| rows[r][column] != 0) else {
            continue;
        };
        rows.swap(rank, best);
        let (above, below) = rows.split_at_mut(rank + 1);
        let pivot = &above[rank];
        let inverse = power_modulo(pivot[column], PRIME - 2);
        for row in below.iter_mut().filter(|row| row[column] != 0) {
            let factor = times(row[column], inverse);
            for (entry, p) in row[column..].iter_mut().zip(&pivot[column..]) {
                *entry = (*entry + PRIME - times(factor, *p)) % PRIME;
            }
        }
        rank += 1;
    }
    rank
}

fn power_modulo(base: u64, mut exponent: u64) -> u64 {
    let modulus = u128::from(PRIME);
    let (mut result, mut square) = (1u128, u128::from(base));
    while exponent > 0 {
        if exponent & 1 == 1 {
            result = result * square % modulus;
        }
        square = square * square % modulus;
        exponent >>= 1;
    }
    result as u64
}

/// Fraction-free elimination: every entry is a minor, and every division is exact.
fn bareiss(mut rows: Vec<Vec<BigInt>>) -> usize {
    let columns = rows.first().map_or(0, Vec::len);
    let mut last = BigInt::one();
    let mut rank = 0;
    for column in 0..columns {
        let best = (rank..rows.len())
            .filter(|&r| !rows[r][column].is_zero())
            .min_by_key(|&r| rows[r][column].abs().bits());
        let Some(best) = best else { continue };
        rows.swap(rank, best);
        let (above, below) = rows.split_at_mut(rank + 1);
        let pivot_row = &above[rank];
        let pivot = &pivot_row[column];
        for row in below {
            let factor = row[column].clone();
            for (entry, p) in row[column + 1..].iter_mut().zip(&pivot_row[column + 1..]) {
                let mut value = &*entry * pivot;
                if !factor.is_zero() && !p.is_zero() {
                    value -= &factor * p;
                }
                *entry = if value.is_zero() {
                    value
                } else {
                    value / &last
                };
            }
            row[column] = BigInt::zero();
        }
        last = pivot.clone();
        rank += 1;
    }
    rank
}

/// The span of linearly independent vectors, ready to give coordinates in it.
#[derive(Clone, Debug)]
pub struct Span {
    vectors: Vec<Vec<(usize, Rational)>>,
    /// Entries that determine the coordinates.
    pivots: Vec<usize>,
    /// `coordinates = inverse * (entries at the pivots)`, sparse rows.
    inverse: Vec<Vec<(usize, Rational)>>,
    length: usize,
}

impl Span {
    /// The span of vectors of equal length.
    ///
    /// # Errors
    /// The coefficients of a linear relation between the vectors.
    pub fn new(vectors: &[Vec<Rational>]) -> Result<Self, Vec<Rational>> {
        let (count, length) = (vectors.len(), vectors.first().map_or(0, Vec::len));
        // [V | 1] -> [R | T] with T V = R: a zero row of R shows a relation.
        let mut rows: Vec<Vec<Rational>> = vectors.to_vec();
        for (i, row) in rows.iter_mut().enumerate() {
            row.extend((0..count).map(|j| {
                if i == j {
                    Rational::ONE
                } else {
                    Rational::ZERO
                }
            }));
        }
        let pivots: Vec<usize> = reduce(&mut rows)
            .into_iter()
            .filter(|&p| p < length)
            .collect();
        if pivots.len() < count {
            return Err(rows[pivots.len()][length..].to_vec());
        }
        // A vector v = sum c_i V_i has the entries v[pivots] = c V[., pivots], and T V[., pivots] = 1,
        // hence c = v[pivots] T.
        let sparse = |row: Vec<&Rational>| -> Vec<(usize, Rational)> {
            row.into_iter()
                .enumerate()
                .filter(|(_, v)| !v.is_zero())
                .map(|(i, v)| (i, v.clone()))
                .collect()
        };
        let inverse = (0..count)
            .map(|i| sparse(rows.iter().map(|row| &row[length + i]).collect()))
            .collect();
        let vectors = vectors.iter().map(|v| sparse(v.iter().collect())).collect();
        Ok(Self {
            vectors,
            pivots,
            inverse,
            length,
        })
    }

    /// The coordinates of a vector, `None` where it is outside the span.
    pub fn coordinates(&self, vector: &[Rational]) -> Option<Vec<Rational>> {
        let mut result = Vec::with_capacity(self.inverse.len());
        for row in &self.inverse {
            let mut sum = Rational::ZERO;
            for (i, factor) in row {
                let entry = &vector[self.pivots[*i]];
                if !entry.is_zero() {
                    sum = &sum + &(factor * entry);
                }
            }
            result.push(sum);
        }
        let mut rest = vector.to_vec();
        debug_assert!(self.vectors.is_empty() || rest.len() == self.length);
        for (coordinate, basis) in result
            .iter()
            .zip(&self.vectors)
            .filter(|(c, _)| !c.is_zero())
        {
            for (i, value) in basis {
                rest[*i] = &rest[*i] - &(coordinate * value);
            }
        }
        rest.iter().all(Rational::is_zero).then_some(result)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(rows: &[&[i64]]) -> Vec<Vec<Rational>> {
        rows.iter()
            .map(|row| row.iter().map(|&v| Rational::from(v)).collect())
            .collect()
    }

    #[test]
    fn ranks() {
        assert_eq!(rank(&matrix(&[&[1, 2, 3], &[4, 5, 6], &[7, 8, 9]]), 3), 2);
        assert_eq!(rank(&matrix(&[&[1, 2, 3], &[4, 5, 6], &[7, 8, 10]]), 3), 3);
        assert_eq!(rank(&matrix(&[&[0, 0, 0], &[0, 0, 5], &[0, 0, 7]]), 3), 1);
        assert_eq!(rank(&[], 0), 0);
        // The rank falls modulo the prime, but not over the rationals.
        assert_eq!(rank(&matrix(&[&[PRIME as i64, 0], &[0, 1]]), 2), 2);
        // Nearly dependent: floats would call this rank 1.
        let tiny = Rational::from(10).pow(-30).unwrap();
        let mut rows = matrix(&[&[1, 1], &[1, 1]]);
        rows[1][1] = &rows[1][1] + &tiny;
        assert_eq!(rank(&rows, 2), 2);
    }

    #[test]
    fn nullspace_is_annihilated() {
        let rows = matrix(&[&[1, 2, 3, 4], &[2, 4, 6, 9]]);
        let null = nullspace(rows.clone(), 4);
        assert_eq!(null.len(), 2);
        for vector in &null {
            for row in &rows {
                let sum = row
                    .iter()
                    .zip(vector)
                    .fold(Rational::ZERO, |s, (a, b)| &s + &(a * b));
                assert!(sum.is_zero());
            }
        }
    }

    #[test]
    fn systems_are_solved_or_refused() {
        let rows = matrix(&[&[1, 2], &[3, 4], &[4, 6]]);
        let right: Vec<_> = [5, 6, 11].map(Rational::from).into();
        assert_eq!(
            solve(&rows, &right).unwrap(),
            vec![Rational::from(-4), Rational::new(9, 2).unwrap()]
        );
        assert_eq!(solve(&rows, &[5, 6, 12].map(Rational::from)), None);
    }

    #[test]
    fn coordinates_in_a_span() {
        let vectors = matrix(&[&[0, 1, 2, 0], &[1, 1, 0, 3], &[0, 0, 1, 1]]);
        let span = Span::new(&vectors).unwrap();
        let inside = &matrix(&[&[2, -1, -4, 8]])[0];
        let c = span.coordinates(inside).unwrap();
        assert_eq!(c, [-3, 2, 2].map(Rational::from));
        assert_eq!(span.coordinates(&matrix(&[&[2, -1, -4, 7]])[0]), None);
        let relation = Span::new(&matrix(&[&[1, 2], &[2, 4]])).unwrap_err();
        assert!(!relation.iter().all(Rational::is_zero));
        assert_eq!(
            &relation[0] + &(&relation[1] * &Rational::from(2)),
            Rational::ZERO
        );
    }
}
