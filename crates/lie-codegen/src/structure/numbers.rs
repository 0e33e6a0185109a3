//! Numbers that look random, for declarations in tests.

use lie_symbolic::exact::Rational;

/// Numbers from a linear congruence.
pub struct Numbers(pub u64);

impl Numbers {
    /// A whole number below another one.
    pub fn below(&mut self, count: u64) -> u64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (self.0 >> 33) % count
    }

    /// Not zero, of either sign.
    pub fn factor(&mut self) -> Rational {
        let sign = if self.below(2) == 0 { 1 } else { -1 };
        let (above, below) = (1 + self.below(9) as i64, 1 + self.below(5) as i64);
        Rational::new(sign * above, below).expect("a number")
    }
}
