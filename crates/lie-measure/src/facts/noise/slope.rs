//! The slope of an error that is known from samples, with its standard error.

/// The parts that samples are divided into.
pub(super) const BATCHES: usize = 20;
/// An error that is not so many of its standard errors away from zero counts for no slope.
const RESOLVED: f64 = 3.0;
/// The fewest points of a slope.
const LEAST: usize = 3;

/// Sums over the samples of one level: of each of some quantities, by batches.
#[derive(Clone, Debug)]
pub(super) struct Level {
    /// The step.
    pub(super) h: f64,
    /// The means of each batch.
    batches: Vec<Vec<f64>>,
}

impl Level {
    /// Of so many samples, each by its number; as many as there are batches, or a multiple. None where a sample is none.
    pub(super) fn of(
        h: f64,
        samples: usize,
        mut sample: impl FnMut(usize) -> Option<Vec<f64>>,
    ) -> Option<Self> {
        let size = samples / BATCHES;
        let mut mean = |batch: usize| {
            let mut sums: Vec<f64> = Vec::new();
            for number in batch * size..(batch + 1) * size {
                let values = sample(number)?;
                sums.resize(values.len(), 0.0);
                sums.iter_mut().zip(values).for_each(|(sum, x)| *sum += x);
            }
            sums.iter_mut().for_each(|sum| *sum /= size as f64);
            Some(sums)
        };
        let batches = (0..BATCHES).map(&mut mean).collect::<Option<_>>()?;
        Some(Self { h, batches })
    }

    /// The mean of a quantity.
    pub(super) fn mean(&self, quantity: usize) -> f64 {
        self.means(None)[quantity]
    }

    /// The mean of each quantity, without one of the batches.
    fn means(&self, without: Option<usize>) -> Vec<f64> {
        let kept = self.batches.iter().enumerate();
        let kept: Vec<&Vec<f64>> = kept
            .filter(|(index, _)| Some(*index) != without)
            .map(|(_, batch)| batch)
            .collect();
        let of = |k: usize| kept.iter().map(|batch| batch[k]).sum::<f64>() / kept.len() as f64;
        (0..self.batches[0].len()).map(of).collect()
    }
}

/// A slope.
#[derive(Clone, Debug)]
pub(super) struct Slope {
    /// The slope.
    pub(super) value: f64,
    /// Its standard error.
    pub(super) error: f64,
    /// The largest and the smallest step that count, with their errors.
    pub(super) ends: [(f64, f64); 2],
}

/// What the errors at some levels are, from the means of their quantities.
type Sizes<'a> = &'a dyn Fn(&[Vec<f64>]) -> Vec<f64>;

/// The slope of the logarithms of the errors that `sizes` makes of the means at all levels, by least squares with the weights of their
/// statistical errors, which are found by leaving one batch out after another (B. Efron, 1982, doi:10.1137/1.9781611970319); none where too few
/// errors are away from zero.
pub(super) fn slope(levels: &[Level], sizes: Sizes<'_>) -> Option<Slope> {
    let without = |batch: Option<usize>| {
        let means: Vec<Vec<f64>> = levels.iter().map(|level| level.means(batch)).collect();
        sizes(&means)
    };
    let all = without(None);
    let others: Vec<Vec<f64>> = (0..BATCHES).map(|batch| without(Some(batch))).collect();
    let jackknife = |of: &dyn Fn(&[f64]) -> f64| {
        let values: Vec<f64> = others.iter().map(|sizes| of(sizes)).collect();
        let mean = values.iter().sum::<f64>() / BATCHES as f64;
        let squares = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>();
        (squares * (BATCHES - 1) as f64 / BATCHES as f64).sqrt()
    };
    let relative = |place: usize| jackknife(&|sizes| sizes[place]) / all[place];
    let resolved: Vec<usize> = (0..levels.len())
        .filter(|place| all[*place] > 0.0 && RESOLVED * relative(*place) < 1.0)
        .collect();
    let (first, last) = (*resolved.first()?, *resolved.last()?);
    if resolved.len() < LEAST {
        return None;
    }
    // no error is so certain that others do not count
    let weights: Vec<f64> = resolved
        .iter()
        .map(|place| (relative(*place).powi(2) + 1e-4).recip())
        .collect();
    let fitted = |sizes: &[f64]| {
        let points = resolved.iter().zip(&weights);
        let points: Vec<(f64, f64, f64)> = points
            .map(|(place, weight)| (levels[*place].h.ln(), sizes[*place].ln(), *weight))
            .collect();
        let total: f64 = points.iter().map(|p| p.2).sum();
        let mean = |of: fn(&(f64, f64, f64)) -> f64| {
            points.iter().map(|p| p.2 * of(p)).sum::<f64>() / total
        };
        let (x, y) = (mean(|p| p.0), mean(|p| p.1));
        let (xy, xx) = points.iter().fold((0.0, 0.0), |(xy, xx), p| {
            let dx = p.0 - x;
            (xy + p.2 * dx * (p.1 - y), xx + p.2 * dx * dx)
        });
        xy / xx
    };
    let value = fitted(&all);
    let error = jackknife(&fitted);
    let end = |place: usize| (levels[place].h, all[place]);
    (value.is_finite() && error.is_finite()).then(|| Slope {
        value,
        error,
        ends: [end(first), end(last)],
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// Errors `3 h^p` with a scatter of each sample.
    fn levels(order: f64, scatter: f64) -> Vec<Level> {
        let mut random = Random::new(3);
        let steps = [0.1, 0.05, 0.025, 0.0125];
        let mut level = |h: f64| {
            let mut error = || 3.0 * h.powf(order) + scatter * h.sqrt() * random.unit();
            Level::of(h, 400, |_| Some(vec![error()])).expect("all samples")
        };
        steps.into_iter().map(&mut level).collect()
    }

    fn first(means: &[Vec<f64>]) -> Vec<f64> {
        means.iter().map(|means| means[0]).collect()
    }

    #[test]
    fn a_slope_is_within_its_error() {
        for order in [0.5, 1.0, 2.0] {
            let found = slope(&levels(order, 0.05), &first).expect("a slope");
            assert!((found.value - order).abs() < 3.0 * found.error, "{found:?}");
            assert!(found.error < 0.15, "{found:?}");
        }
    }

    #[test]
    fn what_the_scatter_hides_has_no_slope() {
        assert!(slope(&levels(1.0, 50.0), &first).is_none());
    }
}
