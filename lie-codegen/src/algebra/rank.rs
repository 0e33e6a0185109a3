//! The rank of the Poisson matrix `Pi_ab(mu) = -C_ab^k mu_k`, exactly at rational points.
//!
//! The generic rank is the maximum over all points; `dimension - rank` is the number of
//! functionally independent Casimirs near a generic point (Beltrametti and Blasi, Phys. Lett. 20
//! (1966) 62, doi:10.1016/0031-9163(66)91048-1).

use super::StructureConstants;
use crate::exact::{Fraction, Rational, matrix};

/// Points at which the generic rank is looked for. At each the determinant of a maximal minor
/// vanishes with probability below degree / 2000.
const POINTS: u64 = 4;

/// The generic rank. `bound` is a known upper bound, such as the dimension minus the number of
/// independent Casimirs; the rank is even, so an odd bound is lowered by one.
pub fn generic(constants: &StructureConstants<Fraction>, bound: usize) -> usize {
    let bound = bound & !1;
    let mut best = 0;
    let mut state = 0x9e37_79b9_7f4a_7c15u64;
    for _ in 0..POINTS {
        if best >= bound {
            break;
        }
        let mut draw = |count: usize| -> Vec<Rational> {
            (0..count).map(|_| small_integer(&mut state)).collect()
        };
        let mu = draw(constants.dimension());
        let parameters = draw(parameter_count(constants));
        if let Some(rank) = at(constants, &mu, &parameters, bound) {
            best = best.max(rank);
        }
    }
    best
}

/// The rank at a point and at values of the parameters; `None` where a constant has a pole there.
pub fn at(
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

/// An integer between -1000 and 1000, not zero (xorshift; the points are the same in every run).
fn small_integer(state: &mut u64) -> Rational {
    loop {
        *state ^= *state << 13;
        *state ^= *state >> 7;
        *state ^= *state << 17;
        let value = (*state >> 20) as i64 % 1001;
        let signed = if *state & 1 == 1 { -value } else { value };
        if signed != 0 {
            return Rational::from(signed);
        }
    }
}
