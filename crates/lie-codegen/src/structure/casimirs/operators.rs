//! The coadjoint action on monomials: `X_i = sum_jk C_ij^k mu_k d/dmu_j`, of as few i as generate the algebra.

use rustc_hash::FxHashMap;

use super::field::{Field, Prime};
use super::kernel::Sparse;
use crate::algebra::StructureConstants;
use lie_symbolic::exact::{Exhausted, Fraction};

/// The largest degree of a monomial.
pub const MAX_DEGREE: usize = 12;

/// A monomial: its variables, one more than their numbers, ascending; zeros behind them.
pub type Word = [u8; MAX_DEGREE];

/// An operator by the variable j that it replaces: `(k, coefficient)`.
pub type Operator<T> = Vec<Vec<(usize, T)>>;

/// The word with a variable at a place replaced by another.
pub fn replaced(word: &Word, place: usize, by: usize) -> Word {
    let mut result = *word;
    let value = by as u8 + 1;
    let mut at = place;
    while at > 0 && result[at - 1] > value {
        result[at] = result[at - 1];
        at -= 1;
    }
    while at + 1 < MAX_DEGREE && result[at + 1] != 0 && result[at + 1] < value {
        result[at] = result[at + 1];
        at += 1;
    }
    result[at] = value;
    result
}

/// The variables of a word with their exponents and the first place of each.
pub fn powers(word: &Word) -> impl Iterator<Item = (usize, u32, usize)> + '_ {
    let mut place = 0;
    std::iter::from_fn(move || {
        let value = *word.get(place).filter(|v| **v != 0)?;
        let first = place;
        while place < MAX_DEGREE && word[place] == value {
            place += 1;
        }
        Some((usize::from(value) - 1, (place - first) as u32, first))
    })
}

/// All monomials of a degree.
pub fn words(dimension: usize, degree: usize) -> Vec<Word> {
    let mut all = vec![([0; MAX_DEGREE], 1u8)];
    for place in 0..degree {
        let mut longer = Vec::with_capacity(all.len() * 2);
        for (word, least) in all {
            for value in least..=dimension as u8 {
                let mut word = word;
                word[place] = value;
                longer.push((word, value));
            }
        }
        all = longer;
    }
    all.into_iter().map(|(word, _)| word).collect()
}

/// The number of monomials of a degree.
pub fn count(dimension: usize, degree: usize) -> u64 {
    let mut count = 1u64;
    for i in 0..degree as u64 {
        count = count.saturating_mul(dimension as u64 + i) / (i + 1);
    }
    count
}

/// The operators of basis elements in a field, `None` at a pole.
pub fn operators<T: Clone>(
    constants: &StructureConstants<Fraction>,
    of: &[usize],
    convert: impl Fn(&Fraction) -> Option<T>,
    negative: impl Fn(&T) -> T,
) -> Option<Vec<Operator<T>>> {
    let mut operators = vec![vec![Vec::new(); constants.dimension()]; of.len()];
    for (i, j, k, constant) in constants.entries() {
        let value = convert(constant)?;
        for (place, index) in of.iter().enumerate() {
            if index == i {
                operators[place][*j].push((*k, value.clone()));
            } else if index == j {
                operators[place][*i].push((*k, negative(&value)));
            }
        }
    }
    Some(operators)
}

/// The matrix of an operator on functions with these monomials, by rows: one for each monomial of the image.
pub fn rows<F: Field>(
    field: &F,
    operator: &Operator<F::Value>,
    monomials: &[Word],
) -> Result<Vec<Sparse<F::Value>>, Exhausted> {
    let mut places: FxHashMap<Word, usize> = FxHashMap::default();
    let mut rows: Vec<Sparse<F::Value>> = Vec::new();
    for (column, word) in monomials.iter().enumerate() {
        for (j, exponent, place) in powers(word) {
            let times = field.integer(i64::from(exponent));
            field.budget().spend(4 * operator[j].len() as u64)?;
            for (k, coefficient) in &operator[j] {
                let value = field.product(&times, coefficient)?;
                let target = replaced(word, place, *k);
                let row = *places.entry(target).or_insert_with(|| {
                    rows.push(Vec::new());
                    rows.len() - 1
                });
                match rows[row].last_mut().filter(|(last, _)| *last == column) {
                    Some((_, last)) => *last = field.sum(last, &value)?,
                    None => rows[row].push((column, value)),
                }
            }
        }
    }
    for row in &mut rows {
        row.retain(|(_, value)| !field.is_zero(value));
    }
    rows.retain(|row| !row.is_empty());
    Ok(rows)
}

/// Basis elements that generate the algebra, modulo a prime and hence over the rationals: a function that they leave
/// alone is an invariant. The operators of `skipped`, a central element, are zero.
pub fn generators(field: &Prime<'_>, table: &[Operator<u64>]) -> Result<Vec<usize>, Exhausted> {
    let n = table.len();
    let mut chosen: Vec<usize> = Vec::new();
    let mut closure = Echelon::new(n);
    for i in 0..n {
        if closure.rank() == n {
            break;
        }
        let mut unit = vec![0; n];
        unit[i] = 1;
        if !closure.is_new(field, &unit)? {
            continue;
        }
        chosen.push(i);
        closure = Echelon::new(n);
        let mut open: Vec<Vec<u64>> = Vec::new();
        for &c in &chosen {
            let mut unit = vec![0; n];
            unit[c] = 1;
            open.push(unit);
        }
        while let Some(vector) = open.pop() {
            if !closure.insert(field, vector.clone())? {
                continue;
            }
            for &c in &chosen {
                open.push(image(field, &table[c], &vector)?);
            }
        }
    }
    chosen.retain(|&i| table[i].iter().any(|row| !row.is_empty()));
    Ok(chosen)
}

/// `[e, v]` by the operator of e.
pub fn image(
    field: &Prime<'_>,
    operator: &Operator<u64>,
    vector: &[u64],
) -> Result<Vec<u64>, Exhausted> {
    let mut value = vec![0; vector.len()];
    field.budget.spend(vector.len() as u64)?;
    for (j, factor) in vector.iter().enumerate().filter(|(_, f)| **f != 0) {
        for (k, c) in &operator[j] {
            value[*k] = field.plus(value[*k], field.times(*factor, *c));
        }
    }
    Ok(value)
}

/// Rows modulo a prime in echelon form.
#[derive(Clone, Debug)]
pub struct Echelon {
    rows: Vec<(usize, Vec<u64>)>,
    columns: usize,
}

impl Echelon {
    /// No rows.
    pub fn new(columns: usize) -> Self {
        Self {
            rows: Vec::new(),
            columns,
        }
    }

    /// The number of rows.
    pub fn rank(&self) -> usize {
        self.rows.len()
    }

    fn reduced(&self, field: &Prime<'_>, mut row: Vec<u64>) -> Result<Vec<u64>, Exhausted> {
        debug_assert_eq!(row.len(), self.columns);
        for (pivot, other) in &self.rows {
            if row[*pivot] != 0 {
                field.budget.spend(self.columns as u64)?;
                let factor = field.negative(&row[*pivot]);
                for (entry, value) in row.iter_mut().zip(other).filter(|(_, v)| **v != 0) {
                    *entry = field.plus(*entry, field.times(factor, *value));
                }
            }
        }
        Ok(row)
    }

    /// Whether a row is no combination of those that are there.
    pub fn is_new(&self, field: &Prime<'_>, row: &[u64]) -> Result<bool, Exhausted> {
        Ok(self.reduced(field, row.to_vec())?.iter().any(|v| *v != 0))
    }

    /// Adds a row; whether it was new.
    pub fn insert(&mut self, field: &Prime<'_>, row: Vec<u64>) -> Result<bool, Exhausted> {
        let mut row = self.reduced(field, row)?;
        let Some(pivot) = row.iter().position(|v| *v != 0) else {
            return Ok(false);
        };
        let inverse = field.inverse(&row[pivot])?;
        row.iter_mut()
            .filter(|v| **v != 0)
            .for_each(|v| *v = field.times(*v, inverse));
        self.rows.push((pivot, row));
        Ok(true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_stay_sorted() {
        assert_eq!(words(3, 2).len() as u64, count(3, 2));
        assert_eq!(words(10, 4).len() as u64, count(10, 4));
        let word = |variables: &[u8]| {
            let mut word = [0; MAX_DEGREE];
            word[..variables.len()].copy_from_slice(variables);
            word
        };
        let w = word(&[1, 2, 2, 4]);
        assert_eq!(replaced(&w, 1, 0), word(&[1, 1, 2, 4]));
        assert_eq!(replaced(&w, 0, 4), word(&[2, 2, 4, 5]));
        assert_eq!(replaced(&w, 3, 1), word(&[1, 2, 2, 2]));
        let found: Vec<_> = powers(&w).collect();
        assert_eq!(found, [(0, 1, 0), (1, 2, 1), (3, 1, 3)]);
    }
}
