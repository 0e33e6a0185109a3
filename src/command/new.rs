//! `lie new`: writes a spec that runs.

use std::path::PathBuf;

use lie_codegen::compile::compile_spec;
use lie_codegen::structure::Structure;
use lie_codegen::structure::directions::Form;
use lie_in_process::words::counted;
use lie_syntax::diagnostic::Diagnostic;

use super::{args, files, print, shell};
use crate::message::{Failure, Message};

/// Moments of inertia that are all different: without that some motions rest.
const FIRST: u32 = 3;
/// Beyond so many coordinates numbers stand in place of parameters.
const MOST_PARAMETERS: usize = 12;

/// Writes the spec.
///
/// # Errors
/// `option` for an algebra or a name that is none, `io` where the file is there already or cannot be written.
pub fn run(arguments: &args::New) -> Result<u8, Failure> {
    let algebra = arguments.algebra.trim();
    if arguments.name.starts_with('-') {
        let text = format!(
            "`{}` begins with a hyphen, and would be read as an option",
            arguments.name
        );
        let help = "take a name such as `spinning_top`";
        return Err(Message::option("NAME", text).help(help).into());
    }
    let name = type_name(&arguments.name)?;
    let model = draft(&name, algebra)?;
    let coordinates: Vec<String> = model.coordinates.iter().map(|c| c.text.clone()).collect();
    let units = units(&model);
    let text = spec(&name, algebra, &coordinates, &units);
    let path = PathBuf::from(format!("{}.json", arguments.name.trim_end_matches(".json")));
    files::write_new(&path, &text)?;
    let path = path.display().to_string();
    let picture = format!("{}.svg", arguments.name.trim_end_matches(".json"));
    print(&format!(
        "{path}: {} of {algebra}, with a kinetic energy{}\nnext: lie run {} --plot {}\n",
        counted(coordinates.len() as u64, "coordinate"),
        why(&units),
        shell::word(&path),
        shell::word(&picture)
    ))?;
    Ok(0)
}

/// The name of a system from that of a file: its words with capitals, nothing else.
fn type_name(file: &str) -> Result<String, Failure> {
    let stem = PathBuf::from(file.trim_end_matches(".json"));
    let stem = stem
        .file_name()
        .map(|stem| stem.to_string_lossy().into_owned());
    let stem = stem.unwrap_or_default();
    let words = stem.split(|c: char| !c.is_alphanumeric());
    let capital = |word: &str| {
        let mut letters = word.chars();
        let first = letters.next().map(|first| first.to_uppercase().to_string());
        first.unwrap_or_default() + letters.as_str()
    };
    let name: String = words.map(capital).collect();
    if name.starts_with(char::is_alphabetic) {
        return Ok(name);
    }
    let message = Message::option("NAME", format!("`{file}` begins with no letter"));
    Err(message.help("take a name such as `spinning_top`").into())
}

/// The system with the standard names of the coordinates of an algebra, at rest.
fn draft(name: &str, algebra: &str) -> Result<Structure, Failure> {
    let draft = serde_json::json!({
        "format": 1, "name": name, "algebra": algebra, "hamiltonian": "0",
    });
    let found = compile_spec(&draft.to_string());
    found.map_err(|mistakes| refused(algebra, mistakes.into_iter().next()))
}

/// A coordinate that is the bracket of canonical pairs.
struct Unit {
    place: usize,
    name: String,
    /// Where it starts.
    value: &'static str,
    /// `{q, p} = -z`
    bracket: String,
}

/// The coordinates on which the direction of time in canonical pairs depends, with the sign that makes it run forwards.
fn units(model: &Structure) -> Vec<Unit> {
    let mut units: Vec<Unit> = Vec::new();
    let name = |k: usize| &model.coordinates[k].text;
    for pair in &model.directions.pairs {
        let Form::Multiple(place, negative) = model.directions.form(pair) else {
            continue;
        };
        if units.iter().all(|unit| unit.place != place) {
            let [q, p] = [pair.position, pair.momentum].map(name);
            units.push(Unit {
                place,
                name: name(place).clone(),
                value: if negative { "-1" } else { "1" },
                bracket: format!("{{{q}, {p}}} = {}", model.directions.display(pair, model)),
            });
        }
    }
    units
}

/// Why it starts from these units.
fn why(units: &[Unit]) -> String {
    let [first, rest @ ..] = units else {
        return String::new();
    };
    let more = if rest.is_empty() { "" } else { ", and so on" };
    let Unit {
        name,
        value,
        bracket,
        ..
    } = first;
    format!(
        "; it starts from {name} = {value}{more}, since {bracket}: so mechanics runs forwards in time"
    )
}

/// Why the name of an algebra is none.
fn refused(algebra: &str, mistake: Option<Diagnostic>) -> Failure {
    let Some(mistake) = mistake else {
        return Message::option("--algebra", format!("`{algebra}` is no algebra")).into();
    };
    let message = Message::new(mistake.kind, mistake.message).at_option("--algebra");
    let help = mistake
        .help
        .unwrap_or_else(|| "the names are in docs/algebras.md".to_owned());
    message.help(help).into()
}

/// A free body: the kinetic energy with different moments, begun off its axes.
fn spec(name: &str, algebra: &str, coordinates: &[String], units: &[Unit]) -> String {
    let few = coordinates.len() <= MOST_PARAMETERS;
    let (mut parameters, mut terms) = (Vec::new(), Vec::new());
    for (place, coordinate) in (0_u32..).zip(coordinates) {
        // 1, 4/3, 5/3, … in thirds
        if few {
            let moment = fraction(FIRST + place, FIRST);
            parameters.push(format!(r#""I{}": "{moment}""#, place + 1));
            terms.push(format!("{coordinate}^2/(2*I{})", place + 1));
        } else {
            let (above, below) = reduced(FIRST, 2 * (FIRST + place));
            let factor = match above {
                1 => String::new(),
                above => format!("{above}*"),
            };
            terms.push(format!("{factor}{coordinate}^2/{below}"));
        }
    }
    let initial = (0_u32..)
        .zip(0..coordinates.len())
        .map(|(place, coordinate)| {
            if let Some(unit) = units.iter().find(|unit| unit.place == coordinate) {
                return format!("{:?}", unit.value);
            }
            let sign = if place % 2 == 0 { "" } else { "-" };
            format!(r#""{sign}{}""#, fraction(5 - place % 4, 10))
        });
    let initial: Vec<String> = initial.collect();
    let state: Vec<String> = coordinates.iter().map(|name| format!("{name:?}")).collect();
    let mut lines = vec![
        r#""format": 1"#.to_owned(),
        format!(r#""name": "{name}""#),
        format!(
            r#""description": "A free body on the dual of {algebra}{}""#,
            why(units)
        ),
        format!(r#""algebra": "{algebra}""#),
        format!(r#""state": [{}]"#, state.join(", ")),
    ];
    if few {
        lines.push(format!(r#""parameters": {{ {} }}"#, parameters.join(", ")));
    }
    lines.extend([
        format!(r#""hamiltonian": "{}""#, terms.join(" + ")),
        format!(r#""initial": [{}]"#, initial.join(", ")),
        r#""run": { "method": "lie-midpoint", "step": "1/50", "until": 20 }"#.to_owned(),
    ]);
    format!("{{\n  {}\n}}\n", lines.join(",\n  "))
}

/// A fraction in lowest terms.
fn reduced(above: u32, below: u32) -> (u32, u32) {
    let (mut divisor, mut rest) = (above, below);
    while rest > 0 {
        (divisor, rest) = (rest, divisor % rest);
    }
    (above / divisor, below / divisor)
}

/// The same as text: `4/3`, `2`.
fn fraction(above: u32, below: u32) -> String {
    match reduced(above, below) {
        (above, 1) => above.to_string(),
        (above, below) => format!("{above}/{below}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fractions_are_in_lowest_terms() {
        let some = [(3, 3), (4, 3), (6, 3), (5, 10), (4, 10), (3, 10)];
        let texts = some.map(|(above, below)| fraction(above, below));
        assert_eq!(texts, ["1", "4/3", "2", "1/2", "2/5", "3/10"]);
    }
}
