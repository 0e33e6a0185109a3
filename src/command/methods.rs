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
    let (mut references, mut needs): (Vec<&str>, Vec<&str>) = (Vec::new(), Vec::new());
    let mut options: Vec<(String, Vec<&str>)> = Vec::new();
    let mut rows = vec![["method", "order", "", "keeps", "needs"].map(str::to_owned)];
    for method in CATALOGUE {
        let number = place(&mut references, method.reference);
        let need = place(&mut needs, method.needs);
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
            format!(
                "{:5} {}",
                if method.symmetric { "symm." } else { "" },
                if method.explicit {
                    "explicit"
                } else {
                    "implicit"
                }
            ),
            catalogue::preserved(method),
            format!("{need} [{number}]"),
        ]);
    }
    let mut text = aligned(&rows);
    text.push_str(
        "\nSymm.: symmetric, a step of -h undoes a step of h.\n\
         Orbit: the coadjoint orbit, with it every Casimir. Poisson: each step is a Poisson map; if\n\
         constant: where the Poisson matrix is constant.\n",
    );
    text.push_str("\nWhat they need, by the number before the reference:\n");
    for (index, need) in needs.iter().enumerate() {
        let words: Vec<&str> = need.split(' ').collect();
        text.push_str(&wrapped(&format!("  {}: ", index + 1), &words, " "));
    }
    text.push_str("\nOptions and their defaults (a composition takes those of its base, too):\n");
    for (option, takers) in &options {
        text.push_str(&wrapped(&format!("  {option}: "), takers, ", "));
    }
    text.push_str("\nReferences (DOI):\n");
    for (index, reference) in references.iter().enumerate() {
        let words: Vec<&str> = reference.split(' ').collect();
        text.push_str(&wrapped(&format!("  [{}] ", index + 1), &words, " "));
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

/// The number of a text in a list, from 1, which it joins if it is new.
fn place<'a>(list: &mut Vec<&'a str>, text: &'a str) -> usize {
    let known = list.iter().position(|known| *known == text);
    let place = known.unwrap_or_else(|| {
        list.push(text);
        list.len() - 1
    });
    place + 1
}

/// Words with what separates them, in lines of at most 90 characters.
fn wrapped(lead: &str, words: &[&str], separator: &str) -> String {
    let mut text = String::new();
    let mut line = lead.to_owned();
    for (index, word) in words.iter().enumerate() {
        let separator = if index + 1 < words.len() {
            separator
        } else {
            ""
        };
        if line.chars().count() + word.chars().count() > 90 {
            text.push_str(line.trim_end());
            text.push('\n');
            line = "    ".to_owned();
        }
        line.push_str(word);
        line.push_str(separator);
    }
    if words.is_empty() {
        return String::new();
    }
    text + line.trim_end() + "\n"
}
