//! A hash: of everything that goes into a built program, and of files that must be what they were.

/// FNV-1a with 128 bits (Fowler, Noll, Vo), over bytes or over words, stable across versions of Rust and machines.
///
/// It needs no package and no cryptography: whoever can write to the cache can do worse than
/// find a collision, and the generated source is compared byte by byte besides.
pub struct Key(u128);

impl Default for Key {
    fn default() -> Self {
        Self::new()
    }
}

impl Key {
    const BASIS: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
    const PRIME: u128 = 0x0000_0000_0100_0000_0000_0000_0000_013b;

    /// The hash of nothing.
    #[must_use]
    pub fn new() -> Self {
        Self(Self::BASIS)
    }

    /// Adds one ingredient; its length is hashed too, so that ingredients cannot run together.
    #[must_use]
    pub fn update(self, ingredient: &str) -> Self {
        self.bytes(ingredient.as_bytes())
            .bytes(&(ingredient.len() as u64).to_le_bytes())
    }

    /// The hash of one text of bytes, as digits.
    #[must_use]
    pub fn digest(bytes: &[u8]) -> String {
        Self::new().bytes(bytes).hex()
    }

    /// Adds bytes of a text that comes in parts: how it is cut makes no difference.
    #[must_use]
    pub fn bytes(mut self, bytes: &[u8]) -> Self {
        for &byte in bytes {
            self.0 = (self.0 ^ u128::from(byte)).wrapping_mul(Self::PRIME);
        }
        self
    }

    /// Adds a long text, eight bytes at a time, as the same recurrence over words; its length is hashed too.
    #[must_use]
    pub fn long(mut self, text: &str) -> Self {
        let mut words = text.as_bytes();
        while let Some((word, rest)) = words.split_first_chunk() {
            let word = u64::from_le_bytes(*word);
            self.0 = (self.0 ^ u128::from(word)).wrapping_mul(Self::PRIME);
            words = rest;
        }
        self.bytes(words).bytes(&(text.len() as u64).to_le_bytes())
    }

    /// 32 hexadecimal digits.
    #[must_use]
    pub fn hex(&self) -> String {
        format!("{:032x}", self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_values() {
        assert_eq!(Key::new().hex(), "6c62272e07bb014262b821756295c58d");
        assert_eq!(
            Key::new().bytes(b"a").hex(),
            "d228cb696f1a8caf78912b704e4a8964"
        );
        assert_eq!(
            Key::new().bytes(b"foobar").hex(),
            "343e1662793c64bf6f0d3597ba446f18"
        );
    }

    #[test]
    fn every_byte_of_a_long_text_counts() {
        let text = "0123456789".repeat(5);
        let mut keys = std::collections::BTreeSet::new();
        // with none, one and two other bytes, the last one of a word among them, whose bits are the highest
        for one in 0..=text.len() {
            for other in one..=text.len() {
                let mut text = text.clone().into_bytes();
                for place in [one, other] {
                    let byte = text.get_mut(place);
                    byte.into_iter().for_each(|byte| *byte ^= 0x40);
                }
                let text = String::from_utf8(text).expect("letters and digits");
                keys.insert((Key::new().long(&text).hex(), text));
            }
        }
        let texts: std::collections::BTreeSet<_> = keys.iter().map(|(_, text)| text).collect();
        let hashes: std::collections::BTreeSet<_> = keys.iter().map(|(key, _)| key).collect();
        assert_eq!(
            (texts.len(), hashes.len()),
            (1 + 50 + 50 * 49 / 2, texts.len())
        );
        let joined = Key::new().long("ab").long("c").hex();
        assert_ne!(joined, Key::new().long("a").long("bc").hex());
    }

    #[test]
    fn ingredients_do_not_run_together() {
        let joined = Key::new().update("ab").update("c").hex();
        assert_ne!(joined, Key::new().update("a").update("bc").hex());
        assert_ne!(joined, Key::new().update("abc").hex());
    }
}
