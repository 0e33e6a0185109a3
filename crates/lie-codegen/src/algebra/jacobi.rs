//! The Jacobi identity, exactly and identically in the exact parameters.

use std::collections::BTreeMap;

use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::One;

use super::StructureConstants;
use super::ring::Ring;
use lie_symbolic::exact::{Budget, Exhausted, Fraction, Rational};
use lie_syntax::ast::Algebra;
use lie_syntax::diagnostic::{Diagnostic, Kind};
use lie_syntax::linear::Scope;

/// Longer common denominators cost more than they save.
const MAX_DENOMINATOR_BITS: u64 = 1024;

/// A triple for which the identity fails.
#[derive(Clone, Debug)]
pub struct Failure {
    /// The basis indices, ascending.
    pub triple: (usize, usize, usize),
    /// `[[e_i, e_j], e_l] + [[e_j, e_l], e_i] + [[e_l, e_i], e_j]`, nonzero coefficients by index.
    pub residual: Vec<(usize, Fraction)>,
    /// How many triples fail.
    pub count: usize,
}

/// The first triple for which the Jacobi identity fails. A bracket that violates it has no
/// coadjoint orbits: the flow would not conserve anything that it is generated to conserve.
pub fn violation(
    algebra: &Algebra,
    constants: &StructureConstants<Fraction>,
    scope: &Scope<'_>,
    budget: &Budget,
) -> Option<Diagnostic> {
    match first_failure(constants, budget) {
        Ok(failure) => Some(diagnostic(algebra, scope, &failure?)),
        Err(Exhausted) => {
            let message = "the algebra is too large for the exact check of the Jacobi identity";
            let limit = Diagnostic::new(Kind::Limit, algebra.origin, message);
            Some(limit.help(
                "choose a basis with fewer nonzero structure constants, or simpler coefficients",
            ))
        }
    }
}

/// The first triple for which the identity fails.
///
/// # Errors
/// [`Exhausted`] where the budget is too small for all triples.
pub fn first_failure(
    constants: &StructureConstants<Fraction>,
    budget: &Budget,
) -> Result<Option<Failure>, Exhausted> {
    let Some(rationals) = constants.try_map(Fraction::as_constant) else {
        return search(constants, budget);
    };
    // The identity is homogeneous: with integers no sum needs a common denominator.
    let mut common = BigInt::one();
    for (.., value) in rationals.entries() {
        common = common.lcm(value.to_big().denom());
        if common.bits() > MAX_DENOMINATOR_BITS {
            return search(&rationals, budget);
        }
    }
    let integers = rationals.map(|value| (value.to_big() * &common).to_integer());
    let scale = Rational::from_big(BigInt::one(), &common * &common).unwrap_or(Rational::ONE);
    Ok(search(&integers, budget)?.map(|mut failure| {
        for (_, value) in &mut failure.residual {
            *value = value.scale(&scale);
        }
        failure
    }))
}

fn search<T: Ring>(
    constants: &StructureConstants<T>,
    budget: &Budget,
) -> Result<Option<Failure>, Exhausted> {
    let n = constants.dimension();
    let table = constants.table();
    let mut first: Option<Failure> = None;
    for i in 0..n {
        for j in i + 1..n {
            budget.spend((n - j) as u64 / 16 + 1)?;
            for l in j + 1..n {
                if table[i][j].is_empty() && table[j][l].is_empty() && table[l][i].is_empty() {
                    continue;
                }
                let mut residual: BTreeMap<usize, T> = BTreeMap::new();
                for (a, b, c) in [(i, j, l), (j, l, i), (l, i, j)] {
                    for (p, value) in &table[a][b] {
                        for (m, factor) in &table[*p][c] {
                            residual
                                .entry(*m)
                                .or_insert_with(T::zero)
                                .add_product(value, factor, budget)?;
                        }
                    }
                }
                residual.retain(|_, value| !value.is_zero());
                if residual.is_empty() {
                    continue;
                }
                match &mut first {
                    Some(failure) => failure.count += 1,
                    None => {
                        let residual = residual
                            .iter()
                            .map(|(m, value)| (*m, value.to_fraction()))
                            .collect();
                        first = Some(Failure {
                            triple: (i, j, l),
                            residual,
                            count: 1,
                        });
                    }
                }
            }
        }
    }
    Ok(first)
}

fn diagnostic(algebra: &Algebra, scope: &Scope<'_>, failure: &Failure) -> Diagnostic {
    let (i, j, l) = failure.triple;
    let [a, b, c] = [i, j, l].map(|index| scope.basis()[index]);
    let residual = scope.display(&failure.residual);
    let mut message = format!(
        "the Jacobi identity fails for ({a}, {b}, {c}): [[{a}, {b}], {c}] + [[{b}, {c}], {a}] + [[{c}, {a}], {b}] = {residual}"
    );
    match failure.count {
        1 => {}
        2 => message.push_str("; it fails for one other triple too"),
        count => message.push_str(&format!("; it fails for {} other triples too", count - 1)),
    }
    let parametric = failure
        .residual
        .iter()
        .any(|(_, value)| value.as_constant().is_none());
    Diagnostic::new(Kind::Jacobi, algebra.origin, message).help(if parametric {
        "the residual must vanish identically in the exact parameters; check the brackets of these three elements and those that they lead to"
    } else {
        "check the sign and the coefficient of the brackets of these three elements and those that they lead to; a bracket that is left out is zero"
    })
}
