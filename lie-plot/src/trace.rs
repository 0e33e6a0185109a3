//! A curve in the plane, thinned out to what can be seen of it.

use super::svg::Place;
use std::collections::HashSet;

/// Cells along the longer side of what was seen so far: about two pixels each.
const CELLS: f64 = 320.0;

/// A curve that takes points one by one, in constant memory: a segment all of whose cells are covered already is not kept,
/// since nothing more would be seen. What is drawn covers the same cells as all of the curve, its extremes among them.
#[derive(Clone, Debug, Default)]
pub struct Trace {
    pieces: Vec<Vec<Place>>,
    last: Option<Place>,
    /// The least and the largest coordinates.
    bounds: Option<(Place, Place)>,
    cell: f64,
    covered: HashSet<(i32, i32)>,
}

impl Trace {
    /// Takes the next point; one that is not finite leaves a gap.
    pub fn push(&mut self, point: Place) {
        if !(point.0.is_finite() && point.1.is_finite()) {
            self.last = None;
            return;
        }
        self.grow(point);
        let from = self.last.replace(point);
        self.segment(from, point);
    }

    /// Leaves a gap before the next point.
    pub fn lift(&mut self) {
        self.last = None;
    }

    /// What is seen of the curve.
    pub fn pieces(&self) -> &[Vec<Place>] {
        &self.pieces
    }

    /// The least and the largest coordinates of all points.
    pub fn bounds(&self) -> Option<(Place, Place)> {
        self.bounds
    }

    fn grow(&mut self, (x, y): Place) {
        let ((a, b), (c, d)) = self.bounds.unwrap_or(((x, y), (x, y)));
        let (low, high) = ((a.min(x), b.min(y)), (c.max(x), d.max(y)));
        self.bounds = Some((low, high));
        let size = (high.0 - low.0).max(high.1 - low.1);
        if size > 2.0 * self.cell * CELLS {
            // coarser cells, into which what there is is sorted again
            self.cell = size / CELLS;
            self.covered.clear();
            let pieces = std::mem::take(&mut self.pieces);
            for piece in &pieces {
                let mut from = None;
                for &point in piece {
                    self.segment(from.replace(point), point);
                }
            }
        }
    }

    fn segment(&mut self, from: Option<Place>, to: Place) {
        let start = from.unwrap_or(to);
        let mut new = false;
        let (dx, dy) = (to.0 - start.0, to.1 - start.1);
        let steps = (dx.abs().max(dy.abs()) / self.cell.max(f64::MIN_POSITIVE)).ceil();
        let steps = steps.clamp(1.0, 4.0 * CELLS) as u32;
        for k in 0..=steps {
            let part = f64::from(k) / f64::from(steps);
            let at = (start.0 + part * dx, start.1 + part * dy);
            let cell = |x: f64| match self.cell > 0.0 {
                true => (x / self.cell).floor() as i32,
                false => 0,
            };
            new |= self.covered.insert((cell(at.0), cell(at.1)));
        }
        if !new && self.cell > 0.0 {
            return;
        }
        match self.pieces.last_mut() {
            Some(piece) if piece.last() == Some(&start) => piece.push(to),
            _ if from.is_some() => self.pieces.push(vec![start, to]),
            _ => self.pieces.push(vec![to]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A curve that fills a ring: so many points of it.
    fn ring(count: u32) -> Trace {
        let mut trace = Trace::default();
        for k in 0..count {
            let t = 0.05 * f64::from(k);
            let r = 1.0 + 0.5 * (0.01 * 2.0_f64.sqrt() * t).cos();
            trace.push((r * t.cos(), r * t.sin()));
        }
        trace
    }

    fn kept(trace: &Trace) -> usize {
        trace.pieces().iter().map(Vec::len).sum()
    }

    #[test]
    fn what_is_covered_is_not_kept_again() {
        let (short, long) = (ring(100_000), ring(1_000_000));
        assert!(kept(&short) > 5_000);
        assert!(
            kept(&long) < kept(&short) + kept(&short) / 2,
            "{}",
            kept(&long)
        );
        let ((left, bottom), (right, top)) = long.bounds().unwrap();
        // the extremes are among what is kept
        let points = || long.pieces().iter().flatten();
        let reach = |of: fn(&Place) -> f64| points().map(of).fold(f64::MIN, f64::max);
        let size = (right - left) / CELLS;
        assert!(right - reach(|p| p.0) < 2.0 * size && top - reach(|p| p.1) < 2.0 * size);
        assert!(-left - reach(|p| -p.0) < 2.0 * size && -bottom - reach(|p| -p.1) < 2.0 * size);
    }

    #[test]
    fn gaps_stay() {
        let mut trace = Trace::default();
        for point in [
            (0.0, 0.0),
            (1.0, 0.0),
            (f64::NAN, 0.0),
            (1.0, 1.0),
            (0.0, 1.0),
        ] {
            trace.push(point);
        }
        assert_eq!(trace.pieces().len(), 2);
        let mut point = Trace::default();
        point.push((2.0, 3.0));
        point.push((2.0, 3.0));
        assert_eq!(point.pieces()[0][0], (2.0, 3.0));
    }
}
