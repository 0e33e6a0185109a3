//! Initial states of families.

use crate::scalar::Scalar;
use std::vec::Vec;

/// SplitMix64: G. L. Steele, D. Lea, C. H. Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014,
/// [doi:10.1145/2660193.2660195](https://doi.org/10.1145/2660193.2660195).
#[derive(Clone, Debug)]
pub struct SplitMix(u64);

impl SplitMix {
    /// From a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// A number above 0 and at most 1, with 53 bits.
    pub fn uniform(&mut self) -> f64 {
        ((self.bits() >> 11) + 1) as f64 / (1_u64 << 53) as f64
    }

    /// A normally distributed number, by the method of Box and Muller.
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * Scalar::log(self.uniform())).sqrt();
        radius * Scalar::cos(2.0 * core::f64::consts::PI * self.uniform())
    }
}

/// A state of so many sites whose coordinates are a point on the unit sphere each, drawn uniformly. The sites are drawn
/// one after the other: a larger family begins with those of a smaller one.
#[must_use]
pub fn unit_spheres<S: Scalar>(sites: usize, dimension: usize, seed: u64) -> Vec<S> {
    let mut state = std::vec![S::zero(); sites * dimension];
    let mut source = SplitMix(seed);
    let mut point = std::vec![0.0_f64; dimension];
    for site in 0..sites {
        let square = loop {
            point.fill_with(|| source.normal());
            let square: f64 = point.iter().map(|x| x * x).sum();
            if square > 1e-20 {
                break square;
            }
        };
        for (k, x) in point.iter().enumerate() {
            state[k * sites + site] = S::from_f64(x / square.sqrt());
        }
    }
    state
}
