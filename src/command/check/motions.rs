//! What `lie check` says of constants of the motion.

use std::fmt::Write as _;

use lie_codegen::check::motions::{End, Motions};
use lie_codegen::model::Model;
use serde_json::{Value, json};

/// The functions by their names: F1, F2, … and what they are.
fn named(model: &Model, motions: &Motions) -> Vec<(String, u32)> {
    let name = |v: usize| match v.checked_sub(model.dimension()) {
        Some(parameter) => model.parameters[parameter].name.clone(),
        None => model.coordinates[v].text.clone(),
    };
    let found = motions.found.iter();
    found
        .map(|motion| (motion.function.display(&name), motion.degree))
        .collect()
}

/// The constants by lines.
pub(super) fn write(
    model: &Model,
    motions: &Result<Motions, &'static str>,
    text: &mut String,
) -> std::fmt::Result {
    let motions = match motions {
        Ok(motions) => motions,
        Err(reason) => {
            return writeln!(
                text,
                "  other constants of the motion: not looked for: {reason}"
            );
        }
    };
    let count = match motions.found.len() {
        0 => "none".to_owned(),
        count => format!("{count} found"),
    };
    let degree = motions.searched;
    write!(
        text,
        "  other constants of the motion, polynomials of degree up to {degree}: {count}"
    )?;
    match motions.end {
        End::All => writeln!(text, "; there can be no more on a generic orbit")?,
        End::Degree => writeln!(text)?,
        End::Large => writeln!(
            text,
            "; of higher degree there are too many to be looked for"
        )?,
        End::Spent => writeln!(
            text,
            "; the search ended with its budget: `lie check --deep` goes on"
        )?,
    }
    for (index, (function, degree)) in named(model, motions).into_iter().enumerate() {
        let kind = match degree {
            1 => " (linear: H is invariant under the flow of this element of the algebra)",
            2 => " (quadratic)",
            _ => "",
        };
        writeln!(text, "    F{} = {function}{kind}", index + 1)?;
    }
    Ok(())
}

/// The same for programs; null where none were looked for.
pub(super) fn json(model: &Model, motions: &Result<Motions, &'static str>) -> Value {
    let Ok(motions) = motions else {
        return Value::Null;
    };
    let found = named(model, motions);
    let found = found.into_iter();
    found
        .map(|(function, degree)| json!({ "expression": function, "degree": degree }))
        .collect()
}
