//! Normal forms of invariants: integer coefficients without common divisor, that of the highest monomial positive.

use std::collections::BTreeMap;

use super::operators::{self, Word};
use lie_symbolic::exact::{Budget, Exhausted, Fraction, Monomial, Polynomial, Rational};

/// The highest monomial, by which functions of equal length are ordered: those of early variables first.
pub fn largest(function: &Polynomial) -> std::cmp::Reverse<Option<Monomial>> {
    std::cmp::Reverse(function.leading().map(|(monomial, _)| monomial.clone()))
}

fn monomial(word: &Word, unit: Option<usize>) -> Monomial {
    let powers = operators::powers(word).filter(|(v, ..)| Some(*v) != unit);
    powers.fold(Monomial::default(), |product, (v, e, _)| {
        product.mul(&Monomial::power(v, e)).unwrap_or_default()
    })
}

/// Integer coefficients without common divisor, that of the highest monomial positive.
pub fn normal_rational(terms: &[(Word, Rational)], unit: Option<usize>) -> Polynomial {
    let mut sum = Polynomial::default();
    for (word, coefficient) in terms {
        sum.accumulate(monomial(word, unit), coefficient);
    }
    primitive(&sum)
}

/// A function by its terms.
pub fn sum_of(terms: &[(Word, Rational)]) -> Polynomial {
    let mut sum = Polynomial::default();
    for (word, coefficient) in terms {
        sum.accumulate(monomial(word, None), coefficient);
    }
    sum
}

/// The multiple with integer coefficients without common divisor, that of the highest monomial positive.
pub fn primitive(function: &Polynomial) -> Polynomial {
    let content = function.content().abs();
    let negative = function.leading().is_some_and(|(_, c)| c.is_negative());
    let factor = content.recip().unwrap_or(Rational::ONE);
    function.scale(&if negative { -&factor } else { factor })
}

/// The same of coefficients with parameters: without denominators, parameter p the variable n + p.
pub fn normal(
    terms: &[(Word, Fraction)],
    dimension: usize,
    unit: Option<usize>,
    budget: &Budget,
) -> Result<Polynomial, Exhausted> {
    let terms = terms
        .iter()
        .map(|(word, c)| (monomial(word, unit), c.clone()));
    cleared(&terms.collect::<Vec<_>>(), dimension, budget)
}

/// The same of a function by its monomials.
pub fn cleared(
    terms: &[(Monomial, Fraction)],
    dimension: usize,
    budget: &Budget,
) -> Result<Polynomial, Exhausted> {
    let mut below: BTreeMap<Polynomial, u32> = BTreeMap::new();
    for (_, coefficient) in terms {
        for (factor, exponent) in coefficient.denominator() {
            let most = below.entry(factor.clone()).or_insert(0);
            *most = exponent.max(*most);
        }
    }
    let mut common = Fraction::from(Rational::ONE);
    for (factor, exponent) in below {
        common = common.mul(&factor.pow(exponent, budget)?.into(), budget)?;
    }
    let mut sum = Polynomial::default();
    for (monomial, coefficient) in terms {
        let cleared = coefficient.mul(&common, budget)?;
        for (parameters, value) in cleared.numerator().terms() {
            let mut product = monomial.clone();
            for (v, e) in parameters.powers() {
                product = product.mul(&Monomial::power(dimension + v, e))?;
            }
            sum.accumulate(product, value);
        }
    }
    let monomial = sum.monomial_content();
    let parameters = monomial.powers().filter(|(v, _)| *v >= dimension);
    let common = parameters.fold(Monomial::default(), |product, (v, e)| {
        product.mul(&Monomial::power(v, e)).unwrap_or_default()
    });
    Ok(primitive(&sum.strip(&common)))
}
