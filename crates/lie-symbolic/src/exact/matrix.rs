//! Exact linear algebra over the rationals.

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Signed, Zero};

use super::{Budget, Exhausted, Rational, Residue, elimination};

/// Brings rows to reduced echelon form and returns the pivot columns; zero rows go to the end.
///
/// # Errors
/// [`Exhausted`] where the numbers become too long for the budget.
pub fn reduce(rows: &mut [Vec<Rational>], budget: &Budget) -> Result<Vec<usize>, Exhausted> {
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
                    spend(entry, budget)?;
                }
            }
        }
        pivots.push(column);
    }
    Ok(pivots)
}

/// Takes the cost of a sum of products away: common divisors take the square of the length.
pub(super) fn spend(value: &Rational, budget: &Budget) -> Result<(), Exhausted> {
    let words = value.bits() / 64;
    budget.spend(1 + 4 * words * words)
}

/// One solution of `A x = b` (free variables zero), `None` where there is none.
///
/// # Errors
/// [`Exhausted`], as [`reduce`].
pub fn solve(
    rows: &[Vec<Rational>],
    right: &[Rational],
    budget: &Budget,
) -> Result<Option<Vec<Rational>>, Exhausted> {
    let columns = rows.first().map_or(0, Vec::len);
    let mut extended: Vec<Vec<Rational>> = rows
        .iter()
        .zip(right)
        .map(|(row, b)| row.iter().chain([b]).cloned().collect())
        .collect();
    let pivots = reduce(&mut extended, budget)?;
    if pivots.last() == Some(&columns) {
        return Ok(None);
    }
    let mut solution = vec![Rational::ZERO; columns];
    for (row, &pivot) in extended.iter().zip(&pivots) {
        solution[pivot] = row[columns].clone();
    }
    Ok(Some(solution))
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

/// The rank modulo a prime, never above the rank.
fn rank_modulo(rows: &[Vec<BigInt>]) -> usize {
    let residues = |row: &Vec<BigInt>| row.iter().map(Residue::from_integer).collect();
    elimination::rank(rows.iter().map(residues))
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
        assert_eq!(rank(&matrix(&[&[(1 << 61) - 1, 0], &[0, 1]]), 2), 2);
        // Nearly dependent: floats would call this rank 1.
        let tiny = Rational::from(10).pow(-30).unwrap();
        let mut rows = matrix(&[&[1, 1], &[1, 1]]);
        rows[1][1] = &rows[1][1] + &tiny;
        assert_eq!(rank(&rows, 2), 2);
    }

    #[test]
    fn systems_are_solved_or_refused() {
        let rows = matrix(&[&[1, 2], &[3, 4], &[4, 6]]);
        let right: Vec<_> = [5, 6, 11].map(Rational::from).into();
        let solution = vec![Rational::from(-4), Rational::new(9, 2).unwrap()];
        assert_eq!(solve(&rows, &right, &Budget::new(100)), Ok(Some(solution)));
        let none = &[5, 6, 12].map(Rational::from);
        assert_eq!(solve(&rows, none, &Budget::new(100)), Ok(None));
        assert_eq!(solve(&rows, none, &Budget::new(1)), Err(Exhausted));
    }
}
