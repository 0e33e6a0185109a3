//! The algebras B_n and C_n, which have the same dimension n (2n + 1), by the traces of powers of `ad_x`.
//!
//! With e_1, …, e_n the coordinates of x in the Cartan subalgebra, the eigenvalues of `ad_x` are `±e_i ± e_j` and, of B_n, `±e_i`, of
//! C_n, `±2 e_i` (Bourbaki, Groupes et algèbres de Lie, chapter VI, plates II and III). With the power sums P_k of the squares e_i² this
//! is
//!
//! `tr ad_x^(2k) = (4n − 4^k + s_k) P_k + 2 sum_(0<m<k) binomial(2k, 2m) P_m P_(k−m)`, with `s_k = 2` and `2·4^k`.
//!
//! It gives P_1 to P_n from n traces, Newton's identities give the next one, and the next trace is what they say only where
//! the type is right. All of it is done modulo a prime: an identity that does not hold there does not hold.

use super::table::Table;
use crate::structure::casimirs::{Field, PRIMES, Prime};
use lie_symbolic::exact::{Budget, Exhausted};

/// A type of complex simple algebras.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Series {
    /// B_n, of so(2n + 1).
    Orthogonal,
    /// C_n, of sp(2n).
    Symplectic,
}

/// Which of B_n and C_n a simple algebra of this dimension may be, n ≥ 3; both where that is not found out.
pub fn possible(table: &Table, rank: usize, budget: &Budget) -> Result<Vec<Series>, Exhausted> {
    let mut open = vec![Series::Orthogonal, Series::Symplectic];
    for (attempt, prime) in PRIMES.into_iter().enumerate().take(3) {
        let field = Prime { prime, budget };
        let x = element(table.dimension(), attempt);
        let Some(traces) = traces(table, &x, rank + 1, &field)? else {
            continue;
        };
        let mut left = Vec::new();
        for series in open {
            if fits(series, rank, &traces, &field)? {
                left.push(series);
            }
        }
        open = left;
        if open.len() < 2 {
            break;
        }
    }
    Ok(open)
}

/// Small integers that follow no pattern.
fn element(dimension: usize, attempt: usize) -> Vec<i64> {
    let entry = |i: usize| (i * i * 7 + i * (3 + attempt) + 1) % 11;
    (0..dimension).map(|i| entry(i) as i64 - 5).collect()
}

/// `tr ad_x^(2k)` for k = 1, …, `count`; `None` where the prime divides a denominator.
fn traces(
    table: &Table,
    x: &[i64],
    count: usize,
    field: &Prime<'_>,
) -> Result<Option<Vec<u64>>, Exhausted> {
    let n = table.dimension();
    let mut action = vec![vec![0; n]; n];
    for (i, factor) in x.iter().enumerate() {
        let factor = field.integer(*factor);
        for (j, k, c) in table.brackets_of(i) {
            let Some(c) = field.rational(c) else {
                return Ok(None);
            };
            action[k][j] = field.plus(action[k][j], field.times(factor, c));
        }
    }
    let square = product(&action, &action, field)?;
    let mut power = square.clone();
    let mut traces = Vec::new();
    for k in 0..count {
        if k > 0 {
            power = product(&power, &square, field)?;
        }
        traces.push((0..n).fold(0, |sum, i| field.plus(sum, power[i][i])));
    }
    Ok(Some(traces))
}

fn product(
    left: &[Vec<u64>],
    right: &[Vec<u64>],
    field: &Prime<'_>,
) -> Result<Vec<Vec<u64>>, Exhausted> {
    let n = left.len() as u64;
    field.budget.spend(n * n * n)?;
    let of_row = |row: &Vec<u64>| {
        let mut sums = vec![0; row.len()];
        for (a, other) in row.iter().zip(right).filter(|(a, _)| **a != 0) {
            for (sum, b) in sums.iter_mut().zip(other) {
                *sum = field.plus(*sum, field.times(*a, *b));
            }
        }
        sums
    };
    Ok(left.iter().map(of_row).collect())
}

/// Whether the last trace is what the others say.
fn fits(series: Series, rank: usize, traces: &[u64], field: &Prime<'_>) -> Result<bool, Exhausted> {
    let power_of_four = |k: usize| (0..k).fold(1, |p, _| field.times(p, 4));
    let negative = |value: u64| field.negative(&value);
    // the multiple of P_k in the trace of order 2k, and the rest of that trace
    let own = |k: usize| {
        let four = power_of_four(k);
        let short = match series {
            Series::Orthogonal => 2,
            Series::Symplectic => field.times(2, four),
        };
        let pairs = field.plus(field.integer(4 * rank as i64), negative(four));
        field.plus(pairs, short)
    };
    let products = |k: usize, sums: &[u64]| {
        (1..k).fold(0, |sum, m| {
            let pair = field.times(sums[m - 1], sums[k - m - 1]);
            let factor = field.times(2, binomial(2 * k, 2 * m, field));
            field.plus(sum, field.times(factor, pair))
        })
    };
    let mut sums: Vec<u64> = Vec::new();
    for k in 1..=rank {
        let factor = own(k);
        if factor == 0 {
            return Ok(true);
        }
        let rest = field.plus(traces[k - 1], negative(products(k, &sums)));
        sums.push(field.times(rest, field.inverse(&factor)?));
    }
    sums.push(next_power_sum(&sums, field)?);
    let k = rank + 1;
    let expected = field.plus(field.times(own(k), sums[rank]), products(k, &sums));
    Ok(expected == traces[rank])
}

/// The power sum of order n + 1 of n numbers, from those of orders 1 to n, by Newton's identities.
fn next_power_sum(sums: &[u64], field: &Prime<'_>) -> Result<u64, Exhausted> {
    let signed = |i: usize, value: u64| {
        if i.is_multiple_of(2) {
            field.negative(&value)
        } else {
            value
        }
    };
    let mut elementary: Vec<u64> = vec![1];
    for k in 1..=sums.len() {
        let sum = (1..=k).fold(0, |sum, i| {
            let term = field.times(elementary[k - i], sums[i - 1]);
            field.plus(sum, signed(i, term))
        });
        let inverse = field.inverse(&field.integer(k as i64))?;
        elementary.push(field.times(sum, inverse));
    }
    let n = sums.len();
    Ok((1..=n).fold(0, |sum, i| {
        let term = field.times(elementary[i], sums[n - i]);
        field.plus(sum, signed(i, term))
    }))
}

fn binomial(n: usize, k: usize, field: &Prime<'_>) -> u64 {
    let mut row = vec![1_u64];
    for _ in 0..n {
        let inner = row.windows(2).map(|pair| field.plus(pair[0], pair[1]));
        row = std::iter::once(1)
            .chain(inner)
            .chain(std::iter::once(1))
            .collect();
    }
    row[k]
}
