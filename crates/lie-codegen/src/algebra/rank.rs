//! The rank of the Poisson matrix `Pi_ab(mu) = -C_ab^k mu_k`: generic by a prime field, exactly at rational points.
//!
//! The generic rank is the maximum over all points, and that of a matrix modulo a prime is never above it; `dimension - rank` is the number of
//! functionally independent Casimirs near a generic point (Beltrametti and Blasi, Phys. Lett. 20
//! (1966) 62, doi:10.1016/0031-9163(66)91048-1).

use super::StructureConstants;
use lie_symbolic::exact::{Fraction, Polynomial, Rational, Residue, elimination, matrix};

/// Points of the prime field at which the generic rank is looked for. At each the determinant of a maximal
/// minor vanishes with probability below degree / 2^61.
const POINTS: usize = 2;

/// The generic rank. `bound` is a known upper bound, such as the dimension minus the number of
/// independent Casimirs; the rank is even, so an odd bound is lowered by one.
pub fn generic_rank(constants: &StructureConstants<Fraction>, bound: usize) -> usize {
    let bound = bound & !1;
    let mut best = 0;
    let mut state = 0x9e37_79b9_7f4a_7c15u64;
    for _ in 0..POINTS {
        let mut draw = |count: usize| (0..count).map(|_| residue(&mut state)).collect();
        let mu: Vec<Residue> = draw(constants.dimension());
        let parameters: Vec<Residue> = draw(parameter_count(constants));
        if let Some(rows) = modulo_prime(constants, &mu, &parameters) {
            best = best.max(elimination::rank(rows));
        }
        if best >= bound {
            break;
        }
    }
    best
}

/// The matrix at a point of the prime field; `None` where a constant has a pole there.
fn modulo_prime(
    constants: &StructureConstants<Fraction>,
    mu: &[Residue],
    parameters: &[Residue],
) -> Option<Vec<Vec<Residue>>> {
    let n = constants.dimension();
    let mut rows = vec![vec![Residue::ZERO; n]; n];
    let polynomial = |p: &Polynomial| {
        let mut sum = Residue::ZERO;
        for (monomial, coefficient) in p.terms() {
            let mut product = Residue::from_rational(coefficient)?;
            for (v, e) in monomial.powers() {
                product = product.times(parameters.get(v)?.power(i64::from(e))?);
            }
            sum = sum.plus(product);
        }
        Some(sum)
    };
    for (i, j, k, constant) in constants.entries() {
        let mut entry = polynomial(constant.numerator())?.times(mu[*k]);
        for (factor, exponent) in constant.denominator() {
            entry = entry.times(polynomial(factor)?.power(-i64::from(exponent))?);
        }
        rows[*i][*j] = rows[*i][*j].minus(entry);
        rows[*j][*i] = rows[*j][*i].plus(entry);
    }
    Some(rows)
}

/// The rank at a point and at values of the parameters; `None` where a constant has a pole there.
pub fn rank_at(
    constants: &StructureConstants<Fraction>,
    mu: &[Rational],
    parameters: &[Rational],
    bound: usize,
) -> Option<usize> {
    let n = constants.dimension();
    let mut rows = vec![vec![Rational::ZERO; n]; n];
    let value = |p: usize| parameters.get(p).cloned().unwrap_or(Rational::ZERO);
    for (i, j, k, constant) in constants.entries() {
        let entry = &constant.evaluate(&value)? * &mu[*k];
        rows[*i][*j] = &rows[*i][*j] - &entry;
        rows[*j][*i] = &rows[*j][*i] + &entry;
    }
    Some(matrix::rank(&rows, bound.min(n) & !1))
}

/// One more than the largest parameter index in use.
fn parameter_count(constants: &StructureConstants<Fraction>) -> usize {
    let factors = |f: &Fraction| {
        let below = f.denominator().map(|(p, _)| p.clone());
        let polynomials: Vec<_> = below.chain([f.numerator().clone()]).collect();
        polynomials
            .iter()
            .flat_map(|p| {
                p.terms()
                    .flat_map(|(m, _)| m.powers().map(|(v, _)| v + 1))
                    .collect::<Vec<_>>()
            })
            .max()
            .unwrap_or(0)
    };
    constants
        .entries()
        .iter()
        .map(|(.., value)| factors(value))
        .max()
        .unwrap_or(0)
}

/// A number of the prime field (xorshift; the points are the same in every run).
fn residue(state: &mut u64) -> Residue {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    Residue::from_bits(*state)
}
