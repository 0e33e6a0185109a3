//! Means over the density exp(-H/T), from its values at ever more nodes.

/// Means may change by this part of the standard deviation where the number of nodes doubles.
const EXACT: f64 = 1e-5;
/// The most values of H.
pub(super) const MOST_VALUES: usize = 5_000_000;

/// Means with standard deviations.
#[derive(Clone, Debug)]
pub(super) struct Means {
    pub(super) mean: Vec<f64>,
    pub(super) deviation: Vec<f64>,
}

/// Functions of the state of which means are taken, the first of them H.
pub(super) type Functions<'a, V> = &'a dyn Fn(&V) -> Vec<f64>;

/// Sums of a density.
pub(super) struct Sums {
    /// The least value of H so far, where the weight is 1.
    least: f64,
    weight: f64,
    first: Vec<f64>,
    second: Vec<f64>,
}

impl Sums {
    pub(super) fn new() -> Self {
        Self {
            least: f64::INFINITY,
            weight: 0.0,
            first: Vec::new(),
            second: Vec::new(),
        }
    }

    pub(super) fn add(&mut self, values: &[f64], weight: f64, temperature: f64) {
        let energy = values[0];
        if !energy.is_finite() {
            return;
        }
        self.first.resize(values.len(), 0.0);
        self.second.resize(values.len(), 0.0);
        if energy < self.least {
            let factor = match self.weight > 0.0 {
                true => ((energy - self.least) / temperature).exp(),
                false => 0.0,
            };
            self.weight *= factor;
            let sums = self.first.iter_mut().chain(&mut self.second);
            sums.for_each(|sum| *sum *= factor);
            self.least = energy;
        }
        let weight = weight * ((self.least - energy) / temperature).exp();
        self.weight += weight;
        for (k, value) in values.iter().enumerate() {
            self.first[k] += weight * value;
            self.second[k] += weight * value * value;
        }
    }

    pub(super) fn means(self) -> Means {
        let mean: Vec<f64> = self.first.iter().map(|sum| sum / self.weight).collect();
        let pairs = self.second.iter().zip(&mean);
        let variance = pairs.map(|(sum, mean)| (sum / self.weight - mean * mean).max(0.0));
        Means {
            deviation: variance.map(f64::sqrt).collect(),
            mean,
        }
    }
}

/// The means of ever more nodes, until they agree.
pub(super) fn converged(mut of: impl FnMut(usize) -> Option<Means>) -> Result<Means, String> {
    let mut last: Option<Means> = None;
    let mut nodes = 8;
    while let Some(means) = of(nodes) {
        if let Some(last) = last {
            let mut both = means.mean.iter().zip(&last.mean).zip(&means.deviation);
            if both.all(|((new, old), size)| {
                (new - old).abs() <= EXACT * size + f64::EPSILON * new.abs()
            }) {
                return Ok(means);
            }
        }
        last = Some(means);
        nodes *= 2;
    }
    Err("the density is too sharp for the quadrature: its temperature is low".to_owned())
}
