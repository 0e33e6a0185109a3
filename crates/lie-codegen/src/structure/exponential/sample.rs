//! The factors of the minimal polynomial at a random point, modulo a prime.

use super::operator::Operator;
use lie_symbolic::exact::{Fraction, Residue};

/// `z^a` times the rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Factors {
    pub nilpotent: usize,
    pub shape: Shape,
}

/// What the minimal polynomial has besides a power of z, and how often its root, or pair of roots, is an eigenvalue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    None,
    Linear { power: usize, count: usize },
    Quadratic { power: usize, count: usize },
}

/// Numbers that look random; always the same.
struct Draw(u64);

impl Draw {
    fn number(&mut self) -> Residue {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        Residue::from_bits(mixed ^ (mixed >> 31))
    }
}

/// A matrix over the residues, by its entries.
type Entries = Vec<(usize, usize, Residue)>;

/// The factors of the minimal polynomial, where they are of one of the forms.
pub(super) fn factors(operator: &Operator) -> Option<Factors> {
    let places = operator.coordinates();
    let matrix = at_random_point(operator, &places)?;
    let polynomial = minimal_polynomial(&matrix, places.len());
    let nilpotent = polynomial.iter().position(|c| !c.is_zero())?;
    let rest = &polynomial[nilpotent..];
    let degree = rest.len() - 1;
    if degree == 0 {
        let shape = Shape::None;
        return Some(Factors { nilpotent, shape });
    }
    let size = places.len();
    let is_even = rest.iter().skip(1).step_by(2).all(|c| c.is_zero());
    let shape = if degree.is_multiple_of(2) && is_even {
        let even: Vec<Residue> = rest.iter().copied().step_by(2).collect();
        let power = degree / 2;
        let root = power_of_binomial(&even)?;
        let trace = trace(&matrix, &matrix);
        let double = root.plus(root);
        let count = multiple(trace, Residue::ZERO.minus(double), size)?;
        Shape::Quadratic { power, count }
    } else {
        let root = power_of_binomial(rest)?;
        let trace = matrix.iter().filter(|(j, k, _)| j == k);
        let trace = trace.fold(Residue::ZERO, |sum, (.., value)| sum.plus(*value));
        let count = multiple(trace, Residue::ZERO.minus(root), size)?;
        Shape::Linear {
            power: degree,
            count,
        }
    };
    Some(Factors { nilpotent, shape })
}

/// The operator with its rows and columns numbered, at a random point of x and the parameters.
fn at_random_point(operator: &Operator, places: &[usize]) -> Option<Entries> {
    let x = |i: usize| Draw(i as u64 + 1).number();
    let place = |j: &usize| places.binary_search(j).ok();
    let entries = operator.entries.iter().map(|(j, k, form)| {
        let mut sum = Residue::ZERO;
        for (i, value) in form {
            sum = sum.plus(residue(value)?.times(x(*i)));
        }
        Some((place(j)?, place(k)?, sum))
    });
    entries.collect()
}

/// A rational function of the parameters at a random point.
fn residue(value: &Fraction) -> Option<Residue> {
    let parameter = |p: usize| Draw(!(p as u64)).number();
    let of = |polynomial: &lie_symbolic::exact::Polynomial| {
        let mut sum = Residue::ZERO;
        for (monomial, coefficient) in polynomial.terms() {
            let mut term = Residue::from_rational(coefficient)?;
            for (variable, exponent) in monomial.powers() {
                term = term.times(parameter(variable).power(exponent.into())?);
            }
            sum = sum.plus(term);
        }
        Some(sum)
    };
    let mut value_of = of(value.numerator())?;
    for (factor, exponent) in value.denominator() {
        value_of = value_of.times(of(factor)?.power(-i64::from(exponent))?);
    }
    Some(value_of)
}

/// The coefficients from the lowest on, the last 1, of the minimal polynomial, by the powers applied to a random vector.
fn minimal_polynomial(matrix: &Entries, size: usize) -> Vec<Residue> {
    let mut draw = Draw(2018);
    let mut vector: Vec<Residue> = (0..size).map(|_| draw.number()).collect();
    // rows in echelon form, each with the combination of powers that it is
    let mut rows: Vec<(usize, Vec<Residue>, Vec<Residue>)> = Vec::new();
    for power in 0..=size {
        let mut rest = vector.clone();
        let mut combination = vec![Residue::ZERO; power + 1];
        combination[power] = Residue::ONE;
        for (pivot, row, of_row) in &rows {
            let factor = rest[*pivot];
            subtract(&mut rest, row, factor);
            subtract(&mut combination, of_row, factor);
        }
        let Some(pivot) = rest.iter().position(|entry| !entry.is_zero()) else {
            return combination;
        };
        let inverse = rest[pivot].inverse().unwrap_or(Residue::ONE);
        let scaled = |all: Vec<Residue>| all.into_iter().map(|x| x.times(inverse)).collect();
        rows.push((pivot, scaled(rest), scaled(combination)));
        let mut next = vec![Residue::ZERO; size];
        for (j, k, value) in matrix {
            next[*j] = next[*j].plus(value.times(vector[*k]));
        }
        vector = next;
    }
    vec![Residue::ONE]
}

fn subtract(from: &mut [Residue], row: &[Residue], factor: Residue) {
    for (entry, value) in from.iter_mut().zip(row) {
        *entry = entry.minus(factor.times(*value));
    }
}

/// The number r with `sum_j coefficient_j z^j = (z + r)^b`.
fn power_of_binomial(coefficients: &[Residue]) -> Option<Residue> {
    let power = coefficients.len() - 1;
    let count = Residue::from_bits(power as u64);
    let root = coefficients[power - 1].times(count.inverse()?);
    let mut expected = vec![Residue::ONE];
    for _ in 0..power {
        let mut next = vec![Residue::ZERO; expected.len() + 1];
        for (j, value) in expected.iter().enumerate() {
            next[j] = next[j].plus(value.times(root));
            next[j + 1] = next[j + 1].plus(*value);
        }
        expected = next;
    }
    (expected == coefficients).then_some(root)
}

/// The trace of a product.
fn trace(left: &Entries, right: &Entries) -> Residue {
    let mut sum = Residue::ZERO;
    for (j, k, a) in left {
        for (_, _, b) in right
            .iter()
            .filter(|(row, column, _)| row == k && column == j)
        {
            sum = sum.plus(a.times(*b));
        }
    }
    sum
}

/// How often one number is the other, at most so often.
fn multiple(value: Residue, of: Residue, most: usize) -> Option<usize> {
    let ratio = value.times(of.inverse()?);
    (1..=most).find(|count| Residue::from_bits(*count as u64) == ratio)
}
