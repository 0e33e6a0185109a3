//! The grid of times, and where on it a saved time lies.

use super::options::OptionError;

/// `T/h` within this distance of an integer is that integer. Where f64 does not resolve as much,
/// beyond some millions of steps, two units of round-off count instead.
pub(super) const TOLERANCE: f64 = 1e-9;
/// Beyond this, counts are no longer exact in f64.
pub(super) const MAX_STEPS: f64 = 9_007_199_254_740_992.0;

/// Times `t_k = t0 + k h`, k from 0 to a last one; the end may lie off the grid beyond it. From a point on h may be another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    pub(super) start: f64,
    pub(super) end: f64,
    pub(super) step: f64,
    pub(super) steps: u64,
    pub(super) end_place: Place,
    /// The point from which on the step is this one, and its time.
    from: (u64, f64),
    /// Whether it was another one before.
    pub(super) changed: bool,
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

    /// The same from a point on with another step, which need not lead to the end.
    pub(super) fn changed_from(self, (index, time): (u64, f64), step: f64) -> Self {
        let grid = Self {
            step,
            from: (index, time),
            changed: false,
            ..self
        };
        let end_place = grid.locate(self.end);
        Self {
            end_place,
            steps: end_place.index(),
            ..grid
        }
    }

    /// Whether a time lies before the point from which on the step is this one.
    pub(super) fn is_behind(&self, time: f64) -> bool {
        (time - self.from.1) / self.step < -TOLERANCE
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
            return Place::On(first.saturating_sub(u64::from(self.changed)));
        }
        let before = first + count.floor() as u64;
        Place::After(before, time - self.time(before))
    }
}

#[cfg(test)]
mod tests {
    use super::super::options::Save;
    use super::super::rows::Row;
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
