//! Whether the machine was quiet while methods were timed: how far the rounds lie apart, and how much of the time the
//! processor was someone else's.

use lie_measure::bench::{ClockKind, Point};

/// Where more than this part of the time went to others, or the rounds lie further apart, times say little.
const BUSY: f64 = 0.1;
const SPREAD: f64 = 0.15;

/// How quiet it was.
pub struct Quiet {
    /// Whether the times are those of the processor.
    processor: bool,
    /// The part of the time in which this program did not run: the median of all points.
    elsewhere: f64,
    /// How far the median of a point's rounds lies above the least: the median of all points.
    spread: f64,
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// How far the median of the rounds lies above the least, of the points of a method.
pub fn spread(points: &[&Point]) -> f64 {
    median(
        points
            .iter()
            .map(|point| point.median / point.seconds - 1.0),
    )
}

/// `3 %`.
pub fn percent(part: f64) -> String {
    if part.is_nan() {
        "–".to_owned()
    } else {
        format!("{:.0} %", 100.0 * part)
    }
}

impl Quiet {
    /// From all points, by the clock of the program.
    pub fn new(points: &[Point], clock: ClockKind) -> Self {
        let elsewhere = points.iter().map(|p| (1.0 - p.median / p.wall).max(0.0));
        Self {
            processor: clock == ClockKind::Processor,
            elsewhere: median(elsewhere),
            spread: spread(&points.iter().collect::<Vec<_>>()),
        }
    }

    /// What the times are.
    pub fn text(&self) -> String {
        let spread = percent(self.spread);
        if self.processor {
            format!(
                "times: of the processor, the least of the rounds; spread: the median above the least, {spread} over all; \
                 the processor was elsewhere for {} of the time",
                percent(self.elsewhere)
            )
        } else {
            format!(
                "times: wall time (this system has no clock of the processor), the least of the rounds; spread: the median \
                 above the least, {spread} over all"
            )
        }
    }

    /// Why the times are not to be relied on, if so.
    pub fn warning(&self) -> Option<String> {
        let mut reasons = Vec::new();
        if self.elsewhere > BUSY {
            let part = percent(self.elsewhere);
            reasons.push(format!(
                "other programs had the processor for {part} of the time"
            ));
        }
        if self.spread > SPREAD {
            let part = percent(self.spread);
            reasons.push(format!(
                "the median of the rounds lies {part} above the least"
            ));
        }
        let reasons = reasons.join(", and ");
        (!reasons.is_empty()).then(|| {
            format!("the machine was busy: {reasons}; smaller differences in times mean nothing, repeat them when it is quiet")
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lie_measure::bench::Accuracy;

    fn point(seconds: f64, median: f64, wall: f64) -> Point {
        Point {
            method: "m".to_owned(),
            control: Accuracy::Step,
            value: 1.0,
            error: 1.0,
            across: None,
            seconds,
            median,
            wall,
            steps: 1,
            evaluations: 1,
            newton: 1,
        }
    }

    #[test]
    fn what_is_said_of_a_quiet_and_of_a_busy_machine() {
        let of = |points: &[Point]| Quiet::new(points, ClockKind::Processor);
        let calm = [point(1.0, 1.02, 1.03), point(2.0, 2.1, 2.1)];
        assert_eq!(of(&calm).warning(), None);
        assert!(of(&calm).text().contains("of the processor"));
        // half of the time belongs to others, but what is measured is steady
        let shared = [point(1.0, 1.02, 2.04), point(2.0, 2.0, 4.0)];
        let warning = of(&shared).warning().expect("a warning");
        assert!(warning.contains("had the processor for 50 %") && !warning.contains("least"));
        let unsteady = [point(1.0, 1.4, 1.4), point(2.0, 2.8, 2.8)];
        let warning = of(&unsteady).warning().expect("a warning");
        assert!(warning.contains("40 % above the least") && !warning.contains("had the processor"));
        // without a clock of the processor, wall time alone
        let wall = Quiet::new(&unsteady, ClockKind::Wall);
        assert!(wall.text().contains("wall time") && wall.warning().is_some());
    }
}
