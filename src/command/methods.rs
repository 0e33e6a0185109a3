//! `lie methods`: the catalogue.

use lie_codegen::methods::{CATALOGUE, Method, Preserves};
use serde_json::{Value, json};

use super::{args, print};
use crate::message::Failure;

/// Prints it as a table, or as JSON.
///
/// # Errors
/// stdout cannot be written.
pub fn run(arguments: &args::Methods) -> Result<u8, Failure> {
    if arguments.json {
        let all: Vec<Value> = CATALOGUE.iter().map(as_json).collect();
        print(&format!("{:#}\n", Value::from(all)))?;
    } else {
        print(&table())?;
    }
    Ok(0)
}

/// What a method keeps, without what follows from it.
fn kept(method: &Method) -> String {
    let Preserves {
        energy,
        casimirs,
        quadratic_casimirs,
        orbit,
        poisson,
        constant_poisson,
        quadratic_invariants,
        linear_invariants,
    } = method.preserves;
    if method.id.starts_with("compose") {
        return "what its base keeps".to_owned();
    }
    let all = [
        (poisson, "Poisson"),
        (constant_poisson && !poisson, "Poisson if constant"),
        (orbit, "orbit"),
        (casimirs && !orbit, "Casimirs"),
        (energy, "energy"),
        (quadratic_invariants, "quadratic invariants"),
        (
            quadratic_casimirs && !casimirs && !quadratic_invariants,
            "quadratic Casimirs",
        ),
        (
            linear_invariants && !quadratic_invariants,
            "linear invariants",
        ),
    ];
    let names = all.into_iter().filter(|(kept, _)| *kept);
    names.map(|(_, name)| name).collect::<Vec<_>>().join(", ")
}

fn as_json(method: &Method) -> Value {
    let Preserves {
        energy,
        casimirs,
        quadratic_casimirs,
        orbit,
        poisson,
        constant_poisson,
        quadratic_invariants,
        linear_invariants,
    } = method.preserves;
    let options: serde_json::Map<String, Value> = method
        .options()
        .into_iter()
        .map(|(name, default)| (name.to_owned(), default.into()))
        .collect();
    json!({
        "id": method.id,
        "title": method.title,
        "order": method.order,
        "symmetric": method.symmetric,
        "explicit": method.explicit,
        "preserves": {
            "energy": energy,
            "casimirs": casimirs,
            "quadratic_casimirs": quadratic_casimirs,
            "orbit": orbit,
            "poisson": poisson,
            "constant_poisson": constant_poisson,
            "quadratic_invariants": quadratic_invariants,
            "linear_invariants": linear_invariants,
        },
        "needs": method.needs,
        "options": options,
        "reference": method.reference,
        "built": true,
    })
}

fn table() -> String {
    let (mut references, mut needs): (Vec<&str>, Vec<&str>) = (Vec::new(), Vec::new());
    let mut options: Vec<(String, Vec<&str>)> = Vec::new();
    let mut rows = vec![["method", "order", "", "", "keeps", "needs", ""].map(str::to_owned)];
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
            if method.symmetric { "symmetric" } else { "" }.to_owned(),
            if method.explicit {
                "explicit"
            } else {
                "implicit"
            }
            .to_owned(),
            kept(method),
            need.to_string(),
            format!("[{number}]"),
        ]);
    }
    let mut text = aligned(&rows);
    text.push_str(
        "\nOrbit: the coadjoint orbit, with it every Casimir. Poisson: each step is a Poisson map; if\n\
         constant: where the Poisson matrix is constant.\n",
    );
    text.push_str("\nWhat they need:\n");
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
