//! Time as one thread has it: seconds of a processor, and what passed meanwhile.

use super::found::ClockKind;
use std::time::Instant;

/// Where the seconds come from.
pub(super) struct Clock {
    processor: fn() -> Option<f64>,
}

/// What something took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spent {
    /// Seconds by the clock.
    pub(super) seconds: f64,
    /// Seconds that passed; more than those of the processor where other programs ran.
    pub(super) wall: f64,
}

impl Clock {
    /// A clock of the processor; where it answers none, time that passes.
    pub(super) fn new(processor: fn() -> Option<f64>) -> Self {
        Self { processor }
    }

    /// Time that passes.
    pub(super) fn wall() -> Self {
        Self::new(|| None)
    }

    /// What it counts by.
    pub(super) fn kind(&self) -> ClockKind {
        match (self.processor)() {
            Some(_) => ClockKind::Processor,
            None => ClockKind::Wall,
        }
    }

    /// Does something and says what it took.
    pub(super) fn spent<T>(&self, work: impl FnOnce() -> T) -> (T, Spent) {
        let (start, before) = (Instant::now(), (self.processor)());
        let done = work();
        let after = (self.processor)();
        let wall = start.elapsed().as_secs_f64();
        let seconds = before
            .zip(after)
            .map_or(wall, |(before, after)| after - before);
        (done, Spent { seconds, wall })
    }
}

impl Spent {
    /// A part of it.
    pub(super) fn divided_by(self, times: f64) -> Self {
        Self {
            seconds: self.seconds / times,
            wall: self.wall / times,
        }
    }
}

/// The least and the median of the seconds, and the median of what passed; `first` where there are no samples.
pub(super) fn summary(samples: &[Spent], first: Spent) -> [f64; 3] {
    let sorted = |of: fn(&Spent) -> f64| {
        let mut values: Vec<f64> = samples.iter().map(of).collect();
        values.sort_by(f64::total_cmp);
        values
    };
    let (seconds, wall) = (sorted(|s| s.seconds), sorted(|s| s.wall));
    let median = |values: &[f64]| values.get(values.len() / 2).copied();
    [
        seconds.first().copied().unwrap_or(first.seconds),
        median(&seconds).unwrap_or(first.seconds),
        median(&wall).unwrap_or(first.wall),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_clock_counts_and_not_what_passes() {
        let standing = Clock::new(|| Some(7.0));
        let ((), spent) =
            standing.spent(|| std::thread::sleep(std::time::Duration::from_millis(5)));
        assert_eq!(spent.seconds, 0.0);
        assert!(spent.wall >= 5e-3);
        let ((), spent) = Clock::wall().spent(|| ());
        assert_eq!(spent.seconds, spent.wall);
        assert_eq!(
            (standing.kind(), Clock::wall().kind()),
            (ClockKind::Processor, ClockKind::Wall)
        );
    }

    #[test]
    fn least_and_medians() {
        let spent = |seconds, wall| Spent { seconds, wall };
        let samples = [spent(3.0, 4.0), spent(1.0, 9.0), spent(2.0, 2.5)];
        assert_eq!(summary(&samples, spent(8.0, 8.0)), [1.0, 2.0, 4.0]);
        assert_eq!(summary(&[], spent(8.0, 9.0)), [8.0, 8.0, 9.0]);
        assert_eq!(spent(3.0, 4.0).divided_by(2.0), spent(1.5, 2.0));
    }
}
