//! Samples under a window, and the line among them that explains most.

use std::f64::consts::TAU;

use lie_runtime::Scalar;

/// Sines and cosines of so many samples follow from the first by a rotation each, before they are computed anew.
const STRETCH: usize = 32;
/// Steps of false position, at most.
const STEPS: usize = 60;
/// Bins that a frequency goes from its guess, at most.
const FAR: f64 = 4.0;

/// The places of n samples around their middle, in units of their distance, with the window of J. Hann to a power p,
/// `w(u) = (1 + cos(2 pi u/n))^p`, of sum 1.
pub(crate) struct Window {
    weights: Vec<f64>,
}

/// `cosine cos(omega u) + sine sin(omega u)`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Wave {
    /// Radians per sample.
    pub(crate) frequency: f64,
    pub(crate) cosine: f64,
    pub(crate) sine: f64,
}

impl Window {
    pub(crate) fn new(length: usize, power: i32) -> Self {
        let n = length as f64;
        let weight = |j: usize| {
            let u = j as f64 - 0.5 * (n - 1.0);
            (1.0 + Scalar::cos(TAU * u / n)).powi(power)
        };
        let mut weights: Vec<f64> = (0..length).map(weight).collect();
        let sum: f64 = weights.iter().sum();
        weights.iter_mut().for_each(|weight| *weight /= sum);
        Self { weights }
    }

    /// One period over all samples: frequencies that are nearer to each other are hard to tell apart.
    pub(crate) fn bin(&self) -> f64 {
        TAU / self.weights.len() as f64
    }

    /// The samples under the window.
    pub(crate) fn weighted(&self, values: &[f64]) -> impl Iterator<Item = f64> {
        values.iter().zip(&self.weights).map(|(v, w)| v * w)
    }

    /// The mean under the window.
    pub(crate) fn mean(&self, values: &[f64]) -> f64 {
        self.weighted(values).sum()
    }

    /// Calls `each` with the number of every sample, its place, and cosine and sine of a frequency there.
    fn turns(&self, frequency: f64, mut each: impl FnMut(usize, f64, f64, f64)) {
        let length = self.weights.len();
        let middle = 0.5 * (length as f64 - 1.0);
        let (sine, cosine) = Scalar::sin_cos(frequency);
        for first in (0..length).step_by(STRETCH) {
            let place = first as f64 - middle;
            let (mut s, mut c) = Scalar::sin_cos(frequency * place);
            for j in first..(first + STRETCH).min(length) {
                each(j, j as f64 - middle, c, s);
                (c, s) = (c * cosine - s * sine, s * cosine + c * sine);
            }
        }
    }

    /// Adds a wave so many times.
    pub(crate) fn add(&self, wave: &Wave, times: f64, values: &mut [f64]) {
        let (a, b) = (times * wave.cosine, times * wave.sine);
        self.turns(wave.frequency, |j, _, c, s| values[j] += a * c + b * s);
    }

    /// The wave of a frequency that explains most of the samples under the window, and the slope over the frequency of what it
    /// explains. Of a real signal lines come in pairs `±omega`; they are taken together, as the plane of cosine and sine, so that
    /// neither is disturbed by the other.
    fn projected(&self, values: &[f64], frequency: f64) -> (Wave, f64) {
        let (mut cc, mut ss, mut fc, mut fs) = (0.0, 0.0, 0.0, 0.0);
        let (mut fct, mut fst, mut cst) = (0.0, 0.0, 0.0);
        self.turns(frequency, |j, u, c, s| {
            let w = self.weights[j];
            let f = w * values[j];
            cc += w * c * c;
            ss += w * s * s;
            fc += f * c;
            fs += f * s;
            fct += f * c * u;
            fst += f * s * u;
            cst += w * c * s * u;
        });
        // sums that are odd in the place vanish
        let (a, b) = (fc / cc, fs / ss);
        let slope = b * fct - a * fst + (a * a - b * b) * cst;
        let wave = Wave {
            frequency,
            cosine: a,
            sine: b,
        };
        (wave, slope)
    }

    /// The wave whose frequency explains most, uphill from a guess: the zero of the slope, by false position. Steps uphill grow from
    /// `near` on to a quarter of a bin; some bins away from the guess they end.
    pub(crate) fn refined(&self, values: &[f64], guess: f64, near: f64) -> Wave {
        let slope = |frequency: f64| self.projected(values, frequency).1;
        let mut at = (guess, slope(guess));
        let uphill = at.1.signum();
        let mut step = near;
        let next = loop {
            let next = (at.0 + uphill * step).max(0.25 * self.bin());
            let next = (next, slope(next));
            if next.1 * uphill <= 0.0 {
                break next;
            }
            if next.0 == at.0 || (next.0 - guess).abs() > FAR * self.bin() || next.1.is_nan() {
                return self.projected(values, next.0).0;
            }
            at = next;
            step = (4.0 * step).min(0.25 * self.bin());
        };
        let (mut low, mut high) = if uphill > 0.0 { (at, next) } else { (next, at) };
        // the form of Illinois: the slope at an end that stays is halved
        let (mut found, mut last) = (guess, 0.0);
        for _ in 0..STEPS {
            let next = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
            let moved = (next - found).abs();
            found = next;
            if next <= low.0 || next >= high.0 || moved <= f64::EPSILON * next {
                break;
            }
            let value = slope(next);
            let stays = if value.signum() == last { 0.5 } else { 1.0 };
            match value > 0.0 {
                true => (low, high.1) = ((next, value), stays * high.1),
                false => (high, low.1) = ((next, value), stays * low.1),
            }
            last = value.signum();
        }
        self.projected(values, found).0
    }
}
