//! Points at which functions are looked at, the same in every run.

use crate::exact::Rational;
use crate::symbolic::{Graph, Symbol};

/// Values are multiples of this power of two, so that they are the same numbers in any arithmetic.
const LAST_BIT: i64 = -20;

/// A sequence of generic points.
#[derive(Default)]
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
    /// A hash of the point and a symbol.
    pub fn bits(self, symbol: Symbol) -> u64 {
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

    /// A value: numerator and power of two. Its size is between 0.1 and 3 at most points, at others between 0.01
    /// and 0.3, or 1 and 30, so that most domains contain some; it is positive at every fourth point and where
    /// the symbol is, and of either sign at the others.
    pub fn dyadic(self, graph: &Graph, symbol: Symbol) -> (i64, i64) {
        let bits = self.bits(symbol);
        let unit = (bits >> 11) as f64 / (1u64 << 53) as f64;
        let least = match self.seed % 8 {
            3 => 0.01,
            7 => 1.0,
            _ => 0.1,
        };
        let size = least * 30f64.powf(unit) * (-LAST_BIT as f64).exp2();
        let positive = self.seed % 4 == 1 || graph.is_positive(symbol) || bits & 1 == 0;
        let size = size as i64;
        (if positive { size } else { -size }, LAST_BIT)
    }

    /// The same value in double precision.
    pub fn value(self, graph: &Graph, symbol: Symbol) -> f64 {
        let (numerator, exponent) = self.dyadic(graph, symbol);
        numerator as f64 * (exponent as f64).exp2()
    }

    /// A small integer that is not zero.
    pub fn integer(self, graph: &Graph, symbol: Symbol) -> Rational {
        let bits = self.bits(symbol);
        let size = (bits >> 20) as i64 % 97 + 2;
        Rational::from(if bits & 1 == 1 && !graph.is_positive(symbol) {
            -size
        } else {
            size
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of the sizes that the text promises, of both signs where the symbol has no sign; integers are never zero.
    #[test]
    fn values_lie_where_they_should() {
        let mut graph = Graph::new();
        let (free, positive) = (Symbol::Coordinate(3), Symbol::Parameter(1));
        graph.assume_positive(positive);
        let mut signs = [0; 2];
        for sample in Samples::new().take(4000) {
            let (least, most) = match sample.seed % 8 {
                3 => (0.0099, 0.31),
                7 => (0.99, 30.1),
                _ => (0.099, 3.01),
            };
            for symbol in [free, positive] {
                let value = sample.value(&graph, symbol);
                assert!((least..most).contains(&value.abs()), "{value}");
                let (numerator, exponent) = sample.dyadic(&graph, symbol);
                assert_eq!(numerator as f64 * (exponent as f64).exp2(), value);
                let integer = sample.integer(&graph, symbol);
                assert!(!integer.is_zero());
                if symbol == positive {
                    assert!(value > 0.0 && !integer.is_negative());
                } else {
                    assert!(value > 0.0 || sample.seed % 4 != 1);
                    signs[usize::from(value > 0.0)] += 1;
                }
            }
        }
        // every fourth is positive, half of the others
        assert!((1350..1650).contains(&signs[0]), "{signs:?}");
    }
}
