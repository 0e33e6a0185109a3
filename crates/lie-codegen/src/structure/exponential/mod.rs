//! Closed forms of functions of `ad*_x` for a general element x, by its minimal polynomial.
//!
//! The algebra is taken apart into ideals (`ideals`). In each the minimal polynomial of `A = ad*_x` over the rational
//! functions of x is looked for in one of the forms
//!
//! * `z^a`: functions of A are polynomials;
//! * `z^a (z - l)^b`, l a linear form in x: combinations of `phi_k(l)`;
//! * `z^a (z^2 + w)^b`, w a quadratic form in x: combinations of Stumpff functions of w, for any sign of w.
//!
//! Its exponents are read off at one random point modulo a prime (`sample`). The traces of A and `A^2` give the form
//! exactly, and that the polynomial annihilates A is proven over the rational functions. A wrong guess modulo the prime costs a
//! closed form, never a digit.

mod ideals;
mod operator;
mod sample;

use crate::algebra::StructureConstants;
use ideals::{Ideal, ideals};
use lie_symbolic::exact::{Budget, Exhausted, Fraction, Rational};
use operator::Operator;
use sample::{Factors, Shape, factors};

/// Work allowed for the proofs of one algebra.
const WORK: u64 = 3_000_000;
/// Larger algebras are left to the series.
const LARGEST: usize = 256;
/// `a + 2 b` of the largest minimal polynomial whose functions are tabulated, with two derivatives.
const HIGHEST: usize = 8;

/// Functions of `ad*_x` as a sum over ideals.
#[derive(Clone, Debug)]
pub struct Exponential {
    /// The ideals on which x acts.
    pub summands: Vec<Summand>,
}

/// An ideal, and the minimal polynomial `z^a` times a factor of `ad*_x` on it.
#[derive(Clone, Debug)]
pub struct Summand {
    /// Its coordinates.
    pub coordinates: Vec<usize>,
    /// The projection onto the ideal's part of the dual, `(row, column, value)`, where other ideals have the same coordinates.
    pub projection: Option<Vec<(usize, usize, Rational)>>,
    /// The exponent a.
    pub nilpotent: usize,
    /// The other factor.
    pub factor: Factor,
    /// For each power of the other factor's base below its exponent, the rows of `A^a` times it that do not vanish: those
    /// of a quotient by an ideal in which the exponent is smaller.
    pub supports: Vec<Vec<usize>>,
}

/// What the minimal polynomial has besides a power of z.
#[derive(Clone, Debug)]
pub enum Factor {
    /// Nothing.
    None,
    /// `(z - l)^b`: the coefficients of l, and b.
    Linear(Vec<(usize, Fraction)>, usize),
    /// `(z^2 + w)^b`: the coefficients of `x_i x_j`, `i <= j`, in w, and b.
    Quadratic(Vec<(usize, usize, Fraction)>, usize),
}

/// The closed form for an algebra, where every ideal has one.
pub fn closed_form(constants: &StructureConstants<Fraction>) -> Option<Exponential> {
    if constants.dimension() > LARGEST {
        return None;
    }
    let budget = Budget::new(WORK);
    let operator = Operator::coadjoint(constants);
    let mut summands = Vec::new();
    for component in operator.components() {
        summands.extend(of_component(component, &budget).ok()??);
    }
    Some(Exponential { summands })
}

/// The closed form for the elements x of a subalgebra that some basis elements span.
pub fn closed_form_on(
    constants: &StructureConstants<Fraction>,
    elements: &[usize],
) -> Option<Exponential> {
    if constants.dimension() > LARGEST {
        return None;
    }
    let budget = Budget::new(WORK);
    let operator = Operator::coadjoint(constants).restricted(elements);
    let components = operator.components().into_iter();
    let summands = components.map(|component| summand(&component, &budget).ok()?);
    Some(Exponential {
        summands: summands.collect::<Option<_>>()?,
    })
}

/// The summands of the operator on coordinates that no others act on: itself, or ideals that share these coordinates.
fn of_component(operator: Operator, budget: &Budget) -> Result<Option<Vec<Summand>>, Exhausted> {
    if let Some(summand) = summand(&operator, budget)? {
        return Ok(Some(vec![summand]));
    }
    let Some(ideals) = ideals(&operator, budget)? else {
        return Ok(None);
    };
    let coordinates = operator.coordinates();
    let mut summands = Vec::new();
    for Ideal {
        operator,
        projection,
    } in ideals
    {
        let Some(summand) = summand(&operator, budget)? else {
            return Ok(None);
        };
        summands.push(Summand {
            supports: vec![coordinates.clone(); summand.supports.len()],
            coordinates: coordinates.clone(),
            projection: Some(projection),
            ..summand
        });
    }
    Ok(Some(summands))
}

/// The minimal polynomial of an operator in one of the forms, with proof.
fn summand(operator: &Operator, budget: &Budget) -> Result<Option<Summand>, Exhausted> {
    let Some(Factors { nilpotent, shape }) = factors(operator) else {
        return Ok(None);
    };
    // x commutes with itself, so that 0 is a root; where it is none of this part, another factor z does no harm
    let nilpotent = nilpotent.max(1);
    let power = match shape {
        Shape::None => 0,
        Shape::Linear { power, .. } => power,
        Shape::Quadratic { power, .. } => 2 * power,
    };
    if nilpotent + power > HIGHEST {
        return Ok(None);
    }
    let factor = match shape {
        Shape::None => Factor::None,
        Shape::Linear { power, count } => {
            let inverse = Rational::new(1, count as i64).unwrap_or(Rational::ONE);
            let trace = operator.trace(budget)?;
            let scaled = trace.into_iter().map(|(i, c)| (i, c.scale(&inverse)));
            Factor::Linear(scaled.collect(), power)
        }
        Shape::Quadratic { power, count } => {
            let inverse = Rational::new(-1, 2 * count as i64).unwrap_or(Rational::ONE);
            let trace = operator.trace_of_square(budget)?;
            let scaled = trace.into_iter().map(|(i, j, c)| (i, j, c.scale(&inverse)));
            Factor::Quadratic(scaled.collect(), power)
        }
    };
    let supports = operator.supports(nilpotent, &factor, budget)?;
    Ok(supports.map(|supports| Summand {
        coordinates: operator.coordinates(),
        projection: None,
        nilpotent,
        factor,
        supports,
    }))
}

#[cfg(test)]
mod tests;
