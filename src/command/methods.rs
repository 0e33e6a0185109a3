//! `lie methods`: the catalogue.

use lie_codegen::methods::{Availability, CATALOGUE, Method, Preserves};
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

/// The names of what is preserved, in the order of the table.
fn preserved(preserves: Preserves) -> Vec<&'static str> {
    let Preserves {
        energy,
        casimirs,
        quadratic_casimirs,
        orbit,
        poisson,
        quadratic_invariants,
        linear_invariants: _,
    } = preserves;
    let quadratic = quadratic_casimirs && !casimirs && !quadratic_invariants;
    let all = [
        (poisson, "Poisson structure"),
        (orbit, "coadjoint orbit"),
        (casimirs, "Casimirs"),
        (quadratic_invariants, "quadratic invariants"),
        (quadratic, "quadratic Casimirs"),
        (energy, "energy"),
    ];
    all.into_iter()
        .filter_map(|(kept, name)| kept.then_some(name))
        .collect()
}

fn as_json(method: &Method) -> Value {
    let Preserves {
        energy,
        casimirs,
        quadratic_casimirs,
        orbit,
        poisson,
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
            "quadratic_invariants": quadratic_invariants,
            "linear_invariants": linear_invariants,
        },
        "needs": method.needs,
        "options": options,
        "reference": method.reference,
        "built": method.availability == Availability::Built,
    })
}

fn table() -> String {
    let mut text = String::new();
    for method in CATALOGUE
        .iter()
        .filter(|method| method.availability == Availability::Built)
    {
        let kept = preserved(method.preserves);
        let kept = if method.id.starts_with("compose") {
            "what the method that is composed preserves".to_owned()
        } else if kept.is_empty() {
            "linear first integrals only".to_owned()
        } else {
            kept.join(", ")
        };
        let nature = match (method.symmetric, method.explicit) {
            (true, true) => ", symmetric, explicit",
            (true, false) => ", symmetric, implicit",
            (false, true) => ", explicit",
            (false, false) => ", implicit",
        };
        text.push_str(&format!(
            "{}\n    {}, order {}{nature}\n",
            method.id, method.title, method.order
        ));
        text.push_str(&format!(
            "    preserves: {kept}\n    needs:     {}\n",
            method.needs
        ));
        for (name, default) in method.options() {
            text.push_str(&format!("    option:    --{name} (default {default})\n"));
        }
        text.push_str(&format!("    reference: {}\n\n", method.reference));
    }
    let planned = CATALOGUE
        .iter()
        .filter(|method| method.availability == Availability::Planned);
    let planned: Vec<&str> = planned.map(|method| method.id).collect();
    text.push_str(&wrapped("Not built yet: ", &planned));
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
