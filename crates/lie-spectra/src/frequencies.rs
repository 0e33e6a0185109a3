//! The frequencies of a signal, by refined Fourier analysis.
//!
//! A regular motion is quasi-periodic, and an observable of it is a sum of lines, `f(t) = c + sum_k A_k cos(omega_k t + phi_k)`. A line of
//! N samples at the distance h is found by the place where the windowed Fourier transform is largest, and refined by the
//! frequency that explains most of the samples under the window:
//!
//! > omega = arg max |P_omega f|^2, <f, g> = sum_j w_j f_j g_j, w(u) = (1 + cos(2 pi u/(N h)))^p
//!
//! with the projection `P_omega` on the plane of `cos(omega t)` and `sin(omega t)`. It is taken from the signal, the next one is found in
//! what is left, and all are fitted together until none moves, which is what Gram–Schmidt does for amplitudes, for frequencies too.
//! A line that is alone has an error of round-off; what others leave, that are not asked for, falls with the distance like
//! `(distance N h)^-(2 p + 2)`.
//!
//! J. Laskar, The chaotic motion of the solar system: a numerical estimate of the size of the chaotic zones, Icarus 88 (1990) 266–291,
//! doi:10.1016/0019-1035(90)90084-M; Frequency analysis for multi-dimensional systems. Global dynamics and diffusion, Physica D 67
//! (1993) 257–281, doi:10.1016/0167-2789(93)90210-R. That frequencies of lines are fitted together: M. Šidlichovský,
//! D. Nesvorný, Frequency modified Fourier transform and its application to asteroids, Celest. Mech. Dyn. Astr. 65 (1996) 137–148,
//! doi:10.1007/BF00048443.
//!
//! The same lines are fitted to both halves of the time: of a regular motion they agree, up to the error of half the time, and of a
//! chaotic one they do not. Their difference is an estimate of the error, and the diffusion of frequency map analysis.

use std::f64::consts::TAU;

use lie_runtime::Scalar;

use crate::lines::Lines;
use crate::window::Wave;

/// The least number of samples.
pub const LEAST: usize = 16;

/// What is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// The number of lines, at most.
    pub count: usize,
    /// The power p of the window of Hann: 0 is no window. A larger one keeps lines that are not asked for from disturbing
    /// the others, and takes a longer time to tell neighbours apart: their distance should be 2 pi (p + 1)/T.
    pub window: u8,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            count: 5,
            window: 2,
        }
    }
}

/// A line `A cos(omega t + phi)`, with the time from the first sample on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// The angular frequency omega, radians per unit of the time.
    pub frequency: f64,
    /// The amplitude A, in the unit of the signal.
    pub amplitude: f64,
    /// The phase phi, from -pi to pi.
    pub phase: f64,
    /// The angular frequency over the first half of the time, and over the second.
    pub halves: [f64; 2],
}

impl Line {
    /// By how much the halves differ: an estimate of the error, and the diffusion.
    pub fn drift(&self) -> f64 {
        (self.halves[0] - self.halves[1]).abs()
    }
}

/// What a signal is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Frequencies {
    /// Its mean, the line at zero.
    pub mean: f64,
    /// The lines, that of the largest amplitude first.
    pub lines: Vec<Line>,
    /// The root of the mean square of what is left.
    pub rest: f64,
}

/// Times that are off by more than this part of their distance are at no equal ones.
const EVEN: f64 = 1e-6;

/// The distance of times that are at equal ones, and how many of them are: all, or all but a last one behind a shorter step.
pub fn even(times: &[f64]) -> Option<(f64, usize)> {
    let of = |times: &[f64]| {
        let last = times.len().checked_sub(1).filter(|last| *last > 0)?;
        let distance = (times[last] - times[0]) / last as f64;
        let off = |(j, time): (usize, &f64)| (time - times[0] - j as f64 * distance).abs();
        let worst = times.iter().enumerate().map(off).fold(0.0, f64::max);
        (worst <= EVEN * distance.abs()).then_some((distance.abs(), times.len()))
    };
    of(times).or_else(|| of(&times[..times.len().saturating_sub(1)]))
}

/// Finds the lines of a signal whose samples have a distance; none of less than [`LEAST`] samples.
pub fn frequencies(values: &[f64], distance: f64, options: Options) -> Frequencies {
    let power = i32::from(options.window);
    let whole = |values: &[f64]| Lines::new(values, power);
    let mut lines = whole(values);
    if values.len() >= LEAST {
        lines.find(options.count);
    }
    let half = values.len() / 2;
    let parts = [&values[..half], &values[values.len() - half..]];
    let [first, second] = parts.map(|part| {
        let mut part = whole(part);
        part.follow(lines.waves.iter().map(|wave| wave.frequency));
        part.waves
    });
    let middle = 0.5 * (values.len() as f64 - 1.0);
    let of = |wave: &Wave, halves: [&Wave; 2]| {
        let behind = Scalar::atan2(wave.sine, wave.cosine);
        let phase = -(wave.frequency * middle + behind);
        Line {
            frequency: wave.frequency / distance,
            amplitude: wave.amplitude(),
            phase: phase - TAU * (phase / TAU).round(),
            halves: halves.map(|wave| wave.frequency / distance),
        }
    };
    let halves = first.iter().zip(&second).map(|(a, b)| [a, b]);
    let found = lines.waves.iter().zip(halves);
    let mut found: Vec<Line> = found.map(|(wave, halves)| of(wave, halves)).collect();
    found.sort_by(|a, b| b.amplitude.total_cmp(&a.amplitude));
    let squares = lines.rest.iter().map(|value| value * value);
    Frequencies {
        mean: lines.mean,
        lines: found,
        rest: (squares.sum::<f64>() / values.len().max(1) as f64).sqrt(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Amplitude, frequency in radians per sample, phase.
    type Known = (f64, f64, f64);

    const MEAN: f64 = 0.37;
    /// With one of few periods, two that are close, and a small one between large ones.
    const KNOWN: [Known; 5] = [
        (1.0, 0.618_034, 0.3),
        (0.4, 0.603_1, -2.9),
        (0.2, 0.014_7, 1.1),
        (0.03, 2.71, 2.2),
        (1e-4, 1.234_567, -0.7),
    ];

    fn signal(known: &[Known], length: usize) -> Vec<f64> {
        let at = |t: f64| known.iter().map(move |(a, w, phi)| a * (w * t + phi).cos());
        (0..length)
            .map(|j| MEAN + at(j as f64).sum::<f64>())
            .collect()
    }

    fn errors(found: &Frequencies) -> [f64; 3] {
        let pairs = found.lines.iter().zip(&KNOWN);
        pairs.fold([0.0; 3], |worst, (line, (a, w, phi))| {
            let turns = (line.phase - phi) / TAU;
            let off = [
                line.frequency - w,
                line.amplitude / a - 1.0,
                turns - turns.round(),
            ];
            [0, 1, 2].map(|i| f64::max(worst[i], off[i].abs()))
        })
    }

    #[test]
    fn lines_that_are_known_are_found() {
        let values = signal(&KNOWN, 4096);
        for window in [1, 2, 3] {
            let options = Options { count: 5, window };
            let found = frequencies(&values, 1.0, options);
            assert_eq!(found.lines.len(), 5, "{found:?}");
            let [frequency, amplitude, phase] = errors(&found);
            assert!(frequency < 1e-12, "{window}: {frequency:e} {found:?}");
            assert!(amplitude < 1e-9 && phase < 1e-9, "{amplitude:e} {phase:e}");
            assert!((found.mean - MEAN).abs() < 1e-12 && found.rest < 1e-12);
            let drift = found.lines.iter().map(|line| line.drift());
            assert!(drift.fold(0.0, f64::max) < 1e-9, "{found:?}");
        }
        // no line is made of round-off
        let more = frequencies(
            &values,
            1.0,
            Options {
                count: 9,
                window: 2,
            },
        );
        assert_eq!(more.lines.len(), 5, "{more:?}");
        // the control: without the one that is close, the largest is found where both are
        let one = frequencies(
            &values,
            1.0,
            Options {
                count: 1,
                window: 1,
            },
        );
        assert!(
            (one.lines[0].frequency - KNOWN[0].1).abs() > 1e-9,
            "{one:?}"
        );
    }

    #[test]
    fn the_distance_of_samples_is_their_unit_of_time() {
        let values = signal(&KNOWN[..1], 1000);
        let found = frequencies(&values, 0.02, Options::default());
        let [line] = found.lines.as_slice() else {
            panic!("{found:?}");
        };
        assert!((line.frequency * 0.02 - KNOWN[0].1).abs() < 1e-13);
        assert!((line.phase - KNOWN[0].2).abs() < 1e-11, "{line:?}");
    }

    #[test]
    fn a_frequency_that_changes_differs_in_the_halves() {
        let chirp = (0..4096).map(|j| f64::from(j) * (0.5 + 1e-6 * f64::from(j)));
        let values: Vec<f64> = chirp.map(f64::cos).collect();
        let found = frequencies(
            &values,
            1.0,
            Options {
                count: 1,
                window: 2,
            },
        );
        // the frequency at j is 0.5 + 2e-6 j, and the middles of the halves are 2048 apart
        let drift = found.lines[0].drift();
        assert!((drift / (2e-6 * 2048.0) - 1.0).abs() < 0.05, "{drift}");
    }

    #[test]
    fn equal_distances_are_told_from_others() {
        let times = |last: f64| [0.0, 0.1, 0.2, 0.1 + 0.2, last];
        let [(whole, all), (short, fewer)] = [0.4, 0.33].map(|last| even(&times(last)).unwrap());
        assert!((whole - 0.1).abs() < 1e-15 && (short - 0.1).abs() < 1e-15);
        assert_eq!((all, fewer), (5, 4));
        assert_eq!(even(&[0.0, -1.0, -2.0]), Some((1.0, 3)), "backwards");
        assert_eq!(even(&[0.0, 1.0, 3.0, 4.0]), None);
        assert_eq!(even(&[1.0]), None);
    }

    #[test]
    fn what_has_no_lines_has_none() {
        let options = Options::default();
        for values in [vec![], vec![1.0; 3], vec![0.0; 64], vec![2.5; 64]] {
            let found = frequencies(&values, 0.1, options);
            assert!(found.lines.is_empty(), "{found:?}");
        }
        assert_eq!(frequencies(&[2.5; 64], 0.1, options).mean, 2.5);
    }
}
