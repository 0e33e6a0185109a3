//! Points at which functions are looked at, the same in every run.

use crate::exact::Rational;
use crate::symbolic::Symbol;

/// A sequence of generic points.
pub struct Samples(u64);

/// A generic point: a value for every symbol.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    seed: u64,
}

impl Samples {
    /// The sequence from its beginning.
    pub fn new() -> Self {
        Self(0)
    }
}

impl Iterator for Samples {
    type Item = Sample;
    fn next(&mut self) -> Option<Sample> {
        self.0 += 1;
        Some(Sample { seed: self.0 })
    }
}

impl Sample {
    fn bits(self, symbol: Symbol) -> u64 {
        let (kind, index) = match symbol {
            Symbol::Parameter(i) => (1, i),
            Symbol::Step => (2, 0),
            Symbol::Time => (3, 0),
            Symbol::Coordinate(i) => (4, i),
            Symbol::Input(i) => (5, i),
        };
        // splitmix64
        let mut z = self.seed.wrapping_mul(0x9e37_79b9_7f4a_7c15)
            ^ (kind << 60)
            ^ (index as u64).wrapping_mul(0xd1b5_4a32_d192_ed03);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A value of magnitude 0.1 to 3; positive at the odd points, of either sign at the even ones.
    pub fn value(self, symbol: Symbol) -> f64 {
        let bits = self.bits(symbol);
        let unit = (bits >> 11) as f64 / (1u64 << 53) as f64;
        let size = 0.1 * 30f64.powf(unit);
        if self.seed.is_multiple_of(2) && bits & 1 == 1 {
            -size
        } else {
            size
        }
    }

    /// A small integer that is not zero.
    pub fn integer(self, symbol: Symbol) -> Rational {
        let bits = self.bits(symbol);
        let size = (bits >> 20) as i64 % 97 + 2;
        Rational::from(if bits & 1 == 1 { -size } else { size })
    }
}
