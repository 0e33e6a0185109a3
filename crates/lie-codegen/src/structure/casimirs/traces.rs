//! An invariant of degree 4 without elimination: the trace of the fourth power of the adjoint representation.
//!
//! With the Killing form K of a semisimple algebra and `x = K^-1 mu`, the function `tr (ad_x)^4` is invariant. On su(n), n > 3, so(n),
//! n > 4 and not 8, and sp(2n), n > 1, it is independent of the quadratic Casimir (Okubo, Phys. Rev. D 16 (1977) 3528,
//! doi:10.1103/PhysRevD.16.3528). In a basis that mixes all elements, where every monomial occurs, this takes `n^6` operations where
//! elimination takes as many as the cube of the number of monomials.

use num_bigint::BigInt;

use super::field::{Field as _, PRIMES, Prime};
use super::invariants::Terms;
use super::kernel::Sparse;
use super::operators::{self, Operator, Word};
use super::residues::{combine, reconstructed};
use lie_symbolic::exact::{Budget, Exhausted, Rational};

/// The terms of `tr (ad_x)^4` up to a factor, by the operators of all basis elements; none where the Killing form is degenerate or the
/// numbers are too long.
pub fn fourth(
    adjoint: &[Operator<Rational>],
    budget: &Budget,
) -> Result<Option<Terms<Rational>>, Exhausted> {
    let n = adjoint.len();
    let words = operators::words(n, 4);
    let (mut modulus, mut residues) = (BigInt::from(1), Vec::new());
    for prime in PRIMES {
        let field = Prime { prime, budget };
        let Some(vector) = modulo(&field, adjoint, &words)? else {
            continue;
        };
        if vector.is_empty() {
            return Ok(None);
        }
        if residues.is_empty() {
            let first = vector.iter().map(|(c, v)| (*c, BigInt::from(*v)));
            residues = vec![first.collect::<Sparse<BigInt>>()];
        } else if !combine(&mut residues, &modulus, &[vector], prime) {
            continue;
        }
        modulus *= prime;
        let terms = residues[0]
            .iter()
            .map(|(column, value)| Some((words[*column], reconstructed(value, &modulus)?)));
        // a number that fits by chance does not do so modulo one prime more
        let fits = |(_, c): &(Word, Rational)| {
            let c = c.to_big();
            (c.numer().magnitude() * c.denom().magnitude()) << 80 < *modulus.magnitude()
        };
        if let Some(terms) = terms.collect::<Option<Terms<Rational>>>()
            && terms.iter().all(fits)
        {
            return Ok(Some(terms));
        }
    }
    Ok(None)
}

/// The operations modulo one prime for an algebra of this dimension.
pub fn cost(dimension: usize) -> u64 {
    let n = dimension as u64;
    let pairs = n * (n + 1) / 2;
    n.pow(5) + (n * pairs).pow(2) + n.pow(4)
}

/// The coefficients of the words modulo a prime, the first one that is not zero made one; `None` where the prime does not serve.
fn modulo(
    field: &Prime<'_>,
    adjoint: &[Operator<Rational>],
    words: &[Word],
) -> Result<Option<Sparse<u64>>, Exhausted> {
    let n = adjoint.len();
    let pairs = n * (n + 1) / 2;
    field.budget.spend(cost(n))?;
    let Some(constants) = matrices(field, adjoint) else {
        return Ok(None);
    };
    let Some(inverse) = inverse(field, killing(field, &constants, n), n)? else {
        return Ok(None);
    };
    // linear forms: entry (k, j) of ad_x by the coordinates of mu
    let mut linear = vec![0; n * n * n];
    for i in 0..n {
        for entry in 0..n * n {
            let constant = constants[i * n * n + entry];
            if constant != 0 {
                for l in 0..n {
                    let term = field.times(inverse[i * n + l], constant);
                    let place = &mut linear[entry * n + l];
                    *place = field.plus(*place, term);
                }
            }
        }
    }
    let square = squared(field, &linear, n);
    let mut product = vec![0; pairs * pairs];
    for k in 0..n {
        for j in 0..n {
            let one = &square[(k * n + j) * pairs..][..pairs];
            let other = &square[(j * n + k) * pairs..][..pairs];
            for (row, &factor) in product.chunks_exact_mut(pairs).zip(one) {
                for (place, &value) in row.iter_mut().zip(other) {
                    *place = field.plus(*place, field.times(factor, value));
                }
            }
        }
    }
    Ok(Some(scaled(field, by_words(field, &product, n, words))?))
}

/// The matrices of ad of all basis elements, `C_ij^k` at `(i n + k) n + j`; `None` where a denominator is zero.
fn matrices(field: &Prime<'_>, adjoint: &[Operator<Rational>]) -> Option<Vec<u64>> {
    let n = adjoint.len();
    let mut constants = vec![0; n * n * n];
    for (i, operator) in adjoint.iter().enumerate() {
        for (j, row) in operator.iter().enumerate() {
            for (k, constant) in row {
                constants[(i * n + k) * n + j] = field.rational(constant)?;
            }
        }
    }
    Some(constants)
}

/// `tr(ad_i ad_j)`.
fn killing(field: &Prime<'_>, constants: &[u64], n: usize) -> Vec<u64> {
    let mut form = vec![0; n * n];
    for i in 0..n {
        for j in 0..=i {
            let mut sum = 0;
            for a in 0..n {
                for b in 0..n {
                    let one = constants[(i * n + a) * n + b];
                    if one != 0 {
                        sum = field.plus(sum, field.times(one, constants[(j * n + b) * n + a]));
                    }
                }
            }
            form[i * n + j] = sum;
            form[j * n + i] = sum;
        }
    }
    form
}

/// The inverse of a matrix, by Gauss and Jordan; `None` where there is none.
fn inverse(
    field: &Prime<'_>,
    mut matrix: Vec<u64>,
    n: usize,
) -> Result<Option<Vec<u64>>, Exhausted> {
    let mut inverse = vec![0; n * n];
    (0..n).for_each(|i| inverse[i * n + i] = 1);
    for column in 0..n {
        let Some(pivot) = (column..n).find(|row| matrix[row * n + column] != 0) else {
            return Ok(None);
        };
        let factor = field.inverse(&matrix[pivot * n + column])?;
        for side in [&mut matrix, &mut inverse] {
            for k in 0..n {
                side.swap(pivot * n + k, column * n + k);
                side[column * n + k] = field.times(side[column * n + k], factor);
            }
        }
        for row in (0..n).filter(|row| *row != column) {
            let factor = field.negative(&matrix[row * n + column]);
            for side in [&mut matrix, &mut inverse] {
                for k in 0..n {
                    let term = field.times(factor, side[column * n + k]);
                    side[row * n + k] = field.plus(side[row * n + k], term);
                }
            }
        }
    }
    Ok(Some(inverse))
}

/// Where the product of two coordinates stands among those of degree 2.
fn pair(a: usize, b: usize) -> usize {
    let (low, high) = (a.min(b), a.max(b));
    high * (high + 1) / 2 + low
}

/// The square of a matrix of linear forms, each entry by [`pair`]s.
fn squared(field: &Prime<'_>, linear: &[u64], n: usize) -> Vec<u64> {
    let pairs = n * (n + 1) / 2;
    let mut square = vec![0; n * n * pairs];
    for k in 0..n {
        for j in 0..n {
            let out = &mut square[(k * n + j) * pairs..][..pairs];
            for m in 0..n {
                let one = &linear[(k * n + m) * n..][..n];
                let other = &linear[(m * n + j) * n..][..n];
                for (a, &factor) in one.iter().enumerate().filter(|(_, v)| **v != 0) {
                    for (b, &value) in other.iter().enumerate() {
                        let place = &mut out[pair(a, b)];
                        *place = field.plus(*place, field.times(factor, value));
                    }
                }
            }
        }
    }
    square
}

/// The coefficient of each word of four variables: the sum over the ways to take it apart into two pairs in order.
fn by_words(field: &Prime<'_>, product: &[u64], n: usize, words: &[Word]) -> Vec<u64> {
    let pairs = n * (n + 1) / 2;
    let coefficient = |word: &Word| {
        let v = |place: usize| usize::from(word[place]) - 1;
        let mut ways: Vec<(usize, usize)> = [(0, 1, 2, 3), (0, 2, 1, 3), (0, 3, 1, 2)]
            .into_iter()
            .flat_map(|(a, b, c, d)| {
                let (one, other) = (pair(v(a), v(b)), pair(v(c), v(d)));
                [(one, other), (other, one)]
            })
            .collect();
        ways.sort_unstable();
        ways.dedup();
        let values = ways.iter().map(|(one, other)| product[one * pairs + other]);
        values.fold(0, |sum, value| field.plus(sum, value))
    };
    words.iter().map(coefficient).collect()
}

/// What is not zero, the first of it made one.
fn scaled(field: &Prime<'_>, coefficients: Vec<u64>) -> Result<Sparse<u64>, Exhausted> {
    let Some(first) = coefficients.iter().find(|v| **v != 0) else {
        return Ok(Vec::new());
    };
    let factor = field.inverse(first)?;
    let entries = coefficients
        .into_iter()
        .enumerate()
        .filter(|(_, v)| *v != 0);
    Ok(entries.map(|(c, v)| (c, field.times(v, factor))).collect())
}

#[cfg(test)]
mod tests {
    use super::super::invariants::vanishes;
    use super::*;
    use crate::algebra::StructureConstants;
    use crate::algebra::known::{self, from_matrices, mixed};
    use lie_symbolic::exact::Fraction;

    fn operators_of(constants: &StructureConstants<Fraction>) -> Vec<Operator<Rational>> {
        let all: Vec<usize> = (0..constants.dimension()).collect();
        operators::operators(constants, &all, Fraction::as_constant, |v| -v).expect("no parameters")
    }

    #[test]
    fn the_trace_is_invariant_in_any_basis() {
        let budget = Budget::new(100_000_000);
        for matrices in [known::su(3), mixed(&known::su(3), 2018)] {
            let adjoint = operators_of(&from_matrices(&matrices));
            let terms = fourth(&adjoint, &budget).unwrap().expect("semisimple");
            let invariant = |terms: &Terms<Rational>| {
                let kept = |operator| vanishes(operator, terms, &budget).unwrap();
                adjoint.iter().all(kept)
            };
            assert!(invariant(&terms));
            // the control: another coefficient
            let mut wrong = terms;
            wrong[1].1 = &wrong[1].1 + &Rational::ONE;
            assert!(!invariant(&wrong));
        }
    }

    #[test]
    fn a_degenerate_killing_form_has_none() {
        let budget = Budget::new(100_000_000);
        let se3 = operators_of(&known::constants(known::SE3));
        assert_eq!(fourth(&se3, &budget), Ok(None));
        let so3 = operators_of(&known::constants(known::SO3));
        assert_eq!(fourth(&so3, &Budget::new(10)), Err(Exhausted));
    }
}
