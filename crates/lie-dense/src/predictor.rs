//! Where the iteration of a step starts: the midpoints of the steps before it, extrapolated.

use crate::product::widest;
use pulp::NullaryFnOnce;

/// The polynomial goes through so many midpoints at most.
const MOST: usize = 12;
/// Entries that are treated together.
const LANES: usize = 16;

/// Predicts a vector of a sequence by the polynomial through the last ones, whose degree is the one that would have predicted
/// the last best.
///
/// Backward differences `d_0 = u`, `d_j <- d_(j-1) - d_j`: the prediction from j values is `d_0 + … + d_(j-1)`, and its error
/// is the next `d_j`.
#[derive(Clone, Debug)]
pub(crate) struct Predictor {
    /// By blocks of entries, in each all differences.
    differences: Vec<[[f64; LANES]; MOST]>,
    /// How many differences are those of the last vector.
    known: usize,
    /// How many differences the next prediction sums.
    terms: usize,
}

impl Predictor {
    pub(crate) fn new(count: usize) -> Self {
        Self {
            differences: vec![[[0.0; LANES]; MOST]; count.div_ceil(LANES)],
            known: 0,
            terms: 0,
        }
    }

    /// Starts anew.
    pub(crate) fn forget(&mut self) {
        self.known = 0;
        self.terms = 0;
    }

    /// Writes the prediction; false if there is none.
    pub(crate) fn predict(&self, out: &mut [f64]) -> bool {
        if self.terms == 0 {
            return false;
        }
        for (out, block) in out.chunks_mut(LANES).zip(&self.differences) {
            let mut sum = block[0];
            for row in &block[1..self.terms] {
                for (sum, &difference) in sum.iter_mut().zip(row) {
                    *sum += difference;
                }
            }
            let count = out.len();
            out.copy_from_slice(&sum[..count]);
        }
        true
    }

    /// Takes the vector that was to be predicted.
    pub(crate) fn record(&mut self, vector: &[f64]) {
        widest(Take(self, vector));
    }

    #[inline(always)]
    fn take_entries(&mut self, vector: &[f64]) {
        // one more than before; none that will hardly be summed
        let known = self.known.min(MOST - 1).min(self.terms + 1);
        let mut largest = [[0.0_f64; LANES]; MOST];
        for (values, block) in vector.chunks(LANES).zip(&mut self.differences) {
            let mut difference = [0.0; LANES];
            difference[..values.len()].copy_from_slice(values);
            for (row, largest) in block[..=known].iter_mut().zip(&mut largest) {
                for lane in 0..LANES {
                    let before = row[lane];
                    row[lane] = difference[lane];
                    let size = difference[lane].abs();
                    largest[lane] = if size > largest[lane] {
                        size
                    } else {
                        largest[lane]
                    };
                    difference[lane] -= before;
                }
            }
        }
        let error = |terms: &usize| largest[*terms].iter().fold(0.0, |a: f64, &b| a.max(b));
        // the error of a prediction from j values is d_j, which so many are known of
        self.terms = (1..=known)
            .min_by(|a, b| error(a).total_cmp(&error(b)))
            .unwrap_or(1);
        self.known = known + 1;
    }
}

struct Take<'a>(&'a mut Predictor, &'a [f64]);

impl NullaryFnOnce for Take<'_> {
    type Output = ();
    #[inline(always)]
    fn call(self) {
        self.0.take_entries(self.1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest error of the last ten of forty predictions of 20 entries.
    fn error(vector: impl Fn(usize, usize) -> f64) -> f64 {
        let mut predictor = Predictor::new(20);
        let mut worst = 0.0_f64;
        for k in 0..40 {
            let values: Vec<f64> = (0..20).map(|i| vector(k, i)).collect();
            let mut guess = vec![0.0; 20];
            assert_eq!(predictor.predict(&mut guess), k > 0);
            if k >= 30 {
                let errors = guess.iter().zip(&values).map(|(a, b)| (a - b).abs());
                worst = errors.fold(worst, lie_runtime::Scalar::max);
            }
            predictor.record(&values);
        }
        worst
    }

    #[test]
    fn smooth_sequences_are_continued_and_others_do_no_harm() {
        let smooth = error(|k, i| (0.05 * k as f64 + i as f64).sin());
        assert!(smooth < 1e-10, "{smooth:e}");
        // the control: the last value alone
        assert!(0.05_f64.sin() > 1e-2);
        let jumping = error(|k, i| if (k * 7 + i * 3) % 5 < 2 { 1.0 } else { -1.0 });
        assert!(jumping <= 4.0, "{jumping}");
    }

    #[test]
    fn forgetting_starts_anew() {
        let mut predictor = Predictor::new(1);
        predictor.record(&[1.0]);
        assert!(predictor.predict(&mut [0.0]));
        predictor.forget();
        assert!(!predictor.predict(&mut [0.0]));
    }
}
