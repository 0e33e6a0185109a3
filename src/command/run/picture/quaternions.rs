//! Quaternions as a curve: q and -q are one rotation, and long steps take either.

use std::borrow::Cow;

use lie_codegen::program::Chart;

/// The last quaternion of a run that writes them.
#[derive(Default)]
pub struct Quaternions {
    /// Where they begin in a row.
    place: Option<usize>,
    last: Option<[f64; 4]>,
}

impl Quaternions {
    /// Those at a place in the rows of a run with this chart.
    pub fn of(chart: Option<Chart>, place: usize) -> Self {
        Self {
            place: (chart == Some(Chart::Quaternion)).then_some(place),
            last: None,
        }
    }

    /// A row with its quaternion as near to the one before as it can be.
    pub fn continued<'r>(&mut self, row: &'r [f64]) -> Cow<'r, [f64]> {
        let Some((place, here)) = self
            .place
            .and_then(|place| Some((place, four(row, place)?)))
        else {
            return row.into();
        };
        let product = |last: [f64; 4]| last.iter().zip(here).map(|(a, b)| a * b).sum::<f64>();
        if self.last.is_none_or(|last| product(last) >= 0.0) {
            self.last = Some(here);
            return row.into();
        }
        let other = here.map(|entry| -entry);
        self.last = Some(other);
        let mut row = row.to_vec();
        row[place..place + 4].copy_from_slice(&other);
        row.into()
    }
}

fn four(row: &[f64], place: usize) -> Option<[f64; 4]> {
    row.get(place..place + 4)?.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_turns_on_has_no_jumps() {
        let mut quaternions = Quaternions::of(Some(Chart::Quaternion), 1);
        let mut last = [1.0, 0.0];
        for k in 1..100 {
            let (s, c) = (0.1 * f64::from(k)).sin_cos();
            // whichever of the two has a positive real part
            let sign = if c < 0.0 { -1.0 } else { 1.0 };
            let row = [0.0, sign * c, sign * s, 0.0, 0.0];
            let drawn = quaternions.continued(&row);
            assert!((drawn[1] - last[0]).hypot(drawn[2] - last[1]) < 0.11);
            last = [drawn[1], drawn[2]];
        }
        // the same numbers where they are no quaternion
        let mut others = Quaternions::of(Some(Chart::Matrix), 1);
        for sign in [1.0, -1.0] {
            let row = [0.0, sign, 0.0, 0.0, 0.0];
            assert_eq!(*others.continued(&row), row);
        }
    }
}
