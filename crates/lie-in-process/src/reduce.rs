//! What is computed of all members of an ensemble: mean, covariance, quantiles, histograms. The order of the sums is that of the members,
//! whatever the threads and the shares.

mod going;
mod histogram;

use std::io::{self, Read};

pub use going::Going;
pub use histogram::{Bins, MOST_BINS};

/// Members that are summed one after the other; then sums are added two by two.
const LEAF: u64 = 32;
/// Bytes of the numbers that are sorted at a time.
const SORTED: usize = 1 << 28;

/// Mean and covariance of each row, where a member came to it.
///
/// Leaves of 32 members by Welford's recurrence, and pairs of them by that of Chan, Golub and LeVeque (The American
/// Statistician 37, 1983, [doi:10.1080/00031305.1983.10483115](https://doi.org/10.1080/00031305.1983.10483115)) in a binary tree: errors grow
/// like the logarithm of the number of members.
pub struct Moments {
    shape: [usize; 2],
    /// Members of the leaf that is being filled.
    members: u64,
    leaf: Sums,
    /// Sums of 1, 2, 4, … leaves, where there are such.
    levels: Vec<Option<Sums>>,
}

/// Of each row the number of members, their mean, and the products of their deviations.
#[derive(Clone)]
struct Sums {
    counts: Vec<u64>,
    means: Vec<f64>,
    products: Vec<f64>,
}

impl Sums {
    fn none([rows, width]: [usize; 2]) -> Self {
        Self {
            counts: vec![0; rows],
            means: vec![0.0; rows * width],
            products: vec![0.0; rows * width * (width + 1) / 2],
        }
    }

    fn push(&mut self, [rows, width]: [usize; 2], member: &[f64]) {
        let triangle = width * (width + 1) / 2;
        let mut before = vec![0.0; width];
        for row in 0..rows {
            let state = &member[row * width..][..width];
            if state.iter().any(|x| x.is_nan()) {
                continue;
            }
            self.counts[row] += 1;
            let mean = &mut self.means[row * width..][..width];
            let products = &mut self.products[row * triangle..][..triangle];
            for ((before, mean), x) in before.iter_mut().zip(mean.iter_mut()).zip(state) {
                *before = x - *mean;
                *mean += *before / self.counts[row] as f64;
            }
            let mut place = 0;
            for (i, before) in before.iter().enumerate() {
                for (x, mean) in state[..=i].iter().zip(mean.iter()) {
                    products[place] += before * (x - mean);
                    place += 1;
                }
            }
        }
    }

    /// These with those of later members.
    fn and(mut self, [rows, width]: [usize; 2], later: &Self) -> Self {
        let triangle = width * (width + 1) / 2;
        let mut apart = vec![0.0; width];
        for row in 0..rows {
            let (own, others) = (self.counts[row] as f64, later.counts[row] as f64);
            if others == 0.0 {
                continue;
            }
            let all = own + others;
            self.counts[row] += later.counts[row];
            for (i, apart) in apart.iter_mut().enumerate() {
                let mean = &mut self.means[row * width + i];
                *apart = later.means[row * width + i] - *mean;
                *mean += *apart * (others / all);
            }
            let mut place = row * triangle;
            for i in 0..width {
                for j in 0..=i {
                    let between = apart[i] * apart[j] * (own * (others / all));
                    self.products[place] += later.products[place] + between;
                    place += 1;
                }
            }
        }
        self
    }
}

/// What is computed of the members that came to a row.
#[derive(Default)]
pub struct Found {
    /// How many they are, row by row.
    pub counts: Vec<u64>,
    /// Their means, row by row; not a number where there is no member.
    pub means: Vec<f64>,
    /// The covariances, a matrix for each row, over the number of members less one; not a number where there are not two members.
    pub covariances: Vec<f64>,
}

impl Moments {
    /// Of members with so many rows and columns.
    pub fn new(shape: [usize; 2]) -> Self {
        Self {
            shape,
            members: 0,
            leaf: Sums::none(shape),
            levels: Vec::new(),
        }
    }

    /// The numbers that are kept at most for so many members.
    pub fn size([rows, width]: [usize; 2], members: usize) -> f64 {
        let levels = 2.0 + (members as f64 / LEAF as f64).max(1.0).log2().ceil();
        levels * rows as f64 * (1.0 + width as f64 + (width * (width + 1) / 2) as f64)
    }

    /// Adds a member: its rows, one behind the other.
    pub fn push(&mut self, member: &[f64]) {
        self.leaf.push(self.shape, member);
        self.members += 1;
        if !self.members.is_multiple_of(LEAF) {
            return;
        }
        let mut carried = std::mem::replace(&mut self.leaf, Sums::none(self.shape));
        for level in &mut self.levels {
            match level.take() {
                Some(earlier) => carried = earlier.and(self.shape, &carried),
                None => {
                    *level = Some(carried);
                    return;
                }
            }
        }
        self.levels.push(Some(carried));
    }

    /// What is computed of all members.
    pub fn found(self) -> Found {
        let [rows, width] = self.shape;
        let levels = self.levels.into_iter().flatten();
        let sums = levels.fold(self.leaf, |later, earlier| earlier.and(self.shape, &later));
        let triangle = width * (width + 1) / 2;
        let mut covariances = vec![f64::NAN; rows * width * width];
        let mut means = sums.means;
        for row in 0..rows {
            let count = sums.counts[row];
            if count == 0 {
                means[row * width..][..width].fill(f64::NAN);
            }
            if count < 2 {
                continue;
            }
            for i in 0..width {
                for j in 0..=i {
                    let product = sums.products[row * triangle + i * (i + 1) / 2 + j];
                    let value = product / (count - 1) as f64;
                    covariances[(row * width + i) * width + j] = value;
                    covariances[(row * width + j) * width + i] = value;
                }
            }
        }
        Found {
            counts: sums.counts,
            means,
            covariances,
        }
    }
}

/// Quantiles of columns of an array of members, a row of columns for each probability: exact, from all numbers, interpolated
/// linearly as `numpy.quantile` does. Numbers of members that did not come to a row are left out.
///
/// `again` gives the numbers from the beginning, as often as there is need to read them.
///
/// # Errors
/// What cannot be read.
pub fn quantiles<R: Read>(
    mut again: impl FnMut() -> io::Result<R>,
    (members, columns): (usize, usize),
    probabilities: &[f64],
) -> io::Result<Vec<f64>> {
    let mut found = vec![f64::NAN; probabilities.len() * columns];
    let at_once = (SORTED / 8 / members.max(1)).clamp(1, columns.max(1));
    let mut bytes = vec![0; columns * 8];
    for first in (0..columns).step_by(at_once) {
        let last = (first + at_once).min(columns);
        let empty = |_| Vec::with_capacity(members);
        let mut sets: Vec<Vec<f64>> = (first..last).map(empty).collect();
        let mut numbers = again()?;
        for _ in 0..members {
            numbers.read_exact(&mut bytes)?;
            let wanted = bytes[first * 8..last * 8].chunks_exact(8);
            for (set, bytes) in sets.iter_mut().zip(wanted) {
                let number = bytes.try_into().map_or(f64::NAN, f64::from_le_bytes);
                if !number.is_nan() {
                    set.push(number);
                }
            }
        }
        for (column, mut set) in (first..last).zip(sets) {
            set.sort_unstable_by(f64::total_cmp);
            for (index, &probability) in probabilities.iter().enumerate() {
                found[index * columns + column] = quantile(&set, probability);
            }
        }
    }
    Ok(found)
}

/// A quantile of numbers in order.
fn quantile(sorted: &[f64], probability: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else {
        return f64::NAN;
    };
    let place = probability * last as f64;
    let below = (place.floor() as usize).min(last);
    let part = place - below as f64;
    let (low, high) = (sorted[below], sorted[(below + 1).min(last)]);
    match part < 0.5 {
        true => low + (high - low) * part,
        false => high - (high - low) * (1.0 - part),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1,000 members of two rows and two columns far from zero; one of them came to its first row alone.
    fn members() -> Vec<[f64; 4]> {
        let number = |k: u64| {
            let z = (k + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
            (z ^ (z >> 31)) as f64 / u64::MAX as f64
        };
        let mut all: Vec<[f64; 4]> = (0..1000)
            .map(|k| std::array::from_fn(|i| 1e6 + number(4 * k + i as u64)))
            .collect();
        all[17][2..].fill(f64::NAN);
        all
    }

    #[test]
    fn moments_are_those_of_the_definition() {
        let members = members();
        let mut moments = Moments::new([2, 2]);
        members.iter().for_each(|member| moments.push(member));
        let found = moments.found();
        let (means, covariances) = (found.means, found.covariances);
        assert_eq!(found.counts, [1000, 999]);
        for row in 0..2 {
            let came: Vec<&[f64]> = members.iter().map(|m| &m[2 * row..2 * row + 2]).collect();
            let came: Vec<&&[f64]> = came.iter().filter(|m| !m[0].is_nan()).collect();
            assert_eq!(came.len(), 1000 - row);
            // about a point nearby the sums are nearly exact
            let sum = |f: &dyn Fn(&[f64]) -> f64| {
                came.iter().map(|m| f(m)).sum::<f64>() / came.len() as f64
            };
            let near = [0, 1].map(|i| sum(&|m| m[i] - 1e6));
            for i in 0..2 {
                assert!((means[2 * row + i] - 1e6 - near[i]).abs() < 3e-10);
                for j in 0..2 {
                    let product = sum(&|m| (m[i] - 1e6 - near[i]) * (m[j] - 1e6 - near[j]));
                    let expected = product * came.len() as f64 / (came.len() - 1) as f64;
                    let found = covariances[4 * row + 2 * i + j];
                    assert!((found - expected).abs() < 1e-10, "{found} {expected}");
                }
            }
        }
        let none = Moments::new([1, 1]).found();
        assert!(none.means[0].is_nan() && none.covariances[0].is_nan());
    }

    #[test]
    fn quantiles_are_those_of_numpy() {
        // numpy.quantile([3., 1., 2., 7., 5.], [0, .1, .25, .5, .9, 1])
        let numbers = [3.0_f64, 1.0, f64::NAN, 2.0, 7.0, 5.0];
        let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
        let found = quantiles(|| Ok(&bytes[..]), (6, 1), &[0.0, 0.1, 0.25, 0.5, 0.9, 1.0]).unwrap();
        assert_eq!(found, [1.0, 1.4, 2.0, 3.0, 6.2, 7.0]);
        assert!(quantiles(|| Ok(&bytes[16..24]), (1, 1), &[0.5]).unwrap()[0].is_nan());
    }
}
