//! The table of `lie bench`: the time of each method to some errors.

use super::by_method;
use crate::command::measure::quiet::{percent, spread};
use crate::command::measure::{Bed, sense};
use lie_in_process::words::short;
use lie_measure::bench::{Measure, Point};

/// Accuracies of the table.
const TARGETS: [f64; 4] = [1e-3, 1e-6, 1e-9, 1e-12];

/// The time to an error, between the points by their logarithms; of the fastest way there.
fn time_to(points: &[&Point], target: f64) -> Option<f64> {
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
pub(super) fn lines<'a>(bed: &Bed, points: &'a [Point]) -> Vec<Line<'a>> {
    let line = |(method, points): (&'a str, Vec<&Point>)| {
        let times = TARGETS.iter().map(|&target| time_to(&points, target));
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
pub(super) fn cells(lines: &[Line<'_>], measure: Measure) -> Vec<Vec<String>> {
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
        row.push(short(line.least));
        row.extend(line.across.map(short));
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
