//! The tables.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::{Cost, KernelCost};

/// The head of the table of the worst declarations.
pub const HEAD: &str = "| no. | kind | check | generate | format | arena | operations | slowest kernels |\n\
    |---|---|---|---|---|---|---|---|";

/// A value below which a share of the sorted values lies.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let place = (share * (sorted.len().saturating_sub(1)) as f64).round() as usize;
    sorted.get(place).copied().unwrap_or(0.0)
}

/// How the times are distributed, by kind and in all.
pub fn distribution(costs: &[Cost]) -> String {
    let mut kinds: BTreeMap<&str, Vec<&Cost>> = BTreeMap::new();
    for cost in costs {
        kinds.entry(cost.family).or_default().push(cost);
        kinds.entry("~ all").or_default().push(cost);
    }
    let mut text = String::from(
        "| kind | declarations | refused | sum | median | 90% | 99% | longest | over 2 s | operations |\n\
         |---|---|---|---|---|---|---|---|---|---|\n",
    );
    for (kind, costs) in kinds {
        let mut times: Vec<f64> = costs.iter().map(|cost| cost.total()).collect();
        times.sort_by(f64::total_cmp);
        let refused = costs.iter().filter(|cost| cost.refused.is_some()).count();
        let operations: usize = costs.iter().map(|cost| cost.operations).sum();
        let slow = times.iter().filter(|time| **time > 2.0).count();
        let _ = writeln!(
            text,
            "| {kind} | {} | {refused} | {:.1} s | {:.3} s | {:.3} s | {:.3} s | {:.3} s | {slow} | {operations} |",
            costs.len(),
            times.iter().sum::<f64>(),
            quantile(&times, 0.5),
            quantile(&times, 0.9),
            quantile(&times, 0.99),
            quantile(&times, 1.0),
        );
    }
    text.push('\n');
    text
}

/// One of the worst, as a line of the table.
pub fn row(cost: &Cost, kernels: &[KernelCost]) -> String {
    let mut slowest: Vec<&KernelCost> = kernels.iter().collect();
    slowest.sort_by(|a, b| b.seconds.total_cmp(&a.seconds));
    let slowest: Vec<String> = slowest
        .iter()
        .take(3)
        .map(|kernel| {
            format!(
                "{} {:.2} s ({} operations)",
                kernel.name,
                kernel.seconds,
                kernel.counts.weight()
            )
        })
        .collect();
    let last = match &cost.refused {
        Some(message) => format!("refused: {}", message.chars().take(80).collect::<String>()),
        None => slowest.join(", "),
    };
    format!(
        "| {} | {} | {:.3} s | {:.3} s | {:.3} s | {} | {} | {last} |",
        cost.index,
        cost.family,
        cost.check,
        cost.generate,
        cost.format,
        cost.arena,
        cost.operations
    )
}

/// One of the worst with its text and all kernels.
pub fn entry(cost: &Cost, kernels: &[KernelCost]) -> String {
    let mut text = format!(
        "## {} ({}): check {:.3} s, generate {:.3} s\n\n```json\n{}\n```\n\n",
        cost.index, cost.family, cost.check, cost.generate, cost.text
    );
    for kernel in kernels {
        let _ = writeln!(
            text,
            "- {}: {:.3} s, arena +{}, {}",
            kernel.name, kernel.seconds, kernel.added, kernel.counts
        );
    }
    text.push('\n');
    text
}
