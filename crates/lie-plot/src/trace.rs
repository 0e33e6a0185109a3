//! A curve in the plane, thinned out to what can be seen of it.

use super::svg::Place;
use std::collections::HashSet;

/// Cells along the longer side of what was seen so far, or along both sides: about two pixels each.
const CELLS: f64 = 320.0;
/// So many points of a part that is covered already are drawn all the same, where a curve comes to it and where it leaves it:
/// crossing curves have no gaps.
const OVERLAP: usize = 6;

/// A curve that takes points one by one, in constant memory: a longer part all of whose cells are covered already is not kept,
/// since nothing more would be seen. What is drawn covers the same cells as all of the curve, its extremes among them.
#[derive(Clone, Debug, Default)]
pub struct Trace {
    pieces: Vec<Vec<Place>>,
    last: Option<Place>,
    /// The least and the largest coordinates.
    bounds: Option<(Place, Place)>,
    /// Whether the axes have scales of their own.
    stretched: bool,
    cell: Place,
    covered: HashSet<(i32, i32)>,
    /// The last points over covered cells, which are drawn if the curve leaves these soon.
    waiting: Vec<Place>,
    /// Whether the last piece goes on with them.
    down: bool,
}

impl Trace {
    /// A curve without points, to be drawn with a scale of its own for each axis.
    pub fn stretched() -> Self {
        Self {
            stretched: true,
            ..Self::default()
        }
    }

    /// Takes the next point; one that is not finite leaves a gap.
    pub fn push(&mut self, point: Place) {
        if !(point.0.is_finite() && point.1.is_finite()) {
            self.lift();
            return;
        }
        self.grow(point);
        let from = self.last.replace(point);
        self.segment(from, point);
    }

    /// Leaves a gap before the next point.
    pub fn lift(&mut self) {
        self.last = None;
        self.rest();
    }

    /// What is seen of the curve.
    pub fn pieces(&self) -> &[Vec<Place>] {
        &self.pieces
    }

    /// The least and the largest coordinates of all points.
    pub fn bounds(&self) -> Option<(Place, Place)> {
        self.bounds
    }

    /// Ends the last piece, with what waits behind it.
    fn rest(&mut self) {
        let waiting = std::mem::take(&mut self.waiting);
        if let (true, Some(piece)) = (std::mem::take(&mut self.down), self.pieces.last_mut()) {
            piece.extend(waiting);
        }
    }

    fn grow(&mut self, (x, y): Place) {
        let ((a, b), (c, d)) = self.bounds.unwrap_or(((x, y), (x, y)));
        let (low, high) = ((a.min(x), b.min(y)), (c.max(x), d.max(y)));
        self.bounds = Some((low, high));
        let (width, height) = (high.0 - low.0, high.1 - low.1);
        let (width, height) = match self.stretched {
            true => (width, height),
            false => (width.max(height), width.max(height)),
        };
        let outgrown = |size: f64, cell: f64| size > 2.0 * cell * CELLS;
        if outgrown(width, self.cell.0) || outgrown(height, self.cell.1) {
            // coarser cells, into which what there is is sorted again
            self.cell = (width / CELLS, height / CELLS);
            self.covered.clear();
            let down = self.down;
            self.rest();
            for piece in std::mem::take(&mut self.pieces) {
                self.rest();
                let mut from = None;
                for point in piece {
                    self.segment(from.replace(point), point);
                }
            }
            if !down {
                self.rest();
            }
        }
    }

    fn cell(&self, (x, y): Place) -> (i32, i32) {
        let along = |x: f64, cell: f64| match cell > 0.0 {
            true => (x / cell).floor() as i32,
            false => 0,
        };
        (along(x, self.cell.0), along(y, self.cell.1))
    }

    /// The larger of the distances along the axes, in cells.
    fn apart(&self, from: Place, to: Place) -> f64 {
        let along = |d: f64, cell: f64| d.abs() / cell.max(f64::MIN_POSITIVE);
        let (across, up) = (
            along(to.0 - from.0, self.cell.0),
            along(to.1 - from.1, self.cell.1),
        );
        across.max(up)
    }

    fn segment(&mut self, from: Option<Place>, to: Place) {
        let start = from.unwrap_or(to);
        let mut new = self.cell == (0.0, 0.0);
        let steps = self.apart(start, to).ceil().clamp(1.0, 4.0 * CELLS) as u32;
        for k in 0..=steps {
            let part = f64::from(k) / f64::from(steps);
            let at = (
                start.0 + part * (to.0 - start.0),
                start.1 + part * (to.1 - start.1),
            );
            let cell = self.cell(at);
            new |= self.covered.insert(cell);
        }
        if new {
            self.draw(start, to);
        } else {
            self.wait(to);
        }
    }

    fn draw(&mut self, start: Place, to: Place) {
        let mut waiting = std::mem::take(&mut self.waiting);
        if !std::mem::replace(&mut self.down, true) {
            self.pieces.push(Vec::new());
        }
        let Some(mut piece) = self.pieces.pop() else {
            return;
        };
        piece.append(&mut waiting);
        let near = |last: &Place| self.apart(*last, start) < 0.5;
        if !piece.last().is_some_and(near) {
            piece.push(start);
        }
        if piece.last() != Some(&to) {
            piece.push(to);
        }
        self.pieces.push(piece);
    }

    fn wait(&mut self, to: Place) {
        let ends = self.pieces.last().filter(|_| self.down);
        let before = self.waiting.last().or(ends.and_then(|piece| piece.last()));
        if before.is_some_and(|before| self.apart(*before, to) < 0.5) {
            return;
        }
        self.waiting.push(to);
        if self.waiting.len() > OVERLAP {
            match self.down {
                true => self.rest(),
                false => drop(self.waiting.remove(0)),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

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
    fn a_slow_curve_that_crosses_itself_is_one_line() {
        for (mut trace, height) in [(Trace::default(), 50.0), (Trace::stretched(), 1.0)] {
            // an eight in steps of a fraction of a cell
            for k in 0..20_000 {
                let t = TAU * 0.5e-4 * f64::from(k);
                trace.push((100.0 * t.sin(), height * (2.0 * t).sin()));
            }
            assert_eq!(trace.pieces().len(), 1);
            assert!(kept(&trace) < 4_000, "{}", kept(&trace));
        }
    }

    #[test]
    fn what_is_left_out_is_not_bridged() {
        let mut trace = Trace::default();
        // a circle twice, then a line away from it
        for k in 0..=2_250 {
            let (y, x) = (TAU * 1e-3 * f64::from(k)).sin_cos();
            trace.push((x, y));
        }
        for k in 1..=100 {
            trace.push((0.01 * f64::from(k), 1.0));
        }
        assert_eq!(trace.pieces().len(), 2);
        let apart = |pair: &[Place]| (pair[0].0 - pair[1].0).hypot(pair[0].1 - pair[1].1);
        let longest = trace
            .pieces()
            .iter()
            .flat_map(|piece| piece.windows(2))
            .map(apart);
        assert!(longest.fold(0.0, f64::max) < 0.02);
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
