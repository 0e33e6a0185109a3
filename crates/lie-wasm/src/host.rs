//! What a module imports: the elementary functions of the numeric core.

use lie_dynamic::{BINARY, Binary, UNARY, Unary, phi, stumpff};
use lie_runtime::closed::MOST_FUNCTIONS;
use std::cell::Cell;

/// The function with an index of a family, of which those below a count are asked for.
pub type Family = extern "C" fn(u32, u32, f64) -> f64;

/// A function that the host gives to a module.
#[derive(Clone, Copy, Debug)]
pub enum Host {
    /// Of one number.
    Unary(Unary),
    /// Of two numbers.
    Binary(Binary),
    /// One of those of closed forms: of how many there are, its index, and the number.
    Family(Family),
}

impl Host {
    /// The function under a name.
    pub(crate) fn named(name: &str) -> Option<Self> {
        let unary = UNARY.iter().find(|(known, _)| *known == name);
        let binary = BINARY.iter().find(|(known, _)| *known == name);
        let family = FAMILIES.iter().find(|(known, _)| *known == name);
        unary
            .map(|(_, function)| Self::Unary(*function))
            .or(binary.map(|(_, function)| Self::Binary(*function)))
            .or(family.map(|(_, function)| Self::Family(*function)))
    }
}

const FAMILIES: &[(&str, Family)] = &[("stumpff", one_stumpff), ("phi", one_phi)];

/// All functions of a family, of the last number they were asked for.
type Kept = Cell<(u32, u64, [f64; MOST_FUNCTIONS])>;

thread_local! {
    static STUMPFF: Kept = const { Cell::new((0, 0, [0.0; MOST_FUNCTIONS])) };
    static PHI: Kept = const { Cell::new((0, 0, [0.0; MOST_FUNCTIONS])) };
}

extern "C" fn one_stumpff(count: u32, index: u32, x: f64) -> f64 {
    STUMPFF.with(|kept| one(kept, stumpff, count, index, x))
}
extern "C" fn one_phi(count: u32, index: u32, x: f64) -> f64 {
    PHI.with(|kept| one(kept, phi, count, index, x))
}

/// A function of a family. A code asks for all of them one behind the other, and they are computed together.
fn one(
    kept: &Kept,
    all: fn(u8, f64) -> [f64; MOST_FUNCTIONS],
    count: u32,
    index: u32,
    x: f64,
) -> f64 {
    let (of, bits, values) = kept.get();
    if (of, bits) == (count, x.to_bits()) {
        return values[index as usize];
    }
    let values = all(count as u8, x);
    kept.set((count, x.to_bits(), values));
    values[index as usize]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A family is computed again where its size or its argument is another one.
    #[test]
    fn families_are_those_of_the_core() {
        for (count, x) in [(4, 0.3), (5, 0.3), (5, -20.0), (5, 20.0), (4, 0.3)] {
            for index in 0..count {
                let (s, p) = (stumpff(count as u8, x), phi(count as u8, x));
                let (one_s, one_p) = (one_stumpff(count, index, x), one_phi(count, index, x));
                assert_eq!(one_s.to_bits(), s[index as usize].to_bits());
                assert_eq!(one_p.to_bits(), p[index as usize].to_bits());
            }
        }
    }
}
