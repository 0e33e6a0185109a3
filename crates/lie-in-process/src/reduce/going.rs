//! Members without the last states of those that an event has ended.

use std::io::{self, Read};

/// Reads an array of members; those that are gone have no numbers.
pub struct Going<'a, R> {
    members: R,
    /// The bytes of a member.
    size: usize,
    /// Which members are gone; members behind the last of these are not.
    gone: &'a [bool],
    /// Bytes that were read.
    place: usize,
}

impl<'a, R> Going<'a, R> {
    /// Of members with so many numbers each.
    pub fn new(members: R, numbers: usize, gone: &'a [bool]) -> Self {
        Self {
            members,
            size: numbers * size_of::<f64>(),
            gone,
            place: 0,
        }
    }
}

impl<R: Read> Read for Going<'_, R> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let count = self.members.read(bytes)?;
        if !self.gone.is_empty() {
            let none = f64::NAN.to_le_bytes();
            for (byte, place) in bytes[..count].iter_mut().zip(self.place..) {
                if self.gone.get(place / self.size) == Some(&true) {
                    *byte = none[place % none.len()];
                }
            }
        }
        self.place += count;
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn those_that_are_gone_have_no_numbers() {
        let numbers: Vec<u8> = (0..8_u8).flat_map(|x| f64::from(x).to_le_bytes()).collect();
        // a buffer that ends within numbers
        let reader = io::BufReader::with_capacity(13, &numbers[..]);
        let mut bytes = Vec::new();
        let mut going = Going::new(reader, 2, &[false, true, false]);
        going.read_to_end(&mut bytes).expect("bytes");
        let found = bytes.chunks_exact(8);
        let found = found.map(|x| f64::from_le_bytes(x.try_into().expect("8 bytes")));
        let found: Vec<f64> = found.collect();
        assert!(found[2].is_nan() && found[3].is_nan());
        assert_eq!(
            (&found[..2], &found[4..]),
            (&[0.0, 1.0][..], &[4.0, 5.0, 6.0, 7.0][..])
        );
    }
}
