//! Random numbers by counters: the numbers of a step are those of its number, whoever asks for them, and in whatever order.

use crate::scalar::Scalar;
use core::f64::consts::TAU;

/// Philox4x32-10: four words of a counter and two of a key give four random words. J. K. Salmon, M. A. Moraes, R. O. Dror, D. E. Shaw,
/// "Parallel random numbers: as easy as 1, 2, 3", SC 2011, [doi:10.1145/2063384.2063405](https://doi.org/10.1145/2063384.2063405).
#[must_use]
pub fn philox(mut counter: [u32; 4], mut key: [u32; 2]) -> [u32; 4] {
    let product = |a: u32, b: u32| {
        let wide = u64::from(a) * u64::from(b);
        ((wide >> 32) as u32, wide as u32)
    };
    for _ in 0..10 {
        let (high, low) = product(0xD251_1F53, counter[0]);
        let (other_high, other_low) = product(0xCD9E_8D57, counter[2]);
        counter = [
            other_high ^ counter[1] ^ key[0],
            other_low,
            high ^ counter[3] ^ key[1],
            low,
        ];
        key = [
            key[0].wrapping_add(0x9E37_79B9),
            key[1].wrapping_add(0xBB67_AE85),
        ];
    }
    counter
}

/// So many pairs of processes have streams of their own within a stream.
const PROCESSES: u64 = 1 << 24;
/// The most processes of a run: more would have the numbers of another stream.
pub const MOST_PROCESSES: usize = 2 << 24;

/// Wiener processes.
#[derive(Clone, Debug)]
pub struct Wiener {
    seed: u64,
    streams: Vec<u64>,
    processes: usize,
    bounded: bool,
}

impl Wiener {
    /// So many processes of a seed, with a stream for each lane, such as the number of a member; lanes behind them have the last one. There
    /// are 2^40 streams.
    #[must_use]
    pub fn new(seed: u64, streams: &[u64], processes: usize) -> Self {
        Self {
            seed,
            streams: streams.to_vec(),
            processes,
            bounded: false,
        }
    }

    /// The same with increments that an implicit step can take.
    #[must_use]
    pub fn bounded(self, bounded: bool) -> Self {
        Self { bounded, ..self }
    }

    /// The largest |z| of a bounded increment in a step of a size: `sqrt(2 k |ln h|)` with k = 2, and at least 2.
    #[must_use]
    pub fn bound(size: f64) -> f64 {
        2.0 * size.abs().ln().abs().max(1.0).sqrt()
    }

    /// The rates `dW/dt` of a step of a size by its number, `z/sqrt(|h|)`.
    pub fn rates<S: Scalar>(&self, step: u64, size: f64, out: &mut [S]) {
        let scale = 1.0 / size.abs().sqrt();
        let bound = match self.bounded {
            true => Self::bound(size),
            false => f64::INFINITY,
        };
        for (process, rate) in out.iter_mut().take(self.processes).enumerate() {
            let lane = |lane: usize| {
                let stream = self.streams.get(lane).or(self.streams.last());
                let z = self.normal(step, stream.copied().unwrap_or(0), process as u64);
                scale * z.clamp(-bound, bound)
            };
            *rate = S::from_lanes(|index| S::Lane::from_f64(lane(index)));
        }
    }

    /// A normally distributed number, by the method of Box and Muller: processes come in pairs, of which one has the sine.
    fn normal(&self, step: u64, stream: u64, process: u64) -> f64 {
        let words = |value: u64| [value as u32, (value >> 32) as u32];
        let [low, high] = words(step);
        let [pair_low, pair_high] = words(stream * PROCESSES + process / 2);
        let bits = philox([low, high, pair_low, pair_high], words(self.seed));
        let uniform = |high: u32, low: u32| {
            let bits = (u64::from(high) << 32 | u64::from(low)) >> 11;
            (bits + 1) as f64 / (1_u64 << 53) as f64
        };
        let radius = (-2.0 * Scalar::log(uniform(bits[0], bits[1]))).sqrt();
        let angle = TAU * uniform(bits[2], bits[3]);
        radius
            * match process % 2 {
                0 => Scalar::cos(angle),
                _ => Scalar::sin(angle),
            }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The known answers of Random123, philox4x32 with 10 rounds.
    #[test]
    fn the_known_answers() {
        assert_eq!(
            philox([0; 4], [0; 2]),
            [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8]
        );
        assert_eq!(
            philox([u32::MAX; 4], [u32::MAX; 2]),
            [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd]
        );
        assert_eq!(
            philox(
                [0x243f_6a88, 0x85a3_08d3, 0x1319_8a2e, 0x0370_7344],
                [0xa409_3822, 0x299f_31d0]
            ),
            [0xd16c_fe09, 0x94fd_cceb, 0x5001_e420, 0x2412_6ea1]
        );
    }

    #[test]
    fn increments_are_normal_and_independent() {
        let wiener = Wiener::new(7, &[3], 3);
        let (steps, size) = (40_000, 0.25);
        let (mut sums, mut squares, mut fourth, mut mixed) = ([0.0; 3], [0.0; 3], 0.0, 0.0);
        for step in 0..steps {
            let mut rates = [0.0; 3];
            wiener.rates(step, size, &mut rates);
            let increments = rates.map(|rate| rate * size);
            for k in 0..3 {
                sums[k] += increments[k];
                squares[k] += increments[k] * increments[k];
            }
            fourth += increments[0].powi(4);
            mixed += increments[0] * increments[1] + increments[1] * increments[2];
        }
        let n = steps as f64;
        for k in 0..3 {
            assert!((sums[k] / n).abs() < 4.0 * (size / n).sqrt(), "{sums:?}");
            assert!(
                (squares[k] / n - size).abs() < 4.0 * size * (2.0 / n).sqrt(),
                "{squares:?}"
            );
        }
        assert!((fourth / n / (3.0 * size * size) - 1.0).abs() < 0.1);
        assert!((mixed / n).abs() < 4.0 * size * (2.0 / n).sqrt());
    }

    #[test]
    fn numbers_are_those_of_seed_stream_and_step() {
        let rates = |seed, stream, step| {
            let mut rates = [0.0; 2];
            Wiener::new(seed, &[stream], 2).rates(step, 0.1, &mut rates);
            rates
        };
        assert_eq!(rates(1, 2, 3), rates(1, 2, 3));
        let others = [rates(2, 2, 3), rates(1, 3, 3), rates(1, 2, 4)];
        assert!(others.iter().all(|other| *other != rates(1, 2, 3)));
        let mut long = [0.0];
        Wiener::new(1, &[0], 1)
            .bounded(true)
            .rates(0, 1e-3, &mut long);
        assert!((long[0] * 1e-3_f64.sqrt()).abs() <= 2.0 * 1e-3_f64.ln().abs().sqrt());
    }
}
