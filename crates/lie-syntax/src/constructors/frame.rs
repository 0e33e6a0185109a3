//! Coordinates in a basis of sparse matrices, by an echelon form.

use std::collections::BTreeMap;

use super::Constants;
use super::matrix::{Entries, add_multiple, commutator};
use lie_symbolic::exact::Rational;

/// A row of the echelon form: a matrix whose first entry is one, and what it is made of.
type Row = (Entries, BTreeMap<usize, Rational>);

/// Independent matrices in echelon form, by the position of their first entry.
pub struct Frame(BTreeMap<(usize, usize), Row>);

impl Frame {
    /// `None` where the matrices are dependent.
    pub fn new(matrices: &[Entries]) -> Option<Self> {
        let mut frame = Self(BTreeMap::new());
        for (index, matrix) in matrices.iter().enumerate() {
            let (mut rest, used) = frame.reduced(matrix.clone());
            let (pivot, first) = rest.first_key_value()?;
            let (pivot, scale) = (*pivot, first.recip()?);
            rest.values_mut()
                .for_each(|value| *value = &*value * &scale);
            let mut made_of = BTreeMap::from([(index, scale.clone())]);
            add_multiple(&mut made_of, &used, &-scale);
            frame.0.insert(pivot, (rest, made_of));
        }
        Some(frame)
    }

    /// The coordinates of a matrix, `None` outside the span.
    pub fn coordinates(&self, matrix: Entries) -> Option<BTreeMap<usize, Rational>> {
        let (rest, used) = self.reduced(matrix);
        rest.is_empty().then_some(used)
    }

    /// The brackets of the matrices of the frame, `None` where one is outside the span.
    pub fn constants(&self, matrices: &[Entries]) -> Option<Constants> {
        let mut constants = Constants::new();
        for (i, a) in matrices.iter().enumerate() {
            for (j, b) in matrices.iter().enumerate().skip(i + 1) {
                let terms = self.coordinates(commutator(a, b))?;
                if !terms.is_empty() {
                    constants.insert((i, j), terms);
                }
            }
        }
        Some(constants)
    }

    /// A matrix without its part in the span as far as its first entries tell, and that part.
    fn reduced(&self, mut rest: Entries) -> (Entries, BTreeMap<usize, Rational>) {
        let mut used = BTreeMap::new();
        while let Some((position, value)) = rest.first_key_value() {
            let Some((row, made_of)) = self.0.get(position) else {
                break;
            };
            let value = value.clone();
            add_multiple(&mut rest, row, &-&value);
            add_multiple(&mut used, made_of, &value);
        }
        (rest, used)
    }
}
