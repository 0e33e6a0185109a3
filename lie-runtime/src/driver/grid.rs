//! The grid of times, and where on it a saved time lies.

use super::options::{OptionError, Save};

/// `T/h` within this distance of an integer is that integer. Where f64 does not resolve as much,
/// beyond some millions of steps, two units of round-off count instead.
const TOLERANCE: f64 = 1e-9;
/// Beyond this, counts are no longer exact in f64.
const MAX_STEPS: f64 = 9_007_199_254_740_992.0;

/// Times `t_k = t0 + k h`, k from 0 to a last one; the end may lie off the grid beyond it. From a point on h may be another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    start: f64,
    end: f64,
    step: f64,
    steps: u64,
    end_place: Place,
    /// The point from which on the step is this one, and its time.
    from: (u64, f64),
    /// Whether it was another one before.
    changed: bool,
}

/// Where a time lies relative to the grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// At a grid point.
    On(u64),
    /// After a grid point by a step shorter than h, which is given with its sign.
    After(u64, f64),
}

impl Place {
    /// The grid point itself or the one before.
    pub fn index(self) -> u64 {
        match self {
            Self::On(index) | Self::After(index, _) => index,
        }
    }
}

/// A state to be saved: where and under which time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Row {
    pub(super) place: Place,
    pub(super) time: f64,
}

impl Grid {
    /// A grid from t0 to t1 with steps of h.
    ///
    /// # Errors
    /// An [`OptionError`] if a number is not finite, h is zero or has the wrong sign, or there are
    /// too many steps.
    pub fn new((start, end): (f64, f64), step: f64) -> Result<Self, OptionError> {
        if !step.is_finite() || step == 0.0 {
            return Err(OptionError::Step(step));
        }
        if !(start.is_finite() && end.is_finite() && (end - start).is_finite()) {
            return Err(OptionError::Span(start, end));
        }
        let mut grid = Self {
            start,
            end,
            step,
            steps: 0,
            end_place: Place::On(0),
            from: (0, start),
            changed: false,
        };
        let count = (end - start) / step;
        if count < -TOLERANCE {
            return Err(OptionError::Direction { step, start, end });
        }
        if count > MAX_STEPS {
            return Err(OptionError::TooManySteps(count));
        }
        grid.end_place = grid.locate(end);
        grid.steps = grid.end_place.index();
        Ok(grid)
    }

    /// The same up to a point, and from there on with so many steps to the end.
    pub(super) fn going_on_with(self, (index, time): (u64, f64), steps: u64) -> Self {
        let steps = steps.max(1);
        Self {
            step: (self.end - time) / steps as f64,
            steps: index.saturating_add(steps),
            end_place: Place::On(index.saturating_add(steps)),
            from: (index, time),
            changed: true,
            ..self
        }
    }

    /// The point from which on the step is another one than before, and its time.
    pub(super) fn change(&self) -> Option<(u64, f64)> {
        self.changed.then_some(self.from)
    }

    /// The step.
    pub(super) fn step(&self) -> f64 {
        self.step
    }

    /// The number of whole steps.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// The time of a grid point, `t0 + k h` by multiplication.
    pub fn time(&self, index: u64) -> f64 {
        let (first, start) = self.from;
        if self.changed && index == self.steps {
            return self.end;
        }
        start + index.saturating_sub(first) as f64 * self.step
    }

    /// The length of the step from a grid point; from the last one on, of what is left until the end.
    pub(super) fn length(&self, index: u64) -> f64 {
        match self.end_place {
            _ if index < self.steps => self.step,
            Place::On(_) => 0.0,
            Place::After(_, rest) => rest,
        }
    }

    /// Where a time between start and end lies. Outside, the nearest grid point.
    pub fn locate(&self, time: f64) -> Place {
        let (first, start) = self.from;
        let count = (time - start) / self.step;
        let nearest = count.round();
        let slack = TOLERANCE.max(2.0 * f64::EPSILON * nearest);
        // A time that is small beside the step is not the start, however near it lies.
        let start = nearest == 0.0 && count > 0.0;
        if !start && (count - nearest).abs() <= slack {
            return Place::On(first + nearest.max(0.0) as u64);
        }
        if count < 0.0 {
            return Place::On(first.saturating_sub(1));
        }
        let before = first + count.floor() as u64;
        Place::After(before, time - self.time(before))
    }

    /// The states that a choice saves, in order of the run.
    pub(super) fn rows(&self, save: &Save) -> Result<Rows, OptionError> {
        let kind = match save {
            Save::Every(0) => return Err(OptionError::Interval),
            Save::Every(every) => Kind::Every(*every),
            Save::Ends => Kind::Every(u64::MAX),
            Save::Interval(interval) => {
                let ratio = interval / self.step;
                let rows = (self.end - self.start) / interval;
                if !(ratio.is_finite() && ratio > 0.0 && rows < MAX_STEPS) {
                    return Err(OptionError::Interval);
                }
                Kind::Interval(*interval)
            }
            Save::At(times) => Kind::At(self.sorted(times)?.into_iter()),
        };
        Ok(Rows {
            grid: *self,
            kind,
            next: Some(0),
        })
    }

    fn sorted(&self, times: &[f64]) -> Result<Vec<f64>, OptionError> {
        let slack = TOLERANCE * self.step.abs();
        let (low, high) = (
            self.start.min(self.end) - slack,
            self.start.max(self.end) + slack,
        );
        // which was looked at before the step changed
        for &time in times.iter().filter(|_| !self.changed) {
            if !(low <= time && time <= high) {
                return Err(OptionError::SavedTime {
                    time,
                    start: self.start,
                    end: self.end,
                });
            }
        }
        let mut times = times.to_vec();
        times.sort_by(f64::total_cmp);
        if self.step < 0.0 {
            times.reverse();
        }
        Ok(times)
    }

    fn end_row(&self) -> Row {
        match self.end_place {
            Place::On(index) => Row {
                place: self.end_place,
                time: self.time(index),
            },
            Place::After(..) => Row {
                place: self.end_place,
                time: self.end,
            },
        }
    }
}

/// Iterator over the rows of a run.
#[derive(Clone, Debug)]
pub(super) struct Rows {
    grid: Grid,
    kind: Kind,
    /// Number of the next row; none after the end.
    next: Option<u64>,
}

#[derive(Clone, Debug)]
enum Kind {
    Every(u64),
    Interval(f64),
    At(std::vec::IntoIter<f64>),
}

impl Rows {
    /// Those from a grid point on, possibly behind some before it.
    pub(super) fn from(mut self, index: u64) -> Self {
        if let (Kind::Every(every), Some(next)) = (&self.kind, &mut self.next) {
            *next = index.div_ceil(*every);
        }
        self
    }
}

impl Iterator for Rows {
    type Item = Row;

    fn next(&mut self) -> Option<Row> {
        let grid = self.grid;
        let number = self.next?;
        let row = match &mut self.kind {
            Kind::At(times) => {
                return times.next().map(|time| Row {
                    place: grid.locate(time),
                    time,
                });
            }
            Kind::Every(every) => {
                let index = number.saturating_mul(*every);
                let row = Row {
                    place: Place::On(index),
                    time: grid.time(index),
                };
                (index <= grid.steps).then_some(row)
            }
            Kind::Interval(interval) => {
                let time = grid.start + number as f64 * *interval;
                let place = grid.locate(time);
                let before_end = match (place, grid.end_place) {
                    (Place::On(index), Place::After(end, _)) => index <= end,
                    (Place::On(index), Place::On(end)) => index < end,
                    (Place::After(index, _), Place::On(end)) => index < end,
                    (Place::After(index, here), Place::After(end, there)) => {
                        index < end || (index == end && here.abs() < there.abs())
                    }
                };
                before_end.then_some(Row { place, time })
            }
        };
        // the end closes every list, once
        let end = grid.end_row();
        let row = row.unwrap_or(end);
        self.next = (row.place != end.place).then_some(number + 1);
        Some(row)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times(span: (f64, f64), step: f64, save: &Save) -> Vec<f64> {
        Grid::new(span, step)
            .unwrap()
            .rows(save)
            .unwrap()
            .map(|row| row.time)
            .collect()
    }

    #[test]
    fn times_are_multiples() {
        let grid = Grid::new((0.0, 100.0), 0.1).unwrap();
        assert_eq!(grid.steps(), 1000);
        assert_eq!(grid.time(3), 3.0 * 0.1);
        assert_ne!(grid.time(3), 0.3, "not the sum nor the decimal");
    }

    #[test]
    fn ends_near_the_grid_are_on_it() {
        assert_eq!(Grid::new((0.0, 0.3), 0.1).unwrap().end_place, Place::On(3));
        assert_eq!(
            Grid::new((0.0, 1.0 + 0.9e-10), 0.1).unwrap().end_place,
            Place::On(10)
        );
        let grid = Grid::new((0.0, 1.0 + 1.1e-10), 0.1).unwrap();
        assert!(matches!(grid.end_place, Place::After(10, rest) if (rest - 1.1e-10).abs() < 1e-15));
        assert_eq!(Grid::new((0.0, 0.0), 0.1).unwrap().steps(), 0);
        for end in [12_345_678.9, 98_765_432.1, 4_096_000.3] {
            let place = Grid::new((0.0, end), 0.1).unwrap().end_place;
            assert!(matches!(place, Place::On(_)), "{place:?}");
        }
    }

    #[test]
    fn every_kth_and_the_end() {
        assert_eq!(
            times((0.0, 5.0), 1.0, &Save::Every(2)),
            [0.0, 2.0, 4.0, 5.0]
        );
        assert_eq!(times((0.0, 4.0), 1.0, &Save::Every(2)), [0.0, 2.0, 4.0]);
        assert_eq!(
            times((0.0, 4.5), 1.0, &Save::Every(2)),
            [0.0, 2.0, 4.0, 4.5]
        );
        assert_eq!(times((0.0, 4.5), 1.0, &Save::Every(9)), [0.0, 4.5]);
        assert_eq!(times((0.0, 4.0), 1.0, &Save::Ends), [0.0, 4.0]);
        assert_eq!(times((0.0, 0.0), 1.0, &Save::Every(1)), [0.0]);
        assert_eq!(times((0.0, 0.5), 1.0, &Save::Every(1)), [0.0, 0.5]);
        assert_eq!(
            times((1.0, -1.5), -1.0, &Save::Every(1)),
            [1.0, 0.0, -1.0, -1.5]
        );
    }

    #[test]
    fn asked_times_keep_their_value_and_come_in_order() {
        let rows: Vec<Row> = Grid::new((0.0, 1.0), 0.1)
            .unwrap()
            .rows(&Save::At(vec![0.3, 0.0, 0.25, 0.25]))
            .unwrap()
            .collect();
        assert_eq!(
            rows.iter().map(|row| row.time).collect::<Vec<_>>(),
            [0.0, 0.25, 0.25, 0.3]
        );
        assert_eq!(rows[3].place, Place::On(3));
        assert_eq!(rows[1].place, Place::After(2, 0.25 - 0.2));
        let grid = Grid::new((0.0, -1.0), -0.1).unwrap();
        let rows: Vec<Row> = grid
            .rows(&Save::At(vec![-0.95, 0.0, -0.2]))
            .unwrap()
            .collect();
        assert_eq!(
            rows.iter().map(|row| row.time).collect::<Vec<_>>(),
            [0.0, -0.2, -0.95]
        );
        assert_eq!(rows[2].place.index(), 9);
        assert!(grid.rows(&Save::At(vec![0.1])).is_err());
        assert!(grid.rows(&Save::At(vec![f64::NAN])).is_err());
    }

    #[test]
    fn intervals_need_not_divide_the_step() {
        let saved = times((0.0, 1.0), 0.4, &Save::Interval(0.3));
        assert_eq!(saved, [0.0, 0.3, 0.6, 3.0 * 0.3, 1.0]);
        assert_eq!(
            times((0.0, 0.6), 0.1, &Save::Interval(0.3)),
            [0.0, 0.3, 6.0 * 0.1]
        );
        assert_eq!(
            times((0.0, 0.65), 0.1, &Save::Interval(0.325)),
            [0.0, 0.325, 0.65]
        );
    }

    /// A grid whose step changes: rows of steps, of times and of an interval, and the end, which is met exactly.
    #[test]
    fn a_step_may_change_on_the_way() {
        let grid = Grid::new((0.0, 1.0), 0.25)
            .unwrap()
            .going_on_with((2, 0.5), 3);
        let of = |save: &Save| -> Vec<(Place, f64)> {
            let rows = grid.rows(save).unwrap().from(2);
            rows.map(|row| (row.place, row.time)).collect()
        };
        let third = 0.5 / 3.0;
        let steps: Vec<f64> = of(&Save::Every(1)).iter().map(|row| row.1).collect();
        assert_eq!(steps, [0.5, 0.5 + third, 0.5 + 2.0 * third, 1.0]);
        assert_eq!(
            of(&Save::Every(3)),
            [(Place::On(3), 0.5 + third), (Place::On(5), 1.0)]
        );
        assert_eq!(of(&Save::Ends), [(Place::On(5), 1.0)]);
        let after = Place::After(2, 0.6 - 0.5);
        assert_eq!(
            of(&Save::At(vec![1.0, 0.6])),
            [(after, 0.6), (Place::On(5), 1.0)]
        );
        let all = grid.rows(&Save::Interval(0.6)).unwrap();
        assert_eq!(all.map(|row| row.time).collect::<Vec<_>>(), [0.0, 0.6, 1.0]);
        let back = Grid::new((0.1, -0.2), -0.1)
            .unwrap()
            .going_on_with((1, 0.0), 7);
        assert_eq!((back.time(8), back.steps()), (-0.2, 8));
    }

    #[test]
    fn nonsense_is_refused() {
        assert!(matches!(
            Grid::new((0.0, 1.0), 0.0),
            Err(OptionError::Step(_))
        ));
        assert!(matches!(
            Grid::new((0.0, 1.0), f64::NAN),
            Err(OptionError::Step(_))
        ));
        assert!(matches!(
            Grid::new((0.0, f64::INFINITY), 0.1),
            Err(OptionError::Span(..))
        ));
        assert!(matches!(
            Grid::new((0.0, 1.0), -0.1),
            Err(OptionError::Direction { .. })
        ));
        assert!(matches!(
            Grid::new((0.0, 1e300), 1e-300),
            Err(OptionError::TooManySteps(_))
        ));
        let grid = Grid::new((0.0, 1.0), 0.1).unwrap();
        assert_eq!(
            grid.rows(&Save::Every(0)).unwrap_err(),
            OptionError::Interval
        );
        assert_eq!(
            grid.rows(&Save::Interval(-0.1)).unwrap_err(),
            OptionError::Interval
        );
        assert_eq!(
            grid.rows(&Save::Interval(1e-300)).unwrap_err(),
            OptionError::Interval
        );
    }
}
