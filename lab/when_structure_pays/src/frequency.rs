//! The frequency of the strongest line of a signal, by Laskar's numerical analysis of the fundamental frequency: the maximum
//! of
//!
//! ```text
//! |sum_k w_k z_k exp(-i omega t_k)|,    w the square of a Hann window
//! ```
//!
//! The window has side lobes that fall with the fifth power of their distance. J. Laskar, "Frequency analysis for multi-dimensional
//! systems. Global dynamics and diffusion", Physica D 67 (1993) 257–281, doi:10.1016/0167-2789(93)90210-R.

use std::f64::consts::PI;

/// The angular frequency near `guess` (within a width of the window's peak) of a signal at times k dt.
pub fn refined(signal: &[(f64, f64)], dt: f64, guess: f64) -> f64 {
    let n = signal.len() as f64;
    let weighted: Vec<(f64, f64)> = signal
        .iter()
        .enumerate()
        .map(|(k, (re, im))| {
            let w = (PI * (k as f64 + 0.5) / n).sin().powi(4);
            (w * re, w * im)
        })
        .collect();
    let power = |omega: f64| {
        let (mut re, mut im) = (0.0, 0.0);
        let turn = (omega * dt).sin_cos();
        let (mut c, mut s) = (1.0, 0.0);
        for (k, (x, y)) in weighted.iter().enumerate() {
            if k % 256 == 0 {
                let angle = (omega * dt * k as f64).sin_cos();
                (s, c) = angle;
            }
            re += x * c + y * s;
            im += y * c - x * s;
            (c, s) = (c * turn.1 - s * turn.0, s * turn.1 + c * turn.0);
        }
        re * re + im * im
    };
    // the peak of this window is two frequencies of the span wide on either side
    let resolution = 2.0 * PI / (n * dt);
    let (mut best, mut most) = (guess, 0.0);
    for k in -8..=8 {
        let omega = guess + 0.5 * resolution * f64::from(k);
        let here = power(omega);
        if here > most {
            (best, most) = (omega, here);
        }
    }
    // parabolas through three points of the logarithm, on finer and finer scales
    for width in [0.5, 0.1, 0.02, 4e-3] {
        let h = width * resolution;
        let [a, b, c] = [best - h, best, best + h].map(|omega| power(omega).ln());
        let shift = 0.5 * (a - c) / (a - 2.0 * b + c);
        best += h * shift.clamp(-1.0, 1.0);
    }
    best
}

/// The strongest line below half the frequency of the samples: from a plain transform of the beginning of the signal, refined on
/// longer and longer parts.
pub fn strongest(signal: &[(f64, f64)], dt: f64) -> f64 {
    let mut line = roughly(&signal[..signal.len().min(2048)], dt);
    let mut length = 2048;
    while length < signal.len() {
        line = refined(&signal[..length], dt, line);
        length *= 4;
    }
    refined(signal, dt, line)
}

/// The same by a plain transform.
fn roughly(signal: &[(f64, f64)], dt: f64) -> f64 {
    let n = signal.len();
    let mut best = (0.0, 0.0);
    for k in -(n as i32)..n as i32 {
        let omega = PI * f64::from(k) / (n as f64 * dt);
        let (mut re, mut im) = (0.0, 0.0);
        for (j, (x, y)) in signal.iter().enumerate() {
            let w = (PI * (j as f64 + 0.5) / n as f64).sin().powi(2);
            let (s, c) = (omega * dt * j as f64).sin_cos();
            re += w * (x * c + y * s);
            im += w * (y * c - x * s);
        }
        let power = re * re + im * im;
        if power > best.1 {
            best = (omega, power);
        }
    }
    best.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(lines: &[(f64, f64)], n: usize, dt: f64) -> Vec<(f64, f64)> {
        let at = |k: usize| {
            let t = k as f64 * dt;
            let sum = |part: fn(f64) -> f64| lines.iter().map(|(a, w)| a * part(w * t)).sum();
            (sum(f64::cos), sum(f64::sin))
        };
        (0..n).map(at).collect()
    }

    #[test]
    fn a_line_beside_others_is_found() {
        let signal = wave(&[(1.0, 0.7312345), (0.4, -0.31), (0.2, 1.9)], 20_000, 0.5);
        let rough = strongest(&signal, 0.5);
        assert!((rough - 0.7312345).abs() < 1e-12, "{rough}");
        let found = refined(&signal, 0.5, rough + 1e-4);
        assert!((found - 0.7312345).abs() < 1e-12, "{found}");
    }

    #[test]
    fn a_line_that_moves_is_told_from_one_that_stays() {
        let still = wave(&[(1.0, 0.7)], 20_000, 0.5);
        let moved = wave(&[(1.0, 0.7 + 1e-9)], 20_000, 0.5);
        let difference = refined(&moved, 0.5, 0.7) - refined(&still, 0.5, 0.7);
        assert!((difference - 1e-9).abs() < 1e-12, "{difference}");
    }
}
