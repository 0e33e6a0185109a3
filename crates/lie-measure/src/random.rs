//! Random states that are the same on every machine.

use lie_runtime::poisson::Poisson;
use lie_runtime::state::State;

/// The generator xorshift64* (Vigna 2016, doi:10.1145/2845077).
#[derive(Clone, Debug)]
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        let mut random = Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
        // small seeds have few bits: let them spread
        for _ in 0..8 {
            random.unit();
        }
        random
    }

    /// A number between -1 and 1.
    pub(crate) fn unit(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let bits = self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11;
        bits as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// A state near another: each coordinate is moved by up to `part` of the largest.
    pub(crate) fn near<V: State<f64>>(&mut self, mu: &V, part: f64) -> V {
        let mut near = mu.clone();
        let size = mu.max_norm();
        let size = if size > 0.0 { size } else { 1.0 };
        for entry in near.as_mut_slice() {
            *entry += part * size * self.unit();
        }
        near
    }

    /// The same for a state of a system: beside the time the unit stays, without which there is no such motion.
    pub(crate) fn near_state<P: Poisson<f64>>(
        &mut self,
        system: &P,
        mu: &P::State,
        part: f64,
    ) -> P::State {
        let mut near = self.near(mu, part);
        if let Some(clock) = system.clock() {
            near.as_mut_slice()[clock.time + 1] = mu.as_slice()[clock.time + 1];
        }
        near
    }
}
