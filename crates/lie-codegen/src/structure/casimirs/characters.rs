//! Monomials that no invariant of a semisimple algebra has.
//!
//! A character of order two of the grading changes the signs of basis elements, which is an automorphism. Invariants are left alone by
//! an inner one, so that none has a monomial whose sign it changes. It is inner where the elements whose signs it keeps
//! have the rank of the algebra, and contain a Cartan subalgebra (Kac, Infinite-dimensional Lie algebras, chapter 8): reflections of the axes
//! of so(n) in pairs are, a single one of so(2m) is not, and there is the Pfaffian.

use super::field::Prime;
use super::grading::Grading;
use super::operators::{Echelon, Operator, Word, powers};
use crate::algebra::{StructureConstants, rank};
use lie_symbolic::exact::{Exhausted, Fraction};

/// Of the budget, so much may be taken to see whether an algebra is semisimple.
const SHARE: u64 = 16;

/// The grading of an algebra, the operators of which are given modulo a prime, and its signs.
pub fn graded(
    constants: &StructureConstants<Fraction>,
    table: &[Operator<u64>],
    field: &Prime<'_>,
) -> Result<Option<(Grading, Signs)>, Exhausted> {
    let places = constants.entries().iter().map(|(i, j, k, _)| (*i, *j, *k));
    let grading = Grading::new(constants.dimension(), places, field.budget)?;
    let with_signs = |grading: Grading| {
        let signs = Signs::new(constants, &grading, table, field)?;
        Ok((grading, signs))
    };
    grading.map(with_signs).transpose()
}

/// The signs that inner automorphisms change.
#[derive(Debug)]
pub struct Signs(Vec<u64>);

impl Signs {
    /// Those of an algebra; none where it is not semisimple.
    fn new(
        constants: &StructureConstants<Fraction>,
        grading: &Grading,
        table: &[Operator<u64>],
        field: &Prime<'_>,
    ) -> Result<Self, Exhausted> {
        let n = constants.dimension();
        let mut signs = Self(vec![0; n]);
        let characters = grading.characters(n);
        if characters.is_empty() || !semisimple(table, field)? {
            return Ok(signs);
        }
        let whole = index(constants, &vec![false; n]);
        let mut count = 0;
        let mut outer: Option<Vec<bool>> = None;
        for mut character in characters.into_iter().take(u64::BITS as usize) {
            let mut inner = index(constants, &character) == whole;
            match &outer {
                // the product of two outer ones may be inner
                Some(other) if !inner => {
                    character.iter_mut().zip(other).for_each(|(a, b)| *a ^= b);
                    inner = index(constants, &character) == whole;
                }
                None if !inner => outer = Some(character.clone()),
                _ => {}
            }
            if inner {
                let changed = signs.0.iter_mut().zip(character);
                changed.for_each(|(bits, sign)| *bits |= u64::from(sign) << count);
                count += 1;
            }
        }
        Ok(signs)
    }

    /// Whether an invariant may have a monomial.
    pub fn keep(&self, word: &Word) -> bool {
        let odd = powers(word).filter(|(_, exponent, _)| exponent % 2 == 1);
        odd.fold(0, |bits, (v, _, _)| bits ^ self.0[v]) == 0
    }
}

/// The number of independent invariants of the subalgebra of the elements whose signs are kept.
fn index(constants: &StructureConstants<Fraction>, changed: &[bool]) -> usize {
    let kept = |i: &usize| !changed[*i];
    let entries = constants.entries().iter();
    let inside = entries.filter(|(i, j, _, _)| kept(i) && kept(j)).cloned();
    let n = constants.dimension();
    let inside = StructureConstants::new(n, inside.collect());
    let outside = changed.iter().filter(|changed| **changed).count();
    n - outside - rank::generic_rank(&inside, n)
}

/// Whether the Killing form has full rank, as far as it is cheap to see.
fn semisimple(table: &[Operator<u64>], field: &Prime<'_>) -> Result<bool, Exhausted> {
    let n = table.len();
    let lengths = |l: usize| {
        table
            .iter()
            .map(|operator| operator[l].len())
            .sum::<usize>()
    };
    let lengths: Vec<usize> = (0..n).map(lengths).collect();
    let entries = table.iter().flatten().flatten();
    let cost = entries.map(|(l, _)| lengths[*l] as u64).sum::<u64>();
    if cost > field.budget.left() / SHARE {
        return Ok(false);
    }
    field.budget.spend(cost)?;
    let mut form = Echelon::new(n);
    for a in table {
        let entry = |b: &Operator<u64>| {
            let mut sum = 0;
            for (k, row) in a.iter().enumerate() {
                for (l, c) in row {
                    for (_, d) in b[*l].iter().filter(|(m, _)| *m == k) {
                        sum = field.plus(sum, field.times(*c, *d));
                    }
                }
            }
            sum
        };
        if !form.insert(field, table.iter().map(entry).collect())? {
            return Ok(false);
        }
    }
    Ok(true)
}
