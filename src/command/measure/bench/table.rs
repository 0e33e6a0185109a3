//! The table of `lie bench`: the time of each method to some errors.

use super::by_method;
use crate::command::measure::quiet::{percent, spread};
use crate::command::measure::{Bed, sense};
use lie_in_process::words::short;
use lie_measure::bench::{Measure, Point, Reference};

/// Accuracies of the table.
const TARGETS: [f64; 4] = [1e-3, 1e-6, 1e-9, 1e-12];

/// The time to an error, between the points by their logarithms; of the fastest way there. None to an error below the least one
/// that is told from 0.
fn time_to(points: &[&Point], target: f64, floor: f64) -> Option<f64> {
    if target < floor {
        return None;
    }
    let reaching = points.iter().filter(|point| point.error <= target);
    let reached = reaching.map(|point| point.seconds).reduce(f64::min)?;
    let pairs = points.windows(2).filter_map(|pair| {
        let [a, b] = pair else { return None };
        if a.error <= target || b.error > target {
            return None;
        }
        let part = (target / a.error).ln() / (b.error.max(1e-17) / a.error).ln();
        Some((a.seconds.ln() + part * (b.seconds / a.seconds).ln()).exp())
    });
    Some(pairs.fold(reached, f64::min))
}

/// An error, or that it is below the least one that is told from 0.
fn error(value: f64, floor: f64) -> String {
    match value < floor {
        true => format!("< {}", short(floor)),
        false => short(value),
    }
}

/// How a method does: the times to the targets, its least error, its name and order.
pub(super) struct Line<'a> {
    times: Vec<Option<f64>>,
    least: f64,
    /// The least error across the orbit, beside that of the phase.
    across: Option<f64>,
    method: &'a str,
    order: String,
    spread: f64,
}

/// The methods by the time to 1e-6; those that do not come there behind, by how far they come.
pub(super) fn lines<'a>(
    bed: &Bed,
    points: &'a [Point],
    reference: Option<Reference>,
) -> Vec<Line<'a>> {
    let floor = reference.map_or(0.0, |reference| reference.floor);
    let line = |(method, points): (&'a str, Vec<&Point>)| {
        let times = TARGETS
            .iter()
            .map(|&target| time_to(&points, target, floor));
        let order = order_of(bed, method).map_or("–".to_owned(), |order| order.to_string());
        Line {
            times: times.collect(),
            least: points.iter().map(|p| p.error).fold(f64::INFINITY, f64::min),
            across: points.iter().filter_map(|p| p.across).reduce(f64::min),
            method,
            order,
            spread: spread(&points),
        }
    };
    let mut lines: Vec<Line<'_>> = by_method(points).into_iter().map(line).collect();
    let key = |line: &Line<'_>| line.times[1].unwrap_or(f64::INFINITY);
    lines.sort_by(|a, b| {
        let by_time = key(a).total_cmp(&key(b));
        by_time.then(a.least.total_cmp(&b.least))
    });
    lines
}

/// The table of these.
pub(super) fn cells(
    lines: &[Line<'_>],
    measure: Measure,
    reference: Option<Reference>,
) -> Vec<Vec<String>> {
    let [floor, floor_across] = reference.map_or([0.0; 2], |reference| {
        [reference.floor, reference.error.max(reference.difference)]
    });
    let fastest: Vec<f64> = (0..TARGETS.len())
        .map(|k| {
            let times = lines.iter().filter_map(|line| line.times[k]);
            times.fold(f64::INFINITY, f64::min)
        })
        .collect();
    let mut cells = vec![vec!["method".to_owned(), "order".to_owned()]];
    cells[0].extend(TARGETS.iter().map(|target| format!("to {target:.0e}")));
    cells[0].push(sense::least(measure).to_owned());
    if measure == Measure::Phase {
        cells[0].push("least across".to_owned());
    }
    cells[0].push("spread".to_owned());
    for line in lines {
        let mut row = vec![line.method.to_owned(), line.order.clone()];
        for (time, fastest) in line.times.iter().zip(&fastest) {
            row.push(match time {
                Some(time) if time <= fastest => format!("{} *", micro(*time)),
                Some(time) => micro(*time),
                None => "–".to_owned(),
            });
        }
        row.push(error(line.least, floor));
        row.extend(line.across.map(|across| error(across, floor_across)));
        row.push(percent(line.spread));
        cells.push(row);
    }
    cells
}

/// Microseconds, to three digits.
pub(super) fn micro(seconds: f64) -> String {
    let value = seconds * 1e6;
    let digits = (2 - value.abs().log10().floor() as i32).clamp(0, 4) as usize;
    format!("{value:.digits$}")
}

fn order_of(bed: &Bed, label: &str) -> Option<u32> {
    let choice = bed.choices.iter().find(|choice| choice.label() == label)?;
    choice.entry().map(|method| method.order)
}

#[cfg(test)]
mod tests {
    use super::super::tests::point;
    use super::*;

    #[test]
    fn below_the_floor_nothing_is_told() {
        let points = [
            point("rk4", 0.1, 1e-4, 1e-6),
            point("rk4", 0.01, 1e-12, 1e-4),
        ];
        let points: Vec<&Point> = points.iter().collect();
        let time = time_to(&points, 1e-8, 1e-9).unwrap();
        assert!((time - 1e-5).abs() < 1e-12, "{time}");
        assert_eq!(time_to(&points, 1e-12, 0.0), Some(1e-4));
        assert_eq!(time_to(&points, 1e-12, 1e-11), None);
        assert_eq!(error(3e-12, 2e-12), "3.0e-12");
        assert_eq!(error(1e-12, 2e-12), "< 2.0e-12");
    }
}
