//! Means over parts of a time, and what they say of the error of the mean over all of it.

/// Parts of the time.
pub(crate) const BLOCKS: usize = 20;

/// Sums over steps, in parts of nearly the same number of steps.
pub(crate) struct Blocks {
    steps: u64,
    done: u64,
    /// Of each part the steps that were made, and the sums over them.
    parts: Vec<(u64, Vec<f64>)>,
}

impl Blocks {
    /// Nothing yet of so many steps, with so many sums.
    pub(crate) fn new(steps: u64, sums: usize) -> Self {
        Self {
            steps,
            done: 0,
            parts: vec![(0, vec![0.0; sums]); BLOCKS],
        }
    }

    /// The steps that are in it.
    pub(crate) fn done(&self) -> u64 {
        self.done
    }

    /// Adds what a step has of each sum.
    pub(crate) fn add(&mut self, values: impl Iterator<Item = f64>) {
        let place = u128::from(self.done) * BLOCKS as u128 / u128::from(self.steps);
        let (count, sums) = &mut self.parts[(place as usize).min(BLOCKS - 1)];
        *count += 1;
        sums.iter_mut().zip(values).for_each(|(sum, v)| *sum += v);
        self.done += 1;
    }

    /// The mean of a sum per step, and its error: the standard error of the means of the parts, or the distance of the mean over
    /// the second half where that is larger. No number where there are less than two parts.
    pub(crate) fn mean(&self, sum: usize) -> (f64, f64) {
        let parts = self.parts.iter().filter(|(count, _)| *count > 0);
        let parts: Vec<(f64, f64)> = parts
            .map(|(count, sums)| (*count as f64, sums[sum]))
            .collect();
        let over = |parts: &[(f64, f64)]| {
            let steps: f64 = parts.iter().map(|part| part.0).sum();
            parts.iter().map(|part| part.1).sum::<f64>() / steps
        };
        let mean = over(&parts);
        if parts.len() < 2 {
            return (mean, f64::NAN);
        }
        let steps = self.done as f64;
        let squares = parts.iter().map(|(count, sum)| {
            let off = sum / count - mean;
            count / steps * off * off
        });
        let error = (squares.sum::<f64>() / (parts.len() - 1) as f64).sqrt();
        let late = over(&parts[parts.len() / 2..]);
        (mean, error.max((mean - late).abs()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_those_of_means() {
        let mut blocks = Blocks::new(40_000, 2);
        let mut random = crate::random::Random::new(3);
        for step in 0..40_000 {
            blocks.add([random.unit(), 1.0 / f64::from(step + 1)].into_iter());
        }
        let (mean, error) = blocks.mean(0);
        // the deviation of a number between -1 and 1 is 1/sqrt(3)
        let known = (1.0 / 3.0_f64 / 40_000.0).sqrt();
        assert!(mean.abs() < 3.0 * known, "{mean}");
        assert!((0.5..2.0).contains(&(error / known)), "{error} {known}");
        // the control: a mean that only dies away has an error of its own size
        let (mean, error) = blocks.mean(1);
        assert!(error > 0.5 * mean && error < 2.0 * mean, "{mean} {error}");
        assert!(Blocks::new(1, 1).mean(0).1.is_nan());
    }
}
