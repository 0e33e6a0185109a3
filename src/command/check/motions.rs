//! What `lie check` says of constants of the motion.

use std::fmt::Write as _;

use lie_codegen::structure::Structure;
use lie_codegen::structure::motions::End;
use lie_in_process::report::motions::named;

use crate::command::fold::folded;

/// The constants by lines.
pub(super) fn write(model: &Structure, text: &mut String) -> std::fmt::Result {
    let motions = match &model.motions {
        None => return Ok(()),
        Some(Ok(motions)) => motions,
        Some(Err(reason)) => {
            let line = format!("  other constants of the motion: not looked for: {reason}");
            return writeln!(text, "{}", folded(&line));
        }
    };
    let count = match motions.found.len() {
        0 => "none".to_owned(),
        count => format!("{count} found"),
    };
    let degree = motions.searched;
    let end = match motions.end {
        End::All => "; there can be no more on a generic orbit",
        End::Degree => "",
        End::Large => "; of higher degree there are too many to be looked for",
        End::Spent => "; the search ended with its budget: `lie check --deep` goes on",
    };
    let line = format!(
        "  other constants of the motion, polynomials of degree up to {degree}: {count}{end}"
    );
    writeln!(text, "{}", folded(&line))?;
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
