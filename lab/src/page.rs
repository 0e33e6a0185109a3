//! What was measured, as a page.

use crate::measured::{Row, Way};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Errors over the tolerance that the choice of steps is to keep, of so many in a hundred.
pub const BOUND: f64 = 100.0;

/// What is known of the runs of a method with a tolerance.
#[derive(Clone, Debug, Default)]
pub struct Summary {
    /// Runs.
    pub runs: usize,
    /// Those that were refused.
    pub refused: usize,
    /// Those whose reference is less certain than a third of the error and of the tolerance.
    pub uncertain: usize,
    /// Errors over the tolerance of the others, in order.
    pub ratios: Vec<f64>,
    /// The same over the growth of changes, in order.
    pub conditioned: Vec<f64>,
    /// Runs above the bound that said so, and that did not.
    pub above: (usize, usize),
    /// Runs below it that warned.
    pub warned: usize,
}

/// A quantile of numbers in order.
pub fn quantile(numbers: &[f64], part: f64) -> f64 {
    match numbers.len() {
        0 => f64::NAN,
        count => numbers[(part * (count - 1) as f64) as usize],
    }
}

impl Summary {
    /// Of some rows.
    pub fn of<'a>(rows: impl Iterator<Item = &'a Row>) -> Self {
        let mut summary = Self::default();
        for row in rows {
            summary.runs += 1;
            let Some((ratio, warned)) = row.ratio else {
                summary.refused += 1;
                continue;
            };
            if row.doubt > 0.3 * row.tolerance * ratio.max(1.0) {
                summary.uncertain += 1;
                continue;
            }
            summary.ratios.push(ratio);
            summary.conditioned.push(ratio / row.growth);
            match (ratio > BOUND, warned) {
                (true, true) => summary.above.0 += 1,
                (true, false) => summary.above.1 += 1,
                (false, warned) => summary.warned += usize::from(warned),
            }
        }
        summary.ratios.sort_by(f64::total_cmp);
        summary.conditioned.sort_by(f64::total_cmp);
        summary
    }
}

/// The table of methods and tolerances.
pub fn table(rows: &[Row]) -> String {
    let mut text = String::from(
        "| method | tolerance | runs | refused | reference uncertain | 5% | median | 95% | largest | above 100, said | above 100, not said | below 100, warned | 95% over growth |\n\
         |---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    for way in Way::ALL {
        for &tolerance in way.tolerances() {
            let own = rows
                .iter()
                .filter(|row| row.way == way && row.tolerance == tolerance);
            let found = Summary::of(own);
            if found.runs == 0 {
                continue;
            }
            let at = |part| quantile(&found.ratios, part);
            let _ = writeln!(
                text,
                "| {} | {tolerance:e} | {} | {} | {} | {:.1e} | {:.1e} | {:.1e} | {:.1e} | {} | {} | {} | {:.1e} |",
                way.id(),
                found.runs,
                found.refused,
                found.uncertain,
                at(0.05),
                at(0.5),
                at(0.95),
                at(1.0),
                found.above.0,
                found.above.1,
                found.warned,
                quantile(&found.conditioned, 0.95)
            );
        }
    }
    text
}

/// How many runs of a method have an error over the tolerance in each decade.
pub fn histogram(rows: &[Row], way: Way) -> String {
    let mut decades: BTreeMap<i32, usize> = BTreeMap::new();
    let own = rows.iter().filter(|row| row.way == way);
    let found = Summary::of(own);
    for ratio in &found.ratios {
        let decade = ratio.max(1e-8).log10().floor().clamp(-7.0, 8.0) as i32;
        *decades.entry(decade).or_default() += 1;
    }
    let mut text = String::new();
    let most = decades.values().copied().max().unwrap_or(1);
    for decade in -7..=decades.keys().copied().max().unwrap_or(0) {
        let count = decades.get(&decade).copied().unwrap_or(0);
        let bar = "#".repeat((50 * count).div_ceil(most.max(1)));
        let below = if decade == -7 { "below" } else { "     " };
        let _ = writeln!(text, "{below} 1e{:<+3} {count:>5} {bar}", decade + 1);
    }
    text
}
