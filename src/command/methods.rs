//! `lie methods`: the catalogue.

use lie_codegen::methods::CATALOGUE;
use lie_in_process::catalogue;
use serde_json::Value;

use super::{args, print};
use crate::message::Failure;

/// Prints it as a table, or as JSON.
///
/// # Errors
/// stdout cannot be written.
pub fn run(arguments: &args::Methods) -> Result<u8, Failure> {
    if arguments.json {
        let all: Vec<Value> = CATALOGUE.iter().map(catalogue::json).collect();
        print(&format!("{:#}\n", Value::from(all)))?;
    } else {
        print(&table())?;
    }
    Ok(0)
}

fn table() -> String {
    let mut references: Vec<&str> = Vec::new();
    let mut options: Vec<(String, Vec<&str>)> = Vec::new();
    let mut rows = vec![["method", "order", "", "", "keeps", "needs", ""].map(str::to_owned)];
    for method in CATALOGUE {
        let number = references
            .iter()
            .position(|reference| *reference == method.reference)
            .unwrap_or_else(|| {
                references.push(method.reference);
                references.len() - 1
            });
        for (name, default) in method.options() {
            let others: Vec<&str> = method
                .values(name)
                .into_iter()
                .filter(|value| *value != default)
                .collect();
            let option = if others.is_empty() {
                format!("--{name} {default}")
            } else {
                format!("--{name} {default} (or {})", others.join(", "))
            };
            match options.iter_mut().find(|(known, _)| *known == option) {
                Some((_, takers)) => takers.push(method.id),
                None => options.push((option, vec![method.id])),
            }
        }
        rows.push([
            method.id.to_owned(),
            method.order.to_string(),
            if method.symmetric { "symmetric" } else { "" }.to_owned(),
            if method.explicit {
                "explicit"
            } else {
                "implicit"
            }
            .to_owned(),
            catalogue::kept(method),
            method.needs.to_owned(),
            format!("[{}]", number + 1),
        ]);
    }
    let mut text = aligned(&rows);
    text.push_str(
        "\nOrbit: the coadjoint orbit, with it every Casimir. Poisson: each step is a Poisson map; if \
         constant: where the Poisson matrix is constant.\n",
    );
    text.push_str("\nOptions and their defaults (a composition takes those of its base, too):\n");
    for (option, takers) in &options {
        text.push_str(&wrapped(&format!("  {option}: "), takers));
    }
    text.push_str("\nReferences (DOI):\n");
    for (index, reference) in references.iter().enumerate() {
        text.push_str(&format!("  [{}] {reference}\n", index + 1));
    }
    text
}

/// Columns of the width of their widest entry.
fn aligned<const N: usize>(rows: &[[String; N]]) -> String {
    let mut widths = [0; N];
    for row in rows {
        for (width, entry) in widths.iter_mut().zip(row) {
            *width = (*width).max(entry.chars().count());
        }
    }
    let mut text = String::new();
    for row in rows {
        let mut line = String::new();
        for (width, entry) in widths.iter().zip(row) {
            line.push_str(&format!("{entry:<width$}  "));
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

/// Words with commas in lines of at most 90 characters.
fn wrapped(lead: &str, words: &[&str]) -> String {
    let mut text = String::new();
    let mut line = lead.to_owned();
    for (index, word) in words.iter().enumerate() {
        let comma = if index + 1 < words.len() { ", " } else { "" };
        if line.chars().count() + word.chars().count() > 90 {
            text.push_str(line.trim_end());
            text.push('\n');
            line = "    ".to_owned();
        }
        line.push_str(word);
        line.push_str(comma);
    }
    if words.is_empty() {
        return String::new();
    }
    text + line.trim_end() + "\n"
}
