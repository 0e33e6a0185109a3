//! The rows of a run: which states are saved, and where on the grid they lie.

use super::grid::{Grid, MAX_STEPS, Place, TOLERANCE};
use super::options::{OptionError, Save};

/// A state to be saved: where and under which time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Row {
    pub(super) place: Place,
    pub(super) time: f64,
}

impl Grid {
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
            Save::At(times) => Kind::At(self.sorted(times)?),
        };
        Ok(Rows {
            grid: *self,
            kind,
            next: Some(0),
            peeked: None,
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
    /// The next row, once it was looked at.
    peeked: Option<Option<Row>>,
}

#[derive(Clone, Debug)]
enum Kind {
    Every(u64),
    Interval(f64),
    At(Vec<f64>),
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

impl Rows {
    /// The row with a number; the end closes every list.
    fn row(&self, number: u64) -> Option<Row> {
        let grid = self.grid;
        let row = match &self.kind {
            Kind::At(times) => {
                let time = *times.get(number as usize)?;
                return Some(Row {
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
        Some(row.unwrap_or(grid.end_row()))
    }

    /// The next row, where the grid has it now.
    pub(super) fn peek(&mut self) -> Option<&Row> {
        if self.peeked.is_none() {
            self.peeked = Some(self.next.and_then(|number| self.row(number)));
        }
        self.peeked.as_ref()?.as_ref()
    }

    /// Whether the next row is known, and belongs to a later grid point.
    #[inline(always)]
    pub(super) fn begin_after(&self, index: u64) -> bool {
        matches!(&self.peeked, Some(Some(row)) if index < row.place.index())
    }

    /// The next row, if it is one like that.
    pub(super) fn next_if(&mut self, is_one: impl FnOnce(&Row) -> bool) -> Option<Row> {
        self.peek().is_some_and(is_one).then(|| self.next())?
    }

    /// Has the rows to come on another grid.
    pub(super) fn relocate(&mut self, grid: &Grid) {
        self.grid = *grid;
        self.peeked = None;
    }
}

impl Iterator for Rows {
    type Item = Row;

    fn next(&mut self) -> Option<Row> {
        let row = self.peek().copied();
        self.peeked = None;
        let number = self.next?;
        let is_last = match self.kind {
            Kind::At(_) => row.is_none(),
            Kind::Every(_) | Kind::Interval(_) => {
                row.is_none_or(|row| row.place == self.grid.end_place)
            }
        };
        self.next = (!is_last).then_some(number + 1);
        row
    }
}
