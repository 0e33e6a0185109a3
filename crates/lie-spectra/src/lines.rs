//! Waves that make up a signal, found one after the other and fitted together.

use crate::fourier::powers;
use crate::window::{Wave, Window};

/// Rounds over all waves in which each is fitted to what the others leave, at most.
const ROUNDS: usize = 40;
/// The end of the rounds: no frequency moves by more than this part of a bin.
const SETTLED: f64 = 1e-12;
/// A first bracket around a frequency that is nearly known, in bins.
const NEAR: f64 = 1e-4;
/// Waves nearer to each other than this part of a bin are one.
const ONE: f64 = 0.5;

/// A mean and waves, with what they leave of the samples.
pub(crate) struct Lines {
    window: Window,
    pub(crate) mean: f64,
    pub(crate) waves: Vec<Wave>,
    pub(crate) rest: Vec<f64>,
    least: f64,
}

impl Wave {
    pub(crate) fn amplitude(&self) -> f64 {
        self.cosine.hypot(self.sine)
    }
}

impl Lines {
    /// The mean alone.
    pub(crate) fn new(values: &[f64], power: i32) -> Self {
        let largest = values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        let mut lines = Self {
            window: Window::new(values.len(), power),
            mean: 0.0,
            waves: Vec::new(),
            rest: values.to_vec(),
            // angles at the ends are off by as much: waves below that are round-off
            least: f64::EPSILON * values.len() as f64 * largest,
        };
        lines.center();
        lines
    }

    /// Finds up to so many waves, the one that stands out most first.
    pub(crate) fn find(&mut self, count: usize) {
        while self.waves.len() < count {
            let Some(guess) = self.peak() else { break };
            self.take(guess, 0.25 * self.window.bin());
            self.settle();
            let is_one = self.is_crowded();
            if is_one
                || self
                    .waves
                    .last()
                    .is_some_and(|w| w.amplitude() < self.least)
            {
                self.give_back(self.waves.len() - 1);
                self.settle();
                break;
            }
        }
    }

    /// Fits waves of frequencies that are nearly known.
    pub(crate) fn follow(&mut self, frequencies: impl Iterator<Item = f64>) {
        frequencies.for_each(|guess| self.take(guess, NEAR * self.window.bin()));
        self.settle();
    }

    /// The mean takes what is left of one.
    fn center(&mut self) {
        let mean = self.window.mean(&self.rest);
        self.mean += mean;
        self.rest.iter_mut().for_each(|value| *value -= mean);
    }

    /// Fits a wave near a frequency to the rest, and takes it from there.
    fn take(&mut self, guess: f64, near: f64) {
        let wave = self.window.refined(&self.rest, guess, near);
        self.window.add(&wave, -1.0, &mut self.rest);
        self.waves.push(wave);
    }

    /// Gives a wave back to the rest.
    fn give_back(&mut self, place: usize) -> Wave {
        let wave = self.waves.remove(place);
        self.window.add(&wave, 1.0, &mut self.rest);
        wave
    }

    /// Fits each wave to what the others leave until none moves: the least squares under the window, of all at once.
    fn settle(&mut self) {
        let bin = self.window.bin();
        for _ in 0..ROUNDS {
            self.center();
            let mut moved = 0.0_f64;
            // each goes behind the others, so that all are in their order again at the end
            for _ in 0..self.waves.len() {
                let before = self.give_back(0).frequency;
                self.take(before, NEAR * bin);
                let after = self.waves.last().map_or(before, |wave| wave.frequency);
                moved = moved.max((after - before).abs());
            }
            if moved <= SETTLED * bin {
                break;
            }
        }
    }

    /// Whether the last wave is one of the others.
    fn is_crowded(&self) -> bool {
        let near = |a: &Wave, b: &Wave| (a.frequency - b.frequency).abs() < ONE * self.window.bin();
        let (last, others) = match self.waves.split_last() {
            Some(split) => split,
            None => return false,
        };
        others.iter().any(|other| near(last, other))
    }

    /// The frequency at which most is left, a bin or more from the others and from zero.
    fn peak(&self) -> Option<f64> {
        let weighted = self.window.weighted(&self.rest);
        let powers = powers(weighted, 2 * self.rest.len());
        let (bin, last) = (self.window.bin(), powers.len() - 1);
        let frequency = |k: usize| std::f64::consts::PI * k as f64 / last as f64;
        let is_free = |k: &usize| {
            let mut known = self.waves.iter().map(|wave| wave.frequency).chain([0.0]);
            known.all(|known| (frequency(*k) - known).abs() >= bin)
        };
        let free = (0..last).filter(is_free);
        let highest = free.max_by(|a, b| powers[*a].total_cmp(&powers[*b]))?;
        (powers[highest] > 0.0).then(|| frequency(highest))
    }
}
