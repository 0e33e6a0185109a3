//! A curve thinned out to columns of time.

/// Values of a curve, at most four per column.
#[derive(Clone, Debug)]
pub struct Bins {
    range: (f64, f64),
    columns: Vec<Option<Column>>,
    /// Columns in which a value was not finite: the curve has a gap there.
    gaps: Vec<bool>,
    pushed: u64,
}

/// First, smallest, largest and last value of a column, with their times.
#[derive(Clone, Copy, Debug)]
struct Column {
    first: (f64, f64),
    smallest: (f64, f64),
    largest: (f64, f64),
    last: (f64, f64),
}

impl Bins {
    pub fn new(range: (f64, f64), columns: usize) -> Self {
        let columns = columns.max(1);
        Self {
            range,
            columns: vec![None; columns],
            gaps: vec![false; columns],
            pushed: 0,
        }
    }

    pub fn push(&mut self, t: f64, value: f64) {
        let (from, to) = self.range;
        let place = (t - from) / (to - from);
        let all = self.columns.len();
        // A NaN becomes 0; times outside go to the nearest column.
        let index = ((place * all as f64) as usize).min(all - 1);
        self.pushed += 1;
        if !value.is_finite() {
            self.gaps[index] = true;
            return;
        }
        let point = (t, value);
        match &mut self.columns[index] {
            Some(column) => {
                if value < column.smallest.1 {
                    column.smallest = point;
                }
                if value > column.largest.1 {
                    column.largest = point;
                }
                column.last = point;
            }
            empty => {
                *empty = Some(Column {
                    first: point,
                    smallest: point,
                    largest: point,
                    last: point,
                });
            }
        }
    }

    /// Smallest and largest value.
    pub fn bounds(&self) -> Option<(f64, f64)> {
        let all = self.columns.iter().flatten();
        all.map(|column| (column.smallest.1, column.largest.1))
            .reduce(|(a, b), (c, d)| (a.min(c), b.max(d)))
    }

    /// The curve in pieces between its gaps, in order of the rows.
    pub fn pieces(&self) -> Vec<Vec<(f64, f64)>> {
        self.assemble(|column, piece| {
            let Column {
                first,
                smallest,
                largest,
                last,
            } = *column;
            let forwards = (smallest.0 <= largest.0) == (self.range.0 <= self.range.1);
            let (one, two) = if forwards {
                (smallest, largest)
            } else {
                (largest, smallest)
            };
            for point in [first, one, two, last] {
                if piece.last() != Some(&point) {
                    piece.push(point);
                }
            }
        })
    }

    /// Only the largest value of each column: the envelope of a curve that dances between it and
    /// zero. While rows are as few as columns, it is the curve.
    pub fn upper_envelope(&self) -> Vec<Vec<(f64, f64)>> {
        if self.pushed <= 2 * self.columns.len() as u64 {
            return self.pieces();
        }
        self.assemble(|column, piece| piece.push(column.largest))
    }

    fn assemble(&self, mut add: impl FnMut(&Column, &mut Vec<(f64, f64)>)) -> Vec<Vec<(f64, f64)>> {
        let mut pieces = vec![Vec::new()];
        for (column, gap) in self.columns.iter().zip(&self.gaps) {
            if let (Some(column), Some(piece)) = (column, pieces.last_mut()) {
                add(column, piece);
            }
            if *gap {
                pieces.push(Vec::new());
            }
        }
        pieces.retain(|piece| !piece.is_empty());
        pieces
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_points_stay_as_they_are() {
        let mut bins = Bins::new((0.0, 10.0), 100);
        let points: Vec<(f64, f64)> = (0..11)
            .map(|k| (f64::from(k), f64::from(k * k % 7)))
            .collect();
        points.iter().for_each(|&(t, v)| bins.push(t, v));
        assert_eq!(bins.pieces(), std::slice::from_ref(&points));
        assert_eq!(bins.upper_envelope(), [points]);
    }

    #[test]
    fn many_points_keep_their_extremes_in_order() {
        for (from, to) in [(0.0, 1.0), (0.0, -1.0)] {
            let mut bins = Bins::new((from, to), 10);
            for k in 0..=100_000 {
                let t = f64::from(k) * 1e-5 * (to - from);
                bins.push(t, if k == 54_321 { 9.0 } else { (50.0 * t).sin() });
            }
            let [piece] = &bins.pieces()[..] else {
                panic!("one piece")
            };
            assert!(piece.len() <= 40);
            assert!(
                piece
                    .windows(2)
                    .all(|w| (w[1].0 - w[0].0) * (to - from) >= 0.0),
                "{piece:?}"
            );
            assert_eq!(bins.bounds().map(|bounds| bounds.1), Some(9.0));
            assert_eq!(bins.upper_envelope()[0].len(), 10);
        }
    }

    #[test]
    fn what_is_not_finite_leaves_a_gap() {
        let mut bins = Bins::new((0.0, 3.0), 4);
        for (t, v) in [
            (0.0, 1.0),
            (1.0, f64::NAN),
            (2.0, f64::INFINITY),
            (3.0, 2.0),
        ] {
            bins.push(t, v);
        }
        assert_eq!(bins.pieces(), [vec![(0.0, 1.0)], vec![(3.0, 2.0)]]);
        let mut empty = Bins::new((0.0, 0.0), 4);
        assert_eq!((empty.bounds(), empty.pieces().len()), (None, 0));
        empty.push(0.0, 5.0);
        empty.push(f64::NAN, 6.0);
        assert_eq!(empty.bounds(), Some((5.0, 6.0)));
    }
}
