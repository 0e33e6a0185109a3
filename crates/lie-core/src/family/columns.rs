//! The order in which flows have the sites: sites that are done together stand one behind the other.

use crate::scalar::Scalar;

/// Columns by their remainder modulo a power of 2: first those with remainder 0, then those with remainder 1, and so on.
/// With 2 as the modulus the bonds of neighbours lie between stretches of even and of odd columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Columns {
    count: usize,
    modulus: usize,
}

impl Columns {
    /// So many columns.
    pub(super) fn new(count: usize, modulus: usize) -> Self {
        Self { count, modulus }
    }

    /// How far apart columns are that stand one behind the other.
    pub(super) fn modulus(self) -> usize {
        self.modulus
    }

    /// Where the columns with a remainder begin.
    fn begin(self, remainder: usize) -> usize {
        self.count / self.modulus * remainder + (self.count % self.modulus).min(remainder)
    }

    /// Where a column stands.
    pub(super) fn place(self, column: usize) -> usize {
        self.begin(column % self.modulus) + column / self.modulus
    }

    /// Brings rows into this order.
    pub(super) fn gather<S: Scalar>(self, from: &[S], into: &mut [S]) {
        for (from, into) in self.rows(from).zip(into.chunks_exact_mut(self.count)) {
            if self.modulus == 2 {
                let (even, odd) = into.split_at_mut(self.begin(1));
                let pairs = from.chunks_exact(2);
                even[even.len() - 1] = from[2 * (even.len() - 1)];
                for ((even, odd), pair) in even.iter_mut().zip(odd).zip(pairs) {
                    (*even, *odd) = (pair[0], pair[1]);
                }
                continue;
            }
            for remainder in 0..self.modulus.min(self.count) {
                let into = &mut into[self.begin(remainder)..self.begin(remainder + 1)];
                let from = from[remainder..].iter().step_by(self.modulus);
                into.iter_mut().zip(from).for_each(|(to, from)| *to = *from);
            }
        }
    }

    /// Brings rows back from it, in the lanes of a mask.
    pub(super) fn scatter<S: Scalar>(self, lanes: S::Mask, from: &[S], into: &mut [S]) {
        let set = |to: &mut S, from: S| *to = S::select(lanes, from, *to);
        for (from, into) in self.rows(from).zip(into.chunks_exact_mut(self.count)) {
            if self.modulus == 2 {
                let (even, odd) = from.split_at(self.begin(1));
                let last = even.len() - 1;
                set(&mut into[2 * last], even[last]);
                let pairs = into.chunks_exact_mut(2);
                for ((even, odd), pair) in even.iter().zip(odd).zip(pairs) {
                    let [first, second] = pair else { continue };
                    set(first, *even);
                    set(second, *odd);
                }
                continue;
            }
            for remainder in 0..self.modulus.min(self.count) {
                let from = &from[self.begin(remainder)..self.begin(remainder + 1)];
                let into = into[remainder..].iter_mut().step_by(self.modulus);
                into.zip(from).for_each(|(to, from)| set(to, *from));
            }
        }
    }

    fn rows<S>(self, state: &[S]) -> core::slice::ChunksExact<'_, S> {
        state.chunks_exact(self.count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    #[test]
    fn every_column_has_a_place_and_comes_back() {
        for count in 1..40 {
            for modulus in [1, 2, 4, 16] {
                let columns = Columns::new(count, modulus);
                let from: Vec<f64> = (0..2 * count).map(|k| 1.0 + k as f64).collect();
                let (mut taken, mut back) = (from.clone(), from.clone());
                taken.fill(0.0);
                columns.gather(&from, &mut taken);
                for (column, value) in from[..count].iter().enumerate() {
                    let place = columns.place(column);
                    assert_eq!(
                        (taken[place], taken[count + place]),
                        (*value, value + count as f64)
                    );
                }
                back.fill(0.0);
                columns.scatter(false, &taken, &mut back);
                assert!(back.iter().all(|value| *value == 0.0));
                columns.scatter(true, &taken, &mut back);
                assert_eq!(back, from);
            }
        }
        // neighbours of even columns stand beside them in a stretch of their own
        let columns = Columns::new(7, 2);
        assert_eq!(
            [0, 2, 4, 6, 1, 3, 5].map(|c| columns.place(c)),
            [0, 1, 2, 3, 4, 5, 6]
        );
    }
}
