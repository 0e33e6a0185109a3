//! What `lie check` says of the pieces of H whose flows are exact.

use std::fmt::Write as _;

use lie_codegen::structure::Structure;
use lie_in_process::report::splitting::Splitting;

/// One line for each piece.
pub(super) fn write(
    model: &Structure,
    splitting: &Result<Splitting, String>,
    text: &mut String,
) -> std::fmt::Result {
    let Splitting { terms, costs } = match splitting {
        Ok(splitting) => splitting,
        Err(why) => return writeln!(text, "  splitting: none: {why}"),
    };
    let count = match terms.pieces.len() {
        1 => "1 piece with an exact flow".to_owned(),
        count => format!("{count} pieces with exact flows"),
    };
    let rest = if terms.shifted {
        ", and a combination of Casimirs"
    } else {
        ""
    };
    let place = match model.family {
        Some(_) => " at each site",
        None => "",
    };
    let mut driving = model.driving.iter();
    let acts = driving.any(|driving| !driving.declared.is_empty());
    let what = match model.family.is_some() && acts {
        true => "H with what acts",
        false => "H",
    };
    writeln!(text, "  splitting: {what} is {count}{rest}{place}")?;
    for piece in &terms.pieces {
        writeln!(text, "    {}", piece.join(", "))?;
    }
    match costs {
        Some((own, others)) if !others.is_empty() => {
            let others: Vec<String> = others.iter().map(usize::to_string).collect();
            writeln!(
                text,
                "    a step of splitting2 costs {own} multiplications, with other such pieces {}",
                others.join(", ")
            )
        }
        _ => Ok(()),
    }
}
